//! Vibration of a thick plate of bricks: NAFEMS FV52, and hard supports after Rayleigh and Lamb.

use basemat::fem::MassKind;
use basemat_problems::bricks::{BrickGrid, hard_plate, thick_plate};
use basemat_problems::supported::{Vibration, Z};

use super::row::BenchmarkRows;

/// Supports along the lower edges only.
fn lines(rows: &mut BenchmarkRows, counts @ [nx, ny, nz]: [usize; 3]) {
    let mut block = thick_plate(counts);
    for i in 0..=nx {
        for j in 0..=ny {
            if i == 0 || i == nx || j == 0 || j == ny {
                let node = block.node([i, j, 0]);
                block.scene.fix(node, &[Z]);
            }
        }
    }
    // Two displacements in its plane and a rotation are free.
    let modes = block.scene.modes(MassKind::Consistent, 10, 1e4);
    for (mode, vibration) in modes.iter().enumerate().skip(3) {
        let quantity = format!("mode {}, Hz", mode + 1);
        let mesh = format!("{nx}x{ny}x{nz}");
        rows.put("NAFEMS FV52 solid simply supported plate", &quantity, &mesh, vibration.frequency);
    }
}

/// Whether upper and lower face move in opposite directions in their planes.
fn is_flexural(block: &BrickGrid, [nx, ny, nz]: [usize; 3], mode: &Vibration) -> bool {
    let mut product = 0.0;
    for i in 0..=nx {
        for j in 0..=ny {
            let low = mode.shape[block.node([i, j, 0])];
            let high = mode.shape[block.node([i, j, nz])];
            product += low[0] * high[0] + low[1] * high[1];
        }
    }
    product < 0.0
}

/// Supports of whole faces: against motion in their planes.
fn faces(rows: &mut BenchmarkRows, counts @ [nx, ny, nz]: [usize; 3]) {
    let block = hard_plate(counts);
    for (kind, name) in [(MassKind::Consistent, ""), (MassKind::Lumped, " lumped")] {
        let modes = block.scene.modes(kind, 10, 0.0);
        let flexural = modes.iter().filter(|mode| is_flexural(&block, counts, mode));
        for (mode, vibration) in flexural.take(6).enumerate() {
            let quantity = format!("flexural mode {}, Hz", mode + 1);
            let mesh = format!("{nx}x{ny}x{nz}{name}");
            let benchmark = "hard simply supported thick plate, Rayleigh-Lamb";
            rows.put(benchmark, &quantity, &mesh, vibration.frequency);
        }
    }
}

pub(super) fn run(rows: &mut BenchmarkRows, short: bool) {
    for counts in [[8, 8, 2], [8, 8, 3], [16, 16, 4], [24, 24, 6]] {
        let count = counts[0];
        if short && count > 8 {
            break;
        }
        lines(rows, counts);
        if count < 24 {
            faces(rows, counts);
        }
    }
}
