//! The suspension's natural modes as oscillators of unit mass, and the loops over them within a stage.
//!
//! ```text
//! η'' + 2 ζ ω η' + ω² η = f a(t) + Rᵀ F
//! ```
//!
//! F: forces at the joints, R: their rows (`ports`), f: load per inertia load.

use super::ports::JOINTS;
use crate::lanes::{Kernel, widest};
use crate::suspension::ReducedSuspension;

/// The modes of bending, then those of torsion.
#[derive(Clone, Debug)]
pub(super) struct Oscillators {
    /// ω², 1/s2.
    pub stiffness: Vec<f64>,
    /// 2 ζ ω, 1/s.
    pub damping: Vec<f64>,
    /// f, √kg.
    pub load: Vec<f64>,
}

/// Motion of the modes in a stage with v = (x − x_known)/d.
pub(super) struct ModalMotion<'a> {
    /// 1/d, 1/s.
    pub per_d: f64,
    /// Inertia load per mass, m/s2.
    pub a: f64,
    pub x: &'a [f64],
    pub v: &'a [f64],
    pub v_known: &'a [f64],
}

impl Oscillators {
    /// The natural modes of a reduced suspension.
    pub fn new(suspension: &ReducedSuspension) -> Self {
        let mut out = Self {
            stiffness: Vec::new(),
            damping: Vec::new(),
            load: Vec::new(),
        };
        for set in [&suspension.bending, &suspension.torsion] {
            out.stiffness
                .extend(set.natural_rad_per_s.iter().map(|omega| omega * omega));
            out.damping.extend(set.decay_per_s.iter());
            out.load
                .extend(set.in_natural_modes(&set.inertia_load).iter());
        }
        out
    }

    /// Number of modes.
    pub fn len(&self) -> usize {
        self.stiffness.len()
    }

    /// `out` := f a + Rᵀ F − (v − v_known)/d − 2 ζ ω v − ω² x with `rows` R and `force` F.
    pub fn imbalance(
        &self,
        motion: &ModalMotion<'_>,
        rows: [&[f64]; JOINTS],
        force: [f64; JOINTS],
        out: &mut [f64],
    ) {
        widest(Imbalance {
            modes: self,
            motion,
            rows,
            force,
            out,
        });
    }

    /// `out` := (e_v + e_x/d + 2 ζ ω e_x)/d + Rᵀ F.
    pub fn filter_load(
        &self,
        per_d: f64,
        [e_x, e_v]: [&[f64]; 2],
        rows: [&[f64]; JOINTS],
        force: [f64; JOINTS],
        out: &mut [f64],
    ) {
        widest(FilterLoad {
            damping: &self.damping,
            per_d,
            e_x,
            e_v,
            rows,
            force,
            out,
        });
    }

    /// `out` := 1/(1/d² + 2 ζ ω/d + ω²), the flexibility of a mode within a stage.
    pub fn flexibility(&self, d_s: f64, out: &mut [f64]) {
        let (per_d, per_d2) = (1.0 / d_s, 1.0 / (d_s * d_s));
        for ((out, c), k) in out.iter_mut().zip(&self.damping).zip(&self.stiffness) {
            *out = 1.0 / (per_d2 + c * per_d + k);
        }
    }
}

struct Imbalance<'a> {
    modes: &'a Oscillators,
    motion: &'a ModalMotion<'a>,
    rows: [&'a [f64]; JOINTS],
    force: [f64; JOINTS],
    out: &'a mut [f64],
}

impl Kernel for Imbalance<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let n = self.out.len();
        let (out, modes, motion) = (&mut self.out[..n], self.modes, self.motion);
        let (load, damping) = (&modes.load[..n], &modes.damping[..n]);
        let stiffness = &modes.stiffness[..n];
        let (x, v, known) = (&motion.x[..n], &motion.v[..n], &motion.v_known[..n]);
        let [w, s, t, e] = [0, 1, 2, 3].map(|i| &self.rows[i][..n]);
        let [fw, fs, ft, fe] = self.force;
        let (per_d, a) = (motion.per_d, motion.a);
        for k in 0..n {
            let inner = (known[k] - v[k]) * per_d;
            let inner = (-stiffness[k]).mul_add(x[k], (-damping[k]).mul_add(v[k], inner));
            let push = ft.mul_add(t[k], fs.mul_add(s[k], fw * w[k]));
            let push = load[k].mul_add(a, fe.mul_add(e[k], push));
            out[k] = inner + push;
        }
    }
}

struct FilterLoad<'a> {
    damping: &'a [f64],
    per_d: f64,
    e_x: &'a [f64],
    e_v: &'a [f64],
    rows: [&'a [f64]; JOINTS],
    force: [f64; JOINTS],
    out: &'a mut [f64],
}

impl Kernel for FilterLoad<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let n = self.out.len();
        let (out, damping) = (&mut self.out[..n], &self.damping[..n]);
        let (e_x, e_v) = (&self.e_x[..n], &self.e_v[..n]);
        let [w, s, t, e] = [0, 1, 2, 3].map(|i| &self.rows[i][..n]);
        let [fw, fs, ft, fe] = self.force;
        let per_d = self.per_d;
        for k in 0..n {
            let rate = (per_d + damping[k]).mul_add(e_x[k], e_v[k]);
            let push = ft.mul_add(t[k], fs.mul_add(s[k], fw * w[k]));
            out[k] = rate.mul_add(per_d, fe.mul_add(e[k], push));
        }
    }
}
