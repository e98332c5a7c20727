//! Every hard case as a test: the checks that `opshock doctor --hard-cases` runs too.

use opshock_study::hard_cases::{CASES, Case};
use opshock_tests::digests::assert_digest;

fn named(id: &str) -> &'static Case {
    CASES.iter().find(|case| case.id == id).expect("a case")
}

/// A case that no method cures: ambient pressure solves a flat film's equations whatever the scheme.
const PROPERTIES: [&str; 1] = ["C8"];

/// Every figure within its bound; and the naive method, where there is one, beyond it, or the
/// check would not show what the method in use is for.
fn assert_holds(id: &str) {
    let case = named(id);
    let checks = case.run();
    let figures: Vec<f64> = checks.iter().map(|check| check.figure).collect();
    assert_digest(&format!("hard case {id}"), &figures);
    assert!(
        checks.iter().any(|check| check.naive.is_some()) || PROPERTIES.contains(&id),
        "{id}: no fault is shown"
    );
    for check in checks {
        assert!(
            check.holds(),
            "{id} {}: {}: {:e} > {:e}",
            case.name,
            check.what,
            check.figure,
            check.bound
        );
        if let Some(naive) = &check.naive {
            assert!(
                naive.figure > check.bound,
                "{id}: {}: {} has {:e} too",
                check.what,
                naive.method,
                naive.figure
            );
        }
    }
}

/// A test a case, named after it.
macro_rules! hard {
    ($($test:ident $id:literal),* $(,)?) => {
        $(#[test]
        fn $test() {
            assert_holds($id);
        })*

        #[test]
        fn every_case_has_its_test() {
            let tested = [$($id),*];
            let all: Vec<&str> = CASES.iter().map(|case| case.id).collect();
            assert_eq!(tested[..], all[..]);
            assert_eq!(all.len(), 78);
        }
    };
}

hard! {
    hard_a1_half_sine_exactly_at_resonance "A1",
    hard_a2_residual_vibration_null "A2",
    hard_a3_pulse_end_inside_a_step "A3",
    hard_a4_impulse_limit "A4",
    hard_a5_very_stiff_retained_mode "A5",
    hard_a6_a_million_free_steps "A6",
    hard_a7_travelling_wave_split "A7",
    hard_a8_at_the_critical_speed "A8",
    hard_a9_above_the_critical_speed_two_dampings "A9",
    hard_a10_only_n_0_without_contact "A10",
    hard_a11_annular_plate_frequencies "A11",
    hard_a12_extreme_radii "A12",
    hard_a13_mode_truncation "A13",
    hard_b1_sticking_ramp "B1",
    hard_b2_bouncing_oscillator_rigid_stop "B2",
    hard_b3_stiff_elastic_stop "B3",
    hard_b4_elastic_bar_thrown_at_a_wall "B4",
    hard_b5_grazing "B5",
    hard_b6_accumulating_impacts "B6",
    hard_b7_resting_contact "B7",
    hard_b8_both_ramps_at_once "B8",
    hard_b9_starts_touching_starts_overlapping "B9",
    hard_b10_plastic_hit_on_a_free_ramp_mass "B10",
    hard_b11_ramp_mass_ratio_series "B11",
    hard_b12_restitution_must_not_matter_in_the_limit "B12",
    hard_b13_several_impacts_inside_one_step "B13",
    hard_b14_honest_order_at_impacts "B14",
    hard_b15_drift_of_a_velocity_level_constraint "B15",
    hard_b16_yanked_contact "B16",
    hard_b17_positive_and_negative_shock "B17",
    hard_b18_no_ramp_needed "B18",
    hard_c1_exact_one_dimensional_slider "C1",
    hard_c2_huge_bearing_number "C2",
    hard_c3_etched_step "C3",
    hard_c4_linear_squeeze_film "C4",
    hard_c5_gap_to_zero "C5",
    hard_c6_negative_gap_inside_an_iteration "C6",
    hard_c7_suction "C7",
    hard_c8_flat_parallel_slider "C8",
    hard_c9_mirror_in_roll "C9",
    hard_c10_flow_from_the_other_side "C10",
    hard_c11_kinks_in_the_slip_table "C11",
    hard_c12_bad_first_attitude "C12",
    hard_c13_lift_off_and_return "C13",
    hard_d1_stiff_film_light_slider "D1",
    hard_d2_identical_residuals "D2",
    hard_d3_start_from_rest "D3",
    hard_d4_accelerator_stall "D4",
    hard_d5_iteration_cap "D5",
    hard_d6_mixed_units "D6",
    hard_d7_truly_one_way "D7",
    hard_e1_false_failure_at_start "E1",
    hard_e2_touch_between_steps "E2",
    hard_e3_corner_touch "E3",
    hard_e4_not_a_number_is_not_a_pass "E4",
    hard_e5_known_critical_shock "E5",
    hard_e6_nothing_to_find "E6",
    hard_e7_more_than_one_change_of_state "E7",
    hard_e8_threshold_noise "E8",
    hard_e9_late_failure "E9",
    hard_e10_zero_and_tiny_amplitude "E10",
    hard_f1_thread_count "F1",
    hard_f2_interrupted_uninterrupted "F2",
    hard_f3_order_of_points "F3",
    hard_f4_poisoned_neighbour "F4",
    hard_f5_denormals "F5",
    hard_g1_corner_of_a_pad_grazes "G1",
    hard_g2_slides_on_the_side_of_a_rail "G2",
    hard_g3_no_roughness "G3",
    hard_g4_very_stiff_asperities "G4",
    hard_g5_impact_that_yields "G5",
    hard_g6_cascade_of_bounces "G6",
    hard_g7_deep_overlap "G7",
    hard_g8_few_asperities_touch "G8",
    hard_g9_some_yield_some_do_not "G9",
    hard_g10_friction_of_a_skewed_slider "G10",
    hard_g11_flies_on_its_asperities "G11",
    hard_g12_dimple_opens_in_contact "G12",
}

/// The page of the hard cases has every case, under its name.
#[test]
fn every_case_is_on_its_page() {
    let page = std::fs::read_to_string("../docs/hard-cases.md").expect("the page");
    for case in CASES {
        let row = format!("| {} {} |", case.id, case.name);
        assert!(page.contains(&row), "{row}");
    }
}

/// Prints figures, bounds and naive figures of every case.
#[test]
#[ignore = "slow: prints what the tests above assert, about a minute"]
fn hard_slow_every_case_with_its_figures() {
    for case in CASES {
        for check in case.run() {
            let naive = check.naive.as_ref().map_or(String::new(), |naive| {
                format!("; {}: {:.3e}", naive.method, naive.figure)
            });
            println!(
                "{:<4} {:<5} {:.3e} <= {:.1e}  {}: {}{naive}",
                case.id,
                if check.holds() { "ok" } else { "WRONG" },
                check.figure,
                check.bound,
                case.name,
                check.what,
            );
        }
        assert_holds(case.id);
    }
}
