//! A raft of shells under a load on its middle, on springs and on the half-space.

use std::ops::Range;

use basemat::bem::plan::Plan;
use basemat::coupled::Load;
use basemat::fem::{Direction, Element, MassKind, Material};
use basemat::prelude::*;
use basemat::structure::FemModel;
use basemat_problems::supported::{CLAMPED_DIRECTIONS, RZ, X, Y, Z};

use super::row::BenchmarkRows;
use super::surface::{ShellPattern, ShellSurface};
use crate::AnyError;

/// Side and thickness of the raft, m; side of the load, m, and the load, N.
const RAFT_SIDE: f64 = 12.0;
const RAFT_THICKNESS: f64 = 0.8;
const LOAD_SIDE: f64 = 1.5;
const TOTAL_LOAD: f64 = 4.0e6;

/// Springs under a level rectangle, N/m³, that move with its shape functions.
#[derive(Debug)]
struct SpringElement {
    nodes: [usize; 4],
    stiffness: f64,
}

impl Element for SpringElement {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn directions(&self) -> &[Direction] {
        &[Direction::Z]
    }

    fn stiffness(&self, points: &[[f64; 3]], matrix: &mut [f64]) {
        let area = (points[2][0] - points[0][0]) * (points[2][1] - points[0][1]);
        for i in 0..4 {
            for j in 0..4 {
                let x = shape_product(points[i][0], points[j][0]);
                let y = shape_product(points[i][1], points[j][1]);
                matrix[4 * i + j] += self.stiffness * area * x * y;
            }
        }
    }

    fn mass(&self, _: &[[f64; 3]], _: MassKind, _: &mut [f64]) {}
}

/// ∫NᵢNⱼ of the linear shape functions of two ends of a side, over its length.
fn shape_product(end: f64, other_end: f64) -> f64 {
    if (end - other_end).abs() < 1e-9 { 1.0 / 3.0 } else { 1.0 / 6.0 }
}

struct Raft {
    surface: ShellSurface,
    nodes: Vec<Vec<usize>>,
}

/// The raft of `count` × `count` shells.
fn raft(count: usize) -> Result<Raft, AnyError> {
    let concrete = Material::new(30.0e9, 0.2, 2400.0)?;
    let mut surface = ShellSurface::new(concrete, RAFT_THICKNESS);
    let nodes = surface.grid([count; 2], ShellPattern::Quadrilaterals, |x, y| {
        [RAFT_SIDE * (x - 0.5), RAFT_SIDE * (y - 0.5), 0.0]
    })?;
    Ok(Raft { surface, nodes })
}

/// ∫N of both ends of a cell over its part under the load, over the side of the load.
fn loaded_parts(cell: &Range<f64>) -> [f64; 2] {
    let low = cell.start.max(-0.5 * LOAD_SIDE);
    let high = cell.end.min(0.5 * LOAD_SIDE);
    if high <= low {
        return [0.0; 2];
    }
    let end_part = (0.5 * (low + high) - cell.start) / (cell.end - cell.start);
    [1.0 - end_part, end_part].map(|part| part * (high - low) / LOAD_SIDE)
}

/// Downward forces at the nodes, by the shape functions.
fn loads(nodes: &[Vec<usize>]) -> Vec<(usize, f64)> {
    let count = nodes.len() - 1;
    let ends: Vec<f64> = (0..=count).map(|k| RAFT_SIDE * (k as f64 / count as f64 - 0.5)).collect();
    let mut along = vec![0.0; count + 1];
    for k in 0..count {
        let parts = loaded_parts(&(ends[k]..ends[k + 1]));
        along[k] += parts[0];
        along[k + 1] += parts[1];
    }
    let mut forces = Vec::new();
    for (row, part_x) in nodes.iter().zip(&along) {
        for (&node, part_y) in row.iter().zip(&along) {
            let force = TOTAL_LOAD * part_x * part_y;
            if force > 0.0 {
                forces.push((node, force));
            }
        }
    }
    forces
}

/// Enters the settlements (mm) and moments (kNm/m) that the tables list.
fn put(
    rows: &mut BenchmarkRows,
    ground: &str,
    mesh: &str,
    raft: &Raft,
    displacements: &[[f64; 6]],
) -> Result<(), AnyError> {
    let nodes = &raft.nodes;
    let count = nodes.len() - 1;
    let half = count / 2;
    let quarter = 3 * count / 4;
    let settlement = |node: usize| -1e3 * displacements[node][2];
    let work: f64 = loads(nodes).iter().map(|&(node, force)| force * settlement(node)).sum();
    rows.put(ground, "mean settlement under the load, mm", mesh, work / TOTAL_LOAD);
    for (quantity, [i, j]) in [
        ("settlement middle, mm", [half, half]),
        ("settlement middle of a side, mm", [count, half]),
        ("settlement corner, mm", [count, count]),
    ] {
        rows.put(ground, quantity, mesh, settlement(nodes[i][j]));
    }
    for (quantity, axis, [i, j]) in [
        ("moment mx = my under the load, kNm/m", 0, [half, half]),
        ("moment mx at quarter of the middle line (x = L/4, y = 0), kNm/m", 0, [quarter, half]),
        ("moment my at the middle of the side x = L/2, kNm/m", 1, [count, half]),
    ] {
        let moment = raft
            .surface
            .mean_at(nodes[i][j], displacements, |resultants| 1e-3 * resultants.moments[axis])?;
        rows.put(ground, quantity, mesh, moment);
    }
    Ok(())
}

fn on_springs(rows: &mut BenchmarkRows, count: usize) -> Result<(), AnyError> {
    let mut raft = raft(count)?;
    let corners: Vec<[usize; 4]> = raft
        .surface
        .shells
        .iter()
        .filter_map(|shell| shell.nodes().try_into().ok())
        .collect();
    for corners in corners {
        raft.surface.scene.add(SpringElement { nodes: corners, stiffness: 20.0e6 });
    }
    for &node in raft.nodes.iter().flatten() {
        raft.surface.scene.fix(node, &[X, Y, RZ]);
    }
    let forces: Vec<_> =
        loads(&raft.nodes).into_iter().map(|(node, force)| (node, Z, -force)).collect();
    let displacements = raft.surface.scene.displacements(&forces);
    let mesh = format!("Shell4 {count}x{count}");
    put(rows, "Winkler 20 MN/m3", &mesh, &raft, &displacements)
}

/// The raft on cells of the crate's half-space, frictionless and without uplift.
fn on_half_space(rows: &mut BenchmarkRows, count: usize, cells: usize) -> Result<(), AnyError> {
    let raft = raft(count)?;
    let model = FemModel::on_base(raft.surface.scene.mesh.clone())?;
    let half_side = 0.5 * RAFT_SIDE;
    let plan =
        Plan::rectangle(-half_side..half_side, -half_side..half_side, cells)?.without_overhang()?;
    let soil = Soil::new(80.0e6 / 2.6, 0.3, 1900.0)?;
    let ground = ElasticGround::in_plan(soil, plan)?;
    let mut builder =
        Simulation::builder(0.01).structure(model.clone()).ground(ground).gravity(1e-6);
    for (node, force) in loads(&raft.nodes) {
        builder = builder.load(Load::constant(model.row(node, Z)?, -force));
    }
    let simulation = builder.interface(Coulomb::new(0.0)?.with_tensile_strength(1.0e9)?).build()?;
    let displacement = simulation.static_displacement();
    let mut node_displacements = Vec::new();
    for node in 0..model.mesh().nodes().len() {
        node_displacements.push(
            CLAMPED_DIRECTIONS
                .map(|direction| model.dof(node, direction).map_or(0.0, |dof| displacement[dof])),
        );
    }
    let mesh = format!("Shell4 {count}x{count}, {cells}x{cells} cells");
    let ground = "half-space E=80 MPa nu=0.3";
    put(rows, ground, &mesh, &raft, &node_displacements)?;
    let elements = simulation.ground().elements().iter();
    let states = simulation.state().contact.iter();
    let force: f64 =
        elements.zip(states).map(|(element, state)| element.area() * state.pressure).sum();
    rows.put(ground, "force of the ground / P", &mesh, force / TOTAL_LOAD);
    Ok(())
}

pub(super) fn run(rows: &mut BenchmarkRows, short: bool) -> Result<(), AnyError> {
    for count in [8, 16, 24, 32] {
        on_springs(rows, count)?;
    }
    for (count, cells) in [(8, 8), (16, 8), (16, 16), (24, 24), (32, 16), (32, 32)] {
        if !short || count < 24 {
            on_half_space(rows, count, cells)?;
        }
    }
    Ok(())
}
