//! Bars against answers that are known.

use super::*;

/// A law of failure: critical amplitude, G, and clearance at its event, for any setting of knobs.
struct Law {
    /// Critical amplitude with every knob infinitely fine, G.
    exact_g: f64,
    /// Error of each knob at level 0, as a share.
    errors: [f64; 6],
    /// Ratio by which a step finer divides each.
    ratios: [f64; 6],
    /// Clearance lost per relative growth of the amplitude, m; `None`: survival ends abruptly.
    slope_m: Option<f64>,
}

impl Law {
    fn critical_g(&self, levels: Levels) -> f64 {
        let errors = Knob::ALL.iter().zip(self.errors.iter().zip(&self.ratios));
        let sum: f64 = errors
            .map(|(&knob, (error, ratio))| error * ratio.powi(-i32::from(levels.of(knob))))
            .sum();
        self.exact_g * (1.0 + sum)
    }

    fn see(&self, lattice: Lattice, ask: Ask) -> Seen {
        let amplitude_g = lattice.amplitude_g(ask.index);
        let critical_g = self.critical_g(ask.levels);
        let survives = amplitude_g < critical_g;
        Seen {
            verdict: match survives {
                true => NodeVerdict::Survives,
                false => NodeVerdict::Fails,
            },
            h_min_m: Some(match (survives, self.slope_m) {
                (false, _) => 0.0,
                (true, Some(slope_m)) => slope_m * (critical_g / amplitude_g - 1.0),
                (true, None) => 2e-9,
            }),
            t_min_s: Some(match self.slope_m {
                Some(_) => 1e-3,
                None => 2e-3,
            }),
        }
    }

    /// The bar of this law on a lattice of one per cent, and the runs it took.
    fn bar(&self) -> (Bar, f64, usize) {
        self.bar_with(3)
    }

    fn input(&self, film_halvings: i8) -> (BarInput, f64) {
        let search = Lattice::for_tolerance(0.01).expect("lattice");
        let lattice = search.finer(SUBNODES);
        let survivor = search.at_or_below(self.critical_g(Levels::NONE) * (1.0 - 1e-12));
        let known = |node: i32| {
            let index = node * SUBNODES;
            let seen = self.see(
                lattice,
                Ask {
                    levels: Levels::NONE,
                    index,
                    retry: Retry::None,
                },
            );
            Known {
                index,
                h_min_m: seen.h_min_m.expect("a clearance"),
                t_min_s: seen.t_min_s.expect("a time"),
            }
        };
        let input = BarInput {
            base: Levels::NONE,
            lattice,
            survivor: survivor * SUBNODES,
            failure: (survivor + 1) * SUBNODES,
            t_fail_s: Some(1e-3),
            survivors: [4, 2, 0].map(|below| known(survivor - below)).to_vec(),
            knobs: Knob::ALL.to_vec(),
            film_halvings,
            mesh_halvings: 0,
            holds_films: false,
            accuracy: 0.01,
        };
        (input, search.amplitude_g(survivor))
    }

    fn bar_with(&self, film_halvings: i8) -> (Bar, f64, usize) {
        let (input, reported_g) = self.input(film_halvings);
        let lattice = input.lattice;
        let (log, progress) = bar(&input, &|ask| Some(self.see(lattice, ask)));
        let Progress::Done(bar) = progress else {
            panic!("{progress:?}")
        };
        (bar, reported_g, log.len())
    }

    /// The answer after at most so many climbs, its amplitude and the runs it took.
    fn climbed(&self, climbs: u8) -> (Answer, f64, usize) {
        let (input, _) = self.input(3);
        let lattice = input.lattice;
        let (log, progress) = answer(&input, climbs, &|ask| Some(self.see(lattice, ask)));
        let Progress::Done(answer) = progress else {
            panic!("{progress:?}")
        };
        let reported_g = lattice.amplitude_g(answer.survivor);
        (answer, reported_g, log.len())
    }

    fn formal(errors: [f64; 6], slope_m: Option<f64>) -> Law {
        Law {
            exact_g: 300.0,
            errors,
            ratios: Knob::ALL.map(Knob::formal_ratio),
            slope_m,
        }
    }
}

/// Error that a part gives on its larger side, as a share.
fn larger(part: Part) -> f64 {
    part.high.max(part.low / (1.0 - part.low))
}

fn part(bar: &Bar, name: &str) -> Part {
    *bar.parts
        .iter()
        .find(|part| part.name == name)
        .unwrap_or_else(|| panic!("no {name} in {bar:?}"))
}

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
fn a_difference_beyond_the_reach_of_the_slope_is_bracketed_instead() {
    // A quarter of the cells moves the answer by 19 %; the slope was measured over 4 %.
    let law = Law::formal([0.065, 0.0, 0.0, 0.0, 0.0, 0.0], Some(1e-7));
    let (bar, reported_g, _) = law.bar();
    let film = part(&bar, "film_grid");
    let truth = law.exact_g / reported_g - 1.0;
    assert!((-film.low..=film.high).contains(&truth), "{film:?} {truth}");
    assert!(film.high < 4.0 * truth.abs(), "{film:?} {truth}");
    assert!(bar.flags.contains(&Flag::BarExceeds));
}

#[test]
fn a_film_too_coarse_to_be_halved_often_is_held_against_a_finer_one() {
    // 3 % off, of which twice the cells show half for certain: 1.5 % + 1.25 * 1.5 %. Each is a quarter
    // larger for the finer film's bracket, and the scene's has a quarter per cent.
    for halvings in [1, 2] {
        let law = Law::formal([0.03, 0.0, 0.0, 0.0, 0.0, 0.0], None);
        let (bar, reported_g, _) = law.bar_with(halvings);
        let film = part(&bar, "film_grid");
        let truth = (law.exact_g / reported_g - 1.0).abs();
        assert_eq!(film.factor, 1.25);
        let error = larger(film);
        assert!(
            error > 1.05 * truth && error < 2.0 * truth,
            "{film:?} {truth}"
        );
    }
}

#[test]
fn coarse_films_that_agree_with_one_another_do_not_hide_what_a_finer_one_shows() {
    // All films up to the scene's own fly elsewhere than finer ones, which fail 40 % below it.
    let law = Law::formal([0.0; 6], None);
    let (input, reported_g) = law.input(2);
    let lattice = input.lattice;
    let see = |ask: Ask, has_half: bool| {
        let mut seen = law.see(lattice, ask);
        if ask.levels.of(Knob::FilmGrid) > 0 && lattice.amplitude_g(ask.index) > 0.6 * law.exact_g {
            seen.verdict = NodeVerdict::Fails;
        }
        if ask.levels.of(Knob::FilmGrid) < 0 && !has_half {
            seen.verdict = NodeVerdict::Undecided;
        }
        Some(seen)
    };
    for has_half in [true, false] {
        let Progress::Done(bar) = bar(&input, &|ask| see(ask, has_half)).1 else {
            panic!("every run is known")
        };
        // Coarser films without flight take no part away.
        assert!(!bar.flags.contains(&Flag::BarPartial), "{bar:?}");
        let film = part(&bar, "film_grid");
        assert_eq!(film.factor, 3.0);
        let low_g = reported_g * (1.0 - film.low);
        assert!(low_g < 0.6 * law.exact_g, "{film:?}");
    }
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
    let (_, progress) = bar(&input, &|_| Some(undecided));
    let Progress::Done(bar) = progress else {
        panic!("{progress:?}")
    };
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

#[test]
fn a_bar_that_exceeds_climbs_on_the_knob_that_dominates() {
    // The film is 3 % off and the rest exact: one doubling leaves 1.5 %, a second 0.75 %.
    let law = Law::formal([0.03, 0.0, 0.0, 0.0, 0.0, 0.0], Some(1e-7));
    let (plain, reported_g, _) = law.bar();
    assert!(plain.half_length() > 0.03 && (reported_g / law.exact_g - 1.0).abs() > 0.02);
    let (answer, climbed_g, _) = law.climbed(2);
    assert_eq!(answer.levels.of(Knob::FilmGrid), 2);
    assert_eq!(answer.levels.of(Knob::DiskModes), 0);
    assert_eq!(answer.levels.of(Knob::HeadTolerance), 0);
    let off = (law.exact_g / climbed_g - 1.0).abs();
    assert!(off < 0.011, "{off}");
    assert!(answer.bar.half_length() > off, "{answer:?}");
    assert!(answer.bar.half_length() < 0.45 * plain.half_length());
}

/// 6 % off calls for two doublings, which leave 1.5 %; from there one at a time.
#[test]
fn climbs_take_two_steps_at_once_from_the_studys_own_knobs_alone() {
    let law = Law::formal([0.06, 0.0, 0.0, 0.0, 0.0, 0.0], Some(1e-7));
    let level = |climbs| law.climbed(climbs).0.levels.of(Knob::FilmGrid);
    assert_eq!([0, 1, 2, 3].map(level), [0, 2, FLOOR, FLOOR]);
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
        let Progress::Done(bar) = progress else {
            panic!("{progress:?}")
        };
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

/// With 10 % off at the study's own rung the film on its floor, sixteen times finer, is the only part above a third
/// of one per cent; what the bar exceeds by, the head can give. With 18 % it cannot, and is left.
#[test]
fn what_does_not_count_is_turned_where_the_rest_is_on_the_floor() {
    let climbed = |film, climbs| {
        let law = Law::formal([film, 0.0, 0.0, 0.0, 0.003, 0.0], Some(1e-7));
        let (answer, ..) = law.climbed(climbs);
        let at = [Knob::FilmGrid, Knob::DiskModes, Knob::HeadTolerance];
        let flags = [Flag::BarExceeds, Flag::BarFloor];
        (
            at.map(|knob| answer.levels.of(knob)),
            flags.map(|flag| answer.bar.flags.contains(&flag)),
        )
    };
    assert_eq!(climbed(0.1, 3), ([FLOOR + 1, 0, 1], [true, true]));
    assert_eq!(climbed(0.1, 4), ([FLOOR + 1, 0, 2], [false, false]));
    assert_eq!(climbed(0.18, 4), ([FLOOR + 1, 0, 1], [true, true]));
}

/// While the film's part exceeds what was asked, the head's is read from one step coarser, which leaves three times its
/// error. The film's last climb makes room for a finer step that tells it.
#[test]
fn what_counts_on_the_floor_is_looked_at_again_when_there_is_room() {
    let law = Law::formal([0.08, 0.0, 0.0, 0.0, 0.096, 0.0], None);
    let [two, three] = [2, 3].map(|climbs| law.climbed(climbs).0);
    let at = [Knob::FilmGrid, Knob::HeadTolerance];
    assert_eq!(at.map(|knob| two.levels.of(knob)), [FLOOR, FLOOR]);
    assert_eq!(at.map(|knob| three.levels.of(knob)), [FLOOR + 1, FLOOR]);
    let error = 0.096 / 64.0;
    let [wide, narrow] = [&two, &three].map(|answer| part(&answer.bar, "head"));
    assert_eq!([wide.factor, narrow.factor], [3.0, 1.25]);
    assert!(
        wide.high > 2.5 * error && narrow.low < 1.5 * error,
        "{narrow:?}"
    );
    assert!(narrow.low > error, "{narrow:?}");
}

/// The other parts leave between half a node and a whole one for the scene's own bracket: it is narrowed to one.
#[test]
fn the_scene_is_bracketed_to_a_node_where_that_meets_what_was_asked() {
    let node = 0.01 / f64::from(SUBNODES);
    let mut to_a_node = 0;
    for film in 0..60 {
        let law = Law::formal(
            [0.0105 + 2e-5 * f64::from(film), 0.0, 0.0, 0.0, 0.0, 0.0],
            Some(1e-7),
        );
        let (bar, ..) = law.bar();
        let search = part(&bar, "search");
        let others = bar.half_length() - 0.5 * (search.low + search.high);
        let exceeds = bar.flags.contains(&Flag::BarExceeds);
        assert_eq!(exceeds, others + 0.495 * node > 0.01, "{others} {bar:?}");
        to_a_node += usize::from(search.high < 1.1 * node);
    }
    assert!(to_a_node > 1, "{to_a_node}");
}

#[test]
fn a_floor_is_said_and_no_climb_is_made_unasked() {
    let law = Law::formal([0.2, 0.0, 0.0, 0.0, 0.0, 0.0], None);
    let (answer, ..) = law.climbed(3);
    assert!(answer.bar.flags.contains(&Flag::BarFloor), "{answer:?}");
    assert!(answer.bar.flags.contains(&Flag::BarExceeds));
    let (still, still_g, asked) = law.climbed(0);
    let (bar, reported_g, log) = law.bar();
    assert_eq!((still.bar, still_g, asked), (bar, reported_g, log));
    assert!(still.levels.is_none());
    let (met, ..) = Law::formal([0.0; 6], Some(1e-7)).climbed(2);
    assert!(met.levels.is_none() && !met.bar.flags.contains(&Flag::BarFloor));
}

/// Films of half, a quarter and twice the cells scatter by 1 and 2 % about an answer 2 % below the converged one. Held
/// still they tell it, and by what they miss of half the cells how well.
#[test]
fn films_held_still_tell_an_error_without_order_and_its_side() {
    let scatter = |levels: Levels| match levels.of(Knob::FilmGrid) {
        -2 => 0.02,
        -1 => -0.02,
        0 => 0.0,
        _ => -0.01,
    };
    let with = |missed: f64, holds_films: bool| {
        let own = Law::formal([0.0; 6], Some(1e-7));
        let (mut input, reported_g) = own.input(3);
        input.holds_films = holds_films;
        let lattice = input.lattice;
        let see = |ask: Ask| {
            let held = ask.levels.of(Knob::HeldFilm);
            let share = match held {
                0 => scatter(ask.levels),
                1 => 0.02,
                _ => scatter(Levels::NONE.turned(Knob::FilmGrid, -1)) + missed,
            };
            let law = Law {
                exact_g: own.exact_g * (1.0 + share),
                ..Law::formal([0.0; 6], Some(1e-7))
            };
            // Levels that the law knows; where a film would not carry the slider, the margin is negative.
            let mut seen = law.see(
                lattice,
                Ask {
                    levels: Levels::NONE,
                    ..ask
                },
            );
            if held != 0 {
                let ratio = law.exact_g / lattice.amplitude_g(ask.index);
                seen.h_min_m = Some(1e-7 * (ratio - 1.0));
                seen.verdict = NodeVerdict::Survives;
            }
            Some(seen)
        };
        let (log, progress) = bar(&input, &see);
        let Progress::Done(bar) = progress else {
            panic!("{progress:?}")
        };
        (part(&bar, "film_grid"), reported_g, log)
    };
    let (film, reported_g, log) = with(0.0, true);
    assert!(
        log.iter().all(|ask| ask.levels.of(Knob::FilmGrid) <= 0),
        "{log:?}"
    );
    let truth = 1.02 * 300.0 / reported_g - 1.0;
    assert!(
        film.high > truth && film.high < 1.2 * truth,
        "{film:?} {truth}"
    );
    assert!(film.low < 0.15 * truth, "{film:?}");
    // Half a per cent missed of half the cells is 1.25 times that on both sides.
    let (missed, ..) = with(0.005, true);
    assert!(
        (missed.low - film.low - 0.00625).abs() < 3e-4,
        "{missed:?} {film:?}"
    );
    assert!(
        (missed.high - film.high - 0.00625).abs() < 3e-4,
        "{missed:?} {film:?}"
    );
    // What they tell worse than coarser films do is not believed; without them twice the cells are asked.
    for (wrong, ..) in [with(0.1, true), with(0.0, false)] {
        assert_eq!(wrong.factor, 3.0);
        assert!(
            wrong.low + wrong.high > 2.0 * (film.low + film.high),
            "{wrong:?}"
        );
    }
}

/// Half the cells are not asked where films held still tell of a quarter what a quarter answered: a third of what they
/// miss there counts, 1.25 times.
#[test]
fn films_held_still_are_believed_where_a_quarter_of_the_cells_bears_them_out() {
    let with = |missed: f64| {
        let own = Law::formal([0.0; 6], Some(1e-7));
        let (mut input, _) = own.input(3);
        input.holds_films = true;
        let lattice = input.lattice;
        let see = |ask: Ask| {
            let held = ask.levels.of(Knob::HeldFilm);
            let share = match (held, ask.levels.of(Knob::FilmGrid)) {
                (0, -2) => -0.02,
                (0, -1) => -0.01,
                (0, _) => 0.0,
                (1, _) => 0.004,
                (-2, _) => -0.02 + missed,
                _ => -0.01 + missed / 3.0,
            };
            let law = Law {
                exact_g: own.exact_g * (1.0 + share),
                ..Law::formal([0.0; 6], Some(1e-7))
            };
            let levels = Levels::NONE;
            let mut seen = law.see(lattice, Ask { levels, ..ask });
            // By its margin, negative where the film would not carry the slider.
            let ratio = law.exact_g / lattice.amplitude_g(ask.index);
            if held != 0 || ask.levels.of(Knob::FilmGrid) < 0 {
                seen.h_min_m = Some(1e-7 * (ratio - 1.0));
                seen.verdict = NodeVerdict::Survives;
            }
            Some(seen)
        };
        let (log, progress) = bar(&input, &see);
        let Progress::Done(bar) = progress else {
            panic!("{progress:?}")
        };
        let asks_half = log.iter().any(|ask| ask.levels.of(Knob::FilmGrid) == -1);
        (part(&bar, "film_grid"), asks_half)
    };
    let (exact, asks_half) = with(0.0);
    assert!(!asks_half);
    assert!(exact.high > 0.004 && exact.high < 0.0048, "{exact:?}");
    let (missed, asks_half) = with(0.006);
    assert!(!asks_half);
    for [with, without] in [[missed.low, exact.low], [missed.high, exact.high]] {
        assert!((with - without - 0.0025).abs() < 2e-4, "{missed:?}");
    }
    // No room is left for what they miss: half the cells are asked.
    assert!(with(0.03).1);
}

/// Corrected films of a quarter, half and all cells agree in what their reference errs by, 3 %, which films held still
/// show. Twice the cells decide between them.
#[test]
fn agreement_of_coarse_films_does_not_outweigh_what_held_ones_show() {
    let own = Law::formal([0.0; 6], Some(1e-7));
    let (mut input, _) = own.input(3);
    input.holds_films = true;
    let lattice = input.lattice;
    let see = |ask: Ask| {
        let (held, cells) = (ask.levels.of(Knob::HeldFilm), ask.levels.of(Knob::FilmGrid));
        let share = if held > 0 || cells > 0 { -0.03 } else { 0.0 };
        let ratio = own.exact_g * (1.0 + share) / lattice.amplitude_g(ask.index);
        let levels = Levels::NONE;
        let mut seen = own.see(lattice, Ask { levels, ..ask });
        if held != 0 || cells > 0 {
            seen.h_min_m = Some(1e-7 * (ratio - 1.0));
            seen.verdict = NodeVerdict::Survives;
        }
        Some(seen)
    };
    let (_, progress) = bar(&input, &see);
    let Progress::Done(bar) = progress else {
        panic!("{progress:?}")
    };
    let film = part(&bar, "film_grid");
    assert!(film.low > 0.029 && film.factor == 3.0, "{film:?}");
}

/// Half and a quarter of the cells lie 0.4 and 1.2 % off, as their order wants; twice the cells fail 12 % lower, at every
/// survivor that the others are compared at.
#[test]
fn a_finer_film_that_fails_where_coarser_ones_survive_is_bracketed() {
    let own = Law::formal([0.004, 0.0, 0.0, 0.0, 0.0, 0.0], Some(1e-7));
    let (input, reported_g) = own.input(3);
    let lattice = input.lattice;
    let finer = Law {
        exact_g: 0.88 * own.exact_g,
        ..Law::formal([0.004, 0.0, 0.0, 0.0, 0.0, 0.0], Some(1e-7))
    };
    let see = |ask: Ask| {
        let law = if ask.levels.of(Knob::FilmGrid) > 0 {
            &finer
        } else {
            &own
        };
        Some(law.see(lattice, ask))
    };
    let (_, progress) = bar(&input, &see);
    let Progress::Done(bar) = progress else {
        panic!("{progress:?}")
    };
    let film = part(&bar, "film_grid");
    let truth = 1.0 - finer.exact_g / reported_g;
    assert!(film.low > truth && film.factor == 3.0, "{film:?} {truth}");
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
        let (_, progress) = bar(&input, &see);
        let Progress::Done(bar) = progress else {
            panic!("{progress:?}")
        };
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
                let Progress::Done(bar) = progress else {
                    panic!("{progress:?}")
                };
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

#[test]
fn a_climbed_scene_without_verdict_is_tried_again_down_the_ladder() {
    let law = Law::formal([0.03, 0.0, 0.0, 0.0, 0.0, 0.0], Some(1e-7));
    let (input, _) = law.input(3);
    let lattice = input.lattice;
    let climb = |needs: Option<Retry>| {
        let lookup = |ask: Ask| {
            let mut seen = law.see(lattice, ask);
            // On finer films nothing has a verdict before that retry.
            if ask.levels.of(Knob::FilmGrid) > 0 && needs.is_none_or(|needs| ask.retry < needs) {
                seen.verdict = NodeVerdict::Undecided;
                seen.h_min_m = None;
            }
            Some(seen)
        };
        let (log, progress) = answer(&input, 2, &lookup);
        let Progress::Done(answer) = progress else {
            panic!("{progress:?}")
        };
        (log, answer)
    };
    let (plain, _, _) = law.climbed(2);
    let (log, retried) = climb(Some(Retry::QuarterStep));
    assert_eq!(
        (retried.levels, retried.survivor),
        (plain.levels, plain.survivor)
    );
    assert!(retried.bar.flags.contains(&Flag::Retry));
    assert!(!plain.bar.flags.contains(&Flag::Retry));
    // Every retry follows the run one rung down the ladder, and coarser scenes make none.
    for (place, ask) in log
        .iter()
        .enumerate()
        .filter(|(_, ask)| ask.retry != Retry::None)
    {
        assert!(ask.levels.of(Knob::FilmGrid) > 0 && place > 0, "{ask:?}");
        assert_eq!(log[place - 1].retry.next(), Some(ask.retry));
        assert_eq!(
            (log[place - 1].levels, log[place - 1].index),
            (ask.levels, ask.index)
        );
    }
    // Where no retry helps, the climb ends and the answer stays.
    let (log, stayed) = climb(None);
    assert!(stayed.levels.is_none() && stayed.bar.flags.contains(&Flag::BarFloor));
    assert_eq!(
        log.iter()
            .filter(|ask| ask.retry == Retry::OtherContact)
            .count(),
        1
    );
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

#[test]
fn a_bracket_is_halved_where_that_alone_meets_what_was_asked() {
    // 0.5 % of the bracket and 0.53 % of the film exceed 1 %; half of the former does not.
    let law = Law::formal([0.006, 0.0, 0.0, 0.0, 0.0, 0.0], Some(1e-7));
    let (met, _, runs) = law.climbed(0);
    assert_eq!(met.failure - met.survivor, SUBNODES / 2);
    assert!(!met.bar.flags.contains(&Flag::BarExceeds), "{met:?}");
    assert!(met.bar.half_length() + 0.0025 > 0.01, "{met:?}");
    // Nothing is halved where that does not help: 5 % of the film stay.
    let far = Law::formal([0.05, 0.0, 0.0, 0.0, 0.0, 0.0], Some(1e-7));
    let (exceeds, ..) = far.climbed(0);
    assert_eq!(exceeds.failure - exceeds.survivor, SUBNODES);
    assert!(exceeds.bar.flags.contains(&Flag::BarExceeds) && runs > 0);
    // Nor a climb made where it does.
    assert!(law.climbed(2).0.levels.is_none());
}

#[test]
fn half_the_cells_and_the_scene_are_halved_together_as_far_as_is_needed() {
    // A quarter and an eighth of the cells fail 2 % above the scene and all finer ones alike; disk
    // and ramp are 0.3 % off.
    let law = Law::formal([0.0, 0.003, 0.0, 0.0, 0.0, 0.0], None);
    let (input, _) = law.input(3);
    let lattice = input.lattice;
    let lookup = |ask: Ask| {
        let levels = ask
            .levels
            .turned(Knob::FilmGrid, -ask.levels.of(Knob::FilmGrid));
        let shift = if ask.levels.of(Knob::FilmGrid) < -1 {
            32
        } else {
            0
        };
        let index = ask.index - shift;
        Some(law.see(
            lattice,
            Ask {
                levels,
                index,
                ..ask
            },
        ))
    };
    let Progress::Done(met) = answer(&input, 0, &lookup).1 else {
        panic!("every run is known")
    };
    assert!(!met.bar.flags.contains(&Flag::BarExceeds), "{met:?}");
    let structure = part(&met.bar, "structure");
    assert!(structure.high > 0.003, "{structure:?}");
    // The film's bound and half the bracket are what a bracket of that width makes them.
    let width = f64::from(met.failure - met.survivor) * lattice.step();
    let film = part(&met.bar, "film_grid");
    assert!((film.high / (1.25 * width) - 1.0).abs() < 1e-3, "{film:?}");
    // One halving less would not have met what was asked.
    assert!(met.bar.half_length() + 1.7 * width > 0.01, "{met:?}");
}

/// A ramp's mesh is a part of its own, its error with the factor of safety.
#[test]
fn the_mesh_of_a_ramp_has_a_part_of_its_own_and_is_climbed_as_far_as_finer_ones_go() {
    for slope_m in [Some(1e-7), None] {
        let law = Law::formal([0.002, 0.0, 0.0, 0.0, 0.0, 0.0], slope_m);
        let mesh = |levels: Levels| 0.02 * 0.5f64.powi(i32::from(levels.of(Knob::RampMesh)));
        let turned = |lattice: Lattice, ask: Ask| {
            let law = Law {
                exact_g: law.exact_g * (1.0 + mesh(ask.levels) / (1.0 + law.errors[0])),
                ..Law::formal(law.errors, slope_m)
            };
            law.see(lattice, ask)
        };
        // Brackets and survivors of the mesh as the study has it.
        let own = Law {
            exact_g: law.exact_g * (1.0 + mesh(Levels::NONE) / (1.0 + law.errors[0])),
            ..Law::formal(law.errors, slope_m)
        };
        let (without, _) = own.input(3);
        let mut input = without.clone();
        input.knobs.push(Knob::RampMesh);
        input.mesh_halvings = 3;
        let lattice = input.lattice;
        let (log, progress) = bar(&input, &|ask| Some(turned(lattice, ask)));
        let Progress::Done(with) = progress else {
            panic!("{progress:?}")
        };
        let mesh_part = part(&with, "ramp_mesh");
        let (factor, expected) = match slope_m {
            // What twice as fine shows for certain and 1.25 times what that lacks.
            Some(_) => (1.25, 0.0225),
            // Finer ones cannot bring the bar to what was asked: thrice what a coarser one shows.
            None => (3.0, 0.06),
        };
        assert_eq!(mesh_part.factor, factor);
        // The margin is linear in 1/A; brackets leave a quarter of a distance open.
        let over = larger(mesh_part) / expected;
        assert!((0.8..1.3).contains(&over), "{slope_m:?} {mesh_part:?}");
        assert!(with.flags.contains(&Flag::BarExceeds));
        assert!(!with.flags.contains(&Flag::BarPartial));
        // The parts found before it are those of a study that gives its ramp by modes.
        let (plain_log, progress) = bar(&without, &|ask| Some(turned(lattice, ask)));
        let Progress::Done(plain) = progress else {
            panic!("{progress:?}")
        };
        assert!(plain.parts.iter().all(|part| part.name != "ramp_mesh"));
        assert_eq!(plain.parts.len() + 1, with.parts.len());
        for name in ["structure", "head"] {
            assert_eq!(part(&plain, name), part(&with, name));
        }
        assert!(plain_log.len() < log.len());
        // A mesh is climbed while one finer can still be made; other knobs are not where it is too coarse.
        // Two steps leave 0.5 %: 0.56 % by margin, some 1.7 % by verdicts, whose brackets are of that size.
        let by_verdicts = slope_m.is_none();
        for (mesh_halvings, climbed, exceeds) in [
            (0, 0, true),
            (1, 0, true),
            (2, 1, true),
            (3, 2, by_verdicts),
        ] {
            input.mesh_halvings = mesh_halvings;
            let (log, progress) = answer(&input, 3, &|ask| Some(turned(lattice, ask)));
            let Progress::Done(answer) = progress else {
                panic!("{progress:?}")
            };
            let expected = Levels::NONE.turned(Knob::RampMesh, climbed);
            assert_eq!(answer.levels, expected, "{slope_m:?} {mesh_halvings}");
            assert!(
                log.iter()
                    .all(|ask| ask.levels.of(Knob::RampMesh) <= mesh_halvings)
            );
            assert_eq!(answer.bar.flags.contains(&Flag::BarExceeds), exceeds);
            assert_eq!(answer.bar.flags.contains(&Flag::BarFloor), exceeds);
            // What is reported lies within its bar of the ramp on a mesh without end.
            let reported_g = lattice.amplitude_g(answer.survivor);
            let exact_g = law.critical_g(Levels::NONE);
            let high: f64 = answer.bar.parts.iter().map(|part| part.high).sum();
            let low: f64 = answer.bar.parts.iter().map(|part| part.low).sum();
            assert!(exact_g < reported_g * (1.0 + high) && exact_g > reported_g * (1.0 - low));
        }
    }
}
