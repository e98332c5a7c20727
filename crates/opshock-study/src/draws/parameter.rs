//! Distributions of parameters of a study, and points of their ranges.
//!
//! A point is given by one number from 0 to 1 for every parameter, its cumulative probability: where these are
//! uniform and independent, the values are independent draws.

use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use statrs::distribution::{ContinuousCDF as _, Normal};

/// One parameter: a key of the study, or several that change together.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name.
    pub name: String,
    /// Keys, each with the study's own value where values are relative to it.
    pub keys: Vec<(String, Option<f64>)>,
    /// Its distribution.
    pub distribution: Distribution,
    /// Probability that the keys are absent from the study, as for a hard contact.
    pub unset_share: f64,
    /// Source of the range.
    pub source: String,
    /// Cumulative probability from which the refinement starts: of the guess, or of the study's own value (the nearer
    /// end where that is outside the range, the first choice where it is none of them).
    pub start: f64,
}

/// Distribution of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    /// Uniform between two values.
    Uniform([f64; 2]),
    /// Log-uniform between two values.
    LogUniform([f64; 2]),
    /// Normal with mean and standard deviation, cut off outside a range.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation.
        sd: f64,
        /// Ends of the range.
        range: [f64; 2],
    },
    /// One of a list, as TOML, all equally likely.
    Choices(Vec<String>),
}

/// A parameter's value.
#[derive(Clone, Debug, PartialEq)]
pub enum ParameterValue {
    /// A number.
    Number(f64),
    /// One of the choices, by its place.
    Choice(usize),
    /// The keys are absent.
    Unset,
}

impl Distribution {
    /// Whether a number is in the range.
    pub(super) fn has(&self, value: f64) -> bool {
        match self {
            Distribution::Uniform([low, high])
            | Distribution::LogUniform([low, high])
            | Distribution::Normal {
                range: [low, high], ..
            } => (*low..=*high).contains(&value),
            Distribution::Choices(list) => list.iter().any(|text| text.parse() == Ok(value)),
        }
    }

    /// Cumulative probability of a value; of a choice, the middle of the probabilities that give it.
    pub(super) fn probability(&self, value: Option<f64>) -> f64 {
        let share =
            |low: f64, high: f64| ((value.unwrap_or(low) - low) / (high - low)).clamp(0.0, 1.0);
        match self {
            Distribution::Uniform([low, high]) => share(*low, *high),
            Distribution::LogUniform([low, high]) => {
                let of = value.unwrap_or(*low).max(*low);
                ((of / low).ln() / (high / low).ln()).clamp(0.0, 1.0)
            }
            Distribution::Normal { mean, sd, range } => {
                let normal = Normal::new(*mean, *sd).expect("checked when read");
                let [below, above] = range.map(|end| normal.cdf(end));
                let at = normal.cdf(value.unwrap_or(*mean));
                ((at - below) / (above - below)).clamp(0.0, 1.0)
            }
            Distribution::Choices(list) => {
                let is_own = |text: &String| {
                    text.parse::<f64>()
                        .ok()
                        .is_some_and(|one| Some(one) == value)
                };
                let place = list.iter().position(is_own).unwrap_or(0);
                (place as f64 + 0.5) / list.len() as f64
            }
        }
    }
}

impl Parameter {
    /// The value at a cumulative probability.
    pub fn value(&self, probability: f64) -> ParameterValue {
        if probability < self.unset_share {
            return ParameterValue::Unset;
        }
        let p = ((probability - self.unset_share) / (1.0 - self.unset_share)).clamp(0.0, 1.0);
        ParameterValue::Number(match &self.distribution {
            Distribution::Uniform([low, high]) => low + p * (high - low),
            Distribution::LogUniform([low, high]) => low * (high / low).powf(p),
            Distribution::Normal { mean, sd, range } => {
                let normal = Normal::new(*mean, *sd).expect("checked when read");
                let [below, above] = range.map(|end| normal.cdf(end));
                let value = normal.inverse_cdf(below + p * (above - below));
                value.clamp(range[0], range[1])
            }
            Distribution::Choices(list) => {
                let place = (p * list.len() as f64) as usize;
                return ParameterValue::Choice(place.min(list.len() - 1));
            }
        })
    }

    /// The list of choices, as TOML; empty for numbers, and for a parameter that may be absent.
    pub fn choices(&self) -> &[String] {
        match &self.distribution {
            Distribution::Choices(list) if self.unset_share == 0.0 => list,
            _ => &[],
        }
    }

    /// Probabilities that give its extreme values, the absent one, and every choice.
    pub fn extremes(&self) -> Vec<f64> {
        let of_values = match &self.distribution {
            Distribution::Choices(list) => {
                let n = list.len() as f64;
                (0..list.len())
                    .map(|place| (place as f64 + 0.5) / n)
                    .collect()
            }
            _ => vec![0.0, 1.0],
        };
        let present = of_values.into_iter();
        let present = present.map(|p| self.unset_share + (1.0 - self.unset_share) * p);
        let absent = (self.unset_share > 0.0).then_some(0.0);
        absent.into_iter().chain(present).collect()
    }

    /// The middle of the probabilities that give the same choice; a number's probability is unchanged.
    pub fn middle_of_choice(&self, probability: f64) -> f64 {
        match self.choices().len() {
            0 => probability,
            count => {
                let place = ((probability * count as f64) as usize).min(count - 1);
                (place as f64 + 0.5) / count as f64
            }
        }
    }

    /// `--set` and `--unset` arguments: key and text, which is absent where the key is removed.
    pub fn settings(&self, probability: f64) -> Vec<(String, Option<String>)> {
        let value = self.value(probability);
        let of = |(key, own): &(String, Option<f64>)| {
            let text = match &value {
                ParameterValue::Unset => None,
                ParameterValue::Choice(place) => match &self.distribution {
                    Distribution::Choices(list) => Some(list[*place].clone()),
                    _ => unreachable!("choices alone give a place"),
                },
                ParameterValue::Number(value) => Some(format!("{:?}", own.unwrap_or(1.0) * value)),
            };
            (key.clone(), text)
        };
        self.keys.iter().map(of).collect()
    }

    /// The value as text, of the first key.
    pub fn words(&self, probability: f64) -> String {
        let settings = self.settings(probability);
        settings[0].1.clone().unwrap_or_else(|| "absent".to_owned())
    }
}

/// Draw number `index`: independent of all others.
pub fn draw(seed: u64, index: u64, parameters: usize) -> Vec<f64> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream(index);
    (0..parameters).map(|_| generator.random()).collect()
}

/// Numbers from 0 to 1 for a step of a search: independent for every `stage` and `index`.
pub fn numbers(seed: u64, stage: u32, index: u64) -> impl FnMut() -> f64 {
    let mut generator = ChaCha8Rng::seed_from_u64(seed ^ (u64::from(stage) << 32));
    generator.set_stream(index | 1 << 63);
    move || generator.random()
}

/// Point `index` of a sequence that fills the unit cube evenly (Sobol' 1967; Owen's scrambling by the hash of Burley
/// 2020, J. Computer Graphics Techniques 9(4)).
pub fn filling(seed: u64, index: u32, parameters: usize) -> Vec<f64> {
    let of = |dimension: usize| {
        // Sets of 256 dimensions, each with a scrambling of its own.
        let set = (dimension / 256) as u32;
        let seed = (seed ^ seed >> 32) as u32 ^ set;
        f64::from(sobol_burley::sample(
            index % (1 << 16),
            (dimension % 256) as u32,
            seed,
        ))
    };
    (0..parameters).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameter(distribution: Distribution, unset_share: f64) -> Parameter {
        Parameter {
            name: "x".into(),
            keys: vec![("disk.rpm".into(), None)],
            distribution,
            unset_share,
            source: String::new(),
            start: 0.5,
        }
    }

    #[test]
    fn the_probability_of_a_value_gives_it_back() {
        let normal = Distribution::Normal {
            mean: 3.0,
            sd: 1.0,
            range: [2.0, 5.0],
        };
        let (even, ratios) = (
            Distribution::Uniform([2.0, 5.0]),
            Distribution::LogUniform([2.0, 5.0]),
        );
        for distribution in [normal, even, ratios] {
            let p = distribution.probability(Some(2.6));
            let ParameterValue::Number(value) = parameter(distribution.clone(), 0.0).value(p)
            else {
                panic!("a number");
            };
            assert!((value - 2.6).abs() < 1e-9, "{distribution:?}: {value}");
            // Outside the range, its nearer end.
            assert_eq!(
                [1.0, 9.0].map(|one| distribution.probability(Some(one))),
                [0.0, 1.0]
            );
        }
        let choices = Distribution::Choices(vec!["20".into(), "40".into()]);
        assert_eq!(choices.probability(Some(40.0)), 0.75);
        assert_eq!(choices.probability(None), 0.25);
    }

    #[test]
    fn values_have_their_distributions() {
        let number =
            |distribution: Distribution, p: f64| match parameter(distribution, 0.0).value(p) {
                ParameterValue::Number(value) => value,
                other => panic!("{other:?}"),
            };
        assert!((number(Distribution::Uniform([2.0, 6.0]), 0.25) - 3.0).abs() < 1e-15);
        assert!((number(Distribution::LogUniform([1.0, 100.0]), 0.5) - 10.0).abs() < 1e-12);
        let normal = |p| {
            let cut = Distribution::Normal {
                mean: 1.0,
                sd: 0.5,
                range: [-10.0, 10.0],
            };
            number(cut, p)
        };
        // Quantiles of the normal distribution (Abramowitz and Stegun, table 26.5).
        assert!((normal(0.975) - (1.0 + 0.5 * 1.959_963_985)).abs() < 1e-7);
        let cut = Distribution::Normal {
            mean: 0.0,
            sd: 1.0,
            range: [0.0, 10.0],
        };
        assert!((number(cut, 0.5) - 0.674_489_750).abs() < 1e-7);
    }

    #[test]
    fn keys_are_absent_with_their_share_and_choices_alike() {
        let contact = parameter(Distribution::LogUniform([3e5, 1e7]), 0.5);
        let n = 4000;
        let absent = (0..n).filter(|k| contact.value(draw(7, *k, 1)[0]) == ParameterValue::Unset);
        // Six standard deviations of the binomial distribution.
        assert!((absent.count() as f64 - 2000.0).abs() < 6.0 * 1000f64.sqrt());
        let modes = parameter(Distribution::Choices(vec!["16".into(), "32".into()]), 0.0);
        assert_eq!(
            modes.settings(0.49),
            [("disk.rpm".into(), Some("16".into()))]
        );
        assert_eq!(
            modes.settings(0.51),
            [("disk.rpm".into(), Some("32".into()))]
        );
    }

    #[test]
    fn draws_differ_and_repeat_and_fill() {
        assert_eq!(draw(1, 5, 3), draw(1, 5, 3));
        assert_ne!(draw(1, 5, 3), draw(1, 6, 3));
        assert_ne!(draw(1, 5, 3), draw(2, 5, 3));
        // Sixteen points of a scrambled Sobol' sequence lie in one sixteenth of each axis each.
        for dimension in 0..3 {
            let mut places: Vec<u32> = (0..16)
                .map(|k| (16.0 * filling(3, k, 3)[dimension]) as u32)
                .collect();
            places.sort_unstable();
            assert_eq!(places, (0..16).collect::<Vec<_>>());
        }
    }
}
