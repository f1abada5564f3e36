//! Bricks: MacNeal & Harder's cantilevers and thick cylinder, NAFEMS LE10.

use std::f64::consts::FRAC_PI_2;

use basemat::fem::{Direction, Material};
use basemat_problems::bricks::{
    BrickGrid, elliptic_plate, straight_cantilever, thick_cylinder, twisted_cantilever,
};
use basemat_problems::supported::{Y, Z};

use super::row::BenchmarkRows;
use crate::AnyError;

fn straight(rows: &mut BenchmarkRows) {
    for (shape, signs) in
        [("rectangles", [0.0, 0.0]), ("parallelograms", [1.0, 1.0]), ("trapezoids", [1.0, -1.0])]
    {
        for count in [6, 12, 24] {
            let names = ["extension", "in-plane shear", "out-of-plane shear", "twist"];
            for (quantity, value) in names.into_iter().zip(straight_cantilever(count, signs)) {
                let benchmark = format!("MacNeal-Harder straight cantilever, {shape}");
                rows.put(&benchmark, quantity, &format!("{count}x1x1"), value);
            }
        }
    }
}

/// Mean displacement of the tip in the direction of a unit force spread over it.
fn mean_tip_displacement(block: &BrickGrid, direction: Direction) -> f64 {
    let loads = block.tip_force(direction);
    let displacement = block.scene.solve(&loads);
    let weight = 1.0 / loads.len() as f64;
    loads
        .iter()
        .map(|&(node, direction, _)| weight * displacement(node, direction))
        .sum()
}

fn curved(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    let material = Material::new(1.0e7, 0.25, 0.0)?;
    for [nx, ny, nz] in [[6, 1, 1], [12, 2, 1], [24, 2, 2]] {
        // The radius decreases with j, so that the volume of the bricks is positive.
        let block = BrickGrid::cantilever([nx, ny, nz], material, |[i, j, k]| {
            let angle = FRAC_PI_2 * i as f64 / nx as f64;
            let sine = angle.sin();
            let cosine = angle.cos();
            let radius = 4.32 - 0.2 * j as f64 / ny as f64;
            [radius * cosine, radius * sine, 0.1 * k as f64 / nz as f64]
        });
        for (quantity, direction) in [("in-plane", Y), ("out-of-plane", Z)] {
            let value = mean_tip_displacement(&block, direction);
            let mesh = format!("{nx}x{ny}x{nz}");
            rows.put("MacNeal-Harder curved cantilever", quantity, &mesh, value);
        }
    }
    Ok(())
}

fn twisted(rows: &mut BenchmarkRows) {
    for counts @ [nx, ny, nz] in [[12, 2, 1], [24, 4, 2]] {
        let names = ["along the width of the tip (in-plane)", "across (out-of-plane)"];
        for (quantity, value) in names.into_iter().zip(twisted_cantilever(counts)) {
            let mesh = format!("{nx}x{ny}x{nz}");
            rows.put("MacNeal-Harder twisted beam t=0.32", quantity, &mesh, value);
        }
    }
}

fn cylinder(rows: &mut BenchmarkRows) {
    for poisson in [0.3, 0.49, 0.499, 0.4999] {
        let benchmark = format!("MacNeal-Harder thick cylinder, nu = {poisson} (Lame)");
        rows.put(&benchmark, "ur inside", "5x1x1", thick_cylinder(poisson));
    }
}

fn plate(rows: &mut BenchmarkRows, bricks_around: usize) {
    let mesh = format!("{bricks_around}x{}x{}", bricks_around * 2 / 3, bricks_around / 3);
    let [stress, deflection] = elliptic_plate(bricks_around);
    let quantity = "syy at D from the Gauss points, MPa";
    rows.put("NAFEMS LE10 thick elliptic plate", quantity, &mesh, 1e-6 * stress);
    rows.put("NAFEMS LE10, displacement at D", "uz at D, m", &mesh, deflection);
}

pub(super) fn run(rows: &mut BenchmarkRows, short: bool) -> Result<(), AnyError> {
    straight(rows);
    curved(rows)?;
    twisted(rows);
    cylinder(rows);
    for bricks_around in
        [6, 12, 18, 24].into_iter().filter(|bricks_around| !short || *bricks_around < 12)
    {
        plate(rows, bricks_around);
    }
    Ok(())
}
