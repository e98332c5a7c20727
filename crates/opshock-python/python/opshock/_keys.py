"""Settings of a study, with their units. Made by generate_keys.py from `opshock schema`; not edited by hand."""

# ruff: noqa: E501
from dataclasses import dataclass, field
from typing import Any

# Of a setting that a study has only together with others.
MISSING: Any = None


@dataclass(frozen=True)
class AsperityContact:
    """Settings `asperity_contact`."""

    asperities_per_um2: float | tuple[float, ...] | None = None
    """Asperities per area. The default makes roughness x tip radius x density 0.05 (Greenwood and Williamson 1966: 0.03 to 0.05); doubtful for a disk. In 1/µm². Absent: 100.0."""
    friction: float | tuple[float, ...] | None = None
    """Coefficient of friction (0.3 in that sample). Absent: 0.3."""
    modulus_gpa: float | tuple[float, ...] | None = None
    """E' with 1/E' = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 of the two surfaces; doubtful, since coatings are thinner than what is pressed in. In GPa. Absent: 100.0."""
    roughness_nm: float | tuple[float, ...] | None = None
    """Standard deviation of the sum of the heights of slider and disk. With it asperities bear, and the film's height is the mean gap. In nm. Absent: smooth surfaces without contact."""
    tip_radius_um: float | tuple[float, ...] | None = None
    """Radius of their tips (1 um in a sample of the CML Dynamic Simulator). In µm. Absent: 1.0."""
    yield_pressure_gpa: float | tuple[float, ...] | None = None
    """Largest contact pressure of an asperity, at which it yields: about the hardness of the softer surface; doubtful. In GPa. Absent: 12.0."""


@dataclass(frozen=True)
class BaseImported:
    """Settings `base.imported`."""

    cut_khz: float | None = None
    """Natural modes below this frequency are kept, at most 16. In kHz. Absent: 10.0."""
    damping_ratio: float | None = None
    """Damping ratio of every mode. Absent: 0.02."""
    freedoms: str | None = None
    """Freedoms of the rows, a line node.direction each. Absent: places."""
    held: tuple[float, ...] | None = None
    """Nodes that move with the shock; their mass loads the others. Absent: the mounts are springs in the matrices."""
    mass: str | None = None
    """Mass matrix of the base by another program: Matrix Market (.mtx), CalculiX (.mas), or rows of numbers. Absent: modes, or a rigid base."""
    pivot: int | None = None
    """Node of the actuator's pivot. Absent: modes, or a rigid base."""
    places: str | None = None
    """Places and kinds of the rows, a line x y z type each, mm. Absent: freedoms."""
    ramp: int | None = None
    """Node of the ramp's mount. Absent: modes, or a rigid base."""
    spindle: int | None = None
    """Node of the spindle; its displacement z is along the disk's axis. Absent: modes, or a rigid base."""
    stiffness: str | None = None
    """Its stiffness matrix. Absent: modes, or a rigid base."""
    units: str | None = None
    """Units of the matrices: N, m, kg; mN, mm, kg; N, mm, t. Absent: si."""


@dataclass(frozen=True)
class BaseModes:
    """An entry of `base.modes`."""

    damping_ratio: float = MISSING
    """Damping ratio."""
    frequency_hz: float = MISSING
    """Undamped natural frequency. In Hz."""
    participation_sqrt_kg: float = MISSING
    """Load on the mode by a unit acceleration of the base. In √kg."""
    pivot_per_sqrt_kg: float = MISSING
    """Displacement of the actuator's pivot, which carries the suspension. In 1/√kg."""
    ramp_per_sqrt_kg: float = MISSING
    """Displacement of the ramp's mount. In 1/√kg."""
    spindle_per_sqrt_kg: float = MISSING
    """Displacement of the spindle along the disk's axis. In 1/√kg."""


@dataclass(frozen=True)
class Base:
    """Settings `base`."""

    imported: BaseImported | None = None
    """Settings `base.imported`."""
    modes: tuple[BaseModes, ...] = ()
    """Modes of base plate and housing under the shock, of unit modal mass. Needs a straight shock. Absent: a rigid base."""


@dataclass(frozen=True)
class DiskDampingRayleigh:
    """Settings `disk.damping.rayleigh`."""

    alpha_per_s: float | tuple[float, ...] = MISSING
    """Material damping, share of the mass matrix, in the rotating frame. In 1/s."""
    beta_s: float | tuple[float, ...] = MISSING
    """Material damping, share of the stiffness matrix, in the rotating frame. In s."""


@dataclass(frozen=True)
class DiskDamping:
    """Settings `disk.damping`."""

    modal_ratio: float | tuple[float, ...] | None = None
    """The same damping ratio for every mode of the disk, in the rotating frame. Absent: Rayleigh damping."""
    rayleigh: DiskDampingRayleigh = field(default_factory=DiskDampingRayleigh)
    """Settings `disk.damping.rayleigh`."""


@dataclass(frozen=True)
class DiskWaves:
    """An entry of `disk.waves`."""

    amplitude_nm: float | tuple[float, ...] = MISSING
    """Amplitude, the same at every radius. In nm."""
    harmonic: int | tuple[int, ...] = MISSING
    """Waves a revolution."""
    phase_deg: float | tuple[float, ...] | None = None
    """Phase at angle 0 at the onset of the shock. In °. Absent: 0."""


@dataclass(frozen=True)
class Disk:
    """Settings `disk`."""

    damping: DiskDamping = field(default_factory=DiskDamping)
    """Settings `disk.damping`."""
    density_kg_per_m3: float | tuple[float, ...] = MISSING
    """Density. In kg/m³."""
    inner_radius_mm: float | tuple[float, ...] = MISSING
    """Radius of the clamp. In mm."""
    outer_radius_mm: float | tuple[float, ...] = MISSING
    """Radius of the rim. In mm."""
    poisson: float | tuple[float, ...] = MISSING
    """Poisson's ratio."""
    rpm: float | tuple[float, ...] = MISSING
    """Speed of rotation; 0 only for studies without the air bearing. In rev/min."""
    run_out_deg: float | tuple[float, ...] | None = None
    """Angle of its highest point at the onset of the shock, in the disk's sense of rotation. In °. Absent: 0."""
    run_out_um: float | tuple[float, ...] | None = None
    """Axial run-out under the slider once a revolution: amplitude at the rim, growing with the radius. In µm. Absent: a plane disk."""
    space_fixed_damping_per_s: float | tuple[float, ...] = MISSING
    """Damping fixed in space (air): force per mass and velocity. In 1/s."""
    thickness_mm: float | tuple[float, ...] = MISSING
    """Thickness. In mm."""
    waves: tuple[DiskWaves, ...] = ()
    """Waves of the disk's surface that turn with it under the slider. Absent: a plane disk."""
    youngs_modulus_gpa: float | tuple[float, ...] = MISSING
    """Young's modulus. In GPa."""


@dataclass(frozen=True)
class FailureDamage:
    """Settings `failure.damage`."""

    contacts: int | tuple[int, ...] | None = None
    """Limit of damage: number of contacts, each a force above 1 % of the steady force of the dimple. Absent: no limit."""
    overlap_nm: float | tuple[float, ...] | None = None
    """Limit of damage: overlap of the mean planes of slider and disk. In nm. Absent: no limit."""
    pressure_gpa: float | tuple[float, ...] | None = None
    """Limit of damage: contact pressure of a nominal area. In GPa. Absent: no limit."""


@dataclass(frozen=True)
class Failure:
    """Settings `failure`."""

    clearance_nm: float | tuple[float, ...] = MISSING
    """Clearance below which the interface has failed. In nm."""
    criterion: str | tuple[str, ...] | None = None
    """What is called failure: a touch of slider and disk, or contact that exceeds one of the limits of damage below, where a touch is none. Absent: touch."""
    damage: FailureDamage | None = None
    """Settings `failure.damage`."""


@dataclass(frozen=True)
class Fields:
    """Settings `fields`."""

    times_ms: tuple[float, ...] | None = None
    """Times at which pressure_field is kept, on the time axis of every output: pressure and height of the film in every cell. In ms. Absent: no pressure field."""


@dataclass(frozen=True)
class Gas:
    """Settings `gas`."""

    altitude_m: float | tuple[float, ...] | None = None
    """Altitude: pressure of the standard atmosphere. In m. Absent: sea level."""
    mean_free_path_nm: float | tuple[float, ...] | None = None
    """Mean free path at the ambient pressure. In nm. Absent: 63.5 nm scaled with viscosity, pressure and temperature."""
    model: str | tuple[str, ...] = MISSING
    """Rarefaction model of the film."""
    pressure_pa: float | tuple[float, ...] | None = None
    """Ambient pressure. In Pa. Absent: 101325 Pa, or from altitude_m."""
    temperature_c: float | tuple[float, ...] | None = None
    """Temperature: viscosity by Sutherland's law, and mean free path. In °C. Absent: 18.45 degrees, where the viscosity is 1.806e-5 Pa s."""
    viscosity_pa_s: float | tuple[float, ...] | None = None
    """Dynamic viscosity. In Pa s. Absent: from the temperature."""


@dataclass(frozen=True)
class HeadsDisk:
    """Settings `heads.disk`."""

    thickness_mm: float | None = None
    """Thickness. In mm. Absent: the study's."""


@dataclass(frozen=True)
class HeadsRamp:
    """Settings `heads.ramp`."""

    clearance_bottom_um: float | None = None
    """Static clearance below the disk, when unequal. In µm. Absent: the study's."""
    clearance_top_um: float | None = None
    """Static clearance above the disk, when unequal. In µm. Absent: the study's."""
    clearance_um: float | None = None
    """Static clearance between disk and ramp, above and below. In µm. Absent: the study's."""


@dataclass(frozen=True)
class HeadsSliderSurfaceRail:
    """An entry of `heads.slider.surface.rail`."""

    kind: str = MISSING
    """Shape of the rail's outline."""
    points_um: tuple[tuple[float, ...], ...] | None = None
    """Corners of a polygon. In µm. Absent: a rectangle."""
    recess_um: float = MISSING
    """Recess of the rail from the reference plane. In µm."""
    x_um: tuple[float, ...] | None = None
    """Range along the length, from the leading edge. In µm. Absent: a polygon."""
    y_um: tuple[float, ...] | None = None
    """Range across, from the inner edge. In µm. Absent: a polygon."""


@dataclass(frozen=True)
class HeadsSliderSurface:
    """Settings `heads.slider.surface`."""

    base_recess_um: float | None = None
    """Recess of everything no rail covers. In µm. Absent: the study's."""
    camber_nm: float | None = None
    """Rise of the middle over the sides. In nm. Absent: the study's."""
    crown_nm: float | None = None
    """Rise of the middle over the ends. In nm. Absent: the study's."""
    file: str | None = None
    """File of the air-bearing surface, beside the study. Absent: the study's."""
    preset: str | None = None
    """A named air-bearing surface. Absent: the study's."""
    rail: tuple[HeadsSliderSurfaceRail, ...] = ()
    """Rails; later ones overwrite earlier ones. Absent: the study's."""
    taper_angle_deg: float | None = None
    """Angle of the taper at the leading edge. In °. Absent: the study's."""
    taper_length_um: float | None = None
    """Length of the taper at the leading edge; 0 for none. In µm. Absent: the study's."""
    twist_nm: float | None = None
    """Twist. In nm. Absent: the study's."""


@dataclass(frozen=True)
class HeadsSlider:
    """Settings `heads.slider`."""

    angle_deg: float | None = None
    """Angle of the slider's centre in the disk's sense of rotation, measured as the ramp's. In °. Absent: the study's."""
    faces: str | None = None
    """Way the slider faces: down, over the disk, or up, under it, where the shock has the other sign and the ramp's bottom arm is on the slider's side. Absent: the study's."""
    radius_mm: float | None = None
    """Radius of the slider's centre. In mm. Absent: the study's."""
    skew_deg: float | None = None
    """Angle between the disk's velocity and the slider's length, positive towards the outer side. In °. Absent: the study's."""
    surface: HeadsSliderSurface | None = None
    """Settings `heads.slider.surface`."""


@dataclass(frozen=True)
class HeadsSuspensionDimple:
    """Settings `heads.suspension.dimple`."""

    damping_ratio: float | None = None
    """Damping ratio of the closed dimple contact, on the slider's mass. Absent: the study's."""
    stiffness_n_per_m: float | None = None
    """Stiffness of the closed dimple contact; 1e8 is as good as rigid. In N/m. Absent: the study's."""


@dataclass(frozen=True)
class HeadsSuspensionFlange:
    """Settings `heads.suspension.flange`."""

    from_mm: float | None = None
    """Start of the flanges, from the root of the hinge. In mm. Absent: the study's."""
    height_um: float | None = None
    """Height of the flanges on both sides. In µm. Absent: the study's."""
    to_mm: float | None = None
    """End of the flanges, from the root of the hinge. In mm. Absent: the study's."""


@dataclass(frozen=True)
class HeadsSuspensionFlexure:
    """Settings `heads.suspension.flexure`."""

    from_mm: float | None = None
    """Start of the smeared mass, from the root of the hinge; it ends with the beam. In mm. Absent: the study's."""
    mass_mg: float | None = None
    """Mass of the flexure, smeared evenly over the beam. In mg. Absent: the study's."""


@dataclass(frozen=True)
class HeadsSuspensionGimbal:
    """Settings `heads.suspension.gimbal`."""

    dimple_preload_gf: float | None = None
    """Force by which the bent gimbal presses slider and dimple together, in addition to the gram load; the film does not carry it. In gram-force. Absent: the study's."""
    pitch_n_m_per_rad: float | None = None
    """Stiffness of the gimbal, pitch. In N m/rad. Absent: the study's."""
    roll_n_m_per_rad: float | None = None
    """Stiffness of the gimbal, roll. In N m/rad. Absent: the study's."""
    vertical_n_per_m: float | None = None
    """Stiffness of the gimbal, vertical. In N/m. Absent: the study's."""


@dataclass(frozen=True)
class HeadsSuspensionHinge:
    """Settings `heads.suspension.hinge`."""

    length_mm: float | None = None
    """Length of the hinge. In mm. Absent: the study's."""
    thickness_um: float | None = None
    """Thickness of the hinge. In µm. Absent: the study's."""
    width_mm: float | None = None
    """Width of the hinge. In mm. Absent: the study's."""


@dataclass(frozen=True)
class HeadsSuspensionImported:
    """Settings `heads.suspension.imported`."""

    base: tuple[float, ...] | None = None
    """Nodes that the base holds; their mass loads the others. Absent: the study's."""
    cut_khz: float | None = None
    """Modes with the dimple held, below this frequency, are kept of matrices of more than 300 rows. In kHz. Absent: the study's."""
    dimple: int | None = None
    """Node of the dimple: z, roll about x and slope about y. Absent: the study's."""
    freedoms: str | None = None
    """Freedoms of the rows, a line node.direction each. Absent: the study's."""
    mass: str | None = None
    """Mass matrix of another program: Matrix Market (.mtx), CalculiX (.mas) or rows of numbers. Absent: the study's."""
    places: str | None = None
    """Places and kinds of the rows, a line x y z type each, mm. Absent: the study's."""
    stiffness: str | None = None
    """Its stiffness matrix. Absent: the study's."""
    units: str | None = None
    """Units of the matrices: N, m, kg; mN, mm, kg; N, mm, t. Absent: the study's."""


@dataclass(frozen=True)
class HeadsSuspensionLiftTab:
    """Settings `heads.suspension.lift_tab`."""

    damping_ratio: float | None = None
    """Damping ratio of the tab in contact, on the slider's mass. Absent: the study's."""
    gap_um: float | None = None
    """Rise of the end of the tab at which it meets a stop of the base, from steady flight. In µm. Absent: the study's."""
    stiffness_n_per_m: float | None = None
    """Stiffness of the tab in contact with its stop. In N/m. Absent: the study's."""


@dataclass(frozen=True)
class HeadsSuspensionLimiters:
    """Settings `heads.suspension.limiters`."""

    across_mm: float | None = None
    """Distance of each from the middle: inner limiter inwards, outer one outwards. In mm. Absent: the study's."""
    along_mm: float | None = None
    """Place of the limiters from the dimple towards the tip. In mm. Absent: the study's."""
    damping_ratio: float | None = None
    """Damping ratio of a limiter in contact, on the slider's mass. Absent: the study's."""
    gap_outer_um: float | None = None
    """The same of the outer limiter, where it differs. In µm. Absent: the study's."""
    gap_um: float | None = None
    """Opening of the dimple at which the limiters hold it, from steady flight; with it there is an inner and an outer one. In µm. Absent: the study's."""
    stiffness_n_per_m: float | None = None
    """Stiffness of each limiter in contact. In N/m. Absent: the study's."""


@dataclass(frozen=True)
class HeadsSuspensionLoadBeam:
    """Settings `heads.suspension.load_beam`."""

    dimple_mm: float | None = None
    """Dimple, from the root of the hinge. In mm. Absent: the study's."""
    end_mm: float | None = None
    """End of the tab, from the root of the hinge. In mm. Absent: the study's."""
    tab_width_mm: float | None = None
    """Width of the tab. In mm. Absent: the study's."""
    web_um: float | None = None
    """Thickness of the web. In µm. Absent: the study's."""
    width_dimple_mm: float | None = None
    """Width at the dimple. In mm. Absent: the study's."""
    width_root_mm: float | None = None
    """Width where the load beam meets the hinge. In mm. Absent: the study's."""


@dataclass(frozen=True)
class HeadsSuspensionMaterial:
    """Settings `heads.suspension.material`."""

    density_kg_per_m3: float | None = None
    """Density. In kg/m³. Absent: the study's."""
    shear_modulus_gpa: float | None = None
    """Shear modulus. In GPa. Absent: the study's."""
    youngs_modulus_gpa: float | None = None
    """Young's modulus. In GPa. Absent: the study's."""


@dataclass(frozen=True)
class HeadsSuspensionModes:
    """An entry of `heads.suspension.modes`."""

    frequency_hz: float = MISSING
    """Undamped natural frequency. In Hz."""
    participation_sqrt_kg: float = MISSING
    """Load on the mode by a unit acceleration of the base. In √kg."""
    roll_per_m_sqrt_kg: float = MISSING
    """Roll of the dimple; 0 in a mode that bends. In 1/(m √kg)."""
    slope_per_m_sqrt_kg: float = MISSING
    """Slope dw/dx at the dimple, x from root to tip. In 1/(m √kg)."""
    vertical_per_sqrt_kg: float = MISSING
    """Displacement z of the dimple, of unit modal mass. In 1/√kg."""


@dataclass(frozen=True)
class HeadsSuspensionRayleigh:
    """Settings `heads.suspension.rayleigh`."""

    alpha_per_s: float | None = None
    """Rayleigh damping in place of damping_ratio: share of the mass matrix. In 1/s. Absent: the study's."""
    beta_s: float | None = None
    """Its share of the stiffness matrix. In s. Absent: the study's."""


@dataclass(frozen=True)
class HeadsSuspension:
    """Settings `heads.suspension`."""

    damping_ratio: float | None = None
    """Damping ratio of every mode of the suspension. Absent: the study's."""
    dimple: HeadsSuspensionDimple | None = None
    """Settings `heads.suspension.dimple`."""
    flange: HeadsSuspensionFlange | None = None
    """Settings `heads.suspension.flange`."""
    flexure: HeadsSuspensionFlexure | None = None
    """Settings `heads.suspension.flexure`."""
    gimbal: HeadsSuspensionGimbal | None = None
    """Settings `heads.suspension.gimbal`."""
    gram_load_gf: float | None = None
    """Load at the slider's centre. In gram-force. Absent: the study's."""
    hinge: HeadsSuspensionHinge | None = None
    """Settings `heads.suspension.hinge`."""
    imported: HeadsSuspensionImported | None = None
    """Settings `heads.suspension.imported`."""
    lift_tab: HeadsSuspensionLiftTab | None = None
    """Settings `heads.suspension.lift_tab`."""
    limiters: HeadsSuspensionLimiters | None = None
    """Settings `heads.suspension.limiters`."""
    load_beam: HeadsSuspensionLoadBeam | None = None
    """Settings `heads.suspension.load_beam`."""
    material: HeadsSuspensionMaterial | None = None
    """Settings `heads.suspension.material`."""
    modes: tuple[HeadsSuspensionModes, ...] = ()
    """Modes of the suspension on its base, in place of its geometry. Absent: the study's."""
    rayleigh: HeadsSuspensionRayleigh | None = None
    """Settings `heads.suspension.rayleigh`."""


@dataclass(frozen=True)
class Heads:
    """An entry of `heads`."""

    disk: HeadsDisk | None = None
    """Settings `heads.disk`."""
    head: str = MISSING
    """Name of the head, as tables show it."""
    ramp: HeadsRamp | None = None
    """Settings `heads.ramp`."""
    slider: HeadsSlider | None = None
    """Settings `heads.slider`."""
    suspension: HeadsSuspension | None = None
    """Settings `heads.suspension`."""


@dataclass(frozen=True)
class Hub:
    """Settings `hub`."""

    axial_damping_n_s_per_m: float | tuple[float, ...] | None = None
    """Axial damping of the bearing. In N s/m. Absent: 0."""
    axial_stiffness_n_per_m: float | tuple[float, ...] | None = None
    """Axial stiffness of the hub's bearing; with both stiffnesses the disk stands on a hub. In N/m. Absent: the disk is clamped to the base."""
    centre_height_mm: float | tuple[float, ...] | None = None
    """Centre of mass of rotor and disk above the centre of tilt: arm of a shock in the disk's plane. In mm. Absent: 0."""
    cross_damping_n_m_s_per_rad: float | tuple[float, ...] | None = None
    """Moment across the velocity of a tilt, in the sense of the gyroscopic one. In N m s/rad. Absent: 0."""
    cross_stiffness_n_m_per_rad: float | tuple[float, ...] | None = None
    """Moment across a tilt; positive drives the whirl that goes with the spin. In N m/rad. Absent: 0."""
    mass_mg: float | tuple[float, ...] | None = None
    """Mass that moves with the hub, without the free part of the disk. In mg. Absent: 0."""
    polar_inertia_mg_mm2: float | tuple[float, ...] | None = None
    """Its moment of inertia about the axis of spin. In mg mm². Absent: 0."""
    tilt_damping_n_m_s_per_rad: float | tuple[float, ...] | None = None
    """Damping of the hub's tilt. In N m s/rad. Absent: 0."""
    tilt_stiffness_n_m_per_rad: float | tuple[float, ...] | None = None
    """Stiffness of the bearing against tilt of the hub. In N m/rad. Absent: the disk is clamped to the base."""
    transverse_inertia_mg_mm2: float | tuple[float, ...] | None = None
    """Its moment of inertia about a diameter, at the bearing's centre. In mg mm². Absent: 0."""


@dataclass(frozen=True)
class Output:
    """Settings `output`."""

    checkpoint_s: float = MISSING
    """Time between two refreshes of results.h5. In s."""
    keep_histories: str = MISSING
    """Which time histories are stored."""


@dataclass(frozen=True)
class Pulse:
    """Settings `pulse`."""

    decay_per_s: float | tuple[float, ...] = MISSING
    """Decay rate of a damped sine. In 1/s."""
    decay_share: float | tuple[float, ...] = MISSING
    """Share of the peak energy of disk and ramp that ends the window until_decayed."""
    frequency_hz: float | tuple[float, ...] = MISSING
    """Frequency of a damped sine. In Hz."""
    in_plane_x: float | tuple[float, ...] | None = None
    """Share of the shock in the plane of the disk, along angle 0: load along x per axial load. Needs a hub. Absent: a straight shock."""
    in_plane_y: float | tuple[float, ...] | None = None
    """The same a quarter turn on in the disk's sense of rotation. Absent: a straight shock."""
    rise_share: float | tuple[float, ...] = MISSING
    """Share of the width in which a trapezoid rises, and again falls."""
    rotation_x_per_m: float | tuple[float, ...] | None = None
    """Angular acceleration felt about x per axial acceleration at the spindle. Needs a hub. In 1/m. Absent: a straight shock."""
    rotation_y_per_m: float | tuple[float, ...] | None = None
    """The same about y. In 1/m. Absent: a straight shock."""
    shape: str | tuple[str, ...] = MISSING
    """Shape of the acceleration pulse."""
    signs: tuple[str, ...] = MISSING
    """Signs of the shock: + moves the disk towards the slider first."""
    start_ms: float = MISSING
    """Onset of the pulse on the time axis of every output. In ms."""
    table: str | None = None
    """File of a measured pulse, columns of time and acceleration. Needs table_time_unit and table_scale. Absent: no table."""
    table_acceleration_unit: str | None = None
    """Unit of the file's accelerations. Absent: relative numbers, for stretched pulses only."""
    table_columns: tuple[float, ...] | None = None
    """Columns of time and acceleration in the file, counted from 1. Absent: [1, 2], and no others in the file."""
    table_cutoff_hz: float | None = None
    """Butterworth filter instead: frequency at which its two passes give -3 dB. In Hz. Absent: no filter."""
    table_filter: str | None = None
    """Channel frequency class of SAE J211: phaseless low-pass filter of the record. Absent: no filter."""
    table_filter_order: int | None = None
    """Its order in each of the two passes. Absent: no filter."""
    table_offset: str | None = None
    """Zero line that is subtracted: mean of the samples before table_window_ms, or the straight line through those before and after it. Absent: nothing is subtracted."""
    table_relative: tuple[float, ...] | None = None
    """Relative accelerations of a sampled pulse; in G when table_scale is measured. Absent: no table."""
    table_scale: str | None = None
    """measured: real time and G, the pulse's width is the record's own; stretched: to every width of pulse.widths_ms. The shock's amplitude is the largest magnitude of the pulse in both. Absent: stretched, for samples given in the study."""
    table_skip_rows: int | None = None
    """Rows at the beginning of the file that are not read. Rows without a number before the first sample are its header. Absent: 0."""
    table_time_ms: tuple[float, ...] | None = None
    """Times of a sampled pulse given here instead of in a file. In ms. Absent: no table."""
    table_time_unit: str | None = None
    """Unit of the file's times. Absent: no file."""
    table_window_ms: tuple[float, ...] | None = None
    """The part of the record that is the pulse, in the file's time. In ms. Absent: the whole record."""
    widths_ms: float | tuple[float, ...] = MISSING
    """Pulse widths: an axis of the study. Left out with table_scale measured. In ms."""
    window_max_ms: float | tuple[float, ...] = MISSING
    """Longest window until_decayed. In ms."""
    window_ms: float | str | tuple[float | str, ...] = MISSING
    """Simulated time after the onset. In ms."""


@dataclass(frozen=True)
class RampDeformableBottomModes:
    """An entry of `ramp.deformable.bottom_modes`."""

    damping_ratio: float | tuple[float, ...] | None = None
    """Damping ratio of this mode. Absent: as ramp.deformable.damping_ratio."""
    frequency_hz: float | tuple[float, ...] = MISSING
    """Undamped natural frequency. In Hz."""
    mass_mg: float | tuple[float, ...] = MISSING
    """Modal mass. In mg."""
    participation: float | tuple[float, ...] = MISSING
    """Base participation: inertia load = mass x participation x acceleration."""


@dataclass(frozen=True)
class RampDeformableCoupledModes:
    """An entry of `ramp.deformable.coupled_modes`."""

    bottom_per_sqrt_kg: float | tuple[float, ...] = MISSING
    """Shape at the bottom contact, of unit modal mass. In 1/√kg."""
    damping_ratio: float | tuple[float, ...] | None = None
    """Damping ratio of this mode. Absent: as ramp.deformable.damping_ratio."""
    frequency_hz: float | tuple[float, ...] = MISSING
    """Undamped natural frequency. In Hz."""
    participation_sqrt_kg: float | tuple[float, ...] = MISSING
    """Load on the mode by a unit acceleration of the base. In √kg."""
    top_per_sqrt_kg: float | tuple[float, ...] = MISSING
    """Shape at the top contact, of unit modal mass. In 1/√kg."""


@dataclass(frozen=True)
class RampDeformableGeometry:
    """Settings `ramp.deformable.geometry`."""

    body_depth_mm: float | tuple[float, ...] | None = None
    """From the middle of the disk down to the lower face of body and mount. In mm. Absent: 2.6."""
    body_length_mm: float | tuple[float, ...] | None = None
    """Body, along the fingers. In mm. Absent: 3.0."""
    body_width_mm: float | tuple[float, ...] | None = None
    """Width of body and mount. In mm. Absent: 4.0."""
    contact_length_mm: float | tuple[float, ...] | None = None
    """Length of the contact along the finger, over which its force is spread. In mm. Absent: 0.3."""
    contact_mm: float | tuple[float, ...] | None = None
    """From the tips to the middle of the contact with the disk. In mm. Absent: 0.35."""
    cut_khz: float | tuple[float, ...] | None = None
    """Modes with the contact points held, below this frequency, are kept; responses are good to half of it. In kHz. Absent: 100.0."""
    density_kg_per_m3: float | tuple[float, ...] | None = None
    """Density, instead of the material's. In kg/m³. Absent: the material's."""
    finger_length_mm: float | tuple[float, ...] | None = None
    """Fingers, from their tips to the body. In mm. Absent: 3.2."""
    finger_width_mm: float | tuple[float, ...] | None = None
    """Width of the fingers. In mm. Absent: 1.6."""
    material: str | tuple[str, ...] | None = None
    """Material; with it the ramp is given by its geometry instead of modes. Absent: a ramp given by modes."""
    mesh_size_mm: float | tuple[float, ...] | None = None
    """Longest edge of a finite element; elements at re-entrant corners are a quarter of it. In mm. Absent: 1.0."""
    mount_normal_n_per_m: float | tuple[float, ...] | None = None
    """Stiffness of the mount's face against its plane, spread evenly; without it the face is held. In N/m. Absent: bolted."""
    mount_tangential_n_per_m: float | tuple[float, ...] | None = None
    """Stiffness of the mount's face within its plane. In N/m. Absent: as mount_normal_n_per_m."""
    mount_thickness_mm: float | tuple[float, ...] | None = None
    """Thickness of the mount. In mm. Absent: 0.8."""
    neck_length_mm: float | tuple[float, ...] | None = None
    """Free part of the mount behind the body; 0 for none. In mm. Absent: 0.8."""
    pad_length_mm: float | tuple[float, ...] | None = None
    """Bolted part of the mount; 0 for a body bolted itself. In mm. Absent: 2.8."""
    poisson: float | tuple[float, ...] | None = None
    """Poisson's ratio, instead of the material's. Absent: the material's."""
    root_thickness_mm: float | tuple[float, ...] | None = None
    """Thickness of a finger behind its slope. In mm. Absent: 0.9."""
    slope_length_mm: float | tuple[float, ...] | None = None
    """Length of the slope, over which a finger grows from tip to root thickness. In mm. Absent: 1.8."""
    tip_thickness_mm: float | tuple[float, ...] | None = None
    """Thickness of a finger at its tip. In mm. Absent: 0.3."""
    youngs_modulus_gpa: float | tuple[float, ...] | None = None
    """Young's modulus, instead of the material's. In GPa. Absent: the material's."""


@dataclass(frozen=True)
class RampDeformableMesh:
    """Settings `ramp.deformable.mesh`."""

    cut_khz: float | None = None
    """Modes with the contacts held, below this frequency, are kept; responses are good to half of it. In kHz. Absent: 100.0."""
    density_kg_per_m3: float | None = None
    """Density, instead of the material's. In kg/m³. Absent: the material's."""
    file: str | None = None
    """Gmsh mesh (.msh 4.1) of the ramp with physical surfaces mount, top and bottom; z is the disk's axis. Absent: a ramp given by modes."""
    material: str | None = None
    """Material of the mesh. Absent: a ramp given by modes."""
    mount_normal_n_per_m: float | None = None
    """Stiffness of the mount's face against its plane, spread evenly; without it the face is held. In N/m. Absent: bolted."""
    mount_tangential_n_per_m: float | None = None
    """Stiffness of the mount's face within its plane. In N/m. Absent: as mount_normal_n_per_m."""
    poisson: float | None = None
    """Poisson's ratio, instead of the material's. Absent: the material's."""
    unit: str | None = None
    """Unit of length of the file. Absent: mm."""
    youngs_modulus_gpa: float | None = None
    """Young's modulus, instead of the material's. In GPa. Absent: the material's."""


@dataclass(frozen=True)
class RampDeformableModes:
    """An entry of `ramp.deformable.modes`."""

    damping_ratio: float | tuple[float, ...] | None = None
    """Damping ratio of this mode. Absent: as ramp.deformable.damping_ratio."""
    frequency_hz: float | tuple[float, ...] = MISSING
    """Undamped natural frequency. In Hz."""
    mass_mg: float | tuple[float, ...] = MISSING
    """Modal mass. In mg."""
    participation: float | tuple[float, ...] = MISSING
    """Base participation: inertia load = mass x participation x acceleration."""


@dataclass(frozen=True)
class RampDeformableProny:
    """An entry of `ramp.deformable.prony`."""

    share: float | tuple[float, ...] = MISSING
    """Share of the instantaneous modulus that relaxes; the sum stays below 1."""
    time_ms: float | tuple[float, ...] = MISSING
    """Relaxation time. In ms."""


@dataclass(frozen=True)
class RampDeformable:
    """Settings `ramp.deformable`."""

    bottom_modes: tuple[RampDeformableBottomModes, ...] = ()
    """Modes of the bottom arm, when the arms differ. Absent: as modes."""
    coupled_modes: tuple[RampDeformableCoupledModes, ...] = ()
    """Modes of both arms as one body. Absent: a ramp given by modes of each arm."""
    damping_ratio: float | tuple[float, ...] = MISSING
    """Damping ratio of the arms' modes."""
    geometry: RampDeformableGeometry | None = None
    """Settings `ramp.deformable.geometry`."""
    mesh: RampDeformableMesh | None = None
    """Settings `ramp.deformable.mesh`."""
    modes: tuple[RampDeformableModes, ...] = ()
    """Modes of each arm, scaled to 1 at the contact point; both arms alike."""
    prony: tuple[RampDeformableProny, ...] = ()
    """Prony series by which the stiffness of every mode relaxes; frequencies are those of the instantaneous modulus. Damping ratios add to it. Absent: elastic modes."""


@dataclass(frozen=True)
class Ramp:
    """Settings `ramp`."""

    angle_deg: float | tuple[float, ...] = MISSING
    """Angle of the contact points in the disk's sense of rotation. In °."""
    clearance_bottom_um: float | tuple[float, ...] | None = None
    """Static clearance below the disk, when unequal. In µm. Absent: as clearance_um."""
    clearance_top_um: float | tuple[float, ...] | None = None
    """Static clearance above the disk, when unequal. In µm. Absent: as clearance_um."""
    clearance_um: float | tuple[float, ...] = MISSING
    """Static clearance between disk and ramp, above and below. In µm."""
    contact_damping_ratio: float | tuple[float, ...] | None = None
    """Damping ratio at that frequency, where ringing is no physics; 0.5 at 400 kHz is a loss factor of 6 % at 25 kHz. Absent: 0.5."""
    contact_frequency_khz: float | tuple[float, ...] | None = None
    """Natural frequency of the contact's stiffness on the mass it is given: above what an impact carries to the slider. In kHz. Absent: 400.0."""
    contact_stiffness_n_per_m: float | tuple[float, ...] | None = None
    """Local stiffness between each arm and its contact point. In N/m. Absent: a hard contact."""
    deformable: RampDeformable = field(default_factory=RampDeformable)
    """Settings `ramp.deformable`."""
    models: tuple[str, ...] = MISSING
    """Ramp models: an axis of the study."""
    radius_mm: float | tuple[float, ...] = MISSING
    """Radius of the contact points. In mm."""
    restitution: float | tuple[float, ...] = MISSING
    """Coefficient of restitution of an impact; 0 with a contact stiffness."""
    run_out: str | tuple[str, ...] | None = None
    """lowest_gap takes the run-out of the disk at the ramp off the gaps above and below it: the lowest gap of a revolution. Absent: none."""


@dataclass(frozen=True)
class Resolution:
    """Settings `resolution`."""

    approach_share: float | tuple[float, ...] | None = None
    """Largest share of the clearance closed in one step. Set by resolution.preset when absent."""
    coupling_tolerance: float | tuple[float, ...] | None = None
    """Relative residual of the coupled solve; a hundredth of head_tolerance when that is set alone. Set by resolution.preset when absent."""
    disk_cut_khz: float | tuple[float, ...] | None = None
    """Modes of the disk above this frequency are left out. In kHz. Set by resolution.preset when absent."""
    disk_elements: int | tuple[int, ...] | None = None
    """Radial finite elements of the disk. Set by resolution.preset when absent."""
    disk_harmonics: int | tuple[int, ...] | None = None
    """Largest number of nodal diameters. Set by resolution.preset when absent."""
    film_cells: int | tuple[int, ...] | None = None
    """Wanted number of film cells. Set by resolution.preset when absent."""
    film_correction_cells: int | tuple[int, ...] | None = None
    """Cells of the defect-correction grid, whose forces correct those of the film (2000 at least for a skewed slider); 0: no correction, as where film_cells is set alone. Set by resolution.preset when absent."""
    head_tolerance: float | tuple[float, ...] | None = None
    """Relative local error of the clearance per step. Set by resolution.preset when absent."""
    min_film_height_nm: float | tuple[float, ...] | None = None
    """Minimum film height, a regularisation: the height that the film sees does not fall below it. No uncertainty interval includes what another one would change. In nm. Set by resolution.preset when absent."""
    not_refined: tuple[str, ...] | None = None
    """Discretisation parameters whose values belong to the model, as the modes of another program's mesh: they contribute to no uncertainty interval, and no refinement changes them. Absent: all are refined."""
    preset: str | tuple[str, ...] = MISSING
    """Named set of discretisation parameters: gives those that are not set here, and search.target_uncertainty_pct where that is not set."""
    static_correction: bool | tuple[bool, ...] | None = None
    """Adds the residual flexibility of the ramp point. Set by resolution.preset when absent."""
    structure_step_us: float | tuple[float, ...] | None = None
    """Step on which disk and ramp are stored and contact is resolved. In µs. Set by resolution.preset when absent."""
    suspension_modes: int | tuple[int, ...] | None = None
    """Modes of the suspension kept above the pinned dimple. Set by resolution.preset when absent."""


@dataclass(frozen=True)
class SearchAddedPoints:
    """Settings `search.added_points`."""

    closest_pct: float | None = None
    """No widths are added closer than this. In %. Absent: 2."""
    crossing_pct: float | None = None
    """Adds widths until those between which two ramp models change places are this close. In %. Absent: no widths are added for it."""
    max_points: int | None = None
    """Points added at most. Absent: 60."""
    tolerance_pct: float | None = None
    """Adds widths until straight lines between the answers of a ramp model are this good. In %. Absent: no widths are added for it."""


@dataclass(frozen=True)
class SearchAmplitudeG:
    """Settings `search.amplitude_g`."""

    max: float = MISSING
    """Highest amplitude tried. In g0 (9.80665 m/s²)."""
    min: float = MISSING
    """Lowest amplitude tried. In g0 (9.80665 m/s²)."""


@dataclass(frozen=True)
class Search:
    """Settings `search`."""

    added_points: SearchAddedPoints | None = None
    """Settings `search.added_points`."""
    amplitude_g: SearchAmplitudeG = field(default_factory=SearchAmplitudeG)
    """Settings `search.amplitude_g`."""
    max_refinements: int = MISSING
    """Times that a point which misses the target uncertainty is refined and answered anew."""
    monotonicity_scan: str = MISSING
    """Which amplitudes below the lowest failure are simulated, to see that none of them fails: all (full), some (sampled), none (off)."""
    required_amplitude_g: float | None = None
    """Amplitude that every point must survive. With search.uncertainty_of = "decisive" intervals are then made for points within a factor 4 of this amplitude, and those whose interval contains it are refined, until they meet the target uncertainty. In g0 (9.80665 m/s²). Absent: none."""
    scan_gap_pct: float = MISSING
    """Largest gap between the amplitudes that a sampled scan simulates. In %."""
    target_uncertainty_pct: float | None = None
    """Uncertainty wanted of each critical shock: half-width of its uncertainty interval over the value. A point that misses it is refined. In %. Absent: that of the preset: 5, 1, 0.1."""
    tolerance_pct: float = MISSING
    """Width of the final bracket. In %."""
    uncertainty: bool = MISSING
    """Gives each critical shock its uncertainty interval."""
    uncertainty_of: str | None = None
    """Points that get uncertainty intervals: all, or the decisive ones, on which the best value of every axis and its lead depend, or without such an axis the worst case, or the verdicts on search.required_amplitude_g. These are refined only while that is open; the other points have their brackets alone. Absent: all points."""


@dataclass(frozen=True)
class SliderSurfaceRail:
    """An entry of `slider.surface.rail`."""

    kind: str = MISSING
    """Shape of the rail's outline."""
    points_um: tuple[tuple[float, ...], ...] | None = None
    """Corners of a polygon. In µm. Absent: a rectangle."""
    recess_um: float | tuple[float, ...] = MISSING
    """Recess of the rail from the reference plane. In µm."""
    x_um: tuple[float, ...] | None = None
    """Range along the length, from the leading edge. In µm. Absent: a polygon."""
    y_um: tuple[float, ...] | None = None
    """Range across, from the inner edge. In µm. Absent: a polygon."""


@dataclass(frozen=True)
class SliderSurface:
    """Settings `slider.surface`."""

    base_recess_um: float | tuple[float, ...] = MISSING
    """Recess of everything no rail covers. In µm."""
    camber_nm: float | tuple[float, ...] = MISSING
    """Rise of the middle over the sides. In nm."""
    crown_nm: float | tuple[float, ...] = MISSING
    """Rise of the middle over the ends. In nm."""
    file: str | None = None
    """File of the air-bearing surface, beside the study. Absent: no file."""
    preset: str | tuple[str, ...] | None = None
    """A named air-bearing surface. Absent: a file, rails given here, or femto-2.5in."""
    rail: tuple[SliderSurfaceRail, ...] = ()
    """Rails; later ones overwrite earlier ones. Absent: the rails of preset or file."""
    taper_angle_deg: float | tuple[float, ...] = MISSING
    """Angle of the taper at the leading edge. In °."""
    taper_length_um: float | tuple[float, ...] = MISSING
    """Length of the taper at the leading edge; 0 for none. In µm."""
    twist_nm: float | tuple[float, ...] = MISSING
    """Twist. In nm."""


@dataclass(frozen=True)
class Slider:
    """Settings `slider`."""

    angle_deg: float | tuple[float, ...] = MISSING
    """Angle of the slider's centre in the disk's sense of rotation, measured as the ramp's. In °."""
    density_kg_per_m3: float | tuple[float, ...] = MISSING
    """Density. In kg/m³."""
    faces: str | tuple[str, ...] | None = None
    """Way the slider faces: down, over the disk, or up, under it, where the shock has the other sign and the ramp's bottom arm is on the slider's side. Absent: down."""
    height_mm: float | tuple[float, ...] = MISSING
    """Height. In mm."""
    length_mm: float | tuple[float, ...] = MISSING
    """Length, leading to trailing edge. In mm."""
    radius_mm: float | tuple[float, ...] = MISSING
    """Radius of the slider's centre. In mm."""
    skew_deg: float | tuple[float, ...] = MISSING
    """Angle between the disk's velocity and the slider's length, positive towards the outer side. In °."""
    surface: SliderSurface = field(default_factory=SliderSurface)
    """Settings `slider.surface`."""
    viscous_shear: bool | tuple[bool, ...] | None = None
    """Shear of the film on the slider, which the suspension balances at the dimple: moments of pitch and roll. Absent: no shear."""
    width_mm: float | tuple[float, ...] = MISSING
    """Width, inner to outer side. In mm."""


@dataclass(frozen=True)
class Solver:
    """Settings `solver`."""

    coupling: str | tuple[str, ...] = MISSING
    """How film and slider are solved together."""
    effects: str = MISSING
    """auto simulates only what the outputs need."""
    leave_out: tuple[str, ...] = MISSING
    """Effects left out by hand; refused when an output needs them."""
    max_steps: int | tuple[int, ...] = MISSING
    """Deterministic limit of steps; reaching it leaves the run undecided."""


@dataclass(frozen=True)
class SurfaceForces:
    """Settings `surface_forces`."""

    hamaker_j: float | tuple[float, ...] | None = None
    """Hamaker's constant A of the attraction A/(6 pi h^3) per area between slider and disk. In J. Absent: no van der Waals force."""
    potential_v: float | tuple[float, ...] | None = None
    """Potential difference V of slider and disk: attraction eps0 V^2/(2 h^2) per area. In V. Absent: no electrostatic force."""
    repulsion_j_m6: float | tuple[float, ...] | None = None
    """Constant B of the repulsion B/(45 pi h^9) per area that ends the attraction. In J m⁶. Absent: no repulsion."""


@dataclass(frozen=True)
class SuspensionDimple:
    """Settings `suspension.dimple`."""

    damping_ratio: float | tuple[float, ...] = MISSING
    """Damping ratio of the closed dimple contact, on the slider's mass."""
    stiffness_n_per_m: float | tuple[float, ...] = MISSING
    """Stiffness of the closed dimple contact; 1e8 is as good as rigid. In N/m."""


@dataclass(frozen=True)
class SuspensionFlange:
    """Settings `suspension.flange`."""

    from_mm: float | tuple[float, ...] = MISSING
    """Start of the flanges, from the root of the hinge. In mm."""
    height_um: float | tuple[float, ...] = MISSING
    """Height of the flanges on both sides. In µm."""
    to_mm: float | tuple[float, ...] = MISSING
    """End of the flanges, from the root of the hinge. In mm."""


@dataclass(frozen=True)
class SuspensionFlexure:
    """Settings `suspension.flexure`."""

    from_mm: float | tuple[float, ...] = MISSING
    """Start of the smeared mass, from the root of the hinge; it ends with the beam. In mm."""
    mass_mg: float | tuple[float, ...] = MISSING
    """Mass of the flexure, smeared evenly over the beam. In mg."""


@dataclass(frozen=True)
class SuspensionGimbal:
    """Settings `suspension.gimbal`."""

    dimple_preload_gf: float | tuple[float, ...] = MISSING
    """Force by which the bent gimbal presses slider and dimple together, in addition to the gram load; the film does not carry it. In gram-force."""
    pitch_n_m_per_rad: float | tuple[float, ...] = MISSING
    """Stiffness of the gimbal, pitch. In N m/rad."""
    roll_n_m_per_rad: float | tuple[float, ...] = MISSING
    """Stiffness of the gimbal, roll. In N m/rad."""
    vertical_n_per_m: float | tuple[float, ...] = MISSING
    """Stiffness of the gimbal, vertical. In N/m."""


@dataclass(frozen=True)
class SuspensionHinge:
    """Settings `suspension.hinge`."""

    length_mm: float | tuple[float, ...] = MISSING
    """Length of the hinge. In mm."""
    thickness_um: float | tuple[float, ...] = MISSING
    """Thickness of the hinge. In µm."""
    width_mm: float | tuple[float, ...] = MISSING
    """Width of the hinge. In mm."""


@dataclass(frozen=True)
class SuspensionImported:
    """Settings `suspension.imported`."""

    base: tuple[float, ...] | None = None
    """Nodes that the base holds; their mass loads the others. Absent: the base is not in the matrices."""
    cut_khz: float | None = None
    """Modes with the dimple held, below this frequency, are kept of matrices of more than 300 rows. In kHz. Absent: 1000.0."""
    dimple: int | None = None
    """Node of the dimple: z, roll about x and slope about y. Absent: a suspension by its geometry."""
    freedoms: str | None = None
    """Freedoms of the rows, a line node.direction each. Absent: places."""
    mass: str | None = None
    """Mass matrix of another program: Matrix Market (.mtx), CalculiX (.mas) or rows of numbers. Absent: a suspension by its geometry."""
    places: str | None = None
    """Places and kinds of the rows, a line x y z type each, mm. Absent: freedoms."""
    stiffness: str | None = None
    """Its stiffness matrix. Absent: a suspension by its geometry."""
    units: str | None = None
    """Units of the matrices: N, m, kg; mN, mm, kg; N, mm, t. Absent: si."""


@dataclass(frozen=True)
class SuspensionLiftTab:
    """Settings `suspension.lift_tab`."""

    damping_ratio: float | tuple[float, ...] | None = None
    """Damping ratio of the tab in contact, on the slider's mass. Absent: that of the dimple."""
    gap_um: float | tuple[float, ...] | None = None
    """Rise of the end of the tab at which it meets a stop of the base, from steady flight. In µm. Absent: the tab moves freely."""
    stiffness_n_per_m: float | tuple[float, ...] | None = None
    """Stiffness of the tab in contact with its stop. In N/m. Absent: that of the dimple."""


@dataclass(frozen=True)
class SuspensionLimiters:
    """Settings `suspension.limiters`."""

    across_mm: float | tuple[float, ...] | None = None
    """Distance of each from the middle: inner limiter inwards, outer one outwards. In mm. Absent: 0."""
    along_mm: float | tuple[float, ...] | None = None
    """Place of the limiters from the dimple towards the tip. In mm. Absent: 0."""
    damping_ratio: float | tuple[float, ...] | None = None
    """Damping ratio of a limiter in contact, on the slider's mass. Absent: that of the dimple."""
    gap_outer_um: float | tuple[float, ...] | None = None
    """The same of the outer limiter, where it differs. In µm. Absent: gap_um."""
    gap_um: float | tuple[float, ...] | None = None
    """Opening of the dimple at which the limiters hold it, from steady flight; with it there is an inner and an outer one. In µm. Absent: no limiters."""
    stiffness_n_per_m: float | tuple[float, ...] | None = None
    """Stiffness of each limiter in contact. In N/m. Absent: that of the dimple."""


@dataclass(frozen=True)
class SuspensionLoadBeam:
    """Settings `suspension.load_beam`."""

    dimple_mm: float | tuple[float, ...] = MISSING
    """Dimple, from the root of the hinge. In mm."""
    end_mm: float | tuple[float, ...] = MISSING
    """End of the tab, from the root of the hinge. In mm."""
    tab_width_mm: float | tuple[float, ...] = MISSING
    """Width of the tab. In mm."""
    web_um: float | tuple[float, ...] = MISSING
    """Thickness of the web. In µm."""
    width_dimple_mm: float | tuple[float, ...] = MISSING
    """Width at the dimple. In mm."""
    width_root_mm: float | tuple[float, ...] = MISSING
    """Width where the load beam meets the hinge. In mm."""


@dataclass(frozen=True)
class SuspensionMaterial:
    """Settings `suspension.material`."""

    density_kg_per_m3: float | tuple[float, ...] = MISSING
    """Density. In kg/m³."""
    shear_modulus_gpa: float | tuple[float, ...] = MISSING
    """Shear modulus. In GPa."""
    youngs_modulus_gpa: float | tuple[float, ...] = MISSING
    """Young's modulus. In GPa."""


@dataclass(frozen=True)
class SuspensionModes:
    """An entry of `suspension.modes`."""

    frequency_hz: float | tuple[float, ...] = MISSING
    """Undamped natural frequency. In Hz."""
    participation_sqrt_kg: float | tuple[float, ...] = MISSING
    """Load on the mode by a unit acceleration of the base. In √kg."""
    roll_per_m_sqrt_kg: float | tuple[float, ...] = MISSING
    """Roll of the dimple; 0 in a mode that bends. In 1/(m √kg)."""
    slope_per_m_sqrt_kg: float | tuple[float, ...] = MISSING
    """Slope dw/dx at the dimple, x from root to tip. In 1/(m √kg)."""
    vertical_per_sqrt_kg: float | tuple[float, ...] = MISSING
    """Displacement z of the dimple, of unit modal mass. In 1/√kg."""


@dataclass(frozen=True)
class SuspensionRayleigh:
    """Settings `suspension.rayleigh`."""

    alpha_per_s: float | tuple[float, ...] | None = None
    """Rayleigh damping in place of damping_ratio: share of the mass matrix. In 1/s. Absent: damping_ratio."""
    beta_s: float | tuple[float, ...] | None = None
    """Its share of the stiffness matrix. In s. Absent: 0."""


@dataclass(frozen=True)
class Suspension:
    """Settings `suspension`."""

    damping_ratio: float | tuple[float, ...] = MISSING
    """Damping ratio of every mode of the suspension."""
    dimple: SuspensionDimple = field(default_factory=SuspensionDimple)
    """Settings `suspension.dimple`."""
    flange: SuspensionFlange = field(default_factory=SuspensionFlange)
    """Settings `suspension.flange`."""
    flexure: SuspensionFlexure = field(default_factory=SuspensionFlexure)
    """Settings `suspension.flexure`."""
    gimbal: SuspensionGimbal = field(default_factory=SuspensionGimbal)
    """Settings `suspension.gimbal`."""
    gram_load_gf: float | tuple[float, ...] = MISSING
    """Load at the slider's centre. In gram-force."""
    hinge: SuspensionHinge = field(default_factory=SuspensionHinge)
    """Settings `suspension.hinge`."""
    imported: SuspensionImported | None = None
    """Settings `suspension.imported`."""
    lift_tab: SuspensionLiftTab | None = None
    """Settings `suspension.lift_tab`."""
    limiters: SuspensionLimiters | None = None
    """Settings `suspension.limiters`."""
    load_beam: SuspensionLoadBeam = field(default_factory=SuspensionLoadBeam)
    """Settings `suspension.load_beam`."""
    material: SuspensionMaterial = field(default_factory=SuspensionMaterial)
    """Settings `suspension.material`."""
    modes: tuple[SuspensionModes, ...] = ()
    """Modes of the suspension on its base, in place of its geometry. Absent: a suspension by its geometry."""
    rayleigh: SuspensionRayleigh | None = None
    """Settings `suspension.rayleigh`."""


@dataclass(frozen=True)
class Study:
    """Settings of a study."""

    asperity_contact: AsperityContact | None = None
    """Settings `asperity_contact`."""
    base: Base | None = None
    """Settings `base`."""
    disk: Disk = field(default_factory=Disk)
    """Settings `disk`."""
    failure: Failure = field(default_factory=Failure)
    """Settings `failure`."""
    fields: Fields | None = None
    """Settings `fields`."""
    gas: Gas = field(default_factory=Gas)
    """Settings `gas`."""
    head: str | None = None
    """Of several heads the one that is simulated. Absent: every head."""
    heads: tuple[Heads, ...] = ()
    """Heads of a drive, each with its slider, suspension, disk and gap of the ramp: an axis of the study. What an entry leaves out is the study's. Absent: one head."""
    hub: Hub | None = None
    """Settings `hub`."""
    name: str = MISSING
    """Name of the study, printed on every product."""
    output: Output = field(default_factory=Output)
    """Settings `output`."""
    outputs: tuple[str, ...] = MISSING
    """What is wanted; only the effects these need are simulated."""
    pulse: Pulse = field(default_factory=Pulse)
    """Settings `pulse`."""
    ramp: Ramp = field(default_factory=Ramp)
    """Settings `ramp`."""
    resolution: Resolution = field(default_factory=Resolution)
    """Settings `resolution`."""
    search: Search = field(default_factory=Search)
    """Settings `search`."""
    slider: Slider = field(default_factory=Slider)
    """Settings `slider`."""
    solver: Solver = field(default_factory=Solver)
    """Settings `solver`."""
    surface_forces: SurfaceForces | None = None
    """Settings `surface_forces`."""
    suspension: Suspension = field(default_factory=Suspension)
    """Settings `suspension`."""
