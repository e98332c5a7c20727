//! Mutations of files for the fuzz tests: of lines as an editor's slip makes them, of bytes as a damaged disk.

use opshock_study::study::keys::KEYS;
use opshock_tests::seeded::Seeded;

/// Values that break readers: limits of numbers, other types, other notations.
const VALUES: &[&str] = &[
    "nan",
    "inf",
    "-inf",
    "0",
    "-0.0",
    "-1",
    "1",
    "3.5",
    "1e308",
    "1e309",
    "1e-400",
    "5e-324",
    "1e9",
    "9223372036854775807",
    "9223372036854775808",
    "0x7f",
    "0b1",
    "0o17",
    "1_000",
    "01",
    "1.",
    ".5",
    "+1",
    "1e",
    "true",
    "false",
    "\"\"",
    "\"x\"",
    "'+'",
    "\"+\"",
    "\"standard\"",
    "\"none\"",
    "\"rigid\"",
    "\"deformable\"",
    "[]",
    "[[]]",
    "[1, 2, 3]",
    "[1.0, 1.0]",
    "[\"+\", \"-\"]",
    "[1, \"a\"]",
    "{}",
    "{ from = 1, to = 2, count = 3 }",
    "{ from = 1, to = 2, count = 1000000000 }",
    "{ from = 1, to = 1000, count = 4, spacing = \"log\" }",
    "{ from = 2, to = 1, count = 2 }",
    "{ from = nan, to = 1, count = 2 }",
    "{ count = -1 }",
    "{ modal_ratio = 0.01 }",
    "{ alpha_per_s = 1, beta_s = 1 }",
    "{ preset = \"femto-2.5in\" }",
    "{ file = \"/dev/zero\" }",
    "{ file = \".\" }",
    "\"2 ms\"",
    "2 ms",
    "1979-05-27",
    "1979-05-27T07:32:00Z",
    "\"\"\"a\nb\"\"\"",
    "\"\\u0000\"",
    "\"\\uD800\"",
    "\"a/b\"",
    "1,5",
    "",
    "\t",
    "# comment",
    "= 1",
];

/// Lines that open, close or break sections.
const LINES: &[&str] = &[
    "[pulse]",
    "[disk]",
    "[ramp]",
    "[slider]",
    "[slider.surface]",
    "[search]",
    "[solver]",
    "[output]",
    "[[rail]]",
    "[[slider.surface.rail]]",
    "[[ramp.deformable.modes]]",
    "[a.b.c.d]",
    "[",
    "]",
    "[[",
    "[]",
    "[\"\"]",
    "x",
    "=",
    "\u{feff}",
    "\"",
    "'''",
    "\"\"\"",
    "a.b.c = 1",
    "\"pulse\".widths_ms = [1.0]",
    "kind = \"polygon\"",
    "points_um = [[0, 0], [1, 0], [0, 1]]",
    "recess_um = 0.25",
    "\u{0}",
];

/// One in half of all cases, else up to six: many slips at once hide each other.
fn n_slips(seeded: &mut Seeded) -> usize {
    if seeded.once_in(2) {
        1
    } else {
        1 + seeded.below(6)
    }
}

/// A text after its slips; `others` lends lines.
pub fn text(seeded: &mut Seeded, base: &str, others: &[String]) -> String {
    let mut lines: Vec<String> = base.lines().map(str::to_owned).collect();
    for _ in 0..n_slips(seeded) {
        let at = seeded.below(lines.len());
        match seeded.below(11) {
            0 if !lines.is_empty() => drop(lines.remove(at)),
            1 if !lines.is_empty() => lines.insert(at, lines[at].clone()),
            2 if lines.len() > 1 => {
                let other = seeded.below(lines.len());
                lines.swap(at, other);
            }
            3 => {
                let shared_model = seeded.one_of(others);
                let n = shared_model.lines().count();
                let from = seeded.below(n);
                let some = 1 + seeded.below(4);
                let taken: Vec<String> = shared_model
                    .lines()
                    .skip(from)
                    .take(some)
                    .map(str::to_owned)
                    .collect();
                lines.splice(at..at, taken);
            }
            4 | 5 if !lines.is_empty() => {
                if let Some((key, _)) = lines[at].split_once('=') {
                    lines[at] = format!("{key}= {}", seeded.one_of(VALUES));
                }
            }
            6 => {
                let key = seeded.one_of(&KEYS).path;
                let line = format!("{key} = {}", seeded.one_of(VALUES));
                // Dotted paths belong to the root: above the first section.
                let place = if seeded.once_in(2) { 0 } else { at };
                lines.insert(place, line);
            }
            7 => lines.insert(at, (*seeded.one_of(LINES)).to_owned()),
            8 if !lines.is_empty() => lines[at] = number_changed(seeded, &lines[at]),
            9 if !lines.is_empty() => lines[at] = typo(seeded, &lines[at]),
            _ => lines.truncate(at + 1),
        }
    }
    lines.join("\n")
}

/// One number of a line made another.
fn number_changed(seeded: &mut Seeded, line: &str) -> String {
    let digits: Vec<usize> = line
        .char_indices()
        .filter(|(_, c)| c.is_ascii_digit())
        .map(|(i, _)| i)
        .collect();
    if digits.is_empty() {
        return line.to_owned();
    }
    let at = *seeded.one_of(&digits);
    let with = match seeded.below(5) {
        0 => format!("{}", seeded.below(10)),
        1 => format!("{:e}", seeded.log_between(1e-12, 1e12)),
        2 => "-1".to_owned(),
        3 => "00".to_owned(),
        _ => String::new(),
    };
    format!("{}{with}{}", &line[..at], &line[at + 1..])
}

/// One character left out, doubled, or replaced.
fn typo(seeded: &mut Seeded, line: &str) -> String {
    let mut letters: Vec<char> = line.chars().collect();
    let at = seeded.below(letters.len());
    match seeded.below(3) {
        0 if !letters.is_empty() => drop(letters.remove(at)),
        1 if !letters.is_empty() => letters.insert(at, letters[at]),
        _ => letters.insert(
            at,
            *seeded.one_of(&[
                '=', '[', ']', '{', '}', '"', '\'', ',', '.', '#', '\\', '\u{b5}', '\r',
            ]),
        ),
    }
    letters.into_iter().collect()
}

/// Bytes after their damages.
pub fn bytes(seeded: &mut Seeded, bytes: &mut Vec<u8>) {
    for _ in 0..n_slips(seeded) {
        let n = bytes.len();
        let at = seeded.below(n);
        let length = (1 + seeded.below(40)).min(n - at.min(n));
        match seeded.below(6) {
            0 | 1 if n > 0 => bytes[at] ^= 1 << seeded.below(8),
            2 if n > 0 => bytes[at] = seeded.bits() as u8,
            3 => drop(bytes.drain(at..at + length)),
            4 if n < 1 << 16 => {
                let copy = bytes[at..at + length].to_vec();
                let to = seeded.below(n + 1);
                bytes.splice(to..to, copy);
            }
            _ if seeded.once_in(4) => bytes.truncate(at),
            _ => bytes.insert(at, seeded.bits() as u8),
        }
    }
}
