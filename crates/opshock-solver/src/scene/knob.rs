//! The knobs that trade time for accuracy, each in steps finer and coarser than a scene has it.
//!
//! A [`Levels`] says how many steps each knob is turned: 0 is the scene as given, positive is
//! finer. One step divides the knob's error by its [`Knob::formal_ratio`] where nothing but the
//! formal order counts:
//!
//! | knob | one step finer | error falls by | because |
//! |---|---|---|---|
//! | `film_grid` | twice the cells | 2 | second order in the spacing |
//! | `disk_modes` | twice the cut frequency | 2 | what a point contact excites falls with 1/f |
//! | `suspension_modes` | twice the modes | 4 | clamped beam, f ~ n² |
//! | `structure_step` | half the step | 2 | contact begins and ends on steps |
//! | `head_tolerance` | an eighth of the tolerance | 4 | local error of a second-order step |
//! | `coupling_tolerance` | an eighth of the tolerance | 8 | the residual itself |
//! | `ramp_mesh` | half the size of the ramp's elements | 2 | stress without bound at inner edges |
//!
//! A ramp comes to a scene as oscillators. Whoever made them of a geometry makes them of another mesh
//! too; [`Scene::at_levels`](super::Scene::at_levels) leaves them as they are, and `ramp_mesh` is none of
//! [`Knob::ALL`]. Oscillators that the study itself gives are the model: no knob turns them.
//!
//! [`Knob::HeldFilm`] is no knob of a scene either. It asks of a shock what its smallest clearance would be on
//! another film held still at the lowest attitude ([`crate::simulation::held`]): one step finer, the film with
//! every cell cut in two, continued to infinitely many; a step coarser, one of half the cells.

/// Something that trades time for accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Knob {
    /// Cells of the film.
    FilmGrid,
    /// Modes of the disk: cut frequency, harmonics and radial elements together.
    DiskModes,
    /// Modes of the suspension.
    SuspensionModes,
    /// Step on which disk and ramp are stored and contact is resolved.
    StructureStep,
    /// Local error per step of the head, with its approach bound.
    HeadTolerance,
    /// Residual of the coupled solve.
    CouplingTolerance,
    /// Elements of the solid that the ramp's oscillators were made of.
    RampMesh,
    /// The film held still where the slider came closest.
    HeldFilm,
}

/// All that can be turned; those of a scene come first.
const EVERY: [Knob; 8] = [
    Knob::FilmGrid,
    Knob::DiskModes,
    Knob::SuspensionModes,
    Knob::StructureStep,
    Knob::HeadTolerance,
    Knob::CouplingTolerance,
    Knob::RampMesh,
    Knob::HeldFilm,
];

impl Knob {
    /// Every knob of a scene.
    pub const ALL: [Knob; 6] = *EVERY.first_chunk().expect("fewer than there are");

    /// Word in products.
    pub const fn as_str(self) -> &'static str {
        match self {
            Knob::FilmGrid => "film_grid",
            Knob::DiskModes => "disk_modes",
            Knob::SuspensionModes => "suspension_modes",
            Knob::StructureStep => "structure_step",
            Knob::HeadTolerance => "head_tolerance",
            Knob::CouplingTolerance => "coupling_tolerance",
            Knob::RampMesh => "ramp_mesh",
            Knob::HeldFilm => "held_film",
        }
    }

    /// The knob of a word.
    pub fn from_word(word: &str) -> Option<Knob> {
        EVERY.into_iter().find(|knob| knob.as_str() == word)
    }

    /// Factor by which one step finer divides the knob's error at its formal order.
    pub const fn formal_ratio(self) -> f64 {
        match self {
            Knob::FilmGrid
            | Knob::DiskModes
            | Knob::StructureStep
            | Knob::RampMesh
            | Knob::HeldFilm => 2.0,
            Knob::SuspensionModes | Knob::HeadTolerance => 4.0,
            Knob::CouplingTolerance => 8.0,
        }
    }

    pub(super) fn place(self) -> usize {
        self as usize
    }
}

/// Steps by which each knob is turned; positive is finer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Levels(pub(super) [i8; EVERY.len()]);

impl Levels {
    /// The scene as it is.
    pub const NONE: Levels = Levels([0; EVERY.len()]);

    /// These levels with one knob turned by `steps` more.
    #[must_use]
    pub fn turned(mut self, knob: Knob, steps: i8) -> Levels {
        self.0[knob.place()] += steps;
        self
    }

    /// These levels turned by `more`.
    #[must_use]
    pub fn plus(mut self, more: Levels) -> Levels {
        for (level, steps) in self.0.iter_mut().zip(more.0) {
            *level += steps;
        }
        self
    }

    /// Level of a knob.
    pub fn of(self, knob: Knob) -> i8 {
        self.0[knob.place()]
    }

    /// No knob is turned.
    pub fn is_none(self) -> bool {
        self == Levels::NONE
    }

    /// `film_grid-2 disk_modes+1`; empty when no knob is turned.
    pub fn label(self) -> String {
        let turned = EVERY.into_iter().filter(|&knob| self.of(knob) != 0);
        turned
            .map(|knob| format!("{}{:+}", knob.as_str(), self.of(knob)))
            .collect::<Vec<_>>()
            .join(" ")
    }

    /// Reads a label back.
    pub fn parse(label: &str) -> Option<Levels> {
        let mut levels = Levels::NONE;
        for word in label.split_whitespace() {
            let sign = word.find(['+', '-'])?;
            let (name, steps) = word.split_at(sign);
            levels.0[Knob::from_word(name)?.place()] = steps.parse().ok()?;
        }
        Some(levels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_read_back_and_leave_out_what_is_not_turned() {
        let levels = Levels::NONE
            .turned(Knob::FilmGrid, -2)
            .turned(Knob::StructureStep, 1)
            .turned(Knob::RampMesh, -1);
        assert_eq!(levels.label(), "film_grid-2 structure_step+1 ramp_mesh-1");
        assert_eq!(Levels::parse(&levels.label()), Some(levels));
        assert_eq!(Levels::parse(""), Some(Levels::NONE));
        assert_eq!(Levels::parse("film_grid"), None);
        assert_eq!(Levels::parse("film_grid-x"), None);
    }
}
