//! GOAL: the thin-layer law is the limit of its element, and tends to hard contact as it stiffens.
//! SCENE: any motion of the four nodes of a layer element; blocks on layers of several thicknesses.
//! REFERENCE: one-point and exactly integrated quadrilaterals; hard contact; the weight.

use basemat::bem::{Grading, Ground};
use basemat::coupled::State;
use basemat::fem::{Element, Material, Quad4, QuadFormulation};
use basemat::interface::{
    ContactState, FrictionLimit, InterfaceLaw, Mode, PreviousContact, SlipSense, ThinLayer,
    Tolerance,
};
use basemat::results::Run;
use basemat::unobserved;
use basemat_problems::scenes::{
    SCENE_GRAVITY, SI_UNITS, block, friction, ground, scene, soil, tower,
};

const ELEMENT_LENGTH: f64 = 1.3;
/// Height of the layer before its thickness ratio, m.
const LAYER_HEIGHT: f64 = 0.8;

fn layer(ratio: f64) -> ThinLayer {
    ThinLayer::new(soil(SI_UNITS), LAYER_HEIGHT, 0.3)
        .unwrap()
        .with_thickness_ratio(ratio)
        .unwrap()
}

/// Nodal forces of a thin quadrilateral, nodes counter-clockwise from below left.
fn element_forces(ratio: f64, formulation: QuadFormulation, u: &[f64; 8]) -> [f64; 8] {
    let soil = soil(SI_UNITS);
    let young = 2.0 * soil.shear_modulus() * (1.0 + soil.poisson());
    let material = Material::new(young, soil.poisson(), 0.0).unwrap();
    let t = ratio * LAYER_HEIGHT;
    let corners = [[0.0; 3], [ELEMENT_LENGTH, 0.0, 0.0], [ELEMENT_LENGTH, t, 0.0], [0.0, t, 0.0]];
    let mut stiffness = vec![0.0; 64];
    Quad4::new([0, 1, 2, 3], material, formulation).stiffness(&corners, &mut stiffness);
    std::array::from_fn(|i| (0..8).map(|j| stiffness[8 * i + j] * u[j]).sum())
}

/// Nodal forces by the law: tractions of the mean jump, half of them at each end.
fn law_forces(law: &ThinLayer, u: &[f64; 8]) -> [f64; 8] {
    let jump = [0, 1].map(|k| 0.5 * (u[4 + k] + u[6 + k] - u[k] - u[2 + k]));
    // The conditions are linear: pressure and shear follow from gap and slip.
    let start = PreviousContact::new(ContactState::default(), Mode::Stick, 1.0);
    let [normal, along] = law.conditions(Mode::Stick, &start);
    let pressure = (normal.value - normal.gap * jump[1]) / normal.pressure;
    let shear = (along.value - along.slip * jump[0]) / along.shear;
    let force = [0.5 * ELEMENT_LENGTH * shear, -0.5 * ELEMENT_LENGTH * pressure];
    std::array::from_fn(|i| if i < 4 { -force[i % 2] } else { force[i % 2] })
}

fn norm(x: &[f64; 8]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Difference between the forces of the one-point element and of the law, relative to the latter.
fn one_point_error(ratio: f64) -> f64 {
    let u = [0.3, -0.2, 0.5, 0.4, -0.1, 0.9, 0.7, -0.6];
    let element = element_forces(ratio, QuadFormulation::OnePoint, &u);
    let law = law_forces(&layer(ratio), &u);
    norm(&std::array::from_fn(|i| element[i] - law[i])) / norm(&law)
}

/// For any motion of the nodes the difference is of first order in the thickness.
///
/// It comes from the strains along the layer, which are t/L times the strains across it.
#[test]
fn one_point_element_tends_to_the_law() {
    for ratio in [1e-1, 1e-2, 1e-3] {
        let error = one_point_error(ratio);
        let order = (error / one_point_error(0.1 * ratio)).log10();
        println!("{ratio:e}: {error:.3e}, order {order:.3}");
        assert!((order - 1.0).abs() < 0.1, "{ratio}: {order}");
    }
}

/// For a jump that is constant along the element, all integrations have the forces of the law.
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

fn work(forces: &[f64; 8], u: &[f64; 8]) -> f64 {
    0.5 * forces.iter().zip(u).map(|(f, u)| f * u).sum::<f64>()
}

/// With jumps g₁, g₂ at the ends, exact integration stores ½ k L (mean² + (g₂−g₁)²/12).
///
/// The law and the one-point element have the first term only.
#[test]
fn exact_integration_contains_the_variation_along_the_element() {
    let g1 = 0.2;
    let g2 = 0.7;
    let u = [0.0, 0.0, 0.0, 0.0, 0.0, g2, 0.0, g1];
    let ratio = 1e-6;
    let by_element = work(&element_forces(ratio, QuadFormulation::Full, &u), &u);
    let by_law = work(&law_forces(&layer(ratio), &u), &u);
    let expected = 1.0 + (g2 - g1) * (g2 - g1) / 12.0 / (0.5 * (g1 + g2)).powi(2);
    assert!((by_element / by_law / expected - 1.0).abs() < 1e-5, "{}", by_element / by_law);
}

/// A run and all its states.
struct RecordedRun {
    states: Vec<State>,
    run: Run,
}

fn recorded_run(law: impl InterfaceLaw + 'static) -> RecordedRun {
    let mut simulation =
        scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interface(law).build().unwrap();
    let mut states = Vec::new();
    let run = simulation.run(400, |state| states.push(state.clone())).unwrap();
    RecordedRun { states, run }
}

/// Difference of a quantity over a run, relative to its reference.
fn relative_difference(computed: &[State], reference: &[State], value: fn(&State) -> f64) -> f64 {
    let mut squared_difference = 0.0;
    let mut squared_reference = 0.0;
    for (computed, reference) in computed.iter().zip(reference) {
        let difference = value(computed) - value(reference);
        squared_difference += difference * difference;
        squared_reference += value(reference) * value(reference);
    }
    (squared_difference / squared_reference).sqrt()
}

/// Difference of two histories of slip and rotation.
fn history_error(computed: &[State], reference: &[State]) -> f64 {
    let slip_error = relative_difference(computed, reference, |state| state.mean_slip);
    slip_error.max(relative_difference(computed, reference, |state| state.base_rotation))
}

#[test]
fn stiff_layers_tend_to_hard_contact() {
    let hard_contact = recorded_run(friction(0.3));
    assert!(hard_contact.run.whole.uplifted_fraction.largest().value > 0.2, "{}", hard_contact.run);
    assert!(
        hard_contact.run.whole.largest_slip.largest().value.abs() > 1e-3,
        "{}",
        hard_contact.run
    );
    let errors = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6].map(|ratio| {
        let soft_layer = recorded_run(layer(ratio).with_debonded_ratio(0.0).unwrap());
        let error = history_error(&soft_layer.states, &hard_contact.states);
        println!("{ratio:e}: {error:.3e}, energy balance {:.1e}", soft_layer.run.energy_error);
        assert!(soft_layer.run.energy_error < 1e-9);
        error
    });
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

/// Order of the operator: two components for each of ten elements.
const OPERATOR_SIZE: usize = 20;

/// G¹ + 1/k, the operator of a bonded base that cannot move.
struct ContactOperator<'a> {
    step_compliance: &'a [f64],
    layer_compliance: [f64; 2],
}

impl ContactOperator<'_> {
    /// Product of the operator minus a shift of its diagonal.
    fn multiply_shifted(&self, x: &[f64], shift: f64) -> Vec<f64> {
        let rows = self.step_compliance.chunks(OPERATOR_SIZE).enumerate();
        rows.map(|(i, row)| {
            let product: f64 = row.iter().zip(x).map(|(entry, x)| entry * x).sum();
            product + (self.layer_compliance[i / 10] - shift) * x[i]
        })
        .collect()
    }

    /// Smallest and largest eigenvalue.
    fn extreme_eigenvalues(&self) -> [f64; 2] {
        let max_eigenvalue = largest_eigenvalue(|x| self.multiply_shifted(x, 0.0), OPERATOR_SIZE);
        let gap = largest_eigenvalue(|x| self.multiply_shifted(x, max_eigenvalue), OPERATOR_SIZE);
        [max_eigenvalue - gap, max_eigenvalue]
    }

    fn condition(&self) -> f64 {
        let eigenvalues = self.extreme_eigenvalues();
        assert!(eigenvalues[0] > 0.0);
        eigenvalues[1] / eigenvalues[0]
    }
}

/// No layer, however stiff, makes the condition worse than hard contact.
///
/// The compliance adds to the diagonal.
#[test]
fn layers_do_not_worsen_the_condition_of_the_contact_operator() {
    let mut ground = ground(SI_UNITS, 10, Grading::Uniform);
    ground.prepare(2.5e-3, None, &mut unobserved).unwrap();
    let mut step_compliance = vec![0.0; OPERATOR_SIZE * OPERATOR_SIZE];
    ground.step_compliance(&mut step_compliance).unwrap();
    let step_compliance = &step_compliance;
    let condition_of_hard_contact =
        ContactOperator { step_compliance, layer_compliance: [0.0; 2] }.condition();
    let start = PreviousContact::new(ContactState::default(), Mode::Stick, 1.0);
    println!("none: {condition_of_hard_contact:.4}");
    for ratio in [1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        let law = ThinLayer::new(soil(SI_UNITS), 1.0, 0.3).unwrap();
        let law = law.with_thickness_ratio(ratio).unwrap();
        let layer_compliance = law.compliance(Mode::Stick, &start);
        let condition_with_layer =
            ContactOperator { step_compliance, layer_compliance }.condition();
        println!("{ratio:e}: {condition_with_layer:.4}");
        assert!(condition_with_layer < 10.0 * condition_of_hard_contact);
        if ratio <= 1e-4 {
            assert!((condition_with_layer / condition_of_hard_contact - 1.0).abs() < 1e-2);
        }
    }
}

/// Under weight each layer is shorter by p/k, and the pressures carry the weight.
#[test]
fn preload_compresses_the_layer() {
    let law = layer(0.1);
    let builder = scene(SI_UNITS, 0.0).structure(tower(SI_UNITS, None)).interface(law);
    let mut simulation = builder.build().unwrap();
    let state = simulation.state();
    let weight = 4.0 * 6.0 * 1500.0 * SCENE_GRAVITY;
    assert!((state.normal_force / weight - 1.0).abs() < 1e-9);
    for contact in &state.contact {
        let expected = -contact.pressure / law.stiffness()[0];
        assert!((contact.gap / expected - 1.0).abs() < 1e-12);
        assert_eq!((contact.shear, contact.slip), (0.0, 0.0));
    }
    // Without shaking the blocks are at rest.
    let run = simulation.run(50, |_| {}).unwrap();
    assert!(run.whole.base_shear.magnitude() < 1e-9 * weight);
    assert!(run.whole.largest_slip.largest().value.abs() < 1e-12);
}

/// A trial step of an element on the layer of thickness ratio 0.1.
#[derive(Clone, Copy)]
struct LayerTrial {
    mode: Mode,
    pressure: f64,
    shear: f64,
    /// Slip over the elastic slip per shear traction, Pa.
    slip_traction: f64,
}

impl LayerTrial {
    /// A trial under a pressure of 1 kPa whose slip is elastic.
    fn elastic(mode: Mode, shear: f64) -> Self {
        Self { mode, pressure: 1e3, shear, slip_traction: shear }
    }

    /// The mode that the law chooses next.
    fn next_mode(self, law: &ThinLayer, start: &PreviousContact) -> Mode {
        let stiffness = layer(0.1).stiffness();
        let state = ContactState {
            gap: -self.pressure / stiffness[0],
            slip: self.slip_traction / stiffness[1],
            pressure: self.pressure,
            shear: self.shear,
            ..ContactState::default()
        };
        law.next_mode(self.mode, start, &state, Tolerance::new(1e-13, 1e-6))
    }
}

#[test]
fn admissible_states_keep_their_mode_and_others_change() {
    let law = layer(0.1);
    let start = PreviousContact::new(ContactState::default(), Mode::Stick, 1e-3);
    for (shear, expected) in
        [(299.0, Mode::Stick), (301.0, Mode::SlipRight), (-301.0, Mode::SlipLeft)]
    {
        let trial = LayerTrial::elastic(Mode::Stick, shear);
        assert_eq!(trial.next_mode(&law, &start), expected);
    }
    let tension = LayerTrial { pressure: -1.0, ..LayerTrial::elastic(Mode::Stick, 0.0) };
    assert_eq!(tension.next_mode(&law, &start), Mode::Open);
    let slip = LayerTrial { slip_traction: 350.0, ..LayerTrial::elastic(Mode::SlipRight, 300.0) };
    assert_eq!(slip.next_mode(&law, &start), Mode::SlipRight);
}

/// A slip smaller than the elastic slip is not inelastic.
#[test]
fn the_sense_of_slip_is_inelastic_or_by_velocity() {
    let law = layer(0.1);
    let mut start = PreviousContact::new(ContactState::default(), Mode::Stick, 1e-3);
    let slip = LayerTrial { slip_traction: 250.0, ..LayerTrial::elastic(Mode::SlipRight, 300.0) };
    assert_eq!(slip.next_mode(&law, &start), Mode::Stick);
    let by_velocity = law.with_slip_sense(SlipSense::Velocity);
    assert_eq!(slip.next_mode(&by_velocity, &start), Mode::SlipRight);
    start.slip_rate = -1.0;
    let by_last_velocity = law.with_slip_sense(SlipSense::LastVelocity);
    let trial = LayerTrial::elastic(Mode::Stick, 301.0);
    assert_eq!(trial.next_mode(&by_last_velocity, &start), Mode::SlipLeft);
    // A velocity has no tolerance: that of slips is a length.
    start.slip_rate = -1e-12;
    let sliding = LayerTrial::elastic(Mode::SlipRight, 300.0);
    assert_eq!(sliding.next_mode(&by_last_velocity, &start), Mode::Stick);
    start.slip_rate = 0.0;
    assert_eq!(sliding.next_mode(&by_last_velocity, &start), Mode::SlipRight);
}

/// The friction limit follows from the static, the previous or the dynamic pressure.
#[test]
fn friction_limits_follow_from_their_pressure() {
    let mut start = PreviousContact::new(ContactState::default(), Mode::Stick, 1e-3);
    start.static_pressure = 500.0;
    start.state.pressure = 200.0;
    for (limit, shear, expected) in [
        (FrictionLimit::Static, 151.0, Mode::SlipRight),
        (FrictionLimit::Static, 149.0, Mode::Stick),
        (FrictionLimit::Lagged, 61.0, Mode::SlipRight),
        (FrictionLimit::Dynamic, 89.0, Mode::Stick),
        (FrictionLimit::Dynamic, 91.0, Mode::SlipRight),
    ] {
        let law = layer(0.1).with_friction_limit(limit);
        let trial = LayerTrial { slip_traction: 0.0, ..LayerTrial::elastic(Mode::Stick, shear) };
        assert_eq!(trial.next_mode(&law, &start), expected, "{limit:?} {shear}");
    }
}
