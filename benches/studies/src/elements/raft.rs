//! A raft of shells under a load on its middle, on springs and on the half-space.

use std::ops::Range;

use basemat::bem::plan::Plan;
use basemat::coupled::{Load, SimulationBuilder};
use basemat::fem::{Direction, Element, MassKind, Material};
use basemat::prelude::*;
use basemat::structure::FemModel;
use basemat_problems::supported::{CLAMPED, RZ, X, Y, Z};

use super::row::Rows;
use super::surface::{Pattern, Surface};
use crate::AnyError;

/// Side and thickness of the raft, m; side of the load, m, and the load, N.
const SIDE: f64 = 12.0;
const THICKNESS: f64 = 0.8;
const PATCH: f64 = 1.5;
const FORCE: f64 = 4.0e6;

/// Springs under a level rectangle, N/m³, that move with its shape functions.
#[derive(Debug)]
struct Bed([usize; 4], f64);

impl Element for Bed {
    fn nodes(&self) -> &[usize] {
        &self.0
    }

    fn directions(&self) -> &[Direction] {
        &[Direction::Z]
    }

    fn stiffness(&self, points: &[[f64; 3]], matrix: &mut [f64]) {
        let area = (points[2][0] - points[0][0]) * (points[2][1] - points[0][1]);
        for i in 0..4 {
            for j in 0..4 {
                let part = |axis: usize| {
                    let is_same = (points[i][axis] - points[j][axis]).abs() < 1e-9;
                    if is_same { 1.0 / 3.0 } else { 1.0 / 6.0 }
                };
                matrix[4 * i + j] += self.1 * area * part(0) * part(1);
            }
        }
    }

    fn mass(&self, _: &[[f64; 3]], _: MassKind, _: &mut [f64]) {}
}

/// The raft of `count` × `count` shells, and its nodes.
fn raft(count: usize) -> Result<(Surface, Vec<Vec<usize>>), AnyError> {
    let concrete = Material::new(30.0e9, 0.2, 2400.0)?;
    let mut raft = Surface::new(concrete, THICKNESS);
    let nodes = raft.grid([count; 2], Pattern::Quadrilaterals, |x, y| {
        [SIDE * (x - 0.5), SIDE * (y - 0.5), 0.0]
    })?;
    Ok((raft, nodes))
}

/// ∫N of both ends of a cell over its part under the load, over the side of the load.
fn parts(cell: &Range<f64>) -> [f64; 2] {
    let (low, high) = (cell.start.max(-0.5 * PATCH), cell.end.min(0.5 * PATCH));
    if high <= low {
        return [0.0; 2];
    }
    let far = (0.5 * (low + high) - cell.start) / (cell.end - cell.start);
    [1.0 - far, far].map(|part| part * (high - low) / PATCH)
}

/// Downward forces at the nodes, by the shape functions.
fn loads(nodes: &[Vec<usize>]) -> Vec<(usize, f64)> {
    let count = nodes.len() - 1;
    let place = |k: usize| SIDE * (k as f64 / count as f64 - 0.5);
    let mut along = vec![0.0; count + 1];
    for k in 0..count {
        let [near, far] = parts(&(place(k)..place(k + 1)));
        along[k] += near;
        along[k + 1] += far;
    }
    let all = nodes.iter().zip(&along).flat_map(|(row, own)| {
        row.iter().zip(&along).map(move |(&node, other)| (node, FORCE * own * other))
    });
    all.filter(|(_, force)| *force > 0.0).collect()
}

/// Settlements (mm) and moments (kNm/m) that the tables list.
fn put(
    rows: &mut Rows,
    [ground, mesh]: [&str; 2],
    (raft, nodes): (&Surface, &[Vec<usize>]),
    all: &[[f64; 6]],
) -> Result<(), AnyError> {
    let count = nodes.len() - 1;
    let (half, quarter) = (count / 2, 3 * count / 4);
    let settlement = |node: usize| -1e3 * all[node][2];
    let under = loads(nodes).iter().map(|&(node, force)| force * settlement(node)).sum::<f64>();
    rows.put(ground, "mean settlement under the load, mm", mesh, under / FORCE);
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
        let moment = raft.mean_at(nodes[i][j], all, |own| 1e-3 * own.moments[axis])?;
        rows.put(ground, quantity, mesh, moment);
    }
    Ok(())
}

fn on_springs(rows: &mut Rows, count: usize) -> Result<(), AnyError> {
    let (mut raft, nodes) = raft(count)?;
    let corners: Vec<[usize; 4]> =
        raft.shells.iter().filter_map(|shell| shell.nodes().try_into().ok()).collect();
    for corners in corners {
        raft.scene.add(Bed(corners, 20.0e6));
    }
    for &node in nodes.iter().flatten() {
        raft.scene.hold(node, &[X, Y, RZ]);
    }
    let forces: Vec<_> = loads(&nodes).into_iter().map(|(node, force)| (node, Z, -force)).collect();
    let all = raft.scene.displacements(&forces);
    let mesh = format!("Shell4 {count}x{count}");
    put(rows, ["Winkler 20 MN/m3", &mesh], (&raft, &nodes), &all)
}

/// Cells of the crate's half-space under the raft, frictionless and held down.
fn on_half_space(rows: &mut Rows, count: usize, cells: usize) -> Result<(), AnyError> {
    let (raft, nodes) = raft(count)?;
    let model = FemModel::on_base(raft.scene.mesh.clone())?;
    let half = 0.5 * SIDE;
    let plan = Plan::rectangle(-half..half, -half..half, cells)?.without_overhang()?;
    let soil = Soil::new(80.0e6 / 2.6, 0.3, 1900.0)?;
    let ground = ElasticGround::in_plan(soil, plan)?;
    let forces = loads(&nodes).into_iter().map(|(node, force)| {
        let row = model.row(node, Z)?;
        Ok::<_, basemat::Error>(Load::constant(row, -force))
    });
    let forces: Vec<Load> = forces.collect::<Result<_, _>>()?;
    let builder = Simulation::builder(0.01).structure(model.clone()).ground(ground).gravity(1e-6);
    let simulation = forces
        .into_iter()
        .fold(builder, SimulationBuilder::load)
        .interface(Coulomb::new(0.0)?.with_tensile_strength(1.0e9)?)
        .build()?;
    let displacement = simulation.static_displacement();
    let of_node = |node: usize| {
        CLAMPED.map(|direction| model.dof(node, direction).map_or(0.0, |dof| displacement[dof]))
    };
    let all: Vec<[f64; 6]> = (0..model.mesh().nodes().len()).map(of_node).collect();
    let mesh = format!("Shell4 {count}x{count}, {cells}x{cells} cells");
    let ground = "half-space E=80 MPa nu=0.3";
    put(rows, [ground, &mesh], (&raft, &nodes), &all)?;
    let elements = simulation.ground().elements().iter();
    let states = simulation.state().contact.iter();
    let force: f64 = elements.zip(states).map(|(own, state)| own.area() * state.pressure).sum();
    rows.put(ground, "force of the ground / P", &mesh, force / FORCE);
    Ok(())
}

pub(super) fn run(rows: &mut Rows, short: bool) -> Result<(), AnyError> {
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
