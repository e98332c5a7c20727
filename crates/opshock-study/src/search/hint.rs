//! Starting amplitude of a point's search, estimated from points answered before.
//!
//! Everything is a logarithm; with a ramp, of the amplitude relative to first touch. A point's
//! *excess* is its logarithm less that of its reference point. Excess varies slowly with the width,
//! so that of the answered widths, interpolated, is added to the point's own reference.

/// Share above first touch at which a ramp is expected to make the head fail when nothing else is
/// known.
const ABOVE_TOUCH: f64 = 1.03;

/// A point with what is known of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Known {
    /// Width, ms.
    pub pulse_ms: f64,
    /// Amplitude of first touch, G.
    pub onset_g: Option<f64>,
    /// Its answer, G.
    pub answer_g: Option<f64>,
    /// First touch and answer of its reference, G.
    pub reference: Option<(Option<f64>, f64)>,
}

/// Expected answer of `at`, G, from the answered widths next to it; `None`: nothing to go by.
pub(super) fn expected_g(at: Known, answered: &[Known]) -> Option<f64> {
    // Relative to first touch only when every point used has one.
    let speakers = || answered.iter().filter(|known| known.answer_g.is_some());
    let is_touched = at.onset_g.is_some() && speakers().all(|known| known.onset_g.is_some());
    let height = |onset_g: Option<f64>, answer_g: f64| {
        Some(answer_g.ln() - if is_touched { onset_g?.ln() } else { 0.0 })
    };
    let of_reference = |known: &Known| {
        let (onset_g, answer_g) = known.reference?;
        height(onset_g, answer_g)
    };
    let own_reference = of_reference(&at);
    let has_reference = own_reference.is_some() && speakers().all(|k| of_reference(k).is_some());
    let excess: Vec<(f64, f64)> = speakers()
        .filter_map(|known| {
            let height = height(known.onset_g, known.answer_g?)?;
            let reference = of_reference(known).filter(|_| has_reference);
            Some((known.pulse_ms.ln(), height - reference.unwrap_or(0.0)))
        })
        .collect();
    let reference = own_reference.filter(|_| has_reference);
    let height = match (reference, interpolated(&excess, at.pulse_ms.ln())) {
        (Some(reference), excess) => reference + excess.unwrap_or(0.0),
        (None, Some(excess)) => excess,
        (None, None) if is_touched => ABOVE_TOUCH.ln(),
        (None, None) => return None,
    };
    let base = at.onset_g.filter(|_| is_touched).map_or(0.0, f64::ln);
    Some((base + height).exp())
}

/// On the line through the first two, at the first if there is one.
fn interpolated(known: &[(f64, f64)], at: f64) -> Option<f64> {
    match *known {
        [] => None,
        [(_, only)] => Some(only),
        [(x_a, a), (x_b, b), ..] => Some(a + (b - a) * (at - x_a) / (x_b - x_a)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known(pulse_ms: f64, onset_g: Option<f64>, answer_g: Option<f64>) -> Known {
        Known {
            pulse_ms,
            onset_g,
            answer_g,
            reference: None,
        }
    }

    fn close(found: Option<f64>, expected: f64) {
        let found = found.expect("expected");
        assert!(
            (found / expected - 1.0).abs() < 1e-12,
            "{found}, not {expected}"
        );
    }

    #[test]
    fn without_anything_known_first_touch_is_the_guide() {
        assert_eq!(expected_g(known(1.0, None, None), &[]), None);
        close(expected_g(known(1.0, Some(200.0), None), &[]), 206.0);
    }

    #[test]
    fn widths_are_interpolated_relative_to_first_touch() {
        // Twice and four times first touch at 1 and 4 ms: a factor of sqrt(8) at 2 ms.
        let ends = [
            known(1.0, Some(100.0), Some(200.0)),
            known(4.0, Some(50.0), Some(200.0)),
        ];
        close(
            expected_g(known(2.0, Some(70.0), None), &ends),
            70.0 * 8.0_f64.sqrt(),
        );
        close(expected_g(known(2.0, Some(70.0), None), &ends[..1]), 140.0);
        // One point without first touch: amplitudes themselves.
        let bare = [ends[0], known(4.0, None, Some(800.0))];
        close(expected_g(known(2.0, Some(70.0), None), &bare), 400.0);
    }

    #[test]
    fn the_reference_is_corrected_by_the_excess_of_the_neighbours() {
        let with = |mut point: Known, onset_g, answer_g| {
            point.reference = Some((onset_g, answer_g));
            point
        };
        // 10 % above the reference at one end, 21 % at the other.
        let ends = [
            with(known(1.0, None, Some(110.0)), None, 100.0),
            with(known(4.0, None, Some(363.0)), None, 300.0),
        ];
        let at = with(known(2.0, None, None), None, 500.0);
        close(expected_g(at, &ends), 500.0 * 1.1_f64.powf(1.5));
        close(expected_g(at, &[]), 500.0);
        // The reference at another first touch is moved with it.
        let at = with(known(2.0, Some(60.0), None), Some(50.0), 100.0);
        close(expected_g(at, &[]), 120.0);
    }
}
