//! Rules about the forces between slider and disk other than the air's.

use super::check::Check;
use crate::study::fields;
use crate::study::words::Criterion;
use opshock_solver::air_bearing::GapForces;

/// Limits of damage.
pub(super) const DAMAGE: [&str; 3] = [
    fields::FAILURE_DAMAGE_OVERLAP_NM.path(),
    fields::FAILURE_DAMAGE_PRESSURE_GPA.path(),
    fields::FAILURE_DAMAGE_CONTACTS.path(),
];

impl Check<'_, '_> {
    /// A repulsion belongs to the attraction that it ends.
    pub(super) fn surface_forces(&mut self) {
        const PATHS: [&str; 2] = [
            fields::SURFACE_FORCES_HAMAKER_J.path(),
            fields::SURFACE_FORCES_REPULSION_J_M6.path(),
        ];
        if !self.sound(&PATHS) {
            return;
        }
        let [attraction, repulsion] = PATHS.map(|path| self.view.maybe_number(path).unwrap_or(0.0));
        if repulsion > 0.0 && attraction == 0.0 {
            let message = "a repulsion without the attraction that it ends";
            let fault = self.fault("E125", &PATHS[1..], message);
            fault.allowed = "a repulsion beside hamaker_j > 0".to_string();
            fault.hint = "give hamaker_j, or leave the repulsion out".to_string();
        }
    }

    /// Damage is what contact of asperities does, beyond a limit that it can exceed.
    pub(super) fn damage(&mut self) {
        const CRITERION: &str = fields::FAILURE_CRITERION.path();
        const ROUGHNESS: &str = fields::ASPERITY_CONTACT_ROUGHNESS_NM.path();
        if !self.sound(&[CRITERION, ROUGHNESS])
            || self.view.get(&fields::FAILURE_CRITERION) != Some(Criterion::Damage)
        {
            return;
        }
        let has = |path: &&str| self.view.settings.has(path);
        let (has_contact, has_limit) = (has(&ROUGHNESS), DAMAGE.iter().any(has));
        let (message, allowed) = match (has_contact, has_limit) {
            (true, true) => return self.reachable_pressure(),
            (false, _) => (
                "damage of smooth surfaces, whose contact is not simulated",
                "with asperity_contact.roughness_nm".to_string(),
            ),
            (true, false) => (
                "damage without any limit of contact",
                format!("with one or more of {}", DAMAGE.join(", ")),
            ),
        };
        let fault = self.fault("E127", &[CRITERION], message);
        fault.hint = format!("run {allowed}, or take touch");
        fault.allowed = allowed;
    }

    /// Yielding keeps a contact's pressure below that of the asperities' yielding.
    fn reachable_pressure(&mut self) {
        const PRESSURE: &str = fields::FAILURE_DAMAGE_PRESSURE_GPA.path();
        const YIELDING: &str = fields::ASPERITY_CONTACT_YIELD_PRESSURE_GPA.path();
        if !self.sound(&[PRESSURE, YIELDING]) {
            return;
        }
        let limit_pa = self.view.get(&fields::FAILURE_DAMAGE_PRESSURE_GPA);
        let yields_pa = self.view.get(&fields::ASPERITY_CONTACT_YIELD_PRESSURE_GPA);
        let most_pa = yields_pa.unwrap_or(GapForces::default().asperity_contact.yield_pressure_pa);
        if limit_pa.is_some_and(|limit_pa| limit_pa >= most_pa) {
            let message = "no contact has a pressure above that at which asperities yield";
            let fault = self.fault("E127", &[PRESSURE], message);
            fault.allowed = format!("below {YIELDING}, {} GPa", most_pa / 1e9);
            fault.hint = format!("lower the limit, or raise {YIELDING}");
        }
    }

    /// Asperities are those of rough surfaces, between which no other force is known.
    pub(super) fn asperity_contact(&mut self) {
        const ROUGHNESS: &str = fields::ASPERITY_CONTACT_ROUGHNESS_NM.path();
        const ASPERITIES: [&str; 5] = [
            fields::ASPERITY_CONTACT_ASPERITIES_PER_UM2.path(),
            fields::ASPERITY_CONTACT_TIP_RADIUS_UM.path(),
            fields::ASPERITY_CONTACT_MODULUS_GPA.path(),
            fields::ASPERITY_CONTACT_YIELD_PRESSURE_GPA.path(),
            fields::ASPERITY_CONTACT_FRICTION.path(),
        ];
        const FORCES: [&str; 2] = [
            fields::SURFACE_FORCES_HAMAKER_J.path(),
            fields::SURFACE_FORCES_POTENTIAL_V.path(),
        ];
        if !self.sound(&[ROUGHNESS]) {
            return;
        }
        let is_rough = self.view.settings.has(ROUGHNESS);
        let (paths, message, allowed, hint): (&[&str], _, _, _) = match is_rough {
            false => (
                &ASPERITIES,
                "asperities of surfaces without roughness",
                "with asperity_contact.roughness_nm",
                "give roughness_nm, or leave the key out",
            ),
            true => (
                &FORCES,
                "a force between smooth surfaces, which are rough here",
                "without asperity_contact.roughness_nm",
                "leave roughness_nm or this key out: the force between rough surfaces is not that at their mean gap",
            ),
        };
        for path in paths {
            if self.view.settings.has(path) {
                let fault = self.fault("E125", &[path], message);
                fault.allowed = allowed.to_string();
                fault.hint = hint.to_string();
            }
        }
    }
}
