//! Floor spectra of a square tower shaken along y, compared with those of the tower shaken along x.

use basemat::coupled::Probe;
use basemat::motion::{STANDARD_GRAVITY, Triaxial, el_centro_1940};
use basemat::results::{Comparison, Recorder, Run, TimeSeries, log_spaced};

use super::pictures::{on_springs, tower};

/// A tower that is shaken along one axis, with probes along it.
struct ShakenTower {
    time_series: TimeSeries,
    run: Run,
}

impl ShakenTower {
    fn along(axis: usize) -> Self {
        let tower = tower();
        let floor = tower.floor(2, [0.0; 2]).unwrap();
        let drift = tower.drift(0).unwrap();
        let shear = tower.shear(0).unwrap();
        let probes = vec![
            Probe::acceleration("roof", floor[axis].clone()),
            Probe::displacement("drift", drift[axis].clone()),
            Probe::section("shear", &shear[axis]),
            Probe::acceleration("other", floor[1 - axis].clone()),
        ];
        let record = Some(el_centro_1940().scaled(0.4).unwrap());
        let motion = match axis {
            0 => Triaxial { x: record, ..Triaxial::default() },
            _ => Triaxial { y: record, ..Triaxial::default() },
        };
        let mut simulation = on_springs(tower, motion, probes);
        let mut time_series = Recorder::new().start(&simulation).unwrap();
        let run = simulation.run(600, |state| time_series.record(state)).unwrap();
        Self { time_series, run }
    }
}

/// Magnitude in a column of a comparison.
fn column_magnitude(heading: &str, row: &str, column: &str) -> f64 {
    let index = heading.split(',').position(|name| name == column).expect(column);
    row.split(',').nth(index).unwrap().parse::<f64>().unwrap().abs()
}

/// A square tower that is shaken along y has the floor spectra, drifts and peaks along y of one that is shaken along x.
#[test]
fn floors_along_y_are_those_along_x() {
    let along_x = ShakenTower::along(0);
    let along_y = ShakenTower::along(1);
    let periods = log_spaced(0.1, 2.0, 15).unwrap();
    let spectrum_x = along_x.time_series.floor_spectrum("roof", &periods, 0.05).unwrap();
    let spectrum_y = along_y.time_series.floor_spectrum("roof", &periods, 0.05).unwrap();
    for (x, y) in spectrum_x.iter().zip(&spectrum_y) {
        assert!(x.acceleration > 0.02 * STANDARD_GRAVITY);
        assert!((x.acceleration / y.acceleration - 1.0).abs() < 1e-6);
    }
    for name in ["drift", "shear"] {
        let x = along_x.run.probe(name).unwrap().magnitude();
        let y = along_y.run.probe(name).unwrap().magnitude();
        assert!(x > 0.0 && (x / y - 1.0).abs() < 1e-6, "{name} {x} {y}");
    }
    assert!(along_y.run.probe("other").unwrap().magnitude() < 1e-6);
    let comparison = Comparison::from_iter([("x", along_x.run), ("y", along_y.run)]);
    let csv = comparison.csv().to_string();
    let lines: Vec<&str> = csv.lines().collect();
    for (column_along_x, column_along_y) in [
        ("base_shear_n", "shear_across_n"),
        ("base_moment_n_m", "moment_across_n_m"),
        ("mean_slip_m", "mean_slip_across_m"),
        ("base_rotation_rad", "rotation_across_rad"),
        ("overturning_safety", "overturning_safety_across"),
        ("residual_slip_m", "residual_slip_across_m"),
    ] {
        let x = column_magnitude(lines[0], lines[1], column_along_x);
        let y = column_magnitude(lines[0], lines[2], column_along_y);
        assert!(x > 0.0 && (x / y - 1.0).abs() < 1e-6, "{column_along_x}: {x} {y}");
    }
}
