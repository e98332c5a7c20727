//! Writes the study that `opshock new` prints.

/// A short, valid study with a name.
pub fn text(name: &str) -> String {
    // Quotes, backslashes and control characters would end or break the TOML string.
    let name: String = name
        .chars()
        .filter(|c| !c.is_control() && !"\"\\/".contains(*c))
        .collect();
    let name = if name.trim().is_empty() {
        "new study"
    } else {
        name.trim()
    };
    format!(
        r#"# How hard may this drive be hit before the slider touches the disk?
# Everything left out has a default; `opshock check --resolved` lists them all,
# `opshock schema` explains them.

study_format = 2
name = "{name}"

[pulse]
widths_ms = [0.5, 1.0, 2.0]
signs = ["+", "-"]

[ramp]
models = ["none", "rigid", "deformable"]
clearance_um = 100.0

[disk]
rpm = 5400.0

[search]
amplitude_g = {{ min = 20.0, max = 2000.0 }}
tolerance_pct = 1.0
"#
    )
}

#[cfg(test)]
mod tests {
    use super::super::{Ramp, Study};
    use opshock_solver::scene::Scene;

    #[test]
    fn the_defaults_are_the_default_drive_of_the_solver() {
        let study = Study::from_text(&super::text("defaults"), &[]).expect("valid");
        let is_it = |ramp, width_ms| ramp == Ramp::Deformable && width_ms == 1.0;
        let mut points = study.points.iter();
        let point = points.find(|point| is_it(point.ramp, point.pulse_ms));
        assert_eq!(point.expect("a point").scene, Scene::default_drive());
    }
}
