//! Decides which effects of a scene are built and simulated for the requested outputs, each by a rule.
//!
//! ```text
//! outputs, mode -> Plan::new -> Model::assemble(scene, plan) -> simulate
//! ```
//!
//! A plan is decided before anything is built. What it leaves out is not built, and no time loop tests for it. The
//! rules:
//!
//! | rule | what | condition |
//! |---|---|---|
//! | R1 | disk and ramp without film, slider and suspension | only outputs of disk and ramp |
//! | R2 | harmonics n ≥ 1 inactive; without a ramp not built | axial shock, axisymmetric disk: only n = 0 is driven |
//! | R3 | harmonics n ≥ 1 are activated at the first touch, at rest | as R2 |
//! | R4 | no ramp contact is run | closing of disk against the freely shaking ramp < clearance |
//! | R5 | one unit response serves all amplitudes and both signs | linear before contact |
//! | R6 | the head ends at its failure | a verdict is wanted |
//! | R7 | −A is the mirror of +A for disk and ramp | equal clearances and arms; used without a ramp only: with one, contact is run for each sign |
//! | R8 | pressure fields only at requested times, in recorded runs | `pressure_field` requested, its times |
//! | R9 | one steady flight for equal sliders, gases, speeds and gram loads; one structural history for several sliders at one place or several altitudes | contents equal |
//! | R10 | nothing approximate without its name | always |
//!
//! [`Mode::Full`] applies R8 and R10 alone. Without R6 its head continues after a touch, with the film at its minimum
//! height where the slider touches; verdict, smallest clearance and forces are reported up to the touch in both modes.
//!
//! R1 holds because the film's force on the disk is neglected compared with the disk's inertia. An oblique shock on a
//! hub drives n = 1 from the onset: R2 and R3 then apply to n ≥ 2.

use super::description::Scene;
pub use super::output::{Needs, Output};
use crate::disk::Harmonics;
use crate::mutant;
use crate::quantity::STANDARD_GRAVITY_M_PER_S2;
use crate::structure::Activation;

/// Whether effects that cannot change an output are left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Only what the outputs need.
    #[default]
    Auto,
    /// Full model: everything in the scene, integrated from the onset to the end of the window, nothing shared.
    Full,
}

impl Mode {
    /// Its name in a study.
    pub const fn as_str(self) -> &'static str {
        match self {
            Mode::Auto => "auto",
            Mode::Full => "full",
        }
    }
}

/// What is built and run for the requested outputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Mode.
    pub mode: Mode,
    /// Outputs asked for.
    pub outputs: Vec<Output>,
    /// How much of the drive is built.
    pub needs: Needs,
    /// When integration of the contact-driven state starts.
    pub activation: Activation,
    /// Whether structure, film and steady flight of another model may be used, and a model kept for further shocks.
    pub shares_parts: bool,
    /// Whether the head's run ends at its failure, which decides the verdict; the structure
    /// always runs the whole window.
    pub stops_at_failure: bool,
    /// Times after the onset at which recorded runs keep pressure fields, s; empty unless requested.
    pub field_times_s: Vec<f64>,
}

/// One rule as it stands for a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// `R1` to `R10`.
    pub rule: &'static str,
    /// What the rule does.
    pub what: &'static str,
    /// Whether it is applied.
    pub applied: bool,
    /// The condition, in words.
    pub condition: &'static str,
    /// The condition's number or finding, in words; empty when it has none.
    pub value: String,
}

/// Whether an effect is simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Built and integrated.
    On,
    /// At rest until the first touch; built when a run first touches.
    Inactive,
    /// Not built.
    Off,
}

impl State {
    /// `on`, `inactive` or `off`.
    pub const fn as_str(self) -> &'static str {
        match self {
            State::On => "on",
            State::Inactive => "inactive",
            State::Off => "off",
        }
    }
}

/// One effect of a scene under a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effect {
    /// Name, as results carry it.
    pub name: &'static str,
    /// State.
    pub state: State,
    /// Rule that made it inactive or left it out; `None` when it is on or the scene has none.
    pub rule: Option<&'static str>,
}

/// What is known of a scene once disk and ramp are built.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Touch {
    /// Amplitude of the shock in question, signed, m/s²; `None` when it is open.
    pub amplitude_m_per_s2: Option<f64>,
    /// Smallest touching amplitude for positive and for negative shocks, m/s²; `None` when nothing
    /// closes a gap in the window.
    pub threshold_m_per_s2: [Option<f64>; 2],
}

impl Plan {
    /// The plan for `outputs`.
    pub fn new(outputs: &[Output], mode: Mode) -> Self {
        let declared = |output: &Output| match mutant::is_on(output.as_str()) {
            true => Needs::Structure,
            false => output.needs(),
        };
        let asked = outputs.iter().map(declared).max();
        match mode {
            Mode::Auto => Self {
                mode,
                outputs: outputs.to_vec(),
                needs: asked.unwrap_or(Needs::Structure),
                activation: Activation::AtTouch,
                shares_parts: true,
                // Contact goes on after it.
                stops_at_failure: !outputs.contains(&Output::SliderContact)
                    || mutant::is_on("R6 slider contact"),
                field_times_s: Vec::new(),
            },
            Mode::Full => Self {
                mode,
                outputs: outputs.to_vec(),
                needs: Needs::Head,
                activation: Activation::AtOnset,
                shares_parts: false,
                stops_at_failure: false,
                field_times_s: Vec::new(),
            },
        }
    }

    /// The plan whose recorded runs keep pressure fields at `times_s` after the onset, when
    /// [`Output::PressureField`] is asked for.
    #[must_use]
    pub fn with_field_times(self, times_s: &[f64]) -> Self {
        let is_asked = self.outputs.contains(&Output::PressureField);
        let times_s = match is_asked && !mutant::is_on("R8 asked times") {
            true => times_s.to_vec(),
            false => Vec::new(),
        };
        Self {
            field_times_s: times_s,
            ..self
        }
    }

    /// The plan whose head continues after its first touch to the end of the window, whatever the mode, so that
    /// histories have the motion there. All else but the cost is that up to the touch.
    #[must_use]
    pub fn past_touch(self) -> Self {
        Self {
            stops_at_failure: false,
            ..self
        }
    }

    /// The plan without film, slider and suspension, whatever the mode.
    ///
    /// # Errors
    /// The first output that needs them.
    pub fn without_head(self) -> Result<Self, Output> {
        let asks = |output: &&Output| output.needs() > Needs::Structure;
        match self.outputs.iter().find(asks) {
            Some(output) => Err(*output),
            None => Ok(Self {
                needs: Needs::Structure,
                ..self
            }),
        }
    }

    /// Harmonics of the disk that are built: without a ramp nothing can activate n >= 1.
    pub fn harmonics(&self, scene: &Scene) -> Harmonics {
        match (self.activation, scene.ramp.model.is_absent()) {
            (Activation::AtTouch, true) if scene.oblique.is_some() => Harmonics::Tilting,
            (Activation::AtTouch, true) => Harmonics::Symmetric,
            (Activation::AtTouch, _) if mutant::is_on("R2 no ramp") => Harmonics::Symmetric,
            _ => Harmonics::All,
        }
    }

    /// Every effect of `scene` with its state at the start of a run.
    pub fn effects(&self, scene: &Scene, touch: &Touch) -> Vec<Effect> {
        let effect = |name, state, rule| Effect { name, state, rule };
        let on = |name| effect(name, State::On, None);
        let sleeps = |name, rule| match self.activation {
            Activation::AtOnset => on(name),
            Activation::AtTouch => effect(name, State::Inactive, Some(rule)),
        };
        let needs = |name, least| {
            if self.needs >= least {
                on(name)
            } else {
                effect(name, State::Off, Some("R1"))
            }
        };
        let mut list = vec![
            on("disk.bending"),
            match scene.disk.hub {
                Some(_) => on("disk.hub"),
                None => effect("disk.hub", State::Off, None),
            },
            match scene.oblique {
                Some(_) => on("shock.oblique"),
                None => effect("shock.oblique", State::Off, None),
            },
            match scene.base.is_empty() {
                true => effect("base.modes", State::Off, None),
                false => on("base.modes"),
            },
            match self.harmonics(scene) {
                Harmonics::Tilting => on("disk.travelling_waves"),
                Harmonics::Symmetric => effect("disk.travelling_waves", State::Off, Some("R2")),
                Harmonics::All => sleeps("disk.travelling_waves", "R2"),
            },
            match (scene.ramp.model.is_absent(), self.activation) {
                (true, _) => effect("ramp.contact", State::Off, None),
                (_, Activation::AtTouch) if touch.stays_clear() == Some(true) => {
                    effect("ramp.contact", State::Off, Some("R4"))
                }
                _ => sleeps("ramp.contact", "R3"),
            },
            match scene.ramp.model.modes().is_empty() {
                true => effect("ramp.arms", State::Off, None),
                false => on("ramp.arms"),
            },
            needs("head.steady_flight", Needs::Flight),
            match scene.run_out.is_empty() {
                false => needs("disk.run_out", Needs::Head),
                true => effect("disk.run_out", State::Off, None),
            },
        ];
        list.extend(scene.gap_forces.all().map(|force| match force.is_active() {
            true => needs(force.name(), Needs::Flight),
            false => effect(force.name(), State::Off, None),
        }));
        list.extend(scene.ramp.model.relaxes().then(|| on("ramp.relaxation")));
        for name in ["head.film", "head.slider", "head.suspension", "head.dimple"] {
            list.push(needs(name, Needs::Head));
        }
        for (name, is_there) in [
            ("head.limiters", !scene.suspension.limiters.is_empty()),
            ("head.lift_tab", scene.suspension.lift_tab.is_some()),
        ] {
            list.push(match is_there {
                true => needs(name, Needs::Head),
                false => effect(name, State::Off, None),
            });
        }
        list
    }

    /// Rules that a run of `scene` applied, in order; `touched` says whether disk and ramp met.
    pub fn applied(&self, scene: &Scene, touched: bool) -> Vec<&'static str> {
        // A run that touched is above a touching amplitude of zero, one that did not has none.
        let touch = Touch {
            amplitude_m_per_s2: Some(1.0),
            threshold_m_per_s2: [touched.then_some(0.0); 2],
        };
        self.decisions(scene, &touch)
            .into_iter()
            .filter(|decision| decision.applied)
            .map(|decision| decision.rule)
            .collect()
    }

    /// R1 to R10 for `scene`, in order.
    pub fn decisions(&self, scene: &Scene, touch: &Touch) -> Vec<Decision> {
        let auto = self.mode == Mode::Auto;
        let has_ramp = !scene.ramp.model.is_absent();
        let decision = |rule, what, applied, condition, value| Decision {
            rule,
            what,
            applied,
            condition,
            value,
        };
        let deepest = self.outputs.iter().max_by_key(|output| output.needs());
        vec![
            decision(
                "R1",
                "disk and ramp without film, slider and suspension",
                self.needs < Needs::Head,
                "no output needs the moving head; the film's force on the disk is neglected",
                deepest.map_or_else(String::new, |output| {
                    let part = match output.needs() {
                        Needs::Structure => "disk and ramp",
                        Needs::Flight => "the steady flight",
                        Needs::Head => "the head",
                    };
                    format!("{} needs {part}", output.as_str())
                }),
            ),
            decision(
                "R2",
                "harmonics n >= 1 of the disk inactive, and not built, until the first touch",
                self.activation == Activation::AtTouch,
                "axial shock, axisymmetric disk, no tilt: only n = 0 is driven; run-out turns with the disk and drives no mode",
                match scene.oblique {
                    None if !scene.run_out.is_empty() => {
                        "participation of n >= 1 is 0; run-out moves the surface under the slider alone".to_owned()
                    }
                    None => "participation of n >= 1 is 0".to_owned(),
                    Some(_) => {
                        "the shock drives n = 1, which is active; that of n >= 2 is 0".to_owned()
                    }
                },
            ),
            decision(
                "R3",
                "harmonics n >= 1 are activated at the first touch, at rest",
                self.activation == Activation::AtTouch && has_ramp,
                "as R2, and a ramp to touch",
                if has_ramp {
                    "state at the first touch is 0".to_owned()
                } else {
                    "no ramp".to_owned()
                },
            ),
            decision(
                "R4",
                "no ramp contact is run",
                auto && (!has_ramp || touch.stays_clear() == Some(true)),
                "closing of the disk against the freely shaking ramp stays below the clearance",
                touch.words(has_ramp),
            ),
            decision(
                "R5",
                "one unit response serves every amplitude and both signs",
                auto,
                "linear before contact",
                "motion before contact = amplitude x unit response".to_owned(),
            ),
            decision(
                "R6",
                "the head's run ends at its failure",
                self.stops_at_failure && self.needs == Needs::Head,
                "a verdict is wanted; disk and ramp run the whole window",
                if self.needs == Needs::Head {
                    match scene.damage {
                        Some(_) => "fails by damage".to_owned(),
                        None => format!("fails below {:e} nm", 1e9 * scene.fail_below_m),
                    }
                } else {
                    "no head".to_owned()
                },
            ),
            decision(
                "R7",
                "-A is taken as the mirror of +A for disk and ramp",
                auto && !has_ramp,
                "equal clearances and equal arms; contact is run for each sign all the same",
                mirror_words(scene),
            ),
            decision(
                "R8",
                "pressure fields are kept only at asked times",
                true,
                "times at which pressure_field is asked for, in recorded runs; also in the full model",
                match self.field_times_s.len() {
                    0 => "none asked".to_owned(),
                    n => format!("{n} times asked"),
                },
            ),
            decision(
                "R9",
                "structure, or film and steady flight, shared by scenes that agree in them",
                self.shares_parts,
                "disk, ramp, pulse and the slider's place equal; or slider, gas, speed and gram load",
                if self.needs > Needs::Structure {
                    "compared value by value".to_owned()
                } else {
                    "compared value by value; no film".to_owned()
                },
            ),
            decision(
                "R10",
                "nothing approximate without its name",
                true,
                "linearised film, early verdicts and such only by name",
                "none named".to_owned(),
            ),
        ]
    }
}

impl Touch {
    /// Whether the shock stays below the touching amplitude; `None` when the amplitude is open.
    pub fn stays_clear(&self) -> Option<bool> {
        let amplitude = self.amplitude_m_per_s2?;
        let [plus, minus] = self.threshold_m_per_s2;
        let threshold = if amplitude >= 0.0 { plus } else { minus };
        Some(threshold.is_none_or(|limit| amplitude.abs() < limit))
    }

    fn words(&self, has_ramp: bool) -> String {
        if !has_ramp {
            return "no ramp".to_owned();
        }
        let g = |a: f64| a / STANDARD_GRAVITY_M_PER_S2;
        let limit =
            |side: Option<f64>| side.map_or("never".to_owned(), |a| format!("{:.4} G", g(a)));
        let [plus, minus] = self.threshold_m_per_s2;
        let onset = format!("first touch at +{} / -{}", limit(plus), limit(minus));
        match self.amplitude_m_per_s2 {
            Some(a) => format!("{:.4} G; {onset}", g(a)),
            None => format!("{onset}; below it nothing touches"),
        }
    }
}

/// Whether disk and ramp are their own mirror image.
pub fn is_mirrored(scene: &Scene) -> bool {
    let ramp = &scene.ramp;
    let is_alike = ramp.model.is_symmetric() && ramp.clearance_top_m == ramp.clearance_bottom_m;
    ramp.model.is_absent() || is_alike
}

fn mirror_words(scene: &Scene) -> String {
    let clearances = format!(
        "{}: clearances {} / {} um",
        if is_mirrored(scene) {
            "mirrored"
        } else {
            "not mirrored"
        },
        1e6 * scene.ramp.clearance_top_m,
        1e6 * scene.ramp.clearance_bottom_m
    );
    let ramp = &scene.ramp.model;
    match (ramp.is_absent(), ramp.modes().is_empty(), ramp.arms()) {
        (true, ..) => "no ramp".to_owned(),
        (_, true, _) => clearances,
        (.., Some([top, bottom])) if top == bottom => format!("{clearances}, arms equal"),
        (.., Some(_)) => format!("{clearances}, arms differ"),
        (.., None) => format!("{clearances}, arms of one body"),
    }
}
