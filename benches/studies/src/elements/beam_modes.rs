//! Vibration of thick beams: NAFEMS FV5 and Timoshenko's cantilever.

use basemat::fem::{BeamSection, Direction, MassKind, Material, SpaceBeam};
use basemat_problems::supported::{CLAMPED, RX, RY, RZ, Supported, X, Y, Z};

use super::row::Rows;
use crate::AnyError;

fn deep_beam(rows: &mut Rows) -> Result<(), AnyError> {
    let section =
        BeamSection::new(4.0, [4.0 / 3.0; 2], 2.24923)?.with_shear_areas([10.0 / 3.0; 2])?;
    let steel = Material::new(200.0e9, 0.3, 8000.0)?;
    for count in [5, 10, 40] {
        let mut scene = Supported::new();
        for k in 0..=count {
            scene.node([10.0 * k as f64 / count as f64, 0.0, 0.0]);
        }
        for k in 0..count {
            let beam = SpaceBeam::new([k, k + 1], steel, section, [0.0, 1.0, 0.0])?;
            scene.add(beam.with_rotary_inertia());
        }
        scene.hold(0, &[X, Y, Z, RX]);
        scene.hold(count, &[Y, Z]);
        for (mode, value) in scene.frequencies(MassKind::Consistent, 9).into_iter().enumerate() {
            let quantity = format!("mode {}, Hz", mode + 1);
            let mesh = count.to_string();
            rows.put("NAFEMS FV5 deep simply supported beam", &quantity, &mesh, value);
            if count == 40 {
                rows.put("FV5, closed form", &quantity, &mesh, value);
            }
        }
    }
    Ok(())
}

fn cantilever(rows: &mut Rows) -> Result<(), AnyError> {
    let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
    // 3 m along the first axis of the section, 4 m along the second.
    let section = BeamSection::new(12.0, [16.0, 9.0], 20.0)?.with_shear_areas([10.0; 2])?;
    let across: [(&str, [Direction; 4]); 2] = [("e2", [Y, RX, Z, RZ]), ("e3", [X, RY, Z, RZ])];
    for (kind, name) in [(MassKind::Consistent, "consistent"), (MassKind::Lumped, "lumped")] {
        let benchmark = format!("Timoshenko cantilever 3 x 4 x 20 m, {name} mass");
        for count in [2, 4, 8, 16] {
            for (axis, held) in &across {
                let mut scene = Supported::new();
                for k in 0..=count {
                    scene.node([0.0, 0.0, 20.0 * k as f64 / count as f64]);
                    scene.hold(k, if k == 0 { &CLAMPED } else { held });
                }
                for k in 0..count {
                    let beam = SpaceBeam::new([k, k + 1], concrete, section, [1.0, 0.0, 0.0])?;
                    scene.add(beam.with_rotary_inertia());
                }
                let modes = if count == 2 { 2 } else { 3 };
                for (mode, value) in scene.frequencies(kind, modes).into_iter().enumerate() {
                    let quantity = format!("mode {} along {axis}, Hz", mode + 1);
                    rows.put(&benchmark, &quantity, &count.to_string(), value);
                }
            }
        }
    }
    Ok(())
}

pub(super) fn run(rows: &mut Rows) -> Result<(), AnyError> {
    deep_beam(rows)?;
    cantilever(rows)
}
