//! GOAL: incident waves satisfy the boundary equation and scatter only where the surface is not
//! flat.
//! SCENE: a box of soil, a canyon beside a strip, an excavation.
//! REFERENCE: both sides of the boundary equation; the motion of the new surface in closed form.

use basemat::bem::full_plane::{
    Boundary, FullPlaneGround, IncidentField, Segment, TimeKernel, VerticalWaves,
};
use basemat::bem::{Ground, Strip};
use basemat::motion::{AtRest, FreeField, FreeFieldFn, RickerDisplacement};
use basemat::unobserved;

use super::{coefficients, soil};
use basemat_problems::series::{Error as SeriesError, whole, within};

/// A box of soil, of elements of length `size`, its top at z = 0.
fn soil_box(size: f64) -> Vec<Segment> {
    let (wide, deep) = (whole(2.0 / size), whole(1.0 / size));
    let mut nodes = Vec::new();
    nodes.extend((0..wide).map(|k| [k as f64 * size, 0.0]));
    nodes.extend((0..deep).map(|k| [2.0, k as f64 * size]));
    nodes.extend((0..wide).map(|k| [2.0 - k as f64 * size, 1.0]));
    nodes.extend((0..deep).map(|k| [0.0, 1.0 - k as f64 * size]));
    let count = nodes.len();
    (0..count).map(|k| Segment { from: nodes[k], to: nodes[(k + 1) % count] }).collect()
}

/// GOAL: displacement and stress of the incident field belong together, in sign and size.
/// SCENE: a box of soil, its boundary moved and loaded as S and P waves do it.
/// REFERENCE: the boundary equation, by what its two sides differ.
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
    let errors = [(0.25, 0.2), (0.125, 0.1)].map(|(size, step)| {
        let segments = soil_box(size);
        let count = segments.len();
        let kernel = TimeKernel::new(soil(0.25), &segments, step).unwrap();
        let steps = whole(5.0 / step);
        let (mut difference, mut side) = (vec![0.0; 2 * count], vec![0.0; 2 * count]);
        for lag in 0..steps {
            let [g, h] = coefficients(&kernel, lag);
            let time = 5.0 - lag as f64 * step;
            let (mut u, mut t) = (vec![0.0; 2 * count], vec![0.0; 2 * count]);
            for (e, s) in segments.iter().enumerate() {
                [u[e], u[count + e]] = waves.displacement(s.center(), time - 0.5 * step);
                let [xx, zz, xz] = waves.stress(s.center(), time - 0.5 * step);
                let n = s.normal();
                [t[e], t[count + e]] = [xx * n[0] + xz * n[1], xz * n[0] + zz * n[1]];
                if lag == 0 {
                    // The free term needs the displacement at the end.
                    let end = waves.displacement(s.center(), time);
                    difference[e] += 0.5 * (end[0] - u[e]);
                    difference[count + e] += 0.5 * (end[1] - u[count + e]);
                }
            }
            for i in 0..2 * count {
                let row = i * 2 * count..(i + 1) * 2 * count;
                let sum = |m: &[f64], x: &[f64]| -> f64 {
                    m[row.clone()].iter().zip(x).map(|(a, b)| a * b).sum()
                };
                let load = sum(&g, &t);
                difference[i] += sum(&h, &u) - load;
                side[i] += load;
            }
        }
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        norm(&difference) / norm(&side)
    });
    within("incident waves", &["0.25", "0.125"], &errors, &[0.22, 0.115]);
    assert!(errors[0] / errors[1] > 1.8, "not of first order");
}

/// Surface with a canyon right of a strip, elements about `size` long.
pub(crate) fn canyon(size: f64) -> Boundary {
    let corners: [[f64; 2]; 5] = [[-4.0, 0.0], [2.0, 0.0], [4.0, 1.0], [6.0, 0.0], [9.0, 0.0]];
    let mut segments = Vec::new();
    for pair in corners.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let pieces = whole((to[0] - from[0]).hypot(to[1] - from[1]) / size);
        let at = |k: usize| {
            let part = k as f64 / pieces as f64;
            [from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1])]
        };
        segments.extend((0..pieces).map(|k| Segment { from: at(k), to: at(k + 1) }));
    }
    let under = |s: &Segment| s.from[0] > -1.0 - 1e-9 && s.to[0] < 1.0 + 1e-9;
    let contact: Vec<usize> = (0..segments.len()).filter(|&e| under(&segments[e])).collect();
    Boundary::new(segments, &contact).unwrap()
}

pub(crate) fn waves() -> VerticalWaves {
    VerticalWaves::new(soil(0.25), RickerDisplacement::new(1.0, 0.8, 4.0).unwrap(), 2.0).unwrap()
}

/// Mean scattered and largest incident displacement of the contact, down and along, per step.
fn scattered(boundary: Boundary, time_step: f64, steps: usize) -> Vec<[f64; 3]> {
    let ground = FullPlaneGround::new(soil(0.25), boundary).with_incident_field(waves());
    // Too few steps for growth to show.
    let mut ground = ground.allow_growth();
    ground.prepare(time_step, None, &mut unobserved).unwrap();
    let count = ground.elements().len();
    let (mut history, mut free) = (vec![9.0; 2 * count], vec![9.0; 2 * count]);
    (1..=steps)
        .map(|n| {
            ground.history(&mut history).unwrap();
            ground.free_field(&AtRest, n as f64 * time_step, &mut free);
            ground.commit(&[]);
            let mean = |x: &[f64]| x.iter().sum::<f64>() / count as f64;
            let largest = free.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            [mean(&history[..count]), mean(&history[count..]), largest]
        })
        .collect()
}

/// GOAL: a flat ground scatters nothing, a canyon does, and the answer settles with the mesh.
/// SCENE: canyon 4 wide and 1 deep beside a strip without structure, SV Ricker pulse, β = 0.75.
#[test]
fn canyons_scatter_incident_waves() {
    let strip = Strip::uniform(-1.0..1.0, 4).unwrap();
    let flat = scattered(Boundary::flat(&[strip], 3).unwrap(), 0.25, 80);
    assert!(flat.iter().all(|[down, along, _]| *down == 0.0 && *along == 0.0));
    assert!(flat.iter().any(|[.., free]| *free > 0.95));
    let step = 0.75 * 0.25 / soil(0.25).pressure_wave_speed();
    let (coarse, fine) =
        (scattered(canyon(0.5), 2.0 * step, 80), scattered(canyon(0.25), step, 160));
    let errors = [0, 1].map(|k| {
        let mut error = SeriesError::default();
        coarse.iter().zip(fine.iter().skip(1).step_by(2)).for_each(|(a, b)| error.add(a[k], b[k]));
        error.relative()
    });
    let largest = fine.iter().fold(0.0_f64, |m, x| m.max(x[0].abs()).max(x[1].abs()));
    println!("largest {largest:.3}");
    assert!((0.1..0.5).contains(&largest), "{largest}");
    within("canyon", &["down", "along"], &errors, &[0.29, 0.19]);
}

/// GOAL: incident and scattered field together are the motion of the new surface, in sign and size.
/// SCENE: the soil taken away down to 0.5 over a width of 24, until waves come in from the ends.
/// REFERENCE: a free surface at depth d moves as the wave from below does, twice: s(t − t₀ + d/c₂).
#[test]
fn excavated_half_plane_moves_as_its_own_surface() {
    let pulse = || RickerDisplacement::new(1.0, 0.5, 2.0).unwrap();
    let at = |k: f64| [0.25 * k - 12.0, 0.5];
    let segments =
        (0..96).map(|k| Segment { from: at(f64::from(k)), to: at(f64::from(k + 1)) }).collect();
    let errors = [0.1, 0.05].map(|step| {
        let waves = VerticalWaves::new(soil(0.25), pulse(), 0.5).unwrap();
        let boundary = Boundary::new(Vec::clone(&segments), &[47, 48]).unwrap();
        let ground = FullPlaneGround::new(soil(0.25), boundary).with_incident_field(waves);
        let mut ground = ground.allow_growth();
        ground.prepare(step, None, &mut unobserved).unwrap();
        let (mut history, mut free) = ([0.0; 4], [0.0; 4]);
        let mut worst = 0.0_f64;
        for n in 1..=whole(5.0 / step) {
            let time = n as f64 * step;
            ground.history(&mut history).unwrap();
            ground.free_field(&AtRest, time, &mut free);
            ground.commit(&[]);
            let wanted = pulse().displacement(0.0, time)[0];
            worst = worst.max((history[2] + free[2] - wanted).abs());
        }
        worst
    });
    within("excavated", &["0.1", "0.05"], &errors, &[5e-3, 1.3e-3]);
}
