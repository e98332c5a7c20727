//! What is swept: points with their coordinates and content, and how.

use std::time::Duration;

use opshock_solver::scene::knob::Knob;

use super::progress::PointLabel;
use crate::search::{Coordinates, SearchSettings};
use crate::store::{AxisValue, PointDigest, StudyTexts};
use crate::study::KeepHistories;

/// What an error bar is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct BarPlan {
    /// Knobs that can change the answer.
    pub knobs: Vec<Knob>,
    /// Times the film's cells may be halved.
    pub film_halvings: i8,
    /// Times the study's elements of the ramp's solid may be halved.
    pub mesh_halvings: i8,
    /// A film can be held still at the lowest attitude of a shock ([`Knob::HeldFilm`]).
    pub holds_films: bool,
    /// Accuracy asked for, a share.
    pub accuracy: f64,
    /// Times that the point may be turned finer where its bar exceeds that.
    pub climbs: u8,
}

/// A point of the study.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPoint {
    /// Place among the other points.
    pub coordinates: Coordinates,
    /// Values of the further axes.
    pub axes: Vec<AxisValue>,
    /// Digest of the scene, the sign and the physics versions.
    pub digest: PointDigest,
    /// How its error bar is made; `None`: the search bracket alone.
    pub bar: Option<BarPlan>,
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
    /// Names of the points for people.
    pub fn labels(&self) -> Vec<PointLabel> {
        self.points
            .iter()
            .map(|point| PointLabel {
                ramp: point.coordinates.ramp.clone(),
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
