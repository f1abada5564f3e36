//! Buckling loads of columns.

use basemat::fem::{BeamSection, Direction};
use basemat_problems::columns;
use basemat_problems::space_beams::{section, section_with_shear};
use basemat_problems::supported::{CLAMPED_DIRECTIONS, RX, RY, RZ, X, Y, Z};

use super::row::BenchmarkRows;

fn supported(rows: &mut BenchmarkRows, section: BeamSection, name: &str) {
    let supports: [(&str, &[Direction], &[Direction]); 3] = [
        ("cantilever", &CLAMPED_DIRECTIONS, &[]),
        ("pinned", &[X, Y, Z, RZ], &[X, Y]),
        ("fixed-fixed", &CLAMPED_DIRECTIONS, &[X, Y, RX, RY, RZ]),
    ];
    for (support, foot, head) in supports {
        for count in [1, 2, 4, 8].into_iter().filter(|count| *count > 1 || head.len() < 5) {
            let benchmark = format!("buckling {name}, {support}");
            let value = columns::supported(section, count, foot, head);
            rows.put(&benchmark, "N", &count.to_string(), value);
        }
    }
}

pub(super) fn run(rows: &mut BenchmarkRows) {
    supported(rows, section(), "Euler");
    supported(rows, section_with_shear(), "with shear (Engesser)");
    for count in [2, 4, 8] {
        let benchmark = "buckling of a cantilever by its weight";
        rows.put(benchmark, "q L, N", &count.to_string(), columns::self_weight_buckling(count));
    }
    for count in [1, 2, 4] {
        let benchmark = "buckling of a cantilever with a rigid upper part (offset)";
        rows.put(benchmark, "N", &count.to_string(), columns::rigid_head(count));
    }
}
