//! Vibration of square plates of shells: NAFEMS FV12, FV16, simply supported thin and thick.

use basemat::fem::{MassKind, Material};
use basemat_problems::supported::{CLAMPED, RX, RY, RZ, X, Y, Z};

use super::row::Rows;
use super::surface::{Pattern, Surface};
use crate::AnyError;

/// A plate 10 × 10 m that moves across its plane only, and its nodes.
fn plate(
    count: usize,
    pattern: Pattern,
    thickness: f64,
) -> Result<(Surface, Vec<Vec<usize>>), AnyError> {
    let mut plate = Surface::new(Material::new(200.0e9, 0.3, 8000.0)?, thickness);
    let nodes = plate.grid([count; 2], pattern, |x, y| [10.0 * x, 10.0 * y, 0.0])?;
    for &node in nodes.iter().flatten() {
        plate.scene.hold(node, &[X, Y, RZ]);
    }
    Ok((plate, nodes))
}

fn put(
    rows: &mut Rows,
    benchmarks: &[&str],
    mesh: &str,
    plate: &Surface,
    (first, last, shift): (usize, usize, f64),
) {
    let modes = plate.scene.modes(MassKind::Consistent, last, shift);
    for (mode, own) in modes.iter().enumerate().skip(first - 1) {
        for benchmark in benchmarks {
            rows.put(benchmark, &format!("mode {}, Hz", mode + 1), mesh, own.frequency);
        }
    }
}

pub(super) fn run(rows: &mut Rows, short: bool) -> Result<(), AnyError> {
    for count in [8, 16, 32].into_iter().filter(|count| !short || *count < 16) {
        for pattern in [Pattern::Quadrilaterals, Pattern::Rising] {
            let mesh = format!("{} {count}x{count}", pattern.element());
            // The free plate has three motions without frequency.
            let (free, _) = plate(count, pattern, 0.05)?;
            let name = "NAFEMS FV12 free thin square plate";
            put(rows, &[name], &mesh, &free, (4, 9, 30.0));
            let (mut held, nodes) = plate(count, pattern, 0.05)?;
            for &node in &nodes[0] {
                held.scene.hold(node, &CLAMPED);
            }
            let name = "NAFEMS FV16 cantilevered thin square plate";
            put(rows, &[name], &mesh, &held, (1, 6, 0.0));
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
                let (mut hard, nodes) = plate(count, pattern, thickness)?;
                for k in 0..=count {
                    for node in [nodes[0][k], nodes[count][k]] {
                        hard.scene.hold(node, &[Z, RX]);
                    }
                    for node in [nodes[k][0], nodes[k][count]] {
                        hard.scene.hold(node, &[Z, RY]);
                    }
                }
                put(rows, &names, &mesh, &hard, (1, last, 0.0));
            }
        }
    }
    Ok(())
}
