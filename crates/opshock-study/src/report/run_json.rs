//! The result of one simulation as JSON: what `opshock run --json` prints.

use opshock_solver::simulation::{
    ArmContact, BaseRecord, Complementarity, ContactWork, EnergyBalance, FailureEvidence,
    HeadEnergy, HubRecord, Outcome, SliderContact, SliderEpisode, StopRecord, Verdict, Warning,
};
use serde::Serialize;

/// `opshock run --json`. Times are on the study's axis; what does not exist is `null`.
#[derive(Clone, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct RunJson {
    pub verdict: Option<&'static str>,
    pub cause: Option<String>,
    pub t_fail_s: Option<f64>,
    pub place: Option<PlaceJson>,
    /// Of a failing run that was recorded.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mechanism: Option<MechanismJson>,
    pub min_clearance_m: Option<f64>,
    pub t_min_clearance_s: Option<f64>,
    pub steady: Option<SteadyJson>,
    pub disk: DiskJson,
    pub contact: ContactJson,
    pub dimple: Option<DimpleJson>,
    /// Limiters of the suspension, when there are some.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limiters: Option<StopJson>,
    /// Lift tab, when there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lift_tab: Option<StopJson>,
    /// Contact of slider and disk, of a scene with contact of asperities.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slider_contact: Option<SliderContactJson>,
    pub energy: EnergyJson,
    pub complementarity: ComplementarityJson,
    /// Hub, of a disk on a bearing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hub: Option<HubJson>,
    /// Base, when it vibrates.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub base: Option<BaseJson>,
    pub effects: Vec<&'static str>,
    /// Rules by which other effects were left out or shared.
    pub rules: Vec<&'static str>,
    pub warnings: Vec<WarningJson>,
    pub cost: CostJson,
}

/// Place of touch, slider coordinates.
#[derive(Clone, Copy, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct PlaceJson {
    pub x_m: f64,
    pub y_m: f64,
}

/// Mechanism of a failure and what decided it.
#[derive(Clone, Copy, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct MechanismJson {
    pub name: &'static str,
    #[serde(flatten)]
    pub evidence: FailureEvidence,
}

impl MechanismJson {
    /// That of a failing run that was recorded.
    pub fn of(outcome: &Outcome) -> Option<MechanismJson> {
        FailureEvidence::of(outcome).map(|evidence| MechanismJson {
            name: evidence.mechanism().as_str(),
            evidence,
        })
    }
}

/// Steady flight before the shock.
#[derive(Clone, Copy, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct SteadyJson {
    pub min_clearance_m: f64,
    pub pitch_rad: f64,
    pub roll_rad: f64,
}

/// Extremes of the disk over the window.
#[derive(Clone, Copy, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct DiskJson {
    pub slider_max_m: Option<f64>,
    pub slider_min_m: Option<f64>,
    pub ramp_max_m: Option<f64>,
    pub ramp_min_m: Option<f64>,
    pub rim_max_m: Option<f64>,
}

/// Contact with both arms.
#[derive(Clone, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct ContactJson {
    pub top: ArmJson,
    pub bottom: ArmJson,
}

/// Contact with one arm.
#[derive(Clone, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct ArmJson {
    pub first_touch_s: Option<f64>,
    pub impulse_n_s: f64,
    pub episodes: Vec<EpisodeJson>,
}

/// One contact episode.
#[derive(Clone, Copy, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct EpisodeJson {
    pub on_s: f64,
    pub off_s: f64,
    pub impulse_n_s: f64,
    pub peak_20us_n: f64,
}

/// Dimple over the simulated head.
#[derive(Clone, Copy, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct DimpleJson {
    pub min_force_n: f64,
    pub open_s: f64,
}

/// Limiters together, or lift tab, over the simulated head.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct StopJson {
    /// Largest contact force, N.
    pub max_force_n: f64,
    /// First contact, s.
    pub first_s: Option<f64>,
    /// Total time closed, s.
    pub closed_s: f64,
}

/// Contact of slider and disk over the simulated time.
#[derive(Clone, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct SliderContactJson {
    pub touch_s: Option<f64>,
    pub episodes: Vec<SliderEpisodeJson>,
    /// `flying` or `in_contact`.
    pub end: &'static str,
    pub yielded_j: f64,
    /// Of slider and suspension.
    pub energy: Option<HeadEnergy>,
}

/// One episode of it.
#[derive(Clone, Copy, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct SliderEpisodeJson {
    pub on_s: f64,
    pub off_s: f64,
    pub approach_m_per_s: f64,
    pub impulse_n_s: f64,
    pub peak_force_n: f64,
    pub peak_pressure_pa: f64,
    pub closest_m: f64,
    pub place: PlaceJson,
    pub friction_j: f64,
    pub work: Option<ContactWork>,
    pub mean_pressure_pa: f64,
}

impl SliderContactJson {
    /// Of a run whose pulse begins at `start_s` on the study's axis.
    fn new(contact: &SliderContact, start_s: f64) -> Self {
        let episode = |episode: &SliderEpisode| SliderEpisodeJson {
            on_s: episode.on_s + start_s,
            off_s: episode.off_s + start_s,
            approach_m_per_s: episode.approach_m_per_s,
            impulse_n_s: episode.impulse_n_s,
            peak_force_n: episode.peak_force_n,
            peak_pressure_pa: episode.peak_pressure_pa,
            closest_m: episode.closest_m,
            place: PlaceJson {
                x_m: episode.place.x_m,
                y_m: episode.place.y_m,
            },
            friction_j: episode.friction_j,
            work: episode.work,
            mean_pressure_pa: episode.mean_pressure_pa,
        };
        Self {
            touch_s: contact.touched_s.map(|touched_s| touched_s + start_s),
            episodes: contact.episodes.iter().map(episode).collect(),
            end: match contact.goes_on {
                true => "in_contact",
                false => "flying",
            },
            yielded_j: contact.yielded_j,
            energy: contact.energy,
        }
    }
}

/// Energy balance of disk and ramp.
#[derive(Clone, Copy, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct EnergyJson {
    pub kinetic_j: f64,
    pub elastic_j: f64,
    pub h_end_j: f64,
    pub h_peak_j: f64,
    pub shock_work_j: f64,
    pub damping_loss_j: f64,
    pub impact_loss_j: f64,
    pub algorithmic_j: f64,
    pub spindle_work_j: f64,
    pub closure: f64,
}

/// Hub of a disk on a bearing.
#[derive(Clone, Debug, Serialize)]
pub struct HubJson {
    /// Largest axial displacement, m.
    pub axial_max_m: f64,
    /// Largest tilt, rad.
    pub tilt_max_rad: f64,
    /// Axial impulse of the shock on hub and disk, N s.
    pub shock_n_s: f64,
    /// Axial impulse of the bearing on them, N s.
    pub bearing_n_s: f64,
    /// Axial impulse of the ramp, N s.
    pub contact_n_s: f64,
    /// Residual of the momentum balance, as a share of the largest momentum.
    pub momentum_closure: f64,
}

/// Base that vibrates.
#[derive(Clone, Debug, Serialize)]
pub struct BaseJson {
    /// Largest displacement of the spindle over the base as it would move rigidly, m.
    pub spindle_max_m: f64,
    /// That of the ramp's mount, m.
    pub ramp_max_m: f64,
    /// That of the actuator's pivot, m.
    pub pivot_max_m: f64,
    /// Impulse of the shock along the modes' participations, N s.
    pub shock_n_s: f64,
    /// Impulse of springs and dampers of the modes, N s.
    pub mounts_n_s: f64,
    /// Impulse of the contact between disk and ramp, N s.
    pub contact_n_s: f64,
    /// Residual of the momentum balance, as a share of the largest momentum.
    pub momentum_closure: f64,
}

/// How well 0 <= gap complementary to multiplier >= 0 was met.
#[derive(Clone, Copy, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct ComplementarityJson {
    pub max_penetration_m: f64,
    pub min_multiplier_n_s: f64,
    pub max_product_n_s_m: f64,
}

/// A warning with its stable code.
#[derive(Clone, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct WarningJson {
    pub code: &'static str,
    pub message: String,
}

/// What the run cost; `wall_s` is the only number that differs from run to run.
#[derive(Clone, Copy, Debug, Serialize)]
#[expect(
    missing_docs,
    reason = "the names are the documented JSON keys: docs/files.md"
)]
pub struct CostJson {
    pub steps: u64,
    pub rejected: u64,
    pub film_solves: u64,
    pub factorisations: u64,
    pub film_unknowns: u64,
    pub structure_steps: u64,
    pub wall_s: f64,
}

impl RunJson {
    /// Arranges `outcome`; `start_s` is the onset of the pulse on the study's axis.
    pub fn new(outcome: &Outcome, start_s: f64, wall_s: f64) -> Self {
        let at = |time_s: f64| time_s + start_s;
        let (t_fail_s, place) = match &outcome.verdict {
            Some(Verdict::Fails { t_fail_s, place }) => (
                Some(at(*t_fail_s)),
                Some(PlaceJson {
                    x_m: place.x_m,
                    y_m: place.y_m,
                }),
            ),
            _ => (None, None),
        };
        let finite = |v: f64| v.is_finite().then_some(v);
        let disk = &outcome.disk;
        let cost = &outcome.cost;
        Self {
            verdict: outcome.verdict.as_ref().map(verdict_word),
            cause: match &outcome.verdict {
                Some(Verdict::Undecided { cause }) => Some(cause.to_string()),
                _ => None,
            },
            t_fail_s,
            place,
            mechanism: MechanismJson::of(outcome),
            min_clearance_m: outcome.min_clearance_m.and_then(finite),
            t_min_clearance_s: outcome.t_min_clearance_s.map(at).and_then(finite),
            steady: outcome.steady.map(|steady| SteadyJson {
                min_clearance_m: steady.min_clearance_m,
                pitch_rad: steady.pitch_rad,
                roll_rad: steady.roll_rad,
            }),
            disk: DiskJson {
                slider_max_m: finite(disk.slider_max_m),
                slider_min_m: finite(disk.slider_min_m),
                ramp_max_m: finite(disk.ramp_max_m),
                ramp_min_m: finite(disk.ramp_min_m),
                rim_max_m: finite(disk.rim_max_m),
            },
            contact: ContactJson {
                top: arm(&outcome.top, start_s),
                bottom: arm(&outcome.bottom, start_s),
            },
            dimple: outcome.dimple.map(|dimple| DimpleJson {
                min_force_n: dimple.min_force_n,
                open_s: dimple.open_s,
            }),
            limiters: outcome.limiters.map(|record| stop(&record, start_s)),
            lift_tab: outcome.lift_tab.map(|record| stop(&record, start_s)),
            slider_contact: outcome
                .slider_contact
                .as_ref()
                .map(|contact| SliderContactJson::new(contact, start_s)),
            energy: energy(&outcome.energy),
            complementarity: complementarity(&outcome.complementarity),
            hub: outcome.hub.as_ref().map(hub),
            base: outcome.base.as_ref().map(base),
            effects: outcome.effects.clone(),
            rules: outcome.rules.clone(),
            warnings: outcome.warnings.iter().map(warning).collect(),
            cost: CostJson {
                steps: cost.steps,
                rejected: cost.rejected,
                film_solves: cost.film_solves,
                factorisations: cost.factorisations,
                film_unknowns: cost.film_unknowns,
                structure_steps: cost.structure_steps,
                wall_s,
            },
        }
    }
}

/// `survives`, `fails` or `undecided`.
pub fn verdict_word(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::Survives => "survives",
        Verdict::Fails { .. } => "fails",
        Verdict::Undecided { .. } => "undecided",
    }
}

fn arm(contact: &ArmContact, start_s: f64) -> ArmJson {
    ArmJson {
        first_touch_s: contact.first_touch_s.map(|t| t + start_s),
        impulse_n_s: contact.impulse_n_s,
        episodes: contact
            .episodes
            .iter()
            .map(|episode| EpisodeJson {
                on_s: episode.on_s + start_s,
                off_s: episode.off_s + start_s,
                impulse_n_s: episode.impulse_n_s,
                peak_20us_n: episode.peak_20us_n,
            })
            .collect(),
    }
}

fn stop(record: &StopRecord, start_s: f64) -> StopJson {
    StopJson {
        max_force_n: record.max_force_n,
        first_s: record.first_s.map(|t| t + start_s),
        closed_s: record.closed_s,
    }
}

fn energy(balance: &EnergyBalance) -> EnergyJson {
    EnergyJson {
        kinetic_j: balance.kinetic_j,
        elastic_j: balance.elastic_j,
        h_end_j: balance.h_end_j,
        h_peak_j: balance.h_peak_j,
        shock_work_j: balance.shock_work_j,
        damping_loss_j: balance.damping_loss_j,
        impact_loss_j: balance.impact_loss_j,
        algorithmic_j: balance.algorithmic_j,
        spindle_work_j: balance.spindle_work_j,
        closure: balance.closure,
    }
}

fn hub(record: &HubRecord) -> HubJson {
    HubJson {
        axial_max_m: record.axial_max_m,
        tilt_max_rad: record.tilt_max_rad,
        shock_n_s: record.momentum.shock_n_s,
        bearing_n_s: record.momentum.support_n_s,
        contact_n_s: record.momentum.contact_n_s,
        momentum_closure: record.momentum.closure,
    }
}

fn base(record: &BaseRecord) -> BaseJson {
    BaseJson {
        spindle_max_m: record.spindle_max_m,
        ramp_max_m: record.ramp_max_m,
        pivot_max_m: record.pivot_max_m,
        shock_n_s: record.momentum.shock_n_s,
        mounts_n_s: record.momentum.support_n_s,
        contact_n_s: record.momentum.contact_n_s,
        momentum_closure: record.momentum.closure,
    }
}

fn complementarity(numbers: &Complementarity) -> ComplementarityJson {
    ComplementarityJson {
        max_penetration_m: numbers.max_penetration_m,
        min_multiplier_n_s: numbers.min_multiplier_n_s,
        max_product_n_s_m: numbers.max_product_n_s_m,
    }
}

fn warning(warning: &Warning) -> WarningJson {
    WarningJson {
        code: warning.code,
        message: warning.message.clone(),
    }
}
