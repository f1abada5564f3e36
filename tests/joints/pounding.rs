//! Two towers that strike each other across an expansion joint.

use basemat::bem::ElasticGround;
use basemat::coupled::{DissipativeMidpoint, Joint, Probe};
use basemat::interface::{Coulomb, Mode};
use basemat::motion::el_centro_1940;
use basemat::structure::{RigidBlock, StructureGroup};
use basemat::{Result, Simulation, Soil};

const JOINT_GAP: f64 = 0.02;
const TIME_STEP: f64 = 0.002;
const TOWER_DENSITIES: [f64; 2] = [400.0, 250.0];

/// REFERENCE: momentum of both towers, their distance from the degrees of freedom, the energy balance.
#[test]
fn towers_strike_each_other_across_a_gap() -> Result<()> {
    let towers = [
        RigidBlock::new(4.0, 16.0, TOWER_DENSITIES[0])?,
        RigidBlock::new(4.0, 20.0, TOWER_DENSITIES[1])?,
    ];
    let masses = towers.each_ref().map(RigidBlock::total_mass);
    let heights = [8.0, 10.0];
    let ends = [12.0, 16.0];
    let right_side = towers[0].contact_nodes(&ends.map(|z| [2.0, z]))?;
    let left_side = towers[1].contact_nodes(&ends.map(|z| [-2.0, z]))?;
    let centers = [0, 1].map(|k| towers[k].horizontal_at(heights[k]));
    let tops = [0, 1].map(|k| towers[k].horizontal_at(ends[1]));
    let lows = [0, 1].map(|k| towers[k].horizontal_at(ends[0]));
    let [left, right] = towers;
    let group = StructureGroup::new().with(left, 0.0)?.with(right, 4.0 + JOINT_GAP)?;
    let joint =
        Joint::between(group.contact_nodes(0, right_side)?, group.contact_nodes(1, left_side)?, 2)?
            .with_law(Coulomb::new(0.3)?)
            .with_gap(JOINT_GAP)?;
    let mut builder = Simulation::builder(TIME_STEP);
    for k in 0..2 {
        builder = builder
            .probe(Probe::velocity(format!("velocity {k}"), group.row(k, centers[k].clone())?))
            .probe(Probe::absolute_displacement(format!("top {k}"), group.row(k, tops[k].clone())?))
            .probe(Probe::absolute_displacement(
                format!("low {k}"),
                group.row(k, lows[k].clone())?,
            ));
    }
    let mut simulation = builder
        .ground(ElasticGround::under(Soil::new(40.0e6, 0.33, 1800.0)?, &group, 6)?)
        .structure(group)
        .interface(Coulomb::new(0.6)?)
        .joint(joint)
        .motion(el_centro_1940().scaled(1.5)?)
        .scheme(DissipativeMidpoint::new(0.8)?)
        .build()?;
    assert_eq!(simulation.state().joints[0].modes, [Mode::Open; 2]);
    // Under their weight the towers lean towards each other.
    let static_gaps = [0, 1].map(|e| simulation.state().joints[0].contact[e].gap);
    assert!(static_gaps.iter().all(|gap| (0.0..JOINT_GAP).contains(gap)), "{static_gaps:?}");
    let momentum = |probes: &[f64]| masses[0] * probes[0] + masses[1] * probes[3];
    let weight = 9.81 * (masses[0] + masses[1]);
    let mut previous_momentum = 0.0;
    let mut largest_force: f64 = 0.0;
    let mut largest_residual: f64 = 0.0;
    let mut smallest_distance = f64::INFINITY;
    let mut strikes = 0;
    let run = simulation.run(5000, |state| {
        let joint = &state.joints[0];
        strikes += joint.transitions.iter().filter(|change| change.from == Mode::Open).count();
        largest_force = largest_force.max(joint.normal_force);
        // The base shear of the step alone changes the momentum: the joint acts on both towers.
        let change = momentum(&state.probes) - previous_momentum;
        previous_momentum = momentum(&state.probes);
        largest_residual =
            largest_residual.max((change / TIME_STEP + state.base_shear).abs() / weight);
        // Means over the elements, a quarter and three quarters of the joint's height.
        for (static_gap, fraction) in static_gaps.into_iter().zip([0.25, 0.75]) {
            let place = |k: usize| {
                fraction * state.probes[3 * k + 1] + (1.0 - fraction) * state.probes[3 * k + 2]
            };
            smallest_distance = f64::min(smallest_distance, static_gap + place(1) - place(0));
        }
        assert!(joint.contact.iter().all(|contact| contact.pressure > -1e-6 * weight));
    })?;
    println!(
        "{strikes} strikes of up to {:.2} weights, momentum {largest_residual:e}, distance {smallest_distance:e}, energy {:e}",
        largest_force / weight,
        run.energy_error
    );
    assert!(strikes > 10 && largest_force > 0.1 * weight);
    assert!(largest_residual < 1e-9, "{largest_residual:e}");
    assert!(smallest_distance > -1e-9, "{smallest_distance:e}");
    assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
    Ok(())
}
