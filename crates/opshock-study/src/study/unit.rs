//! Converts a number from the unit in its key's name into SI; the only place that does.
//!
//! The unit of a number stands in the name of its key: the longest suffix of [`UNITS`] the key
//! ends with (`clearance_um`, `youngs_modulus_gpa`, `rpm`). A suffix is only recognised after an
//! underscore or as the whole key, so `beta_s` is seconds and `skew_deg` degrees. Suffixes marked
//! as not in use are recognised to explain a mistake, never accepted.

use opshock_solver::quantity;

/// What a unit measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Time.
    Time,
    /// Acceleration.
    Acceleration,
    /// Force.
    Force,
    /// Length.
    Length,
    /// Frequency.
    Frequency,
    /// Speed of rotation.
    RotationSpeed,
    /// Pressure or modulus.
    Pressure,
    /// Mass.
    Mass,
    /// Stiffness.
    Stiffness,
    /// Rotational stiffness.
    RotationalStiffness,
    /// Moment of inertia.
    Inertia,
    /// Damping.
    Damping,
    /// Rotational damping.
    RotationalDamping,
    /// Curvature: angular per linear acceleration.
    PerLength,
    /// Angle.
    Angle,
    /// Share in percent.
    Percentage,
    /// Rate.
    Rate,
    /// Density.
    Density,
    /// Temperature.
    Temperature,
    /// Dynamic viscosity.
    Viscosity,
    /// Root of a mass: load on a mode of unit mass.
    ModalMass,
    /// Inverse of it: shape of a mode of unit mass.
    ModalShape,
    /// Slope of such a shape.
    ModalSlope,
    /// Energy.
    Energy,
    /// Energy times the sixth power of a length.
    Repulsion,
    /// Electric potential.
    Potential,
    /// Number per area.
    PerArea,
}

impl Dimension {
    /// Name used in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Acceleration => "acceleration",
            Self::Force => "force",
            Self::Length => "length",
            Self::Frequency => "frequency",
            Self::RotationSpeed => "speed of rotation",
            Self::Pressure => "pressure",
            Self::Mass => "mass",
            Self::Stiffness => "stiffness",
            Self::RotationalStiffness => "rotational stiffness",
            Self::Inertia => "moment of inertia",
            Self::Damping => "damping",
            Self::RotationalDamping => "rotational damping",
            Self::PerLength => "angular per linear acceleration",
            Self::Angle => "angle",
            Self::Percentage => "share",
            Self::Rate => "rate",
            Self::Density => "density",
            Self::Temperature => "temperature",
            Self::Viscosity => "viscosity",
            Self::ModalMass => "root of a mass",
            Self::ModalShape => "inverse root of a mass",
            Self::ModalSlope => "inverse root of a mass by a length",
            Self::Energy => "energy",
            Self::Repulsion => "energy times a length to the sixth",
            Self::Potential => "potential",
            Self::PerArea => "number per area",
        }
    }
}

/// A unit a key can end with.
#[derive(Clone, Copy, Debug)]
pub struct Unit {
    /// Suffix, without the underscore before it.
    pub suffix: &'static str,
    /// How people write it.
    pub symbol: &'static str,
    /// What it measures.
    pub dimension: Dimension,
    /// Conversion into SI.
    pub to_si: fn(f64) -> f64,
    /// Whether study files use it.
    pub in_use: bool,
}

const fn unit(
    suffix: &'static str,
    symbol: &'static str,
    dimension: Dimension,
    to_si: fn(f64) -> f64,
) -> Unit {
    Unit {
        suffix,
        symbol,
        dimension,
        to_si,
        in_use: true,
    }
}

const fn foreign(suffix: &'static str, symbol: &'static str, dimension: Dimension) -> Unit {
    Unit {
        suffix,
        symbol,
        dimension,
        to_si: same,
        in_use: false,
    }
}

fn same(value: f64) -> f64 {
    value
}

/// Every suffix, accepted or merely recognised.
pub static UNITS: &[Unit] = &[
    unit("s", "s", Dimension::Time, same),
    unit("ms", "ms", Dimension::Time, quantity::s_from_ms),
    unit("us", "µs", Dimension::Time, quantity::s_from_us),
    unit(
        "g",
        "g0 (9.80665 m/s²)",
        Dimension::Acceleration,
        quantity::m_per_s2_from_g,
    ),
    unit("gf", "gram-force", Dimension::Force, quantity::n_from_gf),
    unit("m", "m", Dimension::Length, same),
    unit("mm", "mm", Dimension::Length, quantity::m_from_mm),
    unit("um", "µm", Dimension::Length, quantity::m_from_um),
    unit("nm", "nm", Dimension::Length, quantity::m_from_nm),
    unit("hz", "Hz", Dimension::Frequency, same),
    unit("khz", "kHz", Dimension::Frequency, quantity::hz_from_khz),
    unit(
        "rpm",
        "rev/min",
        Dimension::RotationSpeed,
        quantity::rad_per_s_from_rpm,
    ),
    unit("pa", "Pa", Dimension::Pressure, same),
    unit("gpa", "GPa", Dimension::Pressure, quantity::pa_from_gpa),
    unit("kg", "kg", Dimension::Mass, same),
    unit("mg", "mg", Dimension::Mass, quantity::kg_from_mg),
    unit("sqrt_kg", "√kg", Dimension::ModalMass, same),
    unit("per_sqrt_kg", "1/√kg", Dimension::ModalShape, same),
    unit("per_m_sqrt_kg", "1/(m √kg)", Dimension::ModalSlope, same),
    unit("n_per_m", "N/m", Dimension::Stiffness, same),
    unit(
        "n_m_per_rad",
        "N m/rad",
        Dimension::RotationalStiffness,
        same,
    ),
    unit(
        "mg_mm2",
        "mg mm²",
        Dimension::Inertia,
        quantity::kg_m2_from_mg_mm2,
    ),
    unit("n_s_per_m", "N s/m", Dimension::Damping, same),
    unit(
        "n_m_s_per_rad",
        "N m s/rad",
        Dimension::RotationalDamping,
        same,
    ),
    unit("deg", "°", Dimension::Angle, quantity::rad_from_deg),
    unit("urad", "µrad", Dimension::Angle, quantity::rad_from_urad),
    unit("pct", "%", Dimension::Percentage, quantity::share_from_pct),
    unit("per_m", "1/m", Dimension::PerLength, same),
    unit("per_s", "1/s", Dimension::Rate, same),
    unit("kg_per_m3", "kg/m³", Dimension::Density, same),
    unit("c", "°C", Dimension::Temperature, quantity::k_from_c),
    unit("pa_s", "Pa s", Dimension::Viscosity, same),
    unit("j", "J", Dimension::Energy, same),
    unit("j_m6", "J m⁶", Dimension::Repulsion, same),
    unit("v", "V", Dimension::Potential, same),
    unit(
        "per_um2",
        "1/µm²",
        Dimension::PerArea,
        quantity::per_m2_from_per_um2,
    ),
    foreign("ns", "ns", Dimension::Time),
    foreign("min", "min", Dimension::Time),
    foreign("m_per_s2", "m/s²", Dimension::Acceleration),
    foreign("n", "N", Dimension::Force),
    foreign("mn", "mN", Dimension::Force),
    foreign("km", "km", Dimension::Length),
    foreign("cm", "cm", Dimension::Length),
    foreign("in", "inch", Dimension::Length),
    foreign("inch", "inch", Dimension::Length),
    foreign("mhz", "MHz", Dimension::Frequency),
    foreign("rad_per_s", "rad/s", Dimension::RotationSpeed),
    foreign("kpa", "kPa", Dimension::Pressure),
    foreign("mpa", "MPa", Dimension::Pressure),
    foreign("bar", "bar", Dimension::Pressure),
    foreign("n_per_mm", "N/mm", Dimension::Stiffness),
    foreign("rad", "rad", Dimension::Angle),
    foreign("mrad", "mrad", Dimension::Angle),
    foreign("g_per_cm3", "g/cm³", Dimension::Density),
    foreign("k", "K", Dimension::Temperature),
    foreign("f", "°F", Dimension::Temperature),
];

/// A key's name taken apart: what it names, and in which unit.
#[derive(Clone, Copy, Debug)]
pub struct Parted<'a> {
    /// Name without unit and underscore; empty when the whole key is a unit.
    pub stem: &'a str,
    /// Unit, as far as the suffix is known in any case.
    pub unit: Option<&'static Unit>,
    /// Whether the suffix is spelt in another case than the unit's.
    pub other_case: bool,
}

/// Takes the name of one key apart. The longest suffix wins; upper case is recognised.
pub fn part(name: &str) -> Parted<'_> {
    // The whole name, then what follows each underscore: the longest first.
    let starts = std::iter::once(0).chain(name.match_indices('_').map(|(at, _)| at + 1));
    let best = starts.map(|from| &name[from..]).find_map(|end| {
        UNITS
            .iter()
            .find(|unit| unit.suffix.eq_ignore_ascii_case(end))
    });
    match best {
        None => Parted {
            stem: name,
            unit: None,
            other_case: false,
        },
        Some(unit) => {
            let cut = name.len() - unit.suffix.len();
            Parted {
                stem: name[..cut].strip_suffix('_').unwrap_or(&name[..cut]),
                unit: Some(unit),
                other_case: name[cut..] != *unit.suffix,
            }
        }
    }
}

/// Unit of the key at a dotted path: of its last name, or of the nearest name above it that has
/// one (`search.amplitude_g.min` is in g).
pub fn of_path(path: &str) -> Option<&'static Unit> {
    path.rsplit('.')
        .map(|name| part(name.split('[').next().unwrap_or(name)))
        .find_map(|parted| parted.unit.filter(|unit| unit.in_use && !parted.other_case))
}

/// The number at `path`, converted into SI. Keys without a unit are dimensionless.
pub fn si(path: &str, value: f64) -> f64 {
    match of_path(path) {
        Some(unit) => (unit.to_si)(value),
        None => value,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_converts_one_into_its_si_value() {
        let expected = [
            ("t_s", 1.0),
            ("t_ms", 1e-3),
            ("t_us", 1e-6),
            ("a_g", 9.80665),
            ("f_gf", 9.80665e-3),
            ("l_m", 1.0),
            ("l_mm", 1e-3),
            ("l_um", 1e-6),
            ("l_nm", 1e-9),
            ("f_hz", 1.0),
            ("f_khz", 1e3),
            ("rpm", std::f64::consts::TAU / 60.0),
            ("p_pa", 1.0),
            ("p_gpa", 1e9),
            ("m_kg", 1.0),
            ("m_mg", 1e-6),
            ("p_sqrt_kg", 1.0),
            ("s_per_sqrt_kg", 1.0),
            ("s_per_m_sqrt_kg", 1.0),
            ("k_n_per_m", 1.0),
            ("k_n_m_per_rad", 1.0),
            ("j_mg_mm2", 1e-12),
            ("c_n_s_per_m", 1.0),
            ("c_n_m_s_per_rad", 1.0),
            ("r_per_m", 1.0),
            ("a_j", 1.0),
            ("b_j_m6", 1.0),
            ("n_per_um2", 1e12),
            ("u_v", 1.0),
            ("a_deg", std::f64::consts::PI / 180.0),
            ("a_urad", 1e-6),
            ("s_pct", 1e-2),
            ("r_per_s", 1.0),
            ("d_kg_per_m3", 1.0),
            ("t_c", 274.15),
            ("v_pa_s", 1.0),
        ];
        for (key, value) in expected {
            assert_eq!(si(key, 1.0), value, "{key}");
        }
        assert_eq!(
            expected.len(),
            UNITS.iter().filter(|unit| unit.in_use).count()
        );
    }

    #[test]
    fn decimal_units_give_the_double_nearest_to_the_decimal_value() {
        assert_eq!(si("thickness_mm", 0.635), 0.000635);
        assert_eq!(si("web_um", 26.9), 26.9e-6);
        assert_eq!(si("min_film_height_nm", 0.3), 0.3e-9);
        assert_eq!(si("mass_mg", 57.9), 57.9e-6);
        assert_eq!(si("tolerance_pct", 1.0), 0.01);
    }

    #[test]
    fn the_longest_suffix_wins_and_needs_an_underscore() {
        assert_eq!(part("viscosity_pa_s").unit.unwrap().suffix, "pa_s");
        assert_eq!(part("vertical_n_per_m").unit.unwrap().suffix, "n_per_m");
        assert_eq!(part("clearance_top_um").stem, "clearance_top");
        assert!(part("participation").unit.is_none());
        assert!(part("models").unit.is_none());
        assert!(part("widths_Ms").other_case);
        assert_eq!(of_path("search.amplitude_g.min").unwrap().suffix, "g");
        assert_eq!(
            of_path("ramp.deformable.modes[1].mass_mg").unwrap().suffix,
            "mg"
        );
    }
}
