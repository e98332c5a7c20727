//! Verdicts as JUnit XML, which pipelines show: a suite for each requirement, a case for each point. A point that fails is
//! a failure, one that is undecided an error.

use std::fmt::Write as _;

use super::answer::{Qualified, critical_words, reserve_words};
use crate::qualification::Verdict;
use crate::report::coordinates;
use crate::report::html::text::escaped;

/// The file.
pub fn junit(qualified: &Qualified<'_>) -> String {
    let of = |verdict| -> usize { qualified.tested.iter().map(|one| one.count(verdict)).sum() };
    let points: usize = qualified
        .tested
        .iter()
        .map(|one| one.found.points.len())
        .sum();
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <testsuites name=\"{}\" tests=\"{points}\" failures=\"{}\" errors=\"{}\">\n",
        escaped(&format!("{}, {}", qualified.study, qualified.spec.name)),
        of(Verdict::Fails),
        of(Verdict::Undecided)
    );
    for tested in &qualified.tested {
        let suite = escaped(&tested.requirement.name);
        let _ = writeln!(
            text,
            "  <testsuite name=\"{suite}\" tests=\"{}\" failures=\"{}\" errors=\"{}\">",
            tested.found.points.len(),
            tested.count(Verdict::Fails),
            tested.count(Verdict::Undecided)
        );
        for (row, at) in tested.rows() {
            let case = escaped(&coordinates::name(tested.summary, row));
            let _ = write!(text, "    <testcase classname=\"{suite}\" name=\"{case}\"");
            let (tag, why) = match at.verdict {
                Verdict::Passes => {
                    text.push_str("/>\n");
                    continue;
                }
                Verdict::Fails => ("failure", String::new()),
                Verdict::Undecided => (
                    "error",
                    at.open
                        .map_or(String::new(), |open| format!("{}: ", open.words())),
                ),
            };
            let message = format!(
                "{why}critical shock {}, required {:.1} G, reserve {}",
                critical_words(row),
                tested.requirement.required_g(),
                reserve_words(row, at)
            );
            let _ = writeln!(
                text,
                ">\n      <{tag} type=\"{}\" message=\"{}\"/>\n    </testcase>",
                at.verdict.as_str(),
                escaped(&message)
            );
        }
        text.push_str("  </testsuite>\n");
    }
    text + "</testsuites>\n"
}
