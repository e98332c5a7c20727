//! Match files: impossible weights, choices and numbers are reported.

use serde_json::Value;

use super::matching::{TWO, matched, shipped, small, with_choices, with_weights};

#[test]
fn weights_are_positive_and_of_observations() {
    let folder = tempfile::tempdir().expect("a folder");
    let open = "[[observation]]\nname = \"open\"\noutput = \"run.disk.rim_max_m\"\nSHOCK\n";
    let file = small(folder.path(), &format!("{TWO}{open}"));
    with_weights(&file, "{ nea = 3, far = 0, open = 2 }");
    let (code, _, reported) = matched(&file, &folder.path().join("store"), &[]);
    assert_eq!(code, Some(3));
    for said in [
        "refinement.weights.nea",
        "did you mean near",
        "refinement.weights.far",
        "refinement.weights.open",
    ] {
        assert!(reported.contains(said), "{said}: {reported}");
    }
}

#[test]
fn a_search_of_each_choice_needs_choices() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = small(folder.path(), TWO);
    with_choices(
        &file,
        "keys = [\"disk.rpm\"]\nchoices = [4200, 5400]",
        "gap",
    );
    let (code, _, reported) = matched(&file, &folder.path().join("store"), &[]);
    assert_eq!(code, Some(3));
    let said = "refinement.each = \\\"gap\\\": is no parameter with choices";
    assert!(
        reported.contains("E193") && reported.contains("pads"),
        "{said}: {reported}"
    );
}

#[test]
fn numbers_belong_to_the_files_that_choices_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let one = TWO.split("[[observation]]").nth(1).expect("the first");
    let file = small(folder.path(), &format!("[[observation]]{one}"));
    let surface = shipped("paper-cases").with_file_name("../fig13/surface.toml");
    let own = folder.path().join("surface.toml");
    let text = std::fs::read_to_string(surface).expect("read");
    std::fs::write(&own, &text).expect("written");
    let pads = format!(
        "keys = [\"slider.surface\"]\nchoices = [{{ file = {own:?} }}, {{ preset = \"femto-2.5in\" }}]"
    );
    with_choices(&file, &pads, "pads");
    let store = folder.path().join("store");
    let simulated = || -> u64 {
        let (code, _, reported) = matched(&file, &store, &[]);
        assert_eq!(code, Some(0), "{reported}");
        let words = reported.split(" simulated sets").next().expect("a count");
        let count = words.rsplit(|c: char| !c.is_ascii_digit()).next();
        count
            .and_then(|digits| digits.parse().ok())
            .expect("a count")
    };
    let all = simulated();
    assert_eq!(simulated(), 0);
    std::fs::write(&own, text.replace("crown_nm = 15.0", "crown_nm = 14.0")).expect("written");
    let again = simulated();
    assert!((1..all).contains(&again), "{again} of {all}");
}

#[test]
fn every_fault_of_a_match_file_is_reported_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = small(
        folder.path(),
        "[[parameter]]\nkeys = [\"ramp.clearance_um\"]\nuniform = [3.0, 1.0]\nsource = \"test\"\n\
         [[parameter]]\nkeys = [\"disk.rpm\"]\nuniforms = [1.0, 2.0]\nsource = \"test\"\n\
         [[parameter]]\nkeys = [\"disk.poisson\"]\nuniform = [0.2, 0.3]\nguess = 0.4\nsource = \"test\"\n\
         [[observation]]\nname = \"a\"\noutput = \"run.contactt\"\nSHOCK\nrange = [0.0, 1.0]\n\
         [[observation]]\nname = \"b\"\nratio = [\"a\", \"c\"]\n\
         [[observation]]\nname = \"d\"\nstatement = \"rigid_tuch\"\n\
         [[observation]]\nname = \"e\"\noutput = \"run.verdict\"\nequals = \"lives\"\nSHOCK\n\
         [[observation]]\nname = \"f\"\nhistory = \"disk_slider_m\"\nfile = \"no.csv\"\nSHOCK\nrange = [0.0, 1e-6]\n",
    );
    let store = folder.path().join("store");
    let (code, json, reported) = matched(&file, &store, &[]);
    assert_eq!((code, json), (Some(3), Value::Null));
    // Errors are on standard error, as JSON.
    let errors: Value = serde_json::from_str(&reported).expect("JSON");
    let reported: Vec<(&str, &str)> = errors["errors"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|fault| {
            (
                fault["code"].as_str().unwrap_or(""),
                fault["key"].as_str().unwrap_or(""),
            )
        })
        .collect();
    for wanted in [
        ("E133", "parameter[2].uniform"),
        ("E110", "parameter[3].uniforms"),
        ("E193", "parameter[3]"),
        ("E193", "parameter[4].guess"),
        ("E193", "observation[0].output"),
        ("E193", "observation[1].ratio"),
        ("E193", "observation[2].statement"),
        ("E193", "observation[3].equals"),
    ] {
        assert!(reported.contains(&wanted), "{wanted:?} of {reported:?}");
    }
    for fault in errors["errors"].as_array().expect("a list") {
        assert_ne!(fault["allowed"].as_str(), Some(""), "{fault}");
    }
    assert!(!store.exists(), "a store for a match that cannot be");
}
