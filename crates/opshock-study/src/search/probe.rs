//! A probe: one simulation that the search requests, and its answer.
//!
//! The verdict has three values and is never the sign of a stored number: a clearance that is not a number decides
//! nothing.

use opshock_solver::scene::discretisation::Levels;
use serde::Serialize;

/// Sign of a shock: plus moves the disk first towards a slider that faces down, over it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub enum Sign {
    /// Inertia load along +z.
    #[serde(rename = "+")]
    Plus,
    /// The disk first moves away from such a slider.
    #[serde(rename = "-")]
    Minus,
}

impl Sign {
    /// Both, in canonical order.
    pub const ALL: [Self; 2] = [Self::Plus, Self::Minus];

    /// Word in study files and tables.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Plus => "+",
            Self::Minus => "-",
        }
    }

    /// The sign of a word.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|sign| sign.as_str() == word)
    }

    /// 1 or -1.
    pub fn factor(self) -> f64 {
        match self {
            Self::Plus => 1.0,
            Self::Minus => -1.0,
        }
    }
}

impl std::fmt::Display for Sign {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.as_str())
    }
}

/// How the run is made when the plain run has no verdict; tried in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Retry {
    /// As the study says.
    #[default]
    None,
    /// Half the steps (structure and head).
    HalfStep,
    /// A quarter of the steps.
    QuarterStep,
    /// The other coupling of film and slider, at the study's steps.
    OtherCoupling,
    /// The other contact method of disk and ramp, at the study's steps.
    OtherContact,
}

impl Retry {
    /// All retries in the order tried.
    pub const ALL: [Retry; 5] = [
        Retry::None,
        Retry::HalfStep,
        Retry::QuarterStep,
        Retry::OtherCoupling,
        Retry::OtherContact,
    ];

    /// Place in that order, 0 is the plain run.
    pub fn place(self) -> u8 {
        self as u8
    }

    /// The retry of a place, `None` beyond the last.
    pub fn from_place(place: u8) -> Option<Retry> {
        Self::ALL.get(usize::from(place)).copied()
    }

    /// The next thing to try.
    pub fn next(self) -> Option<Retry> {
        Self::from_place(self.place() + 1)
    }

    /// Label in output files.
    pub fn label(self) -> &'static str {
        match self {
            Retry::None => "",
            Retry::HalfStep => "dt/2",
            Retry::QuarterStep => "dt/4",
            Retry::OtherCoupling => "other_coupling",
            Retry::OtherContact => "other_contact",
        }
    }
}

/// One simulation requested: a point of the amplitude grid and how to run it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Probe {
    /// Point of the amplitude grid, of the uncertainty interval's when `is_fine`.
    pub index: i32,
    /// The run belongs to an uncertainty interval, whose grid is [`super::uncertainty::SUBDIVISIONS`] times as fine.
    pub is_fine: bool,
    /// Refinement levels relative to the study's resolution.
    pub levels: Levels,
    /// Multiple of the study's window simulated: 1, or 2 for the window check.
    pub window_factor: u8,
    /// How the run is made.
    pub retry: Retry,
}

impl Probe {
    /// A plain probe of a grid point.
    pub fn at(index: i32) -> Probe {
        Probe {
            index,
            is_fine: false,
            levels: Levels::NONE,
            window_factor: 1,
            retry: Retry::None,
        }
    }
}

/// Purpose of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Looking for a bracket from the starting amplitude.
    Bracketing,
    /// Halving the bracket.
    Bisect,
    /// Looking for lower failures.
    Scan,
    /// A lower failure of a neighbouring width, or of a smaller clearance called failure.
    FollowUp,
    /// An end of the bracket whose verdict is known from a smaller clearance called failure.
    OwnRun,
    /// The highest survivor in a doubled window.
    Window,
    /// What a discretisation parameter changes, for the uncertainty interval.
    Uncertainty,
}

impl Purpose {
    /// Name in output files.
    pub fn as_str(self) -> &'static str {
        match self {
            Purpose::Bracketing => "bracketing",
            Purpose::Bisect => "bisect",
            Purpose::Scan => "scan",
            Purpose::FollowUp => "follow_up",
            Purpose::OwnRun => "own_run",
            Purpose::Window => "window",
            Purpose::Uncertainty => "uncertainty",
        }
    }

    /// Reads the word back.
    pub fn parse(text: &str) -> Option<Purpose> {
        [
            Purpose::Bracketing,
            Purpose::Bisect,
            Purpose::Scan,
            Purpose::FollowUp,
            Purpose::OwnRun,
            Purpose::Window,
            Purpose::Uncertainty,
        ]
        .into_iter()
        .find(|purpose| purpose.as_str() == text)
    }
}

/// Survives, fails or undecided; nothing else, and never derived from a clearance.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// No failure within the window.
    Survives,
    /// Failed.
    Fails {
        /// Time of touch after the onset, s.
        t_fail_s: f64,
        /// Place on the slider from its leading edge, m.
        x_m: f64,
        /// Place on the slider from its inner edge, m.
        y_m: f64,
    },
    /// No answer.
    Undecided {
        /// Why, as a stable word.
        cause: UndecidedCause,
        /// A sentence with numbers.
        message: String,
    },
}

impl Verdict {
    /// `survives`, `fails`, `undecided`.
    pub fn as_str(&self) -> &'static str {
        match self {
            Verdict::Survives => "survives",
            Verdict::Fails { .. } => "fails",
            Verdict::Undecided { .. } => "undecided",
        }
    }
}

/// Cause of a run without verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum UndecidedCause {
    /// The coupled solve did not converge at the smallest step.
    NotConverged,
    /// The step limit of the study was reached.
    StepLimit,
    /// A number that is not finite appeared.
    NotFinite,
    /// The simulation panicked.
    Panicked,
    /// The scene could not be built or has no steady flying state.
    NotBuilt,
}

impl UndecidedCause {
    const ALL: [UndecidedCause; 5] = [
        UndecidedCause::NotConverged,
        UndecidedCause::StepLimit,
        UndecidedCause::NotFinite,
        UndecidedCause::Panicked,
        UndecidedCause::NotBuilt,
    ];

    /// Name in output files.
    pub fn as_str(self) -> &'static str {
        match self {
            UndecidedCause::NotConverged => "not_converged",
            UndecidedCause::StepLimit => "step_limit",
            UndecidedCause::NotFinite => "not_finite",
            UndecidedCause::Panicked => "panicked",
            UndecidedCause::NotBuilt => "not_built",
        }
    }

    /// Reads the word back.
    pub fn parse(text: &str) -> Option<UndecidedCause> {
        Self::ALL.into_iter().find(|cause| cause.as_str() == text)
    }
}

/// Work of a run in numbers that do not depend on the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RunCost {
    /// Accepted head steps.
    pub steps: u64,
    /// Rejected head steps.
    pub rejected: u64,
    /// Film linear solves.
    pub film_solves: u64,
    /// Film factorisations.
    pub factorisations: u64,
    /// Structure steps.
    pub structure_steps: u64,
    /// Film unknowns.
    pub film_unknowns: u64,
}

impl RunCost {
    /// Adds the work of another run; unknowns keep the larger.
    pub fn add(&mut self, other: &RunCost) {
        self.steps += other.steps;
        self.rejected += other.rejected;
        self.film_solves += other.film_solves;
        self.factorisations += other.factorisations;
        self.structure_steps += other.structure_steps;
        self.film_unknowns = self.film_unknowns.max(other.film_unknowns);
    }
}

/// Result of a simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct ProbeResult {
    /// Verdict.
    pub verdict: Verdict,
    /// Smallest clearance, m; absent when there is none (never NaN).
    pub h_min_m: Option<f64>,
    /// Its time after the onset, s.
    pub t_min_s: Option<f64>,
    /// Work.
    pub cost: RunCost,
}
