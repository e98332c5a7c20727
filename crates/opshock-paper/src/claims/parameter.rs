//! Lists the parameters the paper does not print, and the ranges over which the statements are tried.
//!
//! Lengths and loads of a suspension are known to a few per cent once one has the part; here the
//! part itself is unknown, so the ranges are those among parts of 2.5-inch drives, not tolerances.

use opshock_study::study::{Study, number_at};

/// How far a parameter moves, downwards and upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Range {
    /// Times a factor.
    Times(f64, f64),
    /// Plus an amount, in the key's unit.
    Plus(f64, f64),
}

/// One parameter, of one key or of several that move together.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Name in products.
    pub name: &'static str,
    /// Keys of the study.
    pub keys: &'static [&'static str],
    range: Range,
}

/// A parameter moved to one end of its range.
#[derive(Clone, Debug)]
pub struct Changed {
    /// `ramp.deformable.modes[0].frequency_hz=799.2`, a key each.
    pub sets: Vec<String>,
    /// Value of the first key.
    pub value: f64,
}

/// Every parameter that is tried.
pub fn parameters() -> Vec<Parameter> {
    let parameter = |name, keys, range| Parameter { name, keys, range };
    vec![
        parameter(
            "ramp body frequency",
            &["ramp.deformable.modes[0].frequency_hz"],
            Range::Times(0.9, 1.1),
        ),
        parameter(
            "ramp body mass",
            &["ramp.deformable.modes[0].mass_mg"],
            Range::Times(0.7, 1.3),
        ),
        parameter(
            "ramp body participation",
            &["ramp.deformable.modes[0].participation"],
            Range::Times(0.5, 1.5),
        ),
        parameter(
            "ramp arm frequency",
            &["ramp.deformable.modes[1].frequency_hz"],
            Range::Times(0.7, 1.3),
        ),
        parameter(
            "ramp arm mass",
            &["ramp.deformable.modes[1].mass_mg"],
            Range::Times(0.7, 1.3),
        ),
        parameter(
            "ramp arm participation",
            &["ramp.deformable.modes[1].participation"],
            Range::Times(0.8, 1.2),
        ),
        parameter(
            "ramp damping",
            &["ramp.deformable.damping_ratio"],
            Range::Times(0.5, 2.0),
        ),
        parameter(
            "contact stiffness",
            &["ramp.contact_stiffness_n_per_m"],
            Range::Times(0.5, 2.0),
        ),
        parameter(
            "gram load",
            &["suspension.gram_load_gf"],
            Range::Times(0.9, 1.1),
        ),
        parameter(
            "gimbal stiffness",
            &[
                "suspension.gimbal.pitch_n_m_per_rad",
                "suspension.gimbal.roll_n_m_per_rad",
                "suspension.gimbal.vertical_n_per_m",
            ],
            Range::Times(2.0 / 3.0, 1.5),
        ),
        parameter(
            "dimple stiffness",
            &["suspension.dimple.stiffness_n_per_m"],
            Range::Times(0.5, 2.0),
        ),
        parameter(
            "dimple place",
            &["suspension.load_beam.dimple_mm"],
            Range::Plus(-0.2, 0.2),
        ),
        parameter("onset time", &["pulse.start_ms"], Range::Plus(-0.1, 0.1)),
        parameter(
            "slider angle",
            &["slider.angle_deg"],
            Range::Plus(-5.0, 5.0),
        ),
    ]
}

impl Parameter {
    /// Value of the first key in `study`, whose every setting is written out; `None` when the study
    /// has no such key.
    pub fn value(&self, resolved: &toml::Table) -> Option<f64> {
        number_at(resolved, self.keys.first()?)
    }

    /// The lower and the upper end of the range; `None` when a key is missing.
    pub fn ends(&self, resolved: &toml::Table) -> Option<[Changed; 2]> {
        let moved = |is_upper: bool| -> Option<Changed> {
            let values = self
                .keys
                .iter()
                .map(|key| Some(self.range.of(number_at(resolved, key)?, is_upper)))
                .collect::<Option<Vec<f64>>>()?;
            Some(Changed {
                sets: self
                    .keys
                    .iter()
                    .zip(&values)
                    .map(|(key, value)| format!("{key}={value:?}"))
                    .collect(),
                value: values[0],
            })
        };
        Some([moved(false)?, moved(true)?])
    }
}

impl Range {
    /// The end, with as many digits as a person would write.
    fn of(self, value: f64, is_upper: bool) -> f64 {
        let end = match (self, is_upper) {
            (Range::Times(low, _), false) => value * low,
            (Range::Times(_, high), true) => value * high,
            (Range::Plus(low, _), false) => value + low,
            (Range::Plus(_, high), true) => value + high,
        };
        format!("{end:.3e}").parse().unwrap_or(end)
    }
}

/// Every setting of a study, as written out with its defaults.
pub(super) fn resolved(study: &Study) -> toml::Table {
    // The study wrote the text itself.
    study.resolved_toml().parse().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_taken_from_the_studys_own_values() {
        let table: toml::Table = "[pulse]\nstart_ms = 0.5\n[[ramp.deformable.modes]]\n\
            frequency_hz = 888.0\n[[ramp.deformable.modes]]\nfrequency_hz = 17500.0\n"
            .parse()
            .expect("toml");
        let named = |name: &str| {
            let all = parameters();
            *all.iter().find(|p| p.name == name).expect("a parameter")
        };
        let ends = named("ramp arm frequency").ends(&table).expect("the key");
        assert_eq!(
            ends[0].sets,
            ["ramp.deformable.modes[1].frequency_hz=12250.0"]
        );
        assert_eq!(ends[1].value, 22750.0);
        assert_eq!(
            named("onset time").ends(&table).expect("the key")[1].value,
            0.6
        );
        assert!(named("gram load").ends(&table).is_none());
    }
}
