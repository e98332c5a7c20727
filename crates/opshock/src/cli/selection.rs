//! Options that choose a point of a study, and a shock.

use super::failure::Failure;
use clap::Args;
use opshock_study::study::{Choice, Point, Ramp, Sign, Study};

/// A point of a study; axes with several values need a choice.
#[derive(Args, Clone, Debug, Default)]
pub struct PointArgs {
    /// Ramp model: none, rigid or deformable
    #[arg(long, value_name = "MODEL", value_parser = ramp)]
    pub ramp: Option<Ramp>,
}

/// One shock.
#[derive(Args, Clone, Debug, Default)]
pub struct ShockArgs {
    #[command(flatten)]
    pub point: PointArgs,
    /// Pulse width, ms
    #[arg(long, value_name = "MS", allow_hyphen_values = true)]
    pub pulse_ms: Option<f64>,
    /// Amplitude without sign, G
    #[arg(long, value_name = "G", allow_hyphen_values = true)]
    pub amplitude_g: Option<f64>,
    /// Sign: + moves the disk towards the slider first
    #[arg(long, value_name = "SIGN", value_parser = sign, allow_hyphen_values = true)]
    pub sign: Option<Sign>,
}

impl ShockArgs {
    /// Anything was chosen.
    pub fn is_given(&self) -> bool {
        self.choice() != Choice::default()
    }

    /// As the study takes it.
    pub fn choice(&self) -> Choice {
        Choice {
            ramp: self.point.ramp,
            pulse_ms: self.pulse_ms,
            sign: self.sign,
            amplitude_g: self.amplitude_g,
        }
    }
}

/// The point for what happens without a shock: width and sign do not matter, and of several ramp
/// models the most flexible is taken.
///
/// # Errors
///
/// Further axes without a choice.
pub fn unshaken_point(study: &Study, arguments: &PointArgs) -> Result<Point, Failure> {
    Ok(study.select_point(&Choice {
        ramp: arguments.ramp.or(study.ramps.last().copied()),
        pulse_ms: study.widths_ms.first().copied(),
        sign: study.signs.first().copied(),
        amplitude_g: None,
    })?)
}

fn ramp(word: &str) -> Result<Ramp, String> {
    Ramp::from_word(word).ok_or_else(|| "must be none, rigid or deformable".to_owned())
}

fn sign(word: &str) -> Result<Sign, String> {
    Sign::from_word(word).ok_or_else(|| "must be + or -".to_owned())
}
