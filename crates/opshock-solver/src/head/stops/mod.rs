//! Limiters of the gimbal and lift tab: one-sided contacts that limit the opening of dimple and suspension.
//!
//! ```text
//! o = r·p,    N = max(0, k (o − g) + c ȯ),    force at the ports −r N,    c = 2 ζ √(k m)
//! ```
//!
//! | symbol | what | unit |
//! |---|---|---|
//! | o | opening, 0 in the steady loaded state | m |
//! | p, r | motions at the ports (`ports`), opening per port | |
//! | g | gap at rest | m |
//! | k, c, ζ | stiffness, damping, damping ratio on the slider's mass m | N/m, N s/m, 1 |
//! | N | force of the contact | N |
//!
//! A limiter is a hook of the flexure behind the load beam, at x along the suspension and y across it from
//! the dimple: o = z_dimple − z + x (pitch + dw/dx) − y (roll − roll_dimple), the load beam being taken as
//! the plane that it has at the dimple. The lift tab's o is the rise of the tab's end over the base, to which
//! its stop is fixed.
//!
//! The law is the dimple's without its preload: continuous, pushing only. With V = k max(0, o − g)²/2 the power (N −
//! V') ȯ is never negative, so no contact releases more energy than it stored. From N = 0 to N = 0 two bodies of
//! reduced mass μ separate at exp(−π ζ'/√(1 − ζ'²)) of the velocity at which they met, ζ' = c/(2 √(k μ)).

#[cfg(test)]
mod tests;

use super::ports::{AtPorts, PORTS, add_along, add_square, along};

/// Most stops beside the dimple that [`Closed`] can hold.
const MOST: usize = 7;

/// One contact.
#[derive(Clone, Debug)]
pub(super) struct Stop {
    /// r.
    pub row: AtPorts,
    pub gap_m: f64,
    pub stiffness_n_per_m: f64,
    pub damping_n_s_per_m: f64,
}

impl Stop {
    #[inline]
    fn signed_force(&self, p: &AtPorts, rate: &AtPorts) -> f64 {
        self.stiffness_n_per_m * (along(&self.row, p) - self.gap_m)
            + self.damping_n_s_per_m * along(&self.row, rate)
    }

    /// Energy held at the ports' motions, J.
    pub fn elastic_j(&self, p: &AtPorts) -> f64 {
        let pressed_m = (along(&self.row, p) - self.gap_m).max(0.0);
        0.5 * self.stiffness_n_per_m * pressed_m * pressed_m
    }

    /// Power that its damper takes, W.
    pub fn damping_w(&self, p: &AtPorts, rate: &AtPorts) -> f64 {
        let elastic_n = self.stiffness_n_per_m * (along(&self.row, p) - self.gap_m).max(0.0);
        (self.force(p, rate) - elastic_n) * along(&self.row, rate)
    }

    /// N at motions and rates at the ports; 0 when it is open.
    pub fn force(&self, p: &AtPorts, rate: &AtPorts) -> f64 {
        self.signed_force(p, rate).max(0.0)
    }
}

/// Which contacts of a head are closed: the dimple and its stops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Closed(u8);

impl Closed {
    /// The dimple alone.
    pub const DIMPLE: Self = Self(1);

    /// With the dimple as it is and every stop open.
    pub fn of_dimple(is_closed: bool) -> Self {
        Self(u8::from(is_closed))
    }

    pub fn dimple(self) -> bool {
        self.0 & 1 != 0
    }

    fn stop(self, k: usize) -> bool {
        self.0 & (2 << k) != 0
    }
}

/// The stops of a head; none by default.
#[derive(Clone, Debug, Default)]
pub(super) struct Stops(Vec<Stop>);

impl Stops {
    /// # Panics
    /// With more than seven.
    pub fn new(stops: Vec<Stop>) -> Self {
        assert!(stops.len() <= MOST);
        Self(stops)
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    pub fn iter(&self) -> std::slice::Iter<'_, Stop> {
        self.0.iter()
    }

    fn closed(&self, closed: Closed) -> impl Iterator<Item = &Stop> {
        let stops = self.0.iter().enumerate();
        stops.filter_map(move |(k, stop)| closed.stop(k).then_some(stop))
    }

    /// `closed` with the state of every stop at (p, rate).
    #[inline]
    pub fn add_closed(&self, p: &AtPorts, rate: &AtPorts, mut closed: Closed) -> Closed {
        for (k, stop) in self.0.iter().enumerate() {
            closed.0 |= u8::from(stop.signed_force(p, rate) > 0.0) << (k + 1);
        }
        closed
    }

    /// Adds the forces at the ports.
    #[inline]
    pub fn add_force(&self, p: &AtPorts, rate: &AtPorts, out: &mut AtPorts) {
        for stop in &self.0 {
            add_along(out, -stop.force(p, rate), &stop.row);
        }
    }

    /// Adds the derivative of −force by p with rate = (p − p_known)/d.
    pub fn add_coupling(&self, d_s: f64, closed: Closed, out: &mut [AtPorts; PORTS]) {
        for stop in self.closed(closed) {
            let contact = stop.stiffness_n_per_m + stop.damping_n_s_per_m / d_s;
            add_square(out, contact, &stop.row);
        }
    }

    /// Adds C/d e of the closed stops, e at the ports.
    pub fn add_filter_load(&self, d_s: f64, closed: Closed, e: &AtPorts, out: &mut AtPorts) {
        for stop in self.closed(closed) {
            let force = stop.damping_n_s_per_m * along(&stop.row, e) / d_s;
            add_along(out, force, &stop.row);
        }
    }
}
