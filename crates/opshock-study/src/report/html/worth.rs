//! The page of what tolerances are worth: the answer, a bar for each tolerance and point, and what it rests on.

use std::fmt::Write as _;

use super::accuracy::plain_table;
use super::text::{escaped, head, signed};
use crate::report::valued::words::{Valued, plus_minus};
use crate::worth::{Change, WorthRow};

/// Width and height of a bar's picture.
const WIDE: f64 = 260.0;
const HIGH: f64 = 18.0;

/// The page.
pub(in crate::report) fn page(valued: &Valued<'_>) -> String {
    let sentences = valued.sentences();
    let (first, others) = sentences.split_first().expect("an answer has a sentence");
    let mut page = head(
        &format!("{}: what tolerances are worth", valued.answer.name),
        false,
    );
    let _ = write!(
        page,
        "<body>\n<header>\n<h1>{}: what tolerances are worth</h1>\n<p class=\"lead\">{}</p>\n",
        escaped(&valued.answer.name),
        signed(first)
    );
    for sentence in others {
        let _ = writeln!(page, "<p>{}</p>", signed(sentence));
    }
    let (header, rows) = valued.table();
    let _ = write!(
        page,
        "<p>Drive: {}.</p>\n<p class=\"quiet\">{}</p>\n</header>\n<main>\n\
         <section aria-labelledby=\"tolerances\">\n<h2 id=\"tolerances\">Tolerances</h2>\n{}</section>\n\
         <section aria-labelledby=\"points\">\n<h2 id=\"points\">Changes by point</h2>\n{}</section>\n",
        escaped(valued.drive),
        escaped(valued.program),
        plain_table(&header, &rows, 1),
        bars(valued)
    );
    let _ = write!(
        page,
        "<section aria-labelledby=\"basis\">\n<h2 id=\"basis\">What it rests on</h2>\n\
         <p>A change is the critical shock at the higher value less that at the lower one, everything else as in the study: the 15.9th \
         and 84.1th percentiles of its distribution, one standard deviation either way of a normal one. Both are found on the same \
         meshes, time steps and amplitudes, and once more a step coarser, so that numerical errors which both have cancel. The number after \
         \u{b1} bounds the rest: brackets, and three times what the change moves by coarsening. A change whose interval holds 0 cannot be \
         distinguished from none.</p>\n\
         <p>Not covered: errors of the model, what several tolerances do together, and how the change is distributed between the two values.</p>\n\
         <h3>Tolerances</h3>\n<pre>{}</pre>\n</section>\n</main>\n</body>\n</html>\n",
        escaped(valued.tolerances)
    );
    page
}

/// A table of bars: tolerances by point, all on one scale.
fn bars(valued: &Valued<'_>) -> String {
    let rows = || {
        valued
            .answer
            .rows
            .iter()
            .flat_map(|row| row.changes.iter().map(move |change| (row, change)))
    };
    let reach = |(_, change): (&WorthRow, &Change)| {
        change.change_g.unwrap_or(0.0).abs() + change.uncertainty_g.unwrap_or(0.0)
    };
    let most_g = rows().map(reach).fold(f64::MIN_POSITIVE, f64::max);
    let mut text = format!(
        "<p>The bar is the change, the line its interval; the scale ends at {most_g:.1} G either way.</p>\n\
         <div class=\"scroll\"><table>\n<thead><tr><th>tolerance</th><th>point</th><th>change</th><th class=\"n\">G</th>\
         </tr></thead>\n<tbody>\n"
    );
    for (row, change) in rows() {
        let words = match (change.change_g, change.uncertainty_g) {
            (Some(change_g), Some(half_g)) => signed(&plus_minus(change_g, half_g)),
            _ => "none found".to_owned(),
        };
        let _ = writeln!(
            text,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td class=\"n\">{words}</td></tr>",
            escaped(&row.name),
            escaped(&change.point),
            bar(change, most_g)
        );
    }
    text + "</tbody>\n</table></div>\n"
}

fn bar(change: &Change, most_g: f64) -> String {
    let (Some(change_g), Some(half_g)) = (change.change_g, change.uncertainty_g) else {
        return String::new();
    };
    let place = |value_g: f64| WIDE * (0.5 + 0.5 * value_g / most_g);
    let (from, to) = (place(change_g.min(0.0)), place(change_g.max(0.0)));
    format!(
        "<svg role=\"img\" aria-label=\"{:.1} G\" viewBox=\"0 0 {WIDE} {HIGH}\" width=\"{WIDE}\" height=\"{HIGH}\">\
         <path d=\"M{from:.1} 4H{to:.1}V14H{from:.1}z\" fill=\"var(--accent)\"/>\
         <path d=\"M{:.1} 9H{:.1}\" stroke=\"var(--ink)\" stroke-width=\"1.5\"/>\
         <path d=\"M{middle} 0V{HIGH}\" stroke=\"var(--line)\"/></svg>",
        change_g,
        place(change_g - half_g),
        place(change_g + half_g),
        middle = WIDE / 2.0
    )
}
