//! Attitudes that shocks compress a film into, and variables in which a grid's defect is smooth.
//!
//! Most of the load of a compressed film sits at the trailing edge, between the two points that come closest when the
//! slider rolls either way. With their heights h₁ and h₂ over the disk and the minimum film height h₀ the variables are
//!
//! ```text
//! x = ½ ln (h₁ + h₀)(h₂ + h₀),   y = θ − θ_eq(½ (h₁ + h₂)),   w = ½ ln (h₁ + h₀)/(h₂ + h₀)
//! ```
//!
//! with the pitch θ and its equilibrium value θ_eq under a larger or smaller load, each over half its range. For an
//! attitude outside the range, the nearest attitude inside is taken. Where wind across the slider rolls it, the range
//! of ½ (h₁ − h₂) is centred on its equilibrium value as well.

use crate::air_bearing::attitude::Attitude;

/// Most by which the two points' heights differ in equilibrium, as a share of their sum.
const MOST_LEAN: f64 = 0.8;

/// Attitudes that samples fill.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(in crate::air_bearing) struct Range {
    /// Minimum film height h₀, m.
    pub(in crate::air_bearing) min_height_m: f64,
    /// Heights of the two points: at zero attitude, m, and derivatives by (h_c, pitch, roll).
    pub(in crate::air_bearing) points: [(f64, [f64; 3]); 2],
    /// Lowest and highest mean height of the points, m.
    pub(in crate::air_bearing) heights_m: [f64; 2],
    /// Largest half difference of their heights, m.
    pub(in crate::air_bearing) lean_m: f64,
    /// θ_eq at three logarithms of the mean height, rad.
    pub(in crate::air_bearing) equilibrium: Parabola,
    /// The half difference of the points' heights in equilibrium, m; zero without wind across.
    pub(in crate::air_bearing) leaning: Parabola,
    /// Largest distance of pitch from θ_eq, rad.
    pub(in crate::air_bearing) pitch_rad: f64,
}

/// A number with its derivatives by (h_c, pitch, roll).
#[derive(Clone, Copy)]
pub(in crate::air_bearing) struct Varying(pub f64, pub [f64; 3]);

impl Varying {
    /// f of this one, given f and f'.
    fn of(self, value: f64, slope: f64) -> Self {
        Self(value, self.1.map(|by| slope * by))
    }

    /// a of this one and b of another.
    fn mixed(self, a: f64, other: Self, b: f64) -> Self {
        let by = std::array::from_fn(|q| a * self.1[q] + b * other.1[q]);
        Self(a * self.0 + b * other.0, by)
    }

    fn clamped(self, low: f64, high: f64) -> Self {
        match self.0 {
            x if x < low => Self(low, [0.0; 3]),
            x if x > high => Self(high, [0.0; 3]),
            _ => self,
        }
    }

    fn ln(self) -> Self {
        self.of(self.0.ln(), 1.0 / self.0)
    }
}

impl Range {
    /// Bounds of the half difference of the points' heights at a mean height: neither point lies in the disk.
    fn leans(&self, mean: Varying) -> [Varying; 2] {
        let above_floor = Varying(mean.0 + self.min_height_m, mean.1);
        let (centre_m, slope) = self.leaning.at(above_floor.0.ln());
        let most_m = MOST_LEAN * mean.0;
        let centre = match centre_m.abs() > most_m {
            true => mean.of(most_m.copysign(centre_m), MOST_LEAN.copysign(centre_m)),
            false => above_floor.of(centre_m, slope / above_floor.0),
        };
        [-1.0, 1.0].map(|sense: f64| {
            let limit = Varying(centre.0 + sense * self.lean_m, centre.1);
            match sense * limit.0 > mean.0 {
                true => mean.of(sense * mean.0, sense),
                false => limit,
            }
        })
    }

    /// The attitude at shares from -1 to 1 of the ranges of height, pitch and roll.
    pub(in crate::air_bearing) fn attitude(&self, [high, up, aside]: [f64; 3]) -> Attitude {
        let [low_m, high_m] = self.heights_m.map(|h| (h + self.min_height_m).ln());
        let logarithm = 0.5 * ((low_m + high_m) + high * (high_m - low_m));
        let mean_m = logarithm.exp() - self.min_height_m;
        let [least, most] = self.leans(Varying(mean_m, [0.0; 3]));
        let lean_m = 0.5 * (least.0 + most.0) + aside * (0.5 * (most.0 - least.0));
        let pitch_rad = self.equilibrium.at(logarithm).0 + up * self.pitch_rad;
        // Heights of the points are mean + lean and mean - lean: two equations for roll and height.
        let [(first_m, [_, a, b]), (second_m, [_, c, d])] = self.points;
        let rise_m = 2.0 * lean_m - (first_m - second_m) - pitch_rad * (a - c);
        let roll_rad = rise_m / (b - d);
        Attitude {
            centre_height_m: mean_m + lean_m - first_m - pitch_rad * a - roll_rad * b,
            pitch_rad,
            roll_rad,
        }
    }

    /// Variables of the polynomial, of the order of 1, at the nearest attitude in the range.
    pub(in crate::air_bearing) fn variables(&self, attitude: &Attitude) -> [Varying; 3] {
        let heights = self
            .points
            .map(|(form_m, arms)| Varying(form_m + height(attitude, &arms), arms));
        let [first, second] = heights;
        let [low_m, high_m] = self.heights_m;
        let mean = first.mixed(0.5, second, 0.5).clamped(low_m, high_m);
        let lean = first.mixed(0.5, second, -0.5);
        // On the limit of the range, which follows the mean height where a point touches.
        let [least, most] = self.leans(mean);
        let lean = match lean.0 {
            x if x < least.0 => least,
            x if x > most.0 => most,
            _ => lean,
        };
        let above = |sense: f64| {
            let height = mean.mixed(1.0, lean, sense);
            Varying(height.0 + self.min_height_m, height.1).ln()
        };
        let (first, second) = (above(1.0), above(-1.0));
        let logarithm = Varying(mean.0 + self.min_height_m, mean.1).ln();
        let (pitch_rad, slope) = self.equilibrium.at(logarithm.0);
        let up = Varying(attitude.pitch_rad, [0.0, 1.0, 0.0]);
        let up = up.mixed(1.0, logarithm.of(pitch_rad, slope), -1.0);
        let up = up.clamped(-self.pitch_rad, self.pitch_rad);
        let [low, high] = self.heights_m.map(|h| (h + self.min_height_m).ln());
        let half = 0.5 * (high - low);
        let x = first.mixed(0.5 / half, second, 0.5 / half);
        [
            Varying(x.0 - 0.5 * (low + high) / half, x.1),
            up.of(up.0 / self.pitch_rad, 1.0 / self.pitch_rad),
            first.mixed(0.5 / half, second, -0.5 / half),
        ]
    }
}

/// Height of the reference plane at a point with these derivatives by (h_c, pitch, roll), m.
pub(in crate::air_bearing) fn height(
    attitude: &Attitude,
    [by_h, by_pitch, by_roll]: &[f64; 3],
) -> f64 {
    by_h * attitude.centre_height_m + by_pitch * attitude.pitch_rad + by_roll * attitude.roll_rad
}

/// Parabola in Newton's form (points and divided differences), optionally constant outside its points.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(in crate::air_bearing) struct Parabola {
    places: [f64; 3],
    differences: [f64; 3],
    inside: [f64; 2],
}

impl Parabola {
    /// Through three points.
    pub(in crate::air_bearing) fn through([a, b, c]: [(f64, f64); 3]) -> Self {
        let slope = |p: (f64, f64), q: (f64, f64)| (q.1 - p.1) / (q.0 - p.0);
        let bend = (slope(b, c) - slope(a, b)) / (c.0 - a.0);
        Self {
            places: [a.0, b.0, c.0],
            differences: [a.1, slope(a, b), bend],
            inside: [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    /// The same everywhere.
    pub(in crate::air_bearing) fn level(value: f64) -> Self {
        Self {
            places: [0.0, 1.0, 2.0],
            differences: [value, 0.0, 0.0],
            inside: [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    /// The same, constant outside its points.
    pub(in crate::air_bearing) fn inside(self) -> Self {
        let [a, b, c] = self.places;
        let inside = [a.min(b).min(c), a.max(b).max(c)];
        Self { inside, ..self }
    }

    /// Value and derivative at a place.
    pub(in crate::air_bearing) fn at(&self, x: f64) -> (f64, f64) {
        let [least, most] = self.inside;
        let level = x < least || x > most;
        let x = x.clamp(least, most);
        let [constant, linear, quadratic] = self.differences;
        let (from_a, from_b) = (x - self.places[0], x - self.places[1]);
        let slope = linear + quadratic * (from_a + from_b);
        (
            constant + from_a * (linear + from_b * quadratic),
            if level { 0.0 } else { slope },
        )
    }
}
