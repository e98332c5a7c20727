//! The page of a qualification: verdict, reserves, every point, and what the verdicts rest on; two sheets when printed.

use std::fmt::Write as _;

use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;

use super::accuracy::plain_table;
use super::main_table::flags;
use super::text::{escaped, explained, figure, head, signed};
use super::words;
use crate::qualification::{PointVerdict, Verdict, pulse_shape};
use crate::report::coordinates;
use crate::report::qualified::answer::{Qualified, Tested, critical_words, reserve_words};
use crate::report::terms;
use crate::search::decisive::FAR;
use crate::store::summary::{PointSummary, Status};

/// Width and height of the picture of a point, and where the required amplitude is in it.
const WIDE: f64 = 180.0;
const HIGH: f64 = 18.0;

/// The page.
pub fn page(qualified: &Qualified<'_>) -> String {
    let sentences = qualified.sentences();
    let (first, others) = sentences.split_first().expect("an answer has a sentence");
    let verdict = qualified.verdict().as_str();
    let mut page = head(&format!("{}: {verdict}", qualified.study), false);
    let _ = write!(
        page,
        r##"<body>
<header>
<h1>{study}: <span class="{verdict}">{verdict}</span></h1>
<p class="lead">{first}</p>
"##,
        study = escaped(qualified.study),
        first = signed(first),
    );
    for sentence in others {
        let _ = writeln!(page, "<p>{}</p>", signed(sentence));
    }
    let _ = write!(
        page,
        "<p>Drive: {}. A point is one ramp model, pulse width and sign of the shock; a shock of sign + moves the disk towards the slider \
         first. <a href=\"#basis\">What the verdicts rest on</a>.</p>\n<p class=\"quiet\">{} simulations. {}</p>\n</header>\n<main>\n\
         <section aria-labelledby=\"requirements\">\n<h2 id=\"requirements\">Requirements</h2>\n{}</section>\n",
        escaped(qualified.drive),
        qualified.runs(),
        escaped(qualified.program),
        requirements(qualified)
    );
    for (place, tested) in qualified.tested.iter().enumerate() {
        let _ = write!(
            page,
            "<section aria-labelledby=\"requirement-{place}\">\n<h2 id=\"requirement-{place}\">{}: \
             <span class=\"{verdict}\">{verdict}</span></h2>\n{}</section>\n",
            escaped(&tested.requirement.name),
            points(tested),
            verdict = tested.found.verdict.as_str()
        );
    }
    if let Some(boundary) = &qualified.boundary {
        let (header, rows) = boundary.table();
        let sentences = boundary.sentences();
        let _ = write!(
            page,
            "<section aria-labelledby=\"boundary\">\n<h2 id=\"boundary\">Damage boundary</h2>\n<p>{}</p>\n{}{}\
             <p>A shock of a tested width that fails has at least both critical values (ASTM D3332): it lies to the right of the vertical line \
             and above the horizontal one. The lines are drawn at the lower ends, and not where these are unknown.</p>\n</section>\n",
            signed(&sentences.join(" ")),
            figure(
                &boundary.figure().inline_svg(),
                "Amplitude against velocity change"
            ),
            plain_table(&header, &rows, 0)
        );
    }
    let _ = write!(
        page,
        "<section aria-labelledby=\"basis\">\n<h2 id=\"basis\">What the verdicts rest on</h2>\n{}</section>\n\
         </main>\n</body>\n</html>\n",
        basis(qualified)
    );
    page
}

/// A line for each requirement.
fn requirements(qualified: &Qualified<'_>) -> String {
    let header = [
        "requirement",
        "amplitude (G)",
        "margin asked (%)",
        "required (G)",
        "met?",
        "points that pass",
        "the point that decides",
        "its reserve",
    ]
    .map(String::from);
    let rows: Vec<Vec<String>> = qualified
        .tested
        .iter()
        .map(|one| {
            let worst = one.worst();
            vec![
                one.requirement.name.clone(),
                format!("{:.1}", one.requirement.amplitude_g),
                format!("{:.1}", one.requirement.margin_pct),
                format!("{:.1}", one.requirement.required_g()),
                one.found.verdict.as_str().to_owned(),
                format!(
                    "{} of {}",
                    one.count(Verdict::Passes),
                    one.found.points.len()
                ),
                worst.map_or(String::new(), |(row, _)| {
                    format!(
                        "{}: {}",
                        coordinates::name(one.summary, row),
                        critical_words(row)
                    )
                }),
                worst.map_or(String::new(), |(row, at)| reserve_words(row, at)),
            ]
        })
        .collect();
    plain_table(&header, &rows, header.len())
}

/// Every point of a requirement with its interval against the required amplitude.
fn points(tested: &Tested<'_>) -> String {
    let required_g = tested.requirement.required_g();
    let changes = tested.requirement.velocity_changes_m_per_s();
    let shape = pulse_shape(&tested.requirement.study);
    // A fall that stops without rebound.
    let falls = changes.map(|change| change * change / (2.0 * STANDARD_GRAVITY_M_PER_S2));
    let mut text = format!(
        "<p>Required: {required_g:.1} G, a velocity change of {} m/s, as at the end of a free fall of {} m. Shape of the pulse: {shape}. In the \
         pictures the line is the required amplitude, the bar where the critical shock may lie, an arrow \
         where it lies beyond a quarter or four times the required amplitude.</p>\n\
         <div class=\"scroll\"><table>\n<thead><tr><th>point</th><th>verdict</th><th>{}</th>\
         <th class=\"n\">critical shock</th><th class=\"n\">reserve</th><th>flags</th></tr></thead>\n<tbody>\n",
        span(changes),
        span(falls),
        explained(
            "picture",
            "Critical shock over required amplitude, from 1/4 to 4"
        )
    );
    for (row, at) in tested.rows() {
        let why = at
            .open
            .map_or(String::new(), |open| format!(": {}", open.words()));
        let _ = writeln!(
            text,
            "<tr><th scope=\"row\">{}</th><td class=\"wrap\"><span class=\"{verdict}\">{verdict}</span>{}</td><td>{}</td>\
             <td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"wrap\">{}</td></tr>",
            escaped(&coordinates::name(tested.summary, row)),
            escaped(&why),
            picture(row, at, required_g),
            signed(&critical_words(row)),
            escaped(&reserve_words(row, at)),
            flags(row),
            verdict = at.verdict.as_str()
        );
    }
    text + "</tbody>\n</table></div>\n"
}

/// Two numbers, or one where they look the same.
fn span([low, high]: [f64; 2]) -> String {
    let (low, high) = (format!("{low:.2}"), format!("{high:.2}"));
    match low == high {
        true => low,
        false => format!("{low} to {high}"),
    }
}

/// Bar from the lower to the upper end of a point's interval, and the required amplitude as a line.
fn picture(row: &PointSummary, at: &PointVerdict, required_g: f64) -> String {
    let Some([low_g, high_g]) = at.interval_g else {
        return String::new();
    };
    // Logarithmic, the required amplitude in the middle.
    let place = |amplitude_g: f64| {
        let octaves = (amplitude_g / required_g).log2() / FAR.log2();
        WIDE * (0.5 + 0.5 * octaves.clamp(-1.0, 1.0))
    };
    let (from, to) = (place(low_g), place(high_g));
    let label = format!("{} against {required_g:.1} G", critical_words(row));
    // An open end is an arrow.
    let drawn = match row.status {
        Status::AboveRange => format!("M{} 3l10 6l-10 6z", WIDE - 10.0),
        Status::BelowRange => "M10 3l-10 6l10 6z".to_owned(),
        _ => format!("M{from:.1} 4H{:.1}V14H{from:.1}z", to.max(from + 2.0)),
    };
    format!(
        "<svg role=\"img\" aria-label=\"{}\" viewBox=\"0 0 {WIDE} {HIGH}\" width=\"{WIDE}\" height=\"{HIGH}\">\
         <path d=\"M0 {middle}H{WIDE}\" stroke=\"var(--line)\"/>\
         <path d=\"{drawn}\" fill=\"var(--accent)\"/>\
         <path d=\"M{required:.1} 0V{HIGH}\" stroke=\"var(--ink)\" stroke-width=\"1.5\"/></svg>",
        signed(&label),
        middle = HIGH / 2.0,
        required = WIDE / 2.0
    )
}

/// Rule of the verdicts, words, specification.
fn basis(qualified: &Qualified<'_>) -> String {
    let mut text = String::from(
        "<p>The critical shock is the largest amplitude up to which every simulated shock is survived: the slider does not touch \
         the disk, or is not damaged where the study calls that failure (failure.criterion). A point passes when the whole numerical uncertainty interval of its critical shock lies at or above \
         the required amplitude, and fails when it lies below. The reserve is the critical shock less what is required; behind it, where \
         that may lie. The number after \u{b1} is the half-width of the interval, an estimated bound and no standard deviation: it has the \
         search's own tolerance and the errors of meshes and time steps.</p>\n\
         <p>Points whose interval contains the required amplitude are refined, until they meet the target uncertainty; none is refined \
         where another point fails already. A refined critical shock may lie anywhere in the interval it had. Where a verdict stays \
         open: a smaller target (search.target_uncertainty_pct), a finer resolution preset, or a reserve in the design.</p>\n\
         <p>Not covered: errors of the model and of the drive's data, tolerances of its parts, other pulse widths and shapes, other directions, \
         damage without touch, and amplitudes between those simulated.</p>\n<p>\u{201c}more than\u{201d} and \u{201c}less than\u{201d}: the \
         point survives about four times the required amplitude, or fails at a quarter of it or less, and no interval is made. A flag \
         beside a verdict changes it only where the verdict names it as its reason.</p>\n",
    );
    let rows = qualified.tested.iter().flat_map(|one| &one.summary.points);
    let all: Vec<PointSummary> = rows.cloned().collect();
    let known = terms::flags_of(&all);
    if !known.is_empty() {
        text.push_str("<h3>Flags</h3>\n");
        text.push_str(&words::list(&known));
    }
    let source = qualified.spec.source.as_deref();
    let source = source.map_or(String::new(), |source| {
        format!("<p>Source: {}</p>\n", escaped(source))
    });
    let _ = write!(
        text,
        "<h3>Specification</h3>\n{source}<pre>{}</pre>\n",
        escaped(&qualified.spec.text)
    );
    text
}
