//! Two buildings side by side: what the neighbour changes.
//!
//! A tall building stands beside a low one on soft soil. Each is computed alone, then both
//! together, coupled by the soil between them (structure–soil–structure interaction).
//!
//! ```text
//! cargo run --release --example two_buildings
//! ```

use basemat::bem::{HalfPlaneGround, Strip};
use basemat::coupled::{Probe, SimulationBuilder};
use basemat::interface::Coulomb;
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{ShearBuilding, Storey, Structure, StructureGroup};
use basemat::{Result, Simulation, Soil};

/// Base width and where its middle is, m.
const TALL: [f64; 2] = [12.0, 0.0];
const LOW: [f64; 2] = [10.0, 13.0];

fn tall() -> Result<ShearBuilding> {
    let storeys = [Storey::new(3.0, 60.0e3, 90.0e6); 8];
    ShearBuilding::new(TALL[0], 120.0e3, 1.5e6, &storeys)?.with_stiffness_damping(0.05)
}

fn low() -> Result<ShearBuilding> {
    let storeys = [Storey::new(3.0, 60.0e3, 120.0e6); 3];
    ShearBuilding::new(LOW[0], 100.0e3, 0.9e6, &storeys)?.with_stiffness_damping(0.05)
}

/// Eight elements under a base.
fn strip([width, middle]: [f64; 2]) -> Result<Strip> {
    Strip::uniform(middle - 0.5 * width..middle + 0.5 * width, 8)
}

fn simulation(
    structure: impl Structure + 'static,
    strips: &[Strip],
    probes: Vec<Probe>,
) -> Result<Simulation> {
    // Shear wave speed 150 m/s.
    let soil = Soil::new(40.0e6, 0.4, 1800.0)?;
    let builder = Simulation::builder(0.005)
        .structure(structure)
        .ground(HalfPlaneGround::new(soil, strips)?)
        .interface(Coulomb::new(0.5)?)
        .motion(el_centro_1940())
        .gravity(STANDARD_GRAVITY);
    probes.into_iter().fold(builder, SimulationBuilder::probe).build()
}

/// Peaks of one building.
#[derive(Default)]
struct Peaks {
    shear: f64,
    rotation: f64,
    uplift: f64,
    roof: f64,
}

/// Runs to the end of the record and returns the peaks of every building.
fn peaks(mut simulation: Simulation) -> Result<Vec<Peaks>> {
    let mut all = Vec::new();
    simulation.run(6000, |state| {
        all.resize_with(state.foundations.len(), Peaks::default);
        for ((peaks, base), roof) in all.iter_mut().zip(&state.foundations).zip(&state.probes) {
            peaks.shear = peaks.shear.max(base.shear.abs());
            peaks.rotation = peaks.rotation.max(base.rotation.abs());
            peaks.uplift = peaks.uplift.max(base.uplifted_fraction);
            peaks.roof = peaks.roof.max(roof.abs());
        }
    })?;
    Ok(all)
}

fn main() -> Result<()> {
    let (first, second) = (tall()?, low()?);
    let roofs = [("tall", first.roof()), ("low", second.roof())];
    let [on_tall, on_low] = roofs.map(|(name, roof)| Probe::acceleration(name, roof));

    let alone = simulation(first, &[strip(TALL)?], vec![on_tall.clone()])?;
    let mut apart = peaks(alone)?;
    // The same building, moved to its place: a group of one.
    let moved = StructureGroup::new().with(second, LOW[1])?;
    apart.extend(peaks(simulation(moved, &[strip(LOW)?], vec![on_low.clone()])?)?);

    let group = StructureGroup::new().with(tall()?, TALL[1])?.with(low()?, LOW[1])?;
    // Unknowns of a member come after those of the members before it.
    let probes = vec![group.probe(0, on_tall)?, group.probe(1, on_low)?];
    let together = peaks(simulation(group, &[strip(TALL)?, strip(LOW)?], probes)?)?;

    println!("El Centro 1940, soil with 150 m/s, friction 0.5, 2 m between the buildings\n");
    println!("| building | | base shear, kN/m | rotation, mrad | uplift, % | roof, m/s² |");
    println!("|---|---|---|---|---|---|");
    for (name, alone, both) in [("8 storeys", 0, 0), ("3 storeys", 1, 1)] {
        for (how, p) in [("alone", &apart[alone]), ("together", &together[both])] {
            println!(
                "| {name} | {how} | {:.1} | {:.2} | {:.0} | {:.2} |",
                p.shear / 1e3,
                p.rotation * 1e3,
                p.uplift * 100.0,
                p.roof
            );
        }
    }
    Ok(())
}
