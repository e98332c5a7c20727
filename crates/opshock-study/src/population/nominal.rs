//! The study without tolerances: films and structures that drives have in common with it are built once, when the first of them asks.

use std::sync::OnceLock;

use crate::study::Study;
use crate::sweep::Physics;

/// A study without tolerances.
pub struct Nominal<'a> {
    study: &'a Study,
    physics: OnceLock<Physics>,
    finer: OnceLock<()>,
}

impl<'a> Nominal<'a> {
    /// Of a study.
    pub fn of(study: &'a Study) -> Self {
        Self {
            study,
            physics: OnceLock::new(),
            finer: OnceLock::new(),
        }
    }

    /// The physics of another study, with what it has in common with this one at its resolution and a step coarser.
    pub fn shared_by(&self, study: &Study) -> Physics {
        Physics::of(study).sharing(self.physics())
    }

    /// What is shared, with the films a step finer.
    pub fn finer(&self) -> &Physics {
        let physics = self.physics();
        self.finer
            .get_or_init(|| physics.build_films(self.study, 1));
        physics
    }

    fn physics(&self) -> &Physics {
        self.physics.get_or_init(|| {
            let physics = Physics::of(self.study);
            physics.build_films(self.study, -1);
            physics
        })
    }
}
