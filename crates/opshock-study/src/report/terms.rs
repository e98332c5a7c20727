//! The words of tables, plots and pages with their meaning: the one place that legends, explanations on hover and
//! `docs/terms.md` take them from.

use crate::search::{Flag, Status};
use crate::store::summary::PointSummary;

/// Where a word stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Heading of a column of the table of critical shocks.
    Column,
    /// How the search of a row ended.
    Status,
    /// A flag that takes something from the answer: its row is shaded, its mark open.
    Reservation,
    /// A flag that says how the answer was found.
    Note,
    /// A contribution to the uncertainty interval.
    Contribution,
    /// Heading of a section of the page.
    Section,
    /// A sign in a plot.
    Sign,
    /// A word of sentences.
    Word,
}

/// A word and its meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Term {
    /// Where it stands.
    pub kind: Kind,
    /// Name in files; of a section, its address in the page.
    pub name: &'static str,
    /// As people read it.
    pub shown: &'static str,
    /// Meaning.
    pub text: &'static str,
}

const fn term(kind: Kind, name: &'static str, shown: &'static str, text: &'static str) -> Term {
    Term {
        kind,
        name,
        shown,
        text,
    }
}

/// All words, by kind.
#[rustfmt::skip]
pub const TERMS: &[Term] = &[
    term(Kind::Column, "ramp", "ramp", "Model of the load/unload ramp: none, rigid or deformable."),
    term(Kind::Column, "pulse_ms", "pulse (ms)", "Width of the shock pulse, ms."),
    term(Kind::Column, "sign", "sign", "Direction of the shock: + moves the disk towards the slider first, - away from it first."),
    term(Kind::Column, "a_crit_g", "A_crit (G)", "Estimate of the critical shock, in multiples of 9.80665 m/s2: the middle of its uncertainty interval, or of the bracket where there is no interval. \"> A\": no failure up to A, the end of the searched range; \"< A\": failure already at A, its start."),
    term(Kind::Column, "uncertainty_g", "uncertainty (G)", "Half-width of the numerical uncertainty interval of A_crit. The interval has the bracket of the search and the discretisation errors. Empty: not computed."),
    term(Kind::Column, "half_min_height_g", "half min. height (G)", "Change of the critical shock with half the minimum film height (resolution.min_film_height_nm), to half a step of the search or a quarter of the change, at the study's own resolution. No part of the uncertainty interval. Empty: not computed, or the clearance called failure is above twice that height."),
    term(Kind::Column, "survived_g", "survived (G)", "Lower end of the bracket: the largest amplitude survived below the smallest that failed."),
    term(Kind::Column, "failed_g", "failed (G)", "Upper end of the bracket: the smallest amplitude that failed: the clearance of the slider fell below failure.clearance_nm, 0 by default, or contact exceeded a limit of failure.damage where failure.criterion says so."),
    term(Kind::Column, "onset_g", "first touch (G)", "The amplitude from which on the disk reaches the ramp."),
    term(Kind::Column, "runs", "runs", "Simulations that the row asked for, those for its uncertainty included. Points that are answered before give it its starting amplitude, so that the same point takes other numbers in other studies."),
    term(Kind::Column, "mechanism", "mechanism", "Why the lowest failure of the search, at the study's own resolution, fails, by its forces and times (docs/mechanisms.md); in the table of the page. Empty: its history is not kept (output.keep_histories), or contact exceeded a limit of damage after the touch."),
    term(Kind::Column, "status", "status", "How the search of the row ended."),
    term(Kind::Column, "flags", "flags", "What else a reader of the row must know; empty: nothing."),

    term(Kind::Status, "ok", "found", "The critical shock is bracketed, as closely as the study asks (search.tolerance_pct)."),
    term(Kind::Status, "above_range", "above the range", "No failure up to the end of the searched range (search.amplitude_g.max): the critical shock is higher."),
    term(Kind::Status, "below_range", "below the range", "Failure already at the start of the searched range (search.amplitude_g.min): the critical shock is lower."),
    term(Kind::Status, "undecided", "undecided", "Simulations without verdict stand between the largest survivor and the smallest failure."),
    term(Kind::Status, "open", "not finished", "The search, or that of the uncertainty interval, has not ended: run the sweep again to go on."),

    term(Kind::Reservation, "non_monotone", "non_monotone", "Failure is not monotone in amplitude: a survivor lies above a failure. The bracket is that of the smallest failure."),
    term(Kind::Reservation, "window", "window", "The largest survivor fails later, in a simulated time (pulse.window_ms) twice as long: the critical shock is too high."),
    term(Kind::Reservation, "window_undecided", "window_undecided", "In a simulated time twice as long the largest survivor has no verdict."),
    term(Kind::Reservation, "undecided_amplitude", "undecided_amplitude", "An amplitude without verdict widens the bracket or leaves a gap in the scan for earlier failures."),
    term(Kind::Reservation, "not_converged", "not_converged", "A simulation did not converge and has no verdict."),
    term(Kind::Reservation, "step_limit", "step_limit", "A simulation reached its largest number of time steps and has no verdict."),
    term(Kind::Reservation, "not_finite", "not_finite", "A simulation met a number that is not finite and has no verdict."),
    term(Kind::Reservation, "panicked", "panicked", "A simulation broke down and has no verdict."),
    term(Kind::Reservation, "not_built", "not_built", "The drive of a simulation could not be built: it has no verdict."),
    term(Kind::Reservation, "onset_unknown", "onset_unknown", "The amplitude of first touch is not known, so that nothing was taken from the answer without ramp."),
    term(Kind::Reservation, "contribution_missing", "contribution_missing", "A contribution to the uncertainty interval could not be estimated and is missing from it."),
    term(Kind::Reservation, "target_not_met", "target_not_met", "Half the width of the uncertainty interval is more than the target (search.target_uncertainty_pct, or that of the resolution preset)."),
    term(Kind::Reservation, "refinement_limit", "refinement_limit", "The target is not met although the answer was refined, and nothing is left: search.max_refinements is reached, every discretisation parameter is at its finest, or the refined simulation has no verdict."),

    term(Kind::Note, "retry", "retry", "A verdict needed smaller time steps or another method; it counts as any other."),
    term(Kind::Note, "no_touch", "no_touch", "The disk does not reach the ramp below the critical shock: the answer is that without ramp."),
    term(Kind::Note, "safety_factor_3", "safety_factor_3", "A discretisation error did not fall as its method predicts, or one step alone does not show how it falls; the interval has it times 3 instead of 1.25."),
    term(Kind::Note, "refined", "refined", "The answer is that of discretisation parameters refined beyond the study's resolution, to meet the target uncertainty."),
    term(Kind::Note, "below_continuum", "below_continuum", "Failure is decided below twice the minimum film height, where the film's pressure is that of a limited height and not of the gap: half_min_height_g says what half of it changes. A larger failure.clearance_nm avoids it."),

    term(Kind::Contribution, "search", "search", "The bracket of the search."),
    term(Kind::Contribution, "film_correction", "film_correction", "Grid of the film's defect correction."),
    term(Kind::Contribution, "film_grid", "film_grid", "Cells of the air film."),
    term(Kind::Contribution, "ramp_mesh", "ramp_mesh", "Finite elements of the ramp."),
    term(Kind::Contribution, "structure", "structure", "All discretisation parameters of disk and ramp, changed together."),
    term(Kind::Contribution, "disk_modes", "disk_modes", "Highest frequency of the disk's modes."),
    term(Kind::Contribution, "structure_step", "structure_step", "Time step of disk and ramp."),
    term(Kind::Contribution, "head", "head", "Tolerances of slider, film and suspension, changed together."),
    term(Kind::Contribution, "suspension_modes", "suspension_modes", "Number of the suspension's modes."),
    term(Kind::Contribution, "head_tolerance", "head_tolerance", "Tolerance of the time steps of slider, film and suspension."),
    term(Kind::Contribution, "coupling_tolerance", "coupling_tolerance", "Tolerance of the iteration between film and slider."),

    term(Kind::Section, "critical", "Critical shock", "Critical shock over the axis with most numbers, or over that of --x."),
    term(Kind::Section, "table", "Table", "A row for every point of the study. Shaded rows have a reservation."),
    term(Kind::Section, "choices", "Choices", "Every value of an axis with its worst case, and whether the best leads it beyond the uncertainty intervals."),
    term(Kind::Section, "crossings", "Crossings", "Pulse widths at which two ramp models change places."),
    term(Kind::Section, "points", "Points", "A page for every point: its answer, uncertainty interval and simulations."),
    term(Kind::Section, "compare", "Compare", "Any two points side by side."),
    term(Kind::Section, "map", "Outcome map", "Every simulation behind the answers at its amplitude."),
    term(Kind::Section, "margin", "Margin", "Smallest clearance between slider and disk against amplitude."),
    term(Kind::Section, "film", "One shock", "A stored shock, moving."),
    term(Kind::Section, "accuracy", "Accuracy", "What the uncertainty intervals are made of."),
    term(Kind::Section, "effects", "Effects", "Physical effects that were simulated for each ramp model, and those left out."),
    term(Kind::Section, "time", "Time", "Simulations and time that the rules of `opshock explain` saved."),
    term(Kind::Section, "reservations", "Reservations", "Points whose answers have a reservation, with the reason."),
    term(Kind::Section, "words", "Words", "Meaning of columns, flags and signs."),
    term(Kind::Section, "provenance", "Provenance", "Program, study and work behind the numbers."),

    term(Kind::Sign, "full", "full mark", "A critical shock without reservation."),
    term(Kind::Sign, "open", "open mark, shaded row", "A critical shock with a reservation: its status is not ok or one of its flags takes something from the answer."),
    term(Kind::Sign, "bar", "vertical bar", "Uncertainty interval."),
    term(Kind::Sign, "arrow", "open arrow", "Only a bound: no failure up to the end, or failure at the start, of the searched range."),
    term(Kind::Sign, "worst", "worst of all signs or heads", "The lowest critical shock of all signs, and of all heads of a drive, at each value of the abscissa."),
    term(Kind::Sign, "minus", "dashed curve (map, margin)", "Sign -: the disk moves away from the slider first."),
    term(Kind::Sign, "survives", "blue open circle (map)", "A simulation that survives."),
    term(Kind::Sign, "fails", "orange square (map)", "A simulation that fails."),
    term(Kind::Sign, "named", "larger mark (map)", "The lowest failure of a point whose history is kept, by its mechanism."),
    term(Kind::Sign, "undecided", "purple mark (map)", "A simulation without verdict."),
    term(Kind::Sign, "touched", "open mark (margin)", "A simulation that fails."),

    term(Kind::Word, "bracket", "bracket", "The largest amplitude survived below the smallest that failed, and that: the critical shock at the resolution of the simulations lies between."),
    term(Kind::Word, "SF 3", "SF 3", "A contribution whose discretisation error is multiplied by 3 instead of 1.25, as safety_factor_3 says of the row when the contribution is more than a quarter of the target."),
    term(Kind::Word, "bracket alone", "bracket alone", "A critical shock whose uncertainty interval was not computed."),
    term(Kind::Word, "lead of the best", "lead of the best", "Whether the best value's worst case lies above that of this value beyond the uncertainty intervals, beyond the brackets, or not at all."),
    term(Kind::Word, "beyond brackets, no intervals", "beyond brackets, no intervals", "The brackets of two critical shocks do not overlap, but one of them has no uncertainty interval: the difference is not proven."),
    term(Kind::Word, "below the best", "below the best (%)", "By how much a value's worst case is lower than that of the best, per cent of the latter."),
    term(Kind::Word, "worst case at", "worst case at", "The point with the worst case of a value."),
    term(Kind::Word, "without answer", "without answer", "Number of points of a value whose critical shock is not known."),
    term(Kind::Word, "study", "study", "What a study file asks: a drive, its shocks, the axes to vary and how to search."),
    term(Kind::Word, "point", "point", "A combination of ramp model, pulse width, sign and values of the further axes: it has one critical shock."),
    term(Kind::Word, "axis", "axis", "A key of the study with a list of values."),
    term(Kind::Word, "scene", "scene", "All data of one simulation but its amplitude: drive, effects, discretisation, and the shock's shape, width and sign, in SI units."),
    term(Kind::Word, "structure", "structure", "Disk and ramp."),
    term(Kind::Word, "head", "head", "Slider, air film and suspension."),
    term(Kind::Word, "verdict", "verdict", "Whether the slider survives a simulated shock or fails it; undecided where the simulation ended before."),
    term(Kind::Word, "store", "store", "The folder that holds the results of a study; its journal has every finished simulation."),
    term(Kind::Word, "shard", "shard", "A share of the points of a study, computed by one of several processes that use one store."),
    term(Kind::Word, "worst case", "worst case", "The lowest critical shock of all points that share a value."),
    term(Kind::Word, "uncertainty interval", "uncertainty interval", "A_crit less and plus its numerical uncertainty: the exact answer of the study's model is expected in it. It does not have the error of the model itself."),
    term(Kind::Word, "beyond the uncertainty intervals", "beyond the uncertainty intervals", "Two critical shocks whose uncertainty intervals do not overlap differ significantly."),
    term(Kind::Word, "formal order", "formal order", "The power of the step with which a method's error falls in theory, 2 for most here. Where the errors fall slower the safety factor is 3."),
    term(Kind::Word, "refinement", "refinement", "Simulating anew with finer discretisation parameters, until the target uncertainty is met or search.max_refinements is reached."),
    term(Kind::Word, "refinement levels", "refinement levels", "Discretisation parameters of the answer that are finer than the study's resolution, with the number of steps."),
    term(Kind::Word, "half-width", "half-width (%)", "Half the width of the uncertainty interval, per cent of A_crit."),
    term(Kind::Word, "film work", "film work", "Solutions of the film times its cells: a measure of cost that does not depend on the machine."),
    term(Kind::Word, "head steps", "head steps", "Time steps of slider, film and suspension, which take nearly all of a sweep's time."),
];

/// Meanings of a word, by its name in files or as people read it, a line each; none for another word.
pub fn named(word: &str) -> Option<String> {
    let meant = TERMS
        .iter()
        .filter(|term| [term.name, term.shown].contains(&word));
    let mut texts: Vec<String> = meant
        .map(|term| format!("{word}: {}\n", term.text))
        .collect();
    texts.dedup();
    (!texts.is_empty()).then(|| texts.concat())
}

/// A word by kind and name.
pub fn find(kind: Kind, name: &str) -> Option<&'static Term> {
    TERMS
        .iter()
        .find(|term| term.kind == kind && term.name == name)
}

/// The columns that the legend of a table explains.
pub(super) fn legend_columns() -> impl Iterator<Item = &'static Term> {
    [
        "a_crit_g",
        "uncertainty_g",
        "half_min_height_g",
        "survived_g",
        "failed_g",
        "onset_g",
        "sign",
    ]
    .into_iter()
    .filter_map(|column| find(Kind::Column, column))
}

/// The meaning of a column of the table, by its name in files or as people read it; a further axis is itself.
pub fn of_column(name: &str) -> &'static str {
    let mut columns = TERMS.iter().filter(|term| term.kind == Kind::Column);
    let found = columns.find(|term| term.name == name || term.shown == name);
    found.map_or("Value of this key of the study.", |term| term.text)
}

/// The entry of a flag.
pub fn of_flag(flag: Flag) -> &'static Term {
    let kinds = [Kind::Reservation, Kind::Note];
    let found = kinds.into_iter().find_map(|kind| find(kind, flag.as_str()));
    // The test of completeness knows every flag.
    found.expect("an entry for every flag")
}

/// The entry of a status.
pub fn of_status(status: Status) -> &'static Term {
    find(Kind::Status, status.as_str()).expect("an entry for every status")
}

/// Whether the status or a flag of a row takes something from its answer.
pub fn is_reserved(point: &PointSummary) -> bool {
    let takes = |flag: &Flag| of_flag(*flag).kind == Kind::Reservation;
    point.status != Status::Ok || point.flags.iter().any(takes)
}

/// Status and flags of a row that take something from its answer, in words.
pub fn reservations(point: &PointSummary) -> Vec<&'static str> {
    let status = (point.status != Status::Ok).then(|| of_status(point.status));
    let flags = point.flags.iter().map(|flag| of_flag(*flag));
    let flags = flags.filter(|term| term.kind == Kind::Reservation);
    status
        .into_iter()
        .chain(flags)
        .map(|term| term.text)
        .collect()
}

/// The flags that rows have, each once.
pub fn flags_of(points: &[PointSummary]) -> Vec<&'static Term> {
    let has = |flag: &Flag| points.iter().any(|point| point.flags.contains(flag));
    let flags = Flag::ALL.into_iter().filter(has);
    flags.map(of_flag).collect()
}

/// Kinds with their headings, in the order of the reference.
pub const HEADINGS: [(Kind, &str); 8] = [
    (Kind::Column, "Columns"),
    (Kind::Status, "Status"),
    (
        Kind::Reservation,
        "Flags that take something from the answer",
    ),
    (Kind::Note, "Flags that say how the answer was found"),
    (
        Kind::Contribution,
        "Contributions to the uncertainty interval",
    ),
    (Kind::Sign, "Signs in plots"),
    (Kind::Section, "Sections of the report"),
    (Kind::Word, "Other words"),
];

/// The reference of all words as Markdown.
pub fn markdown() -> String {
    let mut text = String::from(
        "# Words of tables, plots and reports\n\n\
         Written by `opshock schema --terms`. Names in files (CSV, JSON, HDF5) stand beside what people read. The report \
         has the same texts on hover and in its legends.\n",
    );
    for (kind, heading) in HEADINGS {
        text.push_str(&format!(
            "\n## {heading}\n\n| word | in files | meaning |\n|---|---|---|\n"
        ));
        for term in TERMS.iter().filter(|term| term.kind == kind) {
            let file = match kind {
                Kind::Column
                | Kind::Status
                | Kind::Reservation
                | Kind::Note
                | Kind::Contribution => {
                    format!("`{}`", term.name)
                }
                Kind::Section | Kind::Sign | Kind::Word => String::new(),
            };
            text.push_str(&format!("| {} | {file} | {} |\n", term.shown, term.text));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::table::{AFTER_AXES, BEFORE_AXES, OF_PAGE};
    use crate::store::summary::CONTRIBUTIONS;

    #[test]
    fn every_column_flag_status_and_contribution_has_one_entry() {
        let entries = |kind: Kind, name: &str| {
            let all = TERMS.iter();
            all.filter(|term| term.kind == kind && term.name == name)
                .count()
        };
        let columns = || BEFORE_AXES.iter().chain(&AFTER_AXES).chain([&OF_PAGE]);
        for column in columns() {
            assert_eq!(entries(Kind::Column, column), 1, "{column}");
        }
        for flag in Flag::ALL {
            let word = flag.as_str();
            let found = entries(Kind::Reservation, word) + entries(Kind::Note, word);
            assert_eq!(found, 1, "{word}");
            assert_eq!(of_flag(flag).shown, word);
        }
        for status in Status::ALL {
            assert_eq!(entries(Kind::Status, status.as_str()), 1, "{status:?}");
        }
        for contribution in CONTRIBUTIONS {
            assert_eq!(
                entries(Kind::Contribution, contribution),
                1,
                "{contribution}"
            );
        }
        // And no entry is for something that is not there.
        for term in TERMS {
            let known = match term.kind {
                Kind::Column => columns().any(|column| *column == term.name),
                Kind::Reservation | Kind::Note => Flag::parse(term.name).is_some(),
                Kind::Status => Status::parse(term.name).is_some(),
                Kind::Contribution => CONTRIBUTIONS.contains(&term.name),
                Kind::Section | Kind::Sign | Kind::Word => true,
            };
            assert!(known, "{}", term.name);
            assert!(
                term.text.ends_with('.') && !term.text.contains('|'),
                "{}",
                term.name
            );
            assert!(HEADINGS.iter().any(|(kind, _)| *kind == term.kind));
        }
    }
}
