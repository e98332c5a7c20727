//! Line reader for files of the CMLAir family: version, numbers and the faults found in them.

use crate::fault::{Fault, Faults};
use crate::text::{Line, NotANumber, Source, Word};

/// Versions whose layout is read.
pub const VERSIONS: [&str; 2] = ["7.0", "8.0"];

/// Largest allowed number of items of any kind in a file of this family.
pub(super) const MAX_COUNT: usize = 1000;

/// Lines of a file in order, without blank ones.
pub(super) struct Reader<'a> {
    pub(super) file: &'a str,
    pub(super) lines: std::iter::Peekable<std::vec::IntoIter<Line<'a>>>,
    pub(super) faults: Faults,
    pub(super) n_bytes: usize,
}

impl<'a> Reader<'a> {
    /// Checks the header and skips it.
    ///
    /// # Errors
    /// As [`Reader::of_any`], and E173 for the dynamic program's file.
    pub(super) fn of(source: &'a Source) -> Result<(Self, String), Faults> {
        refuse_dynamic(source)?;
        Self::of_any(source)
    }

    /// Checks the header and skips it.
    ///
    /// # Errors
    /// E160 for another header, E173 for another version.
    pub(super) fn of_any(source: &'a Source) -> Result<(Self, String), Faults> {
        let mut lines = source.lines();
        let first = lines.next();
        let text = first.map_or("", |line| line.text);
        let Some(rest) = text.trim_start().strip_prefix("CML") else {
            return Err(
                Fault::of("E160", &source.name, "not a file of the CMLAir family")
                    .line(1)
                    .value(text)
                    .allowed("a first line that starts with CML and names a version")
                    .into(),
            );
        };
        let version = version(rest);
        if !VERSIONS.contains(&version.as_str()) {
            let (message, reported) = if version.is_empty() {
                ("the first line names no version", text)
            } else {
                ("files of this version are not read", version.as_str())
            };
            return Err(Fault::of("E173", &source.name, message)
                .line(1)
                .what("version")
                .value(reported)
                .allowed(VERSIONS.join(", "))
                .hint("save it as version 8.0")
                .into());
        }
        let lines: Vec<Line<'a>> = lines
            .skip(1)
            .filter(|line| !line.text.trim().is_empty())
            .collect();
        let reader = Self {
            file: &source.name,
            lines: lines.into_iter().peekable(),
            faults: Faults::default(),
            n_bytes: source.n_bytes(),
        };
        Ok((reader, version))
    }

    /// All lines of a file that has no header.
    pub(super) fn without_header(source: &'a Source) -> Self {
        let lines = source.lines();
        let lines: Vec<Line<'a>> = lines.filter(|line| !line.text.trim().is_empty()).collect();
        Self {
            file: &source.name,
            lines: lines.into_iter().peekable(),
            faults: Faults::default(),
            n_bytes: source.n_bytes(),
        }
    }

    /// E160: the file ends where `what` should stand.
    pub(super) fn cut_short(&self, what: &str) -> Faults {
        Fault::of("E160", self.file, format!("the file ends before {what}"))
            .value(format!("{} bytes", self.n_bytes))
            .hint("is it cut short?")
            .into()
    }

    /// Words of the next line.
    pub(super) fn words(&mut self, what: &str) -> Result<(usize, Vec<Word<'a>>), Faults> {
        let Some(line) = self.lines.next() else {
            return Err(self.cut_short(what));
        };
        Ok((line.number, line.words().collect()))
    }

    /// Exactly `names.len()` real numbers on the next line; what follows them is a comment.
    pub(super) fn reals<const N: usize>(&mut self, names: [&str; N]) -> Result<[f64; N], Faults> {
        let (line, words) = self.words(names[0])?;
        if words.len() < N {
            return Err(
                Fault::of("E175", self.file, "values are missing on the line")
                    .line(line)
                    .value(format!("{} values", words.len()))
                    .allowed(names.join(", "))
                    .into(),
            );
        }
        let mut values = [0.0; N];
        for ((value, word), name) in values.iter_mut().zip(&words).zip(names) {
            *value = real(self.file, word, name, &mut self.faults);
        }
        Ok(values)
    }

    /// Whole numbers on the next line, each at most [`MAX_COUNT`].
    pub(super) fn counts<const N: usize>(
        &mut self,
        names: [&str; N],
    ) -> Result<[usize; N], Faults> {
        let (line, words) = self.words(names[0])?;
        let mut counts = [0; N];
        for (k, name) in names.into_iter().enumerate() {
            let found = words.get(k).and_then(Word::count);
            let Some(count) = found.filter(|count| *count <= MAX_COUNT) else {
                let fault = Fault::of("E174", self.file, "not a count").what(name);
                let fault = match words.get(k) {
                    Some(word) => fault.at(word.place()).value(word.text),
                    None => fault.line(line).value("nothing"),
                };
                return Err(fault
                    .allowed(format!("a whole number up to {MAX_COUNT}"))
                    .into());
            };
            counts[k] = count;
        }
        Ok(counts)
    }
}

/// Name of the dynamic program's file.
const DYNAMIC_FILE: &str = "dynluls.def";

/// Names that only the dynamic program's file has: an option of its solver, and its radii.
const DYNAMIC_NAMES: [&str; 3] = ["iqpo", "ra_if", "ra_of"];

/// Rejects `DynLULS.def` in the place of another file: its first line need not identify it.
fn refuse_dynamic(source: &Source) -> Result<(), Faults> {
    let named = source.name.to_lowercase().ends_with(DYNAMIC_FILE);
    let is_name = |word: Word<'_>| {
        let plain = word.text.split('(').next().unwrap_or_default();
        DYNAMIC_NAMES
            .iter()
            .any(|name| plain.eq_ignore_ascii_case(name))
    };
    let line = source.lines().find(|line| line.words().any(is_name));
    let place = match (named, &line) {
        (_, Some(line)) => line.number,
        (true, None) => 1,
        (false, None) => return Ok(()),
    };
    Err(Fault::of(
        "E173",
        &source.name,
        "the file of a dynamic run in the place of another",
    )
    .line(place)
    .what("DynLULS.def")
    .value(line.map_or("", |line| line.text.trim()))
    .allowed("rail.dat, and the run.dat of the same slider")
    .hint("give it beside rail.dat: --dynamic DynLULS.def")
    .into())
}

/// Number behind "Version", or the first number with a point.
fn version(rest: &str) -> String {
    let numbers = rest.split(|c: char| !(c.is_ascii_digit() || c == '.'));
    let mut versions = numbers.map(|text| text.trim_matches('.'));
    versions
        .find(|text| text.contains('.'))
        .unwrap_or_default()
        .to_owned()
}

/// A number for a message.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// A real number; for other words a fault, and 0.
pub(super) fn real(file: &str, word: &Word<'_>, name: &str, faults: &mut Faults) -> f64 {
    let message = match word.real() {
        Ok(value) => return value,
        Err(NotANumber::Comma) => "a comma in a number",
        Err(NotANumber::NotFinite) => "the value is not finite, or 1e300 and more",
        Err(NotANumber::Word) => "the value is no number",
    };
    faults.push(
        Fault::of("E174", file, message)
            .at(word.place())
            .what(name)
            .value(word.text)
            .allowed("a number with a decimal point"),
    );
    0.0
}

/// A number within a range; a fault for other words and values.
pub(super) fn within(
    file: &str,
    word: &Word<'_>,
    name: &str,
    unit: &str,
    (low, high): (f64, f64),
    faults: &mut Faults,
) -> f64 {
    let before = faults.listed.len() + faults.unlisted;
    let value = real(file, word, name, faults);
    let sound = before == faults.listed.len() + faults.unlisted;
    if sound && !(low..=high).contains(&value) {
        let fault = Fault::of("E175", file, "the value is not allowed");
        faults.push(
            fault
                .at(word.place())
                .what(name)
                .value(format!("{} {unit}", short(value)))
                .allowed(format!("{} to {} {unit}", short(low), short(high))),
        );
    }
    value
}
