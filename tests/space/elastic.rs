//! Welded bodies on cells of elastic ground.

use basemat::bem::{ElasticGround, Ground};
use basemat::interface::Bonded;
use basemat::motion::FreeField;
use basemat::soil::SoilProfile;
use basemat::structure::RigidBody;
use basemat::{Simulation, Soil};
use basemat_problems::profiles::{gmb, p1};

/// Ricker's wavelet from straight below, of amplitude 1.
struct VerticalRicker;

impl FreeField for VerticalRicker {
    fn displacement(&self, _: f64, time: f64) -> [f64; 2] {
        let u = (std::f64::consts::PI * 0.3 * (time - 5.0)).powi(2);
        [(1.0 - 2.0 * u) * (-u).exp(), 0.0]
    }
}

/// Horizontal motion and rotation about y of a cube's base at every `interval`-th step.
fn march(profile: SoilProfile, time_step: f64, interval: usize) -> [Vec<f64>; 2] {
    let cube = RigidBody::cuboid([2.0; 3], 1.0).unwrap();
    let ground = ElasticGround::under(profile, &cube, 8).unwrap();
    assert_eq!(ground.elements().len(), 64);
    let simulation = Simulation::builder(time_step).structure(cube).ground(ground);
    let mut simulation = simulation.interface(Bonded).motion(VerticalRicker).build().unwrap();
    let steps = simulation.steps_for(40.0);
    let mut series = [vec![], vec![]];
    let mut count = 0;
    let run = simulation.run(steps, |state| {
        count += 1;
        // The factors of W solve once.
        assert_eq!(state.trials, 1);
        if count % interval == 0 {
            let u = state.absolute_displacement();
            // The table's z points down.
            series[0].push(u[0]);
            series[1].push(-u[4]);
            assert!(u[1].abs().max(u[3].abs()).max(u[5].abs()) < 1e-12, "{u:?}");
        }
    });
    assert!(run.unwrap().energy_error < 1e-9);
    series
}

/// Root of the summed squares of the difference, relative to that of the expected values.
fn relative_error(computed: &[f64], expected: impl Iterator<Item = f64>) -> f64 {
    let mut error_square = 0.0;
    let mut expected_square = 0.0;
    for (computed, expected) in computed.iter().zip(expected) {
        error_square += (computed - expected) * (computed - expected);
        expected_square += expected * expected;
    }
    f64::sqrt(error_square / expected_square)
}

/// Errors of a run's motion and rotation against the rows of a table.
fn errors(profile: &SoilProfile, rows: &[Vec<f64>], time_step: f64, interval: usize) -> [f64; 2] {
    let computed = march(profile.clone(), time_step, interval);
    [0, 1].map(|column| {
        // A row of the table is a tenth of a second.
        let expected = rows[4..].iter().step_by(4).map(|row| row[column + 1]);
        relative_error(&computed[column], expected)
    })
}

/// `march_cube_*.csv`: the same cells in the frequency domain. Errors are of second order in the step.
#[test]
fn cubes_follow_the_tables() {
    let half_space = SoilProfile::from(Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap());
    let tables = [
        (half_space, include_str!("../data/plan/march_cube_half_space.csv")),
        (p1(gmb(5), gmb(1)), include_str!("../data/plan/march_cube_layer_on_rock.csv")),
    ];
    for (profile, table) in tables {
        let rows: Vec<Vec<f64>> = table
            .lines()
            .skip(1)
            .map(|line| line.split(',').map(|number| number.parse().unwrap()).collect())
            .collect();
        let errors = [
            errors(&profile, &rows, 0.4, 1),
            errors(&profile, &rows, 0.2, 2),
            errors(&profile, &rows, 0.1, 4),
        ];
        println!("{errors:?}");
        for ([base, rotation], limit) in errors.into_iter().zip([7.7e-2, 2.0e-2, 5.0e-3]) {
            assert!(base.max(rotation) < 1.1 * limit, "{errors:?}");
        }
        for column in [0, 1] {
            let order = (errors[1][column] / errors[2][column]).log2();
            assert!((order - 2.0).abs() < 0.15, "{order}");
        }
    }
}
