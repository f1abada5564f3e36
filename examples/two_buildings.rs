//! Two buildings side by side: structure–soil–structure interaction.
//!
//! A tall building stands next to a low building on soft soil. Each building is computed alone. Then both are computed
//! together, coupled through the soil.
//!
//! ```text
//! cargo run --release --example two_buildings
//! ```

use basemat::Result;
use basemat::prelude::*;

fn tall() -> Result<ShearBuilding> {
    let storeys = [Storey::new(3.0, 60.0e3, 90.0e6); 8];
    ShearBuilding::new(12.0, 120.0e3, 1.5e6, &storeys)?.with_stiffness_damping(0.05)
}

fn low() -> Result<ShearBuilding> {
    let storeys = [Storey::new(3.0, 60.0e3, 120.0e6); 3];
    ShearBuilding::new(10.0, 100.0e3, 0.9e6, &storeys)?.with_stiffness_damping(0.05)
}

/// Runs 30 s of El Centro; `roofs` has an acceleration probe for the roof of each building in `structure`.
fn shake<const N: usize>(structure: impl Structure + 'static, roofs: [Probe; N]) -> Result<Run> {
    let soil = Soil::from_shear_wave_speed(150.0, 0.4, 1800.0)?;
    let mut simulation = Simulation::builder(0.005)
        // Eight elements under each base; the bases are coupled through the soil.
        .ground(ElasticGround::under(soil, &structure, 8)?)
        .structure(structure)
        .interface(Coulomb::new(0.5)?)
        .motion(el_centro_1940())
        .probes(roofs)
        .build()?;
    let steps = simulation.steps_for(30.0);
    simulation.run(steps, |_| {})
}

fn main() -> Result<()> {
    let tall_roof = Probe::acceleration("tall", tall()?.roof());
    let low_roof = Probe::acceleration("low", low()?.roof());
    let single_runs = [shake(tall()?, [tall_roof.clone()])?, shake(low()?, [low_roof.clone()])?];

    // The low building stands 13 m to the right, with 2 m between the buildings.
    // // `StructureGroup::probe` converts a probe to the group's degrees of freedom.
    let group = StructureGroup::new().with(tall()?, 0.0)?.with(low()?, 13.0)?;
    let probes = [group.probe(0, tall_roof)?, group.probe(1, low_roof)?];
    let group_run = shake(group, probes)?;

    println!("El Centro 1940, soil with 150 m/s, friction 0.5, 2 m between the buildings\n");
    println!("| building | | base shear, kN/m | rotation, mrad | uplift, % | roof, m/s² |");
    println!("|---|---|---|---|---|---|");
    let mut changes = Vec::new();
    for (k, (name, probe)) in [("8 storeys", "tall"), ("3 storeys", "low")].iter().enumerate() {
        let bases = [&single_runs[k].foundations[0], &group_run.foundations[k]];
        let roofs = [single_runs[k].probe(probe)?, group_run.probe(probe)?];
        for ((neighbour, base), roof) in ["alone", "together"].iter().zip(bases).zip(roofs) {
            println!(
                "| {name} | {neighbour} | {:.1} | {:.2} | {:.0} | {:.2} |",
                1e-3 * base.base_shear.magnitude(),
                1e3 * base.base_rotation.magnitude(),
                100.0 * base.uplifted_fraction.largest().value,
                roof.magnitude()
            );
        }
        let shear_alone = bases[0].base_shear.magnitude();
        let shear_together = bases[1].base_shear.magnitude();
        changes.push(100.0 * (shear_together / shear_alone - 1.0));
    }
    println!(
        "\nThe neighbour changes the base shear by {:+.0} % (8 storeys) and {:+.0} % (3 storeys).",
        changes[0], changes[1]
    );
    Ok(())
}
