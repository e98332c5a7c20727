//! Rules for disk, hub, ramp, slider, suspension and gas: geometry that fits, values that a solver can use.

use opshock_solver::gas::{REFERENCE_TEMPERATURE_K, mean_free_path_m};

use super::check::{Check, trim};
use crate::search::Ramp;
use crate::study::fields;
use crate::study::{imported_suspension, ramp_geometry, scene, unit};
use opshock_solid::ramp::{GeometryError, MOST_ELEMENTS, SolidRampError};
use opshock_solid::sparse::SparseError;
use opshock_solver::suspension::ReducedSuspension;

/// Lengths of the slider that a wave of the disk has at least: a plane then misses 8 % of its amplitude at the ends.
const LENGTHS_A_WAVE: f64 = 8.0;

impl Check<'_, '_> {
    pub(super) fn disk_and_ramp(&mut self) {
        let radii = [
            fields::DISK_INNER_RADIUS_MM.path(),
            fields::DISK_OUTER_RADIUS_MM.path(),
        ];
        let mut disk_fits = false;
        if self.sound(&radii) {
            let (inner, outer) = (self.view.number(radii[0]), self.view.number(radii[1]));
            disk_fits = inner < outer;
            if !disk_fits {
                let fault = self.fault(
                    "E140",
                    &radii,
                    format!("the inner radius {inner} mm is not below the outer radius {outer} mm"),
                );
                fault.allowed = "inner_radius_mm < outer_radius_mm".to_string();
            }
        }
        if disk_fits && self.sound(&[fields::RAMP_RADIUS_MM.path()]) {
            let (inner, outer) = (self.view.number(radii[0]), self.view.number(radii[1]));
            let ramp = self.view.number(fields::RAMP_RADIUS_MM.path());
            if ramp <= inner || ramp > outer {
                let side = if ramp > outer {
                    "outside the disk"
                } else {
                    "inside the clamp"
                };
                let fault = self.fault(
                    "E141",
                    &[fields::RAMP_RADIUS_MM.path(), radii[0], radii[1]],
                    format!("the ramp at {ramp} mm is {side}"),
                );
                fault.allowed = format!("> {inner} and <= {outer} mm");
            }
        }
        let contact = [
            fields::RAMP_RESTITUTION.path(),
            fields::RAMP_CONTACT_STIFFNESS_N_PER_M.path(),
        ];
        if self.sound(&contact)
            && self.view.maybe_number(contact[1]).is_some()
            && self.view.number(contact[0]) > 0.0
        {
            let message =
                "restitution belongs to a hard contact, and contact_stiffness_n_per_m is set";
            let fault = self.fault("E136", &contact, message);
            fault.allowed = "restitution = 0, or no contact_stiffness_n_per_m".to_string();
        }
        for path in [
            fields::RAMP_CONTACT_FREQUENCY_KHZ.path(),
            fields::RAMP_CONTACT_DAMPING_RATIO.path(),
        ] {
            let given = self.sound(&[path]) && self.view.maybe_number(path).is_some();
            if given && self.view.maybe_number(contact[1]).is_none() {
                let message = "a hard contact has no spring";
                let fault = self.fault("E136", &[path], message);
                fault.allowed = "with contact_stiffness_n_per_m".to_string();
            }
        }
        for path in [
            fields::RAMP_CLEARANCE_UM.path(),
            fields::RAMP_CLEARANCE_TOP_UM.path(),
            fields::RAMP_CLEARANCE_BOTTOM_UM.path(),
        ] {
            if self.sound(&[path]) && self.view.maybe_number(path) == Some(0.0) {
                let fault = self.fault("N143", &[path], "disk and ramp touch at rest");
                fault.hint = "allowed; contact begins with the shock".to_string();
            }
        }
    }

    /// A hub has both stiffnesses, and moments of inertia that a body can have.
    pub(super) fn hub(&mut self) {
        const STIFFNESSES: [&str; 2] = [
            fields::HUB_AXIAL_STIFFNESS_N_PER_M.path(),
            fields::HUB_TILT_STIFFNESS_N_M_PER_RAD.path(),
        ];
        const REST: [&str; 8] = [
            fields::HUB_MASS_MG.path(),
            fields::HUB_TRANSVERSE_INERTIA_MG_MM2.path(),
            fields::HUB_POLAR_INERTIA_MG_MM2.path(),
            fields::HUB_AXIAL_DAMPING_N_S_PER_M.path(),
            fields::HUB_TILT_DAMPING_N_M_S_PER_RAD.path(),
            fields::HUB_CROSS_STIFFNESS_N_M_PER_RAD.path(),
            fields::HUB_CROSS_DAMPING_N_M_S_PER_RAD.path(),
            fields::HUB_CENTRE_HEIGHT_MM.path(),
        ];
        let given: Vec<&str> = STIFFNESSES
            .into_iter()
            .chain(REST)
            .filter(|path| self.view.settings.has(path))
            .collect();
        self.direction(given.is_empty());
        if given.is_empty() || !self.sound(&STIFFNESSES) || !self.sound(&REST) {
            return;
        }
        let missing: Vec<&str> = STIFFNESSES
            .into_iter()
            .filter(|path| self.view.maybe_number(path).is_none())
            .collect();
        if !missing.is_empty() {
            let message = format!("a hub without {}", missing.join(" and "));
            let fault = self.fault("E112", &given, message);
            fault.allowed = "both stiffnesses of the bearing".to_string();
            fault.hint = "add them, or leave the hub out".to_string();
            return;
        }
        let inertia = |path: &str| self.view.maybe_number(path).unwrap_or(0.0);
        let (transverse, polar) = (inertia(REST[1]), inertia(REST[2]));
        if polar > 2.0 * transverse {
            let message = format!(
                "no body has a polar inertia of {polar} mg mm2 beside a transverse one of {transverse}"
            );
            let fault = self.fault("E137", &[REST[2], REST[1]], message);
            fault.allowed = "polar_inertia_mg_mm2 <= 2 x transverse_inertia_mg_mm2".to_string();
        }
    }

    /// An oblique shock has a hub to tilt.
    fn direction(&mut self, is_clamped: bool) {
        const SHARES: [&str; 4] = [
            fields::PULSE_IN_PLANE_X.path(),
            fields::PULSE_IN_PLANE_Y.path(),
            fields::PULSE_ROTATION_X_PER_M.path(),
            fields::PULSE_ROTATION_Y_PER_M.path(),
        ];
        let given: Vec<&str> = SHARES
            .into_iter()
            .filter(|path| {
                self.view
                    .maybe_number(path)
                    .is_some_and(|share| share != 0.0)
            })
            .collect();
        if is_clamped && !given.is_empty() && self.sound(&SHARES) {
            let message = "an oblique shock on a disk clamped to the base";
            let fault = self.fault("E138", &given, message);
            fault.allowed = "a study with a [hub]".to_string();
            fault.hint = "give the hub's stiffnesses, however large".to_string();
        }
    }

    /// Waves are so long that the slider sees a plane.
    pub(super) fn waves(&mut self) {
        const PATHS: [&str; 2] = [
            fields::SLIDER_RADIUS_MM.path(),
            fields::SLIDER_LENGTH_MM.path(),
        ];
        let waves = 0..self.view.get(&fields::DISK_WAVES);
        let members: Vec<String> = waves
            .map(|entry| fields::DISK_WAVES_HARMONIC.of_entry(entry))
            .collect();
        let paths: Vec<&str> = members.iter().map(String::as_str).collect();
        // An entry that is no table has no members.
        if !self.sound(&PATHS) || !self.sound(&[fields::DISK_WAVES.path()]) {
            return;
        }
        let [radius_mm, length_mm] = PATHS.map(|path| self.view.number(path));
        let round_mm = std::f64::consts::TAU * radius_mm;
        let most = (round_mm / (LENGTHS_A_WAVE * length_mm)).floor();
        for (entry, path) in paths.into_iter().enumerate() {
            let harmonic = f64::from(self.view.entry(entry, &fields::DISK_WAVES_HARMONIC));
            if harmonic > most {
                let message = format!(
                    "waves {:.3} mm long under a slider of {length_mm} mm: too short to be plane along it",
                    round_mm / harmonic
                );
                let fault = self.fault("E126", &[path, PATHS[0], PATHS[1]], message);
                fault.allowed = format!(
                    "at most {most} waves a revolution, each {LENGTHS_A_WAVE} slider lengths long or longer"
                );
            }
        }
    }

    /// Parts of a ramp's geometry fit together, and its model can be solved.
    pub(super) fn ramp_geometry(&mut self) {
        let mut looked_at: Vec<&str> = ramp_geometry::paths().collect();
        looked_at.extend([
            fields::DISK_THICKNESS_MM.path(),
            fields::RAMP_CLEARANCE_UM.path(),
            fields::RAMP_CLEARANCE_TOP_UM.path(),
            fields::RAMP_CLEARANCE_BOTTOM_UM.path(),
        ]);
        let is_wanted = self
            .view
            .get(&fields::RAMP_MODELS)
            .contains(&Ramp::Deformable);
        if !is_wanted || !self.sound(&looked_at) {
            return;
        }
        let is_one_body = ramp_geometry::is_given(self.view)
            || self.view.get(&fields::RAMP_DEFORMABLE_COUPLED_MODES) > 0;
        if is_one_body && self.view.get(&fields::RAMP_DEFORMABLE_BOTTOM_MODES) > 0 {
            let paths = [fields::RAMP_DEFORMABLE_BOTTOM_MODES.path()];
            let message = "modes of the bottom arm beside a geometry, which gives both arms";
            let fault = self.fault("E115", &paths, message);
            fault.allowed = "one of the two".to_string();
            fault.hint = "leave one out".to_string();
        }
        if !ramp_geometry::is_given(self.view) {
            let lonely: Vec<&str> = ramp_geometry::paths()
                .filter(|path| self.view.settings.has(path))
                .collect();
            if !lonely.is_empty() {
                let message = "a ramp's geometry without its material";
                let fault = self.fault("E112", &lonely, message);
                fault.allowed = "a material beside the dimensions".to_string();
                fault.hint = "add material, or leave the geometry out".to_string();
            }
            return;
        }
        let Err(error) = ramp_geometry::modes(&ramp_geometry::solid_ramp(self.view)) else {
            return;
        };
        match error {
            SolidRampError::Geometry(GeometryError::Dimension {
                name,
                value,
                allowed,
            }) => {
                let path = ramp_geometry::path(&format!("{name}_mm"));
                let is_key = looked_at.contains(&path.as_str());
                // A default that does not fit is the fault of what was written.
                let blamed: Vec<&str> = match is_key && self.view.place(&path).is_some() {
                    true => vec![path.as_str()],
                    false => looked_at,
                };
                let message = format!(
                    "the ramp's parts do not fit: {name} is {} mm",
                    trim(1e3 * value)
                );
                self.fault("E173", &blamed, message).allowed = allowed;
            }
            SolidRampError::Geometry(fault @ GeometryError::MeshSize { .. }) => {
                let fault = self.fault(
                    "E174",
                    &[fields::RAMP_DEFORMABLE_GEOMETRY_MESH_SIZE_MM.path()],
                    fault.to_string(),
                );
                fault.allowed = format!("a size of at most {MOST_ELEMENTS} elements");
                fault.hint = "a larger mesh_size_mm".to_string();
            }
            SolidRampError::Sparse(fault @ SparseError::TooManyModes { most, .. }) => {
                let mut keys = looked_at;
                keys.insert(0, fields::RAMP_DEFORMABLE_GEOMETRY_CUT_KHZ.path());
                let fault = self.fault("E174", &keys, fault.to_string());
                fault.allowed = format!("a cut with at most {most} modes below it");
                fault.hint = "a lower cut_khz, or a smaller or stiffer ramp".to_string();
            }
            other => {
                let message = format!("the ramp has no modes: {other}");
                let fault = self.fault("E175", &looked_at, message);
                fault.allowed = "a ramp that can be solved".to_string();
                fault.hint = "another cut_khz or mesh_size_mm".to_string();
            }
        }
    }

    pub(super) fn slider_place(&mut self) {
        let paths = [
            fields::SLIDER_RADIUS_MM.path(),
            fields::SLIDER_LENGTH_MM.path(),
            fields::SLIDER_WIDTH_MM.path(),
            fields::SLIDER_SKEW_DEG.path(),
            fields::DISK_INNER_RADIUS_MM.path(),
            fields::DISK_OUTER_RADIUS_MM.path(),
        ];
        if !self.sound(&paths) {
            return;
        }
        let [radius, length, width, skew_deg, inner, outer] =
            paths.map(|path| self.view.number(path));
        if inner >= outer {
            return;
        }
        let skew = unit::si("skew_deg", skew_deg);
        // Slider axes: the disk moves along (cos skew, sin skew); outward is a quarter turn left.
        let mut over = Vec::new();
        for (x, edge) in [(-0.5 * length, "leading"), (0.5 * length, "trailing")] {
            for (y, side) in [(-0.5 * width, "inner"), (0.5 * width, "outer")] {
                let along = x * skew.cos() + y * skew.sin();
                let outward = y * skew.cos() - x * skew.sin();
                let corner = (radius + outward).hypot(along);
                if corner > outer {
                    over.push(format!(
                        "{edge} {side} corner at radius {corner:.3} mm, beyond the rim"
                    ));
                } else if corner < inner || radius + outward < 0.0 {
                    over.push(format!(
                        "{edge} {side} corner at radius {corner:.3} mm, on the clamp"
                    ));
                }
            }
        }
        if !over.is_empty() {
            let message = format!("the slider hangs over: {}", over.join(", "));
            let fault = self.fault("E142", &paths, message);
            fault.allowed = format!("every corner between {inner} and {outer} mm");
            fault.hint = "move the slider's centre".to_string();
        }
        let ramp = [
            fields::RAMP_RADIUS_MM.path(),
            fields::RAMP_ANGLE_DEG.path(),
            fields::SLIDER_ANGLE_DEG.path(),
        ];
        if self.sound(&ramp)
            && self
                .view
                .get(&fields::RAMP_MODELS)
                .iter()
                .any(|model| *model != Ramp::None)
        {
            let [ramp_radius, ramp_deg, slider_deg] = ramp.map(|path| self.view.number(path));
            let apart = unit::si("angle_deg", ramp_deg - slider_deg);
            let (along, outward) = (
                ramp_radius * apart.sin(),
                ramp_radius * apart.cos() - radius,
            );
            let x = along * skew.cos() - outward * skew.sin();
            let y = along * skew.sin() + outward * skew.cos();
            if x.abs() <= 0.5 * length && y.abs() <= 0.5 * width {
                let fault = self.fault(
                    "W203",
                    &[
                        fields::SLIDER_ANGLE_DEG.path(),
                        fields::SLIDER_RADIUS_MM.path(),
                        fields::RAMP_RADIUS_MM.path(),
                        fields::RAMP_ANGLE_DEG.path(),
                    ],
                    "the ramp's contact point lies under the slider, where no ramp can be",
                );
                fault.allowed = "a contact point outside the slider's outline".to_string();
                fault.hint = "slider.angle_deg and ramp.angle_deg are angles around the spindle; radii are slider.radius_mm and ramp.radius_mm".to_string();
            }
        }
    }

    pub(super) fn suspension(&mut self) {
        let orders: [(&str, &str, bool); 5] = [
            (
                fields::SUSPENSION_HINGE_LENGTH_MM.path(),
                fields::SUSPENSION_LOAD_BEAM_DIMPLE_MM.path(),
                true,
            ),
            (
                fields::SUSPENSION_LOAD_BEAM_DIMPLE_MM.path(),
                fields::SUSPENSION_LOAD_BEAM_END_MM.path(),
                true,
            ),
            (
                fields::SUSPENSION_FLANGE_FROM_MM.path(),
                fields::SUSPENSION_FLANGE_TO_MM.path(),
                true,
            ),
            (
                fields::SUSPENSION_FLANGE_TO_MM.path(),
                fields::SUSPENSION_LOAD_BEAM_END_MM.path(),
                false,
            ),
            (
                fields::SUSPENSION_FLEXURE_FROM_MM.path(),
                fields::SUSPENSION_LOAD_BEAM_END_MM.path(),
                true,
            ),
        ];
        for (low, high, strict) in orders {
            if !self.sound(&[low, high]) {
                continue;
            }
            let (a, b) = (self.view.number(low), self.view.number(high));
            if a > b || (strict && a == b) {
                let sign = if strict { "<" } else { "<=" };
                let fault = self.fault(
                    "E149",
                    &[low, high],
                    format!("{low} is {a} and {high} is {b}, from the root of the hinge"),
                );
                fault.allowed = format!("{low} {sign} {high}");
            }
        }
    }

    /// Modes that take the place of the suspension's geometry move the dimple, and bend or twist.
    pub(super) fn suspension_modes(&mut self) {
        let path = imported_suspension::MODES;
        if !self.sound(&["suspension"]) || self.view.get(&fields::SUSPENSION_MODES) == 0 {
            return;
        }
        let mut suspension = scene::suspension(self.view);
        // A lift tab is another rule's.
        suspension.lift_tab = None;
        if let Err(error) = ReducedSuspension::build(&suspension, 1) {
            let fault = self.fault("E180", &[path], error.to_string());
            fault.allowed = "modes that bend or twist, some of each moving the dimple".to_string();
        }
    }

    /// A mean free path given by hand that is far from what pressure and viscosity imply for air:
    /// often a pressure was changed and the path forgotten.
    pub(super) fn gas(&mut self) {
        let path = fields::GAS_MEAN_FREE_PATH_NM.path();
        let Some(given_m) = self.view.get(&fields::GAS_MEAN_FREE_PATH_NM) else {
            return;
        };
        if !self.sound(&["gas"]) {
            return;
        }
        let gas = scene::gas_parameters(self.view);
        let temperature_k = self
            .view
            .get(&fields::GAS_TEMPERATURE_C)
            .unwrap_or(REFERENCE_TEMPERATURE_K);
        let air_m = mean_free_path_m(gas.viscosity_pa_s, gas.pressure_pa, temperature_k);
        if !(0.8..=1.25).contains(&(given_m / air_m)) {
            let fault = self.fault(
                "N117",
                &[path],
                format!(
                    "air at this pressure and viscosity has a mean free path of {:.1} nm",
                    air_m * 1e9
                ),
            );
            fault.hint = "leave it out for air; keep it for another gas".to_string();
        }
    }
}
