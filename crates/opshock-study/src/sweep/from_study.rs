//! Converts a study file to the input of a sweep.

use std::time::Duration;

use opshock_solver::scene::discretisation::{Discretisation, Levels};
use opshock_solver::scene::plan::{Mode, Touch};
use opshock_solver::scene::{Scene, Window};
use opshock_solver::simulation::{Bearing, is_correction_kept};
use serde_json::json;

use super::input::{KEPT_LEVELS, PointFilm, SweepInput, SweepPoint, UncertaintyPlan};
use crate::identity;
use crate::provenance::{PHYSICS_HEAD, PHYSICS_STRUCTURE};
use crate::search::decisive::Question;
use crate::search::uncertainty::MOST_STEPS;
use crate::search::{AmplitudeGridError, Coordinates, SearchSettings, Sign};
use crate::store::{PointDigest, StudyTexts};
use crate::study::{Faces, HEADS, Point, Study, UncertaintyOf, keys};

impl SweepInput {
    /// The points of a study in the order of its tables ([`Study::table_order`]): point `i` here
    /// is `study.points[study.table_order()[i]]`.
    ///
    /// # Errors
    ///
    /// The amplitude range has no point of the tolerance's amplitude grid.
    pub fn of(study: &Study) -> Result<SweepInput, AmplitudeGridError> {
        let search = &study.search;
        // A window that ends when the motion has died away needs no check by a longer one.
        let is_fixed = |point: &Point| matches!(point.scene.window, Window::Fixed { .. });
        let settings = SearchSettings::new(
            (search.amplitude_min_g, search.amplitude_max_g),
            search.tolerance_pct / 100.0,
            search.monotonicity_scan,
            search.scan_gap_pct / 100.0,
            study.points.iter().any(is_fixed),
        )?;
        let mut axes = study.axes.iter();
        // A full model shares nothing.
        let clearance_axis = axes
            .position(|axis| axis.path == CLEARANCE)
            .filter(|_| study.plan().mode == Mode::Auto);
        let mut films: Vec<(&Scene, [bool; KEPT_LEVELS])> = Vec::new();
        let points: Vec<SweepPoint> = study
            .table_order()
            .into_iter()
            .map(|place| {
                let point = &study.points[place];
                let film = film(&point.scene, &mut films);
                sweep_point(point, search, clearance_axis, film)
            })
            .collect();
        let is_decisive = search.uncertainty && search.uncertainty_of == UncertaintyOf::Decisive;
        Ok(SweepInput {
            texts: StudyTexts {
                name: study.name.clone(),
                digest: study.digest_hex(),
                file: study.file.clone(),
                given: study.text.clone(),
                resolved: study.resolved_toml(),
            },
            plan: plan_json(study),
            axes: study.axes.iter().map(|axis| axis.column.clone()).collect(),
            decides: is_decisive.then(|| match search.required_amplitude_g {
                Some(amplitude_g) => Question::Survives(amplitude_g),
                None => Question::BestValue(choices(study, &points)),
            }),
            points,
            settings,
            start_s: study.start_s,
            keep_histories: study.output.keep_histories,
            checkpoint: Duration::from_secs_f64(study.output.checkpoint_s.clamp(0.1, 1e6)),
        })
    }
}

/// The study's plan for each ramp: effects at the start of a run, rules applied below and above the first touch.
fn plan_json(study: &Study) -> String {
    let plan = study.plan();
    let mut scenes = serde_json::Map::new();
    for point in &study.points {
        let scene = &point.scene;
        let effects = plan.effects(scene, &Touch::default());
        let effects = effects
            .iter()
            .map(|effect| (effect.name.to_owned(), json!(effect.state.as_str())))
            .collect::<serde_json::Map<_, _>>();
        let of_ramp = json!({
            "effects": effects,
            "rules_below_touch": plan.applied(scene, false),
            "rules_above_touch": plan.applied(scene, true),
        });
        scenes.entry(point.ramp.as_str()).or_insert(of_ramp);
    }
    let outputs: Vec<&str> = plan.outputs.iter().map(|output| output.as_str()).collect();
    let mut whole = json!({"effects": plan.mode.as_str(), "outputs": outputs, "ramps": scenes});
    if !plan.field_times_s.is_empty() {
        whole["field_times_s"] = json!(plan.field_times_s);
    }
    whole.to_string()
}

/// The axes of which a value is chosen: ramp models, and every further one of the drive but its heads, which must all
/// survive. For each the number of the value of every point; without any, one value of all.
fn choices(study: &Study, points: &[SweepPoint]) -> Vec<Vec<usize>> {
    fn numbered<T: PartialEq>(values: impl Iterator<Item = T>) -> Vec<usize> {
        let mut known: Vec<T> = Vec::new();
        let number = |value: T| {
            let number = known.iter().position(|other| *other == value);
            number.unwrap_or_else(|| {
                known.push(value);
                known.len() - 1
            })
        };
        values.map(number).collect()
    }
    let mut axes = vec![numbered(points.iter().map(|point| point.coordinates.ramp))];
    for (place, axis) in study.axes.iter().enumerate() {
        if axis.path != HEADS && keys::is_of_the_drive(&axis.path) {
            let values = points.iter().map(|point| &point.coordinates.axes[place]);
            axes.push(numbered(values));
        }
    }
    axes.retain(|axis| axis.iter().any(|&number| number > 0));
    if axes.is_empty() {
        axes.push(vec![0; points.len()]);
    }
    axes
}

/// The key whose values are clearances called failure.
const CLEARANCE: &str = "failure.clearance_nm";

/// The film of `scene`, numbered among the `known` ones, of which it is known which corrections are kept.
fn film<'a>(scene: &'a Scene, known: &mut Vec<(&'a Scene, [bool; KEPT_LEVELS])>) -> PointFilm {
    let place = known
        .iter()
        .position(|(known, _)| Bearing::has_reference(scene, known));
    let number = place.unwrap_or_else(|| {
        let is_kept = |place: usize| {
            let level = place as i8 + 1;
            let levels = Levels::NONE.changed(Discretisation::FilmCorrection, level);
            is_correction_kept(&scene.at_levels(levels))
        };
        known.push((scene, std::array::from_fn(is_kept)));
        known.len() - 1
    });
    PointFilm {
        number,
        cells: scene.film_resolution.cells,
        kept: known[number].1,
    }
}

fn sweep_point(
    point: &Point,
    search: &crate::study::SearchSettings,
    clearance_axis: Option<usize>,
    film: PointFilm,
) -> SweepPoint {
    SweepPoint {
        coordinates: Coordinates {
            ramp: point.ramp,
            pulse_ms: point.pulse_ms,
            sign: point.sign,
            axes: point
                .axes
                .iter()
                .map(|(_, value)| sortable(value))
                .collect(),
            round: point.round,
            fail_below_m: point.scene.fail_below_m,
            // Whether the slider follows a disk with run-out is judged by that clearance too; damage is not judged by it.
            clearance_axis: clearance_axis
                .filter(|_| point.scene.run_out.is_empty() && point.scene.damage.is_none()),
        },
        axes: point.axes.iter().map(|(_, value)| value.into()).collect(),
        digest: digest(point, point.sign),
        below_continuum: point.scene.fails_below_continuum(),
        film,
        uncertainty: search
            .uncertainty
            .then(|| uncertainty_plan(point, search.max_refinements)),
    }
}

/// Number of cells below which a film does not resolve rails and is no estimate of finer ones.
const COARSEST_FILM: usize = 60;

fn uncertainty_plan(point: &Point, refinements: u8) -> UncertaintyPlan {
    let cells = point.scene.film_resolution.cells;
    let ramp = &point.scene.ramp;
    let mut discretisations = point.scene.discretisations();
    discretisations.extend(point.remeshed.as_ref().map(|_| Discretisation::RampMesh));
    UncertaintyPlan {
        discretisations,
        film_halvings: (0..=3_i8)
            .rev()
            .find(|&halvings| cells >> halvings >= COARSEST_FILM)
            .unwrap_or(0),
        mesh_halvings: match &point.remeshed {
            Some(ramp) => ramp.halvings(MOST_STEPS + 1),
            None => 0,
        },
        hard_contact: !ramp.model.is_absent() && ramp.contact_stiffness_n_per_m.is_none(),
        target: point.target_uncertainty,
        refinements,
    }
}

/// Content of a point: its scene, the solid that its ramp is remade of, the physics versions, the
/// sign and the way the head faces.
///
/// Without a ramp the clearances mean nothing: such scenes share their runs along a clearance
/// axis.
fn digest(point: &Point, sign: Sign) -> PointDigest {
    let scene = &point.scene;
    let key = if scene.ramp.model.is_absent() {
        let mut bare = scene.clone();
        bare.ramp.clearance_top_m = 0.0;
        bare.ramp.clearance_bottom_m = 0.0;
        bare.ramp.restitution = 0.0;
        bare.ramp.contact_stiffness_n_per_m = None;
        identity::head_key(&bare, PHYSICS_STRUCTURE, PHYSICS_HEAD)
    } else {
        identity::head_key(scene, PHYSICS_STRUCTURE, PHYSICS_HEAD)
    };
    let mut hasher = blake3::Hasher::new();
    hasher.update(b"opshock point 1");
    hasher.update(&key);
    hasher.update(sign.as_str().as_bytes());
    // Two solids may have the same oscillators, rounded as they are, and others on other meshes.
    if let Some(ramp) = &point.remeshed {
        hasher.update(b"remeshed 1");
        hasher.update(ramp.content().as_bytes());
    }
    if point.faces == Faces::Up {
        hasher.update(b"faces up");
    }
    PointDigest(*hasher.finalize().as_bytes())
}

/// Text that sorts as the value does.
fn sortable(value: &crate::study::AxisValue) -> String {
    let ordered = |number: f64| {
        let bits = (number + 0.0).to_bits();
        // Negative numbers descend by their bits; the flip makes all of them ascend.
        let flipped = if bits >> 63 == 1 {
            !bits
        } else {
            bits | 1 << 63
        };
        format!("{flipped:016x}")
    };
    match value {
        crate::study::AxisValue::Number(number) => ordered(*number),
        crate::study::AxisValue::Integer(number) => ordered(*number as f64),
        crate::study::AxisValue::Word(word) => word.clone(),
        crate::study::AxisValue::Flag(flag) => flag.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_sort_as_text() {
        let numbers = [-2e300, -1.5, -1e-300, 0.0, 1e-300, 2.0, 10.0, 1e9];
        let texts: Vec<String> = numbers
            .iter()
            .map(|&number| sortable(&crate::study::AxisValue::Number(number)))
            .collect();
        assert!(texts.is_sorted(), "{texts:?}");
    }

    #[test]
    fn a_study_is_swept_in_the_order_of_its_tables() {
        let set = "ramp.clearance_um=[100, 60]"
            .parse()
            .expect("a set argument");
        let study = Study::from_text(&Study::example("order"), &[set]).expect("a study");
        let input = SweepInput::of(&study).expect("input");
        assert_eq!(input.points.len(), study.points.len());
        for (point, &place) in input.points.iter().zip(&study.table_order()) {
            assert_eq!(point.coordinates.pulse_ms, study.points[place].pulse_ms);
        }
        // Without a ramp both clearances are the same point; with one they are not.
        let digests = |ramp: crate::search::Ramp| {
            let mut all: Vec<_> = input
                .points
                .iter()
                .filter(|point| point.coordinates.ramp == ramp)
                .map(|point| point.digest)
                .collect();
            let n = all.len();
            all.sort();
            all.dedup();
            (n, all.len())
        };
        let (n, distinct) = digests(crate::search::Ramp::None);
        assert_eq!(distinct * 2, n);
        let (n, distinct) = digests(crate::search::Ramp::Rigid);
        assert_eq!(distinct, n);
    }
}
