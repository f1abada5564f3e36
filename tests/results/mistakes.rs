//! GOAL: numbers and steps that are probably mistakes cause warnings, and usual ones do not.

use basemat::bem::ElasticGround;
use basemat::coupled::{Mistake, Warning};
use basemat::fem::{Material, Mesh, Shell};
use basemat::interface::Cohesive;
use basemat::motion::FreeFieldFn;
use basemat::prelude::*;
use basemat::results::Run;
use basemat::structure::{CraigBampton, FemModel, MatrixModel, StructureGroup, Triplets};

fn soil() -> Soil {
    Soil::from_shear_wave_speed(250.0, 0.33, 1900.0).unwrap()
}

/// Five storeys, times a factor on masses and stiffness.
fn building(factor: f64) -> ShearBuilding {
    let storeys = [Storey::new(3.0, factor * 30.0e3, factor * 60.0e6); 5];
    let building = ShearBuilding::new(8.0, factor * 60.0e3, factor * 4.0e5, &storeys).unwrap();
    building.with_stiffness_damping(0.05).unwrap()
}

fn run(
    time_step: f64,
    structure: impl Structure + 'static,
    law: impl InterfaceLaw + 'static,
    motion: impl FreeField + 'static,
    duration: f64,
) -> Run {
    let mut simulation = Simulation::builder(time_step)
        .ground(ElasticGround::under(soil(), &structure, 12).unwrap())
        .structure(structure)
        .interface(law)
        .motion(motion)
        .build()
        .unwrap();
    let run = simulation.run(simulation.steps_for(duration), |_| {}).unwrap();
    for warning in &run.warnings {
        let line = format!("warning: {warning}");
        assert!(run.to_string().contains(&line) && line.chars().count() <= 100, "{line}");
    }
    run
}

fn coulomb() -> Coulomb {
    Coulomb::new(0.4).unwrap()
}

/// The first number that `read` finds in a run's warnings.
fn first_warning<T>(run: &Run, read_number: impl Fn(&Warning) -> Option<T>) -> Option<T> {
    run.warnings.iter().find_map(read_number)
}

/// Whether a run has a warning of this kind.
fn warns(run: &Run, is_kind: impl Fn(&Warning) -> bool) -> bool {
    run.warnings.iter().any(is_kind)
}

fn is_of_step(warning: &Warning) -> bool {
    matches!(
        warning,
        Warning::Mistake(Mistake::LongTimeStep { .. })
            | Warning::UnresolvedMotion { .. }
            | Warning::UnresolvedPeriod { .. }
    )
}

/// Reference: ω² = ∫ ȧ² dt / ∫ a² dt of the record's acceleration, which is linear between its samples.
#[test]
fn longer_steps_cause_no_fewer_warnings() {
    let record = el_centro_1940();
    let mut rates = 0.0;
    let mut squares = 0.0;
    for pair in record.accelerations().windows(2) {
        rates += (pair[1] - pair[0]).powi(2) / 0.02;
        squares += 0.02 * (pair[0].powi(2) + pair[0] * pair[1] + pair[1].powi(2)) / 3.0;
    }
    let mean_period = std::f64::consts::TAU * f64::sqrt(squares / rates);
    for step in [0.1, 0.2, 0.5, 1.0, 2.0, 4.0, 5.0, 10.0, 20.0, 40.0] {
        let record = run(step, building(1.0), coulomb(), el_centro_1940(), 32.0);
        assert!(warns(&record, is_of_step), "record, {step} s: {:?}", record.warnings);
        let long_step = first_warning(&record, |warning| match warning {
            Warning::Mistake(Mistake::LongTimeStep { period, interval, needed, .. }) => {
                Some([*period, *interval, *needed])
            }
            _ => None,
        });
        if let Some([period, interval, needed]) = long_step {
            assert!((period / mean_period - 1.0).abs() < 0.02, "{period} {mean_period}");
            assert_eq!(interval, 0.02);
            assert!(needed <= period / 14.9, "{needed}");
        }
        // A motion without a record is sampled.
        let wave = FreeFieldFn::new(|_: f64, time: f64| {
            [0.01 * (time * 12.0).sin() * (0.1 * time).sin(), 0.0]
        });
        let closure = run(step, building(1.0), coulomb(), wave, 120.0);
        let is_expected = step <= 0.1 || warns(&closure, is_of_step);
        assert!(is_expected, "closure, {step} s: {:?}", closure.warnings);
    }
    let fine = run(0.01, building(1.0), coulomb(), el_centro_1940(), 32.0);
    assert!(!warns(&fine, is_of_step), "{:?}", fine.warnings);
    // Few short steps, and few long steps of a slow motion, cause no warning.
    let short_run = run(0.01, building(1.0), coulomb(), el_centro_1940(), 0.05);
    assert!(!warns(&short_run, is_of_step), "{:?}", short_run.warnings);
    let creep = FreeFieldFn::new(|_, time| [1e-6 * time * time, 0.0]);
    let slow_run = run(1.0, building(1.0), coulomb(), creep, 5.0);
    assert!(!warns(&slow_run, is_of_step), "{:?}", slow_run.warnings);
}

fn is_heavy(warning: &Warning) -> bool {
    matches!(warning, Warning::Mistake(Mistake::HeavyStructure { .. }))
}

/// Reference: the weight by hand over 8 m, and G = ρ c² = 118.75 MPa.
#[test]
fn weights_beyond_the_resistance_of_soil_cause_a_warning() {
    for (factor, expected) in [(1.0, false), (5.0, false), (20.0, true), (100.0, true)] {
        let run = run(0.005, building(factor), coulomb(), el_centro_1940(), 0.1);
        assert_eq!(warns(&run, is_heavy), expected, "{factor}: {:?}", run.warnings);
        for warning in &run.warnings {
            if let Warning::Mistake(Mistake::HeavyStructure { pressure, shear_modulus }) = warning {
                let by_hand = factor * 210.0e3 * STANDARD_GRAVITY / 8.0;
                assert!((pressure / by_hand - 1.0).abs() < 1e-9);
                assert!((shear_modulus / 118.75e6 - 1.0).abs() < 1e-9);
            }
        }
    }
}

/// Matrices of a building with this vertical mass.
fn matrices(vertical: f64) -> MatrixModel {
    let masses = [50e3, vertical, 400e3, 20e3, 20e3, 20e3, 20e3, 20e3];
    let mass = Triplets::from_entries(8, masses.iter().enumerate().map(|(i, m)| (i, i, *m)));
    let mut stiffness = Triplets::new(8);
    for storey in 0..5 {
        let below = if storey == 0 { 0 } else { 2 + storey };
        let tilt = (2, 3.0);
        stiffness.add_outer([(3 + storey, 1.0), (below, -1.0), tilt], 40e6);
    }
    MatrixModel::new(mass, stiffness, BaseNode::rigid_base(-3.0, 3.0, [0, 1, 2])).unwrap()
}

/// Vertical and horizontal mass of the warning of unequal masses.
fn unequal_masses(vertical: f64) -> Option<[f64; 2]> {
    let run = run(0.005, matrices(vertical), coulomb(), el_centro_1940(), 0.1);
    first_warning(&run, |warning| match warning {
        Warning::Mistake(Mistake::UnequalMasses { vertical, horizontal }) => {
            Some([*vertical, *horizontal])
        }
        _ => None,
    })
}

#[test]
fn missing_vertical_mass_causes_a_warning() {
    assert_eq!(unequal_masses(150e3), None);
    let [vertical, horizontal] = unequal_masses(50e3).unwrap();
    assert!((vertical - 50e3).abs() < 1e-3 && (horizontal - 150e3).abs() < 1e-3);
    assert!(unequal_masses(300e3).is_some());
}

/// A raft of shells with sides of 6 m.
fn raft(density: f64, thickness: f64) -> FemModel {
    let concrete = Material::new(30e9, 0.2, density).unwrap();
    let mut mesh = Mesh::in_space();
    let grid = mesh
        .add_grid(4, 4, |row, column| [2.0 * column as f64, 2.0 * row as f64, 0.0])
        .unwrap();
    for (_, cell) in grid.cells() {
        mesh.add(Shell::new(cell, concrete, thickness).unwrap()).unwrap();
    }
    FemModel::on_base(mesh).unwrap()
}

fn shaken_raft(model: impl Structure + 'static) -> Run {
    let mut simulation = Simulation::builder(0.01)
        .ground(ElasticGround::under(soil(), &model, 4).unwrap())
        .structure(model)
        .interface(coulomb())
        .motion(el_centro_1940())
        .build()
        .unwrap();
    simulation.run(5, |_| {}).unwrap()
}

fn unusual_density(run: &Run) -> Option<f64> {
    first_warning(run, |warning| match warning {
        Warning::Mistake(Mistake::UnusualDensity { density }) => Some(*density),
        _ => None,
    })
}

#[test]
fn densities_of_no_material_cause_a_warning() {
    for density in [25.0, 2.5, 25_000.0] {
        assert_eq!(unusual_density(&shaken_raft(raft(density, 1.0))), Some(density));
    }
    for density in [450.0, 2500.0, 7850.0] {
        assert_eq!(unusual_density(&shaken_raft(raft(density, 1.0))), None, "{density}");
    }
    // One of two structures.
    let group = StructureGroup::new().with(raft(2500.0, 1.0), 0.0).unwrap();
    let group = group.with(raft(25.0, 1.0), 20.0).unwrap();
    assert_eq!(group.description().densities, Some([25.0, 2500.0]));
    // A raft one kilometre thick is recognised by its weight.
    let thick_raft = shaken_raft(raft(2500.0, 1000.0));
    assert!(warns(&thick_raft, is_heavy));
    // A reduced model has the description of its full model.
    let reduced_structure = CraigBampton::new(3).reduce(raft(25.0, 1.0)).unwrap();
    assert_eq!(reduced_structure.description().densities, Some([25.0; 2]));
}

/// Warnings of a ground motion.
#[derive(Debug, PartialEq)]
struct MotionWarnings {
    is_strong: bool,
    drift_velocity: Option<f64>,
}

fn motion_warnings(record: Record) -> MotionWarnings {
    let run = run(0.005, building(1.0), coulomb(), record, 0.2);
    MotionWarnings {
        is_strong: warns(&run, |warning| {
            matches!(warning, Warning::Mistake(Mistake::UnusualMotion { .. }))
        }),
        drift_velocity: first_warning(&run, |warning| match warning {
            Warning::Mistake(Mistake::DriftingRecord { velocity }) => Some(*velocity),
            _ => None,
        }),
    }
}

#[test]
fn motions_above_two_g_and_drifting_records_cause_warnings() {
    let record = el_centro_1940();
    let usual_warnings = MotionWarnings { is_strong: false, drift_velocity: None };
    assert_eq!(motion_warnings(record.clone()), usual_warnings);
    // 0.318 g times 6.2 is below 2 g; times 9.75 it is 3.1 g.
    assert!(!motion_warnings(record.scaled(6.2).unwrap()).is_strong);
    assert!(motion_warnings(record.scaled(9.75).unwrap()).is_strong);
    // A pulse of 1.3 Hz with the offset of a recorder, 0.0783 m/s² for 10 s.
    let mut samples = Vec::new();
    for k in 0..1000 {
        let time = 0.01 * f64::from(k);
        let pulse = 1.5 * (8.17 * time).sin() * (-((time - 4.0) / 2.0).powi(2)).exp();
        samples.push(pulse + 0.0783);
    }
    let offset = Record::new(0.01, samples).unwrap();
    let velocity = motion_warnings(offset.clone()).drift_velocity.unwrap();
    assert!((velocity - 0.0783 * 9.99).abs() < 0.02, "{velocity}");
    let corrected_record = offset.with_baseline(basemat::motion::Baseline::RemoveMean).unwrap();
    assert_eq!(motion_warnings(corrected_record).drift_velocity, None);
}

/// Strength and pressure of the warning of a weak bond.
fn weak_bond(tension: f64, cohesion: f64) -> Option<[f64; 2]> {
    let block = RigidBlock::new(6.0, 9.0, 1000.0).unwrap();
    let law = Cohesive::new(tension, cohesion, 0.4).unwrap();
    let run = run(0.005, block, law, el_centro_1940(), 0.1);
    first_warning(&run, |warning| match warning {
        Warning::Mistake(Mistake::WeakBond { strength, pressure }) => Some([*strength, *pressure]),
        _ => None,
    })
}

#[test]
fn strengths_in_kilopascals_cause_a_warning() {
    assert_eq!(weak_bond(0.0, 0.0), None);
    assert_eq!(weak_bond(50e3, 100e3), None);
    let [strength, pressure] = weak_bond(10.0, 20.0).unwrap();
    assert_eq!(strength, 10.0);
    assert!((pressure / (9.0 * 1000.0 * STANDARD_GRAVITY) - 1.0).abs() < 1e-9);
}
