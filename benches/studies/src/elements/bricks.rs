//! Bricks: MacNeal & Harder's cantilevers and thick cylinder, NAFEMS LE10.

use std::f64::consts::FRAC_PI_2;

use basemat::fem::{Direction, Hex8, Material, Spring};
use basemat_problems::supported::{HINGED, Load, X, Y, Z};

use super::block::Block;
use super::row::Rows;
use crate::AnyError;

fn straight(rows: &mut Rows) -> Result<(), AnyError> {
    let material = Material::new(1.0e7, 0.3, 0.0)?;
    for (shape, signs) in
        [("rectangles", [0.0, 0.0]), ("parallelograms", [1.0, 1.0]), ("trapezoids", [1.0, -1.0])]
    {
        for count in [6, 12, 24] {
            let pitch = 6.0 / count as f64;
            let mut block = Block::new([count, 1, 1], material, |[i, j, k]| {
                let inner = i > 0 && i < count;
                let slant = if inner { 0.1 * pitch * signs[(i + 1) % 2] } else { 0.0 };
                let [y, z] = [j as f64, k as f64];
                [pitch * i as f64 + slant * (1.0 - 2.0 * y), 0.2 * y, 0.1 * z]
            });
            for (node, _) in block.section(0) {
                block.scene.hold(node, &HINGED);
            }
            let tip = block.section(count);
            let force = |axis: usize| -> Vec<Load> {
                tip.iter().map(|&(node, part)| (node, HINGED[axis], part)).collect()
            };
            let torque = tip.iter().flat_map(|&(node, _)| {
                let [_, y, z] = block.scene.mesh.nodes()[node];
                [(node, Z, 1.25 * (10.0 * y - 1.0)), (node, Y, -2.5 * (20.0 * z - 1.0))]
            });
            let loads = [force(0), force(1), force(2), torque.collect()];
            let names = ["extension", "in-plane shear", "out-of-plane shear", "twist"];
            for (quantity, loads) in names.into_iter().zip(loads) {
                let benchmark = format!("MacNeal-Harder straight cantilever, {shape}");
                let mesh = format!("{count}x1x1");
                rows.put(&benchmark, quantity, &mesh, block.scene.work(&loads));
            }
        }
    }
    Ok(())
}

/// Displacement in the direction of a unit force spread over the section of the tip: the plain mean of its nodes, or
/// the mean with the weights of the load.
fn tip(block: &Block, direction: Direction, is_plain: bool) -> f64 {
    let nodes = block.section(block.counts[0]);
    let loads: Vec<Load> = nodes.iter().map(|&(node, part)| (node, direction, part)).collect();
    let found = block.scene.solve(&loads);
    let plain = 1.0 / nodes.len() as f64;
    let weight = |part: f64| if is_plain { plain } else { part };
    nodes.iter().map(|&(node, part)| weight(part) * found(node, direction)).sum()
}

fn curved(rows: &mut Rows) -> Result<(), AnyError> {
    let material = Material::new(1.0e7, 0.25, 0.0)?;
    for [nx, ny, nz] in [[6, 1, 1], [12, 2, 1], [24, 2, 2]] {
        // The radius runs backwards, for bricks whose volume is positive.
        let mut block = Block::new([nx, ny, nz], material, |[i, j, k]| {
            let (sine, cosine) = (FRAC_PI_2 * i as f64 / nx as f64).sin_cos();
            let radius = 4.32 - 0.2 * j as f64 / ny as f64;
            [radius * cosine, radius * sine, 0.1 * k as f64 / nz as f64]
        });
        for (node, _) in block.section(0) {
            block.scene.hold(node, &HINGED);
        }
        for (quantity, direction) in [("in-plane", Y), ("out-of-plane", Z)] {
            let value = tip(&block, direction, true);
            let mesh = format!("{nx}x{ny}x{nz}");
            rows.put("MacNeal-Harder curved cantilever", quantity, &mesh, value);
        }
    }
    Ok(())
}

fn twisted(rows: &mut Rows) -> Result<(), AnyError> {
    let material = Material::new(2.9e7, 0.22, 0.0)?;
    for [nx, ny, nz] in [[12, 2, 1], [24, 4, 2]] {
        let mut block = Block::new([nx, ny, nz], material, |[i, j, k]| {
            let part = i as f64 / nx as f64;
            let (sine, cosine) = (FRAC_PI_2 * part).sin_cos();
            let [y, z] = [1.1 * (j as f64 / ny as f64 - 0.5), 0.32 * (k as f64 / nz as f64 - 0.5)];
            [12.0 * part, y * cosine - z * sine, y * sine + z * cosine]
        });
        for (node, _) in block.section(0) {
            block.scene.hold(node, &HINGED);
        }
        for (quantity, direction) in
            [("along the width of the tip (in-plane)", Z), ("across (out-of-plane)", Y)]
        {
            let value = tip(&block, direction, false);
            let mesh = format!("{nx}x{ny}x{nz}");
            rows.put("MacNeal-Harder twisted beam t=0.32", quantity, &mesh, value);
        }
    }
    Ok(())
}

fn cylinder(rows: &mut Rows) -> Result<(), AnyError> {
    const RADII: [f64; 6] = [3.0, 3.5, 4.2, 5.2, 6.75, 9.0];
    let angle = 10.0_f64.to_radians();
    let (sine, cosine) = angle.sin_cos();
    for poisson in [0.3, 0.49, 0.499, 0.4999] {
        let material = Material::new(1000.0, poisson, 0.0)?;
        let mut block = Block::new([5, 1, 1], material, |[i, j, k]| {
            let (sine, cosine) = (angle * j as f64).sin_cos();
            [RADII[i] * cosine, RADII[i] * sine, k as f64]
        });
        for i in 0..6 {
            for k in 0..2 {
                let nodes = [block.node([i, 0, k]), block.node([i, 1, k])];
                block.scene.hold(nodes[0], &[Y, Z]);
                // The other radial face moves in its plane: a stiff spring across it.
                let [x, y, z] = block.scene.mesh.nodes()[nodes[1]];
                let support = block.scene.node([x + sine, y - cosine, z]);
                block.scene.add(Spring::axial_in_space([nodes[1], support], 1.0e10)?);
                block.scene.hold(nodes[1], &[Z]);
                block.scene.hold(support, &HINGED);
            }
        }
        let force = 3.0 * angle / 4.0;
        let mut loads: Vec<Load> = Vec::new();
        for k in 0..2 {
            let [lower, upper] = [block.node([0, 0, k]), block.node([0, 1, k])];
            let own = [(lower, X, force), (upper, X, force * cosine), (upper, Y, force * sine)];
            loads.extend(own);
        }
        let value = block.scene.solve(&loads)(block.node([0, 0, 0]), X);
        let benchmark = format!("MacNeal-Harder thick cylinder, nu = {poisson} (Lame)");
        rows.put(&benchmark, "ur inside", "5x1x1", value);
    }
    Ok(())
}

/// Forces of a pressure (Pa) downwards on a level quadrilateral, with 2 × 2 points.
fn pressure(block: &Block, nodes: [usize; 4], pressure: f64) -> Vec<Load> {
    const SIDES: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let points = block.scene.points(&nodes);
    let mut loads = Vec::new();
    for point in SIDES {
        let [xi, eta] = point.map(|side| side / 3.0_f64.sqrt());
        let mut tangent = [[0.0; 2]; 2];
        for ([a, b], at) in SIDES.iter().zip(&points) {
            for axis in 0..2 {
                tangent[0][axis] += 0.25 * a * (1.0 + b * eta) * at[axis];
                tangent[1][axis] += 0.25 * b * (1.0 + a * xi) * at[axis];
            }
        }
        let area = tangent[0][0] * tangent[1][1] - tangent[0][1] * tangent[1][0];
        for ([a, b], node) in SIDES.iter().zip(nodes) {
            let shape = 0.25 * (1.0 + a * xi) * (1.0 + b * eta);
            loads.push((node, Z, -pressure * area * shape));
        }
    }
    loads
}

fn elliptic_plate(rows: &mut Rows, around: usize) -> Result<(), AnyError> {
    let (radial, levels) = (around * 2 / 3, around / 3);
    let material = Material::new(210.0e9, 0.3, 0.0)?;
    let mut block = Block::new([radial, around, levels], material, |[i, j, k]| {
        let (sine, cosine) = (FRAC_PI_2 * j as f64 / around as f64).sin_cos();
        let part = i as f64 / radial as f64;
        let height = 0.6 * k as f64 / levels as f64;
        [(2.0 + 1.25 * part) * cosine, (1.0 + 1.75 * part) * sine, height]
    });
    for k in 0..=levels {
        for i in 0..=radial {
            let ends = [block.node([i, 0, k]), block.node([i, around, k])];
            block.scene.hold(ends[0], &[Y]);
            block.scene.hold(ends[1], &[X]);
        }
        for j in 0..=around {
            let node = block.node([radial, j, k]);
            block.scene.hold(node, if 2 * k == levels { &HINGED } else { &[X, Y] });
        }
    }
    let mut loads = Vec::new();
    for i in 0..radial {
        for j in 0..around {
            let [_, _, _, _, a, b, c, d] = block.corners([i, j, levels - 1]);
            loads.extend(pressure(&block, [a, b, c, d], 1.0e6));
        }
    }
    let found = block.scene.solve(&loads);
    let nodes = block.corners([0, 0, levels - 1]);
    let displacement: Vec<f64> =
        nodes.iter().flat_map(|&node| HINGED.map(|direction| found(node, direction))).collect();
    let stresses =
        Hex8::new(nodes, material).stresses(&block.scene.points(&nodes), &displacement)?;
    let mesh = format!("{around}x{radial}x{levels}");
    rows.put(
        "NAFEMS LE10 thick elliptic plate",
        "syy at D from the Gauss points, MPa",
        &mesh,
        1e-6 * stresses[4][1],
    );
    rows.put(
        "NAFEMS LE10, own extension",
        "uz at D, m",
        &mesh,
        found(block.node([0, 0, levels]), Z),
    );
    Ok(())
}

pub(super) fn run(rows: &mut Rows, short: bool) -> Result<(), AnyError> {
    straight(rows)?;
    curved(rows)?;
    twisted(rows)?;
    cylinder(rows)?;
    for around in [6, 12, 18, 24].into_iter().filter(|around| !short || *around < 12) {
        elliptic_plate(rows, around)?;
    }
    Ok(())
}
