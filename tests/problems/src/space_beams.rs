//! Benchmarks of beams in space: cantilevers, a hinge, thick beams.

use std::f64::consts::FRAC_PI_2;

use basemat::fem::{BeamSection, Direction, Material, SpaceBeam};

use crate::supported::{CLAMPED_DIRECTIONS, RX, RY, RZ, SupportedMesh, X, Y, Z};

/// Concrete of the tables.
pub fn concrete() -> Material {
    Material::new(30.0e9, 0.2, 2500.0).unwrap()
}

/// Section of the tables' beams, 0.3 m × 0.4 m, without shear deformation.
pub fn section() -> BeamSection {
    BeamSection::new(0.12, [1.6e-3, 0.9e-3], 1.94e-3).unwrap()
}

/// Section of the tables' beams with shear deformation.
pub fn section_with_shear() -> BeamSection {
    section().with_shear_areas([0.1; 2]).unwrap()
}

/// Rectangle with shear deformation, sides along the beam's y and z axes.
pub fn rectangle(y_side: f64, z_side: f64, torsion_constant: f64) -> BeamSection {
    let area = y_side * z_side;
    let moments = [area * z_side * z_side / 12.0, area * y_side * y_side / 12.0];
    let section = BeamSection::new(area, moments, torsion_constant).unwrap();
    section.with_shear_areas([5.0 / 6.0 * area; 2]).unwrap()
}

/// Beams along a curve from a clamped node, oriented as at their middles.
///
/// `point` and `orientation` are functions of the curve's parameter from 0 to 1.
pub fn chain(
    material: Material,
    section: BeamSection,
    count: usize,
    point: impl Fn(f64) -> [f64; 3],
    orientation: impl Fn(f64) -> [f64; 3],
) -> SupportedMesh {
    let mut scene = SupportedMesh::new();
    for k in 0..=count {
        scene.node(point(k as f64 / count as f64));
    }
    for k in 0..count {
        let middle = (k as f64 + 0.5) / count as f64;
        let beam = SpaceBeam::new([k, k + 1], material, section, orientation(middle));
        scene.add(beam.unwrap());
    }
    scene.fix(0, &CLAMPED_DIRECTIONS);
    scene
}

/// The straight cantilever of `MacNeal` & Harder (Finite Elements in Analysis and Design 1, 1985), along x.
pub fn straight_cantilever(torsion_constant: f64, count: usize) -> SupportedMesh {
    let material = Material::new(1.0e7, 0.3, 0.0).unwrap();
    let section = rectangle(0.2, 0.1, torsion_constant);
    chain(material, section, count, |fraction| [6.0 * fraction, 0.0, 0.0], |_| [0.0, 1.0, 0.0])
}

/// The twisted cantilever of `MacNeal` & Harder, 1.1 wide, turned by 90°.
pub fn twisted_cantilever(thickness: f64, torsion_constant: f64, count: usize) -> SupportedMesh {
    let material = Material::new(2.9e7, 0.22, 0.0).unwrap();
    let section = rectangle(1.1, thickness, torsion_constant);
    chain(
        material,
        section,
        count,
        |fraction| [12.0 * fraction, 0.0, 0.0],
        |fraction| [0.0, (FRAC_PI_2 * fraction).cos(), (FRAC_PI_2 * fraction).sin()],
    )
}

/// Deflection of a cantilever, 4 m high, with a hinge below its guided head, under a unit force.
pub fn hinged_cantilever(section: BeamSection) -> f64 {
    let mut scene = SupportedMesh::new();
    let ends = [[0.0; 3], [0.0, 0.0, 4.0]].map(|point| scene.node(point));
    let beam = SpaceBeam::new(ends, concrete(), section, [1.0, 0.0, 0.0]).unwrap();
    scene.add(beam.with_releases(1, &[RY, RZ]).unwrap());
    scene.fix(0, &CLAMPED_DIRECTIONS);
    scene.fix(1, &[RX, RY, RZ]);
    scene.work(&[(1, X, 1.0)])
}

/// The deep beam FV5 of the National Agency for Finite Element Methods and Standards (NAFEMS).
pub fn deep_beam(count: usize) -> SupportedMesh {
    let section = BeamSection::new(4.0, [4.0 / 3.0; 2], 2.24923).unwrap();
    let section = section.with_shear_areas([10.0 / 3.0; 2]).unwrap();
    let steel = Material::new(200.0e9, 0.3, 8000.0).unwrap();
    let mut scene = SupportedMesh::new();
    for k in 0..=count {
        scene.node([10.0 * k as f64 / count as f64, 0.0, 0.0]);
    }
    for k in 0..count {
        let beam = SpaceBeam::new([k, k + 1], steel, section, [0.0, 1.0, 0.0]).unwrap();
        scene.add(beam.with_rotary_inertia());
    }
    scene.fix(0, &[X, Y, Z, RX]);
    scene.fix(count, &[Y, Z]);
    scene
}

/// A cantilever 3 m × 4 m × 20 m, with these directions fixed over its whole height.
pub fn thick_cantilever(count: usize, fixed_directions: &[Direction]) -> SupportedMesh {
    // 3 m along the first axis of the section, 4 m along the second.
    let section = BeamSection::new(12.0, [16.0, 9.0], 20.0).unwrap();
    let section = section.with_shear_areas([10.0; 2]).unwrap();
    let mut scene = SupportedMesh::new();
    for k in 0..=count {
        scene.node([0.0, 0.0, 20.0 * k as f64 / count as f64]);
        scene.fix(k, if k == 0 { &CLAMPED_DIRECTIONS } else { fixed_directions });
    }
    for k in 0..count {
        let beam = SpaceBeam::new([k, k + 1], concrete(), section, [1.0, 0.0, 0.0]).unwrap();
        scene.add(beam.with_rotary_inertia());
    }
    scene
}
