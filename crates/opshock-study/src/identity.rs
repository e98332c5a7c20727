//! Identities by content: digests of cells and of the stages of a simulation.
//!
//! Equal inputs have equal identities, on every machine and in every study. A cell is one search: a scene and the sign
//! of its amplitude. Its [`CellId`] and the keys of the two stages are digests of the scene's SI numbers as JSON, with
//! the shortest digits that read back to the same bits. New fields are digested without further code; a new field of a
//! scene does not compile until it is one of `structure`'s or `head`'s.

use opshock_solver::scene::Scene;
use serde::Serialize;
use serde_json::ser::{CompactFormatter, Formatter, Serializer};
use std::io;

/// Version of the contact of asperities, raised by hand as those of the stages are; it counts where slider and disk are rough.
const CONTACT_VERSION: u32 = 2;

/// Identity of one cell: a scene and the sign of its amplitude.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CellId(pub [u8; 16]);

impl CellId {
    /// Identity of a scene shaken with one sign of the amplitude, for a head that faces down or up.
    pub fn new(scene: &Scene, positive: bool, up: bool) -> Self {
        Self(digest(
            "opshock cell 2",
            &(structure(scene), head(scene), positive, up),
        ))
    }

    /// Reads the 32 hexadecimal digits written by [`Display`](std::fmt::Display).
    pub fn from_hex(text: &str) -> Option<Self> {
        let mut bytes = [0; 16];
        if text.len() != 32 || !text.is_ascii() {
            return None;
        }
        for (byte, digits) in bytes.iter_mut().zip(text.as_bytes().chunks_exact(2)) {
            *byte = u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()?;
        }
        Some(Self(bytes))
    }
}

impl std::fmt::Display for CellId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl std::fmt::Debug for CellId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "CellId({self})")
    }
}

/// Key of the structural stage: everything disk, ramp and their motion at the slider depend on,
/// and nothing else. `physics_version` is the stage's own.
pub fn structure_key(scene: &Scene, physics_version: u32) -> [u8; 16] {
    digest("opshock structure 2", &(physics_version, structure(scene)))
}

/// Key of the head stage: the structural stage and everything the head depends on.
pub fn head_key(scene: &Scene, structure_version: u32, head_version: u32) -> [u8; 16] {
    let versions = [structure_version, head_version];
    digest("opshock head 2", &(versions, structure(scene), head(scene)))
}

/// Key of the defect correction of a film: all that [`Bearing::has_reference`](opshock_solver::simulation::Bearing::has_reference)
/// compares, and the program that samples it.
pub fn correction_key(scene: &Scene, program: &str) -> [u8; 16] {
    let film = &scene.film_resolution;
    let of_film = (film.min_height_m, film.correction_cells, scene.flow);
    let of_slider = (&scene.slider, &scene.gas, &scene.gap_forces);
    let held = (scene.disk.spin_rad_per_s, scene.suspension.gram_load_n);
    digest(
        "opshock correction 1",
        &(program, CONTACT_VERSION, of_film, of_slider, held),
    )
}

/// Everything that disk, ramp and their motion at the slider depend on.
fn structure(scene: &Scene) -> impl Serialize {
    let Scene {
        pulse,
        oblique,
        base,
        window,
        disk,
        run_out: _,
        ramp,
        slider,
        disk_resolution,
        structure_resolution,
        suspension: _,
        gas: _,
        flow: _,
        gap_forces: _,
        fail_below_m: _,
        damage: _,
        film_resolution: _,
        head_resolution: _,
        not_refined: _,
    } = scene;
    // The head meets the disk at the slider's centre, in the slider's axes.
    let place = [slider.radius_m, slider.angle_rad, slider.skew_rad];
    let shock = (pulse, oblique, base, window);
    (
        shock,
        disk,
        ramp,
        place,
        disk_resolution,
        structure_resolution,
    )
}

/// A part of a scene, with what came later and only some scenes have: the digests of the others are what they were.
#[derive(Serialize)]
#[serde(untagged)]
enum Part<A, B> {
    Plain(A),
    With(A, B),
}

/// Everything else the head depends on.
fn head(scene: &Scene) -> impl Serialize {
    let Scene {
        slider,
        suspension,
        gas,
        flow,
        gap_forces,
        fail_below_m,
        damage,
        film_resolution,
        head_resolution,
        oblique: _,
        base: _,
        pulse: _,
        window: _,
        disk: _,
        run_out,
        ramp: _,
        disk_resolution: _,
        structure_resolution: _,
        not_refined: _,
    } = scene;
    let film = (gas, flow, gap_forces, film_resolution);
    let film = match gap_forces.asperity_contact.roughness_m > 0.0 {
        true => Part::With(film, CONTACT_VERSION),
        false => Part::Plain(film),
    };
    let failure = match damage {
        Some(limits) => Part::With(fail_below_m, limits),
        None => Part::Plain(fail_below_m),
    };
    (slider, suspension, film, failure, head_resolution, run_out)
}

/// JSON in which minus zero is zero: they are the same input.
struct ZeroHasNoSign;

impl Formatter for ZeroHasNoSign {
    fn write_f64<W: ?Sized + io::Write>(&mut self, writer: &mut W, value: f64) -> io::Result<()> {
        CompactFormatter.write_f64(writer, value + 0.0)
    }
}

fn digest(domain: &str, content: &impl Serialize) -> [u8; 16] {
    let mut hasher = blake3::Hasher::new();
    let mut serializer = Serializer::with_formatter(&mut hasher, ZeroHasNoSign);
    (domain, content)
        .serialize(&mut serializer)
        .expect("a scene is plain data");
    let mut bytes = [0; 16];
    bytes.copy_from_slice(&hasher.finalize().as_bytes()[..16]);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_identity_survives_its_text() {
        let id = CellId(std::array::from_fn(|i| 17 * i as u8));
        assert_eq!(id.to_string(), "00112233445566778899aabbccddeeff");
        assert_eq!(CellId::from_hex(&id.to_string()), Some(id));
        assert_eq!(CellId::from_hex("12"), None);
    }
}
