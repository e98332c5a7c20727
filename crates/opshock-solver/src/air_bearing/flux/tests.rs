//! Fluxes through faces against closed forms and finite differences.

use super::super::flow_factor::{FlowFactor, FlowModel};
use super::super::heights::{inverses, is_steep};
use super::*;

#[test]
fn without_wind_the_short_form_is_the_general_one() {
    for h_face in [0.02, 0.7, 0.999_999, 1.0, 1.3, 40.0] {
        let cell = HalfCell {
            psi: 1.7,
            inverse_psi: 1.0 / 1.7,
            psi_behind: 1.1,
            reach: 0.0,
            g: 2.3,
            inverse_g: 1.0 / 2.3,
            g_slope: 0.4,
            h_centre: 1.0,
            h_face,
            inverses: inverses(1.0, h_face),
            distance: 1.0 / 3.0,
            inverse_distance: 3.0,
            inverse_h: 1.0,
            wind: 0.0,
        };
        let (general, (alpha, beta)) = (
            cell.flux::<false>(&cell.logarithmic_mean::<true>()),
            cell.still(),
        );
        assert!((general.alpha / alpha - 1.0).abs() < 1e-13, "{h_face}");
        assert!((general.beta / beta - 1.0).abs() < 1e-13, "{h_face}");
    }
}

fn flux_and_excess(cell: &HalfCell, p: f64) -> [f64; 2] {
    let (alpha, beta) = cell.coefficients();
    let mean = cell.logarithmic_mean::<true>();
    let excess = match cell.wind {
        0.0 => cell.still_excess(p),
        w if w > 0.0 => cell.mean_excess::<true>(&cell.flux::<true>(&mean), p),
        _ => cell.mean_excess::<false>(&cell.flux::<false>(&mean), p),
    };
    [alpha - beta * p, excess]
}

fn partials(cell: &HalfCell, p: f64) -> HalfPartials {
    let mean = cell.logarithmic_mean::<true>();
    match cell.wind {
        0.0 => cell.still_partials(p),
        w if w > 0.0 => cell.partials::<true>(&mean, &cell.flux::<true>(&mean), p),
        _ => cell.partials::<false>(&mean, &cell.flux::<false>(&mean), p),
    }
}

#[test]
fn short_and_general_logarithmic_mean_are_the_same_bits_where_both_hold() {
    for h_face in [0.91, 0.97, 1.0, 1.02, 1.1] {
        let cell = HalfCell {
            psi: 1.7,
            inverse_psi: 1.0 / 1.7,
            psi_behind: 1.1,
            reach: 0.4,
            g: 2.3,
            inverse_g: 1.0 / 2.3,
            g_slope: 0.4,
            h_centre: 1.0,
            inverse_h: 1.0,
            h_face,
            inverses: inverses(1.0, h_face),
            distance: 1.0 / 3.0,
            inverse_distance: 3.0,
            wind: 5.0,
        };
        assert!(!is_steep(1.0, h_face));
        let short = cell.flux::<true>(&cell.logarithmic_mean::<false>());
        let general = cell.flux::<true>(&cell.logarithmic_mean::<true>());
        assert_eq!((short.alpha, short.beta), (general.alpha, general.beta));
    }
}

#[test]
fn half_cell_derivatives_match_differences() {
    for wind in [
        -4000.0, -60.0, -3.0, -0.05, 0.0, 0.001, 0.05, 5.0, 80.0, 4000.0,
    ] {
        for (h_face, psi_behind) in [(0.7, 1.2), (1.0, 2.5), (1.3, 1.9)] {
            let p = 1.2;
            let conductance = |psi: f64| psi + 3.0 + 0.2 * psi * psi;
            let make_with = |v: [f64; 4], extra_g: f64| HalfCell {
                psi: v[0],
                inverse_psi: 1.0 / v[0],
                psi_behind: v[1],
                reach: if wind > 0.0 { 0.45 } else { 0.0 },
                g: conductance(v[0]) + extra_g,
                inverse_g: 1.0 / (conductance(v[0]) + extra_g),
                g_slope: 1.0 + 0.4 * v[0],
                h_centre: v[2],
                h_face: v[3],
                inverses: inverses(v[2], v[3]),
                distance: 0.25,
                inverse_distance: 4.0,
                inverse_h: 1.0 / v[2],
                wind,
            };
            let make = |v| make_with(v, 0.0);
            let at = [1.7, psi_behind, 1.0, h_face];
            let cell = make(at);
            let partials = partials(&cell, p);
            let (by, excess_by, by_p) = (partials.flux, partials.excess, partials.excess_by_p);
            let values = |v: [f64; 4], p: f64| flux_and_excess(&make(v), p);
            let e = 1e-6;
            for k in 0..4 {
                let (mut plus, mut minus) = (at, at);
                plus[k] += e;
                minus[k] -= e;
                let (plus, minus) = (values(plus, p), values(minus, p));
                for (f, analytic) in [by[k], excess_by[k]].into_iter().enumerate() {
                    let numeric = (plus[f] - minus[f]) / (2.0 * e);
                    let scale = 1.0 + numeric.abs() + 1e-3 * wind.abs();
                    assert!(
                        (analytic - numeric).abs() < 1e-6 * scale,
                        "wind {wind} h_face {h_face} variable {k} value {f}: {analytic} {numeric}"
                    );
                }
            }
            let e_g = 1e-4;
            let with_g = |extra_g: f64| flux_and_excess(&make_with(at, extra_g), p);
            for f in 0..2 {
                let numeric = (with_g(e_g)[f] - with_g(-e_g)[f]) / (2.0 * e_g);
                let scale = 1.0 + numeric.abs() + 1e-3 * wind.abs();
                assert!(
                    (partials.by_g[f] - numeric).abs() < 1e-6 * scale,
                    "wind {wind} h_face {h_face} value {f} by G: {} {numeric}",
                    partials.by_g[f]
                );
            }
            let numeric = (values(at, p + e)[1] - values(at, p - e)[1]) / (2.0 * e);
            assert!((by_p - numeric).abs() < 1e-6);
        }
    }
}

/// The flux towards a face grows with the cell's own ψ. With G of the centre alone it falls in front of a pad, where the
/// face has ten times the cell's pressure.
#[test]
fn flux_grows_with_the_cell_that_it_leaves() {
    let slope = |flow: &FlowFactor, of_centre: bool, wind: f64, ratio: f64| {
        let at = |psi: f64| {
            let at_centre = flow.conductance(psi);
            let [g, g_slope, _] = match of_centre {
                true => [at_centre.0, at_centre.1, 0.0],
                false => flow.of_half_cell(psi, at_centre, ratio),
            };
            let cell = HalfCell {
                psi,
                inverse_psi: 1.0 / psi,
                psi_behind: 1.0,
                reach: 0.0,
                g,
                inverse_g: 1.0 / g,
                g_slope,
                h_centre: 1.0,
                inverse_h: 1.0,
                h_face: 1.0,
                inverses: inverses(1.0, 1.0),
                distance: 1.0,
                inverse_distance: 1.0,
                wind,
            };
            let (alpha, beta) = cell.coefficients();
            alpha - beta * ratio
        };
        (at(1.0 + 1e-6) - at(1.0 - 1e-6)) / 2e-6
    };
    for model in [
        FlowModel::Continuum,
        FlowModel::Slip1,
        FlowModel::Slip2,
        FlowModel::FukuiKaneko,
    ] {
        for knudsen in [1e-4, 0.01, 0.1, 1.0, 7.0, 100.0] {
            let flow = FlowFactor::new(model, knudsen);
            for wind in [0.0, 0.1, 1.0, 5.0, 30.0, 200.0] {
                for ratio in [0.01, 0.5, 2.0, 5.0, 10.0, 100.0] {
                    let slope = slope(&flow, false, wind, ratio);
                    assert!(slope > 0.0, "{model:?} {knudsen} {wind} {ratio}: {slope}");
                }
            }
        }
    }
    // (ψ² − ratio²)/2; with first-order slip of 6 Kn = 0.6 (ratio + 0.6) (ψ − ratio)/2. Of the centre ψ (ψ − ratio) and
    // (ψ + 0.6) (ψ − ratio).
    let none = FlowFactor::new(FlowModel::Continuum, 1.0);
    let little = FlowFactor::new(FlowModel::Slip1, 0.1);
    assert!((slope(&none, false, 0.0, 10.0) - 1.0).abs() < 1e-8);
    assert!((slope(&little, false, 0.0, 10.0) - 5.3).abs() < 1e-8);
    assert!((slope(&none, true, 0.0, 10.0) + 8.0).abs() < 1e-8);
    assert!((slope(&little, true, 0.0, 10.0) + 7.4).abs() < 1e-8);
    assert!(slope(&none, true, 2.0, 10.0) < -1.0);
}

/// Where the film thins towards a face faster than the wind carries gas there (Pe < 0), the straight line takes gas from a cell
/// that is emptier than the one behind; without the line nothing does.
#[test]
fn nothing_leaves_an_emptying_cell_without_its_straight_line() {
    let mut taken = 0;
    for wind in [0.05, 1.0, 20.0, 400.0] {
        for h_face in [0.002, 0.1, 0.5, 0.9, 1.0, 1.5, 30.0] {
            for psi in [1e-9, 1e-3, 0.3, 1.0] {
                let alpha = |reach: f64| {
                    let cell = HalfCell {
                        psi,
                        inverse_psi: 1.0 / psi,
                        psi_behind: 5.0,
                        reach,
                        g: 1.0,
                        inverse_g: 1.0,
                        g_slope: 0.0,
                        h_centre: 1.0,
                        inverse_h: 1.0,
                        h_face,
                        inverses: inverses(1.0, h_face),
                        distance: 0.5,
                        inverse_distance: 2.0,
                        wind,
                    };
                    cell.flux::<true>(&cell.logarithmic_mean::<true>()).alpha
                };
                taken += usize::from(alpha(0.45) < 0.0);
                assert!(alpha(0.0) >= 0.0, "{wind} {h_face} {psi}");
            }
        }
    }
    assert!(taken > 3, "{taken}");
}
