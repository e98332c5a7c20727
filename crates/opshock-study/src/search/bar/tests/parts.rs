//! Parts of a bar, their factors and flags, the runs they take.

use super::*;

#[test]
fn a_knob_of_formal_order_gives_its_error_times_the_narrow_factor() {
    // Film 1 %, modes -1 %, by margin: the laws are linear in 1/A, not in A, hence 5 %.
    let law = Law::formal([0.01, -0.01, 0.0, 0.0, 0.0, 0.0], Some(1e-7));
    let (bar, _, _) = law.bar();
    let film = part(&bar, "film_grid");
    assert_eq!(film.factor, 1.25);
    // A step finer shows half of it for certain, on its side: 0.5 % + 1.25 * 0.5 %, and 1.25 * 0.5 % on the other.
    assert!(
        (larger(film) / (1.125 * 0.01) - 1.0).abs() < 0.05,
        "{film:?}"
    );
    assert!((film.high / (0.625 * 0.01) - 1.0).abs() < 0.05, "{film:?}");
    let modes = part(&bar, "structure");
    assert_eq!(modes.factor, 1.25);
    assert!(
        (modes.high / (1.125 * 0.01) - 1.0).abs() < 0.10,
        "{modes:?}"
    );
    assert!((modes.low / (0.625 * 0.01) - 1.0).abs() < 0.10, "{modes:?}");
    assert!(!bar.flags.contains(&Flag::BarPartial));
    assert!(bar.flags.contains(&Flag::BarExceeds));
}

#[test]
fn an_abrupt_end_of_survival_is_read_from_verdicts() {
    let law = Law::formal([0.01, -0.01, 0.0, 0.0, 0.0, 0.0], None);
    let (bar, _, _) = law.bar();
    // Brackets of 1/16 % and of a quarter of a distance leave a third of the parts open.
    let film = part(&bar, "film_grid");
    assert!(
        (0.8..1.4).contains(&(film.high / (1.25 * 0.01))),
        "{film:?}"
    );
    let modes = part(&bar, "structure");
    assert!(modes.high >= 0.01, "{modes:?}");
    // The head's knobs move nothing: together they are within a node.
    let still = part(&bar, "head");
    assert_eq!(still.factor, 1.25);
    assert!(still.high < 0.05 * bar.half_length(), "{still:?}");
}

#[test]
fn disorder_is_marked_and_carries_the_wide_factor() {
    // A step divides the error by 1.3 instead of 2: what is left is thrice what was seen.
    let mut law = Law::formal([0.0, 0.01, 0.0, 0.0, 0.0, 0.0], Some(1e-7));
    law.ratios[Knob::DiskModes as usize] = 1.3;
    let (bar, _, _) = law.bar();
    let modes = part(&bar, "structure");
    assert_eq!(modes.factor, 3.0);
    assert!(modes.high > 0.0099, "{modes:?}");
    law.errors[Knob::DiskModes as usize] = 0.5;
    let (bar, _, _) = law.bar();
    assert!(bar.flags.contains(&Flag::BarWide));
}

#[test]
fn knobs_that_move_nothing_cost_two_runs_a_group() {
    let (bar, _, by_margin) = Law::formal([0.0; 6], Some(1e-7)).bar();
    let names: Vec<&str> = bar.parts.iter().map(|part| part.name).collect();
    assert_eq!(names, ["search", "film_grid", "structure", "head"]);
    assert_eq!(by_margin, 1 + 1 + 2);
    let (bar, _, by_verdicts) = Law::formal([0.0; 6], None).bar();
    assert_eq!(bar.parts.len(), 4);
    // Two coarse films of at most six runs each.
    assert!(by_verdicts <= 12 + 4, "{by_verdicts}");
}

#[test]
fn knobs_against_each_other_do_not_hide() {
    // Together they move the answer by a tenth of what each does.
    let law = Law::formal([0.0, 0.02, 0.0, -0.018, 0.0, 0.0], None);
    let (bar, reported_g, _) = law.bar();
    let truth = law.exact_g / reported_g - 1.0;
    let half = bar.half_length();
    assert!(half > truth.abs(), "{half} {truth}");
    // No amplitude can lose more than itself.
    assert!(
        bar.parts
            .iter()
            .all(|part| (0.0..1.0).contains(&part.low) && part.high >= 0.0)
    );
}

#[test]
fn what_cannot_be_read_is_said() {
    let law = Law::formal([0.0; 6], Some(1e-7));
    let search = Lattice::for_tolerance(0.01).expect("lattice");
    let input = BarInput {
        base: Levels::NONE,
        lattice: search.finer(SUBNODES),
        survivor: 8000,
        failure: 8000 + SUBNODES,
        t_fail_s: None,
        survivors: Vec::new(),
        knobs: Knob::ALL.to_vec(),
        film_halvings: 3,
        mesh_halvings: 0,
        holds_films: false,
        accuracy: 0.01,
    };
    let undecided = Seen {
        verdict: NodeVerdict::Undecided,
        h_min_m: None,
        t_min_s: None,
    };
    let bar = done(bar(&input, &|_| Some(undecided)).1);
    assert!(bar.flags.contains(&Flag::BarPartial));
    assert_eq!(bar.parts.len(), 1);
    assert!(law.bar().0.half_length() < 0.01);
}

#[test]
fn a_bar_asks_the_same_runs_whether_it_knows_many_or_few() {
    let law = Law::formal([0.01, 0.004, 0.002, 0.0, -0.003, 0.0], None);
    let lattice = Lattice::for_tolerance(0.01)
        .expect("lattice")
        .finer(SUBNODES);
    let node = |amplitude_g: f64| {
        Lattice::for_tolerance(0.01)
            .expect("lattice")
            .at_or_below(amplitude_g)
    };
    let survivor = node(law.critical_g(Levels::NONE)) * SUBNODES;
    let input = BarInput {
        base: Levels::NONE,
        lattice,
        survivor,
        failure: survivor + SUBNODES,
        t_fail_s: None,
        survivors: Vec::new(),
        knobs: Knob::ALL.to_vec(),
        film_halvings: 3,
        mesh_halvings: 0,
        holds_films: false,
        accuracy: 0.01,
    };
    let (whole, _) = bar(&input, &|ask| Some(law.see(lattice, ask)));
    let mut known: Vec<Ask> = Vec::new();
    loop {
        let lookup = |ask: Ask| known.contains(&ask).then(|| law.see(lattice, ask));
        let (log, progress) = bar(&input, &lookup);
        assert_eq!(log, known);
        match progress {
            Progress::Wants(ask) => known.push(ask),
            Progress::Done(_) => break,
        }
    }
    assert_eq!(known, whole);
}

/// The highest survivor comes close when the failure touches, those that the search met below it came close earlier,
/// and less so: a survivor just below tells the slope, and no other scene is bracketed. Where the highest is hardly closer
/// than they are, survival ends abruptly, and nothing is asked.
#[test]
fn a_slope_is_asked_for_where_a_touch_grows_late() {
    let law = Law::formal([0.002, 0.0, 0.0, 0.0, 0.0, 0.0], Some(1e-7));
    let (mut input, _) = law.input(3);
    let lattice = input.lattice;
    let highest = input.survivors[2];
    let with = |input: &BarInput| {
        let (log, progress) = bar(input, &|ask| Some(law.see(lattice, ask)));
        let bar = done(progress);
        (log, part(&bar, "film_grid"))
    };
    let (known, by_margin) = with(&input);
    for (below, found) in [(20.0, true), (4.0, false)] {
        for survivor in &mut input.survivors[..2] {
            survivor.t_min_s = 0.4e-3;
            survivor.h_min_m = below * highest.h_min_m;
        }
        let (log, film) = with(&input);
        let own = |ask: &&Ask| ask.levels.is_none() && ask.index < highest.index;
        let asked: Vec<i32> = log.iter().filter(own).map(|ask| ask.index).collect();
        assert_eq!(asked == [highest.index - SUBNODES], found, "{asked:?}");
        assert_eq!(log.len() == known.len() + 1, found, "{log:?}");
        if found {
            assert!(
                (film.high / by_margin.high - 1.0).abs() < 0.05,
                "{film:?} {by_margin:?}"
            );
        }
    }
}

/// The scene survives at its bracket's lower end and fails where a slope is asked for, one per cent below.
#[test]
fn a_failure_met_below_the_answer_is_said() {
    let law = Law::formal([0.002, 0.0, 0.0, 0.0, 0.0, 0.0], Some(1e-7));
    let (mut input, _) = law.input(3);
    let lattice = input.lattice;
    let highest = input.survivors[2];
    for survivor in &mut input.survivors[..2] {
        survivor.t_min_s = 0.4e-3;
        survivor.h_min_m = 20.0 * highest.h_min_m;
    }
    let with = |fails: bool| {
        let see = |ask: Ask| {
            let mut seen = law.see(lattice, ask);
            if fails && ask.levels.is_none() && ask.index < input.survivor {
                seen.verdict = NodeVerdict::Fails;
            }
            Some(seen)
        };
        let bar = done(bar(&input, &see).1);
        bar.flags.contains(&Flag::NonMonotone)
    };
    assert_eq!([true, false].map(with), [true, false]);
}

/// Errors of up to two and a half nodes on films of formal order, wherever the nodes lie: the brackets of a quarter and of an
/// eighth of the cells do not resolve them, and the bar holds the truth all the same.
#[test]
fn errors_below_what_brackets_resolve_are_covered() {
    let node = 0.01 / f64::from(SUBNODES);
    for error in 0..=10 {
        for phase in 0..48 {
            let mut law = Law::formal(
                [0.25 * f64::from(error) * node, 0.0, 0.0, 0.0, 0.0, 0.0],
                None,
            );
            law.exact_g *= 1.0 + f64::from(phase) * node / 3.0;
            let (input, _) = law.input(3);
            for accuracy in [0.0009, 0.0012, 0.0015, 0.002, 0.0025, 0.003, 0.004, 0.01] {
                let input = BarInput {
                    accuracy,
                    knobs: vec![Knob::FilmGrid],
                    ..input.clone()
                };
                let (log, progress) = bar(&input, &|ask| Some(law.see(input.lattice, ask)));
                let bar = done(progress);
                let own = log.iter().filter(|ask| ask.levels.is_none());
                let survivor = own
                    .filter(|&&ask| law.see(input.lattice, ask).verdict == NodeVerdict::Survives)
                    .map(|ask| ask.index)
                    .max()
                    .map_or(input.survivor, |index| index.max(input.survivor));
                let truth = law.exact_g / input.lattice.amplitude_g(survivor) - 1.0;
                let (low, high) = bar.parts.iter().fold((0.0, 0.0), |sum, part| {
                    (sum.0 + part.low, sum.1 + part.high)
                });
                assert!(
                    truth > -low && truth < high,
                    "{error} {phase} {accuracy} {truth} {bar:?}"
                );
            }
        }
    }
}

/// Brackets of further parts are a 16th of the bar's length, an eighth where it exceeds 10 % whatever they say.
#[test]
fn parts_of_a_bar_that_exceeds_in_any_case_are_bracketed_half_as_closely() {
    let (mut input, _) = Law::formal([0.0; 6], None).input(3);
    input.accuracy = 0.1;
    let (lookup, mut log) = (|_: Ask| None, Vec::new());
    let walk = Walk::new(&input, &lookup, &mut log);
    let grain = |half: f64, spare: f64| {
        let part = Part {
            name: "search",
            low: half,
            high: half,
            factor: 1.0,
        };
        let sum = Bar {
            parts: vec![part],
            ..Bar::default()
        };
        walk.share(Limits::of(&walk, &sum, spare).grain) / (2.0 * half)
    };
    let step = walk.share(1);
    for (half, spare, expected) in [
        (0.05, 0.0, 1.0 / 16.0),
        (0.2, 0.0, 1.0 / 8.0),
        (0.2, 0.15, 1.0 / 16.0),
    ] {
        let found = grain(half, spare);
        let slack = step / (2.0 * half);
        assert!(
            found <= expected * 1.01 && found > expected - 1.01 * slack,
            "{found}, not {expected}"
        );
    }
}
