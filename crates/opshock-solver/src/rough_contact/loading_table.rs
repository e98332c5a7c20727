//! The pressure of surfaces that were never closer, as a table.
//!
//! Cubic Hermite interpolation of ln p over the distance in units of the roughness, by values and slopes of the integral. ln p bends
//! so little that its fourth derivative stays below some tenths: with a spacing of 1/32 the error is some 1e-9 up to 4. Farther out,
//! where the pressure is below 1e-5 of that at 0, the end of the heights bends it: the error is 1e-8 at 6 and 4e-3 at 8.

/// Entries per unit.
const PER_UNIT: f64 = 32.0;

/// ln p and its slope at equal distances.
#[derive(Clone, Debug, Default)]
pub(super) struct LoadingTable {
    first: f64,
    entries: Vec<[f64; 2]>,
}

impl LoadingTable {
    /// Between two places, by the pressure and its slope at a place, both not zero.
    pub(super) fn new([first, last]: [f64; 2], at: impl Fn(f64) -> [f64; 2]) -> Self {
        let n = ((last - first) * PER_UNIT).floor() as u32;
        let entries = (0..=n).map(|k| {
            let [pressure, slope] = at(first + f64::from(k) / PER_UNIT);
            [pressure.ln(), slope / pressure / PER_UNIT]
        });
        Self {
            first,
            entries: entries.collect(),
        }
    }

    /// Pressure and slope at `x`; `None` outside the table.
    #[inline]
    pub(super) fn at(&self, x: f64) -> Option<[f64; 2]> {
        let place = (x - self.first) * PER_UNIT;
        let first = (place >= 0.0).then_some(place as usize)?;
        let [before, rising] = *self.entries.get(first)?;
        let [after, leaving] = *self.entries.get(first + 1)?;
        let t = place.fract();
        // before + t (rising + t (bend + t twist)), with the value and slope of both ends.
        let rise = after - before;
        let twist = rising + leaving - 2.0 * rise;
        let bend = rise - rising - twist;
        let log = t.mul_add(t.mul_add(t.mul_add(twist, bend), rising), before);
        let slope = t.mul_add(3.0 * twist * t + 2.0 * bend, rising);
        let pressure = log.exp();
        Some([pressure, pressure * slope * PER_UNIT])
    }
}
