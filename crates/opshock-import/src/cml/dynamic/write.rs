//! Writes a dynamic run as `DynLULS.def`: all values that are read, with every digit, in 19 sections.

use super::contents::{Contents, DynamicFile, FUKUI_KANEKO, SHAPES};
use super::layout::{self, SECTIONS};
use std::fmt::Write as _;

/// The file. Sections that are not read get a name and a zero; names unknown to the reader are opshock's own.
pub fn write(file: &DynamicFile) -> String {
    let mut text = format!(
        "CML Version {} dynamic load, unload, shock\nwritten by opshock\n",
        file.version
    );
    for (at, (title, _)) in SECTIONS.iter().enumerate() {
        let _ = writeln!(text, "***** {title} *****");
        for (names, values) in section(file, at) {
            let _ = writeln!(text, "{names}\n{values}");
        }
    }
    text
}

/// Lines of names and of values.
fn section(file: &DynamicFile, at: usize) -> Vec<(&'static str, String)> {
    match at {
        layout::PROBLEM => {
            let [x, y, z] = file.centre;
            let [load_x, load_y] = file.load_point_m;
            let [first, last] = file.move_radii_m;
            vec![
                (
                    "xl(m) yl/xl xg yg zg",
                    row(&[file.length_m, file.width_per_length, x, y, z]),
                ),
                (
                    "f0(kg) xf0(m) yf0(m)",
                    row(&[file.load_kgf, load_x, load_y]),
                ),
                (
                    "halt rpm dt(s) tf(s)",
                    row(&[file.halt, file.speed_rpm, file.step_s, file.end_s]),
                ),
                (
                    "ra(m) ra_if(m) ra_of(m)",
                    row(&[file.radius_m, first, last]),
                ),
            ]
        }
        layout::ACTUATOR => {
            let [mode, distance, speed] = file.actuator;
            let values = [mode, file.arm_m, distance, speed, file.skew_deg];
            vec![("iact xact(m) dact vact skew(deg)", row(&values))]
        }
        layout::ATTITUDE => vec![("hm hp hr dx dy yaw", row(&file.attitude))],
        layout::SOLVER => {
            let values = format!("{FUKUI_KANEKO} 1e-7 1e-3 1");
            vec![("iqpo akmax emax idisc", values)]
        }
        layout::AIR => match &file.gas {
            Some(gas) => {
                let values = [gas.pressure_pa, gas.mean_free_path_m, gas.viscosity_pa_s];
                vec![("p0(Pa) al(m) vis(Pa.s)", row(&values))]
            }
            None => nothing(),
        },
        layout::SHOCK => match &file.shock {
            Some(shock) => {
                let number = SHAPES.iter().find(|(_, shape)| *shape == shock.shape);
                let number = number.map_or(0, |(number, _)| *number);
                let values = [
                    shock.start_s,
                    shock.width_s,
                    shock.magnitude_g,
                    shock.time_constant_s,
                ];
                let names = "mode start(s) width(s) magnitude(G) time_constant(s)";
                vec![(names, format!("{number} {}", row(&values)))]
            }
            None => nothing(),
        },
        layout::MATRICES => match &file.suspension {
            Contents::Suspension(found) => {
                let values = format!("{} 1 {}", found.n_rows, found.slider_row);
                vec![("size dtfac slider_freedom", values)]
            }
            Contents::Unknown | Contents::Deck(_) => nothing(),
        },
        layout::DISK => {
            let (disk, ramp) = (&file.disk, &file.ramp);
            let [inner, outer] = disk.radii_m;
            let material = [disk.youngs_modulus_pa, disk.poisson, disk.density_kg_per_m3];
            let place = [ramp.distance_m, ramp.angle_deg, ramp.clearance_m];
            vec![
                ("option", "1".to_owned()),
                (
                    "inner(m) outer(m) thickness(m)",
                    row(&[inner, outer, disk.thickness_m]),
                ),
                ("E(Pa) nu rho(kg/m3)", row(&material)),
                ("x_ramp(m) ramp_ang(deg) ramp_clr(m)", row(&place)),
                ("elements_radial elements_around", "10 36".to_owned()),
                ("newmark_beta newmark_gamma", "0.25 0.5".to_owned()),
                (
                    "rayleigh_mass(1/s) rayleigh_stiffness(s)",
                    row(&[disk.alpha_per_s, disk.beta_s]),
                ),
            ]
        }
        _ => nothing(),
    }
}

/// Of a section that is not read, and of a shock or a matrix that is not there.
fn nothing() -> Vec<(&'static str, String)> {
    vec![("none", "0".to_owned())]
}

fn row(values: &[f64]) -> String {
    let words: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
    words.join(" ")
}
