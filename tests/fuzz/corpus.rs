//! Sound and unsound files that mutations of the fuzz tests start from.

use std::path::{Path, PathBuf};

/// Text files of a folder with an ending, in the order of their names.
fn texts(folder: &Path, ending: &str) -> Vec<String> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == ending))
        .collect();
    paths.sort();
    // Those that are no text are bad inputs of their own.
    let read = |path: &PathBuf| std::fs::read_to_string(path).ok();
    paths.iter().filter_map(read).collect()
}

/// How many of [`studies`], from the first, are sound.
pub const N_SOUND_STUDIES: usize = 3;

/// Studies that fit a fuzzer: sound ones of few points, and every bad input.
pub fn studies() -> Vec<String> {
    let sound: [String; N_SOUND_STUDIES] = [
        opshock_study::study::Study::example("fuzz"),
        "study_format = 2\nname = \"case\"\n[pulse]\nwidths_ms = [2.0]\n[ramp]\nmodels = [\"rigid\"]\n".into(),
        "study_format = 2\nname = \"case\"\n[pulse]\nwidths_ms = [0.5, 2.0]\nsigns = [\"+\", \"-\"]\n\
         [ramp]\nmodels = [\"none\", \"deformable\"]\n[disk]\nrpm = { from = 5400, to = 7200, count = 3 }\n\
         thickness_mm = 0.8\n[slider]\nsurface = { preset = \"femto-2.5in\" }\n"
            .into(),
    ];
    let mut all: Vec<String> = sound.into_iter().collect();
    all.extend(texts(Path::new("bad_inputs"), "toml"));
    all.retain(|text| text.len() < 20_000);
    all
}

/// Surfaces.
pub fn surfaces() -> Vec<String> {
    let mut all = texts(Path::new("bad_inputs/surfaces"), "toml");
    all.extend(texts(Path::new("../studies/fig13"), "toml"));
    all.retain(|text| !text.contains("[search]"));
    all
}

/// Sampled pulses.
pub fn pulses() -> Vec<String> {
    let mut all = texts(Path::new("bad_inputs/pulses"), "csv");
    all.push("time_ms,relative\n0,0\n0.5,1\n1.0,0.25\n2.0,0\n".into());
    all
}
