//! A specification with what was found of each requirement, and the answer in sentences.

use super::boundary::Boundary;
use crate::qualification::{PointVerdict, Requirement, RequirementVerdict, Spec, Verdict};
use crate::report::coordinates;
use crate::store::summary::{PointSummary, Status, Summary};

/// Undecided points that the answer names at most.
const LISTED: usize = 4;

/// A requirement with its verdict.
#[derive(Clone, Debug)]
pub struct Tested<'a> {
    /// The requirement.
    pub requirement: &'a Requirement,
    /// Critical shocks of its points.
    pub summary: &'a Summary,
    /// Verdicts on them.
    pub found: RequirementVerdict,
}

impl<'a> Tested<'a> {
    /// Verdicts of a table.
    pub fn of(requirement: &'a Requirement, summary: &'a Summary) -> Self {
        Self {
            requirement,
            summary,
            found: RequirementVerdict::of(summary, requirement.required_g()),
        }
    }

    /// Rows with their verdicts.
    pub fn rows(&self) -> impl Iterator<Item = (&'a PointSummary, &PointVerdict)> {
        self.summary.points.iter().zip(&self.found.points)
    }

    /// The row that decides, and its verdict.
    pub fn worst(&self) -> Option<(&'a PointSummary, &PointVerdict)> {
        let place = self.found.worst?;
        Some((&self.summary.points[place], &self.found.points[place]))
    }

    /// Points of a verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        let verdicts = self.found.points.iter();
        verdicts.filter(|point| point.verdict == verdict).count()
    }
}

/// A specification with the verdicts on all of its requirements.
#[derive(Clone, Debug)]
pub struct Qualified<'a> {
    /// Name of the study.
    pub study: &'a str,
    /// Its file, and the settings that the command line laid over it.
    pub drive: &'a str,
    /// Program that found the critical shocks.
    pub program: &'a str,
    /// The specification.
    pub spec: &'a Spec,
    /// Its requirements, in the file's order.
    pub tested: Vec<Tested<'a>>,
    /// Its damage boundary, where one is asked for.
    pub boundary: Option<Boundary>,
}

impl Qualified<'_> {
    /// The verdict of all requirements together.
    pub fn verdict(&self) -> Verdict {
        Verdict::of_all(self.tested.iter().map(|tested| tested.found.verdict))
    }

    /// Simulations behind the verdicts.
    pub fn runs(&self) -> u64 {
        let of_requirements = self.tested.iter().map(|one| one.summary.totals.runs);
        let of_boundary = self.boundary.iter().map(|boundary| boundary.runs);
        of_requirements.chain(of_boundary).sum()
    }

    /// The answer: verdict, how many points of which requirements, the point that decides, and where it is
    /// undecided what is open and why.
    pub fn sentences(&self) -> Vec<String> {
        let points: usize = self.tested.iter().map(|one| one.found.points.len()).sum();
        let of = |verdict| -> usize { self.tested.iter().map(|one| one.count(verdict)).sum() };
        let (fails, undecided) = (of(Verdict::Fails), of(Verdict::Undecided));
        let what = match self.verdict() {
            Verdict::Passes => format!(
                "every point survives, the numerical uncertainty included ({}, {})",
                counted(points, "point"),
                counted(self.tested.len(), "requirement")
            ),
            Verdict::Fails => format!(
                "{fails} of {} {} not survive, the numerical uncertainty included{}",
                counted(points, "point"),
                if fails == 1 { "does" } else { "do" },
                match undecided {
                    0 => String::new(),
                    _ => format!("; {undecided} more left undecided"),
                }
            ),
            Verdict::Undecided => {
                let is = if undecided == 1 { "is" } else { "are" };
                format!("{undecided} of {} {is} undecided", counted(points, "point"))
            }
        };
        let mut sentences = vec![format!(
            "{} {} \"{}\": {what}.",
            self.study,
            match self.verdict() {
                Verdict::Passes => "passes",
                Verdict::Fails => "fails",
                Verdict::Undecided => "neither passes nor fails",
            },
            self.spec.name
        )];
        let deciding = self
            .tested
            .iter()
            .filter_map(|one| Some((one, one.worst()?)));
        // By verdict, then by the lower end of the interval over what is required.
        let place = |(one, (_, at)): &(&Tested<'_>, (&PointSummary, &PointVerdict))| {
            let low_g = at.interval_g.map_or(0.0, |[low_g, _]| low_g);
            (at.verdict, low_g / one.requirement.required_g())
        };
        let lowest = deciding.min_by(|a, b| {
            let (a, b) = (place(a), place(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        if let Some((tested, (row, at))) = lowest {
            sentences.push(format!(
                "The point that decides is {} at \"{}\": a critical shock of {} where {:.1} G are required, a reserve of {}.",
                coordinates::name(tested.summary, row),
                tested.requirement.name,
                critical_words(row),
                tested.requirement.required_g(),
                reserve_words(row, at)
            ));
        }
        let bounds = self.tested.iter().flat_map(Tested::rows);
        let bounds = bounds.filter(|(row, at)| at.open.is_none() && row.uncertainty_g.is_none());
        match bounds.count() {
            0 => {}
            count => sentences.push(format!(
                "The verdict on {} rests on a bound of four times or a quarter of what is required, without an uncertainty interval.",
                counted(count, "point")
            )),
        }
        if self.verdict() == Verdict::Undecided {
            sentences.extend(self.undecided());
        }
        sentences
    }

    /// What is open and why, a sentence for each point, [`LISTED`] at most.
    fn undecided(&self) -> Vec<String> {
        let rows = self
            .tested
            .iter()
            .flat_map(|one| one.rows().map(move |row| (one, row)));
        let mut open: Vec<String> = rows
            .filter_map(|(tested, (row, at))| {
                Some(format!(
                    "Undecided at \"{}\", {}: {}.",
                    tested.requirement.name,
                    coordinates::name(tested.summary, row),
                    at.open?.words()
                ))
            })
            .collect();
        if open.len() > LISTED {
            let more = counted(open.len() - LISTED, "more point");
            open.truncate(LISTED);
            open.push(format!("Undecided at {more}."));
        }
        open
    }
}

/// `1 point`, `2 points`.
fn counted(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}

/// Critical shock with its uncertainty, or the bound that is known of it.
pub(in crate::report) fn critical_words(row: &PointSummary) -> String {
    let Some(known_g) = row.known_g() else {
        return "unknown".to_owned();
    };
    match (row.status, row.uncertainty_g) {
        (Status::Ok, Some(half_g)) => format!("{known_g:.1} +- {half_g:.1} G"),
        (Status::Ok, None) => format!("{known_g:.1} G"),
        (Status::BelowRange, _) => format!("less than {known_g:.1} G"),
        (Status::AboveRange, _) => format!("more than {known_g:.1} G"),
        (Status::Undecided | Status::Open, _) => "unknown".to_owned(),
    }
}

/// Reserve in G and in per cent of what is required, with the range of the interval, or its bound.
pub(in crate::report) fn reserve_words(row: &PointSummary, at: &PointVerdict) -> String {
    let (Some(reserve), Some(known_g)) = (at.reserve, row.known_g()) else {
        return "unknown".to_owned();
    };
    let bound = match row.status {
        Status::Ok => "",
        Status::BelowRange => "less than ",
        Status::AboveRange => "more than ",
        Status::Undecided | Status::Open => return "unknown".to_owned(),
    };
    let required_g = known_g / (1.0 + reserve);
    let range = row.uncertainty_g.map_or(String::new(), |half_g| {
        let [low, high] = [-half_g, half_g].map(|g| 100.0 * (reserve + g / required_g));
        format!(" ({low:+.1} to {high:+.1} %)")
    });
    let reserve_g = known_g - required_g;
    format!("{bound}{reserve_g:+.1} G, {:+.1} %{range}", 100.0 * reserve)
}
