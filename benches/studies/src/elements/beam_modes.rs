//! Vibration of thick beams: NAFEMS FV5 and Timoshenko's cantilever.

use basemat::fem::{Direction, MassKind};
use basemat_problems::space_beams;
use basemat_problems::supported::{RX, RY, RZ, X, Y, Z};

use super::row::BenchmarkRows;

fn deep_beam(rows: &mut BenchmarkRows) {
    for count in [5, 10, 40] {
        let frequencies = space_beams::deep_beam(count).frequencies(MassKind::Consistent, 9);
        for (mode, value) in frequencies.into_iter().enumerate() {
            let quantity = format!("mode {}, Hz", mode + 1);
            let mesh = count.to_string();
            rows.put("NAFEMS FV5 deep simply supported beam", &quantity, &mesh, value);
            if count == 40 {
                rows.put("FV5, closed form", &quantity, &mesh, value);
            }
        }
    }
}

fn cantilever(rows: &mut BenchmarkRows) {
    let across: [(&str, [Direction; 4]); 2] = [("e2", [Y, RX, Z, RZ]), ("e3", [X, RY, Z, RZ])];
    for (kind, name) in [(MassKind::Consistent, "consistent"), (MassKind::Lumped, "lumped")] {
        let benchmark = format!("Timoshenko cantilever 3 x 4 x 20 m, {name} mass");
        for count in [2, 4, 8, 16] {
            for (axis, restrained) in &across {
                let scene = space_beams::thick_cantilever(count, restrained);
                let modes = if count == 2 { 2 } else { 3 };
                for (mode, value) in scene.frequencies(kind, modes).into_iter().enumerate() {
                    let quantity = format!("mode {} along {axis}, Hz", mode + 1);
                    rows.put(&benchmark, &quantity, &count.to_string(), value);
                }
            }
        }
    }
}

pub(super) fn run(rows: &mut BenchmarkRows) {
    deep_beam(rows);
    cantilever(rows);
}
