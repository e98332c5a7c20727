//! Advances many oscillators at once by a fixed time, stored as columns.
//!
//! Every column is padded with resting modes to a multiple of [`LANES`], so that loops run on
//! whole chunks and sums have one fixed order.

use super::oscillator::{Flow, Oscillator};
use crate::lanes::{self, Kernel, SUMS};
use nalgebra::Complex;

/// Chunk length of the loops over modes.
pub const LANES: usize = SUMS;

/// Amplitudes and velocities of all modes in the fixed frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModalState {
    /// Real part of q.
    pub q_re: Vec<f64>,
    /// Imaginary part of q.
    pub q_im: Vec<f64>,
    /// Real part of r = q̇.
    pub r_re: Vec<f64>,
    /// Imaginary part of r.
    pub r_im: Vec<f64>,
}

impl ModalState {
    /// q_re, q_im, r_re and r_im.
    pub fn columns(&self) -> [&[f64]; 4] {
        [&self.q_re, &self.q_im, &self.r_re, &self.r_im]
    }
}

/// Real and imaginary weights that read one point's displacement out of the amplitudes (and its
/// velocity out of the velocities): Σ re·q_re + im·q_im.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Readout {
    /// Weight of the real part.
    pub re: Vec<f64>,
    /// Weight of the imaginary part.
    pub im: Vec<f64>,
}

/// Transition of every mode over one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BankFlow {
    qq: Columns,
    qr: Columns,
    rq: Columns,
    rr: Columns,
}

#[derive(Clone, Debug, Default, PartialEq)]
struct Columns {
    re: Vec<f64>,
    im: Vec<f64>,
}

impl Columns {
    fn zeros(n: usize) -> Self {
        Self {
            re: vec![0.0; n],
            im: vec![0.0; n],
        }
    }

    fn set(&mut self, i: usize, z: Complex<f64>) {
        self.re[i] = z.re;
        self.im[i] = z.im;
    }
}

/// Length that holds `n` modes in whole chunks.
pub fn padded(n: usize) -> usize {
    n.div_ceil(LANES) * LANES
}

impl ModalState {
    /// State at rest for columns of length `n`.
    pub fn at_rest(n: usize) -> Self {
        let zero = || vec![0.0; n];
        Self {
            q_re: zero(),
            q_im: zero(),
            r_re: zero(),
            r_im: zero(),
        }
    }

    /// Puts every mode to rest.
    pub fn reset(&mut self) {
        self.rest(0..self.len());
    }

    /// Takes the values of `other`, of the same length.
    pub fn copy_from(&mut self, other: &Self) {
        self.q_re.copy_from_slice(&other.q_re);
        self.q_im.copy_from_slice(&other.q_im);
        self.r_re.copy_from_slice(&other.r_re);
        self.r_im.copy_from_slice(&other.r_im);
    }

    /// Puts the modes of `range` to rest.
    pub fn rest(&mut self, range: std::ops::Range<usize>) {
        for column in [
            &mut self.q_re,
            &mut self.q_im,
            &mut self.r_re,
            &mut self.r_im,
        ] {
            column[range.clone()].fill(0.0);
        }
    }

    /// Columns length.
    pub fn len(&self) -> usize {
        self.q_re.len()
    }

    /// True when there is no mode.
    pub fn is_empty(&self) -> bool {
        self.q_re.is_empty()
    }

    /// Adds `impulse` times the real `shape` of the first modes to the velocities.
    pub fn kick(&mut self, shape: &[f64], impulse: f64) {
        lanes::add_scaled(&mut self.r_re[..shape.len()], impulse, shape);
    }
}

impl BankFlow {
    /// Flow of no mode, to be set for columns of length `n`.
    pub fn zeros(n: usize) -> Self {
        Self {
            qq: Columns::zeros(n),
            qr: Columns::zeros(n),
            rq: Columns::zeros(n),
            rr: Columns::zeros(n),
        }
    }

    /// Sets the flow of all `oscillators` to that over `h_s`; does not allocate.
    pub fn set(&mut self, oscillators: &[Oscillator], h_s: f64) {
        for (i, oscillator) in oscillators.iter().enumerate() {
            self.set_mode(i, &oscillator.flow(h_s));
        }
    }

    /// Sets the flow of mode `i`.
    pub fn set_mode(&mut self, i: usize, flow: &Flow) {
        self.qq.set(i, flow.qq);
        self.qr.set(i, flow.qr);
        self.rq.set(i, flow.rq);
        self.rr.set(i, flow.rr);
    }

    /// Flow of mode `i`.
    pub fn of_mode(&self, i: usize) -> Flow {
        let of = |column: &Columns| Complex::new(column.re[i], column.im[i]);
        Flow {
            qq: of(&self.qq),
            qr: of(&self.qr),
            rq: of(&self.rq),
            rr: of(&self.rr),
        }
    }

    /// Sets the flow of chunk `i`, in the order of [`ChunkFlow`].
    #[inline(always)]
    pub fn set_chunk(&mut self, i: usize, flow: &[[f64; LANES]; 8]) {
        let Self { qq, qr, rq, rr } = self;
        let [a, b, c, d, e, f, g, h] = flow;
        for (column, from) in [(qq, [a, b]), (qr, [c, d]), (rq, [e, f]), (rr, [g, h])] {
            column.re.as_chunks_mut::<LANES>().0[i] = *from[0];
            column.im.as_chunks_mut::<LANES>().0[i] = *from[1];
        }
    }

    /// `after` := flow of `before`, for the first `n_modes` of them, in whole chunks.
    pub fn apply(&self, n_modes: usize, before: &ModalState, after: &mut ModalState) {
        let flow = self;
        lanes::widest(Apply {
            flow,
            n: n_modes / LANES,
            before,
            after,
        });
    }

    /// Flow of chunk `i`.
    #[inline(always)]
    pub fn of_chunk(&self, i: usize) -> ChunkFlow<'_> {
        let Self { qq, qr, rq, rr } = self;
        let columns = [
            &qq.re, &qq.im, &qr.re, &qr.im, &rq.re, &rq.im, &rr.re, &rr.im,
        ];
        ChunkFlow(columns.map(|column| &chunks(column)[i]))
    }

    /// Adds to `after` the effect of an impulse on the real `shape` of the first modes at the start of the flow.
    pub fn add_kick(&self, shape: &[f64], impulse: f64, after: &mut ModalState) {
        lanes::widest(AddKick {
            flow: self,
            shape,
            impulse,
            after,
        });
    }

    /// Velocity of `to` after the flow per unit impulse on `from` at its start.
    pub fn response_across(&self, from: &[f64], to: &[f64]) -> f64 {
        let pairs = from.iter().zip(to).zip(&self.rr.re);
        pairs.map(|((a, b), c)| a * b * (1.0 + c)).sum()
    }

    /// Displacement of `to` after the flow per unit impulse on `from` at its start.
    pub fn compliance_across(&self, from: &[f64], to: &[f64]) -> f64 {
        let pairs = from.iter().zip(to).zip(&self.qr.re);
        pairs.map(|((a, b), s)| a * b * s).sum()
    }
}

struct Apply<'a> {
    flow: &'a BankFlow,
    n: usize,
    before: &'a ModalState,
    after: &'a mut ModalState,
}

impl Kernel for Apply<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let BankFlow { qq, qr, rq, rr } = self.flow;
        // Slices of one length, so that the loop needs no bounds checks.
        let n = self.n;
        let read = |column| &chunks(column)[..n];
        let flow = [qq, qr, rq, rr].map(|column| (read(&column.re), read(&column.im)));
        let [(ar, ai), (br, bi), (cr, ci), (dr, di)] = flow;
        let (xr, xi) = (read(&self.before.q_re), read(&self.before.q_im));
        let (yr, yi) = (read(&self.before.r_re), read(&self.before.r_im));
        let ur = &mut self.after.q_re.as_chunks_mut::<LANES>().0[..n];
        let ui = &mut self.after.q_im.as_chunks_mut::<LANES>().0[..n];
        let vr = &mut self.after.r_re.as_chunks_mut::<LANES>().0[..n];
        let vi = &mut self.after.r_im.as_chunks_mut::<LANES>().0[..n];
        for i in 0..n {
            let flow = [ar, ai, br, bi, cr, ci, dr, di].map(|column| &column[i]);
            [ur[i], ui[i], vr[i], vi[i]] = ChunkFlow(flow).carry([xr[i], xi[i], yr[i], yi[i]]);
        }
    }
}

/// Flow of one chunk of modes: real and imaginary parts of q from q, q from r, r from q, r from r.
pub struct ChunkFlow<'a>(pub [&'a [f64; LANES]; 8]);

impl ChunkFlow<'_> {
    /// q and r, real and imaginary parts, after the flow.
    #[inline(always)]
    pub fn carry(&self, at: [[f64; LANES]; 4]) -> [[f64; LANES]; 4] {
        let [ar, ai, br, bi, cr, ci, dr, di] = self.0;
        let [qr, qi, rr, ri] = at;
        let mut to = [[0.0; LANES]; 4];
        for l in 0..LANES {
            let (qr, qi, rr, ri) = (qr[l], qi[l], rr[l], ri[l]);
            let real = |a: f64, b: f64, c: f64, d: f64| {
                a.mul_add(qr, b.mul_add(-qi, c.mul_add(rr, -(d * ri))))
            };
            let imaginary = |a: f64, b: f64, c: f64, d: f64| {
                a.mul_add(qi, b.mul_add(qr, c.mul_add(ri, d * rr)))
            };
            to[0][l] = qr + real(ar[l], ai[l], br[l], bi[l]);
            to[1][l] = qi + imaginary(ar[l], ai[l], br[l], bi[l]);
            to[2][l] = rr + real(cr[l], ci[l], dr[l], di[l]);
            to[3][l] = ri + imaginary(cr[l], ci[l], dr[l], di[l]);
        }
        to
    }
}

struct AddKick<'a> {
    flow: &'a BankFlow,
    shape: &'a [f64],
    impulse: f64,
    after: &'a mut ModalState,
}

impl Kernel for AddKick<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let BankFlow { qr, rr, .. } = self.flow;
        let n = chunks(self.shape).len();
        let read = |column| &chunks(column)[..n];
        let shape = read(self.shape);
        let [qr_re, qr_im, rr_re, rr_im] = [&qr.re, &qr.im, &rr.re, &rr.im].map(|c| read(c));
        let q_re = &mut self.after.q_re.as_chunks_mut::<LANES>().0[..n];
        let q_im = &mut self.after.q_im.as_chunks_mut::<LANES>().0[..n];
        let r_re = &mut self.after.r_re.as_chunks_mut::<LANES>().0[..n];
        let r_im = &mut self.after.r_im.as_chunks_mut::<LANES>().0[..n];
        for i in 0..n {
            let mut to = [q_re[i], q_im[i], r_re[i], r_im[i]];
            for l in 0..LANES {
                let p = self.impulse * shape[i][l];
                to[0][l] = p.mul_add(qr_re[i][l], to[0][l]);
                to[1][l] = p.mul_add(qr_im[i][l], to[1][l]);
                to[2][l] += p.mul_add(rr_re[i][l], p);
                to[3][l] = p.mul_add(rr_im[i][l], to[3][l]);
            }
            [q_re[i], q_im[i], r_re[i], r_im[i]] = to;
        }
    }
}

/// The whole chunks of a padded column.
#[inline(always)]
pub fn chunks(column: &[f64]) -> &[[f64; LANES]] {
    column.as_chunks().0
}

impl Readout {
    /// Displacement (or velocity, given velocities) of the point.
    pub fn read(&self, re: &[f64], im: &[f64]) -> f64 {
        let [real, imaginary] = lanes::abreast([[&self.re, re], [&self.im, im]]);
        real + imaginary
    }

    /// The same of three points.
    pub fn read_three(rows: &[Self; 3], re: &[f64], im: &[f64]) -> [f64; 3] {
        let [a, b, c] = rows;
        let [a0, b0, c0] = [a, b, c].map(|row| [&*row.re, re]);
        let [a1, b1, c1] = [a, b, c].map(|row| [&*row.im, im]);
        let sums = lanes::abreast([a0, b0, c0, a1, b1, c1]);
        std::array::from_fn(|k| sums[k] + sums[k + 3])
    }
}

/// Sum of products, one fixed order.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    lanes::product(a, b)
}
