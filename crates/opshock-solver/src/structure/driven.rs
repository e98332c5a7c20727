//! What contact drives: every mode of disk and arms, and the tables of one step.
//!
//! Nothing moves it before the first touch, so it is built when a run first needs it.

use super::bank::Bank;
use super::energy::EnergyWeights;
use super::model::StructureWarning;
use super::rotor::{self, Rotor};
use crate::disk::{DiskBasis, DiskMode, DiskPose};
use crate::modal::{BankFlow, Oscillator, Readout};
use std::ops::Range;

/// One arm in the bank of oscillators.
pub(super) struct Arm {
    /// Indices of its modes in the bank.
    pub modes: Range<usize>,
}

/// The bank of oscillators and what is read from it.
pub(super) struct Driven {
    /// Disk modes, then the arms' modes, padded.
    pub oscillators: Vec<Oscillator>,
    /// Disk modes including padding.
    pub n_disk: usize,
    /// Bank index of each forced mode.
    pub forced_index: Vec<usize>,
    pub arms: [Arm; 2],
    /// Whether both arms are one body with the same modes.
    pub coupled: bool,
    /// Shape of the disk at the contact point, over the bank (zero on arms).
    pub contact: Vec<f64>,
    /// Nodal diameters times `contact`: −Im of it reads w_θ.
    pub contact_turn: Vec<f64>,
    /// Shapes 1/√m of each arm's contact point over the bank.
    pub arm_shape: [Vec<f64>; 2],
    pub rim: Vec<f64>,
    /// Displacement, pitch and roll at the slider.
    pub slider: [Readout; 3],
    /// Jump of the slider's pose rate per impulse on the disk.
    pub slider_jump: DiskPose,
    /// That of the slider's pose and of the pivot per impulse on the disk and on each arm, on a base.
    pub base_jumps: Option<[(DiskPose, f64); 3]>,
    pub step_flow: BankFlow,
    pub weights: EnergyWeights,
    pub mobility: [[f64; 2]; 2],
    pub ripple_loss: [[f64; 2]; 2],
    /// Harmonics left out, waves that grow.
    pub warnings: Vec<StructureWarning>,
}

impl Driven {
    /// Tables over a padded bank for steps of `step_s`. `basis` is that of its disk.
    pub fn new(
        bank: Bank,
        arms: [Arm; 2],
        basis: &DiskBasis,
        rotor: Option<&Rotor>,
        step_s: f64,
    ) -> Self {
        let mut step_flow = BankFlow::zeros(bank.oscillators.len());
        step_flow.set(&bank.oscillators, step_s);
        let mut mobility = bank.contact_matrix(|_| 1.0);
        let mut ripple_loss = bank.contact_matrix(|o| o.ripple_loss(step_s));
        let mut slider_jump = bank.slider_jump();
        if let Some(rotor) = rotor {
            rotor::add(&mut mobility, &rotor.mobility());
            rotor::add(&mut ripple_loss, &rotor.ripple_loss());
            slider_jump = slider_jump.plus(&rotor.slider_jump());
        }
        let base_jumps = rotor.and_then(Rotor::base_jumps).map(|mut jumps| {
            jumps[0].0 = slider_jump;
            jumps
        });
        let mut warnings = instabilities(&basis.modes, &bank.oscillators);
        if basis.harmonics_bounded {
            warnings.push(StructureWarning::HarmonicsBounded);
        }
        Self {
            weights: EnergyWeights::new(&bank.oscillators, &bank.forced_index, step_s),
            n_disk: bank.n_disk,
            oscillators: bank.oscillators,
            forced_index: bank.forced_index,
            coupled: arms[0].modes == arms[1].modes && !arms[0].modes.is_empty(),
            arms,
            contact: bank.contact,
            contact_turn: bank.contact_turn,
            arm_shape: bank.arm_shape,
            rim: bank.rim,
            slider: bank.slider,
            slider_jump,
            base_jumps,
            step_flow,
            mobility,
            ripple_loss,
            warnings,
        }
    }

    /// Modes of disk and arms, without padding.
    pub fn n_modes(&self) -> usize {
        let used = |o: &&Oscillator| o.omega_rad_per_s > 0.0;
        self.oscillators.iter().filter(used).count()
    }
}

/// Modes that grow: air held in space above a critical speed.
fn instabilities(modes: &[DiskMode], oscillators: &[Oscillator]) -> Vec<StructureWarning> {
    modes
        .iter()
        .zip(oscillators)
        .filter_map(|(mode, o)| {
            let growth_per_s = o.roots().iter().map(|r| r.re).fold(f64::MIN, f64::max);
            (growth_per_s > 0.0).then_some(StructureWarning::PhysicalInstability {
                nodal_diameters: mode.nodal_diameters,
                growth_per_s,
            })
        })
        .collect()
}
