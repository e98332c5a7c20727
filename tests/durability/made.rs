//! Commands that make files, and whether what they made is what an undisturbed run makes.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use opshock_study::store::{history, results};
use opshock_tests::coarse;
use opshock_tests::hdf5_dump::dump;

/// The program.
pub const OPSHOCK: &str = env!("CARGO_BIN_EXE_opshock-under-test");

/// Content of files by their path below a folder.
pub type Files = BTreeMap<PathBuf, Vec<String>>;

/// A command that makes files in its working folder.
#[derive(Clone, Copy, Debug)]
pub struct Making {
    pub name: &'static str,
    words: &'static [&'static str],
    /// It takes the settings of a study; else it reads a store.
    of_study: bool,
    /// Its standard output has no times in it.
    says_the_same: bool,
}

const SHOCK: [&str; 8] = [
    "--ramp",
    "none",
    "--pulse-ms",
    "0.5",
    "--sign",
    "+",
    "--amplitude-g",
    "100",
];

/// Every kind of file that the program writes.
pub const MAKING: [Making; 7] = [
    Making {
        name: "sweep",
        words: &["sweep", "STUDY", "--store", "s.opshock"],
        of_study: true,
        says_the_same: true,
    },
    Making {
        name: "report",
        words: &["report", "STORE", "--out", "out"],
        of_study: false,
        says_the_same: true,
    },
    Making {
        name: "export_csv",
        words: &["export", "STORE", "--format", "csv"],
        of_study: false,
        says_the_same: true,
    },
    Making {
        name: "export_vtu",
        words: &[
            "export", "STUDY", "--format", "vtu", "--frames", "2", "--out", "out", "SHOCK",
        ],
        of_study: true,
        says_the_same: true,
    },
    Making {
        name: "history_h5",
        words: &["run", "STUDY", "--history", "run.h5", "SHOCK"],
        of_study: true,
        says_the_same: false,
    },
    Making {
        name: "history_csv",
        words: &["run", "STUDY", "--history", "run.csv", "SHOCK"],
        of_study: true,
        says_the_same: false,
    },
    Making {
        name: "plots",
        words: &["run", "STUDY", "--plots", "out", "SHOCK"],
        of_study: true,
        says_the_same: false,
    },
];

/// A command with what it makes when nothing disturbs it.
pub struct Reference {
    pub making: Making,
    store: PathBuf,
    pub files: Files,
    stdout: Vec<u8>,
}

impl Reference {
    /// Makes everything once below `root`, where a store is swept first.
    pub fn of(making: Making, root: &Path) -> Reference {
        let store = root.join("read.opshock");
        if !store.exists() {
            let sweep = Reference::without(MAKING[0], &store);
            let folder = root.join("swept");
            std::fs::create_dir(&folder).expect("folder");
            let swept = sweep.run(&mut Command::new(OPSHOCK), &folder);
            assert!(swept.status.success(), "{swept:?}");
            std::fs::rename(folder.join("s.opshock"), &store).expect("renames");
        }
        let folder = root.join(making.name);
        std::fs::create_dir(&folder).expect("folder");
        let mut reference = Reference::without(making, &store);
        let output = reference.run(&mut Command::new(OPSHOCK), &folder);
        assert!(output.status.success(), "{output:?}");
        reference.stdout = output.stdout;
        reference.files = files(&folder).expect("whole");
        reference
    }

    fn without(making: Making, store: &Path) -> Reference {
        Reference {
            making,
            store: store.to_owned(),
            files: Files::new(),
            stdout: Vec::new(),
        }
    }

    /// The words after the program's name.
    pub fn words(&self) -> Vec<String> {
        let study = Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies/fig13/study.toml");
        let mut words = Vec::new();
        for word in self.making.words {
            match *word {
                "STUDY" => words.push(study.display().to_string()),
                "STORE" => words.push(self.store.display().to_string()),
                "SHOCK" => words.extend(SHOCK.map(str::to_owned)),
                word => words.push(word.to_owned()),
            }
        }
        words.extend(["-j1".to_owned(), "--quiet".to_owned()]);
        if self.making.of_study {
            for set in coarse::TWO_POINTS.iter().chain(&coarse::SEARCH) {
                words.extend(["--set".to_owned(), (*set).to_owned()]);
            }
        }
        words
    }

    /// Runs it by `command`, which the words are added to, in `folder`.
    pub fn run(&self, command: &mut Command, folder: &Path) -> Output {
        let command = command.args(self.words()).current_dir(folder);
        command.env("OPSHOCK_CACHE_DIR", "");
        command.output().expect("starts")
    }

    /// Runs it undisturbed: everything must be there, and be what it should.
    pub fn finish(&self, folder: &Path) {
        let output = self.run(&mut Command::new(OPSHOCK), folder);
        assert!(output.status.success(), "{output:?}");
        self.judge(folder, &output, true);
    }

    /// Judges a run that something disturbed: a product that has its name is whole and right; a run
    /// that ends with 0 has made all of them; one that does not says why, and leaves nothing aside.
    ///
    /// `is_heard`: standard error was not disturbed itself.
    pub fn judge(&self, folder: &Path, output: &Output, is_heard: bool) {
        let reported = String::from_utf8_lossy(&output.stderr);
        let code = output.status.code();
        let code = code.unwrap_or_else(|| panic!("ended by a signal: {output:?}"));
        assert!(!reported.contains("panicked") && code != 101, "{reported}");
        let found = files(folder).unwrap_or_else(|damage| panic!("{damage}\n{code}: {reported}"));
        for (path, content) in &found {
            let expected = self.files.get(path);
            assert!(expected.is_some(), "{path:?} was left\n{code}: {reported}");
            assert!(
                expected == Some(content),
                "{path:?} differs\n{code}: {reported}"
            );
        }
        match code {
            1 | 6 if !is_heard => {}
            0 => {
                let missing = self.files.keys().find(|path| !found.contains_key(*path));
                assert!(missing.is_none(), "{missing:?} is missing\n{reported}");
                let is_said = !self.making.says_the_same || output.stdout == self.stdout;
                assert!(is_said, "other words on standard output");
            }
            // Standard output itself.
            1 => assert!(
                reported.contains("cannot write to standard output"),
                "{reported}"
            ),
            6 => assert!(reported.contains("E183: "), "{reported}"),
            other => panic!("exit code {other}: {reported}"),
        }
    }
}

/// Products below `folder`, read back; what is wrong with the first that is damaged.
fn files(folder: &Path) -> Result<Files, String> {
    let mut found = Files::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(below) = folders.pop() {
        for entry in std::fs::read_dir(&below).expect("folder") {
            let path = entry.expect("entry").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path.file_name().and_then(OsStr::to_str).expect("a name");
            // A journal may be torn, the lock holds words; the next writer replaces either.
            if ["journal", ".aside-journal", "lock"].contains(&name) {
                continue;
            }
            let content = match path.extension().and_then(OsStr::to_str) {
                Some("h5") => hdf5(&path, name == "results.h5")?,
                _ => {
                    let bytes = std::fs::read(&path).expect("reads");
                    vec![String::from_utf8_lossy(&bytes).into_owned()]
                }
            };
            let inside = path.strip_prefix(folder).expect("below");
            found.insert(inside.to_owned(), content);
        }
    }
    Ok(found)
}

/// Lines of an HDF5 file that its seal vouches for.
fn hdf5(path: &Path, is_results: bool) -> Result<Vec<String>, String> {
    let bytes = std::fs::read(path).expect("reads");
    let sound = if is_results {
        results::parse(path, &bytes).map(drop)
    } else {
        history::parse(path, &bytes).map(drop)
    };
    sound.map_err(|error| error.to_string())?;
    // Results name the histories that were there when they were written.
    Ok(dump(path, &["/machine", "/runs/history"]))
}
