//! A five-storey building with and without base isolation.
//!
//! ```text
//! cargo run --release --example base_isolated
//! ```
//!
//! The building stands directly on its basemat (elastic, or with columns that yield), on friction pendulums,
//! and on lead–rubber bearings. The law of the pendulums uses the static weight and one friction coefficient;
//! it neglects vertical motion and the influence of speed. In all cases the basemat may uplift and slide on
//! the soil. The hysteretic laws return a force for a drift; the energy balance includes the energy that they
//! dissipate.

use basemat::Result;
use basemat::prelude::*;
use basemat::structure::{Bilinear, FrictionPendulum, IsolationLevel, LeadRubber, ShearBuilding};

const FLOOR_COUNT: usize = 5;
/// Mass of each floor, kg/m.
const FLOOR_MASS: f64 = 20.0e3;
/// Mass of the slab on the bearings, kg/m.
const SLAB_MASS: f64 = 30.0e3;
/// Stiffness of each storey, N/m².
const STOREY_STIFFNESS: f64 = 40.0e6;

/// Five storeys of 3 m, per metre of thickness.
///
/// The damping is 2 % of critical at the fixed-base frequency. It does not change where columns yield.
fn building() -> Result<ShearBuilding> {
    let storeys = [Storey::new(3.0, FLOOR_MASS, STOREY_STIFFNESS); FLOOR_COUNT];
    ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys)?.with_stiffness_damping(0.02)
}

/// Runs 20 s of El Centro; records the roof acceleration and the drifts of the lowest `levels`.
fn shake(structure: ShearBuilding, levels: usize) -> Result<Run> {
    let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
    let mut probes = vec![Probe::acceleration("roof", structure.roof())];
    for level in 0..levels {
        probes.push(Probe::displacement(format!("drift {level}"), structure.drift(level)?));
    }
    let mut simulation = Simulation::builder(2.5e-3)
        .ground(ElasticGround::under(soil, &structure, 10)?)
        .structure(structure)
        .interface(Coulomb::new(0.4)?)
        .motion(el_centro_1940())
        .probes(probes)
        .build()?;
    let steps = simulation.steps_for(20.0);
    simulation.run(steps, |_| {})
}

/// Largest drift of a level in a run, mm.
fn largest_drift(run: &Run, level: usize) -> Result<f64> {
    Ok(1e3 * run.probe(&format!("drift {level}"))?.magnitude())
}

fn main() -> Result<()> {
    // Weight on the bearings: the slab and all floors.
    let weight = STANDARD_GRAVITY * (SLAB_MASS + FLOOR_COUNT as f64 * FLOOR_MASS);
    let level =
        IsolationLevel { height: 0.3, slab_mass: SLAB_MASS, slab_inertia: 2.5e5, damping: 0.0 };
    // Every storey yields at 15 % of the weight above it and hardens with 3 % of its stiffness.
    let mut yielding_building = building()?;
    for storey in 0..FLOOR_COUNT {
        let weight_above = STANDARD_GRAVITY * FLOOR_MASS * (FLOOR_COUNT - storey) as f64;
        yielding_building = yielding_building
            .with_law(storey, Bilinear::new(STOREY_STIFFNESS, 0.15 * weight_above, 0.03)?)?;
    }
    let pendulums = FrictionPendulum::new(weight, 2.0, 0.06)?;
    let rubber = LeadRubber::from_strength(0.6e6, 0.05 * weight)?;
    let isolated_cases = [
        ("friction pendulum", building()?.isolated(level, pendulums)?),
        ("lead-rubber", building()?.isolated(level, rubber)?),
    ];
    let direct_cases = [("elastic", building()?), ("yielding", yielding_building)];
    // The bearings are the lowest level of an isolated building.
    let cases = direct_cases
        .map(|case| (case, 0))
        .into_iter()
        .chain(isolated_cases.map(|case| (case, 1)));

    println!("                   bearing  1st storey  roof     base     uplift  input  hysteresis");
    println!("                   mm       drift, mm   acc., g  shear/W  %       kJ/m   kJ/m");
    for ((name, structure), bearing_levels) in cases {
        let total_weight = STANDARD_GRAVITY * structure.total_mass();
        let run = shake(structure, bearing_levels + 1)?;
        let bearing_travel = if bearing_levels > 0 { largest_drift(&run, 0)? } else { 0.0 };
        let storey_drift = largest_drift(&run, bearing_levels)?;
        println!(
            "{name:<18} {:7.1} {:11.1} {:8.2} {:8.2} {:8.0} {:7.1} {:11.1}",
            bearing_travel,
            storey_drift,
            run.probe("roof")?.magnitude() / STANDARD_GRAVITY,
            run.whole.base_shear.magnitude() / total_weight,
            100.0 * run.whole.uplifted_fraction.largest().value,
            1e-3 * run.energy_balance.input,
            1e-3 * run.energy_balance.hysteresis,
        );
    }
    Ok(())
}
