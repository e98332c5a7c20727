//! Holds the checked values of a study by dotted path, and gives those of one point.

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

use super::datum::Datum;
use super::field::{Field, Single, Tables, Value};
use super::source::{Origin, Place};

/// What a key was set to: one value, or several when it is an axis.
#[derive(Clone, Debug)]
pub struct Setting {
    /// The values; never empty.
    pub values: Vec<Datum>,
    /// Whether the values make an axis of the study.
    pub is_axis: bool,
    /// Place of the whole value.
    pub place: Place,
    /// Place of the key.
    pub key_place: Place,
    /// Place of each value of an axis, each entry of a list.
    pub value_places: Vec<Place>,
}

impl Setting {
    /// Place of one value.
    pub fn place_of(&self, position: usize) -> &Place {
        self.value_places.get(position).unwrap_or(&self.place)
    }

    /// Where the setting came from.
    pub fn origin(&self) -> Origin {
        self.place.origin
    }
}

/// Every setting of a study.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    map: BTreeMap<String, Setting>,
    /// Keys whose value is not usable as given; a stand-in takes its place in further checks.
    unsound: BTreeSet<String>,
    /// Keys that some head has of its own.
    per_head: BTreeSet<String>,
}

/// The list of heads.
const HEADS: &str = "heads";
/// A head's name, among its own keys; at the root the one that is chosen.
const HEAD: &str = "head";

impl Settings {
    /// The setting at a path.
    pub fn get(&self, path: &str) -> Option<&Setting> {
        self.map.get(path)
    }

    /// Whether a key is set.
    pub fn has(&self, path: &str) -> bool {
        self.map.contains_key(path)
    }

    /// Sets a key.
    pub fn put(&mut self, path: String, setting: Setting) {
        if let Some((_, own)) = path
            .strip_prefix("heads[")
            .and_then(|rest| rest.split_once("]."))
        {
            self.per_head.insert(own.to_string());
        }
        self.map.insert(path, setting);
    }

    /// Removes a key and everything below it.
    pub fn remove(&mut self, path: &str) {
        self.map.retain(|known, _| {
            !known
                .strip_prefix(path)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        });
    }

    /// Marks a key's value as not usable.
    pub fn spoil(&mut self, path: &str) {
        self.unsound.insert(path.to_string());
    }

    /// Whether a key was given with a value that is not usable.
    pub fn is_spoilt(&self, path: &str) -> bool {
        self.unsound.contains(path)
    }

    /// Whether all these keys, and everything below them, have usable values.
    pub fn are_sound(&self, paths: &[&str]) -> bool {
        paths.iter().all(|path| {
            self.unsound.iter().all(|known| {
                !known
                    .strip_prefix(path)
                    .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
            })
        })
    }

    /// Every setting, by path.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Setting)> {
        self.map
            .iter()
            .map(|(path, setting)| (path.as_str(), setting))
    }

    /// Name and entry of every head.
    pub fn named_heads(&self) -> Vec<(&str, usize)> {
        let n_entries = match self.get(HEADS).map(|setting| &setting.values[0]) {
            Some(Datum::Entries(count)) => *count,
            _ => 0,
        };
        (0..n_entries)
            .filter_map(|entry| Some((self.text(&format!("heads[{entry}].{HEAD}"))?, entry)))
            .collect()
    }

    /// Entries of the heads that are simulated: the chosen one, or all. None: the study has one head.
    pub fn heads(&self) -> Vec<usize> {
        let chosen = self.chosen_head();
        let is_asked = |(name, _): &(&str, usize)| chosen.is_none_or(|asked| asked == *name);
        let named = self.named_heads().into_iter().filter(is_asked);
        named.map(|(_, entry)| entry).collect()
    }

    /// Name of the chosen head.
    pub fn chosen_head(&self) -> Option<&str> {
        self.text(HEAD)
    }

    /// Keys that some head has of its own, but for its name.
    pub fn per_head(&self) -> impl Iterator<Item = &str> {
        let keys = self.per_head.iter().map(String::as_str);
        keys.filter(|path| *path != HEAD)
    }

    fn text(&self, path: &str) -> Option<&str> {
        match self.get(path)?.values.first()? {
            Datum::Text(text) => Some(text),
            _ => None,
        }
    }
}

/// The settings as one point sees them: every axis at one position.
#[derive(Clone, Debug)]
pub struct View<'a> {
    /// All settings.
    pub settings: &'a Settings,
    /// Position on each axis and its number; position 0 when absent.
    positions: BTreeMap<&'a str, (u32, usize)>,
    /// Axes read, a bit for each number.
    read: Cell<u64>,
    /// Entries of the heads simulated.
    heads: Vec<usize>,
}

impl<'a> View<'a> {
    /// The settings with every axis at its first value.
    pub fn first(settings: &'a Settings) -> Self {
        Self {
            settings,
            positions: BTreeMap::new(),
            read: Cell::new(0),
            heads: settings.heads(),
        }
    }

    /// What the study itself says, no head of it in view, with every axis at its first value.
    pub fn of_study(settings: &'a Settings) -> Self {
        Self {
            heads: Vec::new(),
            ..Self::first(settings)
        }
    }

    /// The settings at a position on each of these axes. Axes of one value need not be given.
    ///
    /// # Panics
    /// With more than 64 axes: they would span more points than any study may have.
    pub fn on(settings: &'a Settings, axes: impl IntoIterator<Item = (&'a str, usize)>) -> Self {
        let numbered = (0..).zip(axes).map(|(number, (path, position))| {
            assert!(number < u64::BITS, "more axes than a study can have");
            (path, (number, position))
        });
        Self {
            positions: numbered.collect(),
            ..Self::first(settings)
        }
    }

    /// Axes read since the last [`View::forget_read`], a bit for each.
    pub fn read(&self) -> u64 {
        self.read.get()
    }

    /// Records axes that are read from now on.
    pub fn forget_read(&self) {
        self.read.set(0);
    }

    /// Positions on some axes, a bit for each.
    pub fn at(&self, axes: u64) -> Vec<usize> {
        let mut at: Vec<(u32, usize)> = self.positions.values().copied().collect();
        at.retain(|(number, _)| axes >> number & 1 == 1);
        at.sort_unstable();
        at.into_iter().map(|(_, position)| position).collect()
    }

    fn position(&self, path: &str) -> usize {
        match self.positions.get(path) {
            None => 0,
            Some(&(number, position)) => {
                self.read.set(self.read.get() | 1 << number);
                position
            }
        }
    }

    /// Where the head in view has a value of its own: the path of that value. A list of its own is whole:
    /// no member of it is the study's.
    fn own_path(&self, path: &str) -> Option<String> {
        let list = path.split('[').next().unwrap_or(path);
        if !self.settings.per_head.contains(list) {
            return None;
        }
        let entry = self.heads.get(self.position(HEADS))?;
        let own = format!("heads[{entry}].");
        let is_own = self.settings.has(&format!("{own}{list}"));
        is_own.then(|| format!("{own}{path}"))
    }

    /// Whether the head in view has a value of its own at a path.
    pub fn is_own(&self, path: &str) -> bool {
        self.own_path(path).is_some()
    }

    /// Whether all these keys, and everything below them, have usable values, those of the head in view
    /// included.
    pub fn are_sound(&self, paths: &[&str]) -> bool {
        let of_the_study = self.settings.are_sound(paths);
        if !of_the_study || self.settings.are_sound(&[HEADS]) {
            return of_the_study;
        }
        let Some(entry) = self.heads.get(self.position(HEADS)) else {
            return true;
        };
        let own = |path: &&str| format!("heads[{entry}].{path}");
        let is_sound = |path: String| self.settings.are_sound(&[&path]);
        paths.iter().map(own).all(is_sound)
    }

    /// The value at a path.
    pub fn datum(&self, path: &str) -> Option<&'a Datum> {
        if let Some(own) = self.own_path(path) {
            return self.settings.get(&own)?.values.first();
        }
        let position = self.position(path);
        self.settings
            .get(path)
            .and_then(|setting| setting.values.get(position))
    }

    /// Place of the value at a path.
    pub fn place(&self, path: &str) -> Option<&'a Place> {
        if let Some(own) = self.own_path(path) {
            return self.settings.get(&own).map(|own| &own.place);
        }
        let position = self.position(path);
        self.settings.get(path).map(|setting| {
            if setting.is_axis {
                setting.place_of(position)
            } else {
                &setting.place
            }
        })
    }

    /// The value of a key: numbers in SI.
    pub fn get<T: Value>(&self, field: &Field<T>) -> T::Out<'a> {
        T::read(field.path(), self.datum(field.path()))
    }

    /// The value of a member of a list at an entry of it.
    pub fn entry<T: Value>(&self, entry: usize, field: &Field<T>) -> T::Out<'a> {
        let path = field.of_entry(entry);
        T::read(&path, self.datum(&path))
    }

    /// The value of a key among those of one head: `of` is what stands before its path.
    pub fn get_of<T: Value>(&self, of: &str, field: &Field<T>) -> T::Out<'a> {
        let path = format!("{of}{}", field.path());
        T::read(&path, self.datum(&path))
    }

    /// Number of entries of the list of tables at a path.
    pub fn entries_at(&self, path: &str) -> usize {
        Tables::read(path, self.datum(path))
    }

    /// One value, if there is one.
    pub(super) fn given<T: Single>(&self, field: &Field<T>) -> Option<T::Of> {
        T::given(field.path(), self.datum(field.path()))
    }

    /// Number in the unit of its key.
    ///
    /// # Panics
    /// When the table of keys does not give `path` a number; a programming error.
    pub fn number(&self, path: &str) -> f64 {
        self.maybe_number(path)
            .unwrap_or_else(|| panic!("no number at {path}"))
    }

    /// Number in the unit of its key, if there is one.
    pub fn maybe_number(&self, path: &str) -> Option<f64> {
        match self.datum(path) {
            Some(Datum::Number(value)) => Some(*value),
            _ => None,
        }
    }
}
