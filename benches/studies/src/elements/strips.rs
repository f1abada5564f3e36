//! Cantilevers of shells: MacNeal & Harder's straight, curved and twisted ones, NAFEMS LE5.

use std::f64::consts::FRAC_PI_2;

use basemat::fem::{Material, ShellResultants};
use basemat_problems::supported::{CLAMPED, Load, X, Y, Z};

use super::row::Rows;
use super::surface::{Pattern, Surface, spread};
use crate::AnyError;

const PATTERNS: [Pattern; 2] = [Pattern::Quadrilaterals, Pattern::Rising];

fn straight(rows: &mut Rows) -> Result<(), AnyError> {
    for (shape, signs) in
        [("rectangles", [0.0, 0.0]), ("parallelograms", [1.0, 1.0]), ("trapezoids", [1.0, -1.0])]
    {
        for count in [6, 12, 24] {
            for pattern in PATTERNS {
                let pitch = 6.0 / count as f64;
                let mut strip = Surface::new(Material::new(1.0e7, 0.3, 0.0)?, 0.1);
                let nodes = strip.grid([count, 1], pattern, |along, across| {
                    let column = (count as f64 * along).round();
                    let inner = column > 0.0 && column < count as f64;
                    let sign = if column % 2.0 == 1.0 { signs[0] } else { signs[1] };
                    let slant = if inner { 0.1 * pitch * sign } else { 0.0 };
                    [6.0 * along + slant * (1.0 - 2.0 * across), 0.2 * across, 0.0]
                })?;
                for &node in &nodes[0] {
                    strip.scene.hold(node, &CLAMPED);
                }
                let [low, high] = [0, 1].map(|side| nodes[count][side]);
                let force = |direction| vec![(low, direction, 0.5), (high, direction, 0.5)];
                let torque: Vec<Load> = vec![(low, Z, -5.0), (high, Z, 5.0)];
                let cases = [
                    ("extension", force(X)),
                    ("in-plane shear", force(Y)),
                    ("out-of-plane shear", force(Z)),
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

fn curved(rows: &mut Rows) -> Result<(), AnyError> {
    for [nx, ny] in [[6, 1], [12, 2], [24, 4]] {
        for pattern in PATTERNS {
            let mut strip = Surface::new(Material::new(1.0e7, 0.25, 0.0)?, 0.1);
            let nodes = strip.grid([nx, ny], pattern, |along, across| {
                let (sine, cosine) = (FRAC_PI_2 * along).sin_cos();
                let radius = 4.12 + 0.2 * across;
                [radius * cosine, radius * sine, 0.0]
            })?;
            for &node in &nodes[0] {
                strip.scene.hold(node, &CLAMPED);
            }
            for (quantity, direction) in [("in-plane", Y), ("out-of-plane", Z)] {
                let found = strip.scene.solve(&spread(&nodes[nx], direction, 1.0));
                let sum: f64 = nodes[nx].iter().map(|&node| found(node, direction)).sum();
                let mesh = format!("{} {nx}x{ny}", pattern.element());
                let mean = sum / (ny + 1) as f64;
                rows.put("MacNeal-Harder curved cantilever", quantity, &mesh, mean);
            }
        }
    }
    Ok(())
}

fn twisted(rows: &mut Rows) -> Result<(), AnyError> {
    for [nx, ny] in [[12, 2], [24, 4], [48, 8]] {
        for pattern in PATTERNS {
            // The thin strip stands in no table of shells: thin beams have 5.3161e-3 and 1.2964e-3.
            for (thickness, force) in [(0.32, 1.0), (0.0032, 1e-6)] {
                let mut strip = Surface::new(Material::new(2.9e7, 0.22, 0.0)?, thickness);
                let nodes = strip.grid([nx, ny], pattern, |along, across| {
                    let (sine, cosine) = (FRAC_PI_2 * along).sin_cos();
                    let place = 1.1 * (across - 0.5);
                    [12.0 * along, place * cosine, place * sine]
                })?;
                for &node in &nodes[0] {
                    strip.scene.hold(node, &CLAMPED);
                }
                for (quantity, direction) in
                    [("along the width of the tip (in-plane)", Z), ("across (out-of-plane)", Y)]
                {
                    let found = strip.scene.solve(&spread(&nodes[nx], direction, force));
                    let benchmark = format!("MacNeal-Harder twisted beam t={thickness}");
                    let mesh = format!("{} {nx}x{ny}", pattern.element());
                    rows.put(&benchmark, quantity, &mesh, found(nodes[nx][ny / 2], direction));
                }
            }
        }
    }
    Ok(())
}

/// Place along the middle line of the Z-section, 4 m long.
fn z_section(place: f64) -> [f64; 2] {
    if place <= 1.0 {
        [1.0 - place, 1.0]
    } else if place <= 3.0 {
        [0.0, 2.0 - place]
    } else {
        [3.0 - place, -1.0]
    }
}

fn z_beam(rows: &mut Rows) -> Result<(), AnyError> {
    for factor in [1, 2, 4] {
        for pattern in [Pattern::Quadrilaterals, Pattern::Falling] {
            let (along, around) = (8 * factor, 4 * factor);
            let mut beam = Surface::new(Material::new(210.0e9, 0.3, 0.0)?, 0.1);
            let nodes = beam.grid([along, around], pattern, |along, around| {
                let [y, z] = z_section(4.0 * around);
                [10.0 * along, y, z]
            })?;
            for &node in &nodes[0] {
                beam.scene.hold(node, &CLAMPED);
            }
            let end = &nodes[along];
            let mut loads = spread(&end[..=factor], Y, 0.6e6);
            loads.extend(spread(&end[around - factor..], Y, -0.6e6));
            let all = beam.scene.displacements(&loads);
            let stress = |own: &ShellResultants| 1e-6 * own.membrane[0] / 0.1;
            let mean = beam.mean_at(nodes[2 * factor][0], &all, stress)?;
            let mesh = format!("{} {along}x({factor}+{}+{factor})", pattern.element(), 2 * factor);
            let quantity = "sxx at the flange tip, x = 2.5, MPa";
            rows.put("NAFEMS LE5 Z-section in torsion", quantity, &mesh, mean);
        }
    }
    Ok(())
}

pub(super) fn run(rows: &mut Rows) -> Result<(), AnyError> {
    straight(rows)?;
    curved(rows)?;
    twisted(rows)?;
    z_beam(rows)
}
