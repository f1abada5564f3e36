//! Full-plane boundary elements: coefficients, cavities, and the ground against the half-plane.

mod support;
#[path = "support/truncation.rs"]
mod truncation;

use basemat::bem::full_plane::{
    Boundary, BoundaryKernel, BoundaryMarch, CqMethod, FullPlaneGround, Given, IncidentField,
    Segment, TimeKernel, VerticalWaves,
};
use basemat::bem::{Ground, HalfPlaneGround, Strip};
use basemat::interface::Bonded;
use basemat::motion::{AtRest, FreeField, FreeFieldFn, RickerDisplacement};
use basemat::structure::RigidBlock;
use basemat::{Error, Simulation, Soil};
use std::f64::consts::PI;
use support::series::{Error as SeriesError, whole, within};
use support::{close, table};
use truncation::{Mesh, block_errors, impedance_errors, rocking};

fn soil(poisson: f64) -> Soil {
    Soil::new(1.0, poisson, 1.0).unwrap()
}

/// G and H of a lag.
fn coefficients(kernel: &TimeKernel, lag: usize) -> [Vec<f64>; 2] {
    let size = 2 * kernel.segments().len();
    let (mut g, mut h) = (vec![7.0; size * size], vec![7.0; size * size]);
    kernel.coefficients(lag, &mut g, &mut h).unwrap();
    [g, h]
}

/// Polygon around a hole of area π, the soil outside (or inside).
fn circle(count: usize, outside: bool) -> Vec<Segment> {
    let angle = 2.0 * PI / count as f64;
    let radius = (PI / (0.5 * count as f64 * angle.sin())).sqrt();
    let node = |k: usize| {
        let a = (k % count) as f64 * angle;
        [radius * a.sin(), radius * a.cos()]
    };
    (0..count)
        .map(|k| {
            let (from, to) = (node(k), node(k + 1));
            if outside { Segment { from, to } } else { Segment { from: to, to: from } }
        })
        .collect()
}

/// GOAL: coefficients keep their relative precision at early, middle and late lags.
/// REFERENCE: quadrature of the fundamental solution with 40 digits; elements on the receiver's
/// line and above it, dd, dn, nn of G and traction components dd, dn, nd, nn of H.
#[test]
fn coefficients_match_forty_digits() {
    let mut count = 0;
    for row in table("full_plane_coefficients.csv").rows([
        "nu", "s1", "s2", "h", "lag", "u_dd", "u_dn", "u_nn", "t_dd", "t_dn", "t_nd", "t_nn",
    ]) {
        let [nu, low, high, height, lag, wanted @ ..] = row;
        // d to the right, n up (−z): the receiver is at the origin, the source `height` above it.
        let source = Segment { from: [low, -height], to: [high, -height] };
        let receiver = Segment { from: [-0.01, 0.0], to: [0.01, 0.0] };
        let kernel = TimeKernel::new(soil(nu), &[receiver, source], 0.5).unwrap();
        let [g, h] = coefficients(&kernel, whole(lag));
        let at = |m: &[f64], i: usize, j: usize| m[(2 * i) * 4 + 2 * j + 1];
        let found = [
            at(&g, 0, 0),
            -at(&g, 0, 1),
            at(&g, 1, 1),
            at(&h, 0, 0),
            -at(&h, 1, 0),
            -at(&h, 0, 1),
            at(&h, 1, 1),
        ];
        // Components of one kind, displacement or traction, are of one size.
        for kind in [0..3, 3..7] {
            let size = wanted[kind.clone()].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for k in kind {
                close("coefficient", found[k], wanted[k], 2e-13 * size, 0.0);
                count += 1;
            }
        }
    }
    assert_eq!(count, 70);
}

/// GOAL: the paper's sub-elements tend to the exact integrals, slowly where a front is inside.
#[test]
fn subelements_tend_to_the_exact_integrals() {
    let ends = |low, high| Segment { from: [low, 0.0], to: [high, 0.0] };
    let pair = [ends(-0.5, 0.5), ends(2.5, 3.5)];
    let make = || TimeKernel::new(soil(0.25), &pair, 0.47).unwrap();
    // The shear wave is inside the element at lag 6; both waves are past at lag 12.
    for (lag, order) in [(6, 0.4), (12, 1.9)] {
        let exact = coefficients(&make(), lag);
        let error = |count: usize| {
            let rough = coefficients(&make().with_subelements(count).unwrap(), lag);
            let size = exact[1].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            exact[1].iter().zip(&rough[1]).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / size
        };
        let errors = [error(5), error(5000)];
        println!("lag {lag}: {errors:?}");
        assert!(errors[1] < errors[0] / 1000.0_f64.powf(order));
    }
    assert!(matches!(make().with_subelements(0), Err(Error::Input { .. })));
}

/// GOAL: rigid translations: Σ H over lags and a closed polygon is 1 outside and 0 inside.
#[test]
fn rigid_motion_of_closed_polygons() {
    for (outside, wanted) in [(true, 1.0), (false, 0.0)] {
        let kernel = TimeKernel::new(soil(0.3), &circle(9, outside), 0.7).unwrap();
        let mut sum = [0.0; 18];
        for lag in 0..600 {
            let [_, h] = coefficients(&kernel, lag);
            for (sum, row) in sum.chunks_exact_mut(9).zip(h.chunks_exact(18 * 9)) {
                for (sum, row) in sum.iter_mut().zip(row.chunks_exact(18)) {
                    *sum += row[..9].iter().sum::<f64>();
                }
            }
        }
        // x-components of all elements move: the x rows see it, the z rows do not. What is left
        // after a time t falls like (r/ct)².
        for (k, sum) in sum.iter().enumerate() {
            close("row sum", *sum, if k < 9 { wanted } else { 0.0 }, 3e-5, 0.0);
        }
    }
}

#[test]
fn nothing_moves_before_the_pressure_wave() {
    let far = [
        Segment { from: [-0.5, 0.0], to: [0.5, 0.0] },
        Segment { from: [4.0, 3.0], to: [5.0, 3.5] },
    ];
    let kernel = TimeKernel::new(soil(0.0), &far, 0.1).unwrap();
    // 5 m at √2 m/s: 3.53 s.
    for lag in [0, 1, 20, 34] {
        let [g, h] = coefficients(&kernel, lag);
        for (i, j) in [(0, 1), (1, 0), (0, 3), (3, 0), (2, 3), (3, 2)] {
            assert_eq!([g[i * 4 + j], h[i * 4 + j]], [0.0; 2]);
        }
    }
    assert!(coefficients(&kernel, 36)[0][1] != 0.0);
}

/// Largest error of the radial displacement over 0 < t ≤ 8, relative to the static value ½, and
/// the largest departure of an element from the mean.
fn cavity_errors(poisson: f64, count: usize, time_step: f64) -> [f64; 2] {
    let segments = circle(count, true);
    let kernel = TimeKernel::new(soil(poisson), &segments, time_step).unwrap();
    let mut march =
        BoundaryMarch::new(Box::new(kernel), &vec![Given::Traction; 2 * count]).unwrap();
    // Pressure on the wall is a traction against the outward normal.
    let values: Vec<f64> =
        (0..2).flat_map(|k| segments.iter().map(move |s| -s.normal()[k])).collect();
    let table = table("cavity_step_pressure.csv");
    let column = table.column(if poisson == 0.0 { "u_nu0" } else { "u_nu025" });
    let (mut worst, mut uneven, mut seen) = (0.0_f64, 0.0_f64, 0);
    for n in 1..=whole(8.0 / time_step) {
        march.step(&values).unwrap();
        let u = march.displacement();
        let radial: Vec<f64> = segments
            .iter()
            .enumerate()
            .map(|(k, s)| -(u[k] * s.normal()[0] + u[count + k] * s.normal()[1]))
            .collect();
        let mean = radial.iter().sum::<f64>() / count as f64;
        uneven = radial.iter().fold(uneven, |m, r| m.max((r - mean).abs() / 0.5));
        let place = n as f64 * time_step / 0.2;
        if (place - place.round()).abs() < 1e-9 {
            worst = worst.max((mean - column[whole(place) - 1]).abs() / 0.5);
            seen += 1;
        }
    }
    assert!(seen >= 20);
    [worst, uneven]
}

/// GOAL: curved boundaries, first order in element and step.
/// SCENE: cavity under a pressure switched on at once, β from 1.3 to 2.6, where nothing grows.
/// REFERENCE: closed form in the Laplace domain (K₀, K₁).
#[test]
fn cavity_under_a_sudden_pressure() {
    let runs =
        [(24, 0.2), (48, 0.1), (96, 0.1)].map(|(count, step)| cavity_errors(0.25, count, step));
    let [even, odd] = [0, 1].map(|k| runs.map(|run| run[k]));
    within("cavity", &["24", "48", "96"], &even, &[9.5e-2, 3.3e-2, 2.6e-2]);
    within("cavity, unevenness", &["24", "48", "96"], &odd, &[1e-9; 3]);
}

fn time_mesh(elements: usize, free: usize, beta: f64) -> Mesh {
    Mesh { elements, free, beta, quadrature: None }
}

/// GOAL: the flat boundary is the half-plane, but for its truncated surface.
/// SCENE: bonded massless rigid strip of 8 elements, β = 1.15.
/// REFERENCE: impedances by a spectral method. The coupling, a small number that comes from H and the
/// free surface alone, is poor for every step and hardly better with twice the elements.
#[test]
fn impedances_of_the_bonded_strip() {
    for (free, limits) in
        [(5, [4.2e-2, 4.6e-2, 1.5e-1, 5.2e-1]), (10, [4.2e-2, 4.6e-2, 1.5e-1, 4.2e-1])]
    {
        let errors = impedance_errors("0333", 1.0 / 3.0, time_mesh(8, free, 1.15));
        within(&format!("{free} free"), &["khh", "kvv", "krr", "khr"], &errors, &limits);
    }
}

/// GOAL: what the truncated free surface leaves. The direct impedances are those of the mesh with or
/// without free elements; the coupling, which comes from the free surface and from H alone, tends
/// to the half-plane's with the root of the surface's length.
/// SCENE: as before by convolution quadrature (BDF2), which is bounded with any of these surfaces.
/// REFERENCE: impedances by a spectral method.
#[test]
fn coupling_settles_with_the_length_of_the_free_surface() {
    let mesh = |free| Mesh { elements: 8, free, beta: 1.15, quadrature: Some(CqMethod::Bdf2) };
    let ground = |free| mesh(free).ground(soil(1.0 / 3.0));
    let step = mesh(0).time_step(soil(1.0 / 3.0));
    assert!(ground(20).assess(step).unwrap().is_bounded());
    let errors = [0, 5, 20, 80].map(|free| impedance_errors("0333", 1.0 / 3.0, mesh(free)));
    for (errors, coupling) in errors.iter().zip([4.6e-1, 3.3e-1, 2.4e-1, 1.4e-1]) {
        let limits = [4.3e-2, 4.2e-2, 7.8e-2, coupling];
        within("BDF2", &["khh", "kvv", "krr", "khr"], errors, &limits);
    }
    for k in 0..3 {
        let all = errors.map(|errors| errors[k]);
        let (least, most) = all.iter().fold((1.0_f64, 0.0_f64), |m, e| (m.0.min(*e), m.1.max(*e)));
        assert!(most < 1.2 * least, "{k}: {all:?}");
    }
    // The last quadrupling of the length: by 2^(2 · 0.4).
    close("order", (errors[2][3] / errors[3][3]).log2() / 2.0, 0.4, 0.1, 0.0);
}

/// GOAL: both soils tend to the same answer in a coupled run.
/// SCENE: bonded rigid block under a Ricker pulse, 5 free elements on either side, β = 1.
#[test]
fn rigid_block_on_both_grounds() {
    for (count, free, limits) in [(8, 5, [6.2e-2, 7.6e-2, 3e-2]), (16, 5, [2.2e-2, 3.8e-2, 3.2e-2])]
    {
        let errors = block_errors(time_mesh(count, free, 1.0));
        within(&format!("{count}, {free}"), &["u_base", "theta", "V"], &errors, &limits);
    }
}

/// GOAL: contact with friction copes with an operator that is not symmetric.
/// SCENE: a block that rocks and slides, 5 free elements on either side, β = 2.
#[test]
fn rocking_and_sliding_on_both_grounds() {
    let [(slip, uplift), (other_slip, other_uplift)] = rocking(8, 5, 2.0);
    println!("uplift {uplift} {other_uplift}, slip {:?} {:?}", slip.last(), other_slip.last());
    let mut error = SeriesError::default();
    slip.iter().zip(&other_slip).for_each(|(a, b)| error.add(*a, *b));
    within("rocking", &["slip"], &[error.relative()], &[1e-2]);
    assert!(uplift > 0.0 && (uplift - other_uplift).abs() < 0.13);
}

/// GOAL: the static limit of the boundary equation is the half-plane's.
/// SCENE: a surface of which the last element dips by a millionth, so that it counts as uneven.
/// REFERENCE: the half-plane's static compliance; between two elements, as there is no datum.
#[test]
fn static_compliance_tends_to_the_half_planes() {
    let mut half = HalfPlaneGround::strip(soil(0.3), -1.0..1.0, 4).unwrap();
    half.prepare(0.1).unwrap();
    let mut wanted = [0.0; 64];
    half.static_compliance(&mut wanted).unwrap();
    // From the left element: z and x displacements between the two on the right, and how z and x
    // move each other.
    let measures = |matrix: &[f64]| {
        let at = |i: usize, j: usize| matrix[i * 8 + j];
        [at(2, 0) - at(3, 0), at(6, 4) - at(7, 4), at(3, 4), at(7, 0)]
    };
    let errors: [[f64; 4]; 3] = [5, 20, 80].map(|free| {
        let flat = Boundary::flat(&[Strip::uniform(-1.0..1.0, 4).unwrap()], free).unwrap();
        let mut segments = flat.segments().to_vec();
        segments.last_mut().unwrap().to[1] += 1e-6;
        let boundary = Boundary::new(segments, flat.contact()).unwrap();
        assert!(!boundary.is_flat());
        let ground = FullPlaneGround::new(soil(0.3), boundary);
        let mut found = [0.0; 64];
        ground.static_compliance(&mut found).unwrap();
        let [found, wanted] = [measures(&found), measures(&wanted)];
        std::array::from_fn(|k| (found[k] / wanted[k] - 1.0).abs())
    });
    // Midpoints against means, and elements as long as a quarter of the strip, leave a few percent.
    for (errors, coupling) in errors.iter().zip([1.2e-1, 1.1e-1, 8.5e-2]) {
        let limits = [1.7e-2, 1.7e-2, coupling, coupling];
        within("static", &["zz", "xx", "zx", "xz"], errors, &limits);
    }
}

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
                    // The free term asks for the displacement at the end.
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
fn canyon(size: f64) -> Boundary {
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

fn waves() -> VerticalWaves {
    VerticalWaves::new(soil(0.25), RickerDisplacement::new(1.0, 0.8, 4.0).unwrap(), 2.0).unwrap()
}

/// Mean scattered and largest incident displacement of the contact, down and along, per step.
fn scattered(boundary: Boundary, time_step: f64, steps: usize) -> Vec<[f64; 3]> {
    let ground = FullPlaneGround::new(soil(0.25), boundary).with_incident_field(waves());
    // Too few steps for growth to show.
    let mut ground = ground.skip_assessment();
    ground.prepare(time_step).unwrap();
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
        let mut ground = ground.skip_assessment();
        ground.prepare(step).unwrap();
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

/// GOAL: no silent answers: a boundary that is not flat needs its incident field, and that one does
/// not go with a motion of the scene.
#[test]
fn two_motions_are_refused() {
    let mut ground = FullPlaneGround::new(soil(0.25), canyon(0.5));
    assert!(matches!(ground.prepare(0.5), Err(Error::Scene { .. })));
    let mut ground = ground.with_incident_field(waves()).skip_assessment();
    ground.prepare(0.5).unwrap();
    let mut out = [0.0; 8];
    ground.free_field(&RickerDisplacement::new(1.0, 0.8, 4.0).unwrap(), 4.0, &mut out);
    assert!(out.iter().all(|x| x.is_nan()));
    assert!(matches!(ground.history(&mut out), Err(Error::Scene { .. })));
    // A simulation passes the reason on.
    let ground = FullPlaneGround::new(soil(0.25), canyon(0.5)).with_incident_field(waves());
    let elements = ground.elements().to_vec();
    let width = elements[elements.len() - 1].right - elements[0].left;
    let center = elements[0].left + 0.5 * width;
    let block = RigidBlock::new(width, 0.5, 1.0).unwrap().centered_at(center).unwrap();
    let simulation = Simulation::builder(0.5)
        .structure(block)
        .ground(ground.skip_assessment())
        .interface(Bonded)
        .motion(RickerDisplacement::new(1.0, 0.8, 4.0).unwrap());
    let error = simulation.build().map_or_else(Some, |mut s| s.step().err());
    let message = error.unwrap().to_string();
    assert!(message.contains("ground motion"), "{message}");
}

#[test]
fn bad_input_is_refused() {
    let soil = soil(0.25);
    let flat = |x: f64| Segment { from: [x, 0.0], to: [x + 1.0, 0.0] };
    let mut ground = FullPlaneGround::strip(soil, -1.0..1.0, 2, 2).unwrap();
    assert!(matches!(ground.history(&mut [0.0; 4]), Err(Error::Scene { .. })));
    assert!(matches!(ground.instantaneous(&mut [0.0; 16]), Err(Error::Scene { .. })));
    assert!(matches!(ground.reserve(9), Err(Error::Scene { .. })));
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(ground.prepare(step), Err(Error::Input { .. })));
    }
    ground.prepare(0.5).unwrap();
    assert!(matches!(ground.history(&mut [0.0; 3]), Err(Error::Size { .. })));
    assert!(matches!(ground.instantaneous(&mut [0.0; 15]), Err(Error::Size { .. })));
    assert!(matches!(ground.static_compliance(&mut [0.0; 15]), Err(Error::Size { .. })));
    ground.commit(&[]);
    let [empty, nan, point] =
        [vec![], vec![flat(f64::NAN)], vec![Segment { from: [1.0; 2], to: [1.0; 2] }]];
    assert!(matches!(Boundary::new(empty, &[]), Err(Error::Size { .. })));
    assert!(matches!(Boundary::new(nan, &[0]), Err(Error::Input { .. })));
    assert!(matches!(Boundary::new(point, &[0]), Err(Error::Input { .. })));
    assert!(matches!(Boundary::new(vec![flat(0.0)], &[1]), Err(Error::Index { .. })));
    assert!(matches!(Boundary::new(vec![flat(0.0)], &[]), Err(Error::Size { .. })));
    assert!(matches!(Boundary::new(vec![flat(0.0), flat(0.3)], &[0]), Err(Error::Input { .. })));
    let slope = vec![Segment { from: [0.0, 0.0], to: [1.0, 0.1] }];
    assert!(matches!(Boundary::new(slope, &[0]), Err(Error::Input { .. })));
    let kernel = || Box::new(TimeKernel::new(soil, &[flat(0.0)], 0.5).unwrap());
    assert!(matches!(BoundaryMarch::new(kernel(), &[]), Err(Error::Size { .. })));
    let mut march = BoundaryMarch::new(kernel(), &[Given::Traction; 2]).unwrap();
    assert!(matches!(march.step(&[1.0]), Err(Error::Size { .. })));
    assert!(matches!(VerticalWaves::new(soil, AtRest, f64::NAN), Err(Error::Input { .. })));
}
