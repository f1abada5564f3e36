//! Buckling loads of columns in space, 4 m high, by beams with the section of the tables.

use basemat::fem::{BeamSection, Direction, Element, SpaceBeam};

use crate::space_beams::{concrete, section};
use crate::supported::{CLAMPED_DIRECTIONS, SupportedMesh};

/// Length of all columns, m.
pub const COLUMN_LENGTH: f64 = 4.0;
/// Weight per length, N/m, at a gravity of 1 m/s².
const WEIGHT_PER_LENGTH: f64 = 2500.0 * 0.12;

/// The beam between a node and the next.
pub fn beam(node: usize, section: BeamSection) -> SpaceBeam {
    SpaceBeam::new([node, node + 1], concrete(), section, [1.0, 0.0, 0.0]).unwrap()
}

/// Nodes along the column, without elements.
fn column_nodes(count: usize) -> SupportedMesh {
    let mut scene = SupportedMesh::new();
    for k in 0..=count {
        scene.node([0.0, 0.0, COLUMN_LENGTH * k as f64 / count as f64]);
    }
    scene
}

/// Buckling load of a column between two supports, N.
pub fn supported(
    section: BeamSection,
    count: usize,
    foot_supports: &[Direction],
    head_supports: &[Direction],
) -> f64 {
    let mut scene = column_nodes(count);
    for k in 0..count {
        scene.add(beam(k, section).with_compression(1.0).unwrap());
    }
    scene.fix(0, foot_supports);
    scene.fix(count, head_supports);
    scene.buckling()
}

/// Weight of a cantilever that buckles under this weight, N.
pub fn self_weight_buckling(count: usize) -> f64 {
    let height = COLUMN_LENGTH / count as f64;
    let mut scene = column_nodes(count);
    for k in 0..count {
        // Shortening of the beam by the weight above its middle.
        let weight_above = WEIGHT_PER_LENGTH * (COLUMN_LENGTH - height * (k as f64 + 0.5));
        let mut displacement = [0.0; 12];
        displacement[8] = -weight_above * height / (30.0e9 * 0.12);
        let beam = beam(k, section());
        let points = scene.points(beam.nodes());
        scene.add(beam.in_static_state(&points, &displacement, 1.0).unwrap());
    }
    scene.fix(0, &CLAMPED_DIRECTIONS);
    scene.buckling() * WEIGHT_PER_LENGTH * COLUMN_LENGTH
}

/// Buckling load of a cantilever of 2.5 m with a rigid arm of 1.5 m above it, N.
pub fn rigid_head(count: usize) -> f64 {
    let mut scene = SupportedMesh::new();
    for k in 0..count {
        scene.node([0.0, 0.0, 2.5 * k as f64 / count as f64]);
    }
    scene.node([0.0, 0.0, COLUMN_LENGTH]);
    for k in 0..count {
        let arm = if k + 1 == count { -1.5 } else { 0.0 };
        let beam = beam(k, section()).with_compression(1.0).unwrap();
        scene.add(beam.with_offsets([[0.0; 3], [0.0, 0.0, arm]]).unwrap());
    }
    scene.fix(0, &CLAMPED_DIRECTIONS);
    scene.buckling()
}
