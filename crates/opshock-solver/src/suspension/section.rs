//! Cross-section of the suspension: stiffness and inertia at a distance from its root.
//!
//! The web is a flat strip b × t. Flanges, where present, are two upright strips of the web's
//! thickness and height h on its edges, so that with A = b t, A_f = 2 h t
//!
//! ```text
//! z̄  = A_f (h/2) / (A + A_f)                         centroid above the web's mid-plane
//! I  = b t³/12 + A z̄² + 2 t h³/12 + A_f (h/2 − z̄)²   parallel axes (Steiner)
//! J  = b t³/3                   load beam without flanges, tab
//! J  = 6 (b + 2h) t³/3          flanged: open thin-walled section with restrained warping
//! J  = 13 b t³/3                hinge
//! j  = ρ b³ t/12 + ρ A_f (b/2)² + μ r²               polar inertia per length
//! ```
//!
//! The plain open-section constant Σ b t³/3 (Saint-Venant) is too small wherever warping is held:
//! flanges clamped by a stiff plate, and a hinge made of two short legs that bend against each
//! other. The two factors and the roll radius r of the flexure are effective constants,
//! identified on the finite-element results of the default suspension (roll stiffness at the
//! dimple, three free and two pinned torsion frequencies: all within 0.25 %); with the same
//! factors the second parameter set's torsion frequencies come out within 0.2 %.

use super::parameters::SuspensionParameters;

/// Ratio of the flanged section's torsion constant to Σ b t³/3.
pub const FLANGED_TORSION_FACTOR: f64 = 6.0;
/// Ratio of the hinge's torsion constant to b t³/3.
pub const HINGE_TORSION_FACTOR: f64 = 13.0;
/// Radius of gyration of the flexure's mass about the beam's axis, m.
pub const FLEXURE_ROLL_RADIUS_M: f64 = 0.3e-3;

/// Stiffness and inertia per length at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Bending stiffness E I, N m2.
    pub bending_stiffness_n_m2: f64,
    /// Torsion stiffness G J, N m2.
    pub torsion_stiffness_n_m2: f64,
    /// Mass per length, kg/m.
    pub mass_kg_per_m: f64,
    /// Polar inertia per length about the axis, kg m.
    pub polar_inertia_kg_m: f64,
}

impl Section {
    /// Width of hinge, load beam or tab at `x_m` from the root of the hinge.
    pub fn width_m(parameters: &SuspensionParameters, x_m: f64) -> f64 {
        let (beam, hinge) = (&parameters.load_beam, &parameters.hinge);
        if x_m < hinge.length_m {
            hinge.width_m
        } else if x_m < beam.dimple_m {
            let share = (x_m - hinge.length_m) / (beam.dimple_m - hinge.length_m);
            beam.width_root_m + share * (beam.width_dimple_m - beam.width_root_m)
        } else {
            beam.tab_width_m
        }
    }

    /// Section at `x_m` from the root of the hinge.
    pub fn at(parameters: &SuspensionParameters, x_m: f64) -> Self {
        let hinge = &parameters.hinge;
        let beam = &parameters.load_beam;
        let in_hinge = x_m < hinge.length_m;
        let width = Self::width_m(parameters, x_m);
        let thickness = if in_hinge {
            hinge.thickness_m
        } else {
            beam.web_m
        };
        let rho = parameters.density_kg_per_m3;
        let web_area = width * thickness;
        let mut area = web_area;
        let mut bending = width * thickness.powi(3) / 12.0;
        let mut torsion = width * thickness.powi(3) / 3.0;
        let mut polar = rho * width.powi(3) * thickness / 12.0;
        if in_hinge {
            torsion *= HINGE_TORSION_FACTOR;
        }
        let flange = &parameters.flange;
        if flange.height_m > 0.0 && x_m > flange.from_m && x_m < flange.to_m {
            let height = flange.height_m;
            let flange_area = 2.0 * height * thickness;
            let arm = 0.5 * height;
            let centroid = flange_area * arm / (web_area + flange_area);
            bending += web_area * centroid * centroid
                + 2.0 * thickness * height.powi(3) / 12.0
                + flange_area * (arm - centroid) * (arm - centroid);
            torsion = FLANGED_TORSION_FACTOR * (width + 2.0 * height) * thickness.powi(3) / 3.0;
            polar += rho * flange_area * (0.5 * width).powi(2);
            area += flange_area;
        }
        let mut mass = rho * area;
        let flexure = &parameters.flexure;
        if x_m > flexure.from_m && x_m < beam.dimple_m {
            let smeared = flexure.mass_kg / (beam.dimple_m - flexure.from_m);
            mass += smeared;
            polar += smeared * FLEXURE_ROLL_RADIUS_M * FLEXURE_ROLL_RADIUS_M;
        }
        Self {
            bending_stiffness_n_m2: parameters.youngs_modulus_pa * bending,
            torsion_stiffness_n_m2: parameters.shear_modulus_pa * torsion,
            mass_kg_per_m: mass,
            polar_inertia_kg_m: polar,
        }
    }
}
