//! Content of an HDF5 file as lines of text, bits of every number included; and files opened to be changed.

use std::path::Path;

use hdf5::types::{TypeDescriptor, VarLenUnicode};
use hdf5::{Container, File, Group};

/// A file to change. A process that another test starts holds the lock of a file just closed until it runs its program, so
/// that a refused lock is tried again for a second.
pub fn open_rw(path: impl AsRef<Path>) -> hdf5::File {
    for _ in 0..100 {
        match hdf5::File::open_rw(&path) {
            Err(error) if error.to_string().contains("unable to lock file") => {
                std::thread::sleep(std::time::Duration::from_millis(10));
            }
            opened => return opened.expect("opens"),
        }
    }
    panic!("{}: locked for a second", path.as_ref().display());
}

/// Lines of every attribute and dataset outside the groups and datasets named in `without`.
pub fn dump(path: &Path, without: &[&str]) -> Vec<String> {
    let file = File::open(path).expect("HDF5");
    let mut lines = Vec::new();
    walk(&file.as_group().expect("root"), without, &mut lines);
    lines
}

fn walk(group: &Group, without: &[&str], lines: &mut Vec<String>) {
    let name = group.name();
    if without.contains(&name.as_str()) {
        return;
    }
    for attribute in group.attr_names().expect("attributes") {
        let value = group.attr(&attribute).expect("attribute");
        lines.push(format!("{name}@{attribute} {}", values(&value)));
    }
    for dataset in group.datasets().expect("datasets") {
        let path = dataset.name();
        if without.contains(&path.as_str()) {
            continue;
        }
        lines.push(format!("{path} {}", values(&dataset)));
        for attribute in dataset.attr_names().expect("attributes") {
            let value = dataset.attr(&attribute).expect("attribute");
            lines.push(format!("{path}@{attribute} {}", values(&value)));
        }
    }
    for child in group.groups().expect("groups") {
        walk(&child, without, lines);
    }
}

fn values(container: &Container) -> String {
    let kind = container
        .dtype()
        .and_then(|kind| kind.to_descriptor())
        .expect("type");
    match kind {
        TypeDescriptor::Float(_) => {
            let values: Vec<f64> = container.read_raw().expect("numbers");
            let bits: Vec<String> = values
                .iter()
                .map(|value| format!("{:016x}", value.to_bits()))
                .collect();
            bits.join(" ")
        }
        TypeDescriptor::Integer(_) => {
            format!("{:?}", container.read_raw::<i64>().expect("integers"))
        }
        TypeDescriptor::Unsigned(_) => {
            format!("{:?}", container.read_raw::<u64>().expect("counts"))
        }
        _ => {
            let values: Vec<VarLenUnicode> = container.read_raw().expect("texts");
            format!(
                "{:?}",
                values.iter().map(|text| text.as_str()).collect::<Vec<_>>()
            )
        }
    }
}
