//! Reads the study a command works on, with the settings of the command line.

use super::console::Console;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::terminal::{stderr_colour, stderr_width};
use opshock_solver::air_bearing::steady::SteadyError;
use opshock_solver::head::HeadError;
use opshock_solver::quantity::GRAM_FORCE_N;
use opshock_solver::simulation::BuildError;
use opshock_study::study::{
    ChoiceError, SetArg, SetSyntaxError, Severity, Study, StudyError, StudyErrors, fault,
};
use std::path::Path;

/// The `--set` and `--unset` arguments.
///
/// # Errors
///
/// The first that is not `KEY=VALUE`, or not a key.
pub fn sets(global: &GlobalArgs) -> Result<Vec<SetArg>, SetSyntaxError> {
    let set = global.set.iter().map(|argument| SetArg::parse(argument));
    let unset = global.unset.iter().map(|key| SetArg::unset(key));
    let refinements = global
        .max_refinements
        .map(|most| SetArg::parse(&format!("search.max_refinements={most}")));
    set.chain(unset).chain(refinements).collect()
}

/// Reads a study with the `--set` arguments laid over it, and prints its warnings and notes.
///
/// # Errors
///
/// Every fault of the study.
pub fn read(path: &Path, global: &GlobalArgs, console: &Console) -> Result<Study, Failure> {
    let study = Study::from_path(path, &sets(global)?)?;
    let reported: Vec<StudyError> = study
        .remarks
        .iter()
        .filter(|remark| !global.accept.iter().any(|code| code.trim() == remark.code))
        .cloned()
        .collect();
    report(&reported, console);
    Ok(study)
}

/// Refuses a study whose warnings are not all accepted: a batch must not start on a doubt.
///
/// # Errors
///
/// The warnings, as faults of the study.
pub fn refuse_unaccepted(study: &Study, accepted: &[String]) -> Result<(), Failure> {
    let mut open: Vec<StudyError> = study.unaccepted(accepted).into_iter().cloned().collect();
    if open.is_empty() {
        return Ok(());
    }
    for remark in &mut open {
        let accept = format!("--accept {} starts all the same", remark.code);
        remark.hint = match remark.hint.as_str() {
            "" => accept,
            hint => format!("{hint}; {accept}"),
        };
    }
    Err(StudyErrors::new(open).into())
}

/// A scene that passes every check of its numbers and still has no answer, as a slider without
/// steady flight.
pub fn cannot_be_simulated(study: &Study, error: &(dyn std::error::Error + 'static)) -> Failure {
    let file = study.path.display().to_string();
    if let Some(BuildError::Head(HeadError::StartsFailed {
        min_clearance_m,
        place,
        fail_below_m,
    })) = error.downcast_ref()
    {
        let nm = |metres: &f64| 1e9 * metres;
        let message = format!(
            "the slider flies {:.3} nm above the disk before the shock, {:.3} mm from its leading and \
             {:.3} mm from its inner edge: not above the limit of failure",
            nm(min_clearance_m),
            1e3 * place.x_m,
            1e3 * place.y_m
        );
        let mut fault = StudyError::in_file("E148", &file, message)
            .value(format!("{}", nm(fail_below_m)))
            .allowed(format!("a limit below {:.3} nm", nm(min_clearance_m)))
            .hint("no failure by shock: see `opshock steady`");
        fault.key = "failure.clearance_nm".to_owned();
        return StudyErrors::from(fault).into();
    }
    if let Some(BuildError::Steady(SteadyError::CannotFly {
        load_n,
        carried_n,
        clearance_m,
        ends,
    })) = error.downcast_ref()
    {
        let gf = |newton: &f64| newton / GRAM_FORCE_N;
        let message = format!(
            "the slider cannot fly: its film carries {:.4} gf at most, at a clearance of {:.3} nm (followed from lighter \
             loads, {ends})",
            gf(carried_n),
            1e9 * clearance_m
        );
        let mut fault = StudyError::in_file("E192", &file, message)
            .value(format!("{:.4} gf", gf(load_n)))
            .allowed(format!(
                "a gram load below {:.4} gf on this surface",
                gf(carried_n)
            ))
            .hint(
                "a lighter load, a faster disk, more of the surface as pads, or a higher pressure",
            );
        fault.key = "suspension.gram_load_gf".to_owned();
        return StudyErrors::from(fault).into();
    }
    let fault = StudyError::in_file("E190", &file, error.to_string())
        .hint("change the scene; `opshock steady` and `opshock modes` show its parts");
    StudyErrors::from(fault).into()
}

fn report(remarks: &[StudyError], console: &Console) {
    if remarks.is_empty() || console.quiet || console.json {
        return;
    }
    let text = match stderr_width() {
        Some(width) => fault::to_terminal(remarks, width, stderr_colour()),
        None => remarks
            .iter()
            .map(|remark| format!("{}: {remark}\n", label(remark.severity())))
            .collect(),
    };
    console.note(text.trim_end());
}

fn label(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    }
}

impl From<ChoiceError> for Failure {
    fn from(error: ChoiceError) -> Self {
        match error {
            ChoiceError::Free(axes) => Failure::Usage(
                axes.into_iter()
                    .map(|axis| Fault {
                        key: Some(axis.path.clone()),
                        allowed: (!axis.values.is_empty()).then(|| axis.values.join(", ")),
                        hint: Some(format!("choose with {}", axis.option)),
                        ..Fault::new("free_axis", format!("{} is not chosen", axis.path))
                    })
                    .collect(),
            ),
            ChoiceError::Value {
                option,
                ref value,
                allowed,
            } => Failure::Usage(vec![Fault {
                key: Some(option.into()),
                value: Some(value.clone()),
                allowed: Some(allowed.into()),
                ..Fault::new("usage", error.to_string())
            }]),
            ChoiceError::Study(errors) => errors.into(),
        }
    }
}
