//! The built book in a browser: pages that fit a telephone, formulas that are drawn, dark theme, search.

use crate::report_page::{FRAME, Page, chromium};
use serde_json::Value;
use std::path::Path;

/// Runs after a page's own scripts: looks, searches, and writes down what came of it.
const PROBE: &str = r##"<script>
addEventListener("load", () => setTimeout(() => {
  const all = selector => [...document.querySelectorAll(selector)];
  const size = element => element.getBoundingClientRect();
  const main = document.querySelector("main");
  const reported = {
    overflow: document.documentElement.scrollWidth - document.documentElement.clientWidth,
    formulas: all("main math").length,
    flat: all("main math").filter(math => size(math).height < 4 || size(math).width < 3).length,
    raw: (main.innerText.match(/\$\$|\\[a-z]{3,}/g) ?? []).length - all("main code, main pre").reduce((n, code) => n + (code.innerText.match(/\$\$|\\[a-z]{3,}/g) ?? []).length, 0),
    lost: all("main img").filter(image => image.naturalWidth === 0).map(image => image.src),
    ground: getComputedStyle(document.documentElement).backgroundColor,
    ink: getComputedStyle(main).color,
  };
  const done = () => {
    const pre = document.createElement("pre");
    pre.id = "probe";
    pre.textContent = JSON.stringify(reported);
    document.body.append(pre);
    parent.postMessage(pre.textContent, "*");
  };
  if (!location.search.includes("find")) return done();
  document.getElementById("mdbook-search-toggle").click();
  const bar = document.getElementById("mdbook-searchbar");
  bar.value = "monotonicity scan";
  const typed = () => bar.dispatchEvent(new KeyboardEvent("keyup", { bubbles: true, key: "n" }));
  bar.dispatchEvent(new Event("input", { bubbles: true }));
  typed();
  let tries = 0;
  const wait = setInterval(() => {
    const found = all("#mdbook-searchresults li a").map(link => link.getAttribute("href"));
    typed();
    if (found.length || ++tries > 20) {
      clearInterval(wait);
      reported.found = found;
      done();
    }
  }, 150);
}, 100));
</script>"##;

/// Copies a folder with all in it.
fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).expect("make book first") {
        let path = entry.unwrap().path();
        let to = to.join(path.file_name().unwrap());
        match path.is_dir() {
            true => copy(&path, &to),
            false => drop(std::fs::copy(&path, &to).unwrap()),
        }
    }
}

/// The book with a probe in every page; its pages from the root.
fn book() -> (Page, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    copy(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/book"),
        folder.path(),
    );
    let contents = std::fs::read_to_string(folder.path().join("toc.html")).unwrap();
    let mut pages: Vec<String> = contents
        .split("href=\"")
        .skip(1)
        .filter_map(|rest| rest.split(['"', '#']).next())
        .filter(|name| name.ends_with(".html"))
        .map(str::to_owned)
        .collect();
    pages.dedup();
    for name in &pages {
        let path = folder.path().join(name);
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(
            &path,
            text.replacen("</body>", &format!("{PROBE}</body>"), 1),
        )
        .unwrap();
        let phone = format!("phone-{}", name.replace('/', "-"));
        std::fs::write(folder.path().join(phone), FRAME.replace("NAME", name)).unwrap();
    }
    let browser = chromium();
    (Page { browser, folder }, pages)
}

/// Lightness of a colour as browsers write it, 0 to 255.
fn lightness(colour: &Value) -> f64 {
    let numbers = colour
        .as_str()
        .unwrap()
        .split(|c: char| !c.is_ascii_digit());
    let rgb: Vec<f64> = numbers.filter_map(|number| number.parse().ok()).collect();
    rgb[..3].iter().sum::<f64>() / 3.0
}

#[test]
#[ignore = "needs Chromium and the built book: make verify-book"]
fn the_book_fits_a_telephone_and_draws_its_formulas() {
    let (page, pages) = book();
    assert!(pages.len() > 45, "{pages:?}");
    let mut formulas = 0;
    for name in &pages {
        let phone = format!("phone-{}", name.replace('/', "-"));
        let seen = page.probe_in(&phone, &["--window-size=500,900"]);
        assert_eq!(seen["overflow"], 0, "{name}: wider than 420 px");
        assert_eq!(
            (&seen["flat"], &seen["raw"]),
            (&Value::from(0), &Value::from(0)),
            "{name}: {seen}"
        );
        assert_eq!(seen["lost"], serde_json::json!([]), "{name}");
        formulas += seen["formulas"].as_u64().unwrap();
    }
    assert!(formulas > 500, "{formulas}");
    println!("{} pages at 420 px, {formulas} formulas", pages.len());
}

#[test]
#[ignore = "needs Chromium and the built book: make verify-book"]
fn the_book_is_dark_where_wished_and_finds_words() {
    let (page, _) = book();
    for (scheme, is_dark) in [("1", false), ("0", true)] {
        let wish = format!("--blink-settings=preferredColorScheme={scheme}");
        let seen = page.probe_in("theory/air-film.html", &["--window-size=1400,900", &wish]);
        let [ground, ink] = ["ground", "ink"].map(|key| lightness(&seen[key]));
        assert_eq!(ground < ink, is_dark, "{seen}");
        assert!((ground - ink).abs() > 100.0, "{seen}");
    }
    let seen = page.probe_in("index.html?find", &["--window-size=1400,900"]);
    let found: Vec<&str> = (seen["found"].as_array().unwrap().iter())
        .filter_map(Value::as_str)
        .collect();
    assert!(
        found
            .iter()
            .any(|page| page.contains("search-and-uncertainty")),
        "{found:?}"
    );
}
