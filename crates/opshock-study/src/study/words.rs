//! Gives each word that a study file may hold its value.
//!
//! Each list of words stands once, with the value of each: the table of keys takes the words from here ([`names`]),
//! [`Field`](super::field::Field) the values. So every word has a value, and every value that is printed a word.

use crate::search::{MonotonicityScan, Ramp, Sign};
use opshock_solver::air_bearing::FlowModel;
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;
use opshock_solver::scene::Coupling;
use opshock_solver::scene::discretisation::Discretisation;
use opshock_solver::scene::plan::{Needs, Output};
use opshock_solver::scene::preset::Preset;

/// The words of a list.
pub const fn names<T, const N: usize>(list: &[(&'static str, T); N]) -> [&'static str; N] {
    let mut names = [""; N];
    let mut at = 0;
    while at < N {
        names[at] = list[at].0;
        at += 1;
    }
    names
}

/// Every value of a list with its word.
macro_rules! worded {
    ($all:expr) => {{
        let mut list = [("", $all[0]); $all.len()];
        let mut at = 0;
        while at < list.len() {
            list[at] = ($all[at].as_str(), $all[at]);
            at += 1;
        }
        list
    }};
}

/// `ramp.models`, in canonical order.
pub const RAMPS: [(&str, Ramp); 3] = worded!(Ramp::ALL);
/// `pulse.signs`, in canonical order.
pub const SIGNS: [(&str, Sign); 2] = worded!(Sign::ALL);
/// `outputs`.
pub const OUTPUTS: [(&str, Output); 13] = worded!(Output::ALL);
/// `solver.leave_out`.
pub const LEAVE_OUT: [(&str, LeftOut); 1] = [("air_bearing", LeftOut::AirBearing)];
/// `resolution.not_refined`: discretisation parameters of a scene.
pub const DISCRETISATION: [(&str, Discretisation); 6] = worded!([
    Discretisation::FilmGrid,
    Discretisation::DiskModes,
    Discretisation::SuspensionModes,
    Discretisation::StructureStep,
    Discretisation::HeadTolerance,
    Discretisation::CouplingTolerance,
]);
/// Named materials of a ramp.
pub const RAMP_MATERIALS: &[&str] = &["POM", "LCP", "PEEK", "PEI", "PPS", "aluminium", "steel"];
/// Named surfaces.
pub const SURFACES: &[&str] = &["femto-2.5in"];

/// `pulse.shape`.
pub const SHAPES: [(&str, Shape); 6] = [
    ("half_sine", Shape::HalfSine),
    ("haversine", Shape::Haversine),
    ("square", Shape::Square),
    ("trapezoid", Shape::Trapezoid),
    ("damped_sine", Shape::DampedSine),
    ("table", Shape::Table),
];
/// `pulse.table_scale`.
pub const TABLE_SCALES: [(&str, TableScale); 2] = [
    ("measured", TableScale::Measured),
    ("stretched", TableScale::Stretched),
];
/// `pulse.table_time_unit`, in ms.
pub const TIME_UNITS: [(&str, TimeUnit); 3] = [
    ("s", TimeUnit { ms: 1e3 }),
    ("ms", TimeUnit { ms: 1.0 }),
    ("us", TimeUnit { ms: 1e-3 }),
];
/// `pulse.table_acceleration_unit`, in G.
pub const ACCELERATION_UNITS: [(&str, AccelerationUnit); 2] = [
    ("g", AccelerationUnit { g: 1.0 }),
    (
        "m_per_s2",
        AccelerationUnit {
            g: 1.0 / STANDARD_GRAVITY_M_PER_S2,
        },
    ),
];
/// `pulse.table_offset`.
pub const TABLE_OFFSETS: [(&str, TableOffset); 2] = [
    ("mean_before", TableOffset::MeanBefore),
    ("line_outside", TableOffset::LineOutside),
];
/// `pulse.table_filter`.
pub const FILTER_CLASSES: [(&str, FilterClass); 4] = [
    ("cfc_60", FilterClass(60)),
    ("cfc_180", FilterClass(180)),
    ("cfc_600", FilterClass(600)),
    ("cfc_1000", FilterClass(1000)),
];
/// Units of length of a ramp's mesh, in m; the first is the default.
pub const LENGTH_UNITS: [(&str, LengthUnit); 4] = [
    ("mm", LengthUnit { metres: 1e-3 }),
    ("um", LengthUnit { metres: 1e-6 }),
    ("m", LengthUnit { metres: 1.0 }),
    ("inch", LengthUnit { metres: 0.0254 }),
];
/// `gas.model`.
pub const FLOWS: [(&str, FlowModel); 4] = [
    ("fukui_kaneko", FlowModel::FukuiKaneko),
    ("continuum", FlowModel::Continuum),
    ("slip_1", FlowModel::Slip1),
    ("slip_2", FlowModel::Slip2),
];
/// `solver.coupling`.
pub const COUPLINGS: [(&str, Coupling); 4] = [
    (coupling_word(Coupling::Monolithic), Coupling::Monolithic),
    (coupling_word(Coupling::FixedPoint), Coupling::FixedPoint),
    (coupling_word(Coupling::Aitken), Coupling::Aitken),
    (coupling_word(Coupling::Anderson), Coupling::Anderson),
];
/// `resolution.preset`.
pub const PRESETS: [(&str, Preset); 3] = [
    (preset_word(Preset::Coarse), Preset::Coarse),
    (preset_word(Preset::Standard), Preset::Standard),
    (preset_word(Preset::Fine), Preset::Fine),
];
/// `slider.faces`.
pub const FACES: [(&str, Faces); 2] = [("down", Faces::Down), ("up", Faces::Up)];
/// `failure.criterion`.
pub const CRITERIA: [(&str, Criterion); 2] =
    [("touch", Criterion::Touch), ("damage", Criterion::Damage)];
/// `search.monotonicity_scan`.
pub const MONOTONICITY_SCAN: [(&str, MonotonicityScan); 3] = [
    (
        MonotonicityScan::Sampled.as_str(),
        MonotonicityScan::Sampled,
    ),
    (MonotonicityScan::Off.as_str(), MonotonicityScan::Off),
    (MonotonicityScan::Full.as_str(), MonotonicityScan::Full),
];
/// `search.uncertainty_of`.
pub const UNCERTAINTY_OF: [(&str, UncertaintyOf); 2] = [
    ("all", UncertaintyOf::All),
    ("decisive", UncertaintyOf::Decisive),
];
/// `solver.effects`.
pub const EFFECTS: [(&str, Effects); 2] = [
    (Effects::Auto.as_str(), Effects::Auto),
    (Effects::Full.as_str(), Effects::Full),
];
/// `output.keep_histories`.
pub const KEEP_HISTORIES: [(&str, KeepHistories); 3] = [
    (KeepHistories::Bracket.as_str(), KeepHistories::Bracket),
    (KeepHistories::None.as_str(), KeepHistories::None),
    (KeepHistories::All.as_str(), KeepHistories::All),
];
/// `ramp.run_out`.
pub const RUN_OUT: [(&str, RunOut); 2] =
    [("none", RunOut::None), ("lowest_gap", RunOut::LowestGap)];
/// `slider.surface.rail[].kind`.
pub const RAIL_KINDS: [(&str, RailKind); 2] = [
    ("rect", RailKind::Rectangle),
    ("polygon", RailKind::Polygon),
];

/// Unit of length of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LengthUnit {
    /// Its length, m.
    pub metres: f64,
}

/// What the run-out of the disk takes of the ramp's gaps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunOut {
    /// Nothing.
    None,
    /// Its amplitude at the ramp: the lowest gap of a revolution.
    LowestGap,
}

/// Shape of a rail's outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RailKind {
    /// Along the slider's axes.
    Rectangle,
    /// By its corners.
    Polygon,
}

/// Shape of the acceleration pulse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// sin(pi t/T).
    HalfSine,
    /// sin^2(pi t/T).
    Haversine,
    /// 1.
    Square,
    /// With linear flanks.
    Trapezoid,
    /// A decaying oscillation.
    DampedSine,
    /// Through points.
    Table,
}

/// What becomes of the time of a sampled pulse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableScale {
    /// It stays: the pulse has one width, its own.
    Measured,
    /// It is stretched to every width of the study.
    Stretched,
}

/// A unit of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeUnit {
    /// In ms.
    pub ms: f64,
}

/// A unit of acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AccelerationUnit {
    /// In G.
    pub g: f64,
}

/// Zero line of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableOffset {
    /// Mean of the samples before the pulse.
    MeanBefore,
    /// Straight line through the samples before and after the pulse.
    LineOutside,
}

/// Channel frequency class of SAE J211.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FilterClass(pub u32);

/// What is called failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// The first touch of slider and disk.
    Touch,
    /// The first contact that exceeds a limit of damage.
    Damage,
}

/// The way a head faces: down over its disk, up under it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Faces {
    /// Over the disk.
    #[default]
    Down,
    /// Under the disk.
    Up,
}

impl Faces {
    /// Sign of the drive's axis along the head's, which points from the disk to the head.
    pub fn factor(self) -> f64 {
        match self {
            Self::Down => 1.0,
            Self::Up => -1.0,
        }
    }
}

/// Whether only the needed effects are simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effects {
    /// Only what the outputs need.
    Auto,
    /// Everything.
    Full,
}

impl Effects {
    /// The word in study files.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Full => "full",
        }
    }
}

/// Words of the outputs that disk and ramp alone give.
pub fn structure_outputs() -> String {
    let of_structure = |output: &Output| output.needs() == Needs::Structure;
    let words: Vec<&str> = Output::ALL
        .into_iter()
        .filter(of_structure)
        .map(Output::as_str)
        .collect();
    words.join(", ")
}

/// An effect that a study may leave out by hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeftOut {
    /// Film, slider and suspension.
    AirBearing,
}

/// Which points get uncertainty intervals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UncertaintyOf {
    /// Every one.
    All,
    /// Those on which the answer of the study depends ([`crate::search::decisive`]).
    Decisive,
}

/// Which time histories are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeepHistories {
    /// Those of the highest survivor and the lowest failure.
    Bracket,
    /// None.
    None,
    /// All.
    All,
}

impl KeepHistories {
    /// The word in study files.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Bracket => "bracket",
            Self::None => "none",
            Self::All => "all",
        }
    }
}

/// Word of a preset.
pub const fn preset_word(preset: Preset) -> &'static str {
    match preset {
        Preset::Coarse => "coarse",
        Preset::Standard => "standard",
        Preset::Fine => "fine",
    }
}

/// Word of a coupling scheme.
pub const fn coupling_word(coupling: Coupling) -> &'static str {
    match coupling {
        Coupling::Monolithic => "monolithic",
        Coupling::FixedPoint => "fixed_point",
        Coupling::Aitken => "aitken",
        Coupling::Anderson => "anderson",
    }
}
