//! GOAL: yielding and base-isolated buildings in the coupled integrator.
//! SCENE: five storeys on the half-plane under El Centro; one storey on rock.
//! REFERENCE: tangents by differences, the energy balance, Runge–Kutta integration.

use basemat::bem::{ElasticGround, SpringGround, Strip};
use basemat::coupled::{Newmark, Probe, SimulationBuilder, Theta};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{FreeFieldFn, STANDARD_GRAVITY, el_centro_1940};
use basemat::results::Run;
use basemat::structure::{
    Bilinear, BoucWen, FrictionPendulum, Hysteresis, IsolationLevel, LeadRubber, ShearBuilding,
    Storey, Structure, Triplets,
};
use basemat::{Simulation, Soil};

fn five_storeys() -> ShearBuilding {
    let storeys = [Storey::new(3.0, 20.0e3, 40.0e6); 5];
    let building = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys).unwrap();
    building.with_stiffness_damping(0.02).unwrap()
}

const ISOLATION_LEVEL: IsolationLevel =
    IsolationLevel { height: 0.3, slab_mass: 30.0e3, slab_inertia: 2.5e5, damping: 0.0 };

fn isolated(law: impl Hysteresis + 'static) -> ShearBuilding {
    five_storeys().isolated(ISOLATION_LEVEL, law).unwrap()
}

/// All storeys yield at 0.15 of the weight above.
fn yielding_building(law: impl Fn(f64) -> Box<dyn Hysteresis>) -> ShearBuilding {
    let mut building = five_storeys();
    for storey in 0..5 {
        let weight = STANDARD_GRAVITY * 20.0e3 * (5 - storey) as f64;
        building = building.with_law(storey, law(0.15 * weight)).unwrap();
    }
    building
}

/// Constructor of a structure.
type MakeBuilding = Box<dyn Fn() -> ShearBuilding>;

fn bilinear_storeys() -> ShearBuilding {
    yielding_building(|force| Box::new(Bilinear::new(40e6, force, 0.03).unwrap()))
}

fn bouc_wen_storeys(hardening: f64) -> ShearBuilding {
    yielding_building(|force| Box::new(BoucWen::new(40e6, force, hardening).unwrap()))
}

/// Forces of the laws at these displacements.
fn law_force(building: &ShearBuilding, u: &[f64; 8]) -> [f64; 8] {
    let mut force = [0.0; 8];
    building.nonlinear().unwrap().force(u, &mut force).unwrap();
    force
}

fn on_soil(structure: impl Structure + 'static, time_step: f64) -> SimulationBuilder {
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    Simulation::builder(time_step)
        .structure(structure)
        .ground(ElasticGround::new(soil, Strip::uniform(-5.0..5.0, 8).unwrap()).unwrap())
        .interface(Coulomb::new(0.4).unwrap())
        .motion(el_centro_1940())
        .gravity(STANDARD_GRAVITY)
}

/// A clone has the laws with their internal variables, and yields independently.
#[test]
fn clones_yield_independently() {
    let mut building = bouc_wen_storeys(0.05);
    let yielding_displacement = [0.0, 0.0, 0.0, 0.02, 0.03, 0.03, 0.04, 0.05];
    let at_rest = [0.0; 8];
    let initial_force = law_force(&building, &at_rest);
    building.nonlinear_mut().unwrap().commit(&yielding_displacement);
    let mut clone = building.clone();
    let yield_force = law_force(&building, &at_rest);
    assert!(yield_force != initial_force && law_force(&clone, &at_rest) == yield_force);
    clone.nonlinear_mut().unwrap().commit(&at_rest);
    clone.nonlinear_mut().unwrap().commit(&yielding_displacement.map(|u| -u));
    assert!(law_force(&clone, &at_rest) != yield_force && law_force(&building, &at_rest) == yield_force);
}

/// ∂f/∂u of the whole structure by central differences, where no law is near a kink.
#[test]
fn tangents_are_differences_of_forces() {
    let mut building = bouc_wen_storeys(0.05);
    building.nonlinear_mut().unwrap().commit(&[0.0, 0.0, 0.0, 0.004, 0.01, 0.012, 0.011, 0.015]);
    let u = [0.001, 0.002, 1e-4, 0.003, 0.012, 0.0125, 0.0115, 0.0162];
    let mut matrix = Triplets::new(8);
    building.nonlinear().unwrap().tangent(&u, &mut matrix).unwrap();
    let mut tangent = [[0.0; 8]; 8];
    for &(i, j, value) in matrix.entries() {
        tangent[i][j] += value;
    }
    for j in 0..8 {
        let [above, below] = [1e-7, -1e-7].map(|step| {
            let mut shifted_displacement = u;
            shifted_displacement[j] += step;
            law_force(&building, &shifted_displacement)
        });
        for i in 0..8 {
            let computed = (above[i] - below[i]) / 2e-7;
            let expected = tangent[i][j];
            assert!((computed - expected).abs() < 1e-6 * 4e8, "{i} {j}: {computed} {expected}");
        }
    }
}

/// All laws in the coupled integrator with uplift and friction: Newton converges, the energy balance closes,
/// and the laws dissipate energy.
#[test]
fn runs_converge_and_the_energy_balance_closes() {
    let weight = STANDARD_GRAVITY * 130.0e3;
    let runs: Vec<(&str, MakeBuilding)> = vec![
        ("bilinear storeys", Box::new(bilinear_storeys)),
        ("Bouc–Wen storeys", Box::new(|| bouc_wen_storeys(0.03))),
        (
            "friction pendulum",
            Box::new(move || isolated(FrictionPendulum::new(weight, 2.0, 0.06).unwrap())),
        ),
        (
            "lead–rubber",
            Box::new(move || isolated(LeadRubber::from_strength(0.6e6, 0.06 * weight).unwrap())),
        ),
    ];
    for (name, structure) in &runs {
        for time_step in [0.01, 0.0025] {
            let mut simulation = on_soil(structure(), time_step).build().unwrap();
            let mut dissipated_energy = 0.0;
            let run = simulation
                .run(1500, |state| {
                    assert!(state.energy_balance.hysteresis >= dissipated_energy, "{name} returns energy");
                    dissipated_energy = state.energy_balance.hysteresis;
                })
                .unwrap();
            let energy_balance = run.energy_balance;
            println!("{name}, {time_step} s: {run}");
            assert!(run.energy_error < 1e-9, "{name}: {:e}", run.energy_error);
            assert!(dissipated_energy > 0.05 * energy_balance.input, "{name} dissipates little");
            assert!(energy_balance.strain >= -1e-9 * energy_balance.input, "{name}");
            // One point in a step: the error of the midpoint rule falls with the step.
            let midpoint_error = energy_balance.algorithmic.abs() / energy_balance.input;
            assert!(midpoint_error < if time_step > 0.005 { 0.05 } else { 0.01 }, "{name}: {midpoint_error}");
        }
    }
}

fn run_of(builder: SimulationBuilder) -> Run {
    builder.build().unwrap().run(800, |_| {}).unwrap()
}

#[test]
fn other_time_schemes_dissipate_about_as_much() {
    let schemes = [
        run_of(on_soil(bilinear_storeys(), 0.005)),
        run_of(on_soil(bilinear_storeys(), 0.005).scheme(Newmark::default())),
        run_of(on_soil(bilinear_storeys(), 0.005).scheme(Theta::new(0.55).unwrap())),
    ];
    for run in &schemes {
        assert!(run.energy_error < 1e-9);
        let ratio = run.energy_balance.hysteresis / schemes[0].energy_balance.hysteresis;
        assert!((ratio - 1.0).abs() < 0.25, "{ratio}");
    }
}

/// Displacement, velocity and acceleration of the ground under the single storey: two frequencies from rest.
fn ground(t: f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (amplitude, w) in [(0.03, 4.0), (0.01, 9.0_f64)] {
        sum[0] += amplitude * (1.0 - (w * t).cos() - 0.5 * (1.0 - (2.0 * w * t).cos()) / 4.0);
        sum[1] += amplitude * w * ((w * t).sin() - (2.0 * w * t).sin() / 4.0);
        sum[2] += amplitude * w * w * ((w * t).cos() - (2.0 * w * t).cos() / 2.0);
    }
    sum
}

const STOREY_MASS: f64 = 2.0e4;
const STOREY_STIFFNESS: f64 = 2.0e6;
const STOREY_STRENGTH: f64 = 1.2e4;
const STOREY_HARDENING: f64 = 0.1;
const MOTION_DURATION: f64 = 3.0;

/// Rates of `[x, v, z]` at time t.
fn storey_rates(t: f64, y: [f64; 3]) -> [f64; 3] {
    let g = ground(t);
    let d = y[0] - g[0];
    let v = y[1] - g[1];
    let force =
        STOREY_HARDENING * STOREY_STIFFNESS * d + (1.0 - STOREY_HARDENING) * STOREY_STRENGTH * y[2];
    let sign = if v * y[2] > 0.0 { 1.0 } else { -1.0 };
    let dy = STOREY_STRENGTH / STOREY_STIFFNESS;
    let z = (1.0 - (0.6 * sign + 0.4) * y[2].abs().powf(1.5)) * v / dy;
    [y[1], -force / STOREY_MASS, z]
}

fn shifted(y: [f64; 3], rates: [f64; 3], h: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| y[i] + h * rates[i])
}

/// Displacement of the floor at the end, by Runge–Kutta integration.
fn integrated_floor_displacement() -> f64 {
    let fine = 300_000_u32;
    let mut y = [0.0; 3];
    let h = MOTION_DURATION / f64::from(fine);
    for step in 0..fine {
        let t = f64::from(step) * h;
        let a = storey_rates(t, y);
        let b = storey_rates(t + 0.5 * h, shifted(y, a, 0.5 * h));
        let c = storey_rates(t + 0.5 * h, shifted(y, b, 0.5 * h));
        let d = storey_rates(t + h, shifted(y, c, h));
        y = [0, 1, 2].map(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    y[0]
}

/// Displacement of the floor at the end, by coupled steps.
fn marched_floor_displacement(steps: u32) -> f64 {
    let law = BoucWen::new(STOREY_STIFFNESS, STOREY_STRENGTH, STOREY_HARDENING).unwrap();
    let law = law.with_shape(1.5, 0.6).unwrap();
    let storey = Storey::new(1e-3, STOREY_MASS, STOREY_STIFFNESS);
    let building = ShearBuilding::new(4.0, 1e3, 1e7, &[storey]).unwrap();
    // Springs stand for rock: the base follows the ground.
    let rock = SpringGround::new(-2.0..2.0, 2, 1e13, 1e13).unwrap();
    let motion = FreeFieldFn::new(|_, t| [ground(t)[0], 0.0]);
    let mut simulation = Simulation::builder(MOTION_DURATION / f64::from(steps))
        .structure(building.with_law(0, law).unwrap())
        .ground(rock)
        .interface(Bonded)
        .motion(motion)
        .build()
        .unwrap();
    simulation.run(steps as usize, |_| {}).unwrap();
    simulation.state().absolute_displacement()[3]
}

/// One storey on rock against m ẍ = −F(x − x_g), ż = …, integrated by Runge–Kutta in fine steps: the
/// coupled run converges to it with the square of the step.
#[test]
fn yielding_storey_converges_to_its_differential_equation() {
    let expected = integrated_floor_displacement();
    let errors =
        [150, 300, 600, 1200, 2400, 4800].map(|steps| marched_floor_displacement(steps) - expected);
    println!("floor at the end {expected:.4} m, errors {errors:?}");
    assert!(errors[5].abs() < 1e-6, "{errors:?}");
    // The mean order over five halvings; single ones depend on where in a step the motion reverses.
    let order = (errors[0] / errors[5]).abs().log2() / 5.0;
    assert!((order - 2.0).abs() < 0.3, "order {order}");
}

/// Isolated by a pendulum with long sliding: the force through the bearings stays within the law.
#[test]
fn bearing_forces_stay_within_their_law() {
    let weight = STANDARD_GRAVITY * 130.0e3;
    let radius = 2.0;
    let friction = 0.06;
    let structure = isolated(FrictionPendulum::new(weight, radius, friction).unwrap());
    let drift = structure.drift(0).unwrap();
    let shear = structure.shear(0).unwrap();
    let mut simulation = on_soil(structure, 0.0025)
        .probe(Probe::displacement("bearing", drift))
        .probe(Probe::section("shear", &shear))
        .build()
        .unwrap();
    let mut previous_drift = 0.0;
    let mut sliding_steps = 0;
    simulation
        .run(3000, |state| {
            let bearing = state.probes[0];
            let force = state.probes[1];
            let mean_drift = 0.5 * (previous_drift + bearing);
            let friction_part = force - weight / radius * mean_drift;
            assert!(friction_part.abs() < friction * weight * (1.0 + 1e-6), "{friction_part}");
            if friction_part.abs() > 0.999 * friction * weight {
                sliding_steps += 1;
            }
            previous_drift = bearing;
        })
        .unwrap();
    assert!(sliding_steps > 100, "slid in {sliding_steps} steps only");
    // The base shear of the building without isolators is more than twice the bearings' friction.
    let mut base_shear = on_soil(five_storeys(), 0.0025).build().unwrap();
    let base_shear = base_shear.run(3000, |_| {}).unwrap().whole.base_shear.magnitude();
    assert!(base_shear > 2.0 * friction * weight, "{base_shear}");
}

#[test]
fn resumed_runs_have_the_states_of_the_laws() {
    let mut uninterrupted_simulation = on_soil(bouc_wen_storeys(0.03), 0.01).build().unwrap();
    uninterrupted_simulation.run(250, |_| {}).unwrap();
    let checkpoint = uninterrupted_simulation.checkpoint().unwrap();
    assert!(uninterrupted_simulation.state().energy_balance.hysteresis > 0.0);
    uninterrupted_simulation.run(100, |_| {}).unwrap();
    let mut resumed_simulation = on_soil(bouc_wen_storeys(0.03), 0.01).build().unwrap();
    resumed_simulation.resume(&checkpoint).unwrap();
    resumed_simulation.run(100, |_| {}).unwrap();
    assert_eq!(resumed_simulation.state(), uninterrupted_simulation.state());
}

/// Forces vanish in the end, while the offset stays: its last digit times the stiffness is more than 1e-9 of the forces.
#[test]
fn a_building_that_has_yielded_comes_to_rest() {
    let storeys = [Storey::new(3.0, 20.0e3, 40.0e6); 3];
    let building = ShearBuilding::new(8.0, 50.0e3, 4.0e5, &storeys)
        .and_then(|building| building.with_stiffness_damping(0.1))
        .and_then(|building| building.with_law(0, Bilinear::new(40.0e6, 1.0e5, 0.0)?))
        .unwrap();
    let ground = SpringGround::under(&building, 4, 1.0e9, 1.0e9).unwrap();
    let drift = Probe::displacement("drift", building.drift(0).unwrap());
    let mut simulation = Simulation::builder(0.01)
        .structure(building)
        .ground(ground.with_dashpots(5.0e6, 5.0e6).unwrap())
        .interface(Bonded)
        .probe(drift)
        .initial_velocity(vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
        .build()
        .unwrap();
    let run = simulation.run(3000, |_| ()).unwrap();
    assert!(run.whole.base_shear.largest().value.abs() > 1.0e5);
    let state = simulation.state();
    assert!(state.probes[0].abs() > 2.0e-3, "offset {}", state.probes[0]);
    assert!(state.base_shear.abs() < 1.0e-6, "shear {}", state.base_shear);
}
