//! Reads points off the rotor (harmonics coupled with hub or base): contact points, slider, rim, hub, mounts.

use super::part::Part;
use super::state::RotorState;
use super::whole::Rotor;
use crate::complementarity::Gap;
use crate::disk::DiskPose;
use crate::modal::{CoupledState, PointReadout};
use crate::structure::sample::{BodySample, Motion, Sample};

impl Rotor {
    pub(super) fn pairs<'a>(
        &'a self,
        state: &'a RotorState,
    ) -> impl Iterator<Item = (&'a Part, &'a CoupledState)> {
        self.parts.iter().zip(&state.parts)
    }

    /// Displacement of the disk at the contact points, and its rate.
    pub fn contact(&self, state: &RotorState) -> Gap {
        let mut sum = Gap::default();
        for (part, state) in self.pairs(state) {
            let (value, rate) = part.contact.read(state);
            sum.value_m += value;
            sum.rate_m_per_s += rate;
        }
        sum
    }

    /// Displacement of an arm's contact point by the base and the modes carried on it, and its rate.
    pub fn arm(&self, side: usize, state: &RotorState) -> Gap {
        let mut sum = Gap::default();
        for (part, state) in self.pairs(state) {
            if let Some(arms) = &part.arms {
                let (value, rate) = arms.contact[side].read(state);
                sum.value_m += value;
                sum.rate_m_per_s += rate;
            }
        }
        sum
    }

    /// Displacement of the actuator's pivot with the base, and its rate.
    pub fn pivot(&self, state: &RotorState) -> Gap {
        let Some(arms) = &self.parts[0].arms else {
            return Gap::default();
        };
        let (value_m, rate_m_per_s) = arms.pivot.read(&state.parts[0]);
        Gap {
            value_m,
            rate_m_per_s,
        }
    }

    /// w_θ at the contact points.
    pub fn contact_turn(&self, state: &RotorState) -> f64 {
        let turn = |(p, s): (&Part, &CoupledState)| p.contact_turn.read(&s.re, &s.im);
        self.pairs(state).map(turn).sum()
    }

    pub fn rim_m(&self, state: &RotorState) -> f64 {
        let rim = |(p, s): (&Part, &CoupledState)| p.rim.position.read(&s.re, &s.im);
        self.pairs(state).map(rim).sum()
    }

    /// Displacement of the disk under the slider.
    pub fn slider_m(&self, state: &RotorState) -> f64 {
        let slider = |(p, s): (&Part, &CoupledState)| p.slider[0].position.read(&s.re, &s.im);
        self.pairs(state).map(slider).sum()
    }

    /// Adds pose and rate of the disk under the slider.
    pub fn add_slider(&self, state: &RotorState, pose: &mut DiskPose, rate: &mut DiskPose) {
        for (part, state) in self.pairs(state) {
            let [w, p, r] = part.slider.each_ref().map(|row| row.read(state));
            pose.displacement_m += w.0;
            pose.pitch_rad += p.0;
            pose.roll_rad += r.0;
            rate.displacement_m += w.1;
            rate.pitch_rad += p.1;
            rate.roll_rad += r.1;
        }
    }

    /// Jump of the rate of the slider's pose per impulse on the disk at the contact points.
    pub fn slider_jump(&self) -> DiskPose {
        self.jump(|part| Some(&part.contact_entrance)).0
    }

    /// Jumps of the rates of the slider's pose and of the pivot per impulse on the disk, on the top and on the
    /// bottom arm; `None` on a rigid base.
    pub fn base_jumps(&self) -> Option<[(DiskPose, f64); 3]> {
        self.has_base.then_some(())?;
        let on_arm = |side: usize| {
            self.jump(move |part| part.arms.as_ref().map(|arms| &arms.entrance[side]))
        };
        let on_disk = self.jump(|part| Some(&part.contact_entrance));
        Some([on_disk, on_arm(0), on_arm(1)])
    }

    fn jump(&self, entrance: impl Fn(&Part) -> Option<&CoupledState>) -> (DiskPose, f64) {
        let (mut none, mut jump) = (DiskPose::default(), DiskPose::default());
        let mut kicked = self.at_rest();
        for (part, state) in self.parts.iter().zip(&mut kicked.parts) {
            if let Some(entrance) = entrance(part) {
                state.copy_from(entrance);
            }
        }
        self.add_slider(&kicked, &mut none, &mut jump);
        (jump, self.pivot(&kicked).rate_m_per_s)
    }

    /// Whether a base moves the actuator's pivot.
    pub fn has_pivot(&self) -> bool {
        self.has_base
    }

    /// Whether there is a hub, and a base.
    pub fn has_bodies(&self) -> [bool; 2] {
        self.parts[0].bodies.each_ref().map(Option::is_some)
    }

    /// Hub and base, with the impulses of their supports so far.
    pub fn bodies(&self, state: &RotorState, support_n_s: [f64; 2]) -> BodySample {
        let mut sample = BodySample {
            support_n_s,
            ..BodySample::default()
        };
        for (part, s) in self.pairs(state) {
            let read = |row: &PointReadout| row.position.read(&s.re, &s.im);
            let hub = part.hub.as_ref().map(|rows| rows.each_ref().map(read));
            match (part.nodal_diameters, hub) {
                (0, hub) => {
                    sample.axial_m += hub.map_or(0.0, |[axial, _]| axial);
                    for (sum, body) in sample.momentum_n_s.iter_mut().zip(&part.bodies) {
                        if let Some(body) = body {
                            *sum = body.momentum.velocity.read(&s.re, &s.im);
                        }
                    }
                    if let Some(arms) = part.arms.as_ref().filter(|_| self.has_base) {
                        sample.mounts_m = [&arms.spindle, &arms.ramp, &arms.pivot].map(read);
                    }
                }
                (_, Some(tilt)) => sample.tilt_rad = tilt,
                (_, None) => {}
            }
        }
        sample
    }

    /// Adds the unit response of the points.
    pub fn add_sample(&self, state: &RotorState, sample: &mut Sample) {
        let contact = self.contact(state);
        sample.contact.value += contact.value_m;
        sample.contact.rate += contact.rate_m_per_s;
        let (mut pose, mut rate) = (DiskPose::default(), DiskPose::default());
        self.add_slider(state, &mut pose, &mut rate);
        sample.slider.value += pose.displacement_m;
        sample.slider.rate += rate.displacement_m;
        let motion = |value, rate| Motion { value, rate };
        sample.tilt = [
            motion(pose.pitch_rad, rate.pitch_rad),
            motion(pose.roll_rad, rate.roll_rad),
        ];
        sample.rim += self.rim_m(state);
        for (side, point) in [&mut sample.top, &mut sample.bottom]
            .into_iter()
            .enumerate()
        {
            let arm = self.arm(side, state);
            point.value += arm.value_m;
            point.rate += arm.rate_m_per_s;
        }
    }
}
