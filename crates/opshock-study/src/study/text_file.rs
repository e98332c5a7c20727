//! Reads a text file and refuses what is no ordinary text before any parser sees it: other file kinds (E105),
//! loops (E106), sizes beyond [`MAX_BYTES`] and nesting beyond [`MAX_DEPTH`] (E104), text that is
//! not UTF-8 (E102).

use std::io::Read;
use std::path::Path;
use std::sync::Arc;

use super::fault::StudyError;
use super::source::{Origin, Place, Source};

/// Largest file read, bytes.
pub const MAX_BYTES: u64 = 4 << 20;

/// Deepest nesting of brackets or dotted names.
pub const MAX_DEPTH: usize = 24;

/// Reads a text file whole, within the limits of this module.
///
/// # Errors
/// E102 (not UTF-8), E104 (too large), E105 (not a readable ordinary file), E106 (a loop of
/// symbolic links).
pub fn read_text(path: &Path) -> Result<String, Box<StudyError>> {
    let name = path.display().to_string();
    let refuse = |code: &'static str, message: String, allowed: &str, hint: &str| {
        Box::new(
            StudyError::in_file(code, &name, message)
                .allowed(allowed)
                .hint(hint),
        )
    };
    let system = |error: std::io::Error| {
        let looped = error.raw_os_error() == Some(ELOOP);
        let hint = if looped {
            format!(
                "the symbolic links {} lead back to themselves",
                link_chain(path)
            )
        } else {
            "give the path of a readable study file".to_string()
        };
        let code = if looped { "E106" } else { "E105" };
        refuse(
            code,
            format!("cannot be read: {}", reason(&error)),
            "an ordinary file",
            &hint,
        )
    };
    // Metadata first: opening a FIFO would wait for a writer for ever.
    let metadata = std::fs::metadata(path).map_err(system)?;
    if !metadata.is_file() {
        let kind = if metadata.is_dir() {
            "a directory"
        } else {
            "not an ordinary file"
        };
        return Err(refuse(
            "E105",
            format!("cannot be read: it is {kind}"),
            "an ordinary file",
            "name the study.toml inside",
        ));
    }
    let too_large = |bytes: u64| {
        refuse(
            "E104",
            format!("is too large: {bytes} bytes or more"),
            &format!("at most {MAX_BYTES} bytes"),
            "a study file is a few kilobytes of text",
        )
    };
    if metadata.len() > MAX_BYTES {
        return Err(too_large(metadata.len()));
    }
    let mut bytes = Vec::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(MAX_BYTES + 1).read_to_end(&mut bytes))
        .map_err(system)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(too_large(bytes.len() as u64));
    }
    decode(bytes, &name)
}

/// UTF-8 text of a file's bytes.
///
/// # Errors
/// E102 with the offset of the first byte that is not UTF-8.
pub fn decode(bytes: Vec<u8>, name: &str) -> Result<String, Box<StudyError>> {
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let hint = match error.as_bytes() {
            [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..] => "this is UTF-16; save it as UTF-8",
            _ => "save the file as UTF-8 text",
        };
        let line = error.as_bytes()[..at]
            .iter()
            .filter(|byte| **byte == b'\n')
            .count()
            + 1;
        let mut fault = StudyError::in_file("E102", name, format!("not UTF-8 at byte {at}"))
            .allowed("UTF-8 text")
            .hint(hint);
        fault.line = line;
        Box::new(fault)
    })
}

/// Checks size and nesting without recursion, before the recursive parser runs.
///
/// # Errors
/// E104.
pub fn check_limits(source: &Arc<Source>, origin: Origin) -> Result<(), Box<StudyError>> {
    if source.text.len() as u64 > MAX_BYTES {
        return Err(Box::new(
            StudyError::in_file(
                "E104",
                &source.name,
                format!("is too large: {} bytes", source.text.len()),
            )
            .allowed(format!("at most {MAX_BYTES} bytes"))
            .hint("a study file is a few kilobytes of text"),
        ));
    }
    match too_deep(&source.text) {
        None => Ok(()),
        Some(at) => {
            let place = Place {
                source: source.clone(),
                span: at..at + 1,
                origin,
            };
            Err(Box::new(
                StudyError::at(
                    "E104",
                    &place,
                    "",
                    format!("nested deeper than {MAX_DEPTH} levels"),
                )
                .allowed(format!(
                    "at most {MAX_DEPTH} levels of brackets or dotted names"
                ))
                .hint("no study needs more than 5 levels"),
            ))
        }
    }
}

/// Offset at which brackets or dotted names first go deeper than [`MAX_DEPTH`].
fn too_deep(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut depth, mut dots, mut at) = (0_usize, 0_usize, 0_usize);
    while at < bytes.len() {
        match bytes[at] {
            b'#' => {
                while at < bytes.len() && bytes[at] != b'\n' {
                    at += 1;
                }
                continue;
            }
            quote @ (b'"' | b'\'') => {
                at = after_string(bytes, at, quote);
                continue;
            }
            b'[' | b'{' => {
                depth += 1;
                dots = 0;
            }
            b']' | b'}' => {
                depth = depth.saturating_sub(1);
                dots = 0;
            }
            b'.' => dots += 1,
            b'\n' | b'=' | b',' => dots = 0,
            _ => {}
        }
        if depth > MAX_DEPTH || dots > MAX_DEPTH {
            return Some(at);
        }
        at += 1;
    }
    None
}

/// Offset of the first bracket that is never closed.
pub fn unclosed_bracket(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut open, mut at) = (Vec::new(), 0_usize);
    while at < bytes.len() {
        match bytes[at] {
            b'#' => {
                while at < bytes.len() && bytes[at] != b'\n' {
                    at += 1;
                }
                continue;
            }
            quote @ (b'"' | b'\'') => {
                at = after_string(bytes, at, quote);
                continue;
            }
            b'[' | b'{' => open.push(at),
            b']' | b'}' => {
                open.pop();
            }
            _ => {}
        }
        at += 1;
    }
    open.first().copied()
}

/// Offset behind the string that opens at `at`; an unclosed one ends with its line.
fn after_string(bytes: &[u8], at: usize, quote: u8) -> usize {
    let triple = bytes[at..].starts_with(&[quote; 3]);
    let mut next = at + if triple { 3 } else { 1 };
    while next < bytes.len() {
        match bytes[next] {
            b'\\' if quote == b'"' => next += 2,
            byte if byte == quote && (!triple || bytes[next..].starts_with(&[quote; 3])) => {
                return next + if triple { 3 } else { 1 };
            }
            b'\n' if !triple => return next,
            _ => next += 1,
        }
    }
    bytes.len()
}

/// Too many symbolic links (Linux and most others; macOS has 62).
const ELOOP: i32 = if cfg!(target_os = "macos") { 62 } else { 40 };

/// The system's reason without the number Rust adds.
fn reason(error: &std::io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error")
        .next()
        .unwrap_or(&text)
        .to_lowercase()
}

/// Symbolic links from `path` on until one repeats, as a chain.
fn link_chain(path: &Path) -> String {
    let mut chain = vec![path.to_path_buf()];
    while let Some(last) = chain.last()
        && let Ok(next) = std::fs::read_link(last)
    {
        let next = last.parent().unwrap_or(Path::new("")).join(next);
        let again = chain.contains(&next);
        chain.push(next);
        if again || chain.len() > 8 {
            break;
        }
    }
    chain
        .iter()
        .map(|link| link.display().to_string())
        .collect::<Vec<_>>()
        .join(" -> ")
}
