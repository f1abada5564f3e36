//! Cantilevers of beams: MacNeal & Harder's straight, curved and twisted ones, and a hinged one.

use std::f64::consts::FRAC_PI_2;

use basemat::fem::{BeamSection, Direction, Material, SpaceBeam};
use basemat_problems::supported::{CLAMPED, RX, RY, RZ, Supported, X, Y, Z};

use super::row::Rows;
use super::section::rectangle;
use crate::AnyError;

/// A chain of beams from a clamped node, at these points and with these orientations.
fn chain(
    material: Material,
    section: BeamSection,
    count: usize,
    point: impl Fn(f64) -> [f64; 3],
    orientation: impl Fn(f64) -> [f64; 3],
) -> Result<Supported, AnyError> {
    let mut scene = Supported::new();
    for k in 0..=count {
        scene.node(point(k as f64 / count as f64));
    }
    for k in 0..count {
        let middle = (k as f64 + 0.5) / count as f64;
        scene.add(SpaceBeam::new([k, k + 1], material, section, orientation(middle))?);
    }
    scene.hold(0, &CLAMPED);
    Ok(scene)
}

fn straight(rows: &mut Rows) -> Result<(), AnyError> {
    let material = Material::new(1.0e7, 0.3, 0.0)?;
    for count in [1, 6] {
        let along = |part: f64| [6.0 * part, 0.0, 0.0];
        let beam = chain(material, rectangle(0.2, 0.1)?, count, along, |_| [0.0, 1.0, 0.0])?;
        for (quantity, direction) in
            [("extension", X), ("in-plane shear", Y), ("out-of-plane shear", Z), ("twist", RX)]
        {
            let value = beam.work(&[(count, direction, 1.0)]);
            rows.put("MacNeal-Harder straight cantilever", quantity, &count.to_string(), value);
        }
    }
    Ok(())
}

fn curved(rows: &mut Rows) -> Result<(), AnyError> {
    let material = Material::new(1.0e7, 0.25, 0.0)?;
    for count in [6, 12, 48] {
        let around = |part: f64| {
            let (sine, cosine) = (FRAC_PI_2 * part).sin_cos();
            [4.22 * cosine, 4.22 * sine, 0.0]
        };
        // y of the section across the plane of the arc.
        let beam = chain(material, rectangle(0.1, 0.2)?, count, around, |_| [0.0, 0.0, 1.0])?;
        for (quantity, direction) in [("in-plane", Y), ("out-of-plane", Z)] {
            let value = beam.work(&[(count, direction, 1.0)]);
            for benchmark in ["MacNeal-Harder curved cantilever", "curved cantilever, closed form"]
            {
                rows.put(benchmark, quantity, &count.to_string(), value);
            }
        }
    }
    Ok(())
}

fn twisted(rows: &mut Rows) -> Result<(), AnyError> {
    let material = Material::new(2.9e7, 0.22, 0.0)?;
    for (thickness, force) in [(0.32, 1.0), (0.0032, 1e-6)] {
        for count in [12, 96] {
            let along = |part: f64| [12.0 * part, 0.0, 0.0];
            let turned = |part: f64| {
                let (sine, cosine) = (FRAC_PI_2 * part).sin_cos();
                [0.0, cosine, sine]
            };
            let beam = chain(material, rectangle(1.1, thickness)?, count, along, turned)?;
            let benchmark = format!("MacNeal-Harder twisted beam t={thickness}");
            let tip = |direction: Direction| force * beam.work(&[(count, direction, 1.0)]);
            let mesh = count.to_string();
            rows.put(&benchmark, "along the width of the tip (in-plane)", &mesh, tip(Z));
            rows.put(&benchmark, "across (out-of-plane)", &mesh, tip(Y));
        }
    }
    Ok(())
}

fn hinged(rows: &mut Rows) -> Result<(), AnyError> {
    let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
    let section = BeamSection::new(0.12, [1.6e-3, 0.9e-3], 1.94e-3)?.with_shear_areas([0.1; 2])?;
    let mut scene = Supported::new();
    let ends = [[0.0; 3], [0.0, 0.0, 4.0]].map(|point| scene.node(point));
    let beam = SpaceBeam::new(ends, concrete, section, [1.0, 0.0, 0.0])?;
    scene.add(beam.with_releases(1, &[RY, RZ])?);
    scene.hold(0, &CLAMPED);
    scene.hold(1, &[RX, RY, RZ]);
    let stiffness = 1.0 / scene.work(&[(1, X, 1.0)]);
    rows.put("hinge at end 2: lateral stiffness", "N/m", "1", stiffness);
    Ok(())
}

pub(super) fn run(rows: &mut Rows) -> Result<(), AnyError> {
    straight(rows)?;
    curved(rows)?;
    twisted(rows)?;
    hinged(rows)
}
