//! Begins pages, escapes text, labels figures, explains words and makes links to what a page holds.

use crate::report::chart::colour;

/// The beginning of a page that needs no network and no other file; its policy lets no script run but its own, and none without `script`.
pub(super) fn head(title: &str, script: bool) -> String {
    format!(
        r##"<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'{script}">
<title>{title}</title>
<style>
{style}{dark}
</style>
</head>
"##,
        script = if script {
            "; script-src 'unsafe-inline'"
        } else {
            ""
        },
        title = escaped(title),
        style = include_str!("style.css"),
        dark = colour::dark_style(),
    )
}

/// A figure with its label for those who do not see it.
pub(super) fn figure(svg: &str, label: &str) -> String {
    let svg = svg.replacen("<svg ", &format!(r#"<svg aria-label="{label}" "#), 1);
    format!("<figure>{svg}</figure>\n")
}

/// Text with everything replaced that HTML would read otherwise.
pub(in crate::report) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            c => safe.push(c),
        }
    }
    safe
}

/// The same with the plus-minus sign of numbers.
pub(super) fn signed(text: &str) -> String {
    escaped(&text.replace("+-", "\u{b1}"))
}

/// A word that says its meaning on hover.
pub(super) fn explained(word: &str, meaning: &str) -> String {
    format!(
        "<abbr title=\"{}\">{}</abbr>",
        escaped(meaning),
        escaped(word)
    )
}

/// A link that saves what `address` holds as a file.
pub(super) fn saved(file: &str, address: &str) -> String {
    format!("<a download=\"{file}\" href=\"{address}\">{file}</a>")
}

/// An address that is its content (RFC 2397).
pub(super) fn address(media_type: &str, content: &str) -> String {
    let mut address = format!("data:{media_type};charset=utf-8,");
    for byte in content.bytes() {
        match byte {
            b'a'..=b'z'
            | b'A'..=b'Z'
            | b'0'..=b'9'
            | b'-'
            | b'.'
            | b'_'
            | b'~'
            | b','
            | b'/'
            | b':'
            | b'='
            | b';' => address.push(char::from(byte)),
            other => address.push_str(&format!("%{other:02X}")),
        }
    }
    address
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_has_nothing_that_ends_an_attribute_or_begins_a_tag() {
        assert_eq!(
            address("text/csv", "a,\"b\" µ<\n"),
            "data:text/csv;charset=utf-8,a,%22b%22%20%C2%B5%3C%0A"
        );
    }
}
