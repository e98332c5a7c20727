//! The page of a population: share that survives, fragility, what matters, the worst drives; two sheets when printed.

use std::fmt::Write as _;

use super::accuracy::plain_table;
use super::text::{escaped, figure, head};
use crate::report::populated::figure::fragility_figure;
use crate::report::populated::words::Populated;

/// The page.
pub(in crate::report) fn page(populated: &Populated<'_>) -> String {
    let sentences = populated.sentences();
    let (first, others) = sentences.split_first().expect("an answer has a sentence");
    let mut page = head(&populated.answer.name, false);
    let _ = write!(
        page,
        "<body>\n<header>\n<h1>{}</h1>\n<p class=\"lead\">{}</p>\n",
        escaped(&populated.answer.name),
        escaped(first)
    );
    for sentence in others {
        let _ = writeln!(page, "<p>{}</p>", escaped(sentence));
    }
    let _ = write!(
        page,
        "<p>Drive: {}.</p>\n<p class=\"quiet\">{}</p>\n</header>\n<main>\n",
        escaped(populated.drive),
        escaped(populated.program)
    );
    let table =
        |(header, rows): (Vec<String>, Vec<Vec<String>>), words| plain_table(&header, &rows, words);
    section(
        &mut page,
        "Requirements",
        &format!(
            "{}<p>Decided by a finer shock: drives with a point whose outcome or clearance a coarser resolution left open. \
             Decided by uncertainty interval: drives with a point of which the shocks did not agree.</p>\n",
            table(populated.requirements(), 1)
        ),
    );
    let drawn = fragility_figure(populated);
    if drawn.panels.iter().any(|panel| !panel.series.is_empty()) {
        section(
            &mut page,
            "Fragility",
            &format!(
                "{}<p>Share of the first {} drives that fail at or below an amplitude, at the worse sign and ramp model of each pulse width; \
                 amplitudes are an eighth of an octave apart. The fit is a help to the eye: no verdict rests on it.</p>\n",
                figure(
                    &drawn.inline_svg(),
                    "Share of drives that fail against amplitude"
                ),
                populated.answer.fragility_drives
            ),
        );
    }
    if !populated.answer.sensitivity.is_empty() {
        section(
            &mut page,
            "Which tolerance matters",
            &format!(
                "{}<p>How much of the variance of the verdict (survives, or not) a tolerance explains by itself, and the share of drives that do \
             not survive where its value is low, in the middle and high. A tolerance is significant when it explains more than 95 % of \
             random permutations of the verdicts do. What tolerances do together is not in these numbers.</p>\n",
                table(populated.sensitivities(), 1)
            ),
        );
    }
    section(
        &mut page,
        "Worst drives",
        &format!(
            "{}<p>Each is beside this page as a study, drive-N.toml. Of drives that survive, those decided by their uncertainty \
             interval come first, then those with the smallest clearance. The highest amplitude is the highest that was tested; the lowest \
             failed one is sought of drives that fail and of those of the fragility curve, and blank elsewhere. The clearance is the smallest at \
             the higher survivor of the two amplitudes of the verdict.</p>\n",
            table(populated.worst(), populated.worst().0.len())
        ),
    );
    let source = |source: &Option<String>| match source {
        Some(source) => format!("<p>Source: {}</p>\n", escaped(source)),
        None => String::new(),
    };
    section(
        &mut page,
        "What it rests on",
        &format!(
            "<p>{}</p>\n<p>Not covered: errors of the model, tolerances and dependences that the file does not name, other pulses.</p>\n\
             <h3>Tolerances</h3>\n{}<pre>{}</pre>\n<h3>Specification</h3>\n{}<pre>{}</pre>\n",
            escaped(&populated.basis()),
            source(&populated.tolerances.source),
            escaped(&populated.tolerances.text),
            source(&populated.spec.source),
            escaped(&populated.spec.text)
        ),
    );
    page + "</main>\n</body>\n</html>\n"
}

fn section(page: &mut String, title: &str, content: &str) {
    let id = title.to_lowercase().replace(' ', "-");
    let _ = write!(
        page,
        "<section aria-labelledby=\"{id}\">\n<h2 id=\"{id}\">{title}</h2>\n{content}</section>\n"
    );
}
