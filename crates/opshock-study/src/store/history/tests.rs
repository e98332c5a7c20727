use super::*;
use crate::search::Sign;
use crate::store::summary::AxisValue;
use opshock_solver::simulation::History;
use opshock_solver::simulation::{HeadColumns, Mechanism, StructureColumns};

/// Structure at 0, 1, 2, 3 us; head at 0, 1.5, 2.5 us, where it touches.
fn history() -> History {
    let time_s = vec![0.0, 1e-6, 2e-6, 3e-6];
    let zero = vec![0.0; 4];
    History {
        structure: StructureColumns {
            time_s,
            shock_m_per_s2: vec![0.0, 1.0, 2.0, 3.0],
            disk_slider_m: zero.clone(),
            disk_ramp_m: zero.clone(),
            disk_rim_m: zero.clone(),
            disk_pitch_rad: zero.clone(),
            disk_roll_rad: zero.clone(),
            ramp_top_m: zero.clone(),
            ramp_bottom_m: zero.clone(),
            contact_top_n: zero.clone(),
            contact_bottom_n: zero.clone(),
            energy_j: zero.clone(),
            energy_h_j: zero,
            ..StructureColumns::default()
        },
        head: HeadColumns {
            time_s: vec![0.0, 1.5e-6, 2.5e-6],
            slider_z_m: vec![0.0, 3e-9, 1e-9],
            slider_pitch_rad: vec![1e-4; 3],
            slider_roll_rad: vec![0.0; 3],
            min_clearance_m: vec![9e-9, 4e-9, 0.0],
            bearing_force_n: vec![0.02; 3],
            bearing_pitch_n_m: vec![1e-9; 3],
            bearing_roll_n_m: vec![0.0; 3],
            dimple_force_n: vec![0.02, 0.01, 0.0],
            ..HeadColumns::default()
        },
        fields: None,
    }
}

fn header() -> HistoryHeader {
    HistoryHeader {
        study: "a study".into(),
        digest: "d1gest".into(),
        program_version: "0.1.0".into(),
        commit: "abc".into(),
        ramp: "rigid".into(),
        pulse_ms: 0.5,
        sign: Sign::Plus,
        axes: vec![
            ("clearance_um".into(), AxisValue::Number(80.0)),
            ("head".into(), AxisValue::Text("0 up".into())),
        ],
        amplitude_g: 400.0,
        start_s: 5e-4,
        verdict: "fails".into(),
        t_fail_s: Some(5.025e-4),
        mechanism: Some(Mechanism::RampImpact),
        effects: vec!["disk".into(), "ramp.rigid".into()],
        run: String::new(),
    }
}

#[test]
fn resampling_is_linear_inside_and_absent_outside() {
    let values = super::columns::resampled(
        &[1.0, 2.0, 4.0],
        &[10.0, 20.0, 0.0],
        &[0.5, 1.0, 1.5, 3.0, 4.0, 4.1],
    );
    assert!(values[0].is_nan() && values[5].is_nan());
    assert_eq!(&values[1..5], &[10.0, 15.0, 10.0, 0.0]);
}

#[test]
fn hdf5_carries_both_time_axes_units_and_provenance() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    write_hdf5(&path, &history(), &header()).unwrap();

    let file = hdf5::File::open(&path).unwrap();
    let column = |name: &str| file.dataset(name).unwrap().read_raw::<f64>().unwrap();
    let text = |at: &hdf5::Location, name: &str| {
        let attribute = at.attr(name).unwrap();
        attribute
            .read_scalar::<hdf5::types::VarLenUnicode>()
            .unwrap()
            .to_string()
    };
    let root = file.as_group().unwrap();
    assert_eq!(text(&root, "format"), "opshock history");
    assert_eq!(text(&root, "study_digest"), "d1gest");
    assert_eq!(text(&root, "point_ramp"), "rigid");
    assert_eq!(text(&root, "effects"), "disk ramp.rigid");
    for (name, value) in [("point_pulse_ms", 0.5), ("point_clearance_um", 80.0)] {
        let found: f64 = root.attr(name).unwrap().read_scalar().unwrap();
        assert_eq!(found, value, "{name}");
    }
    let read = parse(&path, &std::fs::read(&path).unwrap()).unwrap();
    assert_eq!(read.point["pulse_ms"], "0.5");
    assert_eq!(read.point["head"], "0 up");
    assert!(text(&root, "description").starts_with("one shock over time"));

    let time = column("time_s");
    assert_eq!(time, [5e-4, 5e-4 + 1e-6, 5e-4 + 2e-6, 5e-4 + 3e-6]);
    assert_eq!(column("head/time_s"), [5e-4, 5e-4 + 1.5e-6, 5e-4 + 2.5e-6]);
    assert_eq!(column("head/min_clearance_m"), [9e-9, 4e-9, 0.0]);
    let clearance = column("min_clearance_m");
    assert!(
        (clearance[2] - 2e-9).abs() < 1e-15,
        "half way from 4 to 0 nm"
    );
    assert!(clearance[3].is_nan(), "the head ended at touch");

    for name in root
        .member_names()
        .unwrap()
        .iter()
        .filter(|name| *name != "head")
    {
        let dataset = file.dataset(name).unwrap();
        assert_eq!(dataset.size(), 4, "{name}");
        assert!(!text(&dataset, "units").is_empty(), "{name}");
        assert_eq!(text(&dataset, "time"), "/time_s", "{name}");
    }
    for dataset in file.group("head").unwrap().datasets().unwrap() {
        assert!(!text(&dataset, "units").is_empty());
        assert_eq!(text(&dataset, "time"), "/head/time_s");
    }
}

#[test]
fn csv_is_one_table_with_empty_cells_after_touch() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    write_csv(&path, &history(), 5e-4).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 5);
    assert_eq!(rows[0][0], "time_s");
    let at = rows[0]
        .iter()
        .position(|name| *name == "min_clearance_m")
        .unwrap();
    assert!(rows.iter().all(|row| row.len() == rows[0].len()));
    assert_eq!(rows[1][at].parse::<f64>().unwrap(), 9e-9);
    assert_eq!(rows[4][at], "");
    assert_eq!(rows[4][1].parse::<f64>().unwrap(), 3.0);
}

#[test]
fn a_folder_that_is_missing_is_an_error_with_the_path() {
    let error = write_csv(
        std::path::Path::new("/nonexistent/run.csv"),
        &history(),
        0.0,
    )
    .unwrap_err();
    assert!(error.to_string().contains("/nonexistent/run.csv"));
}
