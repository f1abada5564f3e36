//! A box culvert under fill: moments at its corners at rest and under El Centro.
//!
//! ```text
//! cargo run --release --example culvert
//! ```
//!
//! Slab, walls and roof are beams; the fill above the roof consists of solid elements. Together they fill a trench.
//! They touch the soil along the whole outline of the trench, and can lift off and slide.

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::coupled::Face;
use basemat::fem::{Beam, Material, Mesh, Quad4, QuadFormulation};
use basemat::prelude::*;
use basemat::site::TrenchMotion;
use basemat::structure::{DofCombination, RayleighDamping};
use basemat::{Result, unobserved};

/// Time step, s.
const TIME_STEP: f64 = 0.02;
const STEP_COUNT: usize = 200;
/// Half the width of the culvert, m.
const HALF_WIDTH: f64 = 4.0;
/// Level of the roof above the surface, m.
const ROOF_LEVEL: f64 = -2.0;
/// Level of the slab above the surface, m.
const SLAB_LEVEL: f64 = -7.0;
/// Length of beams and sides of solids, m.
const ELEMENT_LENGTH: f64 = 0.5;
/// Degrees of freedom of a beam in the plane.
const BEAM_DOFS: usize = 6;

/// Nodes at equal distances between two points; adds those that do not exist.
fn node_line(
    mesh: &mut Mesh,
    start: [f64; 2],
    end: [f64; 2],
    part_count: u32,
) -> Result<Vec<usize>> {
    let mut nodes = Vec::new();
    for part in 0..=part_count {
        let fraction = f64::from(part) / f64::from(part_count);
        let x = start[0] + fraction * (end[0] - start[0]);
        let y = start[1] + fraction * (end[1] - start[1]);
        nodes.push(mesh.node_at(x, y).or_else(|_| mesh.add_node(x, y))?);
    }
    Ok(nodes)
}

fn culvert() -> Result<FemModel> {
    let mut mesh = Mesh::new();
    let left_corner = [-HALF_WIDTH, SLAB_LEVEL];
    let right_corner = [HALF_WIDTH, SLAB_LEVEL];
    let left_side = node_line(&mut mesh, [-HALF_WIDTH, 0.0], left_corner, 14)?;
    let slab = node_line(&mut mesh, left_corner, right_corner, 16)?;
    let right_side = node_line(&mut mesh, right_corner, [HALF_WIDTH, 0.0], 14)?;
    let mut fill_rows = vec![];
    for y in [-2.0, -1.5, -1.0, -0.5, 0.0] {
        fill_rows.push(node_line(&mut mesh, [-HALF_WIDTH, y], [HALF_WIDTH, y], 16)?);
    }
    // Left wall, slab, right wall and roof are strips of concrete plates 1 m thick.
    let fill_layers = fill_rows.len() - 1;
    let left_wall = &left_side[fill_layers..];
    let right_wall = &right_side[..right_side.len() - fill_layers];
    for line in [left_wall, &slab, right_wall, &fill_rows[0]] {
        for ends in line.windows(2) {
            mesh.add(Beam::new([ends[0], ends[1]], 31.0e9, 1.0, 1.0 / 12.0, 2500.0)?)?;
        }
    }
    let fill_material = Material::new(50.0e6, 0.3, 1900.0)?;
    for rows in fill_rows.windows(2) {
        for (lower_nodes, upper_nodes) in rows[0].windows(2).zip(rows[1].windows(2)) {
            let corners = [lower_nodes[0], lower_nodes[1], upper_nodes[1], upper_nodes[0]];
            mesh.add(Quad4::new(corners, fill_material, QuadFormulation::default()))?;
        }
    }
    let mut outline = [left_side, slab, right_side].concat();
    outline.dedup();
    let damping = RayleighDamping::from_ratios([2.0, 10.0], [0.05, 0.05])?;
    Ok(FemModel::in_trench(mesh, &outline)?.with_rayleigh(damping))
}

/// Moment that acts on a beam at its end `point`; the other end is at `far_end`.
fn beam_moment(model: &FemModel, point: [f64; 2], far_end: [f64; 2]) -> Result<DofCombination> {
    let mesh = model.mesh();
    let ends = [mesh.node_at(point[0], point[1])?, mesh.node_at(far_end[0], far_end[1])?];
    let beam = mesh
        .elements()
        .find(|element| {
            element.nodes().len() == 2 && ends.iter().all(|end| element.nodes().contains(end))
        })
        .expect("a beam between the nodes");
    let mut stiffness = vec![0.0; BEAM_DOFS * BEAM_DOFS];
    let nodes = beam.nodes();
    beam.stiffness(&[mesh.nodes()[nodes[0]], mesh.nodes()[nodes[1]]], &mut stiffness);
    // A beam has three degrees of freedom at each end; the third is the rotation.
    let moment_row = if nodes[0] == ends[0] { 2 } else { 5 };
    let mut moment = DofCombination::default();
    for (k, weight) in stiffness[BEAM_DOFS * moment_row..][..BEAM_DOFS].iter().enumerate() {
        moment += *weight * model.row(nodes[k / 3], beam.directions()[k % 3])?;
    }
    Ok(moment)
}

fn main() -> Result<()> {
    let model = culvert()?;
    let corners = [
        ("slab, left", -HALF_WIDTH, SLAB_LEVEL),
        ("slab, right", HALF_WIDTH, SLAB_LEVEL),
        ("roof, left", -HALF_WIDTH, ROOF_LEVEL),
        ("roof, right", HALF_WIDTH, ROOF_LEVEL),
    ];
    let mut corner_moments = Vec::new();
    for (name, x, y) in corners {
        let far_end = [x - ELEMENT_LENGTH * x.signum(), y];
        corner_moments.push((name, beam_moment(&model, [x, y], far_end)?));
    }
    // The moment of the slab at its corner is in equilibrium with the moment of the wall.
    let wall_moment =
        beam_moment(&model, [-HALF_WIDTH, SLAB_LEVEL], [-HALF_WIDTH, SLAB_LEVEL + ELEMENT_LENGTH])?;

    let soil = Soil::from_shear_wave_speed(200.0, 0.35, 1900.0)?;
    let elements = Trench::new(-HALF_WIDTH..HALF_WIDTH, -SLAB_LEVEL)?.elements(8, 6)?;
    let laws = elements.interfaces(Coulomb::new(0.5)?, Coulomb::new(0.4)?);
    let ground = TrenchGround::new(soil, elements)?.with_pressure_at_rest(0.5)?;
    let record = el_centro_1940().padded(0.2, 0.0)?;
    let motion = TrenchMotion::new(&ground, record, &mut unobserved)?;
    let mut builder = Simulation::builder(TIME_STEP).ground(ground).interfaces(laws).motion(motion);
    for (name, moment) in &corner_moments {
        builder = builder.probe(Probe::displacement(*name, moment.clone()).in_unit("N·m/m"));
    }
    let mut simulation = builder.structure(model).expected_steps(STEP_COUNT).build()?;
    let at_rest = simulation.static_displacement().to_vec();
    let wall_moment_at_rest = wall_moment.value(&at_rest);
    let slab_moment_at_rest = corner_moments[0].1.value(&at_rest);
    assert!((wall_moment_at_rest + slab_moment_at_rest).abs() < 0.02 * slab_moment_at_rest.abs());
    let mut largest_opening: f64 = 0.0;
    let run = simulation.run(STEP_COUNT, |state| {
        largest_opening = largest_opening.max(state.face(Face::LeftWall).open_fraction);
    })?;
    println!("{run}\n\ncorner        moment at rest      largest, kN·m/m");
    for (name, moment) in &corner_moments {
        let moment_at_rest = moment.value(&at_rest);
        let change = run.probe(name)?;
        let min_moment = moment_at_rest + change.lowest.value;
        let max_moment = moment_at_rest + change.highest.value;
        let max_magnitude = min_moment.abs().max(max_moment.abs());
        println!("{name:12}  {:14.0}  {:12.0}", 1e-3 * moment_at_rest.abs(), 1e-3 * max_magnitude);
    }
    println!("largest open part of the left wall: {:.0} %", 100.0 * largest_opening);
    assert!(run.energy_error < 1e-9);
    Ok(())
}
