//! Finite elements of the suspension as a beam clamped at its root.
//!
//! Bending: Hermite cubics in (w, w') per node, Euler-Bernoulli. Torsion: linear in the twist.
//! Sections vary inside an element and are integrated by four Gauss points, so the only error is
//! that of the shape functions; element ends lie on every jump of the section and on the dimple.

use nalgebra::{DMatrix, DVector};

use super::error::SuspensionError;
use super::modes::Clamped;
use super::parameters::SuspensionParameters;
use super::section::Section;

/// Longest element, m.
const ELEMENT_M: f64 = 0.4e-3;

/// Assembled matrices of the clamped beam; the root's degrees of freedom are removed.
///
/// Bending unknowns: (w, w') of node 1, 2, ...; torsion unknowns: twist of node 1, 2, ...
#[derive(Clone, Debug)]
pub struct BeamMatrices {
    /// Distances of the nodes from the root, root included, m.
    pub nodes_m: Vec<f64>,
    /// Bending stiffness.
    pub bending_stiffness: DMatrix<f64>,
    /// Bending mass.
    pub bending_mass: DMatrix<f64>,
    /// Load of a unit inertia load per mass on the bending unknowns.
    pub inertia_load: DVector<f64>,
    /// Torsion stiffness.
    pub torsion_stiffness: DMatrix<f64>,
    /// Torsion inertia.
    pub torsion_mass: DMatrix<f64>,
    /// Bending unknown that is the dimple's z; the next one is its slope dw/dx.
    pub dimple_bending: usize,
    /// Torsion unknown that is the dimple's roll.
    pub dimple_torsion: usize,
    /// Mass of hinge, load beam and flexure, kg.
    pub mass_kg: f64,
}

/// Assembled matrices of the beam with its root free to move.
///
/// Bending unknowns: (w, w') of the root, node 1, 2, ...; torsion unknowns: twist of the root, ...
#[derive(Clone, Debug)]
pub struct RootedBeam {
    /// Distances of the nodes from the root, root included, m.
    pub nodes_m: Vec<f64>,
    /// Bending stiffness.
    pub bending_stiffness: DMatrix<f64>,
    /// Bending mass.
    pub bending_mass: DMatrix<f64>,
    /// Load of a unit inertia load per mass on the bending unknowns.
    pub inertia_load: DVector<f64>,
    /// Torsion stiffness.
    pub torsion_stiffness: DMatrix<f64>,
    /// Torsion inertia.
    pub torsion_mass: DMatrix<f64>,
    /// Node of the dimple, the root being 0.
    pub dimple: usize,
    /// Mass of hinge, load beam and flexure, kg.
    pub mass_kg: f64,
}

impl RootedBeam {
    /// Meshes and assembles `parameters`.
    ///
    /// # Errors
    /// A dimension that is not positive, or places out of order.
    pub fn assemble(parameters: &SuspensionParameters) -> Result<Self, SuspensionError> {
        validate(parameters)?;
        let nodes = mesh(parameters);
        let n = nodes.len() - 1;
        let mut bending_stiffness = DMatrix::zeros(2 * n + 2, 2 * n + 2);
        let mut bending_mass = bending_stiffness.clone();
        let mut inertia_load = DVector::zeros(2 * n + 2);
        let mut torsion_stiffness = DMatrix::zeros(n + 1, n + 1);
        let mut torsion_mass = torsion_stiffness.clone();
        let mut mass_kg = 0.0;
        for (e, ends) in nodes.windows(2).enumerate() {
            let length = ends[1] - ends[0];
            for (s, weight) in GAUSS_4 {
                let section = Section::at(parameters, ends[0] + s * length);
                let w = weight * length;
                let shape = hermite(s, length);
                let curvature = hermite_curvature(s, length);
                for i in 0..4 {
                    for j in 0..4 {
                        bending_stiffness[(2 * e + i, 2 * e + j)] +=
                            w * section.bending_stiffness_n_m2 * curvature[i] * curvature[j];
                        bending_mass[(2 * e + i, 2 * e + j)] +=
                            w * section.mass_kg_per_m * shape[i] * shape[j];
                    }
                    inertia_load[2 * e + i] += w * section.mass_kg_per_m * shape[i];
                }
                let (twist, gradient) = ([1.0 - s, s], [-1.0 / length, 1.0 / length]);
                for i in 0..2 {
                    for j in 0..2 {
                        torsion_stiffness[(e + i, e + j)] +=
                            w * section.torsion_stiffness_n_m2 * gradient[i] * gradient[j];
                        torsion_mass[(e + i, e + j)] +=
                            w * section.polar_inertia_kg_m * twist[i] * twist[j];
                    }
                }
                mass_kg += w * section.mass_kg_per_m;
            }
        }
        let dimple = nodes
            .iter()
            .position(|&x| x == parameters.load_beam.dimple_m)
            .expect("the mesh has a node on the dimple");
        Ok(Self {
            bending_stiffness,
            bending_mass,
            inertia_load,
            torsion_stiffness,
            torsion_mass,
            dimple,
            nodes_m: nodes,
            mass_kg,
        })
    }
}

impl BeamMatrices {
    /// Meshes and assembles `parameters`, and holds the root.
    ///
    /// # Errors
    /// A dimension that is not positive, or places out of order.
    pub fn assemble(parameters: &SuspensionParameters) -> Result<Self, SuspensionError> {
        let whole = RootedBeam::assemble(parameters)?;
        let n = whole.nodes_m.len() - 1;
        let bending = |matrix: &DMatrix<f64>| matrix.view((2, 2), (2 * n, 2 * n)).into_owned();
        let torsion = |matrix: &DMatrix<f64>| matrix.view((1, 1), (n, n)).into_owned();
        Ok(Self {
            bending_stiffness: bending(&whole.bending_stiffness),
            bending_mass: bending(&whole.bending_mass),
            inertia_load: whole.inertia_load.rows(2, 2 * n).into_owned(),
            torsion_stiffness: torsion(&whole.torsion_stiffness),
            torsion_mass: torsion(&whole.torsion_mass),
            dimple_bending: 2 * (whole.dimple - 1),
            dimple_torsion: whole.dimple - 1,
            nodes_m: whole.nodes_m,
            mass_kg: whole.mass_kg,
        })
    }

    /// Equations of bending and torsion in the form that the reduction needs.
    pub(super) fn clamped(self) -> [Clamped; 2] {
        let n = self.bending_mass.nrows();
        let mut slope = DVector::zeros(n);
        slope[self.dimple_bending + 1] = 1.0;
        let n_twists = self.torsion_mass.nrows();
        [
            Clamped {
                stiffness: self.bending_stiffness,
                mass: self.bending_mass,
                load: self.inertia_load,
                interface: self.dimple_bending,
                slope,
                tab: Some(n - 2),
            },
            Clamped {
                stiffness: self.torsion_stiffness,
                mass: self.torsion_mass,
                load: DVector::zeros(n_twists),
                interface: self.dimple_torsion,
                slope: DVector::zeros(n_twists),
                tab: None,
            },
        ]
    }
}

/// Points and weights of four-point Gauss quadrature on [0, 1].
const GAUSS_4: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

pub(super) fn hermite(s: f64, length: f64) -> [f64; 4] {
    let (s2, s3) = (s * s, s * s * s);
    [
        1.0 - 3.0 * s2 + 2.0 * s3,
        length * (s - 2.0 * s2 + s3),
        3.0 * s2 - 2.0 * s3,
        length * (s3 - s2),
    ]
}

fn hermite_curvature(s: f64, length: f64) -> [f64; 4] {
    let l2 = length * length;
    [
        (-6.0 + 12.0 * s) / l2,
        (-4.0 + 6.0 * s) / length,
        (6.0 - 12.0 * s) / l2,
        (6.0 * s - 2.0) / length,
    ]
}

fn mesh(parameters: &SuspensionParameters) -> Vec<f64> {
    let mut breaks = vec![
        0.0,
        parameters.hinge.length_m,
        parameters.load_beam.dimple_m,
        parameters.load_beam.end_m,
        parameters.flexure.from_m,
    ];
    if parameters.flange.height_m > 0.0 {
        breaks.extend([parameters.flange.from_m, parameters.flange.to_m]);
    }
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    let mut nodes = vec![0.0];
    for ends in breaks.windows(2) {
        let length = ends[1] - ends[0];
        let n = (length / ELEMENT_M).ceil().max(1.0) as usize;
        nodes.extend((1..n).map(|i| ends[0] + length * i as f64 / n as f64));
        nodes.push(ends[1]);
    }
    nodes
}

fn validate(parameters: &SuspensionParameters) -> Result<(), SuspensionError> {
    let (hinge, beam) = (&parameters.hinge, &parameters.load_beam);
    for (quantity, value) in [
        ("hinge length", hinge.length_m),
        ("hinge width", hinge.width_m),
        ("hinge thickness", hinge.thickness_m),
        ("load beam web thickness", beam.web_m),
        ("load beam width at the root", beam.width_root_m),
        ("load beam width at the dimple", beam.width_dimple_m),
        ("tab width", beam.tab_width_m),
        ("Young's modulus", parameters.youngs_modulus_pa),
        ("shear modulus", parameters.shear_modulus_pa),
        ("density", parameters.density_kg_per_m3),
    ] {
        // A negated comparison, so that NaN is rejected too.
        if !(value > 0.0 && value.is_finite()) {
            return Err(SuspensionError::NotPositive { quantity, value });
        }
    }
    for (quantity, value) in [
        ("flange height", parameters.flange.height_m),
        ("flexure mass", parameters.flexure.mass_kg),
        ("start of the flexure", parameters.flexure.from_m),
    ] {
        if !(value >= 0.0 && value.is_finite()) {
            return Err(SuspensionError::NotPositive { quantity, value });
        }
    }
    let mut order = vec![
        (
            "the hinge's end",
            hinge.length_m,
            "the dimple",
            beam.dimple_m,
        ),
        (
            "the dimple",
            beam.dimple_m,
            "the end of the tab",
            beam.end_m,
        ),
        (
            "the start of the flexure",
            parameters.flexure.from_m,
            "the dimple",
            beam.dimple_m,
        ),
    ];
    if parameters.flange.height_m > 0.0 {
        let flange = &parameters.flange;
        order.push(("the flange's start", flange.from_m, "its end", flange.to_m));
        order.push((
            "the flange's end",
            flange.to_m,
            "the end of the tab",
            beam.end_m,
        ));
        order.push((
            "the root",
            -f64::MIN_POSITIVE,
            "the flange's start",
            flange.from_m,
        ));
    }
    for (first, first_m, second, second_m) in order {
        if !(first_m < second_m && second_m.is_finite()) {
            return Err(SuspensionError::OutOfOrder {
                first,
                first_m,
                second,
                second_m,
            });
        }
    }
    Ok(())
}
