//! Waves from below pass a box of the soil around it, beside closed forms of the waves at depth.

use basemat::fem::Direction;
use basemat::interface::Bonded;
use basemat::motion::PlaneWave;
use basemat::site::TrenchMotion;
use basemat::structure::FemModel;
use basemat::{Result, Simulation, unobserved};

use crate::near_field::{HALF_WIDTH, STEP_COUNT, TIME_STEP, box_ground, near_field, ricker, soil};

/// A plane wave at the surface: polarisation, slowness to the right and upwards (s/m), amplitude.
struct PlaneWaveTerm {
    polarisation: [f64; 2],
    slowness: [f64; 2],
    amplitude: f64,
}

/// Incident SV wave, and the reflected SV and P waves that leave the surface without stress.
///
/// A displacement d f(t − s·x) has the strains −s_j d_i f′.
fn shear_wave(angle: f64) -> [PlaneWaveTerm; 3] {
    let shear_speed = soil().shear_wave_speed();
    let pressure_speed = soil().pressure_wave_speed();
    let p = angle.sin() / shear_speed;
    let a = (pressure_speed.powi(-2) - p * p).sqrt();
    let b = (shear_speed.powi(-2) - p * p).sqrt();
    let wave = |polarisation: [f64; 2], speed: f64, slowness| PlaneWaveTerm {
        polarisation: polarisation.map(|component| component * speed),
        slowness,
        amplitude: 1.0,
    };
    let mut waves = [
        wave([b, -p], shear_speed, [p, b]),
        wave([b, p], shear_speed, [p, -b]),
        wave([p, -a], pressure_speed, [p, -a]),
    ];
    let ratio = (pressure_speed / shear_speed).powi(2) - 2.0;
    // Shear and vertical stress at the surface, over the shear modulus.
    let stresses = [0, 1, 2].map(|k| {
        let PlaneWaveTerm { polarisation: d, slowness: s, .. } = &waves[k];
        [s[1] * d[0] + s[0] * d[1], ratio * (s[0] * d[0] + s[1] * d[1]) + 2.0 * s[1] * d[1]]
    });
    let incident = stresses[0];
    let reflected_stress = stresses[1];
    let pressure = stresses[2];
    let determinant = reflected_stress[0] * pressure[1] - reflected_stress[1] * pressure[0];
    waves[1].amplitude = (incident[1] * pressure[0] - incident[0] * pressure[1]) / determinant;
    waves[2].amplitude =
        (incident[0] * reflected_stress[1] - incident[1] * reflected_stress[0]) / determinant;
    let surface: f64 = waves.iter().map(|wave| wave.amplitude * wave.polarisation[0]).sum();
    for wave in &mut waves {
        wave.amplitude /= surface;
    }
    waves
}

/// Largest difference of a node of the box alone from the free field, relative to the largest motion.
///
/// `angle`: of the shear wave that comes from below, rad from the vertical.
pub fn free_field_difference(angle: f64) -> Result<f64> {
    let record = ricker(1.0);
    let trench = box_ground();
    let origin = -2.0 * HALF_WIDTH;
    let motion = if angle == 0.0 {
        TrenchMotion::new(&trench, record.clone(), &mut unobserved)
    } else {
        let wave = PlaneWave::sv(soil(), angle)?;
        let field = wave.field_from_horizontal(&record, origin)?;
        TrenchMotion::travelling(&trench, &field, &mut unobserved)
    };
    let model = FemModel::on_soil_at_rest(near_field().mesh()?)?;
    let mesh = model.mesh().clone();
    let mut simulation = Simulation::builder(TIME_STEP)
        .ground(trench)
        .structure(model.clone())
        .interface(Bonded)
        .motion(motion?)
        .expected_steps(STEP_COUNT)
        .build()?;
    let waves = shear_wave(angle);
    let mut max_magnitude = 0.0_f64;
    let mut difference = 0.0_f64;
    for _ in 0..STEP_COUNT {
        let state = simulation.step()?;
        let displacement = state.absolute_displacement();
        for (node, [x, y, _]) in mesh.nodes().iter().enumerate() {
            let mut expected = [0.0; 2];
            for PlaneWaveTerm { polarisation, slowness, amplitude } in &waves {
                // Waves arrive at the surface above the left wall at time zero.
                let delay = slowness[0] * (x - origin) + slowness[1] * y;
                let motion = amplitude * record.at(state.time - delay).displacement;
                for (sum, component) in expected.iter_mut().zip(polarisation) {
                    *sum += component * motion;
                }
            }
            for (direction, expected) in [Direction::X, Direction::Y].into_iter().zip(expected) {
                let Some(dof) = model.dof(node, direction) else { continue };
                max_magnitude = max_magnitude.max(expected.abs());
                difference = difference.max((displacement[dof] - expected).abs());
            }
        }
    }
    Ok(difference / max_magnitude)
}
