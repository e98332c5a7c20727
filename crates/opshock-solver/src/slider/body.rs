//! Rigid body of the slider: a homogeneous box turning about its centre of mass.
//!
//! ```text
//! m = ρ L W T,   J_pitch = m (L² + T²)/12,   J_roll = m (W² + T²)/12
//! ```

use super::parameters::SliderParameters;

/// Mass and moments of inertia in the order heave, pitch, roll.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Moment of inertia about the y axis through the centre, kg m2.
    pub pitch_kg_m2: f64,
    /// Moment of inertia about the x axis through the centre, kg m2.
    pub roll_kg_m2: f64,
}

impl Inertia {
    /// Inertia of `slider`.
    pub fn of(slider: &SliderParameters) -> Self {
        let [l, w, t] = [slider.length_m, slider.width_m, slider.height_m];
        let mass = slider.density_kg_per_m3 * l * w * t;
        Self {
            mass_kg: mass,
            pitch_kg_m2: mass * (l * l + t * t) / 12.0,
            roll_kg_m2: mass * (w * w + t * t) / 12.0,
        }
    }

    /// Diagonal of the mass matrix in the order heave, pitch, roll.
    pub fn diagonal(&self) -> [f64; 3] {
        [self.mass_kg, self.pitch_kg_m2, self.roll_kg_m2]
    }
}
