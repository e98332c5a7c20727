//! Coefficients of the ESDIRK schemes TR-BDF2 and ESDIRK3(2)4L\[2\]SA.

/// An ESDIRK scheme: first stage explicit, one γ on the diagonal, last stage equals the new value.
#[derive(Clone, Copy, Debug)]
pub struct Tableau {
    /// Name for reports.
    pub name: &'static str,
    /// Order of the solution.
    pub order: u32,
    /// Power of Δt with which the error estimate falls.
    pub error_order: u32,
    /// Diagonal coefficient of the implicit stages.
    pub gamma: f64,
    /// Stage abscissae; the first is 0, the last 1.
    pub c: &'static [f64],
    /// Rows of A below the diagonal, row i of i entries.
    pub a: &'static [&'static [f64]],
    /// Embedded minus main weights, one per stage.
    pub error_weights: &'static [f64],
}

impl Tableau {
    /// Number of stages, the explicit one included.
    pub fn n_stages(&self) -> usize {
        self.c.len()
    }
}

const SQRT2: f64 = std::f64::consts::SQRT_2;
const TR_W: f64 = SQRT2 / 4.0;
const TR_D: f64 = 1.0 - SQRT2 / 2.0;

/// TR-BDF2 with γ = 2 − √2 as an ESDIRK of two implicit stages; the third-order companion gives
/// the error estimate.
pub const TR_BDF2: Tableau = Tableau {
    name: "tr-bdf2",
    order: 2,
    error_order: 3,
    gamma: TR_D,
    c: &[0.0, 2.0 * TR_D, 1.0],
    a: &[&[], &[TR_D], &[TR_W, TR_W]],
    error_weights: &[
        (1.0 - TR_W) / 3.0 - TR_W,
        (3.0 * TR_W + 1.0) / 3.0 - TR_W,
        TR_D / 3.0 - TR_D,
    ],
};

const K_GAMMA: f64 = 1767732205903.0 / 4055673282236.0;

/// ESDIRK3(2)4L\[2\]SA of Kennedy and Carpenter: third order, three implicit stages.
pub const ESDIRK3: Tableau = Tableau {
    name: "esdirk3",
    order: 3,
    error_order: 3,
    gamma: K_GAMMA,
    c: &[0.0, 2.0 * K_GAMMA, 3.0 / 5.0, 1.0],
    a: &[
        &[],
        &[K_GAMMA],
        &[
            2746238789719.0 / 10658868560708.0,
            -640167445237.0 / 6845629431997.0,
        ],
        &[
            1471266399579.0 / 7840856788654.0,
            -4482444167858.0 / 7529755066697.0,
            11266239266428.0 / 11593286722821.0,
        ],
    ],
    error_weights: &[
        2756255671327.0 / 12835298489170.0 - 1471266399579.0 / 7840856788654.0,
        -10771552573575.0 / 22201958757719.0 + 4482444167858.0 / 7529755066697.0,
        9247589265047.0 / 10645013368117.0 - 11266239266428.0 / 11593286722821.0,
        2193209047091.0 / 5459859503100.0 - K_GAMMA,
    ],
};
