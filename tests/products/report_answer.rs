//! What a report leads with, over which axis it draws, and that every word of it is explained.

use opshock_study::report::answer::Answer;
use opshock_study::report::chart::{Figure, Value};
use opshock_study::report::comparison::Significance;
use opshock_study::report::html::html;
use opshock_study::report::terms;
use opshock_study::report::{
    ReportSource, coordinates, critical_shock_figure, critical_shock_over,
};
use opshock_study::search::Sign;
use opshock_study::store::summary::{AxisValue, Flag, PointSummary, Status, Summary, Totals};

const CLEARANCES_UM: [f64; 5] = [40.0, 60.0, 80.0, 100.0, 120.0];
const WIDTHS_MS: [f64; 2] = [0.5, 2.0];

/// Five clearances, two widths, two signs: 100 + clearance + 100 for 2 ms + 20 for minus, with intervals of this half.
fn five_clearances(half_g: f64) -> Summary {
    let mut points = Vec::new();
    for um in CLEARANCES_UM {
        for sign in [Sign::Plus, Sign::Minus] {
            for ms in WIDTHS_MS {
                let minus = if sign == Sign::Minus { 20.0 } else { 0.0 };
                let crit = 100.0 + um + 100.0 * f64::from(u8::from(ms > 1.0)) + minus;
                points.push(PointSummary {
                    ramp: "rigid".into(),
                    pulse_ms: ms,
                    sign,
                    axes: vec![AxisValue::Number(um)],
                    a_crit_g: Some(crit),
                    uncertainty_g: Some(half_g),
                    half_min_height_g: None,
                    survived_g: Some(crit - 0.5),
                    failed_g: Some(crit + 0.5),
                    contributions: vec![],
                    levels: String::new(),
                    onset_g: Some(90.0),
                    runs: 9,
                    status: Status::Ok,
                    flags: vec![],
                    brackets_g: vec![],
                    scanned_from_g: None,
                    largest_gap_pct: None,
                });
            }
        }
    }
    Summary {
        study: "clearances".into(),
        digest: "0123".into(),
        axes: vec!["clearance_um".into()],
        totals: Totals {
            points: points.len() as u64,
            ok: points.len() as u64,
            ..Totals::default()
        },
        points,
    }
}

#[test]
fn the_first_sentence_has_range_worst_case_and_the_best_value_with_its_lead() {
    let first = |half_g: f64| Answer::of(&five_clearances(half_g)).sentences()[0].clone();
    let head = |half: &str| {
        format!(
            "Critical shocks range from 140.0 G (the worst case: rigid ramp, 0.5 ms, sign +, clearance_um = 40, \
             uncertainty \u{b1}{half} G) to 340.0 G; the best clearance_um is 120, whose worst case, 220.0 G, is \
             20.0 G (10.0 %) above that of the next, 100, a lead "
        )
    };
    // 200 and 220 G: intervals of 8 G do not meet, of 12 G they do.
    assert_eq!(
        first(8.0),
        head("8.0") + "beyond the uncertainty intervals."
    );
    assert_eq!(
        first(12.0),
        head("12.0") + "within the uncertainty intervals: not significant."
    );
    let summary = five_clearances(12.0);
    let answer = Answer::of(&summary);
    assert_eq!(answer.axes.len(), 1, "one ramp model is no choice");
    let choice = &answer.axes[0];
    let ranked: Vec<String> = choice
        .ranks
        .iter()
        .map(|rank| rank.value.to_string())
        .collect();
    assert_eq!(ranked, ["120", "100", "80", "60", "40"]);
    // 180 against 220 G: 12 G on each side leave a gap of 16 G.
    assert_eq!(choice.significance(2), Significance::BeyondUncertainties);
    assert!((choice.behind_pct(4) - 100.0 * (1.0 - 140.0 / 220.0)).abs() < 1e-12);
}

#[test]
fn points_without_answer_and_bounds_are_said() {
    let mut summary = five_clearances(1.0);
    for point in summary.points.iter_mut().take(2) {
        point.status = Status::Open;
        (point.a_crit_g, point.survived_g, point.failed_g) = (None, None, None);
    }
    summary.points[19].status = Status::AboveRange;
    let first = Answer::of(&summary).sentences().remove(0);
    assert!(
        first.contains(" to more than 339.5 G, 2 of 20 points without answer;"),
        "{first}"
    );
    summary.points.clear();
    let none = Answer::of(&summary).sentences();
    assert_eq!(none, ["No critical shock is known yet."]);
    let mut begun = five_clearances(1.0);
    begun.points[3].status = Status::Open;
    let said = Answer::of(&begun).sentences().join(" ");
    assert!(
        said.contains("1 of 20 points with a bracket alone so far"),
        "{said}"
    );
}

fn titles(figure: &Figure) -> Vec<&str> {
    figure
        .panels
        .iter()
        .map(|panel| panel.title.as_str())
        .collect()
}

#[test]
fn the_axis_with_most_numbers_is_on_the_abscissa_and_every_other_one_can_be() {
    let summary = five_clearances(5.0);
    let figure = critical_shock_figure(&summary, "");
    let signs = [
        "worst of all signs",
        "sign +: disk first towards the slider",
        "sign \u{2212}: disk first away from the slider",
    ];
    assert_eq!(titles(&figure), signs);
    for panel in &figure.panels {
        assert_eq!(panel.x.label, "clearance_um");
        let names: Vec<&str> = panel
            .series
            .iter()
            .map(|series| series.name.as_str())
            .collect();
        assert_eq!(names, ["0.5 ms", "2 ms"]);
        for series in &panel.series {
            let x: Vec<f64> = series.samples.iter().map(|sample| sample.x).collect();
            assert_eq!(x, CLEARANCES_UM);
        }
    }
    // The worst sign is plus, 20 G below minus.
    let height = |panel: usize| match figure.panels[panel].series[1].samples[3].value {
        Value::Known { y, low, high } => [y, low, high],
        _ => panic!("known"),
    };
    assert_eq!(height(0), [300.0, 295.0, 305.0]);
    assert_eq!((height(1)[0], height(2)[0]), (300.0, 320.0));

    let pulse = coordinates::find(&summary, "--x", "pulse_ms").unwrap();
    let over = critical_shock_over(&summary, pulse, "");
    assert_eq!(
        over.panels[1].series.len(),
        5,
        "a colour for each clearance"
    );
    let sign = coordinates::find(&summary, "--x", "pulse.signs").unwrap();
    let over = critical_shock_over(&summary, sign, "");
    // Five clearances in colours; two widths would make ten lines, so they have a panel each.
    assert_eq!(titles(&over), ["0.5 ms", "2 ms"]);
    assert_eq!(over.panels[0].x.names, ["+", "-"]);
    assert_eq!(
        coordinates::find(&summary, "--x", "ramp.clearance_um"),
        Ok(3)
    );
}

#[test]
fn heads_are_one_drive_and_its_worst_one_counts() {
    let mut summary = five_clearances(5.0);
    summary.axes = vec!["head".into()];
    for point in &mut summary.points {
        point.axes = vec![AxisValue::Text(point.axes[0].to_string())];
    }
    let figure = critical_shock_figure(&summary, "");
    assert_eq!(figure.panels[0].title, "worst of all signs and heads");
    assert_eq!(figure.panels[0].x.label, "Pulse width (ms)");
    let worst = &figure.panels[0].series;
    assert_eq!(worst.len(), 1);
    assert!(
        worst[0].samples[0]
            .note
            .starts_with("lowest: rigid ramp, 0.5 ms, sign +, head = 40: ")
    );
    assert!(
        Answer::of(&summary).axes.is_empty(),
        "no one chooses among heads"
    );
}

#[test]
fn the_page_leads_with_the_answer_and_explains_every_column_and_flag() {
    let mut summary = five_clearances(5.0);
    for (point, flag) in summary.points.iter_mut().zip(Flag::ALL) {
        point.flags = vec![flag];
    }
    let source = ReportSource::of_table(&summary, &[], "opshock 1 (abc)");
    let page = html(&source);
    let place = |text: &str| page.find(text).unwrap_or_else(|| panic!("{text}"));
    assert!(
        place("<p class=\"lead\">Critical shocks range from") < place("<section id=\"critical\"")
    );
    assert!(place("<section id=\"critical\"") < place("<section id=\"table\""));
    let escaped = |text: &str| {
        text.replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('>', "&gt;")
            .replace('"', "&quot;")
    };
    let words = &page[place("<section id=\"words\"")..];
    for flag in Flag::ALL {
        let term = terms::of_flag(flag);
        let text = escaped(term.text);
        assert!(
            page.contains(&format!("<abbr title=\"{text}\">{}</abbr>", term.shown)),
            "{flag:?}"
        );
        assert!(
            words.contains(&format!("<dt>{}</dt><dd>{text}</dd>", term.shown)),
            "{flag:?}"
        );
    }
    for column in [
        "ramp",
        "sign",
        "A_crit (G)",
        "uncertainty (G)",
        "first touch (G)",
        "flags",
    ] {
        let text = escaped(terms::of_column(column));
        assert!(
            page.contains(&format!("title=\"{text}\">{column}</button>")),
            "{column}"
        );
        assert!(
            words.contains(&format!("<dt>{column}</dt><dd>{text}</dd>")),
            "{column}"
        );
    }
    // A shaded row does not say that all is well.
    let rows: Vec<&str> = page.split("<tr data-point").skip(1).collect();
    assert_eq!(rows.len(), 20);
    for (row, point) in rows.iter().zip(&summary.points) {
        let row = &row[..row.find("</tr>").unwrap()];
        let is_shaded = row.contains("class=\"reserved\"");
        assert_eq!(is_shaded, terms::is_reserved(point));
        assert_eq!(row.contains(">found</abbr>"), !is_shaded, "{row}");
        assert_eq!(row.contains(">found, see flags</abbr>"), is_shaded, "{row}");
    }
    assert_eq!(
        rows.iter()
            .filter(|row| row.contains("class=\"reserved\""))
            .count(),
        13
    );
    // Data and picture are in the page.
    for (file, kind) in [
        ("table.csv", "text/csv"),
        ("table.json", "application/json"),
        ("critical_shock.svg", "image/svg+xml"),
    ] {
        assert!(
            page.contains(&format!("<a download=\"{file}\" href=\"data:{kind};")),
            "{file}"
        );
    }
    // Dark pages repaint the colours of figures; a legend has a drawing for every line.
    assert!(page.contains(
        "@media screen and (prefers-color-scheme: dark){[fill=\"#ffffff\"]{fill:#16191d}"
    ));
    let keys = &page[place("<ul class=\"keys\">")..];
    let keys = &keys[..keys.find("</ul>").unwrap()];
    assert_eq!(keys.matches("<svg").count(), 2);
    assert!(
        keys.contains("0.5 ms</li>") && keys.contains("2 ms</li>"),
        "{keys}"
    );
}
