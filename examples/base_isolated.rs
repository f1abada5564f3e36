//! A five-storey building with and without base isolation.
//!
//! ```text
//! cargo run --release --example base_isolated
//! ```
//!
//! The same building stands on its basemat directly, with columns that yield, on friction pendulums
//! and on lead–rubber bearings. Below the basemat, soil and contact are as ever: the base may uplift
//! and slide. The law of a spring says what force a drift meets; the ledger says what it took.

use basemat::bem::HalfPlaneGround;
use basemat::coupled::{Probe, Run};
use basemat::interface::Coulomb;
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{
    Bilinear, FrictionPendulum, IsolationLevel, LeadRubber, NonlinearShearBuilding, Row,
    ShearBuilding, Storey, Structure,
};
use basemat::{Result, Simulation, Soil};

const FLOORS: usize = 5;
const FLOOR_MASS: f64 = 20.0e3;
const SLAB_MASS: f64 = 30.0e3;

/// Five storeys of 3 m, 2 % of critical damping, per metre of thickness.
fn building() -> Result<ShearBuilding> {
    let storeys = [Storey::new(3.0, FLOOR_MASS, 40.0e6); FLOORS];
    ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys)?.with_stiffness_damping(0.02)
}

/// Marches a structure through El Centro; `roof` is an unknown, `drift` that of the lowest level.
fn shake(structure: impl Structure + 'static, roof: usize, drift: Row) -> Result<Run> {
    let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
    Simulation::builder(2.5e-3)
        .structure(structure)
        .ground(HalfPlaneGround::strip(soil, -5.0..5.0, 10)?)
        .interface(Coulomb::new(0.4)?)
        .motion(el_centro_1940())
        .probe(Probe::displacement("drift", drift))
        .probe(Probe::acceleration("roof", roof))
        .expected_steps(8000)
        .build()?
        .run(8000, |_| {})
}

fn main() -> Result<()> {
    // What the bearings carry: the slab and all floors.
    let weight = STANDARD_GRAVITY * (SLAB_MASS + FLOORS as f64 * FLOOR_MASS);
    let level =
        IsolationLevel { height: 0.3, slab_mass: SLAB_MASS, slab_inertia: 2.5e5, damping: 0.0 };
    // Every storey yields at 15 % of the weight above it and hardens with 3 % of its stiffness.
    let mut yielding = NonlinearShearBuilding::new(building()?);
    for storey in 0..FLOORS {
        let above = STANDARD_GRAVITY * FLOOR_MASS * (FLOORS - storey) as f64;
        yielding = yielding.with_law(storey, Bilinear::new(40.0e6, 0.15 * above, 0.03)?)?;
    }
    let pendulums = FrictionPendulum::new(weight, 2.0, 0.06)?;
    let rubber = LeadRubber::from_strength(0.6e6, 0.05 * weight)?;
    let cases: [(&str, NonlinearShearBuilding); 4] = [
        ("elastic, fixed", NonlinearShearBuilding::new(building()?)),
        ("yielding, fixed", yielding),
        ("friction pendulum", NonlinearShearBuilding::isolated(building()?, level, pendulums)?),
        ("lead-rubber", NonlinearShearBuilding::isolated(building()?, level, rubber)?),
    ];

    println!(
        "                    lowest     roof       base      uplift  input   hysteresis  ledger"
    );
    println!(
        "                    drift, mm  acc., g    shear/W   %       kJ/m    kJ/m        open by"
    );
    for (name, structure) in cases {
        let total = STANDARD_GRAVITY * structure.building().total_mass();
        let roof = structure.building().roof();
        let drift = structure.building().drift(0)?;
        let run = shake(structure, roof, drift)?;
        let peak = |name| run.probe(name).map(|peak| peak.magnitude());
        println!(
            "{name:<18} {:10.1} {:10.2} {:10.2} {:8.0} {:8.1} {:10.1} {:10.0e}",
            1e3 * peak("drift")?,
            peak("roof")? / STANDARD_GRAVITY,
            run.base_shear.magnitude() / total,
            100.0 * run.uplifted_fraction.value,
            1e-3 * run.ledger.input,
            1e-3 * run.ledger.hysteresis,
            run.ledger_residual,
        );
    }
    Ok(())
}
