//! Decides range, ticks and tick labels of an axis.

/// Spacing of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps.
    Linear,
    /// Equal ratios.
    Log,
}

/// An axis; what is `None` follows from the data.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// Spacing.
    pub scale: Scale,
    /// Range.
    pub range: Option<(f64, f64)>,
    /// Labelled values.
    pub ticks: Option<Vec<f64>>,
    /// Words in place of the numbers at given ticks.
    pub names: Vec<String>,
    /// On an ordinate: a unit is as long as on the abscissa. The range of one of the axes then
    /// grows about its middle. For drawings.
    pub is_to_scale: bool,
}

impl Axis {
    /// A linear axis that follows its data.
    pub fn linear(label: &str) -> Self {
        Self {
            label: label.into(),
            scale: Scale::Linear,
            range: None,
            ticks: None,
            names: Vec::new(),
            is_to_scale: false,
        }
    }

    /// A logarithmic axis that follows its data.
    pub fn log(label: &str) -> Self {
        Self {
            scale: Scale::Log,
            ..Self::linear(label)
        }
    }

    /// The same ordinate with units as long as on the abscissa.
    #[must_use]
    pub fn true_to_scale(mut self) -> Self {
        self.is_to_scale = true;
        self
    }

    /// The same axis with words at some values, for categories.
    #[must_use]
    pub fn named(mut self, names: impl IntoIterator<Item = (f64, String)>) -> Self {
        let (ticks, names) = names.into_iter().unzip();
        self.ticks = Some(ticks);
        self.names = names;
        self
    }

    /// The same axis with a fixed range.
    #[must_use]
    pub fn between(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }
}

/// An axis with everything decided.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ResolvedAxis {
    pub scale: Scale,
    pub low: f64,
    pub high: f64,
    /// Labelled values.
    pub ticks: Vec<(f64, String)>,
    /// Values with a short tick only.
    pub minor: Vec<f64>,
}

impl ResolvedAxis {
    /// Decides range and ticks of `axis` for `data`. A given range that cannot be drawn is not
    /// taken; values that are not finite are ignored, on a log axis also those not positive.
    pub fn new(axis: &Axis, data: impl Iterator<Item = f64>) -> Self {
        let log = axis.scale == Scale::Log;
        let given = axis.range.filter(|(low, high)| {
            low < high && low.is_finite() && high.is_finite() && (!log || *low > 0.0)
        });
        let (low, high) = given.unwrap_or_else(|| {
            let usable = data.filter(|v| v.is_finite() && (!log || *v > 0.0));
            let (low, high) = usable.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                (l.min(v), h.max(v))
            });
            padded(axis.scale, low, high)
        });
        let (ticks, minor) = match (&axis.ticks, axis.scale) {
            (Some(ticks), _) => (ticks.clone(), Vec::new()),
            (None, Scale::Linear) => (linear_ticks(low, high), Vec::new()),
            (None, Scale::Log) => log_ticks(low, high),
        };
        // Ticks that were given are written as they are, ticks that were found with equal digits.
        let decimals = axis.ticks.is_none().then(|| decimals(&ticks));
        Self {
            scale: axis.scale,
            low,
            high,
            ticks: ticks
                .into_iter()
                .enumerate()
                .map(|(place, tick)| {
                    let name = axis.names.get(place).cloned();
                    (tick, name.unwrap_or_else(|| tick_label(tick, decimals)))
                })
                .collect(),
            minor,
        }
    }

    /// The same range grown about its middle by `factor`, with ticks of its own.
    pub fn grown(&self, factor: f64) -> Self {
        let middle = 0.5 * (self.low + self.high);
        let half = 0.5 * factor * (self.high - self.low);
        let axis = Axis::linear("").between(middle - half, middle + half);
        Self::new(&axis, std::iter::empty())
    }

    /// Share of the axis at `value`: 0 at the low end, 1 at the high end; not clamped.
    pub fn share(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => (value - self.low) / (self.high - self.low),
            Scale::Log => (value / self.low).ln() / (self.high / self.low).ln(),
        }
    }
}

/// The data's range with a margin; something drawable also for one value or none.
fn padded(scale: Scale, low: f64, high: f64) -> (f64, f64) {
    if low > high {
        return match scale {
            Scale::Linear => (0.0, 1.0),
            Scale::Log => (1.0, 10.0),
        };
    }
    match scale {
        Scale::Linear => {
            let span = high - low;
            let margin = if span > 1e-12 * low.abs().max(high.abs()) && span > 0.0 {
                0.05 * span
            } else {
                0.1 * low.abs().max(1e-12)
            };
            (low - margin, high + margin)
        }
        Scale::Log => {
            let margin = (high / low).powf(0.06).max(1.15);
            (low / margin, high * margin)
        }
    }
}

/// Some six round values, a step of 1, 2, 2.5 or 5 times a power of ten apart.
fn linear_ticks(low: f64, high: f64) -> Vec<f64> {
    let wanted = (high - low) / 6.0;
    let magnitude = 10f64.powf(wanted.log10().floor());
    let off = |step: &f64| (step / wanted).ln().abs();
    let step = [1.0, 2.0, 2.5, 5.0, 10.0]
        .map(|m| m * magnitude)
        .into_iter()
        .min_by(|a, b| off(a).total_cmp(&off(b)))
        .unwrap_or(wanted);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|i| i as f64 * step).collect()
}

/// Labelled: powers of ten, and 2 and 5 times them when the axis spans little; minor: the rest.
fn log_ticks(low: f64, high: f64) -> (Vec<f64>, Vec<f64>) {
    let decades = (high / low).log10();
    let labelled: &[u32] = if decades > 3.0 {
        &[1]
    } else if decades > 1.5 {
        &[1, 2, 5]
    } else if decades > 0.5 {
        &[1, 2, 3, 4, 5, 7]
    } else {
        &[1, 2, 3, 4, 5, 6, 7, 8, 9]
    };
    let (mut ticks, mut minor) = (Vec::new(), Vec::new());
    for exponent in low.log10().floor() as i32..=high.log10().floor() as i32 {
        for m in 1..10u32 {
            let value = f64::from(m) * 10f64.powi(exponent);
            if value < low * (1.0 - 1e-9) || value > high * (1.0 + 1e-9) {
                continue;
            }
            if labelled.contains(&m) {
                ticks.push(value);
            } else {
                minor.push(value);
            }
        }
    }
    if ticks.len() < 3 {
        return (linear_ticks(low, high), minor);
    }
    (ticks, minor)
}

/// Digits after the point that distinguish all ticks.
fn decimals(ticks: &[f64]) -> usize {
    (0..6)
        .find(|&digits| {
            let scale = 10f64.powi(digits as i32);
            ticks.iter().all(|tick| {
                let scaled = tick * scale;
                (scaled - scaled.round()).abs() <= 1e-6 * scaled.abs().max(1e-3)
            })
        })
        .unwrap_or(6)
}

fn tick_label(tick: f64, decimals: Option<usize>) -> String {
    let magnitude = tick.abs();
    let text = if magnitude != 0.0 && !(1e-4..1e6).contains(&magnitude) {
        format!("{magnitude:e}")
    } else {
        decimals.map_or_else(|| magnitude.to_string(), |n| format!("{magnitude:.n$}"))
    };
    if tick < 0.0 && magnitude > 0.0 {
        format!("\u{2212}{text}")
    } else {
        text
    }
}
