//! Escapes text and labels figures for a page.

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
