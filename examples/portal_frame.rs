//! A portal frame on two strip footings: the effect of uplift and friction on each footing.
//!
//! ```text
//! cargo run --release --example portal_frame
//! ```
//!
//! Each column has its own rigid footing. Only friction resists sliding. The footings rotate on their edges,
//! move towards each other, and stay there. A [`Sweep`] over widths and friction coefficients shows how far
//! they move.

use basemat::Result;
use basemat::fem::{Beam, Direction, LumpedMass, Mesh};
use basemat::prelude::*;
use basemat::structure::DofCombination;
use basemat::sweep::CaseError;

/// Height of the columns and distance between them, m.
const HEIGHT: f64 = 5.0;
const SPAN: f64 = 8.0;
/// Area (m²/m) and second moment of area (m⁴/m): columns 0.6 × 0.6 m and a beam 0.4 × 0.8 m, every 5 m.
const COLUMN: [f64; 2] = [0.072, 2.16e-3];
const BEAM: [f64; 2] = [0.064, 3.413e-3];
const YOUNG_MODULUS: f64 = 30.0e9;
/// Mass of the roof, frame included, kg/m.
const ROOF_MASS: f64 = 30.0e3;
/// Frequency of lateral vibration on a fixed base, Hz.
const FREQUENCY: f64 = 2.707;
/// Thickness (m) and density (kg/m³) of the footings.
const FOOTING: [f64; 2] = [0.6, 2400.0];

/// The frame on footings of `width` (m), and the drift of its roof.
///
/// The drift is relative to the mean displacement of the footings.
fn portal(width: f64) -> Result<(FemModel, DofCombination)> {
    let member = |ends, [area, second_moment]: [f64; 2]| {
        Beam::new(ends, YOUNG_MODULUS, area, second_moment, 0.0)
    };
    let [depth, density] = FOOTING;
    let mut mesh = Mesh::new();
    let mut lines = Vec::new();
    for x in [-0.5 * SPAN, 0.5 * SPAN] {
        let line = [x - 0.5 * width, x, x + 0.5 * width].map(|x| mesh.add_node(x, 0.0));
        let line = line.into_iter().collect::<Result<Vec<_>>>()?;
        for ends in [[line[0], line[1]], [line[1], line[2]]] {
            mesh.add(Beam::new(ends, YOUNG_MODULUS, depth, depth.powi(3) / 12.0, density)?)?;
        }
        let top = mesh.add_node(x, HEIGHT)?;
        mesh.add(member([line[1], top], COLUMN)?)?;
        mesh.add(LumpedMass::new(top, 0.5 * ROOF_MASS)?)?;
        lines.push(line);
    }
    let ends = [mesh.node_at(-0.5 * SPAN, HEIGHT)?, mesh.node_at(0.5 * SPAN, HEIGHT)?];
    mesh.add(member(ends, BEAM)?)?;
    let mut model = FemModel::on_foundations(mesh, &lines)?;
    for line in &lines {
        model = model.with_rigid_link(line[1], &[line[0], line[2]])?;
    }
    let mut drift = DofCombination::default();
    for x in [-0.5 * SPAN, 0.5 * SPAN] {
        let [foot, top] = [model.mesh().node_at(x, 0.0)?, model.mesh().node_at(x, HEIGHT)?];
        drift += 0.5 * model.row(top, Direction::X)? - 0.5 * model.row(foot, Direction::X)?;
    }
    Ok((model, drift))
}

fn shake(width: f64, law: impl InterfaceLaw + 'static) -> Result<Run> {
    let (model, drift) = portal(width)?;
    let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0)?;
    // 5 % of critical damping for lateral vibration on a fixed base.
    let damping = RayleighDamping::new(0.0, 0.05 / (std::f64::consts::PI * FREQUENCY))?;
    let mut simulation = Simulation::builder(0.005)
        .ground(ElasticGround::under(soil, &model, 8)?)
        .structure(model.with_rayleigh(damping))
        .interface(law)
        .motion(el_centro_1940())
        .probe(Probe::displacement("drift", drift))
        .build()?;
    simulation.run(simulation.steps_for(20.0), |_| {})
}

fn main() -> Result<()> {
    println!(
        "| base | drift, mm | footing | shear, kN/m | normal force, kN/m | uplift, % | slip, mm \
         | at the end, mm |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let laws: [(&str, Box<dyn InterfaceLaw>); 3] = [
        ("bonded", Box::new(Bonded)),
        ("friction 0.3", Box::new(Coulomb::new(0.3)?)),
        ("friction 0.5", Box::new(Coulomb::new(0.5)?)),
    ];
    for (name, law) in laws {
        let run = shake(2.0, law)?;
        for (side, footing) in ["left", "right"].iter().zip(&run.foundations) {
            println!(
                "| {name} | {:.1} | {side} | {:.1} | {:.1} | {:.0} | {:.1} | {:.1} |",
                1e3 * run.probe("drift")?.magnitude(),
                1e-3 * footing.base_shear.magnitude(),
                1e-3 * footing.normal_force.highest.value,
                100.0 * footing.uplifted_fraction.largest().value,
                1e3 * footing.mean_slip.largest().value,
                1e3 * footing.residual_slip
            );
        }
    }
    let (widths, frictions) = ([1.6, 2.0, 2.4, 3.0], [0.2, 0.3, 0.4, 0.5, 0.6]);
    let [width, friction] = [("width_m", &widths[..]), ("friction", &frictions[..])]
        .map(|(name, values)| Parameter::numbers(name, values.iter().copied()));
    let sweep = Sweep::grid([width, friction])?;
    let closer = sweep.collect(|case| {
        let law = Coulomb::new(case.value("friction")?)?;
        let run = shake(case.value("width_m")?, law)?;
        Ok(run.foundations[0].residual_slip - run.foundations[1].residual_slip)
    });
    let closer = closer.into_iter().collect::<std::result::Result<Vec<_>, CaseError<_>>>()?;
    println!("\nBy how much the footings end closer to each other, mm\n");
    println!("| width, m | friction {} |", frictions.map(|f| f.to_string()).join(" | "));
    println!("|---|{}", "---|".repeat(frictions.len()));
    for (width, row) in widths.iter().zip(closer.chunks(frictions.len())) {
        let row: Vec<_> = row.iter().map(|closer| format!("{:.1}", 1e3 * closer)).collect();
        println!("| {width:.1} | {} |", row.join(" | "));
    }
    Ok(())
}
