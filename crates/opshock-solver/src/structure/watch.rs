//! Evaluates the nodes within a contact-free interval: the motion that the head reads, extremes, recorded columns.

use super::driven::Driven;
use super::run_in_progress::RunInProgress;
use super::span::INTERVAL_NODES;
use crate::disk::DiskPose;
use crate::lanes::{self, Simd, WithSimd};
use crate::modal::ModalState;
use crate::modal::bank::{ChunkFlow, LANES, chunks};

impl RunInProgress<'_> {
    /// Evaluates the nodes within a contact-free interval that begins now.
    pub fn watch(&mut self, driven: &Driven) {
        let first = self.k;
        let mut sums = [[[0.0; LANES]; WATCHED]; INTERVAL_NODES - 1];
        lanes::widest(Watch {
            driven,
            n: self.n_moving / LANES,
            state: &self.state.now,
            sums: &mut sums,
        });
        let mut seen = [(DiskPose::default(), DiskPose::default()); INTERVAL_NODES - 1];
        for (j, (sums, seen)) in sums.into_iter().zip(&mut seen).enumerate() {
            let sample = &self.shared.free.samples[first + j + 1];
            let [contact, rim, w, pitch, roll, w_rate, pitch_rate, roll_rate] =
                sums.map(lanes::total);
            let (pose, rate) = self.free_slider(sample);
            let pose = pose.plus(&DiskPose {
                displacement_m: w,
                pitch_rad: pitch,
                roll_rad: roll,
            });
            let rate = rate.plus(&DiskPose {
                displacement_m: w_rate,
                pitch_rad: pitch_rate,
                roll_rad: roll_rate,
            });
            let a = self.amplitude;
            let [contact, rim] = [a * sample.contact.value + contact, a * sample.rim + rim];
            self.extremes
                .include_points([contact, rim, pose.displacement_m]);
            if self.state.keeps_motion {
                self.keep_motion(first + j + 1, pose, rate);
            }
            *seen = (pose, rate);
        }
        if self.state.record {
            self.record_interval(driven, &seen);
        }
    }

    /// Appends rows for the nodes within a contact-free interval, which is taken by steps for them and then undone.
    fn record_interval(&mut self, driven: &Driven, seen: &[(DiskPose, DiskPose)]) {
        let (first, free) = (self.k, &self.shared.free);
        let (now, unit) = (self.state.now.clone(), self.state.unit_now.clone());
        for (pose, _) in seen {
            let state = &mut *self.state;
            let before = state.now.clone();
            driven
                .step_flow
                .apply(self.n_moving, &before, &mut state.now);
            free.step(&mut state.unit_now, self.k);
            self.k += 1;
            self.is_totalled = false;
            self.record_within(*pose);
        }
        (self.k, self.is_totalled) = (first, false);
        (self.state.now, self.state.unit_now) = (now, unit);
    }
}

/// Sums at a node within an interval: contact point, rim, and the slider's pose and its rate.
const WATCHED: usize = 8;

struct Watch<'a> {
    driven: &'a Driven,
    n: usize,
    state: &'a ModalState,
    sums: &'a mut [[[f64; LANES]; WATCHED]; INTERVAL_NODES - 1],
}

impl WithSimd for Watch<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match S::F64_LANES {
            8 => self.run::<S, 1>(simd),
            4 => self.run::<S, 2>(simd),
            2 => self.run::<S, 4>(simd),
            _ => self.run::<S, 8>(simd),
        }
    }
}

impl Watch<'_> {
    /// Chunk by chunk, each advanced over all nodes in registers, `V` of them per chunk.
    #[inline(always)]
    fn run<S: Simd, const V: usize>(self, simd: S) {
        let n = self.n;
        let read = |column| &chunks(column)[..n];
        let Driven {
            contact,
            rim,
            slider,
            step_flow,
            ..
        } = self.driven;
        let [w, pitch, roll] = slider;
        let rows = [
            contact, rim, &w.re, &w.im, &pitch.re, &pitch.im, &roll.re, &roll.im,
        ];
        let rows = rows.map(|row| read(row));
        let state = self.state.columns().map(read);
        for i in 0..n {
            let load = |x: &[f64; LANES]| -> [S::f64s; V] {
                let parts = S::as_simd_f64s(x).0;
                std::array::from_fn(|v| parts[v])
            };
            let ChunkFlow(flow) = step_flow.of_chunk(i);
            let [ar, ai, br, bi, cr, ci, dr, di] = flow.map(load);
            let [contact, rim, wr, wi, pr, pi, rr, ri] = rows.map(|row| load(&row[i]));
            let [mut qr, mut qi, mut vr, mut vi] = state.map(|column| load(&column[i]));
            for sums in self.sums.iter_mut() {
                for v in 0..V {
                    let fused = |a, b, c| simd.mul_add_f64s(a, b, c);
                    let less = |a, b, c| simd.negate_mul_add_f64s(a, b, c);
                    let (x, y, p, q) = (qr[v], qi[v], vr[v], vi[v]);
                    // Two halves of each sum, so that a step waits for three products and not for five.
                    let half = |re, im, at| fused(re, x, less(im, y, at));
                    let other = |re, im| less(im, q, simd.mul_f64s(re, p));
                    qr[v] = simd.add_f64s(half(ar[v], ai[v], x), other(br[v], bi[v]));
                    vr[v] = simd.add_f64s(half(cr[v], ci[v], p), other(dr[v], di[v]));
                    let half = |re, im, at| fused(re, y, fused(im, x, at));
                    let other = |re, im| fused(re, q, simd.mul_f64s(im, p));
                    qi[v] = simd.add_f64s(half(ar[v], ai[v], y), other(br[v], bi[v]));
                    vi[v] = simd.add_f64s(half(cr[v], ci[v], q), other(dr[v], di[v]));
                    let (x, y, p, q) = (qr[v], qi[v], vr[v], vi[v]);
                    let [s0, s1, s2, s3, s4, s5, s6, s7] = &mut *sums;
                    add(simd, s0, v, [(contact[v], x)]);
                    add(simd, s1, v, [(rim[v], x)]);
                    add(simd, s2, v, [(wr[v], x), (wi[v], y)]);
                    add(simd, s3, v, [(pr[v], x), (pi[v], y)]);
                    add(simd, s4, v, [(rr[v], x), (ri[v], y)]);
                    add(simd, s5, v, [(wr[v], p), (wi[v], q)]);
                    add(simd, s6, v, [(pr[v], p), (pi[v], q)]);
                    add(simd, s7, v, [(rr[v], p), (ri[v], q)]);
                }
            }
        }
    }
}

/// Adds products to register `v` of `sums`.
#[inline(always)]
fn add<S: Simd, const K: usize>(
    simd: S,
    sums: &mut [f64; LANES],
    v: usize,
    products: [(S::f64s, S::f64s); K],
) {
    let sum = &mut S::as_mut_simd_f64s(sums).0[v];
    for (a, b) in products {
        *sum = simd.mul_add_f64s(a, b, *sum);
    }
}
