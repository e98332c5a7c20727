//! Ends a structural run for either contact method: energy balance, contact records, history and recorded columns.

use super::contact_log::ContactLog;
use super::driven::Driven;
use super::energy::{Energies, ExchangedEnergy};
use super::error::StructureError;
use super::history::StructuralHistory;
use super::outcome::StructureRun;
use super::record::{
    BaseRecord, Complementarity, DiskExtremes, EnergyBalance, HubRecord, MomentumBalance,
    StructureColumns,
};
use super::rotor::Body;
use super::sample::BodySample;
use super::shared::Shared;

/// What a contact method hands over at the end of a run.
pub(super) struct Closing<'a> {
    pub shared: &'a Shared,
    /// The contact-driven modes, where contact activated them.
    pub driven: Option<&'a Driven>,
    /// Last node reached.
    pub k: usize,
    /// First node whose motion is not a finite number.
    pub not_finite: Option<usize>,
    /// Energies at the last node, and the energy exchanged until then.
    pub energies: Energies,
    pub exchanged: ExchangedEnergy,
    pub extremes: DiskExtremes,
    pub complementarity: Complementarity,
    /// Hub and base, if the model has them.
    pub bodies: Option<BodyBalance>,
    pub logs: &'a [ContactLog; 2],
    pub history: StructuralHistory,
    pub columns: Option<StructureColumns>,
}

/// Momentum and extremes of hub and base along a run.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BodyBalance {
    pub amplitude: f64,
    /// State at the node reached.
    pub now: BodySample,
    /// Impulse of the ramp on the disk so far, N s.
    pub contact_n_s: f64,
    axial_max_m: f64,
    tilt_max_rad: f64,
    mounts_max_m: [f64; 3],
    momentum_max_n_s: [f64; 2],
}

impl BodyBalance {
    /// An empty balance of a run of one amplitude.
    pub fn of(amplitude: f64) -> Self {
        Self {
            amplitude,
            ..Self::default()
        }
    }

    /// Adds impulses of the supports.
    pub fn add_supports(&mut self, impulse_n_s: [f64; 2]) {
        for (sum, impulse) in self.now.support_n_s.iter_mut().zip(impulse_n_s) {
            *sum += impulse;
        }
    }

    /// Includes the state of hub and base at a node.
    pub fn include(&mut self, now: BodySample) {
        self.now = now;
        self.axial_max_m = self.axial_max_m.max(now.axial_m.abs());
        let tilt = f64::hypot(now.tilt_rad[0], now.tilt_rad[1]);
        self.tilt_max_rad = self.tilt_max_rad.max(tilt);
        for (most, x) in self.mounts_max_m.iter_mut().zip(now.mounts_m) {
            *most = most.max(x.abs());
        }
        for (most, x) in self.momentum_max_n_s.iter_mut().zip(now.momentum_n_s) {
            *most = most.max(x.abs());
        }
    }

    /// The momentum balance of body `i`.
    fn momentum(&self, i: usize, body: &Body, shared: &Shared, end_s: f64) -> MomentumBalance {
        let shock_n_s = self.amplitude * body.load_kg * shared.free.pulse.integral_s(end_s);
        let contact_n_s = self.contact_n_s * body.contact_share;
        let (support_n_s, end_n_s) = (self.now.support_n_s[i], self.now.momentum_n_s[i]);
        let left = (end_n_s - (shock_n_s + support_n_s + contact_n_s)).abs();
        let largest = self.momentum_max_n_s[i];
        MomentumBalance {
            shock_n_s,
            support_n_s,
            contact_n_s,
            end_n_s,
            closure: if largest > 0.0 { left / largest } else { 0.0 },
        }
    }

    fn records(&self, shared: &Shared, end_s: f64) -> (Option<HubRecord>, Option<BaseRecord>) {
        let Some(rotor) = &shared.free.rotor else {
            return (None, None);
        };
        let [hub, base] = rotor.parts[0].bodies.each_ref();
        let [spindle_max_m, ramp_max_m, pivot_max_m] = self.mounts_max_m;
        (
            hub.as_ref().map(|body| HubRecord {
                axial_max_m: self.axial_max_m,
                tilt_max_rad: self.tilt_max_rad,
                momentum: self.momentum(0, body, shared, end_s),
            }),
            base.as_ref().map(|body| BaseRecord {
                spindle_max_m,
                ramp_max_m,
                pivot_max_m,
                momentum: self.momentum(1, body, shared, end_s),
            }),
        )
    }
}

impl Closing<'_> {
    /// Closes the balances; the warnings are those of the model and of deep penetrations.
    ///
    /// # Errors
    /// [`StructureError::NotFinite`].
    pub fn run(self) -> Result<StructureRun, StructureError> {
        let step_s = self.shared.free.step_s;
        let end_s = self.k as f64 * step_s;
        let energy = balance(&self.energies, &self.exchanged);
        let numbers = [
            energy.h_end_j,
            energy.shock_work_j,
            energy.damping_loss_j,
            self.extremes.slider_max_m,
        ];
        if self.not_finite.is_some() || numbers.iter().any(|x| !x.is_finite()) {
            let k = self.not_finite.unwrap_or(self.k);
            return Err(StructureError::NotFinite {
                time_s: k as f64 * step_s,
            });
        }
        let mut warnings = self.shared.warnings.clone();
        warnings.extend(self.driven.iter().flat_map(|driven| &driven.warnings));
        warnings.extend(StructureRun::penetration_warning(
            self.complementarity.max_penetration_m,
        ));
        let [top, bottom] = self.logs.each_ref().map(|log| log.summary(step_s));
        let mut history = self.history;
        let kinks = self.shared.free.pulse.kinks_s().filter(|&t| t <= end_s);
        history.events_s.extend(kinks);
        history.events_s.sort_by(f64::total_cmp);
        history.events_s.dedup();
        let records = self
            .bodies
            .map(|balance| balance.records(self.shared, end_s));
        let (hub, base) = records.unwrap_or_default();
        let columns = self.columns.map(|mut columns| {
            let n = columns.time_s.len();
            columns.contact_top_n = self.logs[0].running_mean(step_s, n);
            columns.contact_bottom_n = self.logs[1].running_mean(step_s, n);
            columns
        });
        let first_touch_s = [top.first_touch_s, bottom.first_touch_s]
            .into_iter()
            .flatten()
            .min_by(f64::total_cmp);
        Ok(StructureRun {
            history,
            columns,
            disk: self.extremes,
            top,
            bottom,
            energy,
            complementarity: self.complementarity,
            hub,
            base,
            first_touch_s,
            steps: self.k as u64,
            end_s,
            warnings,
        })
    }
}

/// H at the end compared with the energy supplied and taken.
fn balance(energies: &Energies, exchanged: &ExchangedEnergy) -> EnergyBalance {
    let h_end = energies.fixed_frame;
    let peak = exchanged.peak_fixed_frame;
    let (work, damping) = (exchanged.work.value(), exchanged.damping.value());
    let net = work - damping - exchanged.impact + exchanged.algorithmic;
    EnergyBalance {
        kinetic_j: energies.kinetic,
        elastic_j: energies.elastic,
        h_end_j: h_end,
        h_peak_j: peak,
        shock_work_j: work,
        damping_loss_j: damping,
        impact_loss_j: exchanged.impact,
        algorithmic_j: exchanged.algorithmic,
        spindle_work_j: exchanged.spindle,
        closure: if peak > 0.0 {
            (h_end - net).abs() / peak
        } else {
            0.0
        },
    }
}
