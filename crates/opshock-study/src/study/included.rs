//! Reads what a study takes from elsewhere: the air-bearing surface (preset or file).

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::datum::Datum;
use super::fault::StudyError;
use super::key::{Kind, Presence};
use super::keys::{KEYS, find};
use super::read::Reader;
use super::set_arg::SetArg;
use super::source::{Origin, Place, Source};
use super::surfaces;
use super::text_file;
use super::tree::{self, Node, Value};

/// The surface of a study that says nothing about rails.
const DEFAULT_SURFACE: &str = "femto-2.5in";

/// Where a study stands: its file, and the folder its file paths start from.
#[derive(Clone, Debug)]
pub struct Location {
    /// The study file as named by the user.
    pub file: PathBuf,
    /// The folder of relative paths.
    pub folder: PathBuf,
}

/// The list a `--set list[0]...` argument reaches into when the study file does not hold it: the
/// key's default, or the rails of the surface's preset or file.
pub fn base_list(root: &Node, sets: &[SetArg], path: &str, location: &Location) -> Option<Node> {
    let key = find(path)?;
    if let Presence::Default(literal) | Presence::Together(literal) = key.presence {
        return (key.kind == Kind::Tables).then(|| tree::literal(literal));
    }
    let rail = path.strip_prefix("slider.surface.")?;
    let text_at = |name: &str| {
        let from_set = sets
            .iter()
            .find(|set| set.key == format!("slider.surface.{name}"));
        let node = from_set.map(|set| set.node(0)).or_else(|| {
            root.get("slider")
                .and_then(|slider| slider.get("surface"))
                .and_then(|surface| surface.get(name))
                .cloned()
        });
        match node.map(|node| node.value) {
            Some(Value::Text(text)) => Some(text),
            _ => None,
        }
    };
    let (source, origin) = match text_at("file") {
        Some(file) => {
            let file = location.folder.join(file);
            // What cannot be read is reported when the surface itself is read.
            (
                Source::new(
                    file.display().to_string(),
                    text_file::read_text(&file).ok()?,
                ),
                Origin::Included,
            )
        }
        None => {
            let name = text_at("preset").unwrap_or_else(|| DEFAULT_SURFACE.to_string());
            (
                Source::new(format!("preset {name}"), surfaces::text(&name)?),
                Origin::Preset,
            )
        }
    };
    tree::parse(&source, origin).ok()?.get(rail).cloned()
}

/// Keys of the surface.
const SURFACE: &str = "slider.surface";

/// Reads preset or file under what the study says about the surface itself.
pub fn surface_base(reader: &mut Reader, location: &Location) {
    surface(reader, location, SURFACE, SURFACE);
}

/// The same for a head with file, preset or rails of its own: nothing of its surface is the study's.
/// What its keys begin with is `head`.
pub fn surface_of_head(reader: &mut Reader, location: &Location, head: &str) {
    let own = |name: &str| format!("{head}{SURFACE}.{name}");
    let names = ["file", "preset", "rail"].map(own);
    if names.iter().all(|name| !reader.settings.has(name)) {
        return;
    }
    let table = format!("{head}{SURFACE}");
    surface(reader, location, &format!("heads[].{SURFACE}"), &table);
    for key in KEYS.iter() {
        let is_plain = key.path.starts_with(SURFACE) && !key.path.contains("[]");
        let path = format!("{head}{}", key.path);
        if let (true, Presence::Default(literal)) = (is_plain, key.presence)
            && let Some(own) = find(&path)
            && !reader.settings.has(&path)
            && !reader.settings.is_spoilt(&path)
        {
            reader.literal(own, &path, literal);
        }
    }
}

/// The surface whose keys lie below `prefix`, `pattern` in the table of keys.
fn surface(reader: &mut Reader, location: &Location, pattern: &str, prefix: &str) {
    let key = |name: &str| format!("{prefix}.{name}");
    let [file_key, preset_key, rails] = ["file", "preset", "rail"].map(key);
    let text_of = |reader: &Reader, path: &str| match reader
        .settings
        .get(path)
        .map(|s| (&s.values[0], s.place.clone()))
    {
        Some((Datum::Word(text) | Datum::Text(text), place)) => Some((text.clone(), place)),
        _ => None,
    };
    if let Some((file, place)) = text_of(reader, &file_key) {
        if let Some(source) = open_named(reader, location, &file_key, &file, &place) {
            match tree::parse(&source, Origin::Included) {
                Err(faults) => {
                    reader.errors.extend(faults);
                    reader.settings.spoil(prefix);
                }
                Ok(node) => {
                    if let Some(inner) = node.get("file").or(node.get("preset")) {
                        let fault = StudyError::at(
                            "E106",
                            &inner.key_place,
                            &file_key,
                            format!(
                                "a surface file cannot name another one: {} -> {} -> {}",
                                location.file.display(),
                                source.name,
                                inner.place.text()
                            ),
                        )
                        .value(inner.place.text())
                        .allowed("the surface itself: base_recess_um, crown_nm, [[rail]], ...");
                        reader.spoil(prefix, fault);
                    } else {
                        reader.table(&node, pattern, prefix);
                        // Written out without rails the study would get the default surface's.
                        if node.get("rail").is_none() && !reader.settings.has(&rails) {
                            let fault = StudyError::at(
                                "E112",
                                &place,
                                &rails,
                                format!("the surface file {} has no rail", source.name),
                            )
                            .value(file)
                            .allowed("at least one [[rail]]")
                            .hint(
                                "a plane slider is one rail over the whole slider, recess_um = 0",
                            );
                            reader.spoil(prefix, fault);
                        }
                    }
                }
            }
        }
        return;
    }
    let preset = match text_of(reader, &preset_key) {
        Some((name, _)) => Some(name),
        None if reader.settings.has(&rails) || !reader.settings.are_sound(&[prefix]) => None,
        None => Some(DEFAULT_SURFACE.to_string()),
    };
    if let Some(name) = preset
        && let Some(text) = surfaces::text(&name)
        && let Ok(node) = tree::parse(&Source::new(format!("preset {name}"), text), Origin::Preset)
    {
        reader.table(&node, pattern, prefix);
    }
}

/// Opens a file a study names; its path starts from the study's folder.
pub fn open_named(
    reader: &mut Reader,
    location: &Location,
    key: &str,
    file: &str,
    place: &Place,
) -> Option<Arc<Source>> {
    let path = location.folder.join(file);
    let same = |a: &Path, b: &Path| match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    };
    if same(&path, &location.file) {
        let fault = StudyError::at(
            "E106",
            place,
            key,
            format!(
                "the study names itself: {} -> {}",
                location.file.display(),
                path.display()
            ),
        )
        .value(place.text())
        .allowed("another file");
        reader.spoil(key, fault);
        return None;
    }
    match text_file::read_text(&path) {
        Ok(text) => Some(Source::new(path.display().to_string(), text)),
        Err(fault) => {
            let named = StudyError::at(
                fault.code,
                place,
                key,
                format!("{}: {}", fault.file, fault.message),
            )
            .value(place.text())
            .allowed(fault.allowed.clone())
            .hint(if fault.hint.is_empty() || fault.code == "E105" {
                "file paths start from the study's folder".to_string()
            } else {
                fault.hint.clone()
            });
            reader.spoil(key, named);
            None
        }
    }
}
