//! Ports: the seven motions through which slider and suspension interact with each other and with everything else.
//!
//! ```text
//! x = (q, η),   q = (z, pitch, roll),    p = P x = (q, s)                force on x by F at the ports: Pᵀ F
//! s = (z − w, pitch + w', roll − θ, e) = E q + R η,     w, w', θ, e = r·η at the dimple and the tab's end
//! ```
//!
//! | symbol | what | unit |
//! |---|---|---|
//! | η | natural modes of the suspension with the dimple free, bending before torsion | √kg m |
//! | s | slider over the suspension's dimple: closing, tilt along and across; rise of the tab's end | m, rad |
//! | w, w' | displacement of the dimple and slope dw/dx there, by bending | m, 1 |
//! | θ | roll at the dimple, by torsion | rad |
//! | e | rise of the lift tab's end, by bending; 0 without a lift tab | m |
//! | E | 4 × 3: 1 on its diagonal | |
//!
//! Modes are mass-normalised, so that a mode has the mass 1, the stiffness ω² and the damping 2 ζ ω. Film, gimbal,
//! dimple, limiters and lift tab depend on x through p only. Their contribution to a matrix of slider and suspension
//! therefore has rank seven at most. A stiff contact depends on s, not on the difference of two displacements that are
//! solved for, so its force does not lose digits.

use crate::lanes::abreast;
use crate::suspension::ReducedSuspension;
use nalgebra::DVector;

/// Number of ports.
pub(super) const PORTS: usize = 7;
/// Ports of the slider: z, pitch, roll.
pub(super) const SLIDER: usize = 3;
/// Ports of the suspension, s.
pub(super) const JOINTS: usize = PORTS - SLIDER;
/// Closing of the dimple, z − w.
pub(super) const CLOSING: usize = 3;
/// Tilt of the slider along the suspension, pitch + dw/dx.
pub(super) const TILT_ALONG: usize = 4;
/// Tilt across it, roll − roll at the dimple.
pub(super) const TILT_ACROSS: usize = 5;
/// Rise of the lift tab's end.
pub(super) const TAB: usize = 6;

/// Motions, or forces, at the ports.
pub(super) type AtPorts = [f64; PORTS];

/// Sum of products.
#[inline(always)]
pub(super) fn along(row: &AtPorts, p: &AtPorts) -> f64 {
    row.iter().zip(p).map(|(r, p)| r * p).sum()
}

/// `out` += `factor` `row`.
#[inline(always)]
pub(super) fn add_along(out: &mut AtPorts, factor: f64, row: &AtPorts) {
    for (out, r) in out.iter_mut().zip(row) {
        *out += factor * r;
    }
}

/// `out` += `factor` `row` `row`ᵀ.
pub(super) fn add_square(out: &mut [AtPorts; PORTS], factor: f64, row: &AtPorts) {
    for (out, left) in out.iter_mut().zip(row) {
        add_along(out, factor * left, row);
    }
}

/// R: the rows of the joints over all modes.
#[derive(Clone, Debug)]
pub(super) struct Ports {
    rows: [Vec<f64>; JOINTS],
}

impl Ports {
    /// Of a reduced suspension in its natural modes.
    pub fn new(suspension: &ReducedSuspension) -> Self {
        let (bending, torsion) = (&suspension.bending, &suspension.torsion);
        let n = bending.len() + torsion.len();
        let of_bending = |row: DVector<f64>| {
            let mut row = row.as_slice().to_vec();
            row.resize(n, 0.0);
            row
        };
        let mut roll = vec![0.0; bending.len()];
        roll.extend(torsion.natural_modes.row(0).iter().map(|r| -r));
        let tab = match &bending.tab_row {
            Some(row) => bending.in_natural_modes(row),
            None => DVector::zeros(bending.len()),
        };
        Self {
            rows: [
                of_bending(-bending.natural_modes.row(0).transpose()),
                of_bending(bending.in_natural_modes(&bending.slope_row)),
                roll,
                of_bending(tab),
            ],
        }
    }

    /// R.
    #[inline]
    pub fn rows(&self) -> [&[f64]; JOINTS] {
        let [closing, along, across, tab] = &self.rows;
        [closing, along, across, tab]
    }

    /// Row of P that gives one port from the coordinates.
    pub fn row(&self, port: usize) -> DVector<f64> {
        let mut out = DVector::zeros(SLIDER + self.rows[0].len());
        match port.checked_sub(SLIDER) {
            None => out[port] = 1.0,
            Some(k) => {
                if k < SLIDER {
                    out[k] = 1.0;
                }
                let modes = DVector::from_column_slice(&self.rows[k]);
                out.rows_mut(SLIDER, modes.len()).copy_from(&modes);
            }
        }
        out
    }

    /// P x.
    #[inline]
    pub fn read(&self, x: &[f64]) -> AtPorts {
        let (q, eta) = x.split_at(SLIDER);
        joined(q, abreast(self.rows().map(|row| [row, eta])))
    }

    /// P x and P v.
    #[inline]
    pub fn read_both(&self, x: &[f64], v: &[f64]) -> [AtPorts; 2] {
        let ((q, eta), (u, rate)) = (x.split_at(SLIDER), v.split_at(SLIDER));
        let [a, b, c, d] = self.rows();
        let [ax, bx, cx, dx, av, bv, cv, dv] = abreast([
            [a, eta],
            [b, eta],
            [c, eta],
            [d, eta],
            [a, rate],
            [b, rate],
            [c, rate],
            [d, rate],
        ]);
        [joined(q, [ax, bx, cx, dx]), joined(u, [av, bv, cv, dv])]
    }
}

/// p of the slider's q and of R η.
#[inline(always)]
fn joined(q: &[f64], [closing, along, across, tab]: [f64; JOINTS]) -> AtPorts {
    let [z, pitch, roll] = [q[0], q[1], q[2]];
    [
        z,
        pitch,
        roll,
        z + closing,
        pitch + along,
        roll + across,
        tab,
    ]
}

/// Forces on the slider, q + Eᵀ s, and on the joints of a force at the ports.
#[inline(always)]
pub(super) fn parted(force: AtPorts) -> ([f64; SLIDER], [f64; JOINTS]) {
    let [z, pitch, roll, closing, along, across, tab] = force;
    (
        [z + closing, pitch + along, roll + across],
        [closing, along, across, tab],
    )
}
