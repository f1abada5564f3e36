//! GOAL: short forms of the interface have the results and errors of the long ones.
//! SCENE: soils from wave speeds, grounds under a structure, durations, sweeps, records, recorders.
//! REFERENCE: the long forms.

use basemat::bem::Grading;
use basemat::prelude::*;
use basemat::sweep::CaseError;
use basemat::{Error, Result};
use basemat_problems::faults::is_unwritable;

const NOT_POSITIVE_FINITE: [f64; 4] = [0.0, -1.0, f64::NAN, f64::INFINITY];

fn soil() -> Soil {
    Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap()
}

fn block() -> RigidBlock {
    RigidBlock::new(6.0, 9.0, 1000.0).unwrap()
}

fn block_simulation() -> Simulation {
    let block = block();
    Simulation::builder(0.01)
        .ground(
            ElasticGround::new(soil(), Strip::under(&block, 8, Grading::Uniform).unwrap()).unwrap(),
        )
        .structure(block)
        .interface(Coulomb::new(0.5).unwrap())
        .motion(el_centro_1940())
        .build()
        .unwrap()
}

/// A base with nodes at these places, by foundation.
struct BaseLines(Vec<Vec<f64>>);

impl Structure for BaseLines {
    fn dofs(&self) -> usize {
        2
    }

    fn base(&self) -> Base {
        let mut lines = Vec::new();
        for places in &self.0 {
            lines.push(places.iter().map(|&x| BaseNode::free(x, 0, 1)).collect());
        }
        Base::Lines(lines)
    }

    fn mass(&self, _: &mut Triplets) -> Result<()> {
        Ok(())
    }

    fn stiffness(&self, _: &mut Triplets) -> Result<()> {
        Ok(())
    }
}

#[test]
fn soil_from_its_shear_wave_speed() {
    assert_eq!(soil(), Soil::new(1900.0 * 200.0 * 200.0, 0.3, 1900.0).unwrap());
    for speed in NOT_POSITIVE_FINITE {
        let error = Soil::from_shear_wave_speed(speed, 0.3, 1900.0).unwrap_err();
        let Error::Input { quantity, .. } = error else { panic!("{error}") };
        assert_eq!(quantity, "shear wave speed of the soil");
    }
    assert!(Soil::from_shear_wave_speed(1e200, 0.3, 1900.0).is_err());
}

fn ground_on(strips: &[Strip]) -> ElasticGround {
    ElasticGround::new(soil(), strips).unwrap()
}

/// Ends of all elements of a ground.
fn element_ends(ground: &ElasticGround) -> Vec<[f64; 2]> {
    ground.elements().iter().map(|element| [element.left(), element.right()]).collect()
}

/// Checks that eight elements lie between these nodes.
fn assert_nodes(ground: &ElasticGround, node: fn(i32) -> f64) {
    let ends = element_ends(ground);
    assert_eq!(ends.len(), 8);
    for (k, [left, right]) in (0..).zip(ends) {
        assert!((left - node(k)).abs() < 1e-14 && (right - node(k + 1)).abs() < 1e-14);
    }
}

#[test]
fn strips_lie_under_foundations() {
    // Graded elements are projections of equal arcs, and the default.
    fn graded_node(k: i32) -> f64 {
        -3.0 * (std::f64::consts::PI * f64::from(k) / 8.0).cos()
    }

    fn uniform_node(k: i32) -> f64 {
        -3.0 + 0.75 * f64::from(k)
    }

    assert_nodes(&ElasticGround::under(soil(), &block(), 8).unwrap(), graded_node);
    assert_nodes(&ground_on(&[Strip::graded(-3.0..3.0, 8).unwrap()]), graded_node);
    let uniform_strip = Strip::under(&block(), 8, Grading::Uniform).unwrap();
    assert_nodes(&ground_on(&uniform_strip), uniform_node);
    assert_nodes(&ground_on(&[Strip::uniform(-3.0..3.0, 8).unwrap()]), uniform_node);
    assert_eq!(Grading::default(), Grading::Cosine);

    let base_lines = BaseLines(vec![vec![0.0, 1.0, 2.0], vec![5.0, 7.0], vec![10.0, 11.0]]);
    let ground = ground_on(&Strip::under(&base_lines, 3, Grading::Uniform).unwrap());
    let strips = [0.0..2.0, 5.0..7.0, 10.0..11.0].map(|range| Strip::uniform(range, 3).unwrap());
    assert_eq!(element_ends(&ground), element_ends(&ground_on(&strips)));
}

/// Error of a ground under a base with these nodes.
fn error_under(lines: &[&[f64]], count: usize) -> Error {
    let structure = BaseLines(lines.iter().map(|line| line.to_vec()).collect());
    ElasticGround::under(soil(), &structure, count).err().unwrap()
}

#[test]
fn bases_without_length_have_no_ground() {
    let line = [0.0, 1.0];
    assert!(matches!(error_under(&[], 3), Error::Size { found: 0, .. }));
    assert!(matches!(error_under(&[&[1.0]], 3), Error::Size { found: 1, .. }));
    assert!(matches!(error_under(&[&[-1.0], &line], 3), Error::Size { found: 1, .. }));
    assert!(matches!(error_under(&[&line, &[]], 3), Error::Size { found: 0, .. }));
    assert!(matches!(error_under(&[&line, &[2.0, 3.0]], 0), Error::Input { .. }));
    assert!(matches!(error_under(&[&[0.0, f64::NAN]], 3), Error::Input { .. }));
    assert!(matches!(error_under(&[&[1.0, 0.0]], 3), Error::Input { .. }));
}

#[test]
fn a_structure_has_weight_by_default() {
    let weight = STANDARD_GRAVITY * block().total_mass();
    assert!((block_simulation().state().normal_force / weight - 1.0).abs() < 1e-9);
}

#[test]
fn steps_of_a_duration() {
    let simulation = block_simulation();
    for (duration, steps) in [
        (0.0, 0),
        (0.07, 7),
        (0.29, 29),
        (0.291, 30),
        (1e4, 1_000_000),
        (-1.0, 0),
        (f64::NAN, 0),
        (f64::INFINITY, usize::MAX),
    ] {
        assert_eq!(simulation.steps_for(duration), steps, "{duration}");
    }
}

#[test]
fn a_sweep_collects_in_order() {
    let results = Sweep::new(20).collect(|case| match case.index {
        7 => Err("seven"),
        index => Ok(3 * index),
    });
    assert_eq!(results.len(), 20);
    for (index, result) in results.into_iter().enumerate() {
        let expected = if index == 7 { Err(CaseError::Failed("seven")) } else { Ok(3 * index) };
        assert_eq!(result, expected);
    }
}

#[test]
fn records_of_functions() {
    let ramp = Record::from_fn(0.25, 1.0, |t| 2.0 * t).unwrap();
    assert_eq!(ramp, Record::new(0.25, vec![0.0, 0.5, 1.0, 1.5, 2.0]).unwrap());
    for value in NOT_POSITIVE_FINITE {
        assert!(Record::from_fn(value, 1.0, |t| t).is_err(), "{value}");
        assert!(Record::from_fn(0.1, value, |t| t).is_err(), "{value}");
    }
    assert!(matches!(Record::from_fn(1e-9, 1.0, |t| t), Err(Error::Memory(_))));
    let record = Record::from_fn(0.1, 1.0, |t| 1.0 / (t - 0.5));
    assert!(matches!(record, Err(Error::NotFinite { index: 5, .. })), "{record:?}");
    assert!(matches!(
        Record::from_fn(1.0, 0.1, |t| t),
        Err(Error::Size { found: 1, needed: 2, .. })
    ));
}

#[test]
fn runs_and_time_series_are_saved() -> Result<()> {
    let mut simulation = block_simulation();
    let mut time_series = Recorder::new().start(&simulation)?;
    let run = simulation.run(100, |state| time_series.record(state))?;
    assert_eq!(time_series.times().len(), 101);

    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("conveniences/new/one");
    let _ = std::fs::remove_dir_all(&folder);
    time_series.csv().save(folder.join("run.csv"))?;
    assert_eq!(std::fs::read_to_string(folder.join("run.csv")).unwrap(), *time_series.csv());
    let mut comparison = Comparison::default();
    comparison.add("only", run);
    comparison.csv().save(folder.join("cases.csv"))?;
    assert_eq!(std::fs::read_to_string(folder.join("cases.csv")).unwrap(), *comparison.csv());
    let below_a_file = folder.join("run.csv/below_a_file.csv");
    assert!(is_unwritable(&time_series.csv().save(&below_a_file)));
    assert!(is_unwritable(&comparison.csv().save(&below_a_file)));
    Ok(())
}
