//! Selects one shock of a study: a point and an amplitude.

use opshock_solver::quantity;

use super::checked::Study;
use super::fault::{Severity, StudyError, StudyErrors};
use super::fields;
use super::measured_pulse;
use super::points::{self, Point};
use super::settings::View;
use super::unit;
use super::validity::Check;
use crate::search::{Ramp, Sign};

/// What the command line says about a single shock. Axes it does not name must have one value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Choice {
    /// Ramp model; need not be one of the study's.
    pub ramp: Option<Ramp>,
    /// Pulse width, ms; need not be one of the study's.
    pub pulse_ms: Option<f64>,
    /// Sign of the amplitude; need not be one of the study's.
    pub sign: Option<Sign>,
    /// Amplitude, g, not negative.
    pub amplitude_g: Option<f64>,
}

/// One shock.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The point.
    pub point: Point,
    /// Amplitude with its sign, m/s2.
    pub amplitude_m_per_s2: f64,
    /// Amplitude without sign, g.
    pub amplitude_g: f64,
}

/// Why no single shock could be chosen.
#[derive(Debug, thiserror::Error)]
pub enum ChoiceError {
    /// Axes of the study are left open: a mistake on the command line.
    #[error("choose one value of {}", list(.0))]
    Free(Vec<FreeAxis>),
    /// A value that cannot be: a mistake on the command line.
    #[error("{option} {value}: must be {allowed}")]
    Value {
        /// Option.
        option: &'static str,
        /// Value given.
        value: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// The chosen shock does not fit the study.
    #[error(transparent)]
    Study(#[from] StudyErrors),
}

/// An axis that needs a choice.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeAxis {
    /// Dotted path of the key.
    pub path: String,
    /// How to choose: an option, or `--set`.
    pub option: String,
    /// Values of the study, as text.
    pub values: Vec<String>,
}

fn list(free: &[FreeAxis]) -> String {
    free.iter()
        .map(|axis| {
            format!(
                "{} ({}) with {}",
                axis.path,
                axis.values.join(", "),
                axis.option
            )
        })
        .collect::<Vec<_>>()
        .join("; ")
}

impl Study {
    /// The single shock a choice names.
    ///
    /// # Errors
    /// [`ChoiceError::Free`] lists every axis that has several values and no choice, and the
    /// amplitude when it is missing; [`ChoiceError::Value`] and [`ChoiceError::Study`] refuse
    /// values.
    pub fn select(&self, choice: &Choice) -> Result<Shot, ChoiceError> {
        let Some(amplitude_g) = choice.amplitude_g else {
            let mut free = self.free_axes(choice);
            free.push(FreeAxis {
                path: "amplitude".to_string(),
                option: "--amplitude-g".to_string(),
                values: vec!["any".to_string()],
            });
            return Err(ChoiceError::Free(free));
        };
        let point = self.select_point(choice)?;
        if !amplitude_g.is_finite() || amplitude_g < 0.0 {
            return Err(ChoiceError::Value {
                option: "--amplitude-g",
                value: amplitude_g.to_string(),
                allowed: "a finite number >= 0; the direction is chosen with --sign",
            });
        }
        let amplitude_m_per_s2 = point.factor() * quantity::m_per_s2_from_g(amplitude_g);
        Ok(Shot {
            point,
            amplitude_m_per_s2,
            amplitude_g,
        })
    }

    /// The single point a choice names, for what needs no amplitude.
    ///
    /// # Errors
    /// As [`Study::select`].
    pub fn select_point(&self, choice: &Choice) -> Result<Point, ChoiceError> {
        let free = self.free_axes(choice);
        if !free.is_empty() {
            return Err(ChoiceError::Free(free));
        }
        let pulse_ms = choice.pulse_ms.unwrap_or(self.widths_ms[0]);
        let is_width = pulse_ms.is_finite() && pulse_ms > 0.0;
        if !is_width || !unit::si(fields::PULSE_WIDTHS_MS.path(), pulse_ms).is_normal() {
            return Err(ChoiceError::Value {
                option: "--pulse-ms",
                value: pulse_ms.to_string(),
                allowed: "a finite number > 0",
            });
        }
        let view = View::first(&self.settings);
        if measured_pulse::length_ms(&view).is_some() && pulse_ms != self.widths_ms[0] {
            return Err(ChoiceError::Value {
                option: "--pulse-ms",
                value: pulse_ms.to_string(),
                allowed: "left out: a measured pulse has its own width (pulse.table_scale = \"measured\")",
            });
        }
        check_width(&view, pulse_ms)?;
        let ramp = choice.ramp.unwrap_or(self.ramps[0]);
        let sign = choice.sign.unwrap_or(self.signs[0]);
        Ok(points::point(&view, &self.axes, ramp, pulse_ms, sign))
    }

    /// The drive a choice names, for what no shock enters (modes, steady flight): ramp, width and
    /// sign may stay open and take their last, first and first value; further axes may not.
    ///
    /// # Errors
    /// As [`Study::select`].
    pub fn select_drive(&self, choice: &Choice) -> Result<Point, ChoiceError> {
        self.select_point(&Choice {
            ramp: choice.ramp.or(self.ramps.last().copied()),
            pulse_ms: choice.pulse_ms.or(self.widths_ms.first().copied()),
            sign: choice.sign.or(self.signs.first().copied()),
            amplitude_g: None,
        })
    }

    /// Axes with several values that a choice leaves open.
    fn free_axes(&self, choice: &Choice) -> Vec<FreeAxis> {
        let mut free = Vec::new();
        let mut leave_open = |chosen: bool, path: &str, option: String, values: Vec<String>| {
            if !chosen && values.len() != 1 {
                free.push(FreeAxis {
                    path: path.to_string(),
                    option,
                    values,
                });
            }
        };
        let ramps = self.ramps.iter().map(ToString::to_string).collect();
        leave_open(
            choice.ramp.is_some(),
            fields::RAMP_MODELS.path(),
            "--ramp".to_string(),
            ramps,
        );
        let widths = self.widths_ms.iter().map(ToString::to_string).collect();
        leave_open(
            choice.pulse_ms.is_some(),
            fields::PULSE_WIDTHS_MS.path(),
            "--pulse-ms".to_string(),
            widths,
        );
        let signs = self.signs.iter().map(ToString::to_string).collect();
        leave_open(
            choice.sign.is_some(),
            fields::PULSE_SIGNS.path(),
            "--sign".to_string(),
            signs,
        );
        for axis in &self.axes {
            let values = axis.values.iter().map(ToString::to_string).collect();
            leave_open(
                false,
                &axis.path,
                format!("--set {}=VALUE", axis.path),
                values,
            );
        }
        free
    }
}

/// A width from the command line must fit step and window as one of the study would.
fn check_width(view: &View<'_>, pulse_ms: f64) -> Result<(), StudyErrors> {
    let mut faults: Vec<StudyError> = Vec::new();
    Check {
        view,
        faults: &mut faults,
    }
    .width(pulse_ms);
    faults.retain(|fault| fault.severity() == Severity::Error);
    if faults.is_empty() {
        Ok(())
    } else {
        Err(StudyErrors::new(faults))
    }
}
