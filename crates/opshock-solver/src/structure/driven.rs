//! Holds the contact-driven modes, which are all modes of disk and arms, and their tables over one step.
//!
//! Before the first touch they are at rest, so a run builds them when it first needs them. They are sorted by rising
//! damping: the modes that have decayed after an impact are then at the end.

use super::bank::{Arm, Bank};
use super::contact_free::ContactFree;
use super::energy::{EnergyWeights, LossWeights};
use super::outcome::StructureWarning;
use super::outlook::Outlook;
use super::rotor::{self, Rotor};
use crate::complementarity::Refund;
use crate::disk::{DiskBasis, DiskMode, DiskPose};
use crate::modal::bank::padded;
use crate::modal::{BankFlow, LossForm, ModalState, Oscillator, PartFlows, Readout};

/// The spring of a contact in the bank of oscillators.
pub(super) struct DrivenSpring {
    mode: usize,
    /// Jump of the mode's velocity per impulse of the contact, 1/√kg.
    push: f64,
    /// Loss in a step; the shock does not drive the spring.
    loss: LossForm,
    /// Loss per step under equal unit impulses, one per step.
    ripple_loss: f64,
}

/// The bank of oscillators, and the rows that read points from it.
pub(super) struct Driven {
    /// The arms' modes, padded, then the disk's by rising damping, padded.
    pub oscillators: Vec<Oscillator>,
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
    /// Jumps of the rates of the slider's pose and of the pivot per impulse on the disk and on each arm, on a base.
    pub base_jumps: Option<[(DiskPose, f64); 3]>,
    pub step_flow: BankFlow,
    /// Motion of the contact point over a step.
    pub outlook: Outlook,
    /// Flows over parts of a step.
    pub part_flows: PartFlows,
    /// [`Self::compliance`] of a step.
    pub step_compliance: [[f64; 2]; 2],
    pub weights: EnergyWeights,
    /// Loss over a step.
    pub step_loss: LossWeights,
    /// Tables over a contact-free interval, for a disk on a rigid base without hub.
    pub contact_free: Option<ContactFree>,
    pub mobility: [[f64; 2]; 2],
    pub ripple_loss: [[f64; 2]; 2],
    /// Springs of both contacts; empty for hard contacts.
    springs: Vec<DrivenSpring>,
    /// Harmonics left out, waves that grow.
    pub warnings: Vec<StructureWarning>,
}

impl Driven {
    /// Tables over a bank for steps of `step_s`. `basis` is that of its disk.
    pub fn new(
        bank: Bank,
        arms: [Arm; 2],
        basis: &DiskBasis,
        rotor: Option<&Rotor>,
        step_s: f64,
    ) -> Self {
        let mut warnings = instabilities(&basis.modes, &bank.oscillators);
        let (bank, arms) = sorted(bank, arms);
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
        if basis.harmonics_bounded {
            warnings.push(StructureWarning::HarmonicsBounded);
        }
        let outlook = Outlook::new(&bank.contact, &step_flow);
        let part_flows = PartFlows::new(&bank.oscillators);
        let spring = |(side, &mode): (usize, &usize)| {
            let (sign, o) = ([1.0, -1.0][side], &bank.oscillators[mode]);
            DrivenSpring {
                mode,
                push: sign * bank.arm_shape[side][mode],
                loss: o.loss_form(step_s),
                ripple_loss: o.ripple_loss(step_s),
            }
        };
        let springs = bank.springs.iter().enumerate().map(spring).collect();
        let mut driven = Self {
            weights: EnergyWeights::new(&bank.oscillators),
            step_loss: LossWeights::new(&bank.oscillators, &bank.forced_index, step_s),
            contact_free: rotor.is_none().then(|| ContactFree::new(&bank, step_s)),
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
            outlook,
            part_flows,
            step_compliance: [[0.0; 2]; 2],
            mobility,
            ripple_loss,
            springs,
            warnings,
        };
        driven.step_compliance = driven.compliance(&driven.step_flow);
        let flow = &driven.step_flow;
        driven.outlook.response = driven.answers(|a, b| flow.response_across(a, b));
        driven
    }

    /// Gaps after `flow` per impulses at its start, s/kg, without the modes of the rotor.
    pub fn compliance(&self, flow: &BankFlow) -> [[f64; 2]; 2] {
        self.answers(|a, b| flow.compliance_across(a, b))
    }

    /// Responses of both gaps to impulses of both contacts, from the response `across` two shapes.
    fn answers(&self, across: impl Fn(&[f64], &[f64]) -> f64) -> [[f64; 2]; 2] {
        let disk = across(&self.contact, &self.contact);
        let [top, bottom] = &self.arm_shape;
        let other = match self.coupled {
            true => disk + across(top, bottom),
            false => disk,
        };
        [
            [disk + across(top, top), -other],
            [-other, disk + across(bottom, bottom)],
        ]
    }

    /// Whether contacts have a stiffness.
    pub fn has_springs(&self) -> bool {
        !self.springs.is_empty()
    }

    /// Loss in the ripple of equal `impulses`, one per step, J.
    pub fn ripple_of(&self, impulses: [f64; 2]) -> f64 {
        let (p, r) = (impulses, self.ripple_loss);
        (0..2)
            .map(|i| p[i] * (r[i][0] * p[0] + r[i][1] * p[1]))
            .sum()
    }

    /// Largest energy that impulses of a lasting contact may return in the step ahead of `now`: for the springs the
    /// damping loss of that step, for all other modes the loss under equal impulses, one per step.
    pub fn refund(&self, now: &ModalState) -> Refund {
        let mut refund = Refund {
            square_per_kg: self.ripple_loss,
            ..Refund::default()
        };
        for (side, spring) in self.springs.iter().enumerate() {
            let (push, loss) = (spring.push, &spring.loss);
            let (q, r) = (now.q_re[spring.mode], now.r_re[spring.mode]);
            refund.constant_j[side] = loss.loss(q.into(), r.into());
            refund.slope_m_per_s[side] = 2.0 * push * (loss.rr * r + loss.qr.re * q);
            refund.square_per_kg[side][side] += push * push * (loss.rr - spring.ripple_loss);
        }
        refund
    }

    /// Number of the arms' modes with padding; the disk's modes follow.
    pub fn n_of_arms(&self) -> usize {
        padded(self.arms[1].modes.end)
    }

    /// Modes of disk and arms, without padding.
    pub fn n_modes(&self) -> usize {
        let used = |o: &&Oscillator| o.omega_rad_per_s > 0.0;
        self.oscillators.iter().filter(used).count()
    }
}

/// Sorts the bank: the arms' modes, then the disk's by rising damping. Returns the arms with their new indices.
pub(super) fn sorted(mut bank: Bank, arms: [Arm; 2]) -> (Bank, [Arm; 2]) {
    let is_used = |&i: &usize| bank.oscillators[i].omega_rad_per_s > 0.0;
    let disk = (0..bank.n_disk).filter(is_used);
    let mut disk: Vec<usize> = disk.collect();
    let damping = |i: usize| {
        let o = &bank.oscillators[i];
        o.half_damping_per_s + o.fixed_damping_per_s
    };
    disk.sort_by(|&a, &b| damping(a).total_cmp(&damping(b)));
    let on_arms = (bank.n_disk..bank.oscillators.len()).filter(is_used);
    let mut order: Vec<Option<usize>> = on_arms.map(Some).collect();
    order.resize(padded(order.len()), None);
    order.extend(disk.into_iter().map(Some));
    order.resize(padded(order.len()), None);

    let pick = |column: &mut Vec<f64>| {
        let entry = |at: &Option<usize>| at.and_then(|i| column.get(i)).copied();
        *column = order.iter().map(|at| entry(at).unwrap_or(0.0)).collect();
    };
    for column in [&mut bank.contact, &mut bank.contact_turn, &mut bank.rim] {
        pick(column);
    }
    bank.arm_shape.iter_mut().for_each(pick);
    for readout in &mut bank.slider {
        pick(&mut readout.re);
        pick(&mut readout.im);
    }
    let oscillator = |at: &Option<usize>| at.map(|i| bank.oscillators[i]).unwrap_or_default();
    bank.oscillators = order.iter().map(oscillator).collect();
    for index in bank.forced_index.iter_mut().chain(&mut bank.springs) {
        let place = order.iter().position(|at| *at == Some(*index));
        *index = place.expect("every mode has a place");
    }
    let arms = arms.map(|arm| Arm {
        modes: arm.modes.start - bank.n_disk..arm.modes.end - bank.n_disk,
    });
    (bank, arms)
}

/// Modes that grow: damping fixed in space above a critical speed.
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
