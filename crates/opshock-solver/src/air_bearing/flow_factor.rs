//! Flow factor of rarefied Poiseuille flow between parallel walls, tabulated as a function of ψ = p h.
//!
//! ```text
//! mass flux per width = −(Q p h³ / 12 μ) ∂p/∂x,    Kn = λ_a p_a/(p h) = λ_a p_a/ψ
//! ```
//!
//! | model         | Q                                              |
//! |---------------|------------------------------------------------|
//! | continuum     | 1                                              |
//! | slip, order 1 | 1 + 6 Kn (Burgdorfer 1959)                     |
//! | slip, order 2 | 1 + 6 Kn + 6 Kn² (Hsia and Domoto 1983)        |
//! | Fukui-Kaneko  | 6 Q_P(D)/D with D = √π/(2 Kn)                  |
//!
//! Q_P is the three-range fit of Fukui and Kaneko (1990, ASME J. Tribology 112, 78-83) to the
//! linearised Boltzmann (BGK) equation. The ranges meet at D = 0.15 and D = 5 with jumps of 0.27 %
//! and 0.14 %; here neighbouring ranges are blended by a quintic step in ln D, so Q has two
//! continuous derivatives and Newton's method cannot cycle between two branches. Below D = 0.01
//! the fit leaves its range (it turns negative at D ≈ 0.003); there the free-molecular asymptote
//! Q_P = −ln(D)/√π + c₀ + c₁ D ln D (leading terms after Cercignani and Daneri 1963) takes over, with
//! c₀ and c₁ from a BGK solution of our own at D = 0.01 and 0.02 (`fukui_kaneko_check.json`).
//!
//! Q depends on ψ alone, so the film needs one number per cell, G = Q ψ. It is tabulated: every binade of ψ is cut into
//! equal intervals, and the interval follows from the bits of ψ without a logarithm. In an interval G is the cubic
//! Hermite interpolant of G and G′.

use crate::elementary::polynomial;

use std::f64::consts::PI;

/// Rarefaction model of the flow factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub enum FlowModel {
    /// Continuum.
    Continuum,
    /// First-order slip (Burgdorfer).
    Slip1,
    /// Second-order slip (Hsia and Domoto).
    Slip2,
    /// Fukui-Kaneko, three-range fit with blended branches.
    FukuiKaneko,
}

/// c₀ and c₁ of the near-free-molecular expansion of Q_P.
const FREE_MOLECULAR: [f64; 2] = [0.376_261, -1.632_81];

/// Intervals a binade of ψ is cut into, as a power of two.
const INTERVAL_BITS: u32 = 7;

/// Range of the table in ψ/(λ_a p_a). At the lower end, walls are 1e-6 mean free paths apart; at the upper end, Q − 1
/// is 6e-6. Outside, the model itself is evaluated.
const TABLE_RANGE: [f64; 2] = [9.5367431640625e-7, 1_048_576.0];

/// G = Q ψ against ψ, with derivative.
#[derive(Clone, Debug)]
pub struct FlowFactor {
    model: FlowModel,
    /// λ_a p_a, Pa m.
    knudsen_psi: f64,
    /// 1/(λ_a p_a).
    inverse_knudsen_psi: f64,
    /// Per interval of ψ/(λ_a p_a): G/(λ_a p_a) = c0 + c1 t + c2 t² + c3 t³, t from 0 to 1. Empty for
    /// models that are a polynomial anyway.
    table: Vec<[f64; 4]>,
    /// Interval index of the start of the table.
    first_interval: u64,
}

/// Rows of the table for many ψ; scratch of [`FlowFactor::conductances`].
#[derive(Clone, Debug)]
pub struct PickedRows {
    index: Vec<u64>,
    row: Vec<[f64; 4]>,
}

impl PickedRows {
    /// For `n` ψ.
    pub fn new(n: usize) -> Self {
        Self {
            index: vec![0; n],
            row: vec![[0.0; 4]; n],
        }
    }
}

impl FlowFactor {
    /// Tabulates `model` for a gas with λ_a p_a = `knudsen_psi` (Pa m).
    pub fn new(model: FlowModel, knudsen_psi: f64) -> Self {
        let first_interval = interval(TABLE_RANGE[0]);
        let n = if model == FlowModel::FukuiKaneko {
            interval(TABLE_RANGE[1]) - first_interval
        } else {
            0
        };
        let table = (0..n)
            .map(|k| {
                let (a, b) = (start(first_interval + k), start(first_interval + k + 1));
                let width = b - a;
                let (left, right) = (fukui_kaneko(a), fukui_kaneko(b));
                let (d0, d1) = (left.1 * width, right.1 * width);
                let rise = right.0 - left.0;
                [left.0, d0, 3.0 * rise - 2.0 * d0 - d1, d0 + d1 - 2.0 * rise]
            })
            .collect();
        Self {
            model,
            knudsen_psi,
            inverse_knudsen_psi: 1.0 / knudsen_psi,
            table,
            first_interval,
        }
    }

    /// The model.
    pub fn model(&self) -> FlowModel {
        self.model
    }

    /// Whether G is proportional to ψ: without slip.
    pub(super) fn is_proportional(&self) -> bool {
        self.model == FlowModel::Continuum
    }

    /// G of a half cell with ψ = `psi` at its centre, where it has `at_centre` with its derivative, and ψ `across` the
    /// face; its derivatives by both ([`super::flux`]).
    #[inline(always)]
    pub(super) fn of_half_cell(&self, psi: f64, at_centre: (f64, f64), across: f64) -> [f64; 3] {
        if self.is_proportional() {
            return [0.5 * (psi + across), 0.5, 0.5];
        }
        let (g, slope) = at_centre;
        let beyond = (across - psi) - g;
        let share = if beyond > 0.0 { 0.5 } else { 0.0 };
        [g + share * beyond, slope - share * (slope + 1.0), share]
    }

    /// G and dG/dψ of many ψ > 0 (Pa m), bit for bit as from [`FlowFactor::conductance`]. Whole registers hold all that
    /// needs no table; table rows are picked in between.
    ///
    /// # Panics
    ///
    /// When slices differ in length or `rows` is for fewer.
    #[inline(always)]
    pub fn conductances(
        &self,
        psi: &[f64],
        g: &mut [f64],
        slope: &mut [f64],
        rows: &mut PickedRows,
    ) {
        assert!(g.len() == psi.len() && slope.len() == psi.len());
        let mut all_inside = !self.table.is_empty();
        if all_inside {
            let PickedRows { index, row } = rows;
            let (index, row) = (&mut index[..psi.len()], &mut row[..psi.len()]);
            for (index, psi) in index.iter_mut().zip(psi) {
                let s = psi * self.inverse_knudsen_psi;
                *index = interval(s).wrapping_sub(self.first_interval);
            }
            for (row, index) in row.iter_mut().zip(&*index) {
                match self.table.get(*index as usize) {
                    Some(found) => *row = *found,
                    None => all_inside = false,
                }
            }
            for (((psi, row), g), slope) in psi.iter().zip(row).zip(&mut *g).zip(&mut *slope) {
                (*g, *slope) = hermite(*row, psi * self.inverse_knudsen_psi);
                *g *= self.knudsen_psi;
            }
        }
        if !all_inside {
            for ((psi, g), slope) in psi.iter().zip(g).zip(slope) {
                (*g, *slope) = self.conductance(*psi);
            }
        }
    }

    /// G and dG/dψ at ψ > 0 (Pa m).
    #[inline(always)]
    pub fn conductance(&self, psi: f64) -> (f64, f64) {
        let l = self.knudsen_psi;
        match self.model {
            FlowModel::Continuum => (psi, 1.0),
            FlowModel::Slip1 => (psi + 6.0 * l, 1.0),
            FlowModel::Slip2 => {
                let kn = l / psi;
                (psi + 6.0 * l * (1.0 + kn), 1.0 - 6.0 * kn * kn)
            }
            FlowModel::FukuiKaneko => {
                let s = psi * self.inverse_knudsen_psi;
                let index = interval(s).wrapping_sub(self.first_interval) as usize;
                let (g, slope) = match self.table.get(index) {
                    Some(row) => hermite(*row, s),
                    None => outside(s),
                };
                (g * l, slope)
            }
        }
    }
}

/// The model itself, for values that are rare or only tabulated.
#[cold]
#[inline(never)]
fn outside(s: f64) -> (f64, f64) {
    fukui_kaneko(s)
}

/// Number of the interval that holds `s` > 0, counted from s = 0.
#[inline]
fn interval(s: f64) -> u64 {
    s.to_bits() >> (52 - INTERVAL_BITS)
}

/// Where interval `k` starts.
#[inline]
fn start(k: u64) -> f64 {
    f64::from_bits(k << (52 - INTERVAL_BITS))
}

/// The cubic of the interval that holds `s`, and its derivative by s. t and dt/ds follow from the bits of s.
#[inline(always)]
fn hermite([c0, c1, c2, c3]: [f64; 4], s: f64) -> (f64, f64) {
    const MANTISSA: u64 = (1 << 52) - 1;
    let bits = s.to_bits();
    let t = f64::from_bits(((bits << INTERVAL_BITS) & MANTISSA) | 1.0_f64.to_bits()) - 1.0;
    // An interval of the binade at 2ᵉ is 2^(e − INTERVAL_BITS) wide.
    let scale = f64::from_bits((2 * 1023 + u64::from(INTERVAL_BITS) - (bits >> 52)) << 52);
    (
        polynomial(t, [c0, c1, c2, c3]),
        polynomial(t, [c1, 2.0 * c2, 3.0 * c3]) * scale,
    )
}

/// G/(λ_a p_a) = 6 Q_P s/D and its derivative by s = ψ/(λ_a p_a); D = s √π/2.
fn fukui_kaneko(s: f64) -> (f64, f64) {
    let per_d = 2.0 / PI.sqrt();
    let (rate, slope) = fukui_kaneko_rate(s / per_d);
    (6.0 * per_d * rate, 6.0 * per_d * slope / s)
}

/// Poiseuille flow rate Q_P of the blended Fukui-Kaneko fit and its derivative by ln D.
fn fukui_kaneko_rate(d: f64) -> (f64, f64) {
    let (inverse, square) = (1.0 / d, 1.0 / (d * d));
    let [c0, c1] = FREE_MOLECULAR;
    let log = d.ln();
    let free = (
        c0 + c1 * d * log - log / PI.sqrt(),
        c1 * d * (log + 1.0) - 1.0 / PI.sqrt(),
    );
    let low = (
        -2.22919 * d + 2.10673 + 0.01653 * inverse - 0.000_069_4 * square,
        -2.22919 * d - 0.01653 * inverse + 2.0 * 0.000_069_4 * square,
    );
    let middle = (
        0.13852 * d + 1.25087 + 0.15653 * inverse - 0.00969 * square,
        0.13852 * d - 0.15653 * inverse + 2.0 * 0.00969 * square,
    );
    let high = (
        d / 6.0 + 1.0162 + 1.0653 * inverse - 2.1354 * square,
        d / 6.0 - 1.0653 * inverse + 2.0 * 2.1354 * square,
    );
    let mut rate = free;
    // The fit's own range ends; widths keep either branch within 0.8 % of the BGK solution.
    for (branch, centre, half_width) in
        [(low, 0.0118, 0.15), (middle, 0.15, 0.10), (high, 5.0, 0.15)]
    {
        rate = blend(rate, branch, (d / centre).ln() / half_width, half_width);
    }
    rate
}

/// Quintic step over ln D from `a` to `b`, both with derivative by ln D, where `t` = −1 ... 1 runs
/// over 2 `half_width` of ln D.
fn blend(a: (f64, f64), b: (f64, f64), t: f64, half_width: f64) -> (f64, f64) {
    if t <= -1.0 {
        return a;
    }
    if t >= 1.0 {
        return b;
    }
    let s = 0.5 * (t + 1.0);
    let weight = s * s * s * (10.0 + s * (6.0 * s - 15.0));
    let weight_slope = 30.0 * s * s * (1.0 - s) * (1.0 - s) / (2.0 * half_width);
    (
        a.0 + weight * (b.0 - a.0),
        a.1 + weight * (b.1 - a.1) + weight_slope * (b.0 - a.0),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNUDSEN_PSI: f64 = 6.4e-3;

    #[test]
    fn table_follows_the_model_to_1e_7_and_its_slope_to_1e_4() {
        let factor = FlowFactor::new(FlowModel::FukuiKaneko, KNUDSEN_PSI);
        let mut s: f64 = 1e-7;
        while s < 1e7 {
            let (g, slope) = factor.conductance(s * KNUDSEN_PSI);
            let (g_exact, slope_exact) = fukui_kaneko(s);
            assert!((g / (g_exact * KNUDSEN_PSI) - 1.0).abs() < 1e-7, "s {s}");
            let scale = g_exact / s;
            assert!(
                (slope - slope_exact).abs() < 1e-4 * scale,
                "s {s}: {slope} {slope_exact}"
            );
            s *= 1.0037;
        }
    }

    #[test]
    fn many_at_once_have_the_bits_of_one_alone() {
        for model in [FlowModel::Slip2, FlowModel::FukuiKaneko] {
            let factor = FlowFactor::new(model, KNUDSEN_PSI);
            // Not a multiple of eight; once all of them in the table, once some outside on either side.
            for (start, most) in [(1e-5, 2e5), (1e-7, 1e8)] {
                let psi: Vec<f64> = (0..555)
                    .map(|k| KNUDSEN_PSI * start * (0.07 * k as f64).exp().min(most / start))
                    .collect();
                let (mut g, mut slope) = (vec![0.0; psi.len()], vec![0.0; psi.len()]);
                let mut rows = PickedRows::new(psi.len());
                factor.conductances(&psi, &mut g, &mut slope, &mut rows);
                for ((psi, g), slope) in psi.iter().zip(&g).zip(&slope) {
                    assert_eq!((*g, *slope), factor.conductance(*psi), "{psi}");
                }
            }
        }
    }

    #[test]
    fn slope_is_the_derivative_for_every_model() {
        for model in [
            FlowModel::Continuum,
            FlowModel::Slip1,
            FlowModel::Slip2,
            FlowModel::FukuiKaneko,
        ] {
            let factor = FlowFactor::new(model, KNUDSEN_PSI);
            let mut psi = 1e-6;
            while psi < 10.0 {
                let step = 1e-6 * psi;
                let (_, slope) = factor.conductance(psi);
                let numeric = (factor.conductance(psi + step).0 - factor.conductance(psi - step).0)
                    / (2.0 * step);
                let scale = factor.conductance(psi).0 / psi;
                assert!((slope - numeric).abs() < 2e-8 * scale, "{model:?} {psi}");
                psi *= 1.09;
            }
        }
    }

    #[test]
    fn value_and_slope_are_continuous_where_branches_meet() {
        for d in [0.01, 0.15, 5.0] {
            for edge in [0.9_f64, 0.86, 1.0, 1.105, 1.16] {
                let d = d * edge;
                let (a, b) = (
                    fukui_kaneko_rate(d * (1.0 - 1e-9)),
                    fukui_kaneko_rate(d * (1.0 + 1e-9)),
                );
                assert!((a.0 - b.0).abs() < 1e-8 * a.0);
                assert!((a.1 - b.1).abs() < 1e-6 * a.0);
            }
        }
    }

    /// Why the film's fluxes are monotone ([`super::super::flux`]).
    #[test]
    fn conductance_rises_by_less_than_psi_and_falls_by_less_than_its_inverse() {
        for model in [FlowModel::Slip1, FlowModel::Slip2, FlowModel::FukuiKaneko] {
            let factor = FlowFactor::new(model, KNUDSEN_PSI);
            let mut psi = 1e-6 * KNUDSEN_PSI;
            while psi < 1e6 * KNUDSEN_PSI {
                let (g, slope) = factor.conductance(psi);
                assert!(slope < 1.0 + 1e-9, "{model:?} {psi}: {slope}");
                assert!(slope > -g / psi, "{model:?} {psi}: {slope}");
                psi *= 1.013;
            }
        }
    }

    #[test]
    fn walls_a_millionth_of_a_path_apart_keep_a_finite_positive_conductance() {
        for model in [FlowModel::Slip1, FlowModel::FukuiKaneko] {
            let (g, slope) = FlowFactor::new(model, KNUDSEN_PSI).conductance(1e-20);
            assert!(g.is_finite() && g > 0.0 && slope.is_finite());
        }
    }
}
