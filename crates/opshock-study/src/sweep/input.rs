//! Input of a sweep: points with their coordinates and digests, and the settings of search and uncertainty.

use std::time::Duration;

use opshock_solver::scene::discretisation::Discretisation;

use super::progress::PointLabel;
use crate::search::decisive::Question;
use crate::search::{Coordinates, SearchSettings};
use crate::store::{AxisValue, PointDigest, StudyTexts};
use crate::study::KeepHistories;

/// Input of a point's uncertainty interval.
#[derive(Clone, Debug, PartialEq)]
pub struct UncertaintyPlan {
    /// Discretisation parameters that can change the answer.
    pub discretisations: Vec<Discretisation>,
    /// Times the film's cells may be halved.
    pub film_halvings: i8,
    /// Times the study's elements of the ramp's solid may be halved.
    pub mesh_halvings: i8,
    /// The ramp's contact has no stiffness.
    pub hard_contact: bool,
    /// Target uncertainty, a share.
    pub target: f64,
    /// Largest number of adaptive refinements of the point.
    pub refinements: u8,
}

/// The film of a point, as far as its time is concerned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointFilm {
    /// Number among the films of the study that differ in their defect correction.
    pub number: usize,
    /// Cells.
    pub cells: usize,
    /// Refinement levels, from 1, at which its defect correction is kept from another process.
    pub kept: [bool; KEPT_LEVELS],
}

/// Refinement levels of the defect correction that an interval of a study at `coarse` or `standard` asks for.
pub(super) const KEPT_LEVELS: usize = 2;

/// A point of the study.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPoint {
    /// Place among the other points.
    pub coordinates: Coordinates,
    /// Values of the further axes.
    pub axes: Vec<AxisValue>,
    /// Digest of the scene, the sign and the physics versions.
    pub digest: PointDigest,
    /// The clearance called failure is below twice the minimum film height.
    pub below_continuum: bool,
    /// Its film.
    pub film: PointFilm,
    /// How its uncertainty interval is made; `None`: the search bracket alone.
    pub uncertainty: Option<UncertaintyPlan>,
}

/// A study as the sweep sees it.
#[derive(Clone, Debug)]
pub struct SweepInput {
    /// The study, kept in the store.
    pub texts: StudyTexts,
    /// Effects and rules of each ramp's scenes, as JSON; kept with the results.
    pub plan: String,
    /// Names of the further axes.
    pub axes: Vec<String>,
    /// Points in the study's order.
    pub points: Vec<SweepPoint>,
    /// Intervals are made for the points alone on which the answer to this question depends
    /// ([`crate::search::decisive`]). `None`: for all points.
    pub decides: Option<Question>,
    /// Search.
    pub settings: SearchSettings,
    /// Time between checkpoints.
    pub checkpoint: Duration,
    /// Onset of the pulse on the study's time axis, s.
    pub start_s: f64,
    /// Which histories are kept.
    pub keep_histories: KeepHistories,
}

impl SweepInput {
    /// The same study without refinement; `None` where none may be refined.
    pub fn without_refinement(&self) -> Option<SweepInput> {
        let mut plain = self.clone();
        let mut may = false;
        for plan in plain
            .points
            .iter_mut()
            .filter_map(|point| point.uncertainty.as_mut())
        {
            may |= plan.refinements > 0;
            plan.refinements = 0;
        }
        may.then_some(plain)
    }

    /// Names of the points, as messages show them.
    pub fn labels(&self) -> Vec<PointLabel> {
        self.points
            .iter()
            .map(|point| PointLabel {
                ramp: point.coordinates.ramp.to_string(),
                pulse_ms: point.coordinates.pulse_ms,
                sign: point.coordinates.sign,
                axes: self
                    .axes
                    .iter()
                    .zip(&point.axes)
                    .map(|(name, value)| format!("{name}={value}"))
                    .collect(),
            })
            .collect()
    }
}
