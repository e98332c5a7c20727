//! Lists the discretisation parameters that trade time for accuracy, and their refinement levels.
//!
//! A [`Levels`] holds the refinement level of each discretisation parameter: 0 is the scene as given, positive is
//! refined. One level divides the parameter's error by its [`Discretisation::formal_ratio`] as far as its formal order
//! holds:
//!
//! | discretisation parameter | one level finer | error falls by | because |
//! |---|---|---|---|
//! | `film_grid` | twice the cells | 2 | second order in the spacing |
//! | `film_correction` | twice the cells of the defect-correction grid | 2 | as the film's grid, or faster |
//! | `disk_modes` | twice the cut frequency | 2 | what a point contact excites falls with 1/f |
//! | `suspension_modes` | twice the modes | 4 | clamped beam, f ~ n² |
//! | `structure_step` | half the step | 2 | contact begins and ends on steps |
//! | `head_tolerance` | an eighth of the tolerance | 4 | local error of a second-order step |
//! | `coupling_tolerance` | an eighth of the tolerance | 8 | the residual itself |
//! | `ramp_mesh` | half the size of the ramp's elements | 2 | stress without bound at inner edges |
//!
//! A ramp enters a scene as oscillators. Whoever computes them from a geometry computes them from another mesh too;
//! [`Scene::at_levels`](super::Scene::at_levels) leaves them as they are, and `ramp_mesh` is not in
//! [`Discretisation::ALL`]. Oscillators that the study itself gives are part of the model and are not refined.
//!
//! `min_film_height` is a regularisation, not a source of discretisation error, and not in [`Discretisation::ALL`] either: a level
//! halves it, so that its effect can be stated.

/// A discretisation parameter, which trades time for accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Discretisation {
    /// Cells of the film.
    FilmGrid,
    /// Cells of the grid that the film's defect correction is sampled on.
    FilmCorrection,
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
    /// Minimum film height, a regularisation.
    MinFilmHeight,
}

/// All that can be refined; the parameters of a scene come first.
const EVERY: [Discretisation; 9] = [
    Discretisation::FilmGrid,
    Discretisation::FilmCorrection,
    Discretisation::DiskModes,
    Discretisation::SuspensionModes,
    Discretisation::StructureStep,
    Discretisation::HeadTolerance,
    Discretisation::CouplingTolerance,
    Discretisation::RampMesh,
    Discretisation::MinFilmHeight,
];

impl Discretisation {
    /// Every discretisation parameter of a scene.
    pub const ALL: [Discretisation; 7] = *EVERY.first_chunk().expect("fewer than there are");

    /// Its name in tables and labels.
    pub const fn as_str(self) -> &'static str {
        match self {
            Discretisation::FilmGrid => "film_grid",
            Discretisation::FilmCorrection => "film_correction",
            Discretisation::DiskModes => "disk_modes",
            Discretisation::SuspensionModes => "suspension_modes",
            Discretisation::StructureStep => "structure_step",
            Discretisation::HeadTolerance => "head_tolerance",
            Discretisation::CouplingTolerance => "coupling_tolerance",
            Discretisation::RampMesh => "ramp_mesh",
            Discretisation::MinFilmHeight => "min_film_height",
        }
    }

    /// The discretisation parameter of a name.
    pub fn from_word(word: &str) -> Option<Discretisation> {
        EVERY
            .into_iter()
            .find(|discretisation| discretisation.as_str() == word)
    }

    /// Factor by which one level finer divides the parameter's error at its formal order; the minimum film height itself.
    pub const fn formal_ratio(self) -> f64 {
        match self {
            Discretisation::FilmGrid
            | Discretisation::FilmCorrection
            | Discretisation::DiskModes
            | Discretisation::StructureStep
            | Discretisation::RampMesh
            | Discretisation::MinFilmHeight => 2.0,
            Discretisation::SuspensionModes | Discretisation::HeadTolerance => 4.0,
            Discretisation::CouplingTolerance => 8.0,
        }
    }

    pub(super) fn place(self) -> usize {
        self as usize
    }
}

/// Refinement level of each discretisation parameter; positive is refined, negative coarsened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Levels(pub(super) [i8; EVERY.len()]);

impl Levels {
    /// The scene as it is.
    pub const NONE: Levels = Levels([0; EVERY.len()]);

    /// These levels with one discretisation parameter refined by `steps` more.
    #[must_use]
    pub fn changed(mut self, discretisation: Discretisation, steps: i8) -> Levels {
        self.0[discretisation.place()] += steps;
        self
    }

    /// These levels plus `more`.
    #[must_use]
    pub fn plus(mut self, more: Levels) -> Levels {
        for (level, steps) in self.0.iter_mut().zip(more.0) {
            *level += steps;
        }
        self
    }

    /// Refinement level of a discretisation parameter.
    pub fn of(self, discretisation: Discretisation) -> i8 {
        self.0[discretisation.place()]
    }

    /// Whether no discretisation parameter is refined or coarsened.
    pub fn is_none(self) -> bool {
        self == Levels::NONE
    }

    /// `film_grid-2 disk_modes+1`; empty when no discretisation parameter is refined or coarsened.
    pub fn label(self) -> String {
        let changed = EVERY
            .into_iter()
            .filter(|&discretisation| self.of(discretisation) != 0);
        changed
            .map(|discretisation| {
                format!("{}{:+}", discretisation.as_str(), self.of(discretisation))
            })
            .collect::<Vec<_>>()
            .join(" ")
    }

    /// Reads a label back.
    pub fn parse(label: &str) -> Option<Levels> {
        let mut levels = Levels::NONE;
        for word in label.split_whitespace() {
            let sign = word.find(['+', '-'])?;
            let (name, steps) = word.split_at(sign);
            levels.0[Discretisation::from_word(name)?.place()] = steps.parse().ok()?;
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
            .changed(Discretisation::FilmGrid, -2)
            .changed(Discretisation::StructureStep, 1)
            .changed(Discretisation::RampMesh, -1);
        assert_eq!(levels.label(), "film_grid-2 structure_step+1 ramp_mesh-1");
        assert_eq!(Levels::parse(&levels.label()), Some(levels));
        assert_eq!(Levels::parse(""), Some(Levels::NONE));
        assert_eq!(Levels::parse("film_grid"), None);
        assert_eq!(Levels::parse("film_grid-x"), None);
    }
}
