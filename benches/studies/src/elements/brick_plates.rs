//! Vibration of a thick plate of bricks: NAFEMS FV52, and hard supports after Rayleigh and Lamb.

use basemat::fem::MassKind;
use basemat_problems::bricks::{hard_plate, thick_plate};
use basemat_problems::supported::{Vibration, Z};

use super::row::Rows;

/// Supports along the lower edges only.
fn lines(rows: &mut Rows, counts: [usize; 3]) {
    let mut block = thick_plate(counts);
    let [nx, ny, nz] = counts;
    for i in 0..=nx {
        for j in 0..=ny {
            if i == 0 || i == nx || j == 0 || j == ny {
                let node = block.node([i, j, 0]);
                block.scene.hold(node, &[Z]);
            }
        }
    }
    // Two displacements in its plane and a rotation are free.
    let modes = block.scene.modes(MassKind::Consistent, 10, 1e4);
    for (mode, own) in modes.iter().enumerate().skip(3) {
        let quantity = format!("mode {}, Hz", mode + 1);
        let mesh = format!("{nx}x{ny}x{nz}");
        rows.put("NAFEMS FV52 solid simply supported plate", &quantity, &mesh, own.frequency);
    }
}

/// Supports of whole faces: against motion in their planes.
fn faces(rows: &mut Rows, counts: [usize; 3]) {
    let block = hard_plate(counts);
    let [nx, ny, nz] = counts;
    // In bending, upper and lower face move against each other.
    let bends = |mode: &&Vibration| {
        let columns = (0..=nx).flat_map(|i| (0..=ny).map(move |j| [i, j]));
        let product = columns.map(|[i, j]| {
            let [low, high] = [0, nz].map(|k| mode.shape[block.node([i, j, k])]);
            low[0] * high[0] + low[1] * high[1]
        });
        product.sum::<f64>() < 0.0
    };
    for (kind, name) in [(MassKind::Consistent, ""), (MassKind::Lumped, " lumped")] {
        let modes = block.scene.modes(kind, 10, 0.0);
        for (mode, own) in modes.iter().filter(bends).take(6).enumerate() {
            let quantity = format!("flexural mode {}, Hz", mode + 1);
            let mesh = format!("{nx}x{ny}x{nz}{name}");
            let benchmark = "hard simply supported thick plate, Rayleigh-Lamb";
            rows.put(benchmark, &quantity, &mesh, own.frequency);
        }
    }
}

pub(super) fn run(rows: &mut Rows, short: bool) {
    for counts in [[8, 8, 2], [8, 8, 3], [16, 16, 4], [24, 24, 6]] {
        let [count, ..] = counts;
        if short && count > 8 {
            break;
        }
        lines(rows, counts);
        if count < 24 {
            faces(rows, counts);
        }
    }
}
