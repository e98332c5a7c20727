//! How a run ends, whatever carried it: energy book, contacts, history, columns.

use super::contact_log::ContactLog;
use super::energy::{Energies, Ledger};
use super::free_motion::HubSample;
use super::history::StructuralHistory;
use super::model::{Shared, StructureError, StructureRun};
use super::record::{Complementarity, DiskExtremes, EnergyBook, HubRecord, StructureColumns};
use super::rotor::Rotor;

/// What a method of contact leaves behind.
pub(super) struct Closing<'a> {
    pub shared: &'a Shared,
    /// Last node reached.
    pub k: usize,
    /// First node whose motion is not a finite number.
    pub not_finite: Option<usize>,
    /// Energies at the last node, and what was exchanged until then.
    pub energies: Energies,
    pub ledger: Ledger,
    pub extremes: DiskExtremes,
    pub complementarity: Complementarity,
    pub hub: Option<HubBook>,
    pub logs: &'a [ContactLog; 2],
    pub history: StructuralHistory,
    pub columns: Option<StructureColumns>,
}

/// The hub along a run.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HubBook {
    pub amplitude: f64,
    /// Now.
    pub now: HubSample,
    /// Impulse of the ramp on the disk so far, N s.
    pub contact_n_s: f64,
    axial_max_m: f64,
    tilt_max_rad: f64,
    momentum_max_n_s: f64,
}

impl HubBook {
    /// A book of one amplitude.
    pub fn of(amplitude: f64) -> Self {
        Self {
            amplitude,
            ..Self::default()
        }
    }

    /// Books the hub at a node.
    pub fn include(&mut self, now: HubSample) {
        self.now = now;
        self.axial_max_m = self.axial_max_m.max(now.axial_m.abs());
        let tilt = f64::hypot(now.tilt_rad[0], now.tilt_rad[1]);
        self.tilt_max_rad = self.tilt_max_rad.max(tilt);
        self.momentum_max_n_s = self.momentum_max_n_s.max(now.momentum_n_s.abs());
    }

    fn record(&self, shared: &Shared, end_s: f64) -> HubRecord {
        let load_kg = shared.free.rotor.as_ref().map_or(0.0, Rotor::load_kg);
        let shock_n_s = self.amplitude * load_kg * shared.free.pulse.integral_s(end_s);
        let impulses = shock_n_s + self.now.bearing_n_s + self.contact_n_s;
        let left = (self.now.momentum_n_s - impulses).abs();
        HubRecord {
            axial_max_m: self.axial_max_m,
            tilt_max_rad: self.tilt_max_rad,
            shock_n_s,
            bearing_n_s: self.now.bearing_n_s,
            contact_n_s: self.contact_n_s,
            momentum_end_n_s: self.now.momentum_n_s,
            momentum_closure: match self.momentum_max_n_s > 0.0 {
                true => left / self.momentum_max_n_s,
                false => 0.0,
            },
        }
    }
}

impl Closing<'_> {
    /// Closes the books; the warnings are those of the model and of deep contacts.
    ///
    /// # Errors
    /// [`StructureError::NotFinite`].
    pub fn run(self) -> Result<StructureRun, StructureError> {
        let step_s = self.shared.free.step_s;
        let end_s = self.k as f64 * step_s;
        let energy = book(&self.energies, &self.ledger);
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
        warnings.extend(StructureRun::penetration_warning(
            self.complementarity.max_penetration_m,
        ));
        let [top, bottom] = self.logs.each_ref().map(|log| log.summary(step_s));
        let mut history = self.history;
        let kinks = self.shared.free.pulse.kinks_s().filter(|&t| t <= end_s);
        history.events_s.extend(kinks);
        history.events_s.sort_by(f64::total_cmp);
        history.events_s.dedup();
        let hub = self.hub.map(|book| book.record(self.shared, end_s));
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
            first_touch_s,
            steps: self.k as u64,
            end_s,
            warnings,
        })
    }
}

/// H at the end against what went in and out.
fn book(energies: &Energies, ledger: &Ledger) -> EnergyBook {
    let h_end = energies.fixed_frame;
    let peak = ledger.peak_fixed_frame;
    let (work, damping) = (ledger.work.value(), ledger.damping.value());
    let exchanged = work - damping - ledger.impact + ledger.algorithmic;
    EnergyBook {
        kinetic_j: energies.kinetic,
        elastic_j: energies.elastic,
        h_end_j: h_end,
        h_peak_j: peak,
        shock_work_j: work,
        damping_loss_j: damping,
        impact_loss_j: ledger.impact,
        algorithmic_j: ledger.algorithmic,
        spindle_work_j: ledger.spindle,
        closure: if peak > 0.0 {
            (h_end - exchanged).abs() / peak
        } else {
            0.0
        },
    }
}
