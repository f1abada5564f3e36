//! Buckling loads of columns.

use basemat::fem::{BeamSection, Direction, Element, Material, SpaceBeam};
use basemat_problems::supported::{CLAMPED, RX, RY, RZ, Supported, X, Y, Z};

use super::row::Rows;
use crate::AnyError;

const LENGTH: f64 = 4.0;
/// Weight per length, N/m, at a gravity of 1 m/s².
const WEIGHT: f64 = 2500.0 * 0.12;

fn beam(k: usize, section: BeamSection) -> basemat::Result<SpaceBeam> {
    let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
    SpaceBeam::new([k, k + 1], concrete, section, [1.0, 0.0, 0.0])
}

fn nodes(length: f64, count: usize) -> Supported {
    let mut scene = Supported::new();
    for k in 0..=count {
        scene.node([0.0, 0.0, length * k as f64 / count as f64]);
    }
    scene
}

fn supported(rows: &mut Rows, section: BeamSection, name: &str) -> Result<(), AnyError> {
    let supports: [(&str, &[Direction], &[Direction]); 3] = [
        ("cantilever", &CLAMPED, &[]),
        ("pinned", &[X, Y, Z, RZ], &[X, Y]),
        ("fixed-fixed", &CLAMPED, &[X, Y, RX, RY, RZ]),
    ];
    for (support, foot, head) in supports {
        for count in [1, 2, 4, 8].into_iter().filter(|count| *count > 1 || head.len() < 5) {
            let mut scene = nodes(LENGTH, count);
            for k in 0..count {
                scene.add(beam(k, section)?.with_compression(1.0)?);
            }
            scene.hold(0, foot);
            scene.hold(count, head);
            let benchmark = format!("buckling {name}, {support}");
            rows.put(&benchmark, "N", &count.to_string(), scene.buckling());
        }
    }
    Ok(())
}

fn own_weight(rows: &mut Rows, section: BeamSection) -> Result<(), AnyError> {
    for count in [2, 4, 8] {
        let height = LENGTH / count as f64;
        let mut scene = nodes(LENGTH, count);
        for k in 0..count {
            // Shortening of the beam by the weight above its middle.
            let above = WEIGHT * (LENGTH - height * (k as f64 + 0.5));
            let mut displacement = [0.0; 12];
            displacement[8] = -above * height / (30.0e9 * 0.12);
            let own = beam(k, section)?;
            let points = scene.points(own.nodes());
            let loaded = own.in_static_state(&points, &displacement, 1.0);
            scene.add(loaded.ok_or("a beam with an axial force")?);
        }
        scene.hold(0, &CLAMPED);
        let value = scene.buckling() * WEIGHT * LENGTH;
        let benchmark = "buckling of a cantilever by its own weight";
        rows.put(benchmark, "q L, N", &count.to_string(), value);
    }
    Ok(())
}

fn rigid_head(rows: &mut Rows, section: BeamSection) -> Result<(), AnyError> {
    for count in [1, 2, 4] {
        let mut scene = Supported::new();
        for k in 0..count {
            scene.node([0.0, 0.0, 2.5 * k as f64 / count as f64]);
        }
        scene.node([0.0, 0.0, LENGTH]);
        for k in 0..count {
            let arm = if k + 1 == count { -1.5 } else { 0.0 };
            let own = beam(k, section)?.with_compression(1.0)?;
            scene.add(own.with_offsets([[0.0; 3], [0.0, 0.0, arm]])?);
        }
        scene.hold(0, &CLAMPED);
        let benchmark = "buckling of a cantilever with a rigid upper part (offset)";
        rows.put(benchmark, "N", &count.to_string(), scene.buckling());
    }
    Ok(())
}

pub(super) fn run(rows: &mut Rows) -> Result<(), AnyError> {
    let slender = BeamSection::new(0.12, [1.6e-3, 0.9e-3], 1.94e-3)?;
    supported(rows, slender, "Euler")?;
    supported(rows, slender.with_shear_areas([0.1; 2])?, "with shear (Engesser)")?;
    own_weight(rows, slender)?;
    rigid_head(rows, slender)
}
