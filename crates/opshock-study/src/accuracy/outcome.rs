//! Errors, observed orders and the cost-error front from the measured settings.

use serde::{Deserialize, Serialize};

use super::measure::Measured;
use super::refinement::{Setting, formal_order, order_quantity};

/// Names of the quantities whose errors are listed, in the order of [`SettingRow::errors`].
pub const QUANTITIES: [&str; 7] = [
    "critical_shock",
    "min_clearance",
    "flying_height",
    "contact_impulse",
    "rim_displacement",
    "slider_displacement",
    "first_touch_time",
];

/// A setting with its errors and cost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SettingRow {
    /// Discretisation parameter varied, or `joint`.
    pub parameter: String,
    /// Value of the discretisation parameter.
    pub value: String,
    /// Fineness.
    pub fineness: f64,
    /// The reference of its refinement study: its errors are its own uncertainty.
    pub is_reference: bool,
    /// Errors, as shares, by [`QUANTITIES`].
    pub errors: [Option<f64>; QUANTITIES.len()],
    /// Median and quartiles of the wall time of the probing shock, s.
    pub wall_s: Option<[f64; 3]>,
    /// No other setting of the front's refinement studies is both cheaper and better.
    pub is_on_front: bool,
    /// As measured.
    pub measured: Measured,
}

/// Observed order of a refinement study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ObservedOrder {
    /// Discretisation parameter varied, or `joint`.
    pub parameter: String,
    /// Quantity it is read on.
    pub quantity: String,
    /// Order with which errors fall as the parameter is refined; `None` where they show none.
    pub observed: Option<f64>,
    /// Three or more errors are known, but scatter too much about any order.
    pub is_disordered: bool,
    /// Formal order.
    pub formal: Option<f64>,
}

/// Refinement studies of one point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointStudies {
    /// `deformable 2 ms -`.
    pub label: String,
    /// Amplitude of the probing shock, G.
    pub probe_g: f64,
    /// Settings.
    pub settings: Vec<SettingRow>,
    /// Orders.
    pub orders: Vec<ObservedOrder>,
}

/// All data of a report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// Name of the study.
    pub study: String,
    /// Its digest.
    pub digest: String,
    /// Program that measured.
    pub program: String,
    /// Points.
    pub points: Vec<PointStudies>,
}

impl PointStudies {
    /// Errors, orders and front of what was measured.
    pub fn of(label: String, probe_g: f64, measured: &[(Setting, Measured)]) -> PointStudies {
        let reference = |parameter: &str| {
            let found = measured
                .iter()
                .find(|(s, _)| s.parameter == parameter && s.is_reference);
            found.map(|(setting, measured)| (setting, measured))
        };
        let mut settings: Vec<SettingRow> = measured
            .iter()
            .map(|(setting, one)| SettingRow {
                parameter: setting.parameter.to_owned(),
                value: setting.value.clone(),
                fineness: setting.fineness,
                is_reference: setting.is_reference,
                errors: reference(setting.parameter)
                    .map_or([None; QUANTITIES.len()], |(_, other)| errors(one, other)),
                wall_s: quartiles(&one.wall_s),
                is_on_front: false,
                measured: one.clone(),
            })
            .collect();
        // Possible error of the reference itself: the finest setting's error, reduced at formal order.
        for place in 0..settings.len() {
            if !settings[place].is_reference {
                continue;
            }
            let (parameter, fineness) =
                (settings[place].parameter.clone(), settings[place].fineness);
            let finest = settings
                .iter()
                .filter(|setting| setting.parameter == parameter && !setting.is_reference)
                .max_by(|a, b| a.fineness.total_cmp(&b.fineness));
            if let Some(finest) = finest {
                let order = formal_order(&parameter).unwrap_or(1.0);
                let fall = (finest.fineness / fineness).powf(order);
                settings[place].errors = finest.errors.map(|error| error.map(|e| e * fall));
            }
        }
        mark_front(&mut settings);
        let mut studies: Vec<String> = settings
            .iter()
            .map(|setting| setting.parameter.clone())
            .collect();
        studies.dedup();
        let orders = studies
            .iter()
            .map(|parameter| order(parameter, &settings))
            .collect();
        PointStudies {
            label,
            probe_g,
            settings,
            orders,
        }
    }
}

fn errors(one: &Measured, reference: &Measured) -> [Option<f64>; QUANTITIES.len()] {
    let share = |value: f64, of: f64, by: f64| {
        let error = (value - of).abs() / by.abs();
        error.is_finite().then_some(error)
    };
    let plain = |value: f64, of: f64| share(value, of, of);
    [
        one.critical_g
            .zip(reference.critical_g)
            .and_then(|(a, b)| plain(a, b)),
        share(
            one.min_clearance_m,
            reference.min_clearance_m,
            reference.flying_height_m,
        ),
        plain(one.flying_height_m, reference.flying_height_m),
        plain(one.contact_impulse_n_s, reference.contact_impulse_n_s),
        plain(one.rim_m, reference.rim_m),
        plain(one.slider_m, reference.slider_m),
        one.first_touch_s
            .zip(reference.first_touch_s)
            .and_then(|(a, b)| plain(a, b)),
    ]
}

fn quartiles(times: &[f64]) -> Option<[f64; 3]> {
    let mut sorted = times.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let place = share * (sorted.len() as f64 - 1.0);
        let (low, rest) = (place.floor() as usize, place.fract());
        let high = (low + 1).min(sorted.len() - 1);
        sorted[low] * (1.0 - rest) + sorted[high] * rest
    };
    (!sorted.is_empty()).then(|| [at(0.25), at(0.5), at(0.75)])
}

/// Front of the joint settings: error of the critical shock against work.
fn mark_front(settings: &mut [SettingRow]) {
    let joint: Vec<(usize, u64, f64)> = settings
        .iter()
        .enumerate()
        .filter(|(_, setting)| setting.parameter == "joint" && !setting.is_reference)
        .filter_map(|(place, setting)| Some((place, setting.measured.work, setting.errors[0]?)))
        .collect();
    for &(place, work, error) in &joint {
        settings[place].is_on_front = !joint.iter().any(|&(_, other_work, other_error)| {
            (other_work < work && other_error <= error)
                || (other_work <= work && other_error < error)
        });
    }
}

/// Order over the settings whose error exceeds both the reference's and rounding.
fn order(parameter: &str, settings: &[SettingRow]) -> ObservedOrder {
    let quantity = order_quantity(parameter);
    let column = QUANTITIES
        .iter()
        .position(|name| *name == quantity)
        .unwrap_or(0);
    let of: Vec<&SettingRow> = settings
        .iter()
        .filter(|setting| setting.parameter == parameter)
        .collect();
    let floor = of
        .iter()
        .find(|setting| setting.is_reference)
        .and_then(|setting| setting.errors[column])
        .unwrap_or(0.0);
    let known: Vec<(f64, f64)> = of
        .iter()
        .filter(|setting| !setting.is_reference)
        .filter_map(|setting| Some((setting.fineness.ln(), setting.errors[column]?)))
        .filter(|&(_, error)| error > 3.0 * floor && error > 1e-12)
        .map(|(fineness, error)| (fineness, error.ln()))
        .collect();
    let fit = slope(&known);
    let is_disordered = fit.is_some_and(|slope| scatter(&known, slope) > SCATTER.ln());
    ObservedOrder {
        parameter: parameter.to_owned(),
        quantity: quantity.to_owned(),
        observed: fit.filter(|_| !is_disordered).map(|slope| -slope),
        is_disordered,
        formal: formal_order(parameter),
    }
}

/// Largest factor of an error from the fitted order for which the fit is used.
const SCATTER: f64 = 1.5;

/// Largest distance of the points from the line of this slope through their middle.
fn scatter(points: &[(f64, f64)], slope: f64) -> f64 {
    let n = points.len() as f64;
    let middle = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (mx, my) = (middle(|point| point.0), middle(|point| point.1));
    let off = points
        .iter()
        .map(|(x, y)| (y - my - slope * (x - mx)).abs());
    off.fold(0.0, f64::max)
}

/// Least squares through at least three points.
fn slope(points: &[(f64, f64)]) -> Option<f64> {
    if points.len() < 3 {
        return None;
    }
    let n = points.len() as f64;
    let (mx, my) = points.iter().fold((0.0, 0.0), |(x, y), point| {
        (x + point.0 / n, y + point.1 / n)
    });
    let above: f64 = points.iter().map(|(x, y)| (x - mx) * (y - my)).sum();
    let below: f64 = points.iter().map(|(x, _)| (x - mx).powi(2)).sum();
    Some(above / below)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_and_slopes_are_those_of_the_books() {
        assert_eq!(quartiles(&[4.0, 1.0, 3.0, 2.0, 5.0]), Some([2.0, 3.0, 4.0]));
        assert_eq!(quartiles(&[]), None);
        let line: Vec<(f64, f64)> = (0..4)
            .map(|i| (f64::from(i), 1.0 - 2.0 * f64::from(i)))
            .collect();
        assert_eq!(slope(&line), Some(-2.0));
        assert_eq!(slope(&line[..2]), None);
        assert!(scatter(&line, -2.0) < 1e-12);
        // Errors 1, 2, 1 lie on no line: the middle one is two thirds of ln 2 off.
        let bent = [(0.0, 0.0), (1.0, 2.0_f64.ln()), (2.0, 0.0)];
        let slope = slope(&bent).expect("three points");
        assert!((scatter(&bent, slope) - 2.0 / 3.0 * 2.0_f64.ln()).abs() < 1e-12);
    }
}
