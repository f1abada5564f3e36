//! GOAL: blocks of soil that yields, shaken on a half-plane: the balance closes with the remainder of the laws.
//! SCENE: a block of `Quad8` of clay (Iwan) or sand (Drucker–Prager) that slides and uplifts or is bonded; few and many
//! elements.
//! REFERENCE: the identity of the energies, in which force, energies and remainder come from separate formulas.

use basemat::coupled::{EnergyBalance, State};
use basemat::fem::{Direction, DruckerPrager, Iwan, Material, Mesh, SharedMaterial};
use basemat::interface::Bonded;
use basemat::results::Run;
use basemat::structure::{Bilinear, FemModel, WithSprings};

use basemat_problems::scenes::{SI_UNITS, friction, scene};
use basemat_problems::yielding_blocks::grid_lines;

/// Block of `columns` × `rows` elements under two pulses, and the balance after each step.
///
/// With weight it slides and uplifts, without weight it is bonded.
fn shaken_block(
    material: impl Into<SharedMaterial>,
    [columns, rows]: [usize; 2],
    has_weight: bool,
) -> (Run, Vec<EnergyBalance>) {
    let material = material.into();
    let x_lines = grid_lines(-2.0, 4.0, columns);
    let y_lines = grid_lines(0.0, 5.0, rows);
    let mesh = Mesh::quad8_block(&x_lines, &y_lines, |_, _| material.clone()).unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    let mut builder = scene(SI_UNITS, 0.6).structure(model);
    builder = if has_weight {
        builder.interface(friction(0.7))
    } else {
        builder.gravity(0.0).interface(Bonded)
    };
    let mut balances = Vec::new();
    let mut simulation = builder.build().unwrap();
    let mut iterations = 0;
    let observe = |state: &State| {
        balances.push(state.energy_balance);
        iterations += state.trials;
    };
    let run = simulation.run(320, observe).unwrap();
    println!(
        "{columns} × {rows}: {:.2} trials a step, open by {:.1e}",
        iterations as f64 / 320.0,
        run.energy_error
    );
    println!("{}", run.energy_balance);
    (run, balances)
}

/// Checks the balance, and that the heat of the soil grows; with `is_associated` also the remainder.
fn assert_energies(run: &Run, balances: &[EnergyBalance], is_associated: bool) {
    let largest_energy = run.energy_balance.largest;
    assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
    assert!(run.energy_balance.algorithmic == 0.0);
    assert!(
        run.energy_balance.hysteresis > 0.02 * run.energy_balance.input,
        "{}",
        run.energy_balance
    );
    assert!(run.energy_balance.midstep_remainder.abs() > 1e-6 * largest_energy);
    for pair in balances.windows(2) {
        assert!(pair[1].hysteresis >= pair[0].hysteresis - 1e-13 * largest_energy);
        let remainder = pair[1].midstep_remainder - pair[0].midstep_remainder;
        assert!(!is_associated || remainder >= -1e-13 * largest_energy, "{remainder:e}");
    }
}

fn clay() -> Iwan {
    Iwan::hyperbolic(40e6, 90e3, 0.45, 0.45, 1900.0).unwrap()
}

fn sand(dilation_angle: f64) -> DruckerPrager {
    let elastic = Material::new(80e6, 0.3, 1900.0).unwrap();
    DruckerPrager::new(elastic, 20e3, 0.55, dilation_angle).unwrap()
}

/// A yielding damper between the top and the base of a block of clay that yields.
///
/// The balance then checks the remainder of the wrapped block, and the damper has no algorithmic work.
#[test]
fn springs_around_clay_close_the_balance() {
    let damped_block = || {
        let x = [-2.0, 0.0, 2.0];
        let mesh = Mesh::quad8_block(&x, &[0.0, 2.0, 4.0], |_, _| clay()).unwrap();
        let model = FemModel::on_base(mesh).unwrap();
        let row_at = |y: f64| {
            let node = model.mesh().node_at(0.0, y).unwrap();
            model.row(node, Direction::X).unwrap()
        };
        let drift = row_at(4.0) - row_at(0.0);
        let damper = Bilinear::new(5e6, 3e3, 0.0).unwrap();
        let block_with_damper = WithSprings::new(model).spring(drift, damper).unwrap();
        let builder =
            scene(SI_UNITS, 0.6).structure(block_with_damper).gravity(0.0).interface(Bonded);
        builder.build().unwrap()
    };
    let mut simulation = damped_block();
    let mut balances = Vec::new();
    let run = simulation.run(320, |state: &State| balances.push(state.energy_balance)).unwrap();
    println!("{}", run.energy_balance);
    assert_energies(&run, &balances, true);
    // Resumed in the middle, to the last bit.
    let mut first = damped_block();
    first.run(150, |_| {}).unwrap();
    let mut second = damped_block();
    second.resume(&first.checkpoint().unwrap()).unwrap();
    second.run(170, |_| {}).unwrap();
    assert_eq!(second.state().energy_balance, simulation.state().energy_balance);
}

#[test]
fn clay_closes_the_balance_with_few_and_many_elements() {
    for (columns, rows) in [(4, 5), (6, 10)] {
        let (run, balances) = shaken_block(clay(), [columns, rows], true);
        assert_energies(&run, &balances, true);
    }
}

#[test]
fn sand_closes_the_balance_with_any_dilation() {
    for (dilation_angle, columns, has_weight) in [(0.55, 4, true), (0.1, 4, false), (0.1, 7, false)]
    {
        let (run, balances) =
            shaken_block(sand(dilation_angle), [columns, 2 * columns], has_weight);
        assert_energies(&run, &balances, dilation_angle == 0.55);
    }
}
