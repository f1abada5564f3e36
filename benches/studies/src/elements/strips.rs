//! Cantilevers of shells: MacNeal & Harder's straight, curved and twisted ones, NAFEMS LE5.

use std::f64::consts::FRAC_PI_2;

use basemat::fem::Material;
use basemat_problems::supported::{CLAMPED_DIRECTIONS, NodalLoad, X, Y, Z};

use super::row::BenchmarkRows;
use super::surface::{ShellPattern, ShellSurface, spread};
use crate::AnyError;

const SHELL_PATTERNS: [ShellPattern; 2] = [ShellPattern::Quadrilaterals, ShellPattern::Rising];

fn straight(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    for (shape, signs) in
        [("rectangles", [0.0, 0.0]), ("parallelograms", [1.0, 1.0]), ("trapezoids", [1.0, -1.0])]
    {
        for count in [6, 12, 24] {
            for pattern in SHELL_PATTERNS {
                let pitch = 6.0 / count as f64;
                let mut strip = ShellSurface::new(Material::new(1.0e7, 0.3, 0.0)?, 0.1);
                let nodes = strip.grid([count, 1], pattern, |along, across| {
                    let column = (count as f64 * along).round();
                    let is_inner = column > 0.0 && column < count as f64;
                    let sign = if column % 2.0 == 1.0 { signs[0] } else { signs[1] };
                    let slant = if is_inner { 0.1 * pitch * sign } else { 0.0 };
                    [6.0 * along + slant * (1.0 - 2.0 * across), 0.2 * across, 0.0]
                })?;
                for &node in &nodes[0] {
                    strip.scene.fix(node, &CLAMPED_DIRECTIONS);
                }
                let tip = &nodes[count];
                let torque: Vec<NodalLoad> = vec![(tip[0], Z, -5.0), (tip[1], Z, 5.0)];
                let cases = [
                    ("extension", spread(tip, X, 1.0)),
                    ("in-plane shear", spread(tip, Y, 1.0)),
                    ("out-of-plane shear", spread(tip, Z, 1.0)),
                    ("twist", torque),
                ];
                for (quantity, loads) in cases {
                    let benchmark = format!("MacNeal-Harder straight cantilever, {shape}");
                    let mesh = format!("{} {count}x1", pattern.element());
                    rows.put(&benchmark, quantity, &mesh, strip.scene.work(&loads));
                }
            }
        }
    }
    Ok(())
}

fn curved(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    for [nx, ny] in [[6, 1], [12, 2], [24, 4]] {
        for pattern in SHELL_PATTERNS {
            let mut strip = ShellSurface::new(Material::new(1.0e7, 0.25, 0.0)?, 0.1);
            let nodes = strip.grid([nx, ny], pattern, |along, across| {
                let angle = FRAC_PI_2 * along;
                let sine = angle.sin();
                let cosine = angle.cos();
                let radius = 4.12 + 0.2 * across;
                [radius * cosine, radius * sine, 0.0]
            })?;
            for &node in &nodes[0] {
                strip.scene.fix(node, &CLAMPED_DIRECTIONS);
            }
            for (quantity, direction) in [("in-plane", Y), ("out-of-plane", Z)] {
                let displacement = strip.scene.solve(&spread(&nodes[nx], direction, 1.0));
                let sum: f64 = nodes[nx].iter().map(|&node| displacement(node, direction)).sum();
                let mesh = format!("{} {nx}x{ny}", pattern.element());
                let mean = sum / (ny + 1) as f64;
                rows.put("MacNeal-Harder curved cantilever", quantity, &mesh, mean);
            }
        }
    }
    Ok(())
}

fn twisted(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    for [nx, ny] in [[12, 2], [24, 4], [48, 8]] {
        for pattern in SHELL_PATTERNS {
            // No table of shells has the thin strip; thin beams have 5.3161e-3 and 1.2964e-3.
            for (thickness, force) in [(0.32, 1.0), (0.0032, 1e-6)] {
                let mut strip = ShellSurface::new(Material::new(2.9e7, 0.22, 0.0)?, thickness);
                let nodes = strip.grid([nx, ny], pattern, |along, across| {
                    let angle = FRAC_PI_2 * along;
                    let sine = angle.sin();
                    let cosine = angle.cos();
                    let offset = 1.1 * (across - 0.5);
                    [12.0 * along, offset * cosine, offset * sine]
                })?;
                for &node in &nodes[0] {
                    strip.scene.fix(node, &CLAMPED_DIRECTIONS);
                }
                for (quantity, direction) in
                    [("along the width of the tip (in-plane)", Z), ("across (out-of-plane)", Y)]
                {
                    let displacement = strip.scene.solve(&spread(&nodes[nx], direction, force));
                    let benchmark = format!("MacNeal-Harder twisted beam t={thickness}");
                    let mesh = format!("{} {nx}x{ny}", pattern.element());
                    rows.put(
                        &benchmark,
                        quantity,
                        &mesh,
                        displacement(nodes[nx][ny / 2], direction),
                    );
                }
            }
        }
    }
    Ok(())
}

/// Point at a distance (m) along the middle line of the Z-section, 4 m long.
fn z_section(distance: f64) -> [f64; 2] {
    if distance <= 1.0 {
        [1.0 - distance, 1.0]
    } else if distance <= 3.0 {
        [0.0, 2.0 - distance]
    } else {
        [3.0 - distance, -1.0]
    }
}

fn z_beam(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    for factor in [1, 2, 4] {
        for pattern in [ShellPattern::Quadrilaterals, ShellPattern::Falling] {
            let along = 8 * factor;
            let around = 4 * factor;
            let mut beam = ShellSurface::new(Material::new(210.0e9, 0.3, 0.0)?, 0.1);
            let nodes = beam.grid([along, around], pattern, |along, around| {
                let [y, z] = z_section(4.0 * around);
                [10.0 * along, y, z]
            })?;
            for &node in &nodes[0] {
                beam.scene.fix(node, &CLAMPED_DIRECTIONS);
            }
            let end = &nodes[along];
            let mut loads = spread(&end[..=factor], Y, 0.6e6);
            loads.extend(spread(&end[around - factor..], Y, -0.6e6));
            let displacements = beam.scene.displacements(&loads);
            let mean = beam.mean_at(nodes[2 * factor][0], &displacements, |resultants| {
                1e-6 * resultants.membrane[0] / 0.1
            })?;
            let mesh = format!("{} {along}x({factor}+{}+{factor})", pattern.element(), 2 * factor);
            let quantity = "sxx at the flange tip, x = 2.5, MPa";
            rows.put("NAFEMS LE5 Z-section in torsion", quantity, &mesh, mean);
        }
    }
    Ok(())
}

pub(super) fn run(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    straight(rows)?;
    curved(rows)?;
    twisted(rows)?;
    z_beam(rows)
}
