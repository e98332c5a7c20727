//! How a run ends, whatever carried it: energy book, contacts, history, columns.

use super::contact_log::ContactLog;
use super::energy::{Energies, Ledger};
use super::history::StructuralHistory;
use super::model::{Shared, StructureError, StructureRun};
use super::record::{Complementarity, DiskExtremes, EnergyBook, StructureColumns};

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
    pub logs: &'a [ContactLog; 2],
    pub history: StructuralHistory,
    pub columns: Option<StructureColumns>,
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
        let kinks = self.shared.free.kinks_s().filter(|&t| t <= end_s);
        history.events_s.extend(kinks);
        history.events_s.sort_by(f64::total_cmp);
        history.events_s.dedup();
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
