//! Solves the linear complementarity problem of one or two contacts.
//!
//! ```text
//! 0 ≤ z ⟂ M z + q ≥ 0,    M symmetric positive semidefinite
//! ```
//!
//! M is singular when one point carries both contacts (a disk point held between two rigid arms):
//! then only the difference of the multipliers is determined, and the solution with at most one
//! of them non-zero is taken, which is the one of least sum.

/// Solves the problem for the contacts marked in `active`; the others get 0.
///
/// Returns `None` when there is no solution, which for a positive semidefinite M means q pushes
/// against a direction without compliance.
pub fn solve(m: [[f64; 2]; 2], q: [f64; 2], active: [bool; 2]) -> Option<[f64; 2]> {
    let single = |i: usize| {
        if !active[i] || q[i] >= 0.0 {
            Some(0.0)
        } else if m[i][i] > 0.0 {
            Some(-q[i] / m[i][i])
        } else {
            None
        }
    };
    let (z0, z1) = (single(0), single(1));
    if !(active[0] && active[1]) || (q[0] >= 0.0 && q[1] >= 0.0) {
        return Some([z0?, z1?]);
    }
    // One contact alone: the other must stay open. Slack for rounding of cancelling terms.
    let slack = |i: usize, z: f64| 1e-12 * (q[i].abs() + (m[0][1] * z).abs());
    let only0 = z0.filter(|&z| z > 0.0 && m[1][0] * z + q[1] >= -slack(1, z));
    let only1 = z1.filter(|&z| z > 0.0 && m[0][1] * z + q[0] >= -slack(0, z));
    match (only0, only1) {
        (Some(a), Some(b)) if a <= b => Some([a, 0.0]),
        (Some(_) | None, Some(b)) => Some([0.0, b]),
        (Some(a), None) => Some([a, 0.0]),
        (None, None) => {
            let det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
            if det <= 1e-14 * m[0][0] * m[1][1] {
                return None;
            }
            let z = [
                (m[0][1] * q[1] - m[1][1] * q[0]) / det,
                (m[1][0] * q[0] - m[0][0] * q[1]) / det,
            ];
            (z[0] >= 0.0 && z[1] >= 0.0).then_some(z)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn hard_b8_both_sides_of_one_point_give_the_net_force() {
        let w = [[3.0, -3.0], [-3.0, 3.0]];
        assert_eq!(solve(w, [-6.0, 6.0], [true; 2]), Some([2.0, 0.0]));
        assert_eq!(solve(w, [6.0, -6.0], [true; 2]), Some([0.0, 2.0]));
        assert_eq!(solve(w, [0.0, 0.0], [true; 2]), Some([0.0, 0.0]));
    }

    proptest! {
        #[test]
        fn the_answer_is_complementary_and_mirrors(
            disk in 0.1..10.0f64, top in 0.01..10.0f64, bottom in 0.01..10.0f64,
            q0 in -1.0..1.0f64, q1 in -1.0..1.0f64,
        ) {
            let m = [[disk + top, -disk], [-disk, disk + bottom]];
            let z = solve(m, [q0, q1], [true; 2]).unwrap();
            for i in 0..2 {
                let w = m[i][0] * z[0] + m[i][1] * z[1] + [q0, q1][i];
                prop_assert!(z[i] >= 0.0 && w >= -1e-10 && (w * z[i]).abs() < 1e-9);
            }
            let swapped = [[m[1][1], m[1][0]], [m[0][1], m[0][0]]];
            let mirrored = solve(swapped, [q1, q0], [true; 2]).unwrap();
            prop_assert_eq!([mirrored[1], mirrored[0]], z);
        }
    }
}
