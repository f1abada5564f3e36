//! GOAL: frames of fibres in space that may lift off their ground: linear limit, energy, independence of the direction.
//! SCENE: a table on four columns on a mat in plan, or on a fixed base, shaken along both axes.
//! REFERENCE: the same table of linear beams; balance of energy; the table turned about the vertical.

use basemat::bem::SpringGround;
use basemat::coupled::{Probe, SimulationBuilder};
use basemat::fem::{
    BeamFormulation, BeamSection, Concrete, Direction, FiberSection, Material, MenegottoPinto,
};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw, Mode};
use basemat::{Result, Simulation};
use basemat_problems::fiber_tables::{FiberTable, TableColumns, turned};

const ALL_FORMULATIONS: [BeamFormulation; 2] =
    [BeamFormulation::DisplacementBased, BeamFormulation::ForceBased];
/// Directions of the probes at one corner of the plate.
const PROBED_DIRECTIONS: [Direction; 4] =
    [Direction::X, Direction::Y, Direction::Z, Direction::RotationZ];

/// Results of a run.
struct ShakenTable {
    /// Displacements along the axes of the table, and the rotation about the vertical, of all steps.
    motion: Vec<[f64; 4]>,
    energy_error: f64,
    /// Plastic work over the energy input.
    hysteresis: f64,
    /// Steps with an open cell, and with one that slides.
    open_steps: usize,
    sliding_steps: usize,
}

/// The table with probes on springs in plan, with P–Δ.
fn scene(
    table: &FiberTable,
    factor: f64,
    law: impl InterfaceLaw + 'static,
) -> Result<SimulationBuilder> {
    let table_model = table.model()?;
    let model = table_model.model.with_p_delta(9.81)?;
    let ground = SpringGround::under(&model, 8, 6.0e7, 5.0e7)?.with_dashpots(2.0e5, 2.0e5)?;
    let mut builder = Simulation::builder(0.005).ground(ground);
    for direction in PROBED_DIRECTIONS {
        let row = model.row(table_model.tops[1], direction)?;
        builder = builder.probe(Probe::displacement(format!("{direction:?}"), row));
    }
    Ok(builder.structure(model).interface(law).motion(table.motion(factor)?))
}

fn shaken(table: &FiberTable, builder: SimulationBuilder, steps: usize) -> Result<ShakenTable> {
    let mut simulation = builder.build()?;
    let mut motion = Vec::new();
    let mut open_steps = 0;
    let mut sliding_steps = 0;
    let run = simulation.run(steps, |state| {
        let horizontal = turned(-table.angle, [state.probes[0], state.probes[1]]);
        motion.push([horizontal[0], horizontal[1], state.probes[2], state.probes[3]]);
        open_steps += usize::from(state.modes.contains(&Mode::Open));
        sliding_steps += usize::from(state.modes.contains(&Mode::Slip));
    })?;
    let balance = run.energy_balance;
    Ok(ShakenTable {
        motion,
        energy_error: run.energy_error,
        hysteresis: balance.hysteresis / balance.input,
        open_steps,
        sliding_steps,
    })
}

/// Largest difference of two motions, relative to the peak of each component.
fn difference(a: &[[f64; 4]], b: &[[f64; 4]]) -> f64 {
    assert_eq!(a.len(), b.len());
    let mut max_error = 0.0_f64;
    for component in 0..4 {
        let peak = a.iter().fold(0.0_f64, |max, values| max.max(values[component].abs()));
        for (x, y) in a.iter().zip(b) {
            let error = (x[component] - y[component]).abs() / peak;
            max_error = if error.is_nan() { f64::NAN } else { max_error.max(error) };
        }
    }
    max_error
}

/// Elastic fibres move as linear beams of their area, second moments and torsion, over 1000 steps.
#[test]
fn a_table_of_elastic_fibres_is_the_linear_table() {
    let area = 0.12 * 0.1;
    let material = Material::new(210.0e9, 0.3, 100.0 / area).unwrap();
    let torsion_constant = 2.0e-5;
    // Σ A s² of n fibres along a side h is A h² (1 − 1/n²)/12.
    let second_moment = |side: f64, n: f64| area * side * side * (1.0 - 1.0 / (n * n)) / 12.0;
    let second_moments = [second_moment(0.1, 5.0), second_moment(0.12, 7.0)];
    let section = BeamSection::new(area, second_moments, torsion_constant).unwrap();
    let columns = TableColumns::Linear { material, section };
    let linear_columns = FiberTable { columns, parts: vec![0.4, 0.6], angle: 0.3 };
    let expected =
        shaken(&linear_columns, scene(&linear_columns, 0.5, Bonded).unwrap(), 1000).unwrap();
    let section = FiberSection::new()
        .with_rectangle([[-0.06, -0.05], [0.06, 0.05]], [7, 5], material)
        .unwrap()
        .with_torsional_stiffness(210.0e9 / 2.6 * torsion_constant)
        .unwrap();
    for formulation in ALL_FORMULATIONS {
        let columns = TableColumns::Fibers { section: section.clone(), formulation };
        let fibers = FiberTable { columns, ..linear_columns.clone() };
        let computed = shaken(&fibers, scene(&fibers, 0.5, Bonded).unwrap(), 1000).unwrap();
        let error = difference(&expected.motion, &computed.motion);
        println!("{formulation:?}: {error:.1e}; energy open by {:.1e}", computed.energy_error);
        assert!(error < 1e-9, "{formulation:?}: {error:e}");
        assert!(computed.energy_error < 1e-9, "{formulation:?}: {:e}", computed.energy_error);
    }
}

/// Columns of steel and of reinforced concrete yield on a mat that lifts off and slides.
#[test]
fn tables_that_yield_and_lift_off_close_the_energy() {
    let concrete = Concrete::new(30.0e6, 0.002, 12.0e6, 0.01).unwrap();
    let bars = MenegottoPinto::new(500.0e6, 200.0e9, 0.01).unwrap();
    let reinforced = FiberSection::new()
        .with_rectangle([[-0.15, -0.125], [0.15, 0.125]], [8, 6], concrete)
        .and_then(|section| section.with_bars([[-0.11, -0.09], [-0.11, 0.09]], 3, 3.1e-4, bars))
        .and_then(|section| section.with_bars([[0.11, -0.09], [0.11, 0.09]], 3, 3.1e-4, bars))
        .and_then(|section| section.with_torsional_stiffness(5.0e6))
        .unwrap();
    for formulation in ALL_FORMULATIONS {
        let steel = FiberTable::of_steel(formulation).unwrap();
        let columns = TableColumns::Fibers { section: reinforced.clone(), formulation };
        let concrete = FiberTable { columns, ..steel.clone() };
        for (name, table) in [("steel", steel), ("concrete", concrete)] {
            let law = Coulomb::new(0.6).unwrap();
            let run = shaken(&table, scene(&table, 1.5, law).unwrap(), 500).unwrap();
            let ShakenTable { energy_error, hysteresis, open_steps, sliding_steps, .. } = run;
            println!(
                "{name}, {formulation:?}: energy open by {energy_error:.1e}, hysteresis {hysteresis:.2}, open in \
                 {open_steps} steps, sliding in {sliding_steps}"
            );
            assert!(energy_error < 1e-9, "{name}, {formulation:?}: {energy_error:e}");
            assert!(hysteresis > 0.02, "{name}, {formulation:?}: {hysteresis}");
            assert!(open_steps > 20 && sliding_steps > 20, "{name}, {formulation:?}");
        }
    }
}

/// A table on a fixed base that yields moves the same at any angle about the vertical.
#[test]
fn a_table_turned_about_the_vertical_is_the_same() {
    for formulation in ALL_FORMULATIONS {
        let table = FiberTable::of_steel(formulation).unwrap();
        let angle = std::f64::consts::FRAC_PI_6;
        let runs = [0.0, angle].map(|angle| {
            let table = FiberTable { angle, ..table.clone() };
            let builder = scene(&table, 2.0, Bonded).unwrap().on_fixed_base();
            shaken(&table, builder, 400).unwrap()
        });
        let error = difference(&runs[0].motion, &runs[1].motion);
        let hysteresis = runs[1].hysteresis;
        println!("{formulation:?}: {error:.1e}, hysteresis {hysteresis:.2}");
        assert!(hysteresis > 0.1, "{hysteresis}");
        assert!(error < 1e-8, "{formulation:?}: {error:e}");
    }
}

/// A table on cells that open and slide moves the same after a quarter turn, which maps the cells on each other.
#[test]
fn a_quarter_turn_on_uplifting_ground_changes_nothing() {
    let table = FiberTable::of_steel(BeamFormulation::ForceBased).unwrap();
    let runs = [0.0, std::f64::consts::FRAC_PI_2].map(|angle| {
        let table = FiberTable { angle, ..table.clone() };
        let law = Coulomb::new(0.6).unwrap();
        shaken(&table, scene(&table, 1.5, law).unwrap(), 300).unwrap()
    });
    let error = difference(&runs[0].motion, &runs[1].motion);
    let open_steps = runs[1].open_steps;
    println!("{error:.1e}, open in {open_steps} steps");
    assert!(open_steps > 10, "{open_steps}");
    assert!(error < 1e-6, "{error:e}");
}
