//! A box culvert under fill: moments at its corners at rest and under El Centro.
//!
//! ```text
//! cargo run --release --example culvert
//! ```
//!
//! Slab, walls and roof are beams, the fill above the roof is solids. Together they fill a trench, touch the soil along
//! its whole outline, and can lift off and slide.

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::coupled::Face;
use basemat::fem::{Beam, Material, Mesh, Quad4, QuadFormulation};
use basemat::prelude::*;
use basemat::site::TrenchMotion;
use basemat::structure::{DofCombination, RayleighDamping};
use basemat::{Result, unobserved};

const STEP: f64 = 0.02;
const STEPS: usize = 200;
/// Half the width, heights of the roof and of the slab, m.
const HALF: f64 = 4.0;
const ROOF: f64 = -2.0;
const SLAB: f64 = -7.0;
/// Length of beams and sides of solids, m.
const SIDE: f64 = 0.5;

/// Nodes at equal distances between two points; adds those that do not exist.
fn line(mesh: &mut Mesh, from: [f64; 2], to: [f64; 2], parts: u32) -> Result<Vec<usize>> {
    let node = |part: u32| {
        let share = f64::from(part) / f64::from(parts);
        let [x, y] = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        mesh.node_at(x, y).or_else(|_| mesh.add_node(x, y))
    };
    (0..=parts).map(node).collect()
}

fn culvert() -> Result<FemModel> {
    let mut mesh = Mesh::new();
    let [left, right] = [[-HALF, SLAB], [HALF, SLAB]];
    let down = line(&mut mesh, [-HALF, 0.0], left, 14)?;
    let along = line(&mut mesh, left, right, 16)?;
    let up = line(&mut mesh, right, [HALF, 0.0], 14)?;
    let mut rows = vec![];
    for y in [-2.0, -1.5, -1.0, -0.5, 0.0] {
        rows.push(line(&mut mesh, [-HALF, y], [HALF, y], 16)?);
    }
    // A metre of concrete, as a strip of a plate.
    let fill = rows.len() - 1;
    let walls = [&down[fill..], &along, &up[..up.len() - fill], &rows[0]];
    for ends in walls.into_iter().flat_map(|own| own.windows(2)) {
        mesh.add(Beam::new([ends[0], ends[1]], 31.0e9, 1.0, 1.0 / 12.0, 2500.0)?)?;
    }
    let soil = Material::new(50.0e6, 0.3, 1900.0)?;
    for pair in rows.windows(2) {
        for (low, high) in pair[0].windows(2).zip(pair[1].windows(2)) {
            let corners = [low[0], low[1], high[1], high[0]];
            mesh.add(Quad4::new(corners, soil, QuadFormulation::default()))?;
        }
    }
    let mut outline = [down, along, up].concat();
    outline.dedup();
    let damping = RayleighDamping::from_ratios([2.0, 10.0], [0.05, 0.05])?;
    Ok(FemModel::in_trench(mesh, &outline)?.with_rayleigh(damping))
}

/// Moment on a beam at its end `node`; the other end is the node `next`.
fn moment(model: &FemModel, [node, next]: [[f64; 2]; 2]) -> Result<DofCombination> {
    let mesh = model.mesh();
    let ends = [mesh.node_at(node[0], node[1])?, mesh.node_at(next[0], next[1])?];
    let is_own = |own: &[usize]| own.len() == 2 && ends.iter().all(|end| own.contains(end));
    let beam = mesh.elements().find(|own| is_own(own.nodes())).expect("a beam between the nodes");
    let [first, last] = [0, 1].map(|k| beam.nodes()[k]);
    let mut stiffness = vec![0.0; 36];
    beam.stiffness(&[first, last].map(|own| mesh.nodes()[own]), &mut stiffness);
    let row = if first == ends[0] { 2 } else { 5 };
    let mut moment = DofCombination::default();
    for (k, weight) in stiffness[6 * row..][..6].iter().enumerate() {
        moment += *weight * model.row(beam.nodes()[k / 3], beam.directions()[k % 3])?;
    }
    Ok(moment)
}

fn main() -> Result<()> {
    let model = culvert()?;
    let corners = [("slab, left", -HALF, SLAB), ("slab, right", HALF, SLAB)];
    let corners = [corners, [("roof, left", -HALF, ROOF), ("roof, right", HALF, ROOF)]].concat();
    let row = |(_, x, y): &(_, f64, f64)| moment(&model, [[*x, *y], [x - SIDE * x.signum(), *y]]);
    let rows = corners.iter().map(row).collect::<Result<Vec<_>>>()?;
    // The wall holds the end of the slab and the moment of its weight there.
    let of_wall = moment(&model, [[-HALF, SLAB], [-HALF, SLAB + SIDE]])?;

    let soil = Soil::from_shear_wave_speed(200.0, 0.35, 1900.0)?;
    let elements = Trench::new(-HALF..HALF, -SLAB)?.elements(8, 6)?;
    let laws = elements.interfaces(Coulomb::new(0.5)?, Coulomb::new(0.4)?);
    let ground = TrenchGround::new(soil, elements)?.with_pressure_at_rest(0.5)?;
    let record = el_centro_1940().padded(0.2, 0.0)?;
    let motion = TrenchMotion::new(&ground, record, &mut unobserved)?;
    let mut builder = Simulation::builder(STEP).ground(ground).interfaces(laws).motion(motion);
    for ((name, ..), row) in corners.iter().zip(&rows) {
        builder = builder.probe(Probe::displacement(*name, row.clone()).in_unit("N·m/m"));
    }
    let mut simulation = builder.structure(model).expected_steps(STEPS).build()?;
    let at_rest = simulation.static_displacement().to_vec();
    let [wall, slab] = [&of_wall, &rows[0]].map(|own| own.value(&at_rest));
    assert!((wall + slab).abs() < 0.02 * slab.abs());
    let mut open: f64 = 0.0;
    let run =
        simulation.run(STEPS, |state| open = open.max(state.face(Face::LeftWall).open_fraction))?;
    println!("{run}\n\ncorner        moment at rest      largest, kN·m/m");
    for ((name, ..), row) in corners.iter().zip(&rows) {
        let (rest, change) = (row.value(&at_rest), run.probe(name)?);
        let largest = (rest + change.lowest.value).abs().max((rest + change.highest.value).abs());
        println!("{name:12}  {:14.0}  {:12.0}", 1e-3 * rest.abs(), 1e-3 * largest);
    }
    println!("largest open part of the left wall: {:.0} %", 100.0 * open);
    assert!(run.energy_error < 1e-9);
    Ok(())
}
