//! GOAL: incident waves satisfy the boundary equation and scatter only where the surface is not flat.
//! SCENE: a box of soil, a canyon beside a strip, an excavation.
//! REFERENCE: both sides of the boundary equation; the motion of the new surface in closed form.

use basemat::bem::full_plane::{
    Boundary, FullPlaneGround, IncidentField, Segment, TimeKernel, VerticalWaves,
};
use basemat::bem::{Ground, Strip};
use basemat::motion::{AtRest, FreeField, FreeFieldFn, RickerDisplacement};
use basemat::unobserved;

use super::{coefficients, mean, point_between, soil};
use basemat_problems::dense::{dot, largest};
use basemat_problems::series::{RelativeError as SeriesError, assert_within, nearest_integer};

/// A box of soil, of elements of length `size`, its top at z = 0.
fn soil_box(size: f64) -> Vec<Segment> {
    let columns = nearest_integer(2.0 / size);
    let rows = nearest_integer(1.0 / size);
    let mut nodes = Vec::new();
    nodes.extend((0..columns).map(|k| [k as f64 * size, 0.0]));
    nodes.extend((0..rows).map(|k| [2.0, k as f64 * size]));
    nodes.extend((0..columns).map(|k| [2.0 - k as f64 * size, 1.0]));
    nodes.extend((0..rows).map(|k| [0.0, 1.0 - k as f64 * size]));
    let count = nodes.len();
    (0..count).map(|k| Segment { from: nodes[k], to: nodes[(k + 1) % count] }).collect()
}

/// Norm of the residual of the boundary equation on a box of soil at time 5, relative to one side.
fn boundary_equation_residual(waves: &VerticalWaves, size: f64, time_step: f64) -> f64 {
    let segments = soil_box(size);
    let count = segments.len();
    let kernel = TimeKernel::new(soil(0.25), &segments, time_step).unwrap();
    let mut residual = vec![0.0; 2 * count];
    let mut traction_side = vec![0.0; 2 * count];
    for lag in 0..nearest_integer(5.0 / time_step) {
        let matrices = coefficients(&kernel, lag);
        let time = 5.0 - lag as f64 * time_step;
        let mut u = vec![0.0; 2 * count];
        let mut t = vec![0.0; 2 * count];
        for (e, segment) in segments.iter().enumerate() {
            let middle = time - 0.5 * time_step;
            [u[e], u[count + e]] = waves.displacement(segment.center(), middle);
            let [xx, zz, xz] = waves.stress(segment.center(), middle);
            let n = segment.normal();
            [t[e], t[count + e]] = [xx * n[0] + xz * n[1], xz * n[0] + zz * n[1]];
            if lag == 0 {
                // The free term needs the displacement at the end.
                let end = waves.displacement(segment.center(), time);
                residual[e] += 0.5 * (end[0] - u[e]);
                residual[count + e] += 0.5 * (end[1] - u[count + e]);
            }
        }
        for i in 0..2 * count {
            let row = i * 2 * count..(i + 1) * 2 * count;
            let load = dot(&matrices.g[row.clone()], &t);
            residual[i] += dot(&matrices.h[row], &u) - load;
            traction_side[i] += load;
        }
    }
    norm(&residual) / norm(&traction_side)
}

/// Euclidean norm.
fn norm(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// GOAL: displacement and stress of the incident field are consistent, in sign and size.
/// SCENE: a box of soil, its boundary moved and loaded as by S and P waves.
/// REFERENCE: the boundary equation; its residual.
#[test]
fn incident_waves_satisfy_the_boundary_equation() {
    let surface = FreeFieldFn::new(|_, t: f64| {
        let a = (t - 4.0) / 1.2;
        [(-a * a).exp() - (-(4.0 / 1.2_f64).powi(2)).exp(), 0.5 * (-a * a).exp()]
    })
    .with_velocity(|_, t: f64| {
        let a = (t - 4.0) / 1.2;
        let v = -2.0 * a / 1.2 * (-a * a).exp();
        [v, 0.5 * v]
    });
    let waves = VerticalWaves::new(soil(0.25), surface, 1.0).unwrap();
    assert_eq!(waves.delay(), 1.0);
    let errors = [(0.25, 0.2), (0.125, 0.1)]
        .map(|(size, time_step)| boundary_equation_residual(&waves, size, time_step));
    assert_within("incident waves", &["0.25", "0.125"], &errors, &[0.22, 0.115]);
    assert!(errors[0] / errors[1] > 1.8, "not of first order");
}

/// Surface with a canyon right of a strip, elements about `size` long.
pub(crate) fn canyon(size: f64) -> Boundary {
    let corners: [[f64; 2]; 5] = [[-4.0, 0.0], [2.0, 0.0], [4.0, 1.0], [6.0, 0.0], [9.0, 0.0]];
    let mut segments = Vec::new();
    for ends in corners.windows(2) {
        let length = (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1]);
        let pieces = nearest_integer(length / size);
        segments.extend((0..pieces).map(|k| Segment {
            from: point_between(ends[0], ends[1], k as f64 / pieces as f64),
            to: point_between(ends[0], ends[1], (k + 1) as f64 / pieces as f64),
        }));
    }
    // Elements under the strip from −1 to 1.
    let contact: Vec<usize> = (0..segments.len())
        .filter(|&e| segments[e].from[0] > -1.0 - 1e-9 && segments[e].to[0] < 1.0 + 1e-9)
        .collect();
    Boundary::new(segments, &contact).unwrap()
}

/// SV waves under the canyon.
pub(crate) fn waves() -> VerticalWaves {
    VerticalWaves::new(soil(0.25), RickerDisplacement::new(1.0, 0.8, 4.0).unwrap(), 2.0).unwrap()
}

/// Mean displacement of the contact by scattering, down and along, and the largest incident one.
struct ContactMotion {
    /// Downwards, then along.
    scattered_motion: [f64; 2],
    largest_incident: f64,
}

/// Motion of the contact in each step.
fn contact_motion(boundary: Boundary, time_step: f64, steps: usize) -> Vec<ContactMotion> {
    let ground = FullPlaneGround::new(soil(0.25), boundary).with_incident_field(waves());
    // The run is too short for growth to be visible.
    let mut ground = ground.allow_growth();
    ground.prepare(time_step, None, &mut unobserved).unwrap();
    let count = ground.elements().len();
    let mut history = vec![9.0; 2 * count];
    let mut incident = vec![9.0; 2 * count];
    (1..=steps)
        .map(|n| {
            ground.history(&mut history).unwrap();
            ground.free_field(&AtRest, n as f64 * time_step, &mut incident);
            ground.commit(&[]);
            ContactMotion {
                scattered_motion: [mean(&history[..count]), mean(&history[count..])],
                largest_incident: largest(&incident),
            }
        })
        .collect()
}

/// GOAL: a canyon scatters waves, a flat ground does not; the scattered motion converges with the mesh.
/// SCENE: canyon 4 wide and 1 deep beside a strip without structure, SV Ricker pulse, β = 0.75.
#[test]
fn canyons_scatter_incident_waves_and_flat_grounds_do_not() {
    let strip = Strip::uniform(-1.0..1.0, 4).unwrap();
    let flat_motion = contact_motion(Boundary::flat(&[strip], 3).unwrap(), 0.25, 80);
    assert!(flat_motion.iter().all(|motion| motion.scattered_motion == [0.0; 2]));
    assert!(flat_motion.iter().any(|motion| motion.largest_incident > 0.95));
    let time_step = 0.75 * 0.25 / soil(0.25).pressure_wave_speed();
    let coarse = contact_motion(canyon(0.5), 2.0 * time_step, 80);
    let fine = contact_motion(canyon(0.25), time_step, 160);
    let errors = [0, 1].map(|k| {
        let mut error = SeriesError::default();
        for (coarse, fine) in coarse.iter().zip(fine.iter().skip(1).step_by(2)) {
            error.add(coarse.scattered_motion[k], fine.scattered_motion[k]);
        }
        error.relative()
    });
    let max_magnitude = fine.iter().fold(0.0, |m, motion| largest(&motion.scattered_motion).max(m));
    println!("largest {max_magnitude:.3}");
    assert!((0.1..0.5).contains(&max_magnitude), "{max_magnitude}");
    assert_within("canyon", &["down", "along"], &errors, &[0.29, 0.19]);
}

/// GOAL: the sum of incident and scattered field is the motion of the new surface, in sign and size.
/// SCENE: the soil excavated down to 0.5 over a width of 24, until waves arrive from the ends.
/// REFERENCE: a free surface at depth d moves by twice the wave from below: s(t − t₀ + d/c₂).
#[test]
fn an_excavated_half_plane_moves_as_its_new_surface() {
    let pulse = RickerDisplacement::new(1.0, 0.5, 2.0).unwrap();
    let nodes: Vec<[f64; 2]> = (0..97).map(|k| [0.25 * f64::from(k) - 12.0, 0.5]).collect();
    let segments: Vec<Segment> =
        nodes.windows(2).map(|ends| Segment { from: ends[0], to: ends[1] }).collect();
    let errors = [0.1, 0.05].map(|time_step| {
        let waves = VerticalWaves::new(soil(0.25), pulse, 0.5).unwrap();
        let boundary = Boundary::new(segments.clone(), &[47, 48]).unwrap();
        let ground = FullPlaneGround::new(soil(0.25), boundary).with_incident_field(waves);
        let mut ground = ground.allow_growth();
        ground.prepare(time_step, None, &mut unobserved).unwrap();
        let mut history = [0.0; 4];
        let mut incident = [0.0; 4];
        let mut largest_error = 0.0_f64;
        for n in 1..=nearest_integer(5.0 / time_step) {
            let time = n as f64 * time_step;
            ground.history(&mut history).unwrap();
            ground.free_field(&AtRest, time, &mut incident);
            ground.commit(&[]);
            let expected = pulse.displacement(0.0, time)[0];
            largest_error = largest_error.max((history[2] + incident[2] - expected).abs());
        }
        largest_error
    });
    assert_within("excavated", &["0.1", "0.05"], &errors, &[5e-3, 1.3e-3]);
}
