//! Uplift and friction under the two strip footings of a portal frame.
//!
//! ```text
//! cargo run --release --example portal_frame
//! ```
//!
//! Each column stands on a rigid footing, and only friction resists the sliding of the footings. They rotate on their
//! edges, move towards each other, and do not return. A [`Sweep`] over widths and friction coefficients shows how far
//! they move.

use basemat::Result;
use basemat::fem::{Beam, Direction, LumpedMass, Mesh};
use basemat::prelude::*;
use basemat::structure::DofCombination;
use basemat::sweep::CaseError;

/// Height of the columns, m.
const COLUMN_HEIGHT: f64 = 5.0;
/// Distance between the columns, m.
const BEAM_SPAN: f64 = 8.0;
/// Area (m²/m) and second moment of area (m⁴/m) of columns of 0.6 × 0.6 m in frames 5 m apart.
const COLUMN_SECTION: [f64; 2] = [0.072, 2.16e-3];
/// Area (m²/m) and second moment of area (m⁴/m) of beams 0.4 m wide and 0.8 m high in frames 5 m apart.
const BEAM_SECTION: [f64; 2] = [0.064, 3.413e-3];
/// Young's modulus of concrete, Pa.
const YOUNG_MODULUS: f64 = 30.0e9;
/// Mass of the roof, frame included, kg/m.
const ROOF_MASS: f64 = 30.0e3;
/// Frequency of lateral vibration on a fixed base, Hz; the stiffness damping refers to it.
const LATERAL_FREQUENCY: f64 = 2.707;
/// Thickness of the footings, m.
const FOOTING_THICKNESS: f64 = 0.6;
/// Density of the footings, kg/m³.
const FOOTING_DENSITY: f64 = 2400.0;

/// A massless member of the frame.
fn member(ends: [usize; 2], [area, second_moment]: [f64; 2]) -> Result<Beam> {
    Beam::new(ends, YOUNG_MODULUS, area, second_moment, 0.0)
}

/// The element of a footing between two nodes.
fn footing(ends: [usize; 2]) -> Result<Beam> {
    let second_moment = FOOTING_THICKNESS.powi(3) / 12.0;
    Beam::new(ends, YOUNG_MODULUS, FOOTING_THICKNESS, second_moment, FOOTING_DENSITY)
}

/// The frame on footings of `width` (m).
fn portal(width: f64) -> Result<FemModel> {
    let mut mesh = Mesh::new();
    let mut footings = Vec::new();
    for x in [-0.5 * BEAM_SPAN, 0.5 * BEAM_SPAN] {
        let left = mesh.add_node(x - 0.5 * width, 0.0)?;
        let foot = mesh.add_node(x, 0.0)?;
        let right = mesh.add_node(x + 0.5 * width, 0.0)?;
        mesh.add(footing([left, foot])?)?;
        mesh.add(footing([foot, right])?)?;
        let top = mesh.add_node(x, COLUMN_HEIGHT)?;
        mesh.add(member([foot, top], COLUMN_SECTION)?)?;
        mesh.add(LumpedMass::new(top, 0.5 * ROOF_MASS)?)?;
        footings.push(vec![left, foot, right]);
    }
    let tops = [
        mesh.node_at(-0.5 * BEAM_SPAN, COLUMN_HEIGHT)?,
        mesh.node_at(0.5 * BEAM_SPAN, COLUMN_HEIGHT)?,
    ];
    mesh.add(member(tops, BEAM_SECTION)?)?;
    let mut model = FemModel::on_foundations(mesh, &footings)?;
    for nodes in &footings {
        model = model.with_rigid_link(nodes[1], &[nodes[0], nodes[2]])?;
    }
    Ok(model)
}

/// Mean horizontal displacement of the columns' tops relative to the footings.
fn roof_drift(model: &FemModel) -> Result<DofCombination> {
    let mut drift = DofCombination::default();
    for x in [-0.5 * BEAM_SPAN, 0.5 * BEAM_SPAN] {
        let foot = model.mesh().node_at(x, 0.0)?;
        let top = model.mesh().node_at(x, COLUMN_HEIGHT)?;
        drift += 0.5 * model.row(top, Direction::X)? - 0.5 * model.row(foot, Direction::X)?;
    }
    Ok(drift)
}

fn shake(width: f64, law: impl InterfaceLaw + 'static) -> Result<Run> {
    let model = portal(width)?;
    let drift = roof_drift(&model)?;
    let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0)?;
    // Damping proportional to the stiffness: 5 % of critical for lateral vibration on a fixed base.
    let damping = RayleighDamping::new(0.0, 0.05 / (std::f64::consts::PI * LATERAL_FREQUENCY))?;
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
    // Footings end closer to each other by the difference of their residual slips.
    let widths = [1.6, 2.0, 2.4, 3.0];
    let frictions = [0.2, 0.3, 0.4, 0.5, 0.6];
    let sweep = Sweep::grid([
        Parameter::numbers("width_m", widths),
        Parameter::numbers("friction", frictions),
    ])?;
    let approaches = sweep.collect(|case| {
        let law = Coulomb::new(case.value("friction")?)?;
        let run = shake(case.value("width_m")?, law)?;
        Ok(run.foundations[0].residual_slip - run.foundations[1].residual_slip)
    });
    let approaches =
        approaches.into_iter().collect::<std::result::Result<Vec<_>, CaseError<_>>>()?;
    println!("\nBy how much the footings end closer to each other, mm\n");
    println!(
        "| width, m | friction {} |",
        frictions.map(|friction| friction.to_string()).join(" | ")
    );
    println!("|---|{}", "---|".repeat(frictions.len()));
    for (width, row) in widths.iter().zip(approaches.chunks(frictions.len())) {
        let cells: Vec<_> = row.iter().map(|approach| format!("{:.1}", 1e3 * approach)).collect();
        println!("| {width:.1} | {} |", cells.join(" | "));
    }
    Ok(())
}
