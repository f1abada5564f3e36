//! Vibration of square plates of shells: NAFEMS FV12, FV16, simply supported thin and thick.

use basemat::fem::{MassKind, Material};
use basemat_problems::supported::{CLAMPED_DIRECTIONS, RX, RY, RZ, X, Y, Z};

use super::row::BenchmarkRows;
use super::surface::{ShellPattern, ShellSurface};
use crate::AnyError;

struct SquarePlate {
    surface: ShellSurface,
    nodes: Vec<Vec<usize>>,
}

/// A plate of 10 × 10 m that moves across its plane only, and its nodes.
fn plate(count: usize, pattern: ShellPattern, thickness: f64) -> Result<SquarePlate, AnyError> {
    let mut surface = ShellSurface::new(Material::new(200.0e9, 0.3, 8000.0)?, thickness);
    let nodes = surface.grid([count; 2], pattern, |x, y| [10.0 * x, 10.0 * y, 0.0])?;
    for &node in nodes.iter().flatten() {
        surface.scene.fix(node, &[X, Y, RZ]);
    }
    Ok(SquarePlate { surface, nodes })
}

/// Enters the frequencies of modes `first` to `last`.
fn put(
    rows: &mut BenchmarkRows,
    benchmarks: &[&str],
    mesh: &str,
    plate: &SquarePlate,
    first: usize,
    last: usize,
    shift: f64,
) {
    let modes = plate.surface.scene.modes(MassKind::Consistent, last, shift);
    for (mode, vibration) in modes.iter().enumerate().skip(first - 1) {
        for benchmark in benchmarks {
            rows.put(benchmark, &format!("mode {}, Hz", mode + 1), mesh, vibration.frequency);
        }
    }
}

pub(super) fn run(rows: &mut BenchmarkRows, short: bool) -> Result<(), AnyError> {
    for count in [8, 16, 32].into_iter().filter(|count| !short || *count < 16) {
        for pattern in [ShellPattern::Quadrilaterals, ShellPattern::Rising] {
            let mesh = format!("{} {count}x{count}", pattern.element());
            // The free plate has three motions without frequency.
            let free = plate(count, pattern, 0.05)?;
            let name = "NAFEMS FV12 free thin square plate";
            put(rows, &[name], &mesh, &free, 4, 9, 30.0);
            let mut cantilever = plate(count, pattern, 0.05)?;
            for &node in &cantilever.nodes[0] {
                cantilever.surface.scene.fix(node, &CLAMPED_DIRECTIONS);
            }
            let name = "NAFEMS FV16 cantilevered thin square plate";
            put(rows, &[name], &mesh, &cantilever, 1, 6, 0.0);
            for (thickness, last, names) in [
                (
                    0.05,
                    6,
                    [
                        "NAFEMS simply supported square plate, thin",
                        "simply supported Mindlin plate t=0.05, closed form",
                    ],
                ),
                (
                    1.0,
                    8,
                    [
                        "NAFEMS simply supported square plate, thick (test 21)",
                        "simply supported Mindlin plate t=1.0, closed form",
                    ],
                ),
            ] {
                let SquarePlate { mut surface, nodes } = plate(count, pattern, thickness)?;
                for k in 0..=count {
                    for node in [nodes[0][k], nodes[count][k]] {
                        surface.scene.fix(node, &[Z, RX]);
                    }
                    for node in [nodes[k][0], nodes[k][count]] {
                        surface.scene.fix(node, &[Z, RY]);
                    }
                }
                let hard_plate = SquarePlate { surface, nodes };
                put(rows, &names, &mesh, &hard_plate, 1, last, 0.0);
            }
        }
    }
    Ok(())
}
