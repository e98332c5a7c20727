//! The answer of a population in sentences, and its tables.

use crate::draws::Share;
use crate::population::{
    Counts, DriveAnswer, PopulationAnswer, Sensitivity, Tolerances, WorstDrive,
};
use crate::qualification::Spec;

/// A population with its answer.
#[derive(Clone, Debug)]
pub struct Populated<'a> {
    /// Name of the study.
    pub study: &'a str,
    /// Its file, and the settings that the command line laid over it.
    pub drive: &'a str,
    /// Program that simulated the drives.
    pub program: &'a str,
    /// Tolerances.
    pub tolerances: &'a Tolerances,
    /// Specification, of the study without tolerances.
    pub spec: &'a Spec,
    /// Every drive.
    pub drives: &'a [DriveAnswer],
    /// The answer.
    pub answer: &'a PopulationAnswer,
}

impl Populated<'_> {
    /// The answer: the share that survives, the requirement that costs most, what matters.
    pub fn sentences(&self) -> Vec<String> {
        let answer = self.answer;
        let mut sentences = vec![format!(
            "{}: {} of the drives survive \"{}\" (95 % confidence; {}).",
            answer.name,
            between(answer.all.survival),
            answer.specification,
            counted(&answer.all)
        )];
        if answer.all.undecided > 0 {
            sentences.push(format!(
                "The numerical uncertainty leaves {} of {} drives undecided: the lower end counts them as failing, the upper end as \
                 surviving.",
                answer.all.undecided, answer.drives
            ));
        }
        let lowest = answer
            .requirements
            .iter()
            .min_by_key(|one| one.counts.passing);
        if let Some(lowest) = lowest.filter(|_| answer.requirements.len() > 1) {
            sentences.push(format!(
                "Fewest survive \"{}\": {}.",
                lowest.name,
                between(lowest.counts.survival)
            ));
        }
        let significant: Vec<&Sensitivity> = answer
            .sensitivity
            .iter()
            .filter(|one| one.is_significant)
            .collect();
        match significant.first() {
            Some(first) => sentences.push(format!(
                "The tolerance that decides most is {}: it explains {:.0} % ({:.0} to {:.0} %) of the variance of the verdict.{}",
                first.name,
                100.0 * first.first_order,
                100.0 * first.interval[0],
                100.0 * first.interval[1],
                match answer.sensitivity.len() - significant.len() {
                    0 => String::new(),
                    others => format!(" {others} of {} cannot be distinguished from chance.", answer.sensitivity.len()),
                }
            )),
            None if answer.all.failing + answer.all.undecided > 0 => sentences.push(
                "No tolerance can be distinguished from chance: too few drives fail, or no single one decides.".to_owned(),
            ),
            None => sentences.push("None fails, so that no tolerance can be ranked.".to_owned()),
        }
        sentences
    }

    /// A line for each requirement, and one for all of them.
    pub(in crate::report) fn requirements(&self) -> (Vec<String>, Vec<Vec<String>>) {
        let header = [
            "requirement",
            "required (G)",
            "survive",
            "undecided",
            "fail",
            "decided by a finer shock",
            "decided by uncertainty interval",
            "share that survives, 95 %",
        ];
        let row = |name: &str, required: String, counts: &Counts, by: [String; 2]| {
            let [by_finer_shock, by_interval] = by;
            vec![
                name.to_owned(),
                required,
                counts.passing.to_string(),
                counts.undecided.to_string(),
                counts.failing.to_string(),
                by_finer_shock,
                by_interval,
                between(counts.survival),
            ]
        };
        let mut rows: Vec<Vec<String>> = self
            .answer
            .requirements
            .iter()
            .map(|one| {
                let by = [one.by_finer_shock, one.by_interval].map(|count| count.to_string());
                row(&one.name, format!("{:.1}", one.required_g), &one.counts, by)
            })
            .collect();
        if rows.len() > 1 {
            rows.push(row(
                "all",
                String::new(),
                &self.answer.all,
                Default::default(),
            ));
        }
        (header.map(String::from).to_vec(), rows)
    }

    /// A line for each tolerance.
    pub(in crate::report) fn sensitivities(&self) -> (Vec<String>, Vec<Vec<String>>) {
        let header = [
            "tolerance",
            "explains (%)",
            "95 %",
            "not passing: lowest quarter",
            "middle half",
            "highest quarter",
            "significant?",
        ];
        let rows = self.answer.sensitivity.iter().map(|one| {
            let parts = &one.not_passing;
            vec![
                one.name.clone(),
                format!("{:.1}", 100.0 * one.first_order),
                format!(
                    "{:.1} to {:.1}",
                    100.0 * one.interval[0],
                    100.0 * one.interval[1]
                ),
                share(&parts.lowest_quarter),
                share(&parts.middle_half),
                share(&parts.highest_quarter),
                if one.is_significant { "yes" } else { "no" }.to_owned(),
            ]
        });
        (header.map(String::from).to_vec(), rows.collect())
    }

    /// A line for each of the worst drives.
    pub(in crate::report) fn worst(&self) -> (Vec<String>, Vec<Vec<String>>) {
        let header = [
            "drive",
            "verdict",
            "at",
            "highest survived (G)",
            "lowest failed (G)",
            "clearance (nm)",
            "its values",
        ];
        let rows = self.answer.worst.iter().map(|one| {
            let amplitude = |amplitude_g: Option<f64>| {
                amplitude_g.map_or(String::new(), |amplitude_g| format!("{amplitude_g:.0}"))
            };
            vec![
                one.drive.to_string(),
                one.verdict.as_str().to_owned(),
                format!("{}, {}", one.requirement, one.point),
                amplitude(one.bracket_g[0]),
                amplitude(one.bracket_g[1]),
                one.clearance_m.map_or(String::new(), |clearance_m| {
                    format!("{:.2}", 1e9 * clearance_m)
                }),
                values(one),
            ]
        });
        (header.map(String::from).to_vec(), rows.collect())
    }

    /// How the drives were drawn and judged.
    pub(in crate::report) fn basis(&self) -> String {
        format!(
            "{} drives, fixed before the first was simulated, each an independent draw (seed {}). A drive survives a requirement when every \
             point of it does. Three shocks judge a point: at the required amplitude, there a step coarser in everything, and at 1.19 times it (a \
             1.19th of it where it fails). It passes when it survives all three and its smallest clearance stays above that of failure less three \
             times its change by the coarser step, and fails when it fails all three. Where the coarser shock leaves this open, one at a step finer \
             takes its place. Any other point is decided by the uncertainty interval of its critical shock, or undecided. Amplitudes between \
             these, lower ones, and a longer simulated time are not looked at. Intervals of shares are exact binomial ones (Clopper and Pearson 1934).",
            self.answer.drives, self.answer.seed
        )
    }
}

/// Values of a listed drive.
pub(super) fn values(drive: &WorstDrive) -> String {
    let values = drive.values.iter();
    let words = values.map(|(key, value)| {
        let value = value.as_deref().unwrap_or("absent");
        let short = value.parse::<f64>().map_or(value.to_owned(), short);
        format!("{key}={short}")
    });
    words.collect::<Vec<_>>().join(" ")
}

/// A number to four digits.
fn short(value: f64) -> String {
    let digits = value.abs().max(f64::MIN_POSITIVE).log10().floor();
    let after_point = (3.0 - digits).clamp(0.0, 12.0) as usize;
    format!("{value:.after_point$}")
}

fn counted(counts: &Counts) -> String {
    let all = counts.passing + counts.undecided + counts.failing;
    format!(
        "{} of {all} survive, {} fail",
        counts.passing, counts.failing
    )
}

/// `99.30 to 99.79 %`.
fn between([low, high]: [f64; 2]) -> String {
    // Outwards, so that rounding claims nothing.
    let (low, high) = ((1e4 * low).floor() / 100.0, (1e4 * high).ceil() / 100.0);
    format!("{low:.2} to {high:.2} %")
}

fn share(share: &Share) -> String {
    let [low, high] = share.interval;
    format!(
        "{:.1} % ({:.1} to {:.1})",
        100.0 * share.with as f64 / (share.of.max(1)) as f64,
        100.0 * low,
        100.0 * high
    )
}

#[cfg(test)]
mod tests {
    use super::{between, short};

    #[test]
    fn rounding_widens_an_interval() {
        assert_eq!(between([0.998_999_9, 0.999_911]), "99.89 to 100.00 %");
        assert_eq!(between([0.0, 0.5]), "0.00 to 50.00 %");
    }

    #[test]
    fn numbers_have_four_digits() {
        assert_eq!(
            [6.2e-5, 28.4563, 1000.4, 0.0].map(short),
            ["0.00006200", "28.46", "1000", "0.000000000000"]
        );
    }
}
