//! Lists the paper's statements, each with the bounds between which its number makes it hold.

use super::critical::{self, Parts};
use super::shock_numbers as shock;
use super::shocks::Shocks;
use opshock_study::store::summary::Summary;

/// Where a number comes from.
#[derive(Clone, Copy, Debug)]
pub enum Source {
    /// Disk and ramp of the two shocks; number and note.
    DiskAndRamp(fn(&Shocks) -> (Option<f64>, String)),
    /// The two shocks with the head; number and note.
    Shocks(fn(&Shocks) -> (Option<f64>, String)),
    /// The table of critical shocks.
    Critical(fn(&Summary) -> Parts),
}

/// One statement of the paper.
#[derive(Clone, Copy, Debug)]
pub struct Claim {
    /// Stable name.
    pub id: &'static str,
    /// Section and figure.
    pub place: &'static str,
    /// The paper's words, shortened.
    pub words: &'static str,
    /// What the number is.
    pub number: &'static str,
    /// Its unit; empty for ratios and counts.
    pub unit: &'static str,
    /// Lowest and highest number with which the statement holds; infinite: unbounded.
    pub bounds: (f64, f64),
    /// Where the number comes from.
    pub source: Source,
}

impl Claim {
    /// Whether the statement holds with this number.
    pub fn admits(&self, value: f64) -> bool {
        (self.bounds.0..=self.bounds.1).contains(&value)
    }

    /// How far inside its bounds a number lies; negative outside.
    pub fn margin(&self, value: f64) -> f64 {
        (value - self.bounds.0).min(self.bounds.1 - value)
    }

    /// The bounds in words: `45 to 55 um`, `at least 2`.
    pub fn bounds_words(&self) -> String {
        let unit = match self.unit {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        match self.bounds {
            (low, high) if low == high => format!("{low}{unit}"),
            (low, f64::INFINITY) if low == ABOVE_ZERO => format!("above 0{unit}"),
            (low, f64::INFINITY) => format!("at least {low}{unit}"),
            (f64::NEG_INFINITY, high) => format!("at most {high}{unit}"),
            (low, high) => format!("{low} to {high}{unit}"),
        }
    }
}

/// Anything above zero.
const ABOVE_ZERO: f64 = f64::MIN_POSITIVE;
const NO_LOWER: f64 = f64::NEG_INFINITY;
const NO_UPPER: f64 = f64::INFINITY;

const fn of_shocks(
    id: &'static str,
    place: &'static str,
    words: &'static str,
    number: &'static str,
    unit: &'static str,
    bounds: (f64, f64),
    source: fn(&Shocks) -> (Option<f64>, String),
) -> Claim {
    Claim {
        id,
        place,
        words,
        number,
        unit,
        bounds,
        source: Source::Shocks(source),
    }
}

const fn of_disk(
    id: &'static str,
    place: &'static str,
    words: &'static str,
    number: &'static str,
    unit: &'static str,
    bounds: (f64, f64),
    source: fn(&Shocks) -> (Option<f64>, String),
) -> Claim {
    Claim {
        source: Source::DiskAndRamp(source),
        ..of_shocks(id, place, words, number, unit, bounds, source)
    }
}

const fn of_table(
    id: &'static str,
    words: &'static str,
    number: &'static str,
    unit: &'static str,
    bounds: (f64, f64),
    source: fn(&Summary) -> Parts,
) -> Claim {
    Claim {
        id,
        place: "4.3, Fig. 13",
        words,
        number,
        unit,
        bounds,
        source: Source::Critical(source),
    }
}

/// Every statement, in the order of the paper.
pub const CLAIMS: &[Claim] = &[
    of_disk(
        "pulse",
        "4, Fig. 4",
        "the shock is a half-sine acceleration, given by amplitude and width",
        "deviation from the half-sine",
        "%",
        (0.0, 0.1),
        shock::pulse_shape,
    ),
    of_disk(
        "free_no_contact",
        "4.1, Fig. 6(1)",
        "400 G, 2 ms, no ramp: no contact force",
        "largest contact force",
        "N",
        (0.0, 0.0),
        shock::free_force,
    ),
    of_disk(
        "rigid_touch",
        "4.1, Fig. 6(2)",
        "400 G, 2 ms, rigid: the disk contacts the ramp at 1 ms",
        "first touch",
        "ms",
        (0.95, 1.05),
        shock::rigid_touch,
    ),
    of_disk(
        "rigid_rim",
        "4.1",
        "rigid: the disk's outer radius is limited by the ramp to about 100 um",
        "largest displacement at the ramp",
        "um",
        (90.0, 110.0),
        shock::rigid_ramp_point,
    ),
    of_disk(
        "rigid_slider",
        "4.1, Fig. 5(2)",
        "rigid: the largest displacement at the slider is about 50 um",
        "largest displacement under the slider",
        "um",
        (45.0, 55.0),
        shock::rigid_peak,
    ),
    of_disk(
        "deformable_touch",
        "4.1, Fig. 6(3)",
        "deformable: the disk contacts the top ramp at about 1 ms",
        "first touch",
        "ms",
        (0.9, 1.1),
        shock::deformable_touch,
    ),
    of_disk(
        "deformable_free_rise",
        "4.1, Fig. 5(3)",
        "deformable: the disk moves on upwards almost as without a ramp",
        "peak under the slider over that without a ramp",
        "%",
        (90.0, 110.0),
        shock::deformable_peak,
    ),
    of_disk(
        "deformable_smooth",
        "4.1, Fig. 5",
        "deformable: the disk moves smoothly, unlike with the rigid ramp",
        "distance from the motion without a ramp, over the rigid ramp's",
        "%",
        (NO_LOWER, 50.0),
        shock::deformable_departure,
    ),
    of_disk(
        "three_collisions",
        "4.1, Fig. 7",
        "deformable: three collisions between the disk and the top ramp",
        "contacts with the top arm",
        "",
        (3.0, 3.0),
        shock::top_collisions,
    ),
    of_disk(
        "direction_kept",
        "4.1, Fig. 7",
        "deformable: the disk keeps its direction after the collisions",
        "smallest velocity after over velocity before a collision",
        "",
        (ABOVE_ZERO, NO_UPPER),
        shock::direction_kept,
    ),
    of_disk(
        "rigid_pitch_jump",
        "4.1, Fig. 8(2)",
        "rigid: the disk's pitch changes suddenly at the contact",
        "largest change of the disk's pitch within 50 us, over the deformable ramp's",
        "",
        (2.0, NO_UPPER),
        shock::rigid_pitch_jump,
    ),
    of_disk(
        "deformable_pitch_jump",
        "4.1, Fig. 8(3)",
        "deformable: the pitch of the disk changes too",
        "largest change of the disk's pitch within 50 us, over the rigid ramp's",
        "%",
        (10.0, NO_UPPER),
        shock::deformable_pitch_jump,
    ),
    of_shocks(
        "rigid_modes_excited",
        "4.1, Fig. 8(2)",
        "rigid: high-frequency bending modes of the suspension are excited",
        "slider against disk pitch above 2 kHz, over that without a ramp",
        "",
        (2.0, NO_UPPER),
        shock::rigid_shaking,
    ),
    of_shocks(
        "deformable_modes_excited",
        "4.1, Fig. 8(3)",
        "deformable: high-frequency bending modes of the suspension are excited",
        "slider against disk pitch above 2 kHz, over that without a ramp",
        "",
        (2.0, NO_UPPER),
        shock::deformable_shaking,
    ),
    of_shocks(
        "follows_better",
        "4.1, Fig. 8",
        "deformable: the slider follows the disk much better than with the rigid ramp",
        "slider against disk pitch above 2 kHz, over the rigid ramp's",
        "",
        (NO_LOWER, 0.5),
        shock::follows_better,
    ),
    of_shocks(
        "rigid_fails",
        "4.1, Fig. 9(2)",
        "400 G, 2 ms, rigid: the slider contacts the disk at 1 ms",
        "time of touch",
        "ms",
        (0.95, 1.05),
        shock::rigid_failure,
    ),
    of_shocks(
        "free_survives",
        "4.1, Fig. 9(1)",
        "400 G, 2 ms, no ramp: the slider flies on",
        "smallest clearance",
        "nm",
        (ABOVE_ZERO, NO_UPPER),
        shock::free_survival,
    ),
    of_shocks(
        "deformable_survives",
        "4.1, Fig. 9(3)",
        "400 G, 2 ms, deformable: the slider flies on",
        "smallest clearance",
        "nm",
        (ABOVE_ZERO, NO_UPPER),
        shock::deformable_survival,
    ),
    of_disk(
        "excitation",
        "4.2",
        "0.5 ms excites at 1 kHz, close to the disk's first mode",
        "pulse frequency over that of the axisymmetric mode",
        "",
        (0.9, 1.1),
        shock::excitation,
    ),
    of_disk(
        "free_swing",
        "4.2",
        "without contact the amplitude remains almost constant for some time",
        "last swing over first, no ramp",
        "%",
        (90.0, 110.0),
        shock::free_swing,
    ),
    of_disk(
        "short_rigid_slider",
        "4.2, Fig. 10(1)",
        "200 G, 0.5 ms, rigid: slightly less than 50 um at the slider",
        "largest displacement under the slider",
        "um",
        (45.0, 50.0),
        shock::short_rigid_peak,
    ),
    of_disk(
        "short_rigid_four",
        "4.2, Fig. 11(1)",
        "200 G, 0.5 ms, rigid: four contacts with the ramps",
        "contacts with both arms",
        "",
        (4.0, 4.0),
        shock::short_rigid_contacts,
    ),
    of_disk(
        "short_rigid_light",
        "4.2, Fig. 10(1)",
        "rigid: the contacts affect the disk's motion only slightly",
        "distance from the motion without a ramp, over that motion",
        "%",
        (NO_LOWER, 10.0),
        shock::short_rigid_departure,
    ),
    of_shocks(
        "short_rigid_survives",
        "4.2, Fig. 12(1)",
        "200 G, 0.5 ms, rigid: the slider flies on",
        "smallest clearance",
        "nm",
        (ABOVE_ZERO, NO_UPPER),
        shock::short_rigid_survival,
    ),
    of_disk(
        "short_deformable_decay",
        "4.2, Fig. 10(2)",
        "200 G, 0.5 ms, deformable: the displacement decays noticeably",
        "last swing over first",
        "%",
        (NO_LOWER, 80.0),
        shock::short_deformable_decay,
    ),
    of_disk(
        "short_deformable_turns",
        "4.2, Fig. 11(2)",
        "deformable: top and bottom are contacted in turn",
        "contacts on the other side than the one before",
        "%",
        (90.0, 100.0),
        shock::alternation,
    ),
    of_disk(
        "short_deformable_growth",
        "4.2, Fig. 11(2)",
        "deformable: the contact force increases with time",
        "contacts stronger than the one before",
        "%",
        (80.0, 100.0),
        shock::growth,
    ),
    of_shocks(
        "short_deformable_fails",
        "4.2, Fig. 12(2)",
        "200 G, 0.5 ms, deformable: the slider crashes on the disk",
        "smallest clearance",
        "nm",
        (NO_LOWER, 0.0),
        shock::short_deformable_failure,
    ),
    of_table(
        "rises_none",
        "no ramp: the critical shock increases with the width",
        "smallest ratio of neighbouring widths",
        "",
        (1.0, NO_UPPER),
        critical::rises_none,
    ),
    of_table(
        "rises_rigid",
        "rigid: the critical shock increases with the width",
        "smallest ratio of neighbouring widths",
        "",
        (1.0, NO_UPPER),
        critical::rises_rigid,
    ),
    of_table(
        "rises_deformable",
        "deformable: the critical shock increases with the width",
        "smallest ratio of neighbouring widths",
        "",
        (1.0, NO_UPPER),
        critical::rises_deformable,
    ),
    of_table(
        "signs_close_rigid",
        "rigid: critical shocks of both signs are very close",
        "largest difference of the signs",
        "%",
        (NO_LOWER, 10.0),
        critical::signs_rigid,
    ),
    of_table(
        "signs_close_deformable",
        "deformable: critical shocks of both signs are very close",
        "largest difference of the signs",
        "%",
        (NO_LOWER, 10.0),
        critical::signs_deformable,
    ),
    of_table(
        "signs_apart_none",
        "no ramp: those of both signs are not close",
        "smallest difference of the signs",
        "%",
        (10.0, NO_UPPER),
        critical::signs_none,
    ),
    of_table(
        "deformable_above_rigid",
        "deformable above rigid, except when the width is small (here: from 1 ms)",
        "smallest ratio deformable to rigid",
        "",
        (1.0, NO_UPPER),
        critical::above_when_long,
    ),
    of_table(
        "deformable_below_rigid",
        "deformable not above rigid when the width is small (here: the smallest)",
        "largest ratio deformable to rigid",
        "",
        (NO_LOWER, 1.0),
        critical::below_when_short,
    ),
    of_table(
        "ramps_lower",
        "ramps can adversely affect the drive: critical shocks below those without a ramp",
        "largest ratio to no ramp",
        "",
        (NO_LOWER, 1.0),
        critical::below_none,
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_bounds_are_read_as_written() {
        for (place, claim) in CLAIMS.iter().enumerate() {
            assert!(
                CLAIMS[..place].iter().all(|other| other.id != claim.id),
                "{}",
                claim.id
            );
            assert!(claim.bounds.0 <= claim.bounds.1, "{}", claim.id);
        }
        let words = |id: &str| {
            let claim = CLAIMS.iter().find(|claim| claim.id == id).expect("a claim");
            claim.bounds_words()
        };
        assert_eq!(words("rigid_slider"), "45 to 55 um");
        assert_eq!(words("free_survives"), "above 0 nm");
        assert_eq!(words("three_collisions"), "3");
        assert_eq!(words("follows_better"), "at most 0.5");
        assert_eq!(words("rises_none"), "at least 1");
    }
}
