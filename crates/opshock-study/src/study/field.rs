//! A key of the study file with the Rust type of its value.
//!
//! From one line `fields!` makes the key and the constant by which code reads it. Where the value goes into a scene
//! unchanged, the line names its place there. A key of another kind than its type does not compile.

use std::marker::PhantomData;

use super::datum::Datum;
use super::key::{Key, Kind, Presence};
use super::unit;
use super::words::names;
use opshock_import::matrix::units::Units;
use opshock_solver::air_bearing::FlowModel;
use opshock_solver::scene::Coupling;
use opshock_solver::scene::discretisation::Discretisation;
use opshock_solver::scene::plan::Output;
use opshock_solver::scene::preset::Preset;

/// A key whose value is a `T`.
pub struct Field<T> {
    /// Its line of the table.
    pub key: Key,
    of: PhantomData<fn() -> T>,
}

impl<T> Field<T> {
    /// Dotted path, `[]` behind the name of a list.
    pub const fn path(&self) -> &'static str {
        self.key.path
    }

    /// Path of a member of the first list on the way, at an entry of it.
    pub fn of_entry(&self, entry: usize) -> String {
        self.key.path.replacen("[]", &format!("[{entry}]"), 1)
    }
}

impl<T: Value> Field<T> {
    /// # Panics
    /// When compiled: if the key's values are of another kind than `T`, or may be absent and `T` may not.
    pub(super) const fn of(key: Key) -> Self {
        assert!(T::IS.fits(key.kind), "the key's kind is not the field's");
        let may_be_absent = matches!(key.presence, Presence::Optional(_) | Presence::ByPreset);
        assert!(T::MAY_BE_ABSENT || !may_be_absent, "the key may be absent");
        Self {
            key,
            of: PhantomData,
        }
    }
}

/// Which kinds of values a type takes.
#[derive(Clone, Copy)]
pub(super) enum Is {
    Number,
    Integer,
    Flag,
    Word(&'static [&'static str]),
    Text,
    Words(&'static [&'static str]),
    Numbers,
    Pair,
    Corners,
    Tables,
}

impl Is {
    const fn fits(self, kind: Kind) -> bool {
        match (self, kind) {
            (Self::Word(own), Kind::Word(words)) | (Self::Words(own), Kind::Words(words)) => {
                are_same(own, words)
            }
            (Self::Number, Kind::Number(_) | Kind::NumberOrWord(..))
            | (Self::Integer, Kind::Integer(..))
            | (Self::Flag, Kind::Flag)
            | (Self::Text, Kind::Text | Kind::Word(_))
            | (Self::Numbers, Kind::Numbers(_) | Kind::Axis(_))
            | (Self::Pair, Kind::Pair(_))
            | (Self::Corners, Kind::Points)
            | (Self::Tables, Kind::Tables) => true,
            _ => false,
        }
    }
}

const fn are_same(one: &[&str], other: &[&str]) -> bool {
    let mut at = 0;
    while at < one.len() && at < other.len() {
        let (a, b) = (one[at].as_bytes(), other[at].as_bytes());
        let mut letter = 0;
        while letter < a.len() && letter < b.len() && a[letter] == b[letter] {
            letter += 1;
        }
        if letter < a.len() || letter < b.len() {
            return false;
        }
        at += 1;
    }
    one.len() == other.len()
}

/// What a field's value is in Rust; numbers in SI.
pub trait Value {
    /// What is read: the value, or a reference into the settings.
    type Out<'a>;
    #[doc(hidden)]
    #[allow(private_interfaces)]
    const IS: Is;
    /// Whether there may be none.
    const MAY_BE_ABSENT: bool;

    /// The value at `path`.
    ///
    /// # Panics
    /// When there is none of a type that is always there; a programming error.
    fn read<'a>(path: &str, datum: Option<&'a Datum>) -> Self::Out<'a>;
}

/// A value by itself, which may go into a scene as it is.
pub(super) trait Single: Value {
    type Of;

    fn given(path: &str, datum: Option<&Datum>) -> Option<Self::Of>;
}

/// One value, always there or not, of a kind, by a way from path and datum.
macro_rules! single {
    ($($type:ty: $is:expr, $read:expr;)*) => {$(
        impl Value for $type {
            type Out<'a> = $type;
            #[allow(private_interfaces)]
            const IS: Is = $is;
            const MAY_BE_ABSENT: bool = false;

            fn read(path: &str, datum: Option<&Datum>) -> $type {
                Self::given(path, datum).unwrap_or_else(|| panic!("no value at {path}"))
            }
        }

        impl Single for $type {
            type Of = $type;

            fn given(path: &str, datum: Option<&Datum>) -> Option<$type> {
                let read: fn(&str, &Datum) -> Option<$type> = $read;
                read(path, datum?)
            }
        }

        impl Value for Option<$type> {
            type Out<'a> = Option<$type>;
            #[allow(private_interfaces)]
            const IS: Is = $is;
            const MAY_BE_ABSENT: bool = true;

            fn read(path: &str, datum: Option<&Datum>) -> Option<$type> {
                <$type>::given(path, datum)
            }
        }

        impl Single for Option<$type> {
            type Of = $type;

            fn given(path: &str, datum: Option<&Datum>) -> Option<$type> {
                <$type>::given(path, datum)
            }
        }
    )*};
}

/// Whole numbers; the table bounds them.
macro_rules! integer {
    ($($type:ty),*) => { single! {$(
        $type: Is::Integer, |_, datum| match datum {
            Datum::Integer(value) => <$type>::try_from(*value).ok(),
            _ => None,
        };
    )*} };
}

single! {
    f64: Is::Number, |path, datum| match datum {
        Datum::Number(value) => Some(unit::si(path, *value)),
        _ => None,
    };
    bool: Is::Flag, |_, datum| match datum {
        Datum::Flag(flag) => Some(*flag),
        _ => None,
    };
}

integer!(i64, u64, u32, u8, usize);

/// Types whose values are the words of a list.
pub trait Named: Sized + Copy + 'static {
    /// Each word with its value.
    const WORDS: &'static [(&'static str, Self)];
    /// The words.
    const NAMES: &'static [&'static str];
    /// Kind of a key that holds one.
    const KIND: Kind = Kind::Word(Self::NAMES);
    /// Kind of a key that holds some.
    const KIND_OF_MANY: Kind = Kind::Words(Self::NAMES);
}

/// Values of a list of words, in the order of the study.
pub struct Many<T>(PhantomData<fn() -> T>);

impl<T: Named> Value for Many<T> {
    type Out<'a> = Vec<T>;
    #[allow(private_interfaces)]
    const IS: Is = Is::Words(T::NAMES);
    const MAY_BE_ABSENT: bool = true;

    fn read(_: &str, datum: Option<&Datum>) -> Vec<T> {
        let Some(Datum::Words(words)) = datum else {
            return Vec::new();
        };
        let value = |word: &String| T::WORDS.iter().find(|(name, _)| name == word);
        words
            .iter()
            .filter_map(value)
            .map(|(_, value)| *value)
            .collect()
    }
}

macro_rules! named {
    ($($type:ty: $list:expr;)*) => {
        $(
            impl Named for $type {
                const WORDS: &'static [(&'static str, Self)] = &$list;
                const NAMES: &'static [&'static str] = &names(&$list);
            }
        )*
        single! {$(
            $type: Is::Word(<$type>::NAMES), |_, datum| match datum {
                Datum::Word(word) => {
                    let found = <$type>::WORDS.iter().find(|(name, _)| name == word);
                    found.map(|(_, value)| *value)
                }
                _ => None,
            };
        )*}
    };
}

named! {
    super::words::Shape: super::words::SHAPES;
    super::words::TableScale: super::words::TABLE_SCALES;
    super::words::TimeUnit: super::words::TIME_UNITS;
    super::words::AccelerationUnit: super::words::ACCELERATION_UNITS;
    super::words::TableOffset: super::words::TABLE_OFFSETS;
    super::words::FilterClass: super::words::FILTER_CLASSES;
    super::words::RunOut: super::words::RUN_OUT;
    super::words::RailKind: super::words::RAIL_KINDS;
    super::words::LengthUnit: super::words::LENGTH_UNITS;
    super::words::Faces: super::words::FACES;
    super::words::Criterion: super::words::CRITERIA;
    crate::search::MonotonicityScan: super::words::MONOTONICITY_SCAN;
    super::words::UncertaintyOf: super::words::UNCERTAINTY_OF;
    super::words::Effects: super::words::EFFECTS;
    super::words::KeepHistories: super::words::KEEP_HISTORIES;
    FlowModel: super::words::FLOWS;
    Coupling: super::words::COUPLINGS;
    Preset: super::words::PRESETS;
    Units: Units::WORDS;
    crate::search::Ramp: super::words::RAMPS;
    crate::search::Sign: super::words::SIGNS;
    super::words::LeftOut: super::words::LEAVE_OUT;
    Output: super::words::OUTPUTS;
    Discretisation: super::words::DISCRETISATION;
}

/// What is read as a part of the settings, empty where there is none.
macro_rules! part {
    ($($(#[$doc:meta])* $name:ident: $is:expr, $out:ty, $($pattern:pat_param)|+ => $value:expr, $empty:expr;)*) => {$(
        $(#[$doc])*
        pub struct $name;

        impl Value for $name {
            type Out<'a> = $out;
            #[allow(private_interfaces)]
            const IS: Is = $is;
            const MAY_BE_ABSENT: bool = true;

            // Some of them borrow, some do not.
            #[allow(clippy::needless_lifetimes)]
            fn read<'a>(_: &str, datum: Option<&'a Datum>) -> $out {
                match datum {
                    $(Some($pattern))|+ => $value,
                    _ => $empty,
                }
            }
        }
    )*};
}

part! {
    /// Text, or a word of a list without values.
    Text: Is::Text, &'a str, Datum::Text(text) | Datum::Word(text) => text, "";
    /// Numbers in the unit of the key.
    Numbers: Is::Numbers, &'a [f64], Datum::Numbers(numbers) => numbers, &[];
    /// From and to, in the unit of the key.
    Pair: Is::Pair, [f64; 2], Datum::Pair(ends) => *ends, [0.0; 2];
    /// Corners, in the unit of the key.
    Corners: Is::Corners, &'a [[f64; 2]], Datum::Points(corners) => corners, &[];
    /// A list of tables: the number of its entries.
    Tables: Is::Tables, usize, Datum::Entries(count) => *count, 0;
}

/// The table of keys: a constant, the type of its value, its line, and the place in a scene to which its value goes.
macro_rules! fields {
    ($($name:ident: $type:ty = $key:expr $(=> |$scene:ident| $place:expr)?;)*) => {
        $(
            #[doc = concat!("`", stringify!($name), "`, as its line says.")]
            pub const $name: Field<$type> = Field::<$type>::of($key);
        )*

        /// The table as it is written here.
        pub(super) static TABLE: &[Key] = &[$($name.key),*];

        /// Writes each value that goes into a scene unchanged to its place; an absent value leaves the place alone.
        pub(super) static PLACES: &[(&str, fn(&View<'_>, &mut Scene))] = &[$($(
            ($name.path(), |view, $scene| {
                if let Some(value) = view.given(&$name) {
                    $place = value;
                }
            }),
        )?)*];
    };
}
pub(super) use fields;
