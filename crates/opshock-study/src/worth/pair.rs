//! A pair of critical shocks, at two values of a key, each at the resolution of the scene, one step coarser in everything, and where
//! that leaves the change uncertain one and two steps finer.
//!
//! With A(x, l) the critical amplitude at value x and refinement level l, the change across the tolerance is
//! D(l) = A(x₊, l) - A(x₋, l). Its numerical error is the change of D by refinement, not that of A: what both values share
//! cancels. With the finest level l and the slowest formal ratio r = 2 of the discretisation parameters
//!
//! ```text
//! D = D(l) ± (w(l) + F (|D(l) - D(l-1)| + w(l) + w(l-1)) / (r - 1)),   F = 3
//! ```
//!
//! where w are the half-widths of the brackets, and F the factor of safety where no order is observed (Roache 1994, J. Fluids
//! Eng. 116, 405). D is the whole change between the two values, so that no error of a difference quotient comes in.

/// Neighbouring amplitudes of the brackets are this share apart.
pub const FINENESS: f64 = 2.5e-4;
/// Factor of safety.
const FACTOR: f64 = 3.0;
/// Slowest formal ratio by which a refinement step divides an error.
const RATIO: f64 = 2.0;
/// First step of a search beyond its start, and the farthest from it, in steps of the grid: a factor of about 2.7.
const FIRST_STEPS: i32 = 16;
const FARTHEST: i32 = 4000;

/// Value of the key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The lower one.
    Low,
    /// The higher one.
    High,
}

/// Whether shocks of the pair are survived.
pub trait Shaken {
    /// Why there is no answer, as after a stop.
    type Interrupted;

    /// At a step of the amplitude grid, with every discretisation parameter refined so many times, or coarsened; `None` without
    /// verdict.
    fn survives(
        &mut self,
        end: End,
        refined: i8,
        step: i32,
    ) -> Result<Option<bool>, Self::Interrupted>;
}

/// Neighbouring steps of which the lower is survived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bracket {
    /// Step that is survived.
    pub survives: i32,
    /// Step that fails.
    pub fails: i32,
}

/// Brackets of a pair at the lower and the higher value: a step coarser, at the scene's resolution, one and two steps finer. Those that
/// were not sought or not found are missing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pair(pub [[Option<Bracket>; 2]; LEVELS]);

/// Resolutions of a pair, the coarsest first, and the place of the scene's own among them.
pub const LEVELS: usize = 4;
const OWN: usize = 1;

/// Middle and half-width of a bracket in G, with the amplitude of a step.
fn middle(bracket: Bracket, amplitude_g: &dyn Fn(i32) -> f64) -> [f64; 2] {
    let [low, high] = [bracket.survives, bracket.fails].map(amplitude_g);
    [0.5 * (low + high), 0.5 * (high - low)]
}

impl Pair {
    /// The finest level with both brackets.
    fn finest(&self) -> Option<usize> {
        (OWN..LEVELS)
            .rev()
            .find(|level| self.0[*level].iter().all(Option::is_some))
    }

    /// Critical shocks at both values, G.
    pub fn critical_g(&self, amplitude_g: &dyn Fn(i32) -> f64) -> [Option<f64>; 2] {
        let level = self.finest().unwrap_or(OWN);
        self.0[level].map(|bracket| Some(middle(bracket?, amplitude_g)[0]))
    }

    /// Change from the lower to the higher value and its half-width, G.
    pub fn change_g(&self, amplitude_g: &dyn Fn(i32) -> f64) -> Option<[f64; 2]> {
        let difference = |level: usize| {
            let [low, high] = self.0[level];
            let [low, high] = [middle(low?, amplitude_g), middle(high?, amplitude_g)];
            Some([high[0] - low[0], high[1] + low[1]])
        };
        let finest = self.finest()?;
        let [change, width] = difference(finest)?;
        let [coarser, coarser_width] = difference(finest - 1)?;
        let moved = (change - coarser).abs() + width + coarser_width;
        Some([change, width + FACTOR * moved / (RATIO - 1.0)])
    }

    /// Refinement steps of the finest level beyond the scene's own.
    pub fn refined(&self) -> usize {
        self.finest().map_or(0, |level| level - OWN)
    }
}

/// Brackets of a pair, sought within those that are known at the lower and at the higher value. Finer ones follow, `most_finer` steps
/// at most, until `is_narrow`.
///
/// # Errors
/// Where a verdict has none to give.
pub fn find<S: Shaken>(
    shaken: &mut S,
    starts: [Bracket; 2],
    most_finer: usize,
    is_narrow: &dyn Fn(&Pair) -> bool,
) -> Result<Pair, S::Interrupted> {
    let mut pair = Pair::default();
    let mut from = starts;
    // The scene's own level first, then the coarser one, then finer ones from the last.
    let finer = OWN + 1..=(OWN + most_finer).min(LEVELS - 1);
    for level in [OWN, OWN - 1].into_iter().chain(finer) {
        if level > OWN && is_narrow(&pair) {
            break;
        }
        let refined = level as i8 - OWN as i8;
        for (place, end) in [End::Low, End::High].into_iter().enumerate() {
            pair.0[level][place] = bracket(shaken, end, refined, from[place])?;
        }
        match pair.0[level] {
            [Some(low), Some(high)] if level >= OWN => from = [low, high],
            // Finer ones without it have a change of their own.
            _ if level < OWN => {}
            _ => break,
        }
    }
    Ok(pair)
}

/// Neighbours within `start`, whose ends are simulated first; where an end has the other verdict, beyond it in growing steps.
fn bracket<S: Shaken>(
    shaken: &mut S,
    end: End,
    refined: i8,
    start: Bracket,
) -> Result<Option<Bracket>, S::Interrupted> {
    let (mut survives, mut fails) = (None, None);
    let (mut step, mut further) = (start.survives, FIRST_STEPS);
    let (mut low, mut high) = loop {
        match shaken.survives(end, refined, step)? {
            None => return Ok(None),
            Some(true) => survives = Some(step),
            Some(false) => fails = Some(step),
        }
        step = match (survives, fails) {
            (Some(low), Some(high)) => break (low, high),
            (Some(low), None) if low < start.fails => start.fails,
            (Some(low), None) => low + further,
            (None, Some(high)) => high - further,
            (None, None) => return Ok(None),
        };
        if (step - start.survives).abs() > FARTHEST {
            return Ok(None);
        }
        // The other end of the start is no step beyond it.
        if step != start.fails {
            further *= 2;
        }
    };
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        match shaken.survives(end, refined, middle)? {
            None => return Ok(None),
            Some(true) => low = middle,
            Some(false) => high = middle,
        }
    }
    Ok(Some(Bracket {
        survives: low,
        fails: high,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draws::draw;

    /// Critical amplitudes (G) with an error of a size of its own that halves with each level, in part without order, and
    /// changes with the value.
    struct Law {
        critical_g: [f64; 2],
        error: f64,
        /// Change of that error between the values, as a share of it.
        drift: f64,
        disorder: f64,
        shocks: u32,
    }

    fn amplitude_g(step: i32) -> f64 {
        (f64::from(step) * FINENESS).exp()
    }

    fn start(survived_g: f64) -> Bracket {
        let survives = (survived_g.ln() / FINENESS) as i32;
        Bracket {
            survives,
            fails: survives + 40,
        }
    }

    impl Law {
        fn at(&self, end: End, level: i32) -> f64 {
            let (exact_g, sign) = match end {
                End::Low => (self.critical_g[0], -1.0),
                End::High => (self.critical_g[1], 1.0),
            };
            let flip = if level % 2 == 0 { 1.0 } else { -1.0 };
            let size = self.error * 0.5_f64.powi(level) * (1.0 + self.disorder * flip);
            exact_g * (1.0 + size * (1.0 + sign * self.drift))
        }
    }

    impl Shaken for Law {
        type Interrupted = std::convert::Infallible;

        fn survives(
            &mut self,
            end: End,
            refined: i8,
            step: i32,
        ) -> Result<Option<bool>, Self::Interrupted> {
            self.shocks += 1;
            Ok(Some(amplitude_g(step) <= self.at(end, refined.into())))
        }
    }

    /// Known change, what the pair says of it, and the half-widths of two separate intervals by the same answers and factor, of 100 laws.
    fn laws(most_finer: usize, most_shocks: u32) -> Vec<([f64; 3], f64)> {
        let of_law = |index| {
            let random = draw(41, index, 6);
            let mean_g = 150.0 + 500.0 * random[0];
            let change_g = 0.2 * mean_g * (random[1] - 0.5);
            let mut law = Law {
                critical_g: [mean_g - 0.5 * change_g, mean_g + 0.5 * change_g],
                error: 0.04 * (random[2] - 0.5),
                drift: 0.4 * (random[3] - 0.5),
                disorder: if random[4] < 0.3 {
                    0.6 * random[5]
                } else {
                    0.0
                },
                shocks: 0,
            };
            // Brackets of 1 % that may lie beside the critical shock.
            let start = start(mean_g * (0.95 + 0.1 * random[5]));
            let is_narrow = |pair: &Pair| {
                let found = pair.change_g(&amplitude_g);
                found.is_some_and(|[_, half_g]| half_g <= 0.005 * mean_g)
            };
            let Ok(pair) = find(&mut law, [start; 2], most_finer, &is_narrow);
            assert!(law.shocks <= most_shocks, "{}", law.shocks);
            let [found_g, half_g] = pair.change_g(&amplitude_g).expect("a change");
            let of = |end| FACTOR * (law.at(end, 0) - law.at(end, -1)).abs();
            let separate_g = of(End::Low) + of(End::High);
            ([change_g, found_g, half_g], separate_g)
        };
        (0..100).map(of_law).collect()
    }

    #[test]
    fn changes_hold_those_of_100_known_laws_and_are_narrower_than_separate_intervals() {
        let all = laws(0, 60);
        let is_held = |([exact_g, found_g, half_g], _): &&([f64; 3], f64)| {
            (found_g - exact_g).abs() <= *half_g
        };
        let held = all.iter().filter(is_held).count();
        let mut narrower: Vec<f64> = all
            .iter()
            .map(|([.., half_g], both_g)| both_g / half_g)
            .collect();
        narrower.sort_by(f64::total_cmp);
        println!("{held} of 100, {} times narrower", narrower[50]);
        assert!(held >= 89, "{held}");
        assert!(narrower[50] >= 3.0, "{}", narrower[50]);
        // Wide ones are refined, and still hold.
        let finer = laws(2, 120);
        let held = finer.iter().filter(is_held).count();
        assert!(held >= 89, "{held}");
        let wide = |all: &[([f64; 3], f64)]| {
            let mut widths: Vec<f64> = all.iter().map(|([.., half_g], _)| *half_g).collect();
            widths.sort_by(f64::total_cmp);
            widths[95]
        };
        assert!(
            wide(&finer) < 0.5 * wide(&all),
            "{} {}",
            wide(&finer),
            wide(&all)
        );
    }

    /// Survives nothing between 99.8 and 100.2 G, where its critical shock is, but all of 100.2 to 104 G.
    struct NonMonotone(Vec<i32>);

    impl Shaken for NonMonotone {
        type Interrupted = std::convert::Infallible;

        fn survives(
            &mut self,
            _: End,
            _: i8,
            step: i32,
        ) -> Result<Option<bool>, Self::Interrupted> {
            self.0.push(step);
            let at_g = amplitude_g(step);
            Ok(Some(at_g < 99.8 || (100.2..104.0).contains(&at_g)))
        }
    }

    #[test]
    fn a_known_failure_bounds_the_search() {
        let at = |of_g: f64| (of_g.ln() / FINENESS).round() as i32;
        let known = Bracket {
            survives: at(99.5),
            fails: at(100.0),
        };
        let mut non_monotone = NonMonotone(Vec::new());
        let Ok(pair) = find(&mut non_monotone, [known; 2], 2, &|_| false);
        for found in pair.0.into_iter().flatten() {
            assert_eq!(found.map(|one| one.fails), Some(at(99.8)));
        }
        assert!(non_monotone.0.iter().all(|step| *step <= known.fails));
    }

    #[test]
    fn a_critical_shock_out_of_reach_leaves_the_change_open() {
        let mut law = Law {
            critical_g: [100.0, 5000.0],
            error: 0.0,
            drift: 0.0,
            disorder: 0.0,
            shocks: 0,
        };
        let Ok(pair) = find(&mut law, [start(110.0); 2], 2, &|_| false);
        assert_eq!(pair.0[OWN].map(|found| found.is_some()), [true, false]);
        assert_eq!(pair.change_g(&amplitude_g), None);
    }
}
