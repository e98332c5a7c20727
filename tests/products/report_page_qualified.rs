//! The page of a qualification in a browser: fits 1400 and 420 pixels, light and dark, and two sheets of paper.

use std::path::Path;

use opshock_study::qualification::{BoundaryPoint, DamageBoundary, Spec};
use opshock_study::report::qualified::{Boundary, Qualified, Tested, qualified_files};
use opshock_study::search::{Flag, Sign};
use opshock_study::store::summary::{PointSummary, Status, Summary, Totals};
use opshock_study::study::Study;

use crate::report_page::{FRAME, Page, chromium, pictures};

const SPEC: &str = r#"
spec_format = 1
name = "operating shock"
source = "a data sheet"

[[requirement]]
name = "400 G, 2 ms"
amplitude_g = 400
widths_ms = [2.0]

[[requirement]]
name = "250 G, short"
amplitude_g = 250
widths_ms = [0.5, 1.0]
"#;

/// Eighteen rows: three ramps, both signs, a third of them at an end of the range, some undecided, some failing.
fn table(widths_ms: &[f64], required_g: f64) -> Summary {
    let mut points = Vec::new();
    for (place, &pulse_ms) in widths_ms.iter().enumerate() {
        for (k, ramp) in ["none", "rigid", "deformable"].into_iter().enumerate() {
            for sign in [Sign::Plus, Sign::Minus] {
                let shift = if sign == Sign::Minus { 0.1 } else { 0.0 };
                let value_g = required_g * (0.8 + 0.1 * (k + place) as f64 + shift);
                let is_far = k == 0;
                points.push(PointSummary {
                    ramp: ramp.into(),
                    pulse_ms,
                    sign,
                    axes: vec![],
                    a_crit_g: (!is_far).then_some(value_g),
                    uncertainty_g: (!is_far).then_some(0.02 * value_g),
                    half_min_height_g: None,
                    survived_g: Some(if is_far {
                        1.99 * required_g
                    } else {
                        0.99 * value_g
                    }),
                    failed_g: (!is_far).then_some(1.01 * value_g),
                    contributions: vec![],
                    levels: String::new(),
                    onset_g: None,
                    runs: 40,
                    status: if is_far {
                        Status::AboveRange
                    } else {
                        Status::Ok
                    },
                    flags: match k {
                        0 => vec![],
                        _ => vec![
                            Flag::SafetyFactor3,
                            Flag::TargetNotMet,
                            Flag::RefinementLimit,
                        ],
                    },
                    brackets_g: vec![],
                    scanned_from_g: None,
                    largest_gap_pct: None,
                });
            }
        }
    }
    Summary {
        study: "s".into(),
        digest: "d".into(),
        axes: vec![],
        totals: Totals::of(&points, []),
        points,
    }
}

/// Widths of a damage boundary, one of them with a bound alone.
fn boundary() -> Boundary {
    let points = [(0.1, 2100.0), (0.5, 480.0), (2.0, 260.0), (10.0, 240.0)];
    let points = points.into_iter().map(|(pulse_ms, critical_g)| {
        let high_g = match pulse_ms {
            0.1 => f64::INFINITY,
            _ => 1.05 * critical_g,
        };
        let amplitude_g = [critical_g, high_g];
        BoundaryPoint {
            pulse_ms,
            sign: Sign::Plus,
            amplitude_g,
            open: None,
            velocity_change_m_per_s: amplitude_g.map(|g| 6.2e-3 * pulse_ms * g),
        }
    });
    Boundary {
        found: DamageBoundary::through(points.collect()).expect("a boundary"),
        shape: "half-sine",
        runs: 40,
    }
}

/// The page, with a damage boundary or without.
fn page(folder: &Path, boundary: Option<Boundary>) -> String {
    let study = folder.join("drive.toml");
    std::fs::write(&study, Study::example("my drive")).expect("written");
    std::fs::write(folder.join("spec.toml"), SPEC).expect("written");
    let spec = Spec::from_path(&folder.join("spec.toml"), &study, &[]).expect("a specification");
    let tables = [table(&[2.0], 400.0), table(&[0.5, 1.0], 250.0)];
    let tested = spec.requirements.iter().zip(&tables);
    let qualified = Qualified {
        study: "my drive",
        drive: "drive.toml",
        program: "opshock 1 (abc)",
        spec: &spec,
        tested: tested.map(|(one, table)| Tested::of(one, table)).collect(),
        boundary,
    };
    let files = qualified_files(&qualified).expect("files");
    let html = files.into_iter().find(|(name, _)| name.ends_with(".html"));
    String::from_utf8(html.expect("a page").1).expect("UTF-8")
}

const PROBE: &str = r#"<script>addEventListener("load", () => {
  const all = what => [...document.querySelectorAll(what)];
  const reported = {
    overflow: document.documentElement.scrollWidth - document.documentElement.clientWidth,
    ground: getComputedStyle(document.body).backgroundColor,
    ink: getComputedStyle(document.querySelector("td")).color,
    rows: all("tbody tr").length,
    pictures: all("td svg").length,
    unnamed: all("svg:not([aria-label])").length,
    verdict: document.querySelector("h1 span").textContent,
    letters_px: Math.min(...all("td, p, dd").map(e => parseFloat(getComputedStyle(e).fontSize))),
  };
  const pre = document.createElement("pre"); pre.id = "probe"; pre.textContent = JSON.stringify(reported);
  document.body.append(pre); parent.postMessage(pre.textContent, "*");
});</script></body>"#;

#[test]
#[ignore = "needs Chromium: make verify-report"]
fn report_page_of_a_qualification_fits_screens_and_two_sheets() {
    let browser = Page {
        browser: chromium(),
        folder: tempfile::tempdir().expect("a folder"),
    };
    let folder = browser.folder.path();
    let html = page(folder, None);
    let policy = "style-src 'unsafe-inline'";
    assert!(html.contains(policy));
    let probed = |html: &str| {
        let allowed = "style-src 'unsafe-inline'; script-src 'unsafe-inline'";
        html.replace(policy, allowed).replace("</body>", PROBE)
    };
    let bounded = probed(&page(folder, Some(boundary())));
    for (name, text) in [
        ("page.html", &html),
        ("probed.html", &probed(&html)),
        ("phone.html", &FRAME.replace("NAME", "probed.html")),
        ("bounded.html", &bounded),
        ("bounded_phone.html", &FRAME.replace("NAME", "bounded.html")),
    ] {
        std::fs::write(folder.join(name), text).expect("written");
    }
    for (scheme, ground) in [(1, "rgb(255, 255, 255)"), (0, "rgb(22, 25, 29)")] {
        let scheme = format!("--blink-settings=preferredColorScheme={scheme}");
        // Two requirements, and their 6 and 12 points; four widths more.
        for (file, size, rows) in [
            ("probed.html", "1400,2000", 20),
            ("phone.html", "500,4000", 20),
            ("bounded.html", "1400,2600", 24),
            ("bounded_phone.html", "500,5000", 24),
        ] {
            let size = format!("--window-size={size}");
            let found = browser.probe_in(file, &[&size, &scheme]);
            assert_eq!(found["overflow"], 0, "{found}");
            assert_eq!(found["ground"], ground, "{found}");
            assert_ne!(found["ink"], ground, "{found}");
            assert_eq!(
                (&found["rows"], &found["pictures"]),
                (&rows.into(), &18.into()),
                "{found}"
            );
            assert_eq!(found["unnamed"], 0, "{found}");
            assert_eq!(found["verdict"], "fails", "{found}");
            assert!(
                found["letters_px"].as_f64().expect("a size") >= 12.0,
                "{found}"
            );
            let shot = pictures().join(format!("qualification-{file}-{ground}.png"));
            browser.open(
                file,
                &[&size, &scheme, &format!("--screenshot={}", shot.display())],
            );
        }
    }
    let pdf = pictures().join("qualification.pdf");
    browser.open(
        "page.html",
        &[
            "--no-pdf-header-footer",
            &format!("--print-to-pdf={}", pdf.display()),
        ],
    );
    let bytes = std::fs::read(&pdf).expect("a PDF");
    let text = String::from_utf8_lossy(&bytes);
    let sheets = text.matches("/Type /Page").count() - text.matches("/Type /Pages").count();
    assert!((1..=2).contains(&sheets), "{sheets} sheets");
}
