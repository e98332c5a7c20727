//! Answer of a population: shares that survive, fragility, sensitivities, the worst drives.

use std::cmp::Ordering;

use serde::Serialize;

use super::fragility::Fragility;
use super::level::{DecidedBy, LevelAnswer};
use super::sensitivity::Sensitivity;
use super::tolerances::Tolerances;
use crate::draws::Share;
use crate::qualification::{Spec, Verdict};

/// Worst drives that are listed.
const LISTED: usize = 10;

/// Answers of a drive.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveAnswer {
    /// Its number, from 0.
    pub index: u64,
    /// By requirement and point.
    pub requirements: Vec<Vec<LevelAnswer>>,
}

impl DriveAnswer {
    /// Verdict on a requirement.
    pub fn verdict(&self, requirement: usize) -> Verdict {
        Verdict::of_all(
            self.requirements[requirement]
                .iter()
                .map(|point| point.verdict),
        )
    }

    /// Verdict on all of them.
    pub fn overall(&self) -> Verdict {
        Verdict::of_all((0..self.requirements.len()).map(|place| self.verdict(place)))
    }

    /// Rank of a point among all, lower is worse: points that fail, the lowest amplitude first; undecided ones; points that pass
    /// by their interval, which are near the required amplitude; others, all of which survive the same two amplitudes. Within
    /// these by their clearance.
    fn rank(point: &LevelAnswer) -> Rank {
        let clearance_m = point.clearance_m.unwrap_or(0.0);
        match (point.verdict, point.by) {
            (Verdict::Fails, _) => (0, point.fails.unwrap_or(0), clearance_m),
            (Verdict::Undecided, _) => (1, 0, clearance_m),
            (Verdict::Passes, DecidedBy::Interval) => (2, 0, clearance_m),
            (Verdict::Passes, _) => (3, 0, clearance_m),
        }
    }

    /// Requirement and point with the lowest rank.
    fn worst(&self) -> Option<(usize, usize, Rank)> {
        let requirements = self.requirements.iter().enumerate();
        let points = requirements.flat_map(|(requirement, points)| {
            let points = points.iter().enumerate();
            points.map(move |(point, answer)| (requirement, point, Self::rank(answer)))
        });
        points.min_by(|a, b| compared(a.2, b.2))
    }
}

/// Group by verdict, step of the lowest failure, clearance in m.
type Rank = (u8, i32, f64);

fn compared(a: Rank, b: Rank) -> Ordering {
    (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2))
}

/// Drives by verdict, and the share that survives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Counts {
    /// Drives that pass.
    pub passing: u64,
    /// Drives that the numerical uncertainty leaves undecided.
    pub undecided: u64,
    /// Drives that fail.
    pub failing: u64,
    /// Share that survives, 95 %: from the exact interval with every undecided drive failing to that with every one passing.
    pub survival: [f64; 2],
}

impl Counts {
    /// Of verdicts.
    pub fn of(verdicts: impl IntoIterator<Item = Verdict>) -> Counts {
        let mut counts = Counts::default();
        for verdict in verdicts {
            match verdict {
                Verdict::Passes => counts.passing += 1,
                Verdict::Undecided => counts.undecided += 1,
                Verdict::Fails => counts.failing += 1,
            }
        }
        let n = counts.passing + counts.undecided + counts.failing;
        let low = Share::of(counts.passing, n).interval[0];
        let high = Share::of(counts.passing + counts.undecided, n).interval[1];
        Counts {
            survival: [low, high],
            ..counts
        }
    }
}

/// Answer of a requirement.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RequirementAnswer {
    /// Name.
    pub name: String,
    /// Amplitude that every point must survive, G.
    pub required_g: f64,
    /// Drives by verdict.
    #[serde(flatten)]
    pub counts: Counts,
    /// Drives with a point whose verdict took a shock at a finer resolution.
    pub by_finer_shock: u64,
    /// Drives with a point whose verdict is that of an uncertainty interval.
    pub by_interval: u64,
    /// Fragility curve of each pulse width.
    pub fragility: Vec<Fragility>,
}

/// A drive that is listed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorstDrive {
    /// Its number, from 1.
    pub drive: u64,
    /// Its verdict.
    pub verdict: Verdict,
    /// Requirement that is worst for it.
    pub requirement: String,
    /// The point that is worst for it.
    pub point: String,
    /// Highest amplitude tested and survived, and lowest one that fails where that was sought, G.
    pub bracket_g: [Option<f64>; 2],
    /// Smallest clearance at the higher survivor of the two amplitudes of its verdict, m.
    pub clearance_m: Option<f64>,
    /// Values by key; an absent key has none.
    pub values: Vec<(String, Option<String>)>,
}

/// Answer of a population.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PopulationAnswer {
    /// Name.
    pub name: String,
    /// Specification.
    pub specification: String,
    /// Seed of the draws.
    pub seed: u64,
    /// Drives.
    pub drives: u64,
    /// Drives of the fragility curves: the first ones.
    pub fragility_drives: u64,
    /// Drives by verdict on all requirements.
    #[serde(flatten)]
    pub all: Counts,
    /// By requirement.
    pub requirements: Vec<RequirementAnswer>,
    /// By tolerance and measured key, the largest first-order index first; nothing where every drive passes.
    pub sensitivity: Vec<Sensitivity>,
    /// The worst drives.
    pub worst: Vec<WorstDrive>,
}

impl PopulationAnswer {
    /// Of all drives of a population, in their order; `spec` is that of the study without tolerances.
    pub fn of(tolerances: &Tolerances, spec: &Spec, drives: &[DriveAnswer]) -> PopulationAnswer {
        let requirements = (0..spec.requirements.len())
            .map(|place| requirement(spec, place, drives, tolerances.fragility_drives));
        PopulationAnswer {
            name: tolerances.name.clone(),
            specification: spec.name.clone(),
            seed: tolerances.seed,
            drives: drives.len() as u64,
            fragility_drives: tolerances.fragility_drives,
            all: Counts::of(drives.iter().map(DriveAnswer::overall)),
            requirements: requirements.collect(),
            sensitivity: sensitivity(tolerances, drives),
            worst: worst(tolerances, spec, drives),
        }
    }
}

fn requirement(
    spec: &Spec,
    place: usize,
    drives: &[DriveAnswer],
    fragility_drives: u64,
) -> RequirementAnswer {
    let one = &spec.requirements[place];
    let points = one.study.table_order().into_iter();
    let widths: Vec<f64> = points
        .map(|point| one.study.points[point].pulse_ms)
        .collect();
    let mut all_widths = widths.clone();
    all_widths.sort_by(f64::total_cmp);
    all_widths.dedup();
    let bracketed = drives.iter().filter(|drive| drive.index < fragility_drives);
    let bracketed: Vec<&DriveAnswer> = bracketed.collect();
    let lowest = |drive: &DriveAnswer, width: f64| {
        let points = drive.requirements[place].iter().zip(&widths);
        let of_width = points.filter(|(_, own)| **own == width);
        let failing = of_width.filter_map(|(point, _)| Some((point.fails?, point.survives)));
        match failing.min() {
            Some((fails, survives)) => (Some(fails), survives == Some(fails - 1)),
            None => (None, false),
        }
    };
    let fragility = all_widths.into_iter().filter(|_| !bracketed.is_empty());
    let fragility = fragility.map(|width| {
        let lowest: Vec<_> = bracketed.iter().map(|drive| lowest(drive, width)).collect();
        Fragility::of(width, one.required_g(), &lowest)
    });
    let decided = |by: DecidedBy| {
        let has = |drive: &&DriveAnswer| {
            let mut points = drive.requirements[place].iter();
            points.any(|point| point.by == by)
        };
        drives.iter().filter(has).count() as u64
    };
    RequirementAnswer {
        name: one.name.clone(),
        required_g: one.required_g(),
        counts: Counts::of(drives.iter().map(|drive| drive.verdict(place))),
        by_finer_shock: decided(DecidedBy::FinerShock),
        by_interval: decided(DecidedBy::Interval),
        fragility: fragility.collect(),
    }
}

fn sensitivity(tolerances: &Tolerances, drives: &[DriveAnswer]) -> Vec<Sensitivity> {
    let fails: Vec<bool> = drives
        .iter()
        .map(|drive| drive.overall() != Verdict::Passes)
        .collect();
    if !fails.contains(&true) {
        return Vec::new();
    }
    let values: Vec<Vec<f64>> = drives
        .iter()
        .map(|drive| tolerances.ranks(&tolerances.draw(drive.index)))
        .collect();
    let names = tolerances.ranked_names().into_iter().enumerate();
    let mut all: Vec<Sensitivity> = names
        .map(|(place, name)| {
            let own: Vec<f64> = values.iter().map(|row| row[place]).collect();
            Sensitivity::of(name, tolerances.seed, &own, &fails)
        })
        .collect();
    all.sort_by(|a, b| b.first_order.total_cmp(&a.first_order));
    all
}

fn worst(tolerances: &Tolerances, spec: &Spec, drives: &[DriveAnswer]) -> Vec<WorstDrive> {
    let mut ranked: Vec<_> = drives
        .iter()
        .filter_map(|drive| Some((drive, drive.worst()?)))
        .collect();
    ranked.sort_by(|(a, (.., x)), (b, (.., y))| compared(*x, *y).then(a.index.cmp(&b.index)));
    ranked.truncate(LISTED);
    let listed = ranked.into_iter().map(|(drive, (place, point, _))| {
        let requirement = &spec.requirements[place];
        let answer = drive.requirements[place][point];
        let study_point = requirement.study.table_order()[point];
        let amplitude_g = |step| super::level::amplitude_g(requirement.required_g(), step);
        WorstDrive {
            drive: drive.index + 1,
            verdict: drive.overall(),
            requirement: requirement.name.clone(),
            point: requirement.study.points[study_point].label(),
            bracket_g: [answer.survives, answer.fails].map(|step| step.map(amplitude_g)),
            clearance_m: answer.clearance_m,
            values: tolerances.values(&tolerances.draw(drive.index)),
        }
    });
    listed.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_point_of_a_drive_is_one_of_its_own_verdict() {
        let point = |verdict, is_near, fails, clearance_nm: f64| LevelAnswer {
            verdict,
            by: match is_near {
                true => DecidedBy::Interval,
                false => DecidedBy::Shocks,
            },
            survives: None,
            fails,
            clearance_m: Some(1e-9 * clearance_nm),
        };
        let fails = |step| point(Verdict::Fails, false, Some(step), 0.0);
        let undecided = point(Verdict::Undecided, true, Some(0), 0.1);
        let near = point(Verdict::Passes, true, Some(2), 9.0);
        let far = |clearance_nm| point(Verdict::Passes, false, None, clearance_nm);
        let worst = |points: &[LevelAnswer]| {
            let drive = DriveAnswer {
                index: 0,
                requirements: vec![points.to_vec()],
            };
            drive.worst().map(|(_, point, _)| point)
        };
        // Failing above the required amplitude, as an interval may say, is worse than undecided.
        assert_eq!(worst(&[undecided, fails(1), near]), Some(1));
        assert_eq!(worst(&[fails(-2), fails(-16), undecided]), Some(1));
        assert_eq!(worst(&[far(0.5), near, far(1.0)]), Some(1));
        assert_eq!(worst(&[far(0.5), far(0.2), far(1.0)]), Some(1));
    }

    #[test]
    fn undecided_drives_count_both_ways() {
        let verdicts = |passing: usize, undecided: usize, failing: usize| {
            let passing = std::iter::repeat_n(Verdict::Passes, passing);
            let undecided = std::iter::repeat_n(Verdict::Undecided, undecided);
            passing
                .chain(undecided)
                .chain(std::iter::repeat_n(Verdict::Fails, failing))
        };
        // binom.test(90, 100) of R begins at 0.823777, binom.test(95, 100) ends at 0.983566.
        let [low, high] = Counts::of(verdicts(90, 5, 5)).survival;
        assert!(
            (low - 0.823_777).abs() < 1e-5 && (high - 0.983_566).abs() < 1e-5,
            "{low} {high}"
        );
        // None of 2995 fails: 99.9 % survive, with 95 % confidence (0.999^2995 = 0.04996).
        let [low, high] = Counts::of(verdicts(2995, 0, 0)).survival;
        assert!((0.999..0.999_01).contains(&low) && high == 1.0, "{low}");
        assert!(Counts::of(verdicts(2994, 0, 0)).survival[0] < 0.999);
    }
}
