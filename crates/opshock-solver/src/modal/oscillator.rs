//! One damped oscillator of unit mass in a frame that may rotate, with its exact flow, energies and losses.
//!
//! ```text
//! p̈ + (2γ + c) ṗ + (ω² − i c N) p = 0       rotating frame
//! q = p e^{−iNt},   r = q̇                   fixed frame, the state used here
//! s = r + i N q = ṗ e^{−iNt}                velocity of the material
//! ```
//!
//! | symbol | name here              | unit  |
//! |--------|------------------------|-------|
//! | ω      | `omega_rad_per_s`      | rad/s |
//! | γ      | `half_damping_per_s`   | 1/s   |
//! | N      | `turn_rad_per_s`       | rad/s |
//! | c      | `fixed_damping_per_s`  | 1/s   |
//!
//! With η = γ + c/2, κ = ω² − icN, δ² = η² − κ the flow over h is
//!
//! ```text
//! C = e^{−ηh} cosh δh,   S = e^{−ηh} sinh(δh)/δ
//! p(h) = (C + ηS) p + S ṗ,   ṗ(h) = −κ S p + (C − ηS) ṗ
//! ```
//!
//! valid for any damping and for ω = 0. N = 0, c = 0 is an ordinary real oscillator.
//!
//! Energies of the mode: of the material E = ½(|s|² + ω²|q|²); in the fixed frame
//! H = ½(|r|² + (ω² − N²)|q|²). Damping takes from H the power 2γ Re(s r*) + c |r|².

use nalgebra::Complex;

/// A damped oscillator of unit mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Oscillator {
    /// Undamped angular frequency, rad/s.
    pub omega_rad_per_s: f64,
    /// γ = ζ ω, damping that rotates with the frame, 1/s.
    pub half_damping_per_s: f64,
    /// N, rate at which the frame rotates the mode, rad/s.
    pub turn_rad_per_s: f64,
    /// c, damping fixed in space, 1/s.
    pub fixed_damping_per_s: f64,
}

/// Transition of (q, r) over a time, minus the identity: q' = q + (qq q + qr r), r' = r + (rq q + rr r).
///
/// A short step's matrix is close to the identity; rounding its diagonal near 1 once would show
/// as a drift of 1e-10 of the energy per million steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flow {
    /// q from q, less 1.
    pub qq: Complex<f64>,
    /// q from r, s.
    pub qr: Complex<f64>,
    /// r from q, 1/s.
    pub rq: Complex<f64>,
    /// r from r, less 1.
    pub rr: Complex<f64>,
}

/// Energy taken from H by damping over a time, as a quadratic form of the state at its start:
/// `qq |q|² + rr |r|² + 2 re(qr q* r)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LossForm {
    /// Weight of |q|², 1/s².
    pub qq: f64,
    /// Weight of |r|².
    pub rr: f64,
    /// Weight of q* r, 1/s.
    pub qr: Complex<f64>,
}

impl Oscillator {
    /// An oscillator in a frame at rest.
    pub fn fixed(omega_rad_per_s: f64, damping_ratio: f64) -> Self {
        Self {
            omega_rad_per_s,
            half_damping_per_s: damping_ratio * omega_rad_per_s,
            turn_rad_per_s: 0.0,
            fixed_damping_per_s: 0.0,
        }
    }

    fn eta(&self) -> f64 {
        self.half_damping_per_s + 0.5 * self.fixed_damping_per_s
    }

    fn kappa(&self) -> Complex<f64> {
        Complex::new(
            self.omega_rad_per_s * self.omega_rad_per_s,
            -self.fixed_damping_per_s * self.turn_rad_per_s,
        )
    }

    /// Roots of the rotating-frame equation, 1/s.
    pub fn roots(&self) -> [Complex<f64>; 2] {
        let eta = self.eta();
        let delta = (Complex::from(eta * eta) - self.kappa()).sqrt();
        [delta - eta, -delta - eta]
    }

    /// (C − 1, S) of the module's formulas.
    fn cosine_sine(&self, h_s: f64) -> (Complex<f64>, Complex<f64>) {
        let eta = self.eta();
        if self.fixed_damping_per_s == 0.0 && self.omega_rad_per_s > eta {
            let damped = ((self.omega_rad_per_s - eta) * (self.omega_rad_per_s + eta)).sqrt();
            let (half_sine, half_cosine) = (0.5 * damped * h_s).sin_cos();
            let cosine_less_1 = -2.0 * half_sine * half_sine;
            let decay_less_1 = (-eta * h_s).exp_m1();
            return (
                Complex::from(decay_less_1 * (1.0 + cosine_less_1) + cosine_less_1),
                Complex::from((1.0 + decay_less_1) * 2.0 * half_sine * half_cosine / damped),
            );
        }
        let delta = (Complex::from(eta * eta) - self.kappa()).sqrt();
        let z = delta * h_s;
        if z.norm_sqr() < 1e-2 {
            // Series to z¹⁰: below 1e-20 for |z| < 0.1.
            let z2 = z * z;
            let one = Complex::from(1.0);
            let cosh_less_1 = z2 / 2.0
                * (one + z2 / 12.0 * (one + z2 / 30.0 * (one + z2 / 56.0 * (one + z2 / 90.0))));
            let sinhc = one
                + z2 / 6.0
                    * (one
                        + z2 / 20.0 * (one + z2 / 42.0 * (one + z2 / 72.0 * (one + z2 / 110.0))));
            let decay_less_1 = (-eta * h_s).exp_m1();
            let decay = 1.0 + decay_less_1;
            return (cosh_less_1 * decay + decay_less_1, sinhc * (decay * h_s));
        }
        let (grow, fade) = (((delta - eta) * h_s).exp(), ((-delta - eta) * h_s).exp());
        ((grow + fade) * 0.5 - 1.0, (grow - fade) / (delta * 2.0))
    }

    /// Exact flow over `h_s`.
    pub fn flow(&self, h_s: f64) -> Flow {
        let (c, s) = self.cosine_sine(h_s);
        let eta = self.eta();
        // (p, ṗ), diagonals less 1.
        let (pp, pv) = (c + s * eta, s);
        let (vp, vv) = (-self.kappa() * s, c - s * eta);
        if self.turn_rad_per_s == 0.0 {
            return Flow {
                qq: pp,
                qr: pv,
                rq: vp,
                rr: vv,
            };
        }
        let turn = Complex::new(0.0, self.turn_rad_per_s);
        let (half_sine, half_cosine) = (0.5 * self.turn_rad_per_s * h_s).sin_cos();
        let rotation_less_1 =
            Complex::new(-2.0 * half_sine * half_sine, -2.0 * half_sine * half_cosine);
        let rotation = rotation_less_1 + 1.0;
        // (q, s) → (q, r) with s = r + iN q on both sides; sq here is s from q less iN.
        let qq = rotation_less_1 + rotation * (pp + pv * turn);
        let qr = rotation * pv;
        let sq = rotation_less_1 * turn + rotation * (vp + vv * turn);
        Flow {
            qq,
            qr,
            rq: sq - turn * qq,
            rr: rotation_less_1 + rotation * vv - turn * qr,
        }
    }

    /// Energy per squared impulse that damping takes in one step of `h_s` from the ripple of equal
    /// impulses, one per step (unit mass, unit shape): (2γ + c) ∫ ṙ² over the periodic motion less
    /// its mean, for ω h < π.
    pub fn ripple_loss(&self, h_s: f64) -> f64 {
        let angle = (self.omega_rad_per_s * h_s).min(std::f64::consts::PI);
        let integral = if angle < 1e-2 {
            h_s / 12.0 * (1.0 + angle * angle / 30.0)
        } else {
            h_s / 8.0 * (1.0 - angle.sin() / angle) / (0.5 * angle).sin().powi(2)
        };
        2.0 * self.eta() * integral
    }

    /// Displacement at the instants of equal impulses, one per step of `h_s`, divided by that under a constant force of
    /// the same sum: (ωh/2) cot(ωh/2) without damping, below 1. Without rotation.
    pub fn train_share(&self, h_s: f64) -> f64 {
        // The periodic motion: over a step q returns to itself, and r to its value less the impulse of 1.
        let flow = self.flow(h_s);
        let (qq, qr, rq, rr) = (flow.qq.re, flow.qr.re, flow.rq.re, flow.rr.re);
        self.omega_rad_per_s * self.omega_rad_per_s * h_s * qr / (qq * rr - qr * rq)
    }

    /// Energy of the material, J for unit mass and q in m kg^½.
    pub fn material_energy(&self, q: Complex<f64>, r: Complex<f64>) -> f64 {
        let s = r + Complex::new(0.0, self.turn_rad_per_s) * q;
        0.5 * (s.norm_sqr() + self.omega_rad_per_s * self.omega_rad_per_s * q.norm_sqr())
    }

    /// H, the energy on which a space-fixed point does work.
    pub fn fixed_frame_energy(&self, q: Complex<f64>, r: Complex<f64>) -> f64 {
        0.5 * (r.norm_sqr() + self.fixed_frame_stiffness() * q.norm_sqr())
    }

    /// ω² − N², 1/s².
    pub fn fixed_frame_stiffness(&self) -> f64 {
        (self.omega_rad_per_s - self.turn_rad_per_s) * (self.omega_rad_per_s + self.turn_rad_per_s)
    }

    /// Loss of H over `h_s` of free motion, from the roots of the motion and not from energies.
    pub fn loss_form(&self, h_s: f64) -> LossForm {
        let (gamma, fixed) = (self.half_damping_per_s, self.fixed_damping_per_s);
        if (gamma == 0.0 && fixed == 0.0) || h_s == 0.0 {
            return LossForm::default();
        }
        let mu = self.roots();
        let spread = mu[0] - mu[1];
        if (mu[0].norm().max(mu[1].norm()) * h_s < 0.5) || spread.norm_sqr() * h_s * h_s < 1e-4 {
            return self.loss_form_by_quadrature(h_s);
        }
        // p = Σ aᵢ e^{μᵢ t}; loss rate = Σᵢⱼ aᵢ aⱼ* bᵢⱼ e^{(μᵢ+μⱼ*) t}, b from s and r amplitudes.
        let turn = Complex::new(0.0, self.turn_rad_per_s);
        let mut m = [[Complex::from(0.0); 2]; 2];
        for i in 0..2 {
            for j in 0..2 {
                let (si, sj) = (mu[i], mu[j]);
                let (ri, rj) = (mu[i] - turn, mu[j] - turn);
                let rate = (si * rj.conj() + ri * sj.conj()) * gamma + ri * rj.conj() * fixed;
                m[i][j] = rate * h_s * phi1((mu[i] + mu[j].conj()) * h_s);
            }
        }
        // a from (q, r): a₀ = (s − μ₁ q)/spread, a₁ = (μ₀ q − s)/spread, s = r + iN q.
        let from_q = [(turn - mu[1]) / spread, (mu[0] - turn) / spread];
        let from_r = [spread.inv(), -spread.inv()];
        let mut form = LossForm::default();
        for i in 0..2 {
            for j in 0..2 {
                form.qq += (from_q[i] * from_q[j].conj() * m[i][j]).re;
                form.rr += (from_r[i] * from_r[j].conj() * m[i][j]).re;
                form.qr += from_r[i] * from_q[j].conj() * m[i][j];
            }
        }
        form
    }

    /// The same by Gauss quadrature, for short times and near critical damping where the
    /// closed form cancels.
    fn loss_form_by_quadrature(&self, h_s: f64) -> LossForm {
        let turn = Complex::new(0.0, self.turn_rad_per_s);
        let fastest = self.omega_rad_per_s + self.turn_rad_per_s.abs() + 2.0 * self.eta();
        let n_panels = (fastest * h_s).ceil().clamp(1.0, 1e4) as usize;
        let panel = h_s / n_panels as f64;
        let mut form = LossForm::default();
        for k in 0..n_panels {
            for (x, weight) in GAUSS_8 {
                let f = self.flow((k as f64 + x) * panel);
                let (f_qq, f_rr) = (f.qq + 1.0, f.rr + 1.0);
                let (s_q, s_r) = (f.rq + turn * f_qq, f_rr + turn * f.qr);
                let w = weight * panel;
                let (gamma, fixed) = (self.half_damping_per_s, self.fixed_damping_per_s);
                let pair = |a: Complex<f64>, b: Complex<f64>, c: Complex<f64>, d: Complex<f64>| {
                    // ½(s r* + r s*) weights of state components with amplitudes a, b | c, d
                    (a * d.conj() + b * c.conj()) * gamma + b * d.conj() * fixed
                };
                form.qq += w * pair(s_q, f.rq, s_q, f.rq).re;
                form.rr += w * pair(s_r, f_rr, s_r, f_rr).re;
                form.qr += pair(s_r, f_rr, s_q, f.rq) * w;
            }
        }
        form
    }
}

impl Flow {
    /// (q, r) after the flow's time.
    pub fn apply(&self, q: Complex<f64>, r: Complex<f64>) -> (Complex<f64>, Complex<f64>) {
        (
            q + (self.qq * q + self.qr * r),
            r + (self.rq * q + self.rr * r),
        )
    }
}

impl LossForm {
    /// Loss for a state at the start.
    pub fn loss(&self, q: Complex<f64>, r: Complex<f64>) -> f64 {
        self.qq * q.norm_sqr() + self.rr * r.norm_sqr() + 2.0 * (self.qr * q.conj() * r).re
    }
}

/// (e^z − 1)/z.
pub(crate) fn phi1(z: Complex<f64>) -> Complex<f64> {
    let one = Complex::from(1.0);
    if z.norm_sqr() < 0.25 {
        // Horner form of Σ zᵏ/(k+1)!, below 1e-17 for |z| < 0.5.
        let mut sum = one;
        for k in (2..=15).rev() {
            sum = one + z * sum / f64::from(k);
        }
        sum
    } else {
        (z.exp() - one) / z
    }
}

/// (e^z − 1 − z)/z².
pub(crate) fn phi2(z: Complex<f64>) -> Complex<f64> {
    let one = Complex::from(1.0);
    if z.norm_sqr() < 0.25 {
        let mut sum = one;
        for k in (3..=16).rev() {
            sum = one + z * sum / f64::from(k);
        }
        sum * 0.5
    } else {
        (z.exp() - one - z) / (z * z)
    }
}

/// Gauss rule on (0, 1), exact to degree 15.
pub(crate) const GAUSS_8: [(f64, f64); 8] = [
    (0.019_855_071_751_231_884, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_63, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_65),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_825, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_65),
    (0.898_333_238_706_813_4, 0.111_190_517_226_687_24),
    (0.980_144_928_248_768_1, 0.050_614_268_145_188_13),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Fourth-order Runge-Kutta on the rotating-frame equation, tiny steps: an independent flow.
    fn integrate(o: &Oscillator, q: Complex<f64>, r: Complex<f64>, h: f64) -> [Complex<f64>; 3] {
        let turn = Complex::new(0.0, o.turn_rad_per_s);
        let rate = |y: [Complex<f64>; 3]| {
            let (q, r) = (y[0], y[1]);
            let s = r + turn * q;
            // D s = −2γ s − c r − ω² q, D = d/dt + iN on amplitudes.
            let s_dot = -s * (2.0 * o.half_damping_per_s)
                - r * o.fixed_damping_per_s
                - q * o.omega_rad_per_s.powi(2)
                - turn * s;
            let loss = 2.0 * o.half_damping_per_s * (s * r.conj()).re
                + o.fixed_damping_per_s * r.norm_sqr();
            [r, s_dot - turn * r, Complex::from(loss)]
        };
        let n = 4000;
        let dt = h / f64::from(n);
        let mut y = [q, r, Complex::from(0.0)];
        let add = |y: [Complex<f64>; 3], k: [Complex<f64>; 3], f: f64| {
            [y[0] + k[0] * f, y[1] + k[1] * f, y[2] + k[2] * f]
        };
        for _ in 0..n {
            let k1 = rate(y);
            let k2 = rate(add(y, k1, dt / 2.0));
            let k3 = rate(add(y, k2, dt / 2.0));
            let k4 = rate(add(y, k3, dt));
            for i in 0..3 {
                y[i] += (k1[i] + k2[i] * 2.0 + k3[i] * 2.0 + k4[i]) * (dt / 6.0);
            }
        }
        y
    }

    fn cases() -> Vec<Oscillator> {
        let base = Oscillator {
            omega_rad_per_s: 3.0,
            half_damping_per_s: 0.2,
            turn_rad_per_s: 1.7,
            fixed_damping_per_s: 0.3,
        };
        vec![
            base,
            Oscillator {
                fixed_damping_per_s: 0.0,
                ..base
            },
            Oscillator {
                turn_rad_per_s: 4.0,
                ..base
            },
            Oscillator {
                half_damping_per_s: 5.0,
                ..base
            },
            Oscillator {
                half_damping_per_s: 3.0,
                fixed_damping_per_s: 0.0,
                ..base
            },
            Oscillator {
                omega_rad_per_s: 0.0,
                half_damping_per_s: 0.0,
                fixed_damping_per_s: 0.0,
                turn_rad_per_s: 0.0,
            },
        ]
    }

    #[test]
    fn flow_and_loss_agree_with_direct_integration() {
        let (q, r) = (Complex::new(0.7, -0.4), Complex::new(-1.1, 0.9));
        for o in cases() {
            for h in [0.01, 0.3, 2.5] {
                let reference = integrate(&o, q, r, h);
                let (q1, r1) = o.flow(h).apply(q, r);
                assert!((q1 - reference[0]).norm() < 1e-10, "{o:?} {h}");
                assert!((r1 - reference[1]).norm() < 1e-10, "{o:?} {h}");
                let loss = o.loss_form(h).loss(q, r);
                assert!(
                    (loss - reference[2].re).abs() < 1e-10,
                    "{o:?} {h}: {loss} {}",
                    reference[2].re
                );
                let taken = o.fixed_frame_energy(q, r) - o.fixed_frame_energy(q1, r1);
                assert!((loss - taken).abs() < 1e-11, "{o:?} {h}");
            }
        }
    }

    #[test]
    fn a_million_steps_keep_the_energy_of_an_undamped_mode() {
        let o = Oscillator {
            omega_rad_per_s: 6400.0,
            turn_rad_per_s: 1131.0,
            ..Oscillator::default()
        };
        let flow = o.flow(5e-7);
        let (mut q, mut r) = (Complex::new(1.0, 0.0), Complex::new(0.0, 3000.0));
        let start = o.fixed_frame_energy(q, r);
        for _ in 0..1_000_000 {
            (q, r) = flow.apply(q, r);
        }
        assert!((o.fixed_frame_energy(q, r) / start - 1.0).abs() < 1e-10);
    }
}
