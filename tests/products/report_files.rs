//! Tables, figure and HTML page made from a summary.

use opshock_solver::simulation::Mechanism;
use opshock_study::accuracy::{Accuracy, Measured, PointStudies, SettingRow};
use opshock_study::report::html::html;
use opshock_study::report::{ReportSource, RunDot, critical_shock_figure, report_files, table};
use opshock_study::search::Sign;
use opshock_study::store::aside::write_all;
use opshock_study::store::summary::{
    AxisValue, Contribution, Flag, PointSummary, Status, Summary, Totals,
};

const PROGRAM: &str = "opshock 1 (abc)";

fn point(ramp: &str, pulse_ms: f64, sign: Sign, status: Status) -> PointSummary {
    let known = status == Status::Ok;
    PointSummary {
        ramp: ramp.into(),
        pulse_ms,
        sign,
        axes: vec![AxisValue::Number(60.0)],
        a_crit_g: known.then_some(367.125),
        uncertainty_g: known.then_some(2.375),
        half_min_height_g: None,
        survived_g: (status != Status::BelowRange).then_some(366.25),
        failed_g: (status != Status::AboveRange).then_some(369.5),
        contributions: vec![],
        levels: String::new(),
        onset_g: (ramp != "none").then_some(195.5),
        runs: 12,
        status,
        flags: if known {
            vec![]
        } else {
            vec![Flag::Retry, Flag::NonMonotone]
        },
        brackets_g: vec![],
        scanned_from_g: None,
        largest_gap_pct: None,
    }
}

/// Two ramps, two signs, two widths; one point above and one below the range.
fn summary() -> Summary {
    let mut points = Vec::new();
    for ramp in ["none", "rigid"] {
        for sign in [Sign::Plus, Sign::Minus] {
            points.push(point(ramp, 0.5, sign, Status::Ok));
            points.push(point(ramp, 2.0, sign, Status::Ok));
        }
    }
    points[0] = point("none", 0.5, Sign::Plus, Status::AboveRange);
    points[7] = point("rigid", 2.0, Sign::Minus, Status::BelowRange);
    Summary {
        study: "60 µm & <script>alert(1)</script>".into(),
        digest: "0123abcd".into(),
        axes: vec!["ramp.clearance_um".into()],
        points,
        totals: Totals {
            points: 8,
            ok: 6,
            above_range: 1,
            below_range: 1,
            runs: 96,
            ..Totals::default()
        },
    }
}

fn runs() -> Vec<RunDot> {
    let dot = |amplitude_g: f64, verdict: &str| RunDot {
        point: 1,
        amplitude_g,
        verdict: verdict.into(),
        h_min_m: Some(2e-9),
        mechanism: (verdict == "fails").then_some(Mechanism::LiftLoss),
    };
    vec![
        dot(366.25, "survives"),
        dot(369.5, "fails"),
        dot(500.0, "undecided"),
    ]
}

/// Panics when tags do not nest. Good enough for our own output: no CDATA, no `>` in attributes.
fn assert_nested(text: &str, void: &[&str]) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = text;
    while let Some(start) = rest.find('<') {
        rest = &rest[start..];
        if rest.starts_with("<!--") {
            rest = &rest[rest.find("-->").expect("an end of the comment")..];
            continue;
        }
        let end = rest.find('>').expect("an end of the tag");
        let tag = &rest[1..end];
        let name = tag.trim_start_matches('/');
        let name = name.split([' ', '\n', '/']).next().unwrap_or("");
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') && !tag.starts_with('!') && !void.contains(&name) {
            open.push(name);
            if name == "script" || name == "style" {
                rest = &rest[rest.find(&format!("</{name}>")).expect("its end")..];
                continue;
            }
        }
        rest = &rest[end + 1..];
    }
    assert!(open.is_empty(), "left open: {open:?}");
}

#[test]
fn csv_has_the_documented_header_and_empty_cells_for_what_is_missing() {
    let text = table::csv(&summary());
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines[0],
        "ramp,pulse_ms,sign,ramp.clearance_um,a_crit_g,uncertainty_g,half_min_height_g,survived_g,failed_g,onset_g,runs,status,flags"
    );
    assert_eq!(
        lines[1],
        "none,0.5,+,60,,,,366.25,,,12,above_range,retry;non_monotone"
    );
    assert_eq!(lines[2], "none,2,+,60,367.125,2.375,,366.25,369.5,,12,ok,");
    assert_eq!(
        lines[8],
        "rigid,2,-,60,,,,,369.5,195.5,12,below_range,retry;non_monotone"
    );
}

#[test]
fn csv_without_further_axes_has_exactly_twelve_columns() {
    let mut summary = summary();
    summary.axes.clear();
    summary
        .points
        .iter_mut()
        .for_each(|point| point.axes.clear());
    let text = table::csv(&summary);
    assert_eq!(
        text.lines().next(),
        Some(
            "ramp,pulse_ms,sign,a_crit_g,uncertainty_g,half_min_height_g,survived_g,failed_g,onset_g,runs,status,flags"
        )
    );
}

#[test]
fn markdown_and_terminal_say_what_is_only_a_bound() {
    let markdown = table::markdown(&summary(), "The answer.", "opshock 1 (abc)");
    assert!(
        markdown.contains("| none | 0.5 | + | 60 | > 366.2 |  | 366.2 |  |"),
        "{markdown}"
    );
    assert!(markdown.contains("| < 369.5 |  |  | 369.5 |"), "{markdown}");
    let columns: Vec<usize> = markdown
        .lines()
        .filter(|line| line.starts_with('|'))
        .map(|line| line.matches('|').count())
        .collect();
    assert_eq!(columns, [13; 10]);
    let terminal = table::terminal(&summary());
    assert!(
        terminal.contains(
            "8 points: 6 critical shocks found, 1 above the searched range, 1 below the searched range; 96 simulations"
        ),
        "{terminal}"
    );
}

#[test]
fn the_figure_is_nested_svg_and_a_png_three_times_its_size() {
    let figure = critical_shock_figure(&summary(), "opshock 1 (abc)");
    let svg = figure.svg();
    assert_nested(&svg, &[]);
    assert!(
        svg.starts_with("<svg viewBox=\"0 0 1232 "),
        "{}",
        &svg[..80]
    );
    assert!(svg.contains("Critical shock (G)") && svg.contains("Pulse width (ms)"));
    assert!(!svg.contains("<script"), "names of studies are text");
    // One mark for each row, and the worst sign of two ramps at two widths, with what a pointer resting on it shows.
    assert_eq!(svg.matches("<title>").count(), 8 + 4);
    let png = figure.png().expect("a picture");
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    let width = u32::from_be_bytes([png[16], png[17], png[18], png[19]]);
    assert_eq!(width, 3 * 1232);
}

#[test]
fn the_page_is_nested_names_no_other_file_and_shows_every_row_and_run() {
    let (summary, runs) = (summary(), runs());
    let page = html(&ReportSource {
        resolved_study: Some("name = \"<b>\"\n"),
        ..ReportSource::of_table(&summary, &runs, PROGRAM)
    });
    assert_nested(&page, &["meta", "br"]);
    assert!(page.contains("default-src 'none'"));
    let without_namespace = page
        .replace("http://www.w3.org/2000/svg", "")
        .replace("href=\"#", "")
        .replace("href=\"data:", "")
        .replace("url(#", "");
    for reference in [
        "http:", "https:", "src=", "href=", "url(", "@import", "fetch(",
    ] {
        assert!(!without_namespace.contains(reference), "{reference}");
    }
    assert!(!page.contains("<script>alert"));
    // The table, and the simulations of the one point that has some.
    assert_eq!(page.matches("<tr data-point").count(), 8);
    assert_eq!(page.matches("<article class=\"page\"").count(), 8);
    assert_eq!(page.matches("<tr class=\"fails\">").count(), 1);
    assert_eq!(page.matches("class=\"reserved\"").count(), 2);
    assert!(page.contains("369.5 G: fails (lift loss), clearance 2.00 nm"));
    assert_eq!(page.matches("<td>lift loss</td>").count(), 1);
    assert!(page.contains("fails: lift loss"));
    assert!(page.contains("name = &quot;&lt;b&gt;&quot;"));
}

/// A joint refinement study of two settings, the first on the front.
fn accuracy() -> Accuracy {
    let setting = |value: &str, error: f64, wall_s: f64, is_on_front: bool| SettingRow {
        parameter: "joint".into(),
        value: value.into(),
        fineness: 1.0 / error,
        is_reference: false,
        errors: [Some(error); 7],
        wall_s: Some([wall_s; 3]),
        is_on_front,
        measured: Measured::default(),
    };
    Accuracy {
        study: "small".into(),
        digest: "4567".into(),
        program: "opshock 1 (abc)".into(),
        points: vec![PointStudies {
            label: "rigid 0.5 ms +".into(),
            probe_g: 180.0,
            settings: vec![
                setting("coarse", 0.04, 0.25, true),
                setting("standard", 0.05, 0.5, false),
            ],
            orders: Vec::new(),
        }],
    }
}

#[test]
fn the_page_says_what_uncertainties_are_made_of_and_what_accuracy_costs() {
    let mut summary = summary();
    let part = |high_g: f64, factor: f64| Contribution {
        low_g: high_g,
        high_g,
        factor,
    };
    summary.points[2].contributions = vec![
        ("search".to_owned(), part(3.6625, 1.0)),
        ("disk_modes".to_owned(), part(7.325, 3.0)),
    ];
    let accuracy = accuracy();
    let source = ReportSource {
        accuracy: Some(&accuracy),
        plan: r#"{"ramps": {"rigid": {"effects": {"disk": "on", "hub": "off"}, "rules_below_touch": ["R4"]}}}"#,
        ..ReportSource::of_table(&summary, &[], PROGRAM)
    };
    let page = html(&source);
    assert_nested(&page, &["meta", "br"]);
    assert_eq!(page.matches(">Accuracy</h2>").count(), 1);
    // 1 % and 2 % of 366.25 G, the second with safety factor 3.
    assert!(page.contains("<td class=\"n\">1.00</td>"));
    assert!(page.contains("<td class=\"n\">2.00 SF 3</td>"));
    assert!(page.contains("aria-label=\"Error against time, rigid 0.5 ms +\""));
    assert!(page.contains("<td><strong>coarse</strong></td>"));
    assert!(page.contains("<td>standard</td>"));
    assert!(page.contains("<td class=\"n\">0.250</td>"));
    assert!(page.contains(
        "<td class=\"wrap\">disk</td><td class=\"wrap\">hub</td><td class=\"wrap\">R4</td>"
    ));
    let without = html(&ReportSource {
        accuracy: None,
        ..source
    });
    assert!(!without.contains("work-precision") && !without.contains("Error against time"));
}

#[test]
fn a_report_is_the_same_bytes_twice() {
    let (summary, runs) = (summary(), runs());
    let source = ReportSource::of_table(&summary, &runs, PROGRAM);
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let names = folders.each_ref().map(|folder| {
        let made = report_files(&source).unwrap();
        let written = write_all(&folder.path().join("new/folder"), made).unwrap();
        written
            .iter()
            .map(|path| std::fs::read(path).unwrap())
            .collect::<Vec<_>>()
    });
    assert_eq!(names[0].len(), 5);
    assert_eq!(names[0], names[1]);
}

#[test]
fn an_empty_or_unfinished_study_still_makes_a_report() {
    let mut open = summary();
    for point in &mut open.points {
        *point = PointSummary {
            a_crit_g: None,
            survived_g: None,
            failed_g: None,
            status: Status::Open,
            ..self::point("rigid", point.pulse_ms, point.sign, Status::Ok)
        };
    }
    let mut empty = summary();
    empty.points.clear();
    for summary in [open, empty] {
        let source = ReportSource::of_table(&summary, &[], "");
        assert_eq!(report_files(&source).unwrap().len(), 5);
    }
}
