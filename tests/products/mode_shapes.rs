//! Shapes of modes as files: read back, they have their nodes, and are orthonormal in the bodies' masses.

use super::cli::{Done, study};
use super::vtk_series::{array, assert_grid};
use opshock_solver::slider::body::Inertia;
use opshock_solver::suspension::Section;
use opshock_study::study::{SetArg, Study};
use std::path::Path;

/// What both tests run: few modes on a coarse film.
const COARSE: [&str; 2] = ["resolution.film_cells=150", "resolution.disk_cut_khz=9"];

/// Runs `modes --shapes v` on a study of the repository; gives the study and what was printed.
fn shapes(folder: &Path, name: &str, sets: &[&str]) -> (Study, serde_json::Value) {
    let path = study(name);
    let sets = [&COARSE[..], sets].concat();
    let mut arguments = vec!["modes", path.to_str().unwrap(), "--shapes", "v", "--json"];
    arguments.extend(sets.iter().flat_map(|set| ["--set", *set]));
    arguments.extend(["--ramp", "deformable"]);
    let done = Done::of(folder, &arguments);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let parsed: Vec<SetArg> = sets.iter().map(|set| SetArg::parse(set).unwrap()).collect();
    (Study::from_path(&path, &parsed).unwrap(), done.json())
}

/// A grid's text, checked to be one.
fn grid(folder: &Path, body: &str) -> String {
    let text = std::fs::read_to_string(folder.join(format!("v/{body}_modes.vtu"))).unwrap();
    assert_grid(&text);
    text
}

/// Names of the arrays of modes, in order.
fn modes(text: &str) -> Vec<String> {
    let names = text.split("Name=\"").skip(1);
    let names = names.map(|rest| rest.split('"').next().unwrap().to_owned());
    names
        .filter(|name| name.ends_with("_per_sqrt_kg"))
        .collect()
}

/// z of every vector of an array.
fn rise(text: &str, name: &str) -> Vec<f64> {
    let vectors = array(text, name);
    assert!(vectors.chunks(3).all(|v| v[0] == 0.0 && v[1] == 0.0));
    vectors.chunks(3).map(|v| v[2]).collect()
}

/// How often a sign follows the other, what is small beside the largest left out.
fn sign_changes(values: &[f64]) -> usize {
    let largest = values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let signs: Vec<bool> = values
        .iter()
        .filter(|x| x.abs() > 1e-6 * largest)
        .map(|x| *x > 0.0)
        .collect();
    signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

/// Weights of Boole's rule, repeated over each four parts of a length.
fn boole(parts: usize, length: f64) -> Vec<f64> {
    assert!(parts.is_multiple_of(4));
    let weight = |k: usize| match k % 4 {
        0 if k == 0 || k == parts => 7.0,
        0 => 14.0,
        2 => 12.0,
        _ => 32.0,
    };
    let unit = 2.0 * length / (45.0 * parts as f64);
    (0..=parts).map(|k| unit * weight(k)).collect()
}

/// Largest distance of Σ wᵢ aᵢ bᵢ of all pairs from the unit matrix.
fn distance_from_unit(columns: &[Vec<f64>], product: impl Fn(&[f64], &[f64]) -> f64) -> f64 {
    let mut worst = 0.0_f64;
    for (i, a) in columns.iter().enumerate() {
        for (j, b) in columns.iter().enumerate() {
            worst = worst.max((product(a, b) - f64::from(u8::from(i == j))).abs());
        }
    }
    worst
}

/// A file for each body, drawings included, and the modes that are printed in them.
#[test]
fn every_body_has_a_grid_and_a_drawing_with_the_printed_frequencies() {
    let folder = tempfile::tempdir().unwrap();
    let (_, reported) = shapes(folder.path(), "paper-cases", &[]);
    for body in ["disk", "ramp", "suspension", "head"] {
        for ending in ["svg", "png", "csv"] {
            let file = folder.path().join(format!("v/{body}_modes.{ending}"));
            assert!(std::fs::metadata(&file).unwrap().len() > 100, "{file:?}");
        }
    }
    let hz = |body: &str, key: &str| -> Vec<f64> {
        let rows = reported[body].as_array().unwrap().iter();
        rows.map(|row| row[key].as_f64().unwrap()).collect()
    };
    let of_grid = |body: &str| array(&grid(folder.path(), body), "frequency_hz");
    let assert_same = |found: &[f64], reported: &[f64]| {
        assert_eq!(found.len(), reported.len());
        let far = |(a, b): (&f64, &f64)| (a / b - 1.0).abs() > 1e-9;
        assert!(
            !found.iter().zip(reported).any(far),
            "{found:?} {reported:?}"
        );
    };
    assert_same(&of_grid("disk"), &hz("disk", "rotating_frame_hz"));
    assert_same(&of_grid("head"), &hz("head", "frequency_hz"));
    let mut ramp = hz("ramp", "frequency_hz");
    ramp.sort_by(f64::total_cmp);
    assert_same(&of_grid("ramp"), &ramp);
    // The suspension's are those of the finite elements, found again for their shapes.
    let mut suspension = Vec::new();
    for family in [
        "bending_free_hz",
        "bending_pinned_hz",
        "torsion_free_hz",
        "torsion_pinned_hz",
    ] {
        let all = reported["suspension"][family].as_array().unwrap().iter();
        suspension.extend(all.map(|hz| hz.as_f64().unwrap()));
    }
    assert_same(&of_grid("suspension"), &suspension);
}

/// 2 n changes of sign around the rim, as many circles as named along a radius, and ∫ ρ h φᵢ φⱼ dA = δᵢⱼ.
#[test]
fn modes_of_the_disk_have_their_nodes_and_are_orthonormal() {
    let folder = tempfile::tempdir().unwrap();
    let (study, reported) = shapes(folder.path(), "paper-cases", &[]);
    let disk = &study.points[0].scene.disk;
    let text = grid(folder.path(), "disk");
    let points = array(&text, "points");
    // The innermost circle comes first, angle running fastest.
    let radius = |k: usize| points[3 * k].hypot(points[3 * k + 1]);
    let around = (0..)
        .take_while(|&k| radius(k) < disk.inner_radius_m * (1.0 + 1e-9))
        .count();
    let circles = points.len() / 3 / around;
    let weights = boole(circles - 1, disk.outer_radius_m - disk.inner_radius_m);
    let per_area =
        disk.density_kg_per_m3 * disk.thickness_m * std::f64::consts::TAU / around as f64;
    let mut columns = Vec::new();
    let rows = reported["disk"].as_array().unwrap();
    assert_eq!(modes(&text).len(), rows.len());
    assert!(rows.len() >= 10);
    for (name, row) in modes(&text).iter().zip(rows) {
        let (n, c) = (&row["nodal_diameters"], &row["nodal_circles"]);
        assert_eq!(*name, format!("n{n}_c{c}_per_sqrt_kg"));
        let shape = rise(&text, name);
        let mut rim = shape[shape.len() - around..].to_vec();
        rim.push(rim[0]);
        assert_eq!(sign_changes(&rim) as u64, 2 * n.as_u64().unwrap(), "{name}");
        let along: Vec<f64> = shape.iter().step_by(around).copied().collect();
        assert_eq!(sign_changes(&along) as u64, c.as_u64().unwrap(), "{name}");
        assert!(shape[..around].iter().all(|w| *w == 0.0), "clamped");
        columns.push(shape);
    }
    let product = |a: &[f64], b: &[f64]| -> f64 {
        let cells = a.iter().zip(b).enumerate();
        cells
            .map(|(k, (a, b))| per_area * weights[k / around] * radius(k) * a * b)
            .sum()
    };
    let worst = distance_from_unit(&columns, product);
    // The trapezoidal rule is exact around; along the radius Boole's rule of 60 parts is left.
    assert!(worst < 1e-4, "{worst:e}");
}

/// Mode k of a beam held at its root alone has k − 1 nodes, one held at the dimple too rests there; masses
/// and polar inertias per length make the shapes orthonormal.
#[test]
fn modes_of_the_suspension_have_their_nodes_and_are_orthonormal() {
    let folder = tempfile::tempdir().unwrap();
    let (study, _) = shapes(folder.path(), "paper-cases", &[]);
    let suspension = &study.points[0].scene.suspension;
    let text = grid(folder.path(), "suspension");
    let points = array(&text, "points");
    let places: Vec<f64> = points.chunks(6).map(|edge| edge[0]).collect();
    let widths: Vec<f64> = points.chunks(6).map(|edge| edge[4] - edge[1]).collect();
    assert_eq!(places.last().copied(), Some(suspension.load_beam.end_m));
    assert_eq!(widths[0], suspension.hinge.width_m);
    let dimple = places
        .iter()
        .position(|x| *x == suspension.load_beam.dimple_m)
        .unwrap();
    for family in [
        "bending_free",
        "bending_pinned",
        "torsion_free",
        "torsion_pinned",
    ] {
        let is_bending = family.starts_with("bending");
        let names: Vec<String> = modes(&text)
            .into_iter()
            .filter(|n| n.starts_with(family))
            .collect();
        assert!(names.len() >= 8, "{family}");
        let columns: Vec<Vec<f64>> = names
            .iter()
            .map(|name| {
                let edges = rise(&text, name);
                let pairs = edges.chunks(2).zip(&widths);
                pairs
                    .map(|(edge, width)| match is_bending {
                        true => 0.5 * (edge[0] + edge[1]),
                        false => (edge[1] - edge[0]) / width,
                    })
                    .collect()
            })
            .collect();
        for (k, shape) in columns.iter().enumerate() {
            assert_eq!(shape[0], 0.0, "{family}");
            let held = family.ends_with("pinned");
            assert_eq!(held, shape[dimple] == 0.0, "{family} {k}");
            assert!(held || sign_changes(shape) == k, "{family} {k}");
        }
        // Four parts an element; masses per length jump from element to element.
        let product = |a: &[f64], b: &[f64]| -> f64 {
            let mut sum = 0.0;
            for first in (0..places.len() - 1).step_by(4) {
                let length = places[first + 4] - places[first];
                for (k, weight) in boole(4, length).into_iter().enumerate() {
                    let within = length * (k as f64 / 4.0).clamp(1e-6, 1.0 - 1e-6);
                    let section = Section::at(suspension, places[first] + within);
                    let inertia = match is_bending {
                        true => section.mass_kg_per_m,
                        false => section.polar_inertia_kg_m,
                    };
                    sum += weight * inertia * a[first + k] * b[first + k];
                }
            }
            sum
        };
        // Those with many points to a wave.
        let worst = distance_from_unit(&columns[..8], product);
        assert!(worst < 1e-4, "{family} {worst:e}");
    }
}

/// The slider's complex modes: q̂ᴴ J q̂ = 1, and q̂ᵀ J q̂ is real; each moves the four corners as a rigid body.
#[test]
fn modes_of_the_slider_on_its_film_are_of_unit_mass() {
    let folder = tempfile::tempdir().unwrap();
    let (study, _) = shapes(folder.path(), "paper-cases", &[]);
    let slider = &study.points[0].scene.slider;
    let inertia = Inertia::of(slider).diagonal();
    let text = grid(folder.path(), "head");
    let points = array(&text, "points");
    let n = points.len() / 3;
    let side = (n as f64).sqrt() as usize;
    assert_eq!(points[3 * (n - 1)], slider.length_m);
    assert_eq!(points[3 * (n - 1) + 1], slider.width_m);
    assert_eq!(modes(&text).len(), 6);
    for mode in 1..=3 {
        let part = |part: &str| -> [f64; 3] {
            let z = rise(&text, &format!("mode_{mode}_{part}_per_sqrt_kg"));
            let corners = [z[0], z[side - 1], z[n - side], z[n - 1]];
            assert!((corners[0] + corners[3] - corners[1] - corners[2]).abs() < 1e-9 * z[0].abs());
            [
                0.25 * corners.iter().sum::<f64>(),
                // Positive pitch lifts the leading edge, positive roll the outer side.
                (corners[0] - corners[1]) / slider.length_m,
                (corners[2] - corners[0]) / slider.width_m,
            ]
        };
        let (re, im) = (part("real"), part("imaginary"));
        let sum = |of: &dyn Fn(usize) -> f64| (0..3).map(|i| inertia[i] * of(i)).sum::<f64>();
        assert!((sum(&|i| re[i] * re[i] + im[i] * im[i]) - 1.0).abs() < 1e-9);
        assert!(sum(&|i| 2.0 * re[i] * im[i]).abs() < 1e-9);
        assert!(sum(&|i| re[i] * re[i] - im[i] * im[i]) > 0.0);
    }
}

/// A ramp of finite elements: the mesh's nodes move as the reduced modes say at the contacts, and the
/// shapes are orthonormal in the mesh's mass.
#[test]
fn modes_of_a_solid_ramp_are_orthonormal_in_its_mass() {
    let folder = tempfile::tempdir().unwrap();
    let coarse = [
        "ramp.deformable.geometry.mesh_size_mm=2.5",
        "ramp.deformable.geometry.mount_thickness_mm=0.8",
    ];
    let (study, reported) = shapes(folder.path(), "fig13-geometry", &coarse);
    let solid = study.ramp_solid().unwrap().expect("a solid");
    let system = solid.mesh.system(&solid.material, solid.mount).unwrap();
    let text = grid(folder.path(), "ramp");
    let names = modes(&text);
    let nodes = array(&text, "points");
    assert_eq!(nodes, solid.mesh.mesh.nodes_m.concat());
    // Twenty nodes an element.
    assert!(array(&text, "types").iter().all(|kind| *kind == 25.0));
    let columns: Vec<Vec<f64>> = names
        .iter()
        .map(|name| {
            let vectors = array(&text, name);
            let mut unknowns = vec![0.0; system.order()];
            for (k, value) in vectors.iter().enumerate() {
                match system.unknown(k / 3, k % 3) {
                    Some(unknown) => unknowns[unknown] = *value,
                    None => assert_eq!(*value, 0.0, "held"),
                }
            }
            unknowns
        })
        .collect();
    let product = |a: &[f64], b: &[f64]| -> f64 {
        let mass = system.mass.times(b);
        a.iter().zip(mass).map(|(a, b)| a * b).sum()
    };
    let worst = distance_from_unit(&columns, product);
    assert!(worst < 1e-8, "{worst:e}");
    let rows = reported["ramp"].as_array().unwrap();
    assert!(names.len() > 5 && names.len() < rows.len());
    for (name, row) in names.iter().zip(rows) {
        let vectors = array(&text, name);
        for (contact, key) in [
            (&solid.mesh.top, "top_shape_per_sqrt_kg"),
            (&solid.mesh.bottom, "bottom_shape_per_sqrt_kg"),
        ] {
            let shares = contact.nodes.iter();
            let mean: f64 = shares
                .map(|(node, w)| w / contact.area_m2 * vectors[3 * node + 2])
                .sum();
            // Those of the study are rounded to nine digits.
            let reported = row[key].as_f64().unwrap();
            assert!(
                (mean - reported).abs() < 1e-7 * reported.abs().max(1.0),
                "{name}: {mean} {reported}"
            );
        }
    }
}

#[test]
fn shapes_go_nowhere_else_than_into_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("taken"), "a file").unwrap();
    let path = study("paper-cases");
    let modes = |out: &str| {
        let arguments = ["modes", path.to_str().unwrap(), "--shapes", out, "--json"];
        Done::of(folder.path(), &arguments)
    };
    let done = modes("taken");
    assert_eq!((done.code, done.stdout.as_str()), (2, ""));
    let error = &done.errors()[0];
    assert_eq!(
        (&error["key"], &error["value"]),
        (&"--shapes".into(), &"taken".into())
    );
    assert_eq!(
        std::fs::read_to_string(folder.path().join("taken")).unwrap(),
        "a file"
    );
    // A folder below a file cannot be made: reported with its name, and nothing is printed.
    let done = modes("taken/below");
    assert_ne!(done.code, 0);
    assert_eq!(done.stdout, "");
    assert!(done.stderr.contains("taken/below"), "{}", done.stderr);
}
