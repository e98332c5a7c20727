//! The words of a study as types.

use opshock_solver::scene::accuracy::Rung;

/// Which ramp stands at the rim. The order is the canonical one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Ramp {
    /// No ramp.
    None,
    /// Fixed contact points.
    Rigid,
    /// Flexible arms.
    Deformable,
}

impl Ramp {
    /// All, in canonical order.
    pub const ALL: [Self; 3] = [Self::None, Self::Rigid, Self::Deformable];

    /// The word in study files and tables.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Rigid => "rigid",
            Self::Deformable => "deformable",
        }
    }

    /// The ramp of a word.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|ramp| ramp.as_str() == word)
    }
}

impl std::fmt::Display for Ramp {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.as_str())
    }
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
    /// The way of a word; a head faces down where nothing is said.
    pub fn from_word(word: &str) -> Self {
        match word {
            "up" => Self::Up,
            _ => Self::Down,
        }
    }

    /// Sign of the drive's axis along the head's, which points from the disk to the head.
    pub fn factor(self) -> f64 {
        match self {
            Self::Down => 1.0,
            Self::Up => -1.0,
        }
    }
}

/// Sign of a shock: plus moves the disk first towards a slider that faces down, over it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Sign {
    /// +
    Plus,
    /// -
    Minus,
}

impl Sign {
    /// Both, in canonical order.
    pub const ALL: [Self; 2] = [Self::Plus, Self::Minus];

    /// The word in study files and tables.
    pub fn as_str(self) -> &'static str {
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

/// How far the evidence below the lowest failure reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Certify {
    /// No scan.
    Off,
    /// Scan with growing gaps.
    Staggered,
    /// Every lattice amplitude.
    Full,
}

impl Certify {
    /// The word in study files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Staggered => "staggered",
            Self::Full => "full",
        }
    }

    pub(super) fn from_word(word: &str) -> Self {
        match word {
            "off" => Self::Off,
            "full" => Self::Full,
            _ => Self::Staggered,
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
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Full => "full",
        }
    }
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
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Bracket => "bracket",
            Self::None => "none",
            Self::All => "all",
        }
    }
}

/// Rung of a word.
pub(super) fn rung(word: &str) -> Rung {
    match word {
        "5%" => Rung::FivePercent,
        "0.1%" => Rung::TenthPercent,
        _ => Rung::OnePercent,
    }
}

/// Word of a rung.
pub fn rung_word(rung: Rung) -> &'static str {
    match rung {
        Rung::FivePercent => "5%",
        Rung::OnePercent => "1%",
        Rung::TenthPercent => "0.1%",
    }
}

/// Word of a coupling scheme.
pub fn coupling_word(coupling: opshock_solver::scene::Coupling) -> &'static str {
    use opshock_solver::scene::Coupling;
    match coupling {
        Coupling::Monolithic => "monolithic",
        Coupling::FixedPoint => "fixed_point",
        Coupling::Aitken => "aitken",
        Coupling::Anderson => "anderson",
    }
}
