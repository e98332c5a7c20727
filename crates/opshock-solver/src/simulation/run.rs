//! Runs one shock through a model: structure, head, verdict, warnings.

use std::sync::Arc;

use super::model::Model;
use super::outcome::{
    Cause, Cost, DiskExtremes, EnergyBalance, History, Outcome, SteadyState, Verdict, Warning,
};
use crate::head::{HeadRun, HeadState, HeadWorkspace, ShockLoad, Stretch};
use crate::structure::{self, StructureError, StructureRun, StructureWarning};

/// Request of one simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// Signed amplitude A, m/s2: the inertia load per mass at the pulse's peak.
    pub amplitude_m_per_s2: f64,
    /// Whether histories are kept.
    pub record: bool,
}

/// Scratch of one thread for one model; made anew for another model.
#[derive(Default)]
pub struct Workspace {
    structure: structure::Workspace,
    head: Option<(Arc<()>, HeadWorkspace)>,
}

/// Runs one shock through `model`.
///
/// Never fails: what prevents an answer is [`Verdict::Undecided`] with its cause. A model without
/// a head has no clearance, and no verdict unless its structure gives no answer.
pub fn simulate(model: &Model, request: &Request, workspace: &mut Workspace) -> Outcome {
    let structure = run_structure(model, request, workspace);
    simulate_head(model, request, structure.as_ref(), workspace)
}

/// The structural half of [`simulate`]: the same for every model whose
/// [`Model::has_structure`] agrees.
///
/// # Errors
/// [`StructureError::NotFinite`].
pub fn run_structure(
    model: &Model,
    request: &Request,
    workspace: &mut Workspace,
) -> Result<StructureRun, StructureError> {
    model.structure.run(
        request.amplitude_m_per_s2,
        request.record,
        &mut workspace.structure,
    )
}

/// The head's part of [`simulate`], under a structural run of the same request.
pub fn simulate_head(
    model: &Model,
    request: &Request,
    structure: Result<&StructureRun, &StructureError>,
    workspace: &mut Workspace,
) -> Outcome {
    simulate_head_on(model, request, structure, Going::default(), workspace).0
}

/// Splits a head's run in two, so that one over a longer window continues where one over a shorter window ended.
#[derive(Clone, Copy, Debug, Default)]
pub struct Going<'a> {
    /// End of the shorter window, s: the head begins anew from its state there.
    pub restart_s: Option<f64>,
    /// State there of a run of the same shock; without it the run begins at the onset, with the same result.
    pub from: Option<&'a HeadState>,
    /// Whether the state at the end is returned, where the head has not touched.
    pub keeps_end: bool,
}

/// [`simulate_head`], continued from an earlier run or to be continued.
pub fn simulate_head_on(
    model: &Model,
    request: &Request,
    structure: Result<&StructureRun, &StructureError>,
    going: Going<'_>,
    workspace: &mut Workspace,
) -> (Outcome, Option<HeadState>) {
    let run = match structure {
        Ok(run) => run,
        Err(error) => return (without_structure(error), None),
    };
    let mut state = None;
    let head = model.head.as_ref().map(|head| {
        let mut scratch = match workspace.head.take() {
            Some((owner, scratch)) if Arc::ptr_eq(&owner, &model.identity) => scratch,
            _ => HeadWorkspace::new(head),
        };
        let load = ShockLoad {
            pulse: &model.scene.pulse,
            base: model.structure.base_motion(),
            // On a turning base the suspension's axial load differs from the spindle's.
            amplitude_m_per_s2: match &model.scene.oblique {
                Some(shock) => {
                    let slider = &model.scene.slider;
                    let share = shock.axial_at(slider.radius_m, slider.angle_rad);
                    request.amplitude_m_per_s2 * share
                }
                None => request.amplitude_m_per_s2,
            },
        };
        let stretch = Stretch {
            end_s: run.end_s,
            restart_s: going.restart_s,
            from: going.from,
            keeps_end: going.keeps_end,
        };
        let (result, end) = head.run_stretch(
            &run.history,
            &load,
            stretch,
            model.plan().stops_at_failure,
            request.record,
            &mut scratch,
        );
        state = end;
        workspace.head = Some((Arc::clone(&model.identity), scratch));
        result
    });
    (assemble(model, run, head), state)
}

fn assemble(model: &Model, run: &StructureRun, head: Option<HeadRun>) -> Outcome {
    let mut warnings: Vec<Warning> = run.warnings.iter().map(describe).collect();
    if let Some(cause) = head.as_ref().and_then(|head| head.broke_off.as_ref()) {
        warnings.push(Warning {
            code: "broke_off_behind_touch",
            message: format!("the head fails, and its motion after that breaks off: {cause}"),
        });
    }
    let mut cost = Cost {
        structure_steps: run.steps,
        ..Cost::default()
    };
    if let Some(head) = &head {
        let film = head.cost;
        cost.steps = film.steps;
        cost.rejected = film.rejected;
        cost.film_solves = film.film_solves;
        cost.factorisations = film.factorisations;
        cost.max_residual = film.max_residual;
        cost.min_pressure_pa = film.min_pressure_pa;
        cost.mass_balance_error = film.mass_balance_error;
    }
    if let Some(bearing) = model.bearing() {
        cost.film_unknowns = bearing.film.n_cells() as u64;
    }
    let steady = model.bearing().map(|bearing| SteadyState {
        min_clearance_m: bearing.flight.min_clearance_m,
        pitch_rad: bearing.flight.attitude.pitch_rad,
        roll_rad: bearing.flight.attitude.roll_rad,
    });
    let touched = run.first_touch_s.is_some();
    let history = run.columns.clone().map(|structure| History {
        structure,
        head: head
            .as_ref()
            .and_then(|h| h.columns.clone())
            .unwrap_or_default(),
        fields: head.as_ref().and_then(|h| h.fields.clone()),
    });
    Outcome {
        verdict: head.as_ref().map(|h| h.verdict.clone()),
        min_clearance_m: head.as_ref().map(|h| h.min_clearance_m),
        t_min_clearance_s: head.as_ref().map(|h| h.t_min_clearance_s),
        lowest: head.as_ref().map(|h| h.lowest),
        steady,
        disk: run.disk,
        top: run.top.clone(),
        bottom: run.bottom.clone(),
        dimple: head.as_ref().map(|h| h.dimple),
        limiters: head.as_ref().and_then(|h| h.limiters),
        lift_tab: head.as_ref().and_then(|h| h.lift_tab),
        slider_contact: head.as_ref().and_then(|h| h.slider_contact.clone()),
        energy: run.energy,
        complementarity: run.complementarity,
        hub: run.hub,
        base: run.base,
        effects: effects(model),
        rules: model.plan().applied(&model.scene, touched),
        warnings,
        cost,
        history,
    }
}

fn without_structure(error: &StructureError) -> Outcome {
    let time_s = match error {
        StructureError::NotFinite { time_s } => *time_s,
        _ => 0.0,
    };
    Outcome {
        verdict: Some(Verdict::Undecided {
            cause: Cause::NotFinite {
                time_s,
                quantity: "structural motion",
            },
        }),
        min_clearance_m: None,
        t_min_clearance_s: None,
        lowest: None,
        steady: None,
        disk: DiskExtremes::default(),
        top: Default::default(),
        bottom: Default::default(),
        dimple: None,
        limiters: None,
        lift_tab: None,
        slider_contact: None,
        energy: EnergyBalance::default(),
        complementarity: Default::default(),
        hub: None,
        base: None,
        effects: Vec::new(),
        rules: Vec::new(),
        warnings: Vec::new(),
        cost: Cost::default(),
        history: None,
    }
}

/// Names of the effects in the model.
pub(super) fn effects(model: &Model) -> Vec<&'static str> {
    let mut names = vec![
        "disk.bending",
        "disk.spin_stiffening",
        "disk.rotating_damping",
    ];
    if model.scene.disk.space_fixed_damping_per_s > 0.0 {
        names.push("disk.space_fixed_damping");
    }
    if model.scene.disk.hub.is_some() {
        names.push("disk.hub");
    }
    if model.scene.oblique.is_some() {
        names.push("shock.oblique");
    }
    if !model.scene.base.is_empty() {
        names.push("base.modes");
    }
    let ramp = &model.scene.ramp.model;
    for (name, is_on) in [
        ("ramp.contact", !ramp.is_absent()),
        ("ramp.arms", !ramp.modes().is_empty()),
        ("ramp.relaxation", ramp.relaxes()),
        ("disk.travelling_waves", !ramp.is_absent()),
    ] {
        names.extend(is_on.then_some(name));
    }
    if model.bearing().is_some() && model.head.is_none() {
        names.push("head.steady_flight");
    }
    if model.head.is_some() && !model.scene.run_out.is_empty() {
        names.push("disk.run_out");
    }
    if model.bearing().is_some() {
        names.extend(model.scene.gap_forces.active().map(|force| force.name()));
    }
    if model.head.is_some() {
        names.extend(["head.film", "head.slider", "head.suspension", "head.dimple"]);
        if !model.scene.suspension.limiters.is_empty() {
            names.push("head.limiters");
        }
        if model.scene.suspension.lift_tab.is_some() {
            names.push("head.lift_tab");
        }
    }
    names
}

/// A warning of the structure in words.
fn describe(warning: &StructureWarning) -> Warning {
    let (code, message) = match *warning {
        StructureWarning::Penetration { depth_m } => (
            "penetration",
            format!(
                "disk and ramp overlapped by {:.3} um: shorten structure_step_us",
                1e6 * depth_m
            ),
        ),
        StructureWarning::BouncesAccumulated { steps } => (
            "bounces_accumulated",
            format!("bounces accumulated within {steps} steps and were taken as lasting contact"),
        ),
        StructureWarning::HarmonicsBounded => (
            "harmonics_bounded",
            "harmonics with modes below disk_cut_khz are left out by disk_harmonics".to_string(),
        ),
        StructureWarning::ArmModesSlowed { modes } => (
            "arm_modes_slowed",
            format!(
                "{modes} arm modes are too fast for structure_step_us and were slowed at constant \
                 stiffness"
            ),
        ),
        StructureWarning::BothArmsOnePoint => (
            "both_arms_one_point",
            "both arms held one point: only the net force is determined".to_string(),
        ),
        StructureWarning::HubInstability {
            nodal_diameters,
            growth_per_s,
        } => (
            "hub_instability",
            format!(
                "the hub's bearing drives its {} motion, which grows at {growth_per_s:.3} per second by \
                 itself",
                if nodal_diameters == 0 {
                    "axial"
                } else {
                    "tilting"
                }
            ),
        ),
        StructureWarning::PhysicalInstability {
            nodal_diameters,
            growth_per_s,
        } => (
            "physical_instability",
            format!(
                "above a critical speed: the wave with {nodal_diameters} nodal diameters grows at \
                 {growth_per_s:.3} per second by itself"
            ),
        ),
    };
    Warning { code, message }
}
