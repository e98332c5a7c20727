use super::axis::ResolvedAxis;
use super::*;

#[test]
fn linear_ticks_are_round_and_inside() {
    let axis = ResolvedAxis::new(&Axis::linear("x"), [-52.0, 118.0].into_iter());
    let values: Vec<f64> = axis.ticks.iter().map(|t| t.0).collect();
    assert_eq!(values, [-50.0, -25.0, 0.0, 25.0, 50.0, 75.0, 100.0, 125.0]);
    let labels: Vec<&str> = axis.ticks.iter().map(|t| t.1.as_str()).collect();
    assert_eq!(labels[..3], ["\u{2212}50", "\u{2212}25", "0"]);
}

#[test]
fn a_log_axis_labels_1_2_5_and_ignores_zero() {
    let axis = ResolvedAxis::new(&Axis::log("x"), [0.0, 60.0, 4000.0].into_iter());
    let values: Vec<f64> = axis.ticks.iter().map(|t| t.0).collect();
    assert_eq!(values, [50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0]);
    assert!((axis.share(axis.low)).abs() < 1e-12 && (axis.share(axis.high) - 1.0).abs() < 1e-12);
}

#[test]
fn one_value_or_none_still_makes_an_axis() {
    for data in [vec![], vec![0.0], vec![7.0], vec![f64::NAN]] {
        for axis in [Axis::linear("x"), Axis::log("x")] {
            let axis = ResolvedAxis::new(&axis, data.clone().into_iter());
            assert!(axis.low < axis.high, "{data:?}");
            assert!(!axis.ticks.is_empty(), "{data:?}");
        }
    }
}

#[test]
fn thinning_keeps_a_spike_of_one_sample() {
    let mut points: Vec<(f64, f64)> = (0..100_000).map(|i| (i as f64 * 1e-3, 0.0)).collect();
    points[31_234].1 = 9.0;
    let kept = lines::thinned(&points);
    assert!(kept.len() < 1000, "{}", kept.len());
    assert!(kept.contains(&(31.234, 9.0)));
    assert_eq!((kept[0], kept[kept.len() - 1]), (points[0], points[99_999]));
}

#[test]
fn clipping_breaks_where_the_line_leaves_and_at_nan() {
    let bounds = (0.0, 0.0, 10.0, 10.0);
    let pieces = lines::clipped(
        &[
            (-5.0, 5.0),
            (5.0, 5.0),
            (5.0, 20.0),
            (6.0, 20.0),
            (6.0, 4.0),
        ],
        bounds,
    );
    assert_eq!(
        pieces,
        [
            vec![(0.0, 5.0), (5.0, 5.0), (5.0, 10.0)],
            vec![(6.0, 10.0), (6.0, 4.0)]
        ]
    );
    let broken = lines::clipped(
        &[(1.0, 1.0), (2.0, f64::NAN), (3.0, 1.0), (4.0, 1.0)],
        bounds,
    );
    assert_eq!(broken, [vec![(3.0, 1.0), (4.0, 1.0)]]);
}

#[test]
fn dashes_run_on_across_many_short_segments() {
    let line: Vec<(f64, f64)> = (0..=1000).map(|i| (i as f64 * 0.1, 0.0)).collect();
    let dashes = lines::dashed(&line, Dash::Dashed);
    assert_eq!(
        dashes.len(),
        10,
        "100 px of 7 on, 4 off: nine whole and one begun"
    );
    let drawn: f64 = dashes.iter().map(|d| d[d.len() - 1].0 - d[0].0).sum();
    assert!((drawn - 64.0).abs() < 1e-9, "9 x 7 + 1: {drawn}");
}

#[test]
fn a_range_that_cannot_be_drawn_is_not_taken() {
    for range in [
        (0.0, 500.0),
        (-1.0, 5.0),
        (5.0, 5.0),
        (f64::NAN, 1.0),
        (1.0, f64::INFINITY),
    ] {
        let axis = Axis::log("x").between(range.0, range.1);
        let axis = ResolvedAxis::new(&axis, [20.0, 300.0].into_iter());
        assert!(axis.low > 10.0 && axis.high < 1000.0, "{range:?}");
        assert!(axis.ticks.len() + axis.minor.len() < 40);
    }
}

#[test]
fn a_circle_drawn_to_scale_is_round() {
    let circle: Vec<(f64, f64)> = (0..=360)
        .map(|k| f64::from(k).to_radians())
        .map(|angle| (5.0 + angle.cos(), angle.sin()))
        .collect();
    for panel_px in [(600.0, 300.0), (300.0, 600.0)] {
        let figure = Figure {
            title: String::new(),
            subtitle: String::new(),
            columns: 1,
            panel_px,
            panels: vec![Panel {
                title: String::new(),
                x: Axis::linear("x"),
                y: Axis::linear("y").true_to_scale(),
                series: vec![Series::curve("", (1, 2, 3), Dash::Solid, circle.clone())],
                rules: Vec::new(),
                shaded: None,
            }],
        };
        let svg = figure.svg();
        let path = svg
            .split("<path ")
            .find(|path| path.contains("#010203"))
            .expect("the circle");
        let d = path.split('"').nth(1).expect("its points");
        let numbers: Vec<f64> = d.split(' ').filter_map(|word| word.parse().ok()).collect();
        let extent = |first: usize| {
            let values = numbers.iter().skip(first).step_by(2);
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| {
                (l.min(v), h.max(v))
            });
            high - low
        };
        let (width, height) = (extent(0), extent(1));
        assert!(width > 100.0, "{width}");
        // Thinning may move an end by half a pixel.
        assert!((width - height).abs() < 0.5, "{width} x {height}");
    }
}
