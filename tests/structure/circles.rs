//! Files of a crate import one another in one direction: each can be read with those below it alone.

use crate::floors::{code, sources};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Crates without circles.
const CRATES: [&str; 7] = [
    "opshock-solver",
    "opshock-import",
    "opshock-solid",
    "opshock-paper",
    "opshock-python",
    "opshock-study",
    "opshock",
];

/// Of every module those that it imports or declares. Modules are named as `disk::hub`, the root is empty.
type Imports = BTreeMap<String, BTreeSet<String>>;

/// Paths of the tree of imports behind `prefix`, groups opened; the text behind it.
fn open<'a>(prefix: &str, tree: &'a str, paths: &mut Vec<String>) -> &'a str {
    let tree = tree.trim_start();
    let end = tree.find(|c: char| !(c.is_alphanumeric() || "_:".contains(c)));
    let (path, mut rest) = tree.split_at(end.unwrap_or(tree.len()));
    let path = format!("{prefix}{path}");
    if !(rest.starts_with('{') && path.ends_with("::")) {
        // What follows the last comma of a group is no path.
        if !tree.starts_with('}') {
            paths.push(path);
        }
        return rest;
    }
    while !rest.is_empty() && !rest.starts_with('}') {
        rest = open(&path, &rest[1..], paths);
        // Behind `as` stands another name.
        rest = &rest[rest.find([',', '}']).unwrap_or(rest.len())..];
    }
    rest.get(1..).unwrap_or_default()
}

/// Paths within the crate that a file names, in `use` or elsewhere, but for its tests.
fn paths(text: &str) -> Vec<String> {
    let code = code(text);
    let tests = ["", "pub(super) "].map(|seen| format!("#[cfg(test)]\n{seen}mod tests {{"));
    let end = tests.iter().filter_map(|tests| code.find(tests)).min();
    let mut code = &code[..end.unwrap_or(code.len())];
    let mut paths = Vec::new();
    let first = ["crate::", "self::", "super::"];
    while let Some(at) = first.iter().filter_map(|first| code.find(first)).min() {
        let before = &code[..at];
        let goes_on = |c: char| c.is_alphanumeric() || "_:".contains(c);
        // Another name's end, or where something can be seen: `pub(in crate::head)`.
        code = match before.ends_with(goes_on) || before.ends_with("(in ") {
            true => &code[at + "self::".len()..],
            false => open("", &code[at..], &mut paths),
        };
    }
    paths
}

/// The module among `known` that holds what `path` names in `module`.
fn holder(module: &str, path: &str, known: &BTreeMap<String, String>) -> String {
    let own = if path.starts_with("crate::") {
        ""
    } else {
        module
    };
    let mut at: Vec<&str> = own.split("::").filter(|name| !name.is_empty()).collect();
    for name in path.split("::") {
        match name {
            "crate" | "self" | "" => {}
            "super" => drop(at.pop()),
            _ => {
                at.push(name);
                if !known.contains_key(&at.join("::")) {
                    at.pop();
                    break;
                }
            }
        }
    }
    at.join("::")
}

/// Imports between modules of these texts; a module declares those within it.
fn imports(texts: &BTreeMap<String, String>) -> Imports {
    let mut imports: Imports = texts.keys().map(|m| (m.clone(), BTreeSet::new())).collect();
    for (module, text) in texts {
        let named = paths(text).into_iter();
        let held = named.map(|path| (module.clone(), holder(module, &path, texts)));
        let declared = (holder(module, "super", texts), module.clone());
        for (from, to) in held.chain([declared]).filter(|(from, to)| from != to) {
            imports.entry(from).or_default().insert(to);
        }
    }
    imports
}

/// Imports in circles: what is imported leads back.
fn circles(imports: &Imports) -> Vec<String> {
    let leads_to = |from: &String, to: &String| {
        let (mut seen, mut next) = (BTreeSet::new(), vec![from]);
        while let Some(module) = next.pop() {
            if seen.insert(module) {
                next.extend(&imports[module]);
            }
        }
        seen.contains(to)
    };
    let all = imports.iter();
    let edges = all.flat_map(|(from, of)| of.iter().map(move |to| (from, to)));
    edges
        .filter(|(from, to)| leads_to(to, from))
        .map(|(from, to)| format!("`{from}` imports `{to}`"))
        .collect()
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
    let mut wrong = Vec::new();
    for name in CRATES {
        let root = crates.join(name).join("src");
        let mut texts = BTreeMap::new();
        for path in sources(&root) {
            let inside = path.strip_prefix(&root).expect("inside").with_extension("");
            let parts = inside.iter().map(|part| part.to_str().expect("a name"));
            let mut module: Vec<&str> = parts.collect();
            if module.contains(&"tests") {
                continue;
            }
            if let Some(&("mod" | "lib" | "main")) = module.last() {
                module.pop();
            }
            let text = std::fs::read_to_string(&path).expect("readable source");
            texts.insert(module.join("::"), text);
        }
        let found = circles(&imports(&texts)).into_iter();
        wrong.extend(found.map(|edge| format!("{name}: {edge}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn reader_of_imports_finds_circles_in_every_form_of_path() {
    let text = |(module, text): (&str, &str)| (module.to_owned(), text.to_owned());
    let texts = [
        ("", "pub mod gas;\npub mod film;"),
        (
            "gas",
            "// use crate::film;\npub(in crate::film) struct Gas;",
        ),
        (
            "film",
            "pub use mesh::Mesh;\nuse crate::{gas::{self, Gas}};",
        ),
        (
            "film::mesh",
            "use super::{cell::{Cell as Box,}, super::gas};",
        ),
        ("film::cell", "fn f() { super::face::g::<f64>() }"),
        ("film::face", "use self::super::{\n    mesh::{Mesh, *},\n};"),
        (
            "film::flux",
            "#[cfg(test)]\nmod tests {\n    use super::super::Mesh;\n}",
        ),
    ];
    let found = circles(&imports(&texts.map(text).into()));
    let expected = [
        "`film::cell` imports `film::face`",
        "`film::face` imports `film::mesh`",
        "`film::mesh` imports `film::cell`",
    ];
    assert_eq!(found, expected);
    let upwards = [("", "mod a;"), ("a", "mod b;"), ("a::b", "use super::A;")];
    let found = circles(&imports(&upwards.map(text).into()));
    assert_eq!(found, ["`a` imports `a::b`", "`a::b` imports `a`"]);
}
