//! Takes one step of a system with up to two unilateral contacts: exact flow, impacts located in time, and impulses
//! aimed at a closed gap.

use super::lcp;

/// A gap and its rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gap {
    /// g, m; positive when open.
    pub value_m: f64,
    /// dg/dt, m/s.
    pub rate_m_per_s: f64,
}

/// Kind of an impulse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImpulseKind {
    /// A collision located in time.
    Impact,
    /// A share of the force of a contact that lasts.
    Sustained,
}

/// A linear system that holds its own state. "Now" is its current instant; "ahead" is the instant last computed.
pub trait UnilateralSystem {
    /// Gaps now; entries from `n_contacts` on are ignored.
    fn gaps(&self) -> [Gap; 2];
    /// Number of contacts, at most 2.
    fn n_contacts(&self) -> usize;
    /// Computes the state `h_s` after now by the exact free flow.
    fn look_ahead(&mut self, h_s: f64);
    /// Gaps ahead.
    fn gaps_ahead(&self) -> [Gap; 2];
    /// Gap velocity now per impulse now, 1/kg.
    fn mobility(&self) -> [[f64; 2]; 2];
    /// Gap ahead per impulse now, s/kg.
    fn compliance_ahead(&self) -> [[f64; 2]; 2];
    /// Longest time over which an impulse can be aimed at a gap, s: π/ω of the fastest mode, beyond
    /// which that mode answers an impulse with the wrong sign. Longer steps are divided.
    fn longest_aim_s(&self) -> f64 {
        f64::INFINITY
    }
    /// Largest energy that impulses of a lasting contact may return of what damping takes; nothing by default.
    fn refund(&self) -> Refund {
        Refund::default()
    }
    /// Applies impulses (N s) now, and their effect to the state ahead.
    fn impulse(&mut self, impulse_n_s: [f64; 2], kind: ImpulseKind);
    /// Makes ahead the new now.
    fn commit(&mut self);
}

/// Largest energy that impulses P now may return, J: Σ c + s P + P·R P.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Refund {
    /// c, without an impulse of the contact, J.
    pub constant_j: [f64; 2],
    /// s, m/s.
    pub slope_m_per_s: [f64; 2],
    /// R, 1/kg.
    pub square_per_kg: [[f64; 2]; 2],
}

impl Refund {
    /// Energy that `impulse_n_s` may return, J; only contacts with an impulse contribute.
    pub fn of(&self, impulse_n_s: [f64; 2]) -> f64 {
        -self.excess([0.0; 2], impulse_n_s)
    }

    /// Energy of `impulse_n_s` on gaps of mean rates `mean_m_per_s` before and after, minus [`Self::of`], J.
    fn excess(&self, mean_m_per_s: [f64; 2], impulse_n_s: [f64; 2]) -> f64 {
        let squares = product(self.square_per_kg, impulse_n_s);
        let of_contact = |i: usize| match impulse_n_s[i] {
            0.0 => 0.0,
            p => p * (mean_m_per_s[i] - squares[i] - self.slope_m_per_s[i]) - self.constant_j[i],
        };
        of_contact(0) + of_contact(1)
    }

    /// Largest impulse of contact `i` alone, of mobility `w`; the impulse `stop` makes its rate zero. It is the larger
    /// root of P v + ½ w P² = c + s P + R P² with v = −w stop.
    fn largest(&self, i: usize, w: f64, stop: f64) -> f64 {
        let alpha = 1.0 - 2.0 * self.square_per_kg[i][i] / w;
        let beta = 1.0 + self.slope_m_per_s[i] / (w * stop);
        let constant = 2.0 * self.constant_j[i] / (w * stop * stop);
        stop * (beta + (beta * beta + alpha * constant).max(0.0).sqrt()) / alpha
    }
}

/// The law of impact and its numerical limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactLaw {
    /// Newton's coefficient of restitution e, 0 to 1. At 0 the impulse aims at a closed gap at the end of the step.
    pub restitution: f64,
    /// Gaps up to this are closed, m; far below anything of interest.
    pub gap_tolerance_m: f64,
    /// Impacts in one step after which contact is taken as sustained.
    pub max_impacts_per_step: u32,
}

/// Which contacts last from step to step; kept by the caller, empty at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactMemory {
    lasting: [bool; 2],
}

/// What happened in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepReport {
    /// Impacts located.
    pub impacts: u32,
    /// The limit of impacts was reached (bounces accumulate, or the step is long).
    pub accumulated: bool,
}

/// Advances `system` by `h_s`.
pub fn advance(
    system: &mut impl UnilateralSystem,
    h_s: f64,
    law: &ImpactLaw,
    memory: &mut ContactMemory,
) -> StepReport {
    let n_parts = (h_s / system.longest_aim_s()).ceil().max(1.0);
    let mut total = StepReport::default();
    for _ in 0..n_parts as u64 {
        let report = advance_part(system, h_s / n_parts, law, memory);
        total.impacts += report.impacts;
        total.accumulated |= report.accumulated;
    }
    total
}

fn advance_part(
    system: &mut impl UnilateralSystem,
    h_s: f64,
    law: &ImpactLaw,
    memory: &mut ContactMemory,
) -> StepReport {
    let mut report = StepReport::default();
    let n = system.n_contacts();
    let mut left = h_s;
    // Each pass but the last commits one impact; the second factor ends a pathological step.
    let max_passes = 4 * law.max_impacts_per_step + 4;
    for pass in 0..=max_passes {
        system.look_ahead(left);
        if pass == 0 {
            begin_at_node(system, left, n, law, memory, &mut report);
        }
        let crossing = if pass < max_passes {
            let bounced = report.impacts > 0 && law.restitution > 0.0;
            first_crossing(system, left, n, law, bounced)
        } else {
            report.accumulated = true;
            None
        };
        let Some(tau) = crossing else {
            system.commit();
            return report;
        };
        system.look_ahead(tau);
        system.commit();
        left = (left - tau).max(0.0);
        report.impacts += 1;
        collide(system, left, n, law, memory, &mut report);
        if left == 0.0 {
            return report;
        }
    }
    report
}

/// Impulse of the contacts that are closed at a node.
fn begin_at_node(
    system: &mut impl UnilateralSystem,
    left_s: f64,
    n: usize,
    law: &ImpactLaw,
    memory: &mut ContactMemory,
    report: &mut StepReport,
) {
    let now = system.gaps();
    let closed: [bool; 2] = std::array::from_fn(|i| i < n && now[i].value_m <= law.gap_tolerance_m);
    for i in 0..n {
        // Impacts are located where the gap is zero. A gap below zero is already in contact: a bounce at every node
        // would let it sink in for e < 1/2.
        let below = now[i].value_m < -law.gap_tolerance_m;
        memory.lasting[i] = closed[i] && (memory.lasting[i] || below);
    }
    let arrives = (0..n).any(|i| closed[i] && !memory.lasting[i] && now[i].rate_m_per_s < 0.0);
    if arrives {
        // The impact falls on the node itself.
        report.impacts += 1;
        collide(system, left_s, n, law, memory, report);
        system.look_ahead(left_s);
    } else if closed[0] || closed[1] {
        let p = aimed_impulse(system, closed, system.refund());
        if p != [0.0; 2] {
            system.impulse(p, ImpulseKind::Sustained);
        }
    }
}

/// Impact at the current instant, `left_s` before the next node.
fn collide(
    system: &mut impl UnilateralSystem,
    left_s: f64,
    n: usize,
    law: &ImpactLaw,
    memory: &mut ContactMemory,
    report: &mut StepReport,
) {
    system.look_ahead(left_s);
    let now = system.gaps();
    let closed = std::array::from_fn(|i| i < n && now[i].value_m <= law.gap_tolerance_m);
    let bounce = law.restitution > 0.0 && report.impacts < law.max_impacts_per_step;
    let p = if bounce {
        let target = std::array::from_fn(|i| (1.0 + law.restitution) * now[i].rate_m_per_s);
        lcp::solve(system.mobility(), target, closed).unwrap_or([0.0; 2])
    } else {
        report.accumulated |= law.restitution > 0.0;
        let p = aimed_impulse(system, closed, Refund::default());
        for (lasting, p) in memory.lasting.iter_mut().zip(p) {
            *lasting |= p > 0.0;
        }
        p
    };
    if p != [0.0; 2] {
        system.impulse(p, ImpulseKind::Impact);
    }
}

/// Impulse now that brings the gaps ahead to zero, within two bounds: at least the impulse that makes the rates zero,
/// at most that of the energy bound P·v⁻ + ½ P·W P ≤ `refund` of P.
fn aimed_impulse(system: &impl UnilateralSystem, closed: [bool; 2], refund: Refund) -> [f64; 2] {
    let (now, ahead) = (system.gaps(), system.gaps_ahead());
    let w = system.mobility();
    let rate = [now[0].rate_m_per_s, now[1].rate_m_per_s];
    let Some(stop) = lcp::solve(w, rate, closed) else {
        return [0.0; 2];
    };
    if stop == [0.0; 2] {
        return stop;
    }
    let predicted = [ahead[0].value_m, ahead[1].value_m];
    let aim = lcp::solve(system.compliance_ahead(), predicted, closed).unwrap_or(stop);
    let bounded = std::array::from_fn(|i| {
        if stop[i] == 0.0 {
            return 0.0;
        }
        let largest = refund.largest(i, w[i][i], stop[i]);
        aim[i].clamp(stop[i], largest.max(stop[i]))
    });
    if !(closed[0] && closed[1]) {
        return bounded;
    }
    // Two contacts: each is bounded by itself. Then both go from `stop`, which makes the rates zero, towards these
    // bounds as far as their common energy allows. Impulses below `stop` would let the contacts penetrate.
    let beyond = [bounded[0] - stop[0], bounded[1] - stop[1]];
    let at = |share: f64| [stop[0] + share * beyond[0], stop[1] + share * beyond[1]];
    let energy = |p: [f64; 2]| {
        let wp = product(w, p);
        refund.excess(std::array::from_fn(|i| rate[i] + 0.5 * wp[i]), p)
    };
    // A quadratic in the share through its values at 0, 1/2 and 1, negative at 0.
    let (e0, e1, e2) = (energy(at(0.0)), energy(at(0.5)), energy(at(1.0)));
    if e2 <= 0.0 {
        return at(1.0);
    }
    let a = 2.0 * (e0 - 2.0 * e1 + e2);
    let b = e2 - e0 - a;
    let root = (b * b - 4.0 * a * e0).max(0.0).sqrt();
    let share = -2.0 * e0 / (b + root);
    at(if share.is_finite() {
        share.clamp(0.0, 1.0)
    } else {
        0.0
    })
}

fn product(m: [[f64; 2]; 2], p: [f64; 2]) -> [f64; 2] {
    std::array::from_fn(|i| m[i][0] * p[0] + m[i][1] * p[1])
}

/// Time to the first gap that becomes negative before the instant ahead, `h_s` from now.
///
/// Leaves the state ahead at `h_s` when there is none. `bounced`: an impact of this step may have opened a closed gap
/// that closes again within the step.
fn first_crossing(
    system: &mut impl UnilateralSystem,
    h_s: f64,
    n: usize,
    law: &ImpactLaw,
    bounced: bool,
) -> Option<f64> {
    let (now, ahead) = (system.gaps(), system.gaps_ahead());
    let mut first: Option<f64> = None;
    let mut disturbed = false;
    for i in 0..n {
        if now[i].value_m <= law.gap_tolerance_m {
            // A closed gap is aimed at and not located, except one that has just bounced and may return.
            let returns =
                bounced && now[i].rate_m_per_s > 0.0 && ahead[i].value_m < -law.gap_tolerance_m;
            if !returns {
                continue;
            }
        }
        let end = if ahead[i].value_m < 0.0 {
            Some(h_s)
        } else if dips(now[i], ahead[i], h_s) {
            disturbed = true;
            lowest(system, i, now[i], ahead[i], h_s)
        } else {
            None
        };
        if let Some(end) = end {
            disturbed = true;
            let tau = root(system, i, now[i], end, law);
            first = Some(first.map_or(tau, |t: f64| t.min(tau)));
        }
    }
    if first.is_none() && disturbed {
        system.look_ahead(h_s);
    }
    first
}

/// True when the cubic through both ends of the step goes below 0 between them.
pub fn dips(now: Gap, ahead: Gap, h_s: f64) -> bool {
    if now.rate_m_per_s >= 0.0 || ahead.rate_m_per_s <= 0.0 {
        return false;
    }
    // The tangents bound the dip: no cubic with these ends falls below the lower tangent value.
    let reach = h_s * now.rate_m_per_s.abs().max(ahead.rate_m_per_s);
    if now.value_m.min(ahead.value_m) > reach {
        return false;
    }
    let x = lowest_of_cubic(now, ahead, h_s);
    cubic(now, ahead, h_s, x) < 0.0
}

/// Largest value between a rising start and a falling end of the cubic through both.
pub fn largest_between(now: Gap, ahead: Gap, h_s: f64) -> f64 {
    let negative = |g: Gap| Gap {
        value_m: -g.value_m,
        rate_m_per_s: -g.rate_m_per_s,
    };
    let (now, ahead) = (negative(now), negative(ahead));
    -cubic(now, ahead, h_s, lowest_of_cubic(now, ahead, h_s))
}

/// Place in (0, 1) of the minimum of the Hermite cubic with falling start and rising end.
fn lowest_of_cubic(now: Gap, ahead: Gap, h_s: f64) -> f64 {
    let (d0, d1) = (h_s * now.rate_m_per_s, h_s * ahead.rate_m_per_s);
    let rise = ahead.value_m - now.value_m;
    // derivative: d0 + b x + a x², a = 3 (d0 + d1 − 2 rise), b = 6 rise − 4 d0 − 2 d1
    let a = 3.0 * (d0 + d1 - 2.0 * rise);
    let b = 6.0 * rise - 4.0 * d0 - 2.0 * d1;
    let root = (b * b - 4.0 * a * d0).max(0.0).sqrt();
    // The rising root, written so that a → 0 is harmless: d0 < 0.
    let x = if b >= 0.0 {
        -2.0 * d0 / (b + root)
    } else {
        (root - b) / (2.0 * a)
    };
    if x.is_finite() {
        x.clamp(0.0, 1.0)
    } else {
        0.5
    }
}

/// Value of the Hermite cubic at share `x` of the step.
fn cubic(now: Gap, ahead: Gap, h_s: f64, x: f64) -> f64 {
    let y = 1.0 - x;
    now.value_m * (1.0 + 2.0 * x) * y * y
        + ahead.value_m * (3.0 - 2.0 * x) * x * x
        + h_s * x * y * (now.rate_m_per_s * y - ahead.rate_m_per_s * x)
}

/// Instant of the lowest gap inside the step on the exact motion, when it is negative there.
fn lowest(
    system: &mut impl UnilateralSystem,
    i: usize,
    now: Gap,
    ahead: Gap,
    h_s: f64,
) -> Option<f64> {
    let (mut a, mut b) = (0.0, h_s);
    let mut tau = h_s * lowest_of_cubic(now, ahead, h_s);
    let (mut rate_a, mut rate_b) = (now.rate_m_per_s, ahead.rate_m_per_s);
    for _ in 0..40 {
        system.look_ahead(tau);
        let gap = system.gaps_ahead()[i];
        if gap.value_m < 0.0 {
            return Some(tau);
        }
        if gap.rate_m_per_s < 0.0 {
            (a, rate_a) = (tau, gap.rate_m_per_s);
        } else {
            (b, rate_b) = (tau, gap.rate_m_per_s);
        }
        let next = a + (b - a) * rate_a / (rate_a - rate_b);
        if !(next > a && next < b) || (next - tau).abs() < 1e-9 * h_s {
            return None;
        }
        tau = next;
    }
    None
}

/// First root of gap `i` in (0, end_s], where it is positive at 0 and negative at `end_s`.
fn root(
    system: &mut impl UnilateralSystem,
    i: usize,
    now: Gap,
    end_s: f64,
    law: &ImpactLaw,
) -> f64 {
    let (mut a, mut b) = (0.0, end_s);
    system.look_ahead(end_s);
    let ahead = system.gaps_ahead()[i];
    // Start from the cubic's root by bisection: 30 cheap halvings.
    let (mut lo, mut hi) = (0.0, 1.0);
    for _ in 0..30 {
        let mid = 0.5 * (lo + hi);
        if cubic(now, ahead, end_s, mid) > 0.0 {
            lo = mid;
        } else {
            hi = mid;
        }
    }
    let mut tau = end_s * hi;
    // A closed gap is one within the tolerance: aim well inside it.
    let close_enough = 0.01 * law.gap_tolerance_m;
    for _ in 0..60 {
        system.look_ahead(tau);
        let gap = system.gaps_ahead()[i];
        if gap.value_m.abs() <= close_enough || b - a <= 1e-15 * end_s {
            break;
        }
        if gap.value_m > 0.0 {
            a = tau;
        } else {
            b = tau;
        }
        let newton = tau - gap.value_m / gap.rate_m_per_s;
        tau = if newton > a && newton < b {
            newton
        } else {
            0.5 * (a + b)
        };
    }
    tau
}
