//! The effect of uplift and sliding on the storeys of a shear building.
//!
//! ```text
//! cargo run --release --example shear_building
//! ```
//!
//! Each storey gets two probes, one for the shear force in its columns and one for its drift. Probes are weighted sums
//! of the structure's degrees of freedom; `ShearBuilding` returns the weights.

use basemat::Result;
use basemat::prelude::*;

const STOREY_COUNT: usize = 5;

/// Runs twelve seconds of El Centro; `friction` is the coefficient for the factor of safety against sliding.
fn shake(law: impl InterfaceLaw + 'static, friction: f64) -> Result<Run> {
    // Storeys of 3 m, 30 t/m and 60 MN/m² on a mat 8 m wide; soil with a shear wave speed of 250 m/s.
    let storeys = [Storey::new(3.0, 30.0e3, 60.0e6); STOREY_COUNT];
    let building =
        ShearBuilding::new(8.0, 60.0e3, 4.0e5, &storeys)?.with_stiffness_damping(0.05)?;
    let soil = Soil::from_shear_wave_speed(250.0, 0.33, 1900.0)?;

    let mut probes = Vec::new();
    for storey in 0..STOREY_COUNT {
        probes.push(Probe::section(format!("shear {}", storey + 1), &building.shear(storey)?));
        probes.push(Probe::displacement(format!("drift {}", storey + 1), building.drift(storey)?));
    }
    let mut simulation = Simulation::builder(5.0e-3)
        .ground(ElasticGround::under(soil, &building, 12)?)
        .structure(building)
        .interface(law)
        .motion(el_centro_1940())
        .probes(probes)
        .safety_friction([friction])
        .build()?;
    let steps = simulation.steps_for(12.0);
    simulation.run(steps, |_| {})
}

fn main() -> Result<()> {
    let cases = [
        // A bonded base has no friction coefficient; its factor of safety uses 0.25.
        ("bonded", shake(Bonded, 0.25)?),
        ("uplift", shake(Coulomb::uplift_only(), f64::INFINITY)?),
        ("uplift, slip", shake(Coulomb::new(0.25)?, 0.25)?),
    ];

    println!("12 s of El Centro 1940; largest shear (kN/m) and drift (mm) of each storey\n");
    print!("{:<8}", "storey");
    for (name, _) in &cases {
        print!("{name:>22}");
    }
    println!();
    for storey in (0..STOREY_COUNT).rev() {
        print!("{:<8}", storey + 1);
        for (_, run) in &cases {
            let shear = run.probe(&format!("shear {}", storey + 1))?.magnitude();
            let drift = run.probe(&format!("drift {}", storey + 1))?.magnitude();
            print!("{:>12.1}{:>10.2}", 1e-3 * shear, 1e3 * drift);
        }
        println!();
    }

    // The same runs in one table: peaks, uplift, slip, safety, energies.
    let mut comparison = Comparison::default();
    for (name, mut run) in cases {
        run.probes.clear();
        comparison.add(name, run);
    }
    println!("\n{comparison}");
    Ok(())
}
