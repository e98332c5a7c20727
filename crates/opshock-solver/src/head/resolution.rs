//! Resolution of a head's time integration, and the coupling scheme of film and slider.

/// How film and slider are solved together at a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub enum Coupling {
    /// Monolithic Newton iteration (Schur complement).
    Monolithic,
    /// The paper's fixed-point iteration.
    FixedPoint,
    /// Fixed point with Aitken's relaxation.
    Aitken,
    /// Anderson acceleration (interface Newton).
    Anderson,
}

/// Resolution and limits of the head's time integration.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct HeadResolution {
    /// Relative local error allowed in the clearance per step.
    pub tolerance: f64,
    /// Share of |clearance| + 2 h₀ for a step to close; 1.25 times it at most.
    pub approach_share: f64,
    /// Modes of the suspension kept above the dimple-pinned interface, bending.
    pub suspension_modes: usize,
    /// Coupling scheme.
    pub coupling: Coupling,
    /// Residual tolerance of the coupled solve relative to its scales.
    pub coupling_tolerance: f64,
    /// Step limit; a run that reaches it is undecided.
    pub max_steps: u64,
}
