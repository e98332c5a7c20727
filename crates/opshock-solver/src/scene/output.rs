//! Lists the outputs that a simulation can give, and the part of the drive that each of them needs.

/// An output of a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Output {
    /// Amplitude at which the head-disk interface fails.
    CriticalShock,
    /// Smallest clearance.
    MinClearance,
    /// Height, pitch and roll of the slider in time.
    SliderAttitude,
    /// Pitch of the slider in time.
    Pitch,
    /// Force of the film in time.
    BearingForce,
    /// Force of the dimple in time.
    DimpleForce,
    /// Flying attitude before the shock.
    SteadyAttitude,
    /// Amplitude at which the disk first touches the ramp.
    TouchThreshold,
    /// Displacement of the disk.
    DiskDisplacement,
    /// Displacement of the ramp's arms.
    RampDisplacement,
    /// Force and impulse between disk and ramp.
    ContactForce,
    /// Pressure and height of the film at [requested times](super::plan::Plan::with_field_times).
    PressureField,
    /// Contact of slider and disk, also after the first touch.
    SliderContact,
}

impl Output {
    /// Every output.
    pub const ALL: [Output; 13] = [
        Output::CriticalShock,
        Output::MinClearance,
        Output::SliderAttitude,
        Output::Pitch,
        Output::SteadyAttitude,
        Output::BearingForce,
        Output::DimpleForce,
        Output::DiskDisplacement,
        Output::RampDisplacement,
        Output::ContactForce,
        Output::TouchThreshold,
        Output::PressureField,
        Output::SliderContact,
    ];

    /// Its name in a study.
    pub const fn as_str(self) -> &'static str {
        match self {
            Output::CriticalShock => "critical_shock",
            Output::MinClearance => "min_clearance",
            Output::SliderAttitude => "slider_attitude",
            Output::Pitch => "pitch",
            Output::BearingForce => "bearing_force",
            Output::DimpleForce => "dimple_force",
            Output::SteadyAttitude => "steady_attitude",
            Output::TouchThreshold => "touch_threshold",
            Output::DiskDisplacement => "disk_displacement",
            Output::RampDisplacement => "ramp_displacement",
            Output::ContactForce => "contact_force",
            Output::PressureField => "pressure_field",
            Output::SliderContact => "slider_contact",
        }
    }

    /// The output of a name.
    pub fn from_word(word: &str) -> Option<Output> {
        Output::ALL
            .into_iter()
            .find(|output| output.as_str() == word)
    }

    /// The part of the drive that it needs.
    pub const fn needs(self) -> Needs {
        match self {
            Output::CriticalShock
            | Output::MinClearance
            | Output::SliderAttitude
            | Output::Pitch
            | Output::BearingForce
            | Output::DimpleForce
            | Output::PressureField
            | Output::SliderContact => Needs::Head,
            Output::SteadyAttitude => Needs::Flight,
            Output::TouchThreshold
            | Output::DiskDisplacement
            | Output::RampDisplacement
            | Output::ContactForce => Needs::Structure,
        }
    }
}

impl std::fmt::Display for Output {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.as_str())
    }
}

/// How much of the drive is built; each includes the ones before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Needs {
    /// Disk and ramp.
    Structure,
    /// Also the film and the slider's steady flight.
    Flight,
    /// Also slider, suspension and the film in time.
    Head,
}
