//! GOAL: a short way gives the same as the long one, and refuses the same.
//! SCENE: soils from wave speeds, grounds under a structure, durations, sweeps, records, recorders.
//! REFERENCE: the same thing at full length.

use basemat::bem::Grading;
use basemat::prelude::*;
use basemat::sweep::CaseError;
use basemat::{Error, Result};
use basemat_problems::faults::is_unwritable;

const BAD: [f64; 4] = [0.0, -1.0, f64::NAN, f64::INFINITY];

fn soil() -> Soil {
    Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap()
}

fn block() -> RigidBlock {
    RigidBlock::new(6.0, 9.0, 1000.0).unwrap()
}

fn simulation() -> Simulation {
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

/// A base with foundations that end where they are told to.
struct Lines(Vec<Vec<f64>>);

impl Structure for Lines {
    fn dofs(&self) -> usize {
        2
    }
    fn base(&self) -> Base {
        let line = |line: &Vec<f64>| line.iter().map(|&x| BaseNode::free(x, 0, 1)).collect();
        Base::Lines(self.0.iter().map(line).collect())
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
    for bad in BAD {
        let fault = Soil::from_shear_wave_speed(bad, 0.3, 1900.0).unwrap_err();
        let Error::Input { quantity, .. } = fault else { panic!("{fault}") };
        assert_eq!(quantity, "shear wave speed of the soil");
    }
    assert!(Soil::from_shear_wave_speed(1e200, 0.3, 1900.0).is_err());
}

#[test]
fn strips_lie_under_foundations() {
    let ends = |ground: &ElasticGround| {
        ground.elements().iter().map(|e| [e.left(), e.right()]).collect::<Vec<_>>()
    };
    // Graded elements are projections of equal arcs, and the default.
    let arc = |k: i32| -3.0 * (std::f64::consts::PI * f64::from(k) / 8.0).cos();
    let equal = |k: i32| -3.0 + 0.75 * f64::from(k);
    let is_cut_at = |ground: ElasticGround, node: &dyn Fn(i32) -> f64| {
        let found = ends(&ground);
        assert_eq!(found.len(), 8);
        for (k, [left, right]) in (0..).zip(found) {
            assert!((left - node(k)).abs() < 1e-14 && (right - node(k + 1)).abs() < 1e-14);
        }
    };
    let on = |strips: &[Strip]| ElasticGround::new(soil(), strips).unwrap();
    is_cut_at(ElasticGround::under(soil(), &block(), 8).unwrap(), &arc);
    is_cut_at(on(&[Strip::graded(-3.0..3.0, 8).unwrap()]), &arc);
    is_cut_at(on(&Strip::under(&block(), 8, Grading::Uniform).unwrap()), &equal);
    is_cut_at(on(&[Strip::uniform(-3.0..3.0, 8).unwrap()]), &equal);
    assert_eq!(Grading::default(), Grading::Cosine);

    let several = Lines(vec![vec![0.0, 1.0, 2.0], vec![5.0, 7.0], vec![10.0, 11.0]]);
    let ground = on(&Strip::under(&several, 3, Grading::Uniform).unwrap());
    let strips = [0.0..2.0, 5.0..7.0, 10.0..11.0].map(|range| Strip::uniform(range, 3).unwrap());
    assert_eq!(ends(&ground), ends(&on(&strips)));

    let under = |lines: &[&[f64]], count| {
        let structure = Lines(lines.iter().map(|line| line.to_vec()).collect());
        ElasticGround::under(soil(), &structure, count).err().unwrap()
    };
    let two = [0.0, 1.0];
    assert!(matches!(under(&[], 3), Error::Size { found: 0, .. }));
    assert!(matches!(under(&[&[1.0]], 3), Error::Size { found: 1, .. }));
    assert!(matches!(under(&[&[-1.0], &two], 3), Error::Size { found: 1, .. }));
    assert!(matches!(under(&[&two, &[]], 3), Error::Size { found: 0, .. }));
    assert!(matches!(under(&[&two, &[2.0, 3.0]], 0), Error::Input { .. }));
    assert!(matches!(under(&[&[0.0, f64::NAN]], 3), Error::Input { .. }));
    assert!(matches!(under(&[&[1.0, 0.0]], 3), Error::Input { .. }));
}

#[test]
fn a_structure_has_weight_unless_told_otherwise() {
    let weight = STANDARD_GRAVITY * block().total_mass();
    assert!((simulation().state().normal_force / weight - 1.0).abs() < 1e-9);
}

#[test]
fn steps_of_a_duration() {
    let simulation = simulation();
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
    let found = Sweep::new(20).collect(|case| match case.index {
        7 => Err("seven"),
        index => Ok(3 * index),
    });
    let seven = Err(CaseError::Failed("seven"));
    let wanted: Vec<_> = (0..20).map(|k| if k == 7 { seven.clone() } else { Ok(3 * k) }).collect();
    assert_eq!(found, wanted);
}

#[test]
fn records_of_functions() {
    let ramp = Record::from_fn(0.25, 1.0, |t| 2.0 * t).unwrap();
    assert_eq!(ramp, Record::new(0.25, vec![0.0, 0.5, 1.0, 1.5, 2.0]).unwrap());
    for bad in BAD {
        assert!(Record::from_fn(bad, 1.0, |t| t).is_err(), "{bad}");
        assert!(Record::from_fn(0.1, bad, |t| t).is_err(), "{bad}");
    }
    assert!(matches!(Record::from_fn(1e-9, 1.0, |t| t), Err(Error::Memory(_))));
    let endless = Record::from_fn(0.1, 1.0, |t| 1.0 / (t - 0.5));
    assert!(matches!(endless, Err(Error::NotFinite { index: 5, .. })), "{endless:?}");
    assert!(matches!(
        Record::from_fn(1.0, 0.1, |t| t),
        Err(Error::Size { found: 1, needed: 2, .. })
    ));
}

#[test]
fn runs_and_histories_are_saved() -> Result<()> {
    let mut simulation = simulation();
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
    let nowhere = folder.join("run.csv/below_a_file.csv");
    assert!(is_unwritable(&time_series.csv().save(&nowhere)));
    assert!(is_unwritable(&comparison.csv().save(&nowhere)));
    Ok(())
}
