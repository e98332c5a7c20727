//! Order in which the points of a study are searched, and the points from which each takes its starting amplitude.
//!
//! The order is a property of the points' values, never of their place in the study: widths ends
//! first and then midpoints; ramps none, rigid, deformable; `+` before `-`. Each point takes its
//! starting amplitude from points earlier in that order alone, so that a sequential search and
//! any parallel one ask the same probes:
//!
//! 1. the *reference* point: the same width, ramp and axes with the other sign; else the previous
//!    ramp that is touched; else the same point at the previous values of the further axes;
//! 2. neighbouring widths already answered (same ramp, sign and axes): how far they lie from their
//!    own reference points, interpolated in the logarithm of the width, corrects the reference;
//! 3. neither: the amplitude of first touch times 1.03, or the middle of the range, by doublings.
//!
//! With a ramp all amplitudes are taken relative to first touch (`hint`).
//!
//! Widths added in later rounds come after all points of the rounds before. Their answered neighbours are those of
//! earlier rounds, whose starting amplitudes do not depend on them.
//!
//! A point whose like is called failed at a smaller clearance starts from what was found for that: runs of both are the
//! same up to the failure.
//!
//! A point with a ramp also has a *companion*: the same point without ramp. Below the amplitude of
//! first touch its answers are the companion's.

use std::collections::BTreeMap;

use super::probe::Sign;
use serde::Serialize;

/// Which ramp stands at the rim. The order is the canonical one, and that of the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ramp {
    /// No ramp.
    None,
    /// Fixed contact points.
    Rigid,
    /// Flexible arms.
    Deformable,
}

impl Ramp {
    /// All, in canonical order.
    pub const ALL: [Self; 3] = [Self::None, Self::Rigid, Self::Deformable];

    /// The word in study files and tables.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Rigid => "rigid",
            Self::Deformable => "deformable",
        }
    }

    /// The ramp of a word.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|ramp| ramp.as_str() == word)
    }
}

impl std::fmt::Display for Ramp {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.as_str())
    }
}

/// Coordinates of a point in the study.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinates {
    /// Ramp model.
    pub ramp: Ramp,
    /// Pulse width, ms.
    pub pulse_ms: f64,
    /// Sign.
    pub sign: Sign,
    /// Further axes as sortable text; equal text = equal values.
    pub axes: Vec<String>,
    /// Round in which the width was added, 0 for the study's own.
    pub round: u32,
    /// Clearance below which the interface has failed, m.
    pub fail_below_m: f64,
    /// Place among the axes of the one that varies that clearance.
    pub clearance_axis: Option<usize>,
}

/// A point's relations.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Relations {
    /// Next smaller and next larger answered width of the same ramp, sign and axes.
    pub answered: [Option<usize>; 2],
    /// A point that was answered before and is expected to answer much the same.
    pub reference: Option<usize>,
    /// The same point without ramp.
    pub companion: Option<usize>,
    /// The same point with the next smaller clearance called failure.
    pub smaller_clearance: Option<usize>,
    /// Next smaller and next larger width of the same ramp, sign and axes.
    pub neighbours: [Option<usize>; 2],
    /// Points of the same ramp, sign, axes and round, by width: a number naming the group.
    pub chain: usize,
    /// Place of the width in its chain; the numbering continues that of the chains of earlier rounds.
    pub width_rank: usize,
}

impl Relations {
    /// Points that must have their answer before this one can start.
    pub fn predecessors(&self) -> Vec<usize> {
        // The references of answered widths are answered before these.
        let mut all: Vec<usize> = self.companion.into_iter().chain(self.reference).collect();
        all.extend(self.smaller_clearance);
        all.extend(self.answered.into_iter().flatten());
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// Order and relations of all points.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Order {
    /// Places in the study in canonical order.
    pub sequence: Vec<usize>,
    /// Relations by place in the study.
    pub relations: Vec<Relations>,
    /// Points of each chain, ascending width.
    pub chains: Vec<Vec<usize>>,
}

/// Order of `count` things on a line: both ends, then midpoints level by level, each with the
/// earlier things next to it. Returns `(place, below, above)`.
pub fn ends_first(count: usize) -> Vec<(usize, Option<usize>, Option<usize>)> {
    let mut order = Vec::with_capacity(count);
    if count == 0 {
        return order;
    }
    order.push((0, None, None));
    if count == 1 {
        return order;
    }
    order.push((count - 1, Some(0), None));
    let mut level = vec![(0, count - 1)];
    while !level.is_empty() {
        let mut next = Vec::new();
        for (low, high) in level {
            if high - low < 2 {
                continue;
            }
            let middle = (low + high) / 2;
            order.push((middle, Some(low), Some(high)));
            next.push((low, middle));
            next.push((middle, high));
        }
        level = next;
    }
    order
}

impl Order {
    /// The point that differs in the clearance called failure alone and has the smallest.
    pub fn smallest_clearance(&self, point: usize) -> usize {
        let mut smallest = point;
        while let Some(smaller) = self.relations[smallest].smaller_clearance {
            smallest = smaller;
        }
        smallest
    }

    /// Order of the points.
    pub fn of(points: &[Coordinates]) -> Order {
        let mut by_value: Vec<usize> = (0..points.len()).collect();
        by_value.sort_by(|&a, &b| {
            let (a, b) = (&points[a], &points[b]);
            a.round
                .cmp(&b.round)
                .then_with(|| a.axes.cmp(&b.axes))
                .then(a.ramp.cmp(&b.ramp))
                .then(a.sign.cmp(&b.sign))
                .then(a.pulse_ms.total_cmp(&b.pulse_ms))
        });

        let mut chains: Vec<Vec<usize>> = Vec::new();
        for &place in &by_value {
            let same = chains
                .last()
                .and_then(|chain| chain.first())
                .is_some_and(|&first| {
                    let (a, b) = (&points[first], &points[place]);
                    a.round == b.round && a.axes == b.axes && a.ramp == b.ramp && a.sign == b.sign
                });
            match chains.last_mut() {
                Some(chain) if same => chain.push(place),
                _ => chains.push(vec![place]),
            }
        }

        let unknown = Relations {
            answered: [None, None],
            reference: None,
            companion: None,
            smaller_clearance: None,
            neighbours: [None, None],
            chain: 0,
            width_rank: 0,
        };
        let smaller_clearances = smaller_clearances(points);
        let mut relations = vec![unknown; points.len()];
        // (axes, rank in ends-first order, ramp, sign) sorts into the canonical sequence.
        let mut keys: Vec<(usize, usize, usize, usize)> = vec![(0, 0, 0, 0); points.len()];
        let (mut group, mut ramp_rank) = (0, 0);
        for (number, chain) in chains.iter().enumerate() {
            if number > 0 {
                let (a, b) = (&points[chains[number - 1][0]], &points[chain[0]]);
                if a.round != b.round || a.axes != b.axes {
                    group += 1;
                    ramp_rank = 0;
                } else if a.ramp != b.ramp {
                    ramp_rank += 1;
                }
            }
            let own = chain_before(points, &chains[..number], chain[0]);
            for (rank, (place, below, above)) in ends_first(chain.len()).into_iter().enumerate() {
                let point = chain[place];
                let at = &points[point];
                let (answered, neighbours) = if own.is_empty() {
                    let neighbours = [place.checked_sub(1), Some(place + 1)];
                    (
                        [below, above].map(|place| place.map(|place| chain[place])),
                        neighbours.map(|place| chain.get(place?).copied()),
                    )
                } else {
                    let beside = beside(points, &own, at.pulse_ms);
                    (beside, beside)
                };
                relations[point] = Relations {
                    answered,
                    reference: reference(points, &chains[..number], at),
                    companion: companion(points, at),
                    smaller_clearance: smaller_clearances[point],
                    neighbours,
                    chain: number,
                    width_rank: own.len() + place,
                };
                let sign = usize::from(at.sign == Sign::Minus);
                keys[point] = (group, rank, ramp_rank, sign);
            }
        }
        let mut sequence = by_value;
        sequence.sort_by_key(|&point| keys[point]);
        Order {
            sequence,
            relations,
            chains,
        }
    }
}

/// Points of the same ramp, sign and axes as `point` in chains of earlier rounds.
fn chain_before(points: &[Coordinates], earlier: &[Vec<usize>], point: usize) -> Vec<usize> {
    let at = &points[point];
    let same = |other: &Coordinates| {
        other.axes == at.axes && other.ramp == at.ramp && other.sign == at.sign
    };
    let all = earlier.iter().flatten().copied();
    all.filter(|&other| same(&points[other])).collect()
}

/// Next smaller and next larger width among `known`.
fn beside(points: &[Coordinates], known: &[usize], pulse_ms: f64) -> [Option<usize>; 2] {
    let width = |point: &usize| points[*point].pulse_ms;
    let smaller = known.iter().filter(|point| width(point) < pulse_ms);
    let larger = known.iter().filter(|point| width(point) > pulse_ms);
    [
        smaller
            .max_by(|a, b| width(a).total_cmp(&width(b)))
            .copied(),
        larger.min_by(|a, b| width(a).total_cmp(&width(b))).copied(),
    ]
}

/// The reference of a point among the chains before its own.
fn reference(points: &[Coordinates], earlier: &[Vec<usize>], at: &Coordinates) -> Option<usize> {
    let is_touched = |point: &Coordinates| point.ramp != Ramp::None;
    let find = |wanted: &dyn Fn(&Coordinates) -> bool| {
        earlier
            .iter()
            .rev()
            .flatten()
            .copied()
            .find(|&point| points[point].pulse_ms == at.pulse_ms && wanted(&points[point]))
    };
    let other_sign =
        find(&|other| other.axes == at.axes && other.ramp == at.ramp && other.sign != at.sign);
    let previous_ramp = || {
        find(&|other| {
            other.axes == at.axes
                && other.sign == at.sign
                && other.ramp != at.ramp
                && is_touched(other) == is_touched(at)
        })
    };
    let previous_axes = || find(&|other| other.ramp == at.ramp && other.sign == at.sign);
    other_sign.or_else(previous_ramp).or_else(previous_axes)
}

fn companion(points: &[Coordinates], at: &Coordinates) -> Option<usize> {
    if at.ramp == Ramp::None {
        return None;
    }
    points.iter().position(|other| {
        other.ramp == Ramp::None
            && other.axes == at.axes
            && other.sign == at.sign
            && other.pulse_ms == at.pulse_ms
    })
}

/// For every point the one that differs from it in the next smaller clearance called failure alone, among those of its
/// round and of earlier ones.
fn smaller_clearances(points: &[Coordinates]) -> Vec<Option<usize>> {
    let mut alike: BTreeMap<_, Vec<usize>> = BTreeMap::new();
    for (place, at) in points.iter().enumerate() {
        if let Some(axis) = at.clearance_axis {
            let (before, after) = at.axes.split_at(axis);
            let key = (at.ramp, at.sign, at.pulse_ms.to_bits(), before, &after[1..]);
            alike.entry(key).or_default().push(place);
        }
    }
    let mut smaller = vec![None; points.len()];
    for mut places in alike.into_values() {
        places.sort_by(|&a, &b| points[a].fail_below_m.total_cmp(&points[b].fail_below_m));
        for (number, &place) in places.iter().enumerate() {
            let below = places[..number].iter().rev().copied();
            smaller[place] = below.into_iter().find(|&other| {
                let (other, own) = (&points[other], &points[place]);
                other.round <= own.round && other.fail_below_m < own.fail_below_m
            });
        }
    }
    smaller
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fig13() -> Vec<Coordinates> {
        let mut points = Vec::new();
        for ramp in Ramp::ALL {
            for pulse_ms in [0.5, 0.75, 1.0, 1.5, 2.0, 3.0] {
                for sign in [Sign::Plus, Sign::Minus] {
                    points.push(Coordinates {
                        ramp,
                        pulse_ms,
                        sign,
                        axes: vec![],
                        round: 0,
                        fail_below_m: 0.0,
                        clearance_axis: None,
                    });
                }
            }
        }
        points
    }

    #[test]
    fn widths_go_ends_first_then_midpoints() {
        let order: Vec<usize> = ends_first(6).iter().map(|entry| entry.0).collect();
        assert_eq!(order, [0, 5, 2, 1, 3, 4]);
        assert_eq!(ends_first(6)[4], (3, Some(2), Some(5)));
        for count in 0..40 {
            let mut all: Vec<usize> = ends_first(count).iter().map(|entry| entry.0).collect();
            all.sort_unstable();
            assert_eq!(all, (0..count).collect::<Vec<_>>());
        }
    }

    #[test]
    fn predecessors_always_come_earlier() {
        let points = fig13();
        let order = Order::of(&points);
        let mut seen = vec![false; points.len()];
        for &point in &order.sequence {
            for before in order.relations[point].predecessors() {
                assert!(seen[before], "{point} before {before}");
            }
            seen[point] = true;
        }
        assert!(seen.iter().all(|seen| *seen));
        let first: Vec<(&str, f64, &str)> = order.sequence[..7]
            .iter()
            .map(|&p| {
                (
                    points[p].ramp.as_str(),
                    points[p].pulse_ms,
                    points[p].sign.as_str(),
                )
            })
            .collect();
        assert_eq!(
            first,
            [
                ("none", 0.5, "+"),
                ("none", 0.5, "-"),
                ("rigid", 0.5, "+"),
                ("rigid", 0.5, "-"),
                ("deformable", 0.5, "+"),
                ("deformable", 0.5, "-"),
                ("none", 3.0, "+"),
            ]
        );
    }

    #[test]
    fn a_shuffled_study_has_the_same_relations() {
        let points = fig13();
        let order = Order::of(&points);
        // 5 is prime to 36.
        let shuffle: Vec<usize> = (0..36).map(|i| (5 * i + 7) % 36).collect();
        let shuffled: Vec<Coordinates> = shuffle.iter().map(|&i| points[i].clone()).collect();
        let other = Order::of(&shuffled);
        let back: Vec<usize> = other.sequence.iter().map(|&i| shuffle[i]).collect();
        assert_eq!(back, order.sequence);
        for (i, relation) in other.relations.iter().enumerate() {
            let same = &order.relations[shuffle[i]];
            assert_eq!(relation.companion.map(|p| shuffle[p]), same.companion);
            assert_eq!(
                relation.neighbours.map(|p| p.map(|p| shuffle[p])),
                same.neighbours
            );
        }
    }
}
