//! Solves with the matrix of a stage: the suspension's modes are eliminated, which leaves seven unknowns.
//!
//! The derivative of a stage's residual by x is diagonal except for forces at the ports (`ports`),
//!
//! ```text
//! S = diag(m/d², D) + Pᵀ G P,    D = 1/d² + 2 ζ ω/d + ω²,    S δx = b
//! ```
//!
//! with m the slider's inertia and G the stiffness of film, gimbal and closed contacts at the ports, the film by its
//! condensed stiffness. With p = P δx = (q, s) and g = G p = (g_q, g_s) the modes' rows are δη = D⁻¹ (b_η − Rᵀ g_s).
//! Inserting them into s = E q + R δη gives, by the identity of Sherman, Morrison and Woodbury,
//!
//! ```text
//! m/d² q + g_q + Eᵀ g_s = b_q,      s − E q + Y g_s = R D⁻¹ b_η,      Y = R D⁻¹ Rᵀ
//! ```
//!
//! | symbol | what | shape |
//! |---|---|---|
//! | R | rows of the joints over the modes | 4 × modes |
//! | Y | compliance of the suspension at its joints within the stage | 4 × 4 |
//! | g | force at the ports due to the correction δx | 3 + 4 |
//!
//! Y depends on d alone. The seven equations mix metres and radians, so they are solved with row exchanges and every
//! unknown scaled ([`PivotedInverse`]). Digits are lost by the ratio Y k of the joints' stiffness to the suspension's
//! within the stage; up to the longest step, solutions are accurate to 1e-13.
//!
//! Source: W. W. Hager, "Updating the inverse of a matrix", SIAM Review 31 (1989) 221.

use super::mechanics::Mechanics;
use super::ports::{AtPorts, JOINTS, PORTS, SLIDER, along};
use super::stops::Closed;
use crate::lanes::{Kernel, abreast, widest};
use crate::linalg::pivoted::PivotedInverse;

/// The matrix of a stage, ready to solve with; storage allocated once.
#[derive(Clone, Debug)]
pub(super) struct StageMatrix {
    /// d for which the following is valid; `None`: for none.
    d_s: Option<f64>,
    /// D⁻¹.
    flexibility: Vec<f64>,
    /// R D⁻¹, row by row.
    weighted: [Vec<f64>; JOINTS],
    /// Y.
    compliance: [[f64; JOINTS]; JOINTS],
    /// G.
    coupling: [AtPorts; PORTS],
    inverse: PivotedInverse,
}

impl StageMatrix {
    /// Storage for a suspension of `n_modes` modes.
    pub fn new(n_modes: usize) -> Self {
        Self {
            d_s: None,
            flexibility: vec![0.0; n_modes],
            weighted: [0; JOINTS].map(|_| vec![0.0; n_modes]),
            compliance: [[0.0; JOINTS]; JOINTS],
            coupling: [[0.0; PORTS]; PORTS],
            inverse: PivotedInverse::new(PORTS),
        }
    }

    /// Discards everything: the next [`StageMatrix::prepare`] may be of another head.
    pub fn forget(&mut self) {
        self.d_s = None;
    }

    /// Sets S up for `d_s`, the closed contacts and the film's condensed stiffness (force taken from the
    /// slider per motion of it), zero without film. False when it is singular or not finite.
    pub fn prepare(
        &mut self,
        mechanics: &Mechanics,
        d_s: f64,
        closed: Closed,
        film: &[[f64; 3]; 3],
    ) -> bool {
        if self.d_s != Some(d_s) {
            self.eliminate(mechanics, d_s);
        }
        self.coupling = mechanics.coupling(d_s, closed);
        for (row, film) in self.coupling.iter_mut().zip(film) {
            for (g, film) in row.iter_mut().zip(film) {
                *g += film;
            }
        }
        let (on_slider, on_joints) = self.coupling.split_at(SLIDER);
        let (top, bottom) = self.inverse.matrix_mut().split_at_mut(SLIDER * PORTS);
        for (i, row) in top.chunks_exact_mut(PORTS).enumerate() {
            for (j, out) in row.iter_mut().enumerate() {
                *out = on_slider[i][j] + on_joints[i][j];
            }
            row[i] += mechanics.slider_inertia()[i] / (d_s * d_s);
        }
        for (k, row) in bottom.chunks_exact_mut(PORTS).enumerate() {
            for (j, out) in row.iter_mut().enumerate() {
                let parts = self.compliance[k].iter().zip(on_joints);
                *out = parts.map(|(y, g)| y * g[j]).sum();
            }
            row[SLIDER + k] += 1.0;
            if k < SLIDER {
                row[k] -= 1.0;
            }
        }
        self.inverse.invert()
    }

    /// D⁻¹, R D⁻¹ and Y of `d_s`.
    fn eliminate(&mut self, mechanics: &Mechanics, d_s: f64) {
        mechanics.modal_flexibility(d_s, &mut self.flexibility);
        let rows = mechanics.ports().rows();
        for (weighted, row) in self.weighted.iter_mut().zip(rows) {
            for ((weighted, r), f) in weighted.iter_mut().zip(row).zip(&self.flexibility) {
                *weighted = r * f;
            }
        }
        for (weighted, y) in self.weighted.iter().zip(&mut self.compliance) {
            *y = abreast(rows.map(|row| [row, weighted]));
        }
        self.d_s = Some(d_s);
    }

    /// Solves S δx = b in place with what [`StageMatrix::prepare`] set up last; false when the solution is
    /// not finite.
    pub fn solve(&mut self, b: &mut [f64]) -> bool {
        let (q, modes) = b.split_at_mut(SLIDER);
        let [w0, w1, w2, w3] = &self.weighted;
        let weighted: [&[f64]; JOINTS] = [w0, w1, w2, w3];
        let read = abreast(weighted.map(|row| [row, &*modes]));
        let mut p: AtPorts = [0.0; PORTS];
        p[..SLIDER].copy_from_slice(q);
        p[SLIDER..].copy_from_slice(&read);
        if !self.inverse.solve(&mut p) {
            return false;
        }
        q.copy_from_slice(&p[..SLIDER]);
        let force = std::array::from_fn(|k| along(&self.coupling[SLIDER + k], &p));
        widest(Spread {
            out: modes,
            flexibility: &self.flexibility,
            weighted,
            force,
        });
        b.iter().all(|x| x.is_finite())
    }
}

/// `out` := D⁻¹ (`out` − Rᵀ g).
struct Spread<'a> {
    out: &'a mut [f64],
    flexibility: &'a [f64],
    weighted: [&'a [f64]; JOINTS],
    force: [f64; JOINTS],
}

impl Kernel for Spread<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let n = self.out.len();
        let (out, flexibility) = (&mut self.out[..n], &self.flexibility[..n]);
        let [a, b, c, d] = self.weighted.map(|row| &row[..n]);
        let [fa, fb, fc, fd] = self.force;
        for k in 0..n {
            let push = fd.mul_add(d[k], fc.mul_add(c[k], fb.mul_add(b[k], fa * a[k])));
            out[k] = flexibility[k].mul_add(out[k], -push);
        }
    }
}

#[cfg(test)]
mod dense;
#[cfg(test)]
mod tests;
