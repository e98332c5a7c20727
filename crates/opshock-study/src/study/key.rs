//! What the table of keys says about one key: kind, range, presence, usual range, help.

/// One end of a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// No limit.
    Free,
    /// The limit itself is not allowed.
    Open(f64),
    /// The limit itself is allowed.
    Closed(f64),
}

/// Allowed range of a number, in the unit of its key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower end.
    pub low: Bound,
    /// Upper end.
    pub high: Bound,
}

/// > 0.
pub const ABOVE_ZERO: Range = Range {
    low: Bound::Open(0.0),
    high: Bound::Free,
};
/// >= 0.
pub const FROM_ZERO: Range = Range {
    low: Bound::Closed(0.0),
    high: Bound::Free,
};
/// Any finite number.
pub const ANY: Range = Range {
    low: Bound::Free,
    high: Bound::Free,
};

/// low <= x <= high.
pub const fn closed(low: f64, high: f64) -> Range {
    Range {
        low: Bound::Closed(low),
        high: Bound::Closed(high),
    }
}

/// low < x < high.
pub const fn open(low: f64, high: f64) -> Range {
    Range {
        low: Bound::Open(low),
        high: Bound::Open(high),
    }
}

/// low < x <= high.
pub const fn above(low: f64, high: f64) -> Range {
    Range {
        low: Bound::Open(low),
        high: Bound::Closed(high),
    }
}

/// low <= x < high.
pub const fn below(low: f64, high: f64) -> Range {
    Range {
        low: Bound::Closed(low),
        high: Bound::Open(high),
    }
}

impl Range {
    /// Whether a finite number lies inside.
    pub fn contains(self, value: f64) -> bool {
        let above = match self.low {
            Bound::Free => true,
            Bound::Open(limit) => value > limit,
            Bound::Closed(limit) => value >= limit,
        };
        let below = match self.high {
            Bound::Free => true,
            Bound::Open(limit) => value < limit,
            Bound::Closed(limit) => value <= limit,
        };
        above && below
    }
}

impl std::fmt::Display for Range {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let low = match self.low {
            Bound::Free => None,
            Bound::Open(limit) => Some(format!("> {limit}")),
            Bound::Closed(limit) => Some(format!(">= {limit}")),
        };
        let high = match self.high {
            Bound::Free => None,
            Bound::Open(limit) => Some(format!("< {limit}")),
            Bound::Closed(limit) => Some(format!("<= {limit}")),
        };
        match (low, high) {
            (None, None) => f.write_str("any finite number"),
            (Some(one), None) | (None, Some(one)) => f.write_str(&one),
            (Some(low), Some(high)) => write!(f, "{low} and {high}"),
        }
    }
}

/// What a key's value is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// One number.
    Number(Range),
    /// One number, or one of some words.
    NumberOrWord(Range, &'static [&'static str]),
    /// One whole number between two limits, both allowed.
    Integer(i64, i64),
    /// One of some words.
    Word(&'static [&'static str]),
    /// true or false.
    Flag,
    /// Free text.
    Text,
    /// A list of words out of some; one word alone is a list of one.
    Words(&'static [&'static str]),
    /// A list of numbers that is an axis by itself: a list, one number alone, or
    /// `{ from, to, count, spacing }`.
    Axis(Range),
    /// A plain list of numbers.
    Numbers(Range),
    /// Two numbers [from, to], from < to.
    Pair(Range),
    /// Corners [[x, y], ...].
    Points,
    /// A list of tables; its members are keys of their own, `path[].member`.
    Tables,
}

impl Kind {
    /// Whether one value is a single number or word, so that a list of them is an axis.
    pub fn is_single(self) -> bool {
        matches!(
            self,
            Self::Number(_)
                | Self::NumberOrWord(..)
                | Self::Integer(..)
                | Self::Word(_)
                | Self::Flag
        )
    }

    /// What a person should write.
    pub fn expected(self) -> &'static str {
        match self {
            Self::Number(_) => "a number",
            Self::NumberOrWord(..) => "a number or a word",
            Self::Integer(..) => "a whole number",
            Self::Word(_) => "a word in quotes",
            Self::Flag => "true or false",
            Self::Text => "text in quotes",
            Self::Words(_) => "a list of words",
            Self::Axis(_) => "a list of numbers or { from, to, count, spacing }",
            Self::Numbers(_) => "a list of numbers",
            Self::Pair(_) => "two numbers [from, to]",
            Self::Points => "a list of corners [[x, y], ...]",
            Self::Tables => "a list of tables [{ ... }, ...]",
        }
    }

    /// What is allowed, in words.
    pub fn allowed(self) -> String {
        match self {
            Self::Number(range) | Self::Axis(range) | Self::Numbers(range) | Self::Pair(range) => {
                range.to_string()
            }
            Self::NumberOrWord(range, words) => format!("{range}, or {}", quoted(words)),
            Self::Integer(low, high) if low == high => low.to_string(),
            Self::Integer(low, high) => format!("whole numbers {low} to {high}"),
            Self::Word(words) | Self::Words(words) => quoted(words),
            _ => self.expected().to_string(),
        }
    }
}

impl Kind {
    /// Kind and range together: what a value of another kind should have been.
    pub fn wanted(self) -> String {
        match self {
            Self::Number(_) | Self::Axis(_) | Self::Numbers(_) | Self::Pair(_) => {
                format!("{}, {}", self.expected(), self.allowed())
            }
            _ => self.allowed(),
        }
    }
}

/// The words, each in quotes, with commas between.
pub fn quoted(words: &[&str]) -> String {
    words
        .iter()
        .map(|word| format!("{word:?}"))
        .collect::<Vec<_>>()
        .join(", ")
}

/// Whether a key must be given, and what stands there when it is not. Literals are TOML.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Presence {
    /// Must be given (within a list of tables: in every entry).
    Required,
    /// This value when absent.
    Default(&'static str),
    /// This value when no key of the same choice is given; must be given when another key of its
    /// alternative is.
    Together(&'static str),
    /// May be absent; the text says what that means.
    Optional(&'static str),
    /// Set by `resolution.preset` when absent.
    ByPreset,
}

/// One key of the study file.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Dotted path; `[]` stands behind the name of a list of tables.
    pub path: &'static str,
    /// Kind of value.
    pub kind: Kind,
    /// Presence.
    pub presence: Presence,
    /// Usual range: outside of it the value is questioned (W201).
    pub usual: Option<(f64, f64)>,
    /// Code of the error for a value out of range.
    pub code: &'static str,
    /// One sentence.
    pub help: &'static str,
    /// An example value, TOML; empty: the default is the example.
    pub example: &'static str,
    /// Whether it has one value in a study, though others of its kind may be an axis.
    pub is_fixed: bool,
}

impl Key {
    const fn new(path: &'static str, kind: Kind, presence: Presence, help: &'static str) -> Self {
        Self {
            path,
            kind,
            presence,
            usual: None,
            code: "E130",
            help,
            example: "",
            is_fixed: false,
        }
    }

    /// A key that must be given.
    pub const fn required(
        path: &'static str,
        kind: Kind,
        example: &'static str,
        help: &'static str,
    ) -> Self {
        let mut key = Self::new(path, kind, Presence::Required, help);
        key.example = example;
        key
    }

    /// A key with a default.
    pub const fn or(
        path: &'static str,
        kind: Kind,
        default: &'static str,
        help: &'static str,
    ) -> Self {
        Self::new(path, kind, Presence::Default(default), help)
    }

    /// A key of a choice, given together with the others of its alternative.
    pub const fn together(
        path: &'static str,
        kind: Kind,
        default: &'static str,
        help: &'static str,
    ) -> Self {
        Self::new(path, kind, Presence::Together(default), help)
    }

    /// A key that may be absent.
    pub const fn optional(
        path: &'static str,
        kind: Kind,
        absent: &'static str,
        example: &'static str,
        help: &'static str,
    ) -> Self {
        let mut key = Self::new(path, kind, Presence::Optional(absent), help);
        key.example = example;
        key
    }

    /// A key whose default comes from the resolution preset.
    pub const fn by_preset(
        path: &'static str,
        kind: Kind,
        example: &'static str,
        help: &'static str,
    ) -> Self {
        let mut key = Self::new(path, kind, Presence::ByPreset, help);
        key.example = example;
        key
    }

    /// With a usual range.
    pub const fn usual(mut self, low: f64, high: f64) -> Self {
        self.usual = Some((low, high));
        self
    }

    /// With the code of its range error.
    pub const fn code(mut self, code: &'static str) -> Self {
        self.code = code;
        self
    }

    /// With one value in a study.
    pub const fn fixed(mut self) -> Self {
        self.is_fixed = true;
        self
    }

    /// The same key in the list of heads; an entry without it takes the study's value.
    pub(super) fn of_a_head(&self) -> Self {
        let is_member = self.path.contains("[].");
        Self {
            // A handful of paths, made once per process.
            path: String::leak(format!("heads[].{}", self.path)),
            presence: match is_member {
                true => self.presence,
                false => Presence::Optional("the study's"),
            },
            example: self.example(),
            ..*self
        }
    }

    /// Last name of the path.
    pub fn name(&self) -> &'static str {
        self.path.rsplit('.').next().unwrap_or(self.path)
    }

    /// An example value, TOML.
    pub fn example(&self) -> &'static str {
        match self.presence {
            Presence::Default(literal) | Presence::Together(literal) if self.example.is_empty() => {
                literal
            }
            _ => self.example,
        }
    }

    /// The number that an absent value stands for.
    ///
    /// # Panics
    /// When the table of keys names no such number; a programming error.
    pub fn absent<T: std::str::FromStr>(&self) -> T {
        match self.presence {
            Presence::Optional(absent) => absent.parse().ok(),
            _ => None,
        }
        .unwrap_or_else(|| panic!("no number for an absent {}", self.path))
    }

    /// First name of the path: the section, or the key itself at the root.
    pub fn section(&self) -> &'static str {
        self.path.split(['.', '[']).next().unwrap_or(self.path)
    }

    /// Whether a list of values makes an axis of the study.
    pub fn may_be_axis(&self) -> bool {
        const SCENE: [&str; 12] = [
            "pulse",
            "disk",
            "hub",
            "ramp",
            "slider",
            "suspension",
            "gas",
            "surface_forces",
            "asperity_contact",
            "solver",
            "resolution",
            "failure",
        ];
        self.kind.is_single()
            && SCENE.contains(&self.section())
            && !self.is_fixed
            // The files are read once, with the study.
            && !self.path.starts_with("ramp.deformable.mesh.")
            && !self.path.starts_with("suspension.imported.")
    }
}

/// Alternatives of which at most one may be given.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// What is chosen, in words.
    pub what: &'static str,
    /// The alternatives: paths of their keys. The first is the default.
    pub alternatives: &'static [&'static [&'static str]],
}
