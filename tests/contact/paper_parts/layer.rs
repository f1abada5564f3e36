//! GOAL: the thin-layer law is the element it stands for, and tends to hard contact as it stiffens.
//! SCENE: any motion of the four nodes of a layer element; blocks on layers of several thicknesses.
//! REFERENCE: one-point and exactly integrated quadrilaterals; hard contact; the weight carried.

use basemat::bem::{Grading, Ground};
use basemat::coupled::State;
use basemat::fem::{Element, Material, Quad4, QuadFormulation};
use basemat::interface::{
    ContactState, FrictionLimit, InterfaceLaw, Mode, PreviousContact, SlipSense, ThinLayer,
    Tolerance,
};
use basemat::results::Run;
use basemat::unobserved;
use basemat_problems::scenes::{GRAVITY, SI, block, friction, ground, scene, soil, tower};

const LENGTH: f64 = 1.3;
const HEIGHT: f64 = 0.8;

fn layer(ratio: f64) -> ThinLayer {
    ThinLayer::new(soil(SI), HEIGHT, 0.3).unwrap().with_thickness_ratio(ratio).unwrap()
}

/// Nodal forces of a thin quadrilateral, nodes counter-clockwise from below left.
fn element_forces(ratio: f64, formulation: QuadFormulation, u: &[f64; 8]) -> [f64; 8] {
    let soil = soil(SI);
    let young = 2.0 * soil.shear_modulus() * (1.0 + soil.poisson());
    let material = Material::new(young, soil.poisson(), 0.0).unwrap();
    let t = ratio * HEIGHT;
    let corners = [[0.0; 3], [LENGTH, 0.0, 0.0], [LENGTH, t, 0.0], [0.0, t, 0.0]];
    let mut stiffness = vec![0.0; 64];
    Quad4::new([0, 1, 2, 3], material, formulation).stiffness(&corners, &mut stiffness);
    std::array::from_fn(|i| (0..8).map(|j| stiffness[8 * i + j] * u[j]).sum())
}

/// The same from the law: tractions of the mean jump, shared by halves.
fn law_forces(law: &ThinLayer, u: &[f64; 8]) -> [f64; 8] {
    let mean = |k: usize| 0.5 * (u[4 + k] + u[6 + k] - u[k] - u[2 + k]);
    let (slip, gap) = (mean(0), mean(1));
    // Conditions are linear: pressure and shear follow from gap and slip.
    let start = PreviousContact::new(ContactState::default(), Mode::Stick, 1.0);
    let [normal, along] = law.conditions(Mode::Stick, &start);
    let pressure = (normal.value - normal.gap * gap) / normal.pressure;
    let shear = (along.value - along.slip * slip) / along.shear;
    let force = [0.5 * LENGTH * shear, -0.5 * LENGTH * pressure];
    std::array::from_fn(|i| if i < 4 { -force[i % 2] } else { force[i % 2] })
}

fn apart(a: &[f64; 8], b: &[f64; 8]) -> f64 {
    let size = |x: &[f64; 8]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    size(&std::array::from_fn(|i| a[i] - b[i])) / size(b)
}

/// Any motion of the four nodes: what differs are the strains along the layer, t/L beside those
/// across it.
#[test]
fn one_point_element_tends_to_the_law() {
    let u = [0.3, -0.2, 0.5, 0.4, -0.1, 0.9, 0.7, -0.6];
    let error = |ratio| {
        apart(&element_forces(ratio, QuadFormulation::OnePoint, &u), &law_forces(&layer(ratio), &u))
    };
    for ratio in [1e-1, 1e-2, 1e-3] {
        let order = (error(ratio) / error(0.1 * ratio)).log10();
        println!("{ratio:e}: {:.3e}, order {order:.3}", error(ratio));
        assert!((order - 1.0).abs() < 0.1, "{ratio}: {order}");
    }
}

/// A jump that does not vary along the element is all that the law sees; exact integration gives
/// the same forces, whatever the thickness.
#[test]
fn uniform_jumps_are_exact_in_both_integrations() {
    let u = [0.0, 0.0, 0.0, 0.0, 0.6, 0.3, 0.6, 0.3];
    for formulation in [QuadFormulation::OnePoint, QuadFormulation::Full] {
        for ratio in [1.0, 0.1, 1e-4] {
            let forces = element_forces(ratio, formulation, &u);
            // Poisson's effect: a layer that thickens pulls its ends apart along x.
            let sums: Vec<_> = (0..2).map(|k| forces[4 + k] + forces[6 + k]).collect();
            let law = law_forces(&layer(ratio), &u);
            for k in 0..2 {
                assert!((sums[k] / (2.0 * law[4 + k]) - 1.0).abs() < 1e-12);
            }
        }
    }
}

/// With jumps g₁, g₂ at the ends, exact integration stores ½ k L (mean² + (g₂−g₁)²/12), the law and
/// the one-point element the first term only.
#[test]
fn exact_integration_keeps_the_variation_along_the_element() {
    let (g1, g2) = (0.2, 0.7);
    let u = [0.0, 0.0, 0.0, 0.0, 0.0, g2, 0.0, g1];
    let ratio = 1e-6;
    let work = |f: [f64; 8]| 0.5 * f.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>();
    let full = work(element_forces(ratio, QuadFormulation::Full, &u));
    let mean = work(law_forces(&layer(ratio), &u));
    let wanted = 1.0 + (g2 - g1) * (g2 - g1) / 12.0 / (0.5 * (g1 + g2)).powi(2);
    assert!((full / mean / wanted - 1.0).abs() < 1e-5, "{}", full / mean);
}

fn states(law: impl InterfaceLaw + 'static) -> (Vec<State>, Run) {
    let mut simulation = scene(SI, 0.6).structure(block(SI)).interface(law).build().unwrap();
    let mut states = Vec::new();
    let run = simulation.run(400, |state| states.push(state.clone())).unwrap();
    (states, run)
}

/// Relative distance of two histories of slip and rotation.
fn history_error(a: &[State], b: &[State]) -> f64 {
    let square = |x: f64| x * x;
    let (mut apart, mut size) = ([0.0; 2], [0.0; 2]);
    for (a, b) in a.iter().zip(b) {
        for (k, (a, b)) in
            [(a.mean_slip, b.mean_slip), (a.base_rotation, b.base_rotation)].into_iter().enumerate()
        {
            apart[k] += square(a - b);
            size[k] += square(b);
        }
    }
    (apart[0] / size[0]).max(apart[1] / size[1]).sqrt()
}

#[test]
fn stiff_layers_tend_to_hard_contact() {
    let (hard, run) = states(friction(0.3));
    assert!(
        run.whole.uplifted_fraction.largest().value > 0.2
            && run.whole.largest_slip.largest().value.abs() > 1e-3,
        "{run}"
    );
    let errors: Vec<_> = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6]
        .map(|ratio| {
            let (soft, run) = states(layer(ratio).with_debonded_ratio(0.0).unwrap());
            let error = history_error(&soft, &hard);
            println!("{ratio:e}: {error:.3e}, energy balance {:.1e}", run.energy_error);
            assert!(run.energy_error < 1e-9);
            error
        })
        .into();
    let order = (errors[2] / errors[4]).log10() / 2.0;
    println!("order {order:.3}");
    assert!((order - 1.0).abs() < 0.3, "{order}");
    assert!(errors[5] < 1e-4, "{errors:?}");
}

/// Largest eigenvalue of a symmetric positive matrix, by the power method.
fn largest_eigenvalue(multiply: impl Fn(&[f64]) -> Vec<f64>, size: usize) -> f64 {
    let mut x: Vec<f64> = (0..size).map(|i| 1.0 + 0.1 * (i as f64).sin()).collect();
    let mut value = 0.0;
    for _ in 0..20_000 {
        let y = multiply(&x);
        value = y.iter().map(|y| y * y).sum::<f64>().sqrt();
        x = y.iter().map(|y| y / value).collect();
    }
    value
}

/// Condition number of G¹ + 1/k, uniform elements, the operator of a bonded base that cannot move.
/// The compliance adds to the diagonal, so no layer, however stiff, makes it worse than none.
#[test]
fn conditioning_of_the_contact_operator() {
    let mut soil_ground = ground(SI, 10, Grading::Uniform);
    soil_ground.prepare(2.5e-3, None, &mut unobserved).unwrap();
    let size = 20;
    let mut soil = vec![0.0; size * size];
    soil_ground.step_compliance(&mut soil).unwrap();
    let condition = |compliance: [f64; 2]| {
        let multiply = |x: &[f64], shift: f64| -> Vec<f64> {
            (0..size)
                .map(|i| {
                    let row: f64 = (0..size).map(|j| soil[i * size + j] * x[j]).sum();
                    row + (compliance[i / 10] - shift) * x[i]
                })
                .collect()
        };
        let top = largest_eigenvalue(|x| multiply(x, 0.0), size);
        let bottom = top - largest_eigenvalue(|x| multiply(x, top), size);
        (top / bottom, bottom)
    };
    let (hard, bottom) = condition([0.0; 2]);
    let start = PreviousContact::new(ContactState::default(), Mode::Stick, 1.0);
    println!("none: {hard:.4}");
    assert!(bottom > 0.0);
    for ratio in [1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        let law = ThinLayer::new(basemat_problems::scenes::soil(SI), 1.0, 0.3).unwrap();
        let law = law.with_thickness_ratio(ratio).unwrap();
        let (soft, _) = condition(law.compliance(Mode::Stick, &start));
        println!("{ratio:e}: {soft:.4}");
        assert!(soft < 10.0 * hard);
        if ratio <= 1e-4 {
            assert!((soft / hard - 1.0).abs() < 1e-2);
        }
    }
}

/// Under weight alone each layer is shorter by p/k, and the pressures carry the weight.
#[test]
fn preload_compresses_the_layer() {
    let law = layer(0.1);
    let simulation = scene(SI, 0.0).structure(tower(SI, None)).interface(law).build().unwrap();
    let state = simulation.state();

    let weight = 4.0 * 6.0 * 1500.0 * GRAVITY;
    assert!((state.normal_force / weight - 1.0).abs() < 1e-9);
    for contact in &state.contact {
        let wanted = -contact.pressure / law.stiffness()[0];
        assert!((contact.gap / wanted - 1.0).abs() < 1e-12);
        assert_eq!((contact.shear, contact.slip), (0.0, 0.0));
    }
    // And nothing moves while nothing shakes.
    let mut simulation = simulation;
    let run = simulation.run(50, |_| {}).unwrap();
    assert!(
        run.whole.base_shear.magnitude() < 1e-9 * weight
            && run.whole.largest_slip.largest().value.abs() < 1e-12
    );
}

#[test]
fn admissible_states_stay_and_others_change() {
    let law = layer(0.1);
    let [normal, shear] = law.stiffness();
    let tolerance = Tolerance::new(1e-13, 1e-6);
    let mut start = PreviousContact::new(ContactState::default(), Mode::Stick, 1e-3);
    start.static_pressure = 500.0;
    let at = |pressure: f64, traction: f64, slip: f64| ContactState {
        gap: -pressure / normal,
        slip,
        pressure,
        shear: traction,
        ..ContactState::default()
    };
    let next = |law: &ThinLayer, mode, start: &PreviousContact, state: ContactState| {
        law.next_mode(mode, start, &state, tolerance)
    };
    assert_eq!(next(&law, Mode::Stick, &start, at(1e3, 299.0, 299.0 / shear)), Mode::Stick);
    assert_eq!(next(&law, Mode::Stick, &start, at(1e3, 301.0, 301.0 / shear)), Mode::SlipRight);
    assert_eq!(next(&law, Mode::Stick, &start, at(1e3, -301.0, -301.0 / shear)), Mode::SlipLeft);
    assert_eq!(next(&law, Mode::Stick, &start, at(-1.0, 0.0, 0.0)), Mode::Open);
    assert_eq!(next(&law, Mode::SlipRight, &start, at(1e3, 300.0, 350.0 / shear)), Mode::SlipRight);
    // Slip smaller than the elastic one: it did not slip.
    assert_eq!(next(&law, Mode::SlipRight, &start, at(1e3, 300.0, 250.0 / shear)), Mode::Stick);
    let by_velocity = law.with_slip_sense(SlipSense::Velocity);
    assert_eq!(
        next(&by_velocity, Mode::SlipRight, &start, at(1e3, 300.0, 250.0 / shear)),
        Mode::SlipRight
    );
    start.slip_rate = -1.0;
    let by_last = law.with_slip_sense(SlipSense::LastVelocity);
    assert_eq!(next(&by_last, Mode::Stick, &start, at(1e3, 301.0, 301.0 / shear)), Mode::SlipLeft);
    let fixed = law.with_friction_limit(FrictionLimit::Static);
    assert_eq!(next(&fixed, Mode::Stick, &start, at(1e3, 151.0, 0.0)), Mode::SlipRight);
    assert_eq!(next(&fixed, Mode::Stick, &start, at(1e3, 149.0, 0.0)), Mode::Stick);
    start.state.pressure = 200.0;
    let lagged = law.with_friction_limit(FrictionLimit::Lagged);
    assert_eq!(next(&lagged, Mode::Stick, &start, at(1e3, 61.0, 0.0)), Mode::SlipRight);
    let dynamic = law.with_friction_limit(FrictionLimit::Dynamic);
    assert_eq!(next(&dynamic, Mode::Stick, &start, at(1e3, 89.0, 0.0)), Mode::Stick);
    assert_eq!(next(&dynamic, Mode::Stick, &start, at(1e3, 91.0, 0.0)), Mode::SlipRight);
}
