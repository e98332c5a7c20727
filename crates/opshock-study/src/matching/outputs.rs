//! Numbers of one parameter set: simulates a stage and reads every observation's number from it.

use super::file::MatchProblem;
use super::observation::{Known, Measure, Observation, Quantity, Scalar, ShockChoice, Stage};
use crate::store::history::root_columns;
use crate::store::summary::{Status, Summary};
use crate::study::{Choice, Study};
use crate::sweep::{Physics, SweepInput, unkept};
use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::scene::Scene;
use opshock_solver::scene::discretisation::{Discretisation, Levels};
use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::simulation::{Model, Outcome, Request, Workspace, simulate};
use serde_json::Value;

/// JSON output of the program's commands.
pub trait Printed: Sync {
    /// `opshock run --json`.
    fn run(&self, outcome: &Outcome, start_s: f64) -> Value;

    /// `opshock modes --json`.
    ///
    /// # Errors
    /// The scene has none.
    fn modes(&self, study: &Study, scene: &Scene) -> Result<Value, String>;

    /// `opshock steady --json`.
    ///
    /// # Errors
    /// The scene has no steady flight.
    fn steady(&self, study: &Study, scene: &Scene) -> Result<Value, String>;
}

/// Numbers of a parameter set without answer at `stage`.
pub(super) fn missing(problem: &MatchProblem, stage: Stage) -> Vec<Known> {
    let known = |one: &Observation| match one.stage == stage
        && !matches!(one.quantity, Quantity::Combined(..))
    {
        true => Known::Missing,
        false => Known::NotAsked,
    };
    problem.observations.iter().map(known).collect()
}

/// Numbers of every observation at `stage` for the `study` of a parameter set; on request with every discretisation
/// parameter refined once.
pub(super) fn numbers(
    problem: &MatchProblem,
    printed: &dyn Printed,
    study: &Study,
    stage: Stage,
    is_refined: bool,
) -> Vec<Known> {
    let mut found = missing(problem, stage);
    if stage == Stage::CriticalShocks {
        critical(problem, study, &mut found);
        return found;
    }
    let mut set = Simulations {
        problem,
        printed,
        study,
        stage,
        is_refined,
        models: Vec::new(),
    };
    set.statements(&mut found);
    set.shocks(&mut found);
    set.unshaken(&mut found);
    found
}

/// Simulations of a stage for one parameter set; parts of models are shared.
struct Simulations<'a> {
    problem: &'a MatchProblem,
    printed: &'a dyn Printed,
    study: &'a Study,
    stage: Stage,
    is_refined: bool,
    models: Vec<Model>,
}

impl Simulations<'_> {
    fn plan(&self) -> Plan {
        let outputs: &[Output] = match self.stage {
            Stage::DiskAndRamp => &[Output::DiskDisplacement, Output::ContactForce],
            _ => &[
                Output::MinClearance,
                Output::SliderAttitude,
                Output::DimpleForce,
                Output::ContactForce,
            ],
        };
        Plan::new(outputs, Mode::Auto)
    }

    /// Every discretisation parameter refined by one step, except those that are unknowns of the match.
    fn levels(&self) -> Levels {
        if !self.is_refined {
            return Levels::NONE;
        }
        let keys = self.problem.parameters.iter().flat_map(|one| &one.keys);
        let is_sought = |name: &str| keys.clone().any(|(key, _)| key == name);
        let discretisations =
            Discretisation::ALL
                .into_iter()
                .filter(|discretisation| match discretisation {
                    Discretisation::DiskModes => !is_sought("resolution.disk_cut_khz"),
                    Discretisation::SuspensionModes => !is_sought("resolution.suspension_modes"),
                    Discretisation::FilmGrid => !is_sought("resolution.film_cells"),
                    Discretisation::StructureStep => !is_sought("resolution.structure_step_us"),
                    _ => true,
                });
        discretisations.fold(Levels::NONE, |levels, discretisation| {
            levels.changed(discretisation, 1)
        })
    }

    fn statements(&mut self, found: &mut [Known]) {
        let observations = self.problem.observations.iter().enumerate();
        let (places, ids): (Vec<usize>, Vec<&str>) = observations
            .filter(|(_, one)| one.stage == self.stage)
            .filter_map(|(place, one)| match one.quantity {
                Quantity::Statement { id, .. } => Some((place, id)),
                _ => None,
            })
            .unzip();
        if ids.is_empty() {
            return;
        }
        let (plan, levels) = (self.plan().past_touch(), self.levels());
        let built_in = self.problem.statements;
        let numbers = built_in.of_shocks(&ids, self.study, &plan, levels, &mut self.models);
        for (place, number) in places.into_iter().zip(numbers) {
            found[place] = is(number);
        }
    }

    fn shocks(&mut self, found: &mut [Known]) {
        let (observations, stage) = (&self.problem.observations, self.stage);
        let of = |one: &Observation| match &one.quantity {
            Quantity::Run { shock, .. } | Quantity::History { shock, .. } if one.stage == stage => {
                Some(shock.clone())
            }
            _ => None,
        };
        let mut asked: Vec<ShockChoice> = Vec::new();
        for shock in observations.iter().filter_map(of) {
            if !asked.contains(&shock) {
                asked.push(shock);
            }
        }
        for shock in asked {
            let those = || {
                observations
                    .iter()
                    .enumerate()
                    .filter(|(_, one)| of(one).as_ref() == Some(&shock))
            };
            let record = those().any(|(_, one)| matches!(one.quantity, Quantity::History { .. }));
            let places: Vec<usize> = those().map(|(place, _)| place).collect();
            let Some(outcome) = self.simulated(&shock, record) else {
                continue;
            };
            let json = self.printed.run(&outcome, self.study.start_s);
            for place in places {
                found[place] = match &observations[place].quantity {
                    Quantity::Run { path, equals, .. } => of_json(&json, path, equals.as_ref()),
                    Quantity::History {
                        column,
                        measured,
                        measure,
                        ..
                    } => distance(&outcome, self.study.start_s, column, measured, *measure),
                    _ => Known::Missing,
                };
            }
        }
    }

    fn simulated(&mut self, shock: &ShockChoice, record: bool) -> Option<Outcome> {
        let choice = Choice {
            ramp: shock.ramp,
            pulse_ms: shock.pulse_ms,
            sign: shock.sign,
            amplitude_g: shock.amplitude_g,
        };
        let shot = self.study.select(&choice).ok()?;
        let scene = shot.point.scene.at_levels(self.levels());
        let model = Model::assemble(&scene, &self.plan(), self.models.iter()).ok()?;
        let request = Request {
            amplitude_m_per_s2: shot.point.factor() * m_per_s2_from_g(shot.amplitude_g),
            record,
        };
        let outcome = simulate(&model, &request, &mut Workspace::default());
        self.models.push(model);
        Some(outcome)
    }

    /// Natural modes and steady flight.
    fn unshaken(&self, found: &mut [Known]) {
        let Some(point) = self.study.points.first() else {
            return;
        };
        let (mut modes, mut steady) = (None, None);
        for (one, found) in self.problem.observations.iter().zip(found) {
            if one.stage != self.stage {
                continue;
            }
            let scene = || point.scene.at_levels(self.levels());
            let (json, path) = match &one.quantity {
                Quantity::Modes(path) => (
                    modes.get_or_insert_with(|| self.printed.modes(self.study, &scene())),
                    path,
                ),
                Quantity::Steady(path) => (
                    steady.get_or_insert_with(|| self.printed.steady(self.study, &scene())),
                    path,
                ),
                _ => continue,
            };
            if let Ok(json) = json {
                *found = of_json(json, path, None);
            }
        }
    }
}

fn is(value: Option<f64>) -> Known {
    value
        .filter(|value| value.is_finite())
        .map_or(Known::Missing, Known::Is)
}

/// The value at a path; of a list, a position or its `length`.
fn of_json(json: &Value, path: &[String], equals: Option<&Scalar>) -> Known {
    let mut here = json;
    for word in path {
        let next = match here {
            Value::Array(list) if word == "length" => return Known::Is(list.len() as f64),
            Value::Array(list) => word.parse().ok().and_then(|place: usize| list.get(place)),
            other => other.get(word),
        };
        let Some(next) = next else {
            return Known::Missing;
        };
        here = next;
    }
    match (here, equals) {
        (Value::String(word), Some(Scalar::Text(wanted))) => {
            Known::Is(f64::from(u8::from(word == wanted)))
        }
        (Value::Bool(flag), Some(Scalar::Flag(wanted))) => {
            Known::Is(f64::from(u8::from(flag == wanted)))
        }
        (_, Some(_)) => Known::Missing,
        (value, None) => is(value.as_f64()),
    }
}

/// Distance of a history from measured values, at the measured times; none where it ends before them.
fn distance(
    outcome: &Outcome,
    start_s: f64,
    column: &str,
    measured: &[(f64, f64)],
    measure: Measure,
) -> Known {
    let Some(history) = &outcome.history else {
        return Known::Missing;
    };
    let columns = root_columns(history, start_s);
    let named = |name: &str| {
        columns
            .iter()
            .find(|one| one.name == name)
            .map(|one| &one.values)
    };
    let (Some(times), Some(values)) = (named("time_s"), named(column)) else {
        return Known::Missing;
    };
    let at = |time: f64| -> Option<f64> {
        let after = times.partition_point(|t| *t < time);
        match (after.checked_sub(1), times.get(after)) {
            (_, Some(exact)) if *exact == time => Some(values[after]),
            (Some(before), Some(next)) => {
                let share = (time - times[before]) / (next - times[before]);
                Some(values[before] + share * (values[after] - values[before]))
            }
            _ => None,
        }
    };
    let apart: Option<Vec<f64>> = measured
        .iter()
        .map(|(time, value)| Some((at(*time)? - value).abs()))
        .collect();
    let Some(apart) = apart else {
        return Known::Missing;
    };
    is(Some(match measure {
        Measure::Rms => (apart.iter().map(|x| x * x).sum::<f64>() / apart.len() as f64).sqrt(),
        Measure::Largest => apart.into_iter().fold(0.0, f64::max),
    }))
}

fn critical(problem: &MatchProblem, study: &Study, found: &mut [Known]) {
    let Ok(input) = SweepInput::of(study) else {
        return;
    };
    let summary = unkept(&input, &Physics::of(study));
    for (one, found) in problem.observations.iter().zip(found) {
        match &one.quantity {
            Quantity::Critical(shock) => *found = is(critical_g(study, &summary, shock)),
            Quantity::Statement { id, .. } if one.stage == Stage::CriticalShocks => {
                *found = is(problem.statements.of_critical_shocks(id, &summary))
            }
            _ => {}
        }
    }
}

fn critical_g(study: &Study, summary: &Summary, shock: &ShockChoice) -> Option<f64> {
    let ramp = shock.ramp.or_else(|| only(&study.ramps))?;
    let pulse_ms = shock.pulse_ms.or_else(|| only(&study.widths_ms))?;
    let sign = shock.sign.or_else(|| only(&study.signs))?;
    let point = summary.points.iter().find(|point| {
        point.ramp == ramp.as_str()
            && point.pulse_ms == pulse_ms
            && point.sign == sign
            && point.status == Status::Ok
    })?;
    point.a_crit_g
}

fn only<T: Copy>(list: &[T]) -> Option<T> {
    match list {
        [one] => Some(*one),
        _ => None,
    }
}

impl MatchProblem {
    /// Numerical uncertainty of a critical shock's number by the tolerance of its search: for each critical shock half
    /// of the tolerance, from the middle of the bracket, which is reported.
    pub(super) fn search_uncertainty(&self, one: &Observation, number: Known) -> f64 {
        let Known::Is(value) = number else {
            return 0.0;
        };
        let share = 0.01 * self.tolerance_pct;
        match one.quantity {
            Quantity::Critical(_) => 0.5 * share * value.abs(),
            // Of differences in per cent, and of ratios.
            Quantity::Statement { unit: "%", .. } => 100.0 * share,
            _ => share * value.abs(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn outputs_are_read_by_their_path() {
        let json = json!({"contact": {"top": {"first_touch_s": null, "episodes": [{"on_s": 0.25}]}}, "verdict": "fails"});
        let read = |path: &str, equals: Option<&Scalar>| {
            let words: Vec<String> = path.split('.').map(str::to_owned).collect();
            of_json(&json, &words, equals)
        };
        assert_eq!(read("contact.top.episodes.0.on_s", None), Known::Is(0.25));
        assert_eq!(read("contact.top.episodes.length", None), Known::Is(1.0));
        assert_eq!(read("contact.top.episodes.1.on_s", None), Known::Missing);
        assert_eq!(read("contact.top.first_touch_s", None), Known::Missing);
        assert_eq!(
            read("verdict", Some(&Scalar::Text("fails".into()))),
            Known::Is(1.0)
        );
        assert_eq!(
            read("verdict", Some(&Scalar::Text("survives".into()))),
            Known::Is(0.0)
        );
    }
}
