//! The report in a browser: what a person sees and touches, in headless Chromium.

use opshock_solver::simulation::Mechanism;
use opshock_study::report::html::html;
use opshock_study::report::{ReportSource, RunDot, ShockFilm};
use opshock_study::search::Sign;
use opshock_study::store::summary::{Flag, PointSummary, Status, Summary, Totals};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const RAMPS: [&str; 3] = ["none", "rigid", "deformable"];
const WIDTHS_MS: [f64; 6] = [0.5, 0.75, 1.0, 1.5, 2.0, 3.0];

pub fn chromium() -> PathBuf {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let found = std::env::split_paths(&path)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|candidate| candidate.is_file());
    found.expect("Chromium on PATH: scripts/bootstrap --verify")
}

/// Three ramps, two signs, six widths, 36 rows as in the paper's figure: values that rise with the width and differ with all.
fn summary() -> Summary {
    let mut points = Vec::new();
    for (k, ramp) in RAMPS.into_iter().enumerate() {
        for sign in [Sign::Plus, Sign::Minus] {
            for ms in WIDTHS_MS {
                let crit = 150.0 + 90.0 * k as f64 + 60.0 * ms + 12.0 * sign.factor();
                points.push(PointSummary {
                    ramp: ramp.into(),
                    pulse_ms: ms,
                    sign,
                    axes: vec![],
                    a_crit_g: Some(crit),
                    uncertainty_g: Some(0.055 * crit),
                    half_min_height_g: None,
                    survived_g: Some(0.995 * crit),
                    failed_g: Some(1.005 * crit),
                    contributions: vec![],
                    levels: String::new(),
                    onset_g: (ramp != "none").then_some(0.8 * crit),
                    runs: 3,
                    status: Status::Ok,
                    flags: if ms < 1.0 {
                        vec![
                            Flag::Window,
                            Flag::SafetyFactor3,
                            Flag::TargetNotMet,
                            Flag::RefinementLimit,
                            Flag::Refined,
                        ]
                    } else {
                        vec![]
                    },
                    brackets_g: vec![[crit, 1.01 * crit]],
                    scanned_from_g: None,
                    largest_gap_pct: None,
                });
            }
        }
    }
    Summary {
        study: "A drive & its <ramp>".into(),
        digest: "0123abcd".repeat(8),
        axes: vec![],
        totals: Totals {
            points: points.len() as u64,
            ok: points.len() as u64,
            ..Totals::default()
        },
        points,
    }
}

fn runs(summary: &Summary) -> Vec<RunDot> {
    let mut runs = Vec::new();
    for (point, row) in summary.points.iter().enumerate() {
        let crit = row.survived_g.unwrap_or(0.0);
        for (share, verdict, h) in [
            (0.7, "survives", 3.0e-9),
            (1.0, "survives", 0.6e-9),
            (1.01, "fails", 0.0),
        ] {
            runs.push(RunDot {
                point,
                amplitude_g: share * crit,
                verdict: verdict.into(),
                h_min_m: Some(h),
                mechanism: (verdict == "fails").then_some(Mechanism::RampImpact),
            });
        }
    }
    runs
}

fn film() -> ShockFilm {
    let wave = |scale: f64| -> Vec<f64> {
        (0..60)
            .map(|k| scale * (0.2 * f64::from(k)).sin())
            .collect()
    };
    ShockFilm {
        label: "deformable ramp, 192.1 G, 0.5 ms, sign +: fails".into(),
        time_ms: (0..60).map(|k| 0.1 * f64::from(k)).collect(),
        slider_um: wave(46.0),
        ramp_um: wave(102.0),
        top_um: wave(3.0),
        bottom_um: wave(-3.0),
        force_n: wave(0.5),
        asperity_mn: wave(2.0).into_iter().map(Some).collect(),
        clearance_nm: (0..60).map(|k| (k < 50).then_some(4.0)).collect(),
        radii_mm: [10.01, 22.215, 32.15, 32.5],
        gap_um: 100.0,
    }
}

/// Runs after the page's own script: acts as a person would and writes down what came of it.
const PROBE: &str = r##"<script>
addEventListener("load", () => {
  const reported = { ready: document.documentElement.dataset.ready ?? "no" };
  const all = (selector, of = document) => [...of.querySelectorAll(selector)];
  const plot = name => document.querySelector(`.plot[data-plot="${name}"] svg`);
  const marks = name => all(".mark", document.querySelector(`.plot[data-plot="${name}"]`));
  reported.marks = Object.fromEntries(["critical", "map", "margin"].map(name => [name, marks(name).length]));
  reported.static_hidden = all("figure.static").every(f => getComputedStyle(f).display === "none");
  // Texts of a plot must not lie on one another.
  const cross = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1;
  reported.text_overlaps = all(".plot svg").map(svg => {
    const boxes = all("text", svg).map(t => t.getBoundingClientRect());
    return boxes.reduce((n, a, i) => n + boxes.slice(i + 1).filter(b => cross(a, b)).length, 0);
  });
  const sections = all("main > section").map(s => s.getBoundingClientRect());
  reported.section_overlaps = sections.slice(1).filter((s, i) => s.top < sections[i].bottom - 1).length;
  reported.empty_sections = all("main > section").filter(s => s.getBoundingClientRect().height < 40).map(s => s.id);
  // Every flag ends inside its table at any width, or can be scrolled to.
  const flags = all("#table td:last-child").map(cell => cell.getBoundingClientRect().right);
  const scroll = document.querySelector("#table .scroll");
  reported.flags_seen = Math.max(...flags) <= innerWidth;
  reported.table_scrolls = scroll.scrollWidth > scroll.clientWidth;
  reported.letters_px = Math.min(...all(".plot text").map(t => parseFloat(getComputedStyle(t).fontSize) * t.closest("svg").getScreenCTM().a));
  reported.ground = getComputedStyle(document.body).backgroundColor;
  reported.ink = [...new Set(all(".plot text").map(t => getComputedStyle(t).fill))];
  reported.line = getComputedStyle(plot("critical").querySelector("path")).stroke;
  reported.overflow = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  reported.unnamed = all("svg:not([aria-label]):not([aria-hidden]), button:empty, input:not([aria-label])")
    .filter(e => !e.closest("label") && !e.closest("svg svg")).map(e => e.outerHTML.slice(0, 60).replace(/[<>&]/g, " "));
  // Linked zoom.
  const ticks = name => all("text", plot(name)).map(t => t.textContent).join(" ");
  const before = ticks("critical");
  all(".tools button", document.getElementById("map"))[0].click();
  reported.linked = ticks("critical") !== before;
  reported.fewer = marks("map").length < reported.marks.map;
  all(".tools button", document.getElementById("map"))[2].click();
  reported.back = ticks("critical") === before && marks("map").length === reported.marks.map;
  // One ramp model hidden.
  const boxes = all("#controls input");
  boxes[0].click();
  reported.without_first = marks("critical").length;
  boxes[0].click();
  // Sorting by critical shock.
  const heads = all("#table th button"), first = () => document.querySelector("#table tbody tr").cells[3].dataset.v;
  heads[3].click(); reported.lowest = Number(first());
  heads[3].click(); reported.highest = Number(first());
  reported.sorted = heads[3].closest("th").getAttribute("aria-sort");
  // Comparing the first point with the last.
  const selects = all("#compare-tool select");
  selects[1].value = String(selects[1].options.length - 1);
  selects[1].dispatchEvent(new Event("change"));
  reported.compared = document.querySelector("#compare-tool td:last-child").textContent;
  reported.csv = document.getElementById("csv").textContent.split("\n").length;
  // The animation.
  const clock = document.querySelector("#film-stage input");
  const frame = () => document.querySelector("#film-stage path").getAttribute("d");
  const still = frame();
  clock.value = "7"; clock.dispatchEvent(new Event("input"));
  reported.moves = frame() !== still;
  // A click opens a point's page.
  const mark = marks("critical")[5];
  reported.clicked = mark.dataset.point;
  mark.dispatchEvent(new MouseEvent("click", { bubbles: true }));
  setTimeout(() => {
    reported.open = all(".page").filter(p => getComputedStyle(p).display !== "none").map(p => p.id);
    reported.focused = document.activeElement.id;
    const pre = document.createElement("pre");
    pre.id = "probe";
    pre.textContent = JSON.stringify(reported);
    document.body.append(pre);
    // Shown in a frame: what contains it is asked for the text.
    parent.postMessage(pre.textContent, "*");
  }, 50);
});
</script>"##;

/// A page as wide as a phone: a browser's own window has a least width.
pub const FRAME: &str = r##"<!doctype html><body style="margin:0"><iframe src="NAME" style="border:0;width:420px;height:4000px"></iframe>
<script>addEventListener("message", e => {
  if (document.getElementById("probe")) return;
  const pre = document.createElement("pre"); pre.id = "probe"; pre.textContent = e.data; document.body.append(pre);
});</script></body>"##;

/// Where the pictures are left to be looked at.
pub fn pictures() -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/report-pages");
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

pub struct Page {
    pub browser: PathBuf,
    pub folder: tempfile::TempDir,
}

impl Page {
    fn new(browser: PathBuf) -> Page {
        let folder = tempfile::tempdir().unwrap();
        let summary = summary();
        let runs = runs(&summary);
        let film = film();
        let page = html(&ReportSource {
            resolved_study: Some("name = \"<b>\"\n"),
            plan: r#"{"ramps": {"rigid": {"effects": {"disk": "on", "hub": "off"}}}}"#,
            film: Some(&film),
            ..ReportSource::of_table(&summary, &runs, "opshock 1 (abc)")
        });
        std::fs::write(folder.path().join("report.html"), &page).unwrap();
        let probed = page.replace("</body>", &format!("{PROBE}</body>"));
        std::fs::write(folder.path().join("probed.html"), probed).unwrap();
        for name in ["report.html", "probed.html"] {
            let frame = FRAME.replace("NAME", name);
            std::fs::write(folder.path().join(format!("phone-{name}")), frame).unwrap();
        }
        // A policy that runs no script: what a reader without JavaScript sees.
        let still = page.replace("script-src 'unsafe-inline'", "script-src 'none'");
        assert_ne!(page, still);
        std::fs::write(folder.path().join("still.html"), still).unwrap();
        Page { browser, folder }
    }

    pub fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Opens a file with more options; the browser ends by itself.
    pub fn open(&self, file: &str, options: &[&str]) -> Output {
        let net_log = format!("--log-net-log={}", self.at("net.json").display());
        let profile = format!("--user-data-dir={}", self.at("profile").display());
        let output = Command::new(&self.browser)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--hide-scrollbars",
            ])
            .args([
                "--disable-background-networking",
                "--disable-component-update",
                "--no-first-run",
            ])
            .args([
                "--disable-dev-shm-usage",
                "--enable-logging=stderr",
                "--virtual-time-budget=4000",
            ])
            .args([&profile, &net_log])
            .args(options)
            .arg(format!("file://{}", self.at(file).display()))
            .output()
            .expect("Chromium starts");
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        output
    }

    /// What the page wrote to the console, and what it asked of the network.
    fn assert_quiet(&self, output: &Output) {
        let reported = String::from_utf8_lossy(&output.stderr);
        let console: Vec<&str> = reported
            .lines()
            .filter(|line| line.contains("CONSOLE"))
            .collect();
        assert!(console.is_empty(), "{}", console.join("\n"));
        let log = std::fs::read_to_string(self.at("net.json")).unwrap_or_default();
        let origin = "\"initiator\":\"file:";
        let asked: Vec<&str> = log
            .lines()
            .filter(|line| line.contains("\"url\":\"http") && line.contains(origin))
            .collect();
        assert!(asked.is_empty(), "{}", asked.join("\n"));
    }

    fn probe(&self, options: &[&str]) -> Value {
        self.probe_in("probed.html", options)
    }

    pub fn probe_in(&self, file: &str, options: &[&str]) -> Value {
        let output = self.open(file, &[&["--dump-dom"], options].concat());
        self.assert_quiet(&output);
        let page = String::from_utf8(output.stdout).unwrap();
        let start = page.rfind("<pre id=\"probe\">").expect("the probe ran") + 16;
        let end = start + page[start..].find("</pre>").unwrap();
        serde_json::from_str(&page[start..end]).expect("what the probe wrote down")
    }

    /// Share of pixels that are not white, in each of `bands` strips from top to bottom.
    fn ink(&self, file: &str, options: &[&str], bands: usize) -> Vec<f64> {
        let shot = format!("--screenshot={}", self.at("shot.png").display());
        let output = self.open(file, &[&[shot.as_str()], options].concat());
        if file == "report.html" {
            self.assert_quiet(&output);
        }
        let (width, pixels) = decoded(&self.at("shot.png"));
        let height = pixels.len() / width;
        let strip = height.div_ceil(bands) * width;
        pixels
            .chunks(strip)
            .map(|strip| strip.iter().filter(|&&white| !white).count() as f64 / strip.len() as f64)
            .collect()
    }
}

/// Width, and for every pixel whether it is white.
fn decoded(path: &Path) -> (usize, Vec<bool>) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    let samples = info.color_type.samples();
    let white = |pixel: &[u8]| pixel[..3].iter().all(|&v| v > 250);
    (
        info.width as usize,
        bytes[..info.buffer_size()]
            .chunks(samples)
            .map(white)
            .collect(),
    )
}

#[test]
#[ignore = "needs Chromium: make verify-report"]
fn the_report_works_in_a_browser_and_asks_nothing_of_the_network() {
    let page = Page::new(chromium());
    let reported = page.probe(&["--window-size=1200,900"]);
    assert_eq!(reported["ready"], "yes");
    // The worst sign of 18, and each of 36.
    assert_eq!(reported["marks"]["critical"], 18 + 36, "{reported}");
    assert_eq!(reported["marks"]["map"], 108);
    assert_eq!(reported["marks"]["margin"], 108);
    assert_eq!(reported["static_hidden"], true);
    assert_eq!(
        reported["text_overlaps"],
        serde_json::json!([0, 0, 0, 0, 0]),
        "{reported}"
    );
    assert_eq!(reported["section_overlaps"], 0);
    assert_eq!(reported["empty_sections"], serde_json::json!([]));
    assert_eq!(reported["overflow"], 0);
    assert_eq!(reported["unnamed"], serde_json::json!([]));
    for act in ["linked", "fewer", "back", "moves"] {
        assert_eq!(reported[act], true, "{act}: {reported}");
    }
    assert_eq!(reported["without_first"], 36);
    // 150 + 60 * 0.5 - 12 and 150 + 180 + 180 + 12.
    assert_eq!(reported["lowest"], 168.0);
    assert_eq!(reported["highest"], 522.0);
    assert_eq!(reported["sorted"], "descending");
    // 498 over 192.
    assert_eq!(reported["compared"], "159.4 %");
    assert_eq!(reported["csv"], 1 + 36 + 1);
    let open = format!("point-{}", reported["clicked"].as_str().unwrap());
    assert_eq!(reported["open"], serde_json::json!([open]));
    assert_eq!(reported["focused"], open.as_str());
}

#[test]
#[ignore = "needs Chromium: make verify-report"]
fn the_report_is_not_blank_with_and_without_its_script() {
    let page = Page::new(chromium());
    let size = "--window-size=1200,5200";
    let with = page.ink("report.html", &[size], 8);
    let without = page.ink("still.html", &[size], 8);
    for ink in [&with, &without] {
        for share in ink {
            assert!((0.005..0.6).contains(share), "{ink:?}");
        }
    }
    // Without its script the page has its static figures, not the plots: another picture.
    assert_ne!(with, without);
}

const LIGHT: (&str, &str) = (
    "--blink-settings=preferredColorScheme=1",
    "rgb(255, 255, 255)",
);
const DARK: (&str, &str) = ("--blink-settings=preferredColorScheme=0", "rgb(22, 25, 29)");

#[test]
#[ignore = "needs Chromium: make verify-report"]
fn the_report_fits_1400_and_420_px_light_and_dark() {
    let page = Page::new(chromium());
    for (name, (scheme, ground)) in [("light", LIGHT), ("dark", DARK)] {
        for (file, px, size) in [
            ("", 1400, "--window-size=1400,5200"),
            ("phone-", 420, "--window-size=500,4000"),
        ] {
            let reported = page.probe_in(&format!("{file}probed.html"), &[size, scheme]);
            assert_eq!(reported["overflow"], 0, "{name} {px}: {reported}");
            let overlaps = reported["text_overlaps"].as_array().unwrap();
            assert!(overlaps.iter().all(|n| *n == 0), "{name} {px}: {reported}");
            // All flags are seen on a desk; on a phone the table scrolls.
            assert_eq!(reported["flags_seen"], px == 1400, "{reported}");
            assert_eq!(reported["table_scrolls"], px == 420, "{reported}");
            assert!(
                reported["letters_px"].as_f64().unwrap() >= 11.5,
                "{reported}"
            );
            assert_eq!(reported["ground"], ground, "{name}");
            let (ink, line) = match name {
                "light" => ("rgb(34, 34, 34)", "rgb(26, 26, 26)"),
                _ => ("rgb(230, 230, 230)", "rgb(238, 238, 238)"),
            };
            assert_eq!(reported["ink"], serde_json::json!([ink]), "{reported}");
            assert_eq!(reported["line"], line, "{reported}");
            let shot = pictures().join(format!("{name}-{px}.png"));
            let shot = format!("--screenshot={}", shot.display());
            page.open(&format!("{file}report.html"), &[&shot, size, scheme]);
        }
    }
}

#[test]
#[ignore = "needs Chromium: make verify-report"]
fn a_report_of_36_rows_prints_on_two_light_pages() {
    let page = Page::new(chromium());
    for (file, (scheme, _)) in [("report.html", DARK), ("still.html", LIGHT)] {
        let paper = pictures().join(file).with_extension("pdf");
        let print = format!("--print-to-pdf={}", paper.display());
        page.open(file, &[&print, "--no-pdf-header-footer", scheme]);
        let bytes = std::fs::read(&paper).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        let pages = text.matches("/Type /Page").count() - text.matches("/Type /Pages").count();
        assert!((1..=2).contains(&pages), "{file}: {pages} pages");
    }
}
