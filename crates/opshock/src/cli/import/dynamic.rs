//! Reads the suspension's matrices beside a CMLAir `DynLULS.def` (a dynamic run) for the study's folder.

use opshock_import::cml::dynamic::flexure::{Parted, part};
use opshock_import::cml::dynamic::{Contents, DynamicFile};
use opshock_import::matrix::check::{self, Found};
use opshock_import::matrix::system::System;
use opshock_import::matrix::units::Units;
use opshock_import::matrix::{dense, dof::Freedoms};
use opshock_import::text::Source;
use opshock_import::{Fault, Faults};
use std::path::Path;

/// Names of the files: mass, stiffness, places and kinds of the rows.
pub const FILES: [&str; 3] = ["susp_M.dat", "susp_K.dat", "susp_cords.dat"];

/// A suspension by matrices.
pub struct Beside {
    /// Text of each of [`FILES`].
    pub texts: [String; 3],
    /// Keys of `[suspension.imported]`.
    pub keys: String,
    /// What is questionable about the matrices.
    pub found: Found,
    /// What a deck of version 6.4 has in them beside the suspension.
    pub parted: Option<Parted>,
}

/// Reads the matrices beside `dynamic`; nothing where none of the files is there.
///
/// # Errors
/// E160 where some are there and others are not, what is wrong with the matrices, E161 for another number of
/// rows than the file gives, E169 where it names no freedom of the slider.
pub fn beside(path: &Path, dynamic: &DynamicFile) -> Result<Option<Beside>, Faults> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let paths = FILES.map(|name| folder.join(name));
    if !paths.iter().any(|path| path.exists()) {
        return Ok(None);
    }
    let mut sources = Vec::new();
    let mut faults = Faults::default();
    for path in &paths {
        match Source::read(path) {
            Ok(source) => sources.push(source),
            Err(wrong) => faults.append(wrong),
        }
    }
    faults.or(())?;
    let parted = match &dynamic.suspension {
        Contents::Deck(deck) => Some(part(deck, [&sources[0], &sources[1], &sources[2]])?),
        Contents::Unknown | Contents::Suspension(_) => None,
    };
    if let Some(parted) = &parted {
        for (source, text) in sources.iter_mut().zip(&parted.texts) {
            *source = Source::of(&source.name, text.clone().into_bytes())?;
        }
    }
    let [mass, stiffness, places] = [&sources[0], &sources[1], &sources[2]];
    let (freedoms, _) = dense::read_places(places)?;
    let dimple = match &parted {
        Some(parted) => parted.dimple,
        None => dimple(dynamic, &freedoms, &path.display().to_string())?,
    };
    let matrices = (dense::read(mass, true)?, dense::read(stiffness, true)?);
    let units = Units::MillimetreMillinewton;
    let system = System::of(matrices.0, matrices.1, None, Some(freedoms), units)?;
    let (_, found) = check::check(system, false)?;
    let keys = format!(
        "mass = \"{}\"\nstiffness = \"{}\"\nplaces = \"{}\"\nunits = \"mm_mn\"\ndimple = {dimple}\n",
        FILES[0], FILES[1], FILES[2]
    );
    Ok(Some(Beside {
        texts: [mass, stiffness, places].map(|source| source.text().to_owned()),
        keys,
        found,
        parted,
    }))
}

/// Node of the slider's first freedom.
fn dimple(dynamic: &DynamicFile, freedoms: &Freedoms, file: &str) -> Result<u64, Faults> {
    let leave = "--without-matrices takes the suspension of the default drive";
    let Contents::Suspension(declared) = &dynamic.suspension else {
        let fault = Fault::of(
            "E169",
            file,
            "the section of the matrices names no freedom of the slider",
        );
        return Err(fault
            .what("matrices of the suspension")
            .allowed("names, and values that start with: rows, dtfac, first freedom of the slider")
            .hint(leave)
            .into());
    };
    if declared.n_rows != freedoms.len() {
        let fault = Fault::of(
            "E161",
            file,
            "another number of rows than susp_cords.dat has",
        );
        return Err(fault
            .what("size")
            .value(declared.n_rows.to_string())
            .allowed(freedoms.len().to_string())
            .hint(leave)
            .into());
    }
    // Rows are counted from 1, and are at most those of the file.
    let freedom = freedoms.get(declared.slider_row - 1);
    Ok(freedom.map_or(0, |freedom| freedom.node))
}
