//! GOAL: the energy balance closes in every kind of run, and only if every term is right.
//! SCENE: kinds of law, scheme, damping, structure and ground; stiff structures that
//! travel far.
//! REFERENCE: the identity of the energies; perturbing any term must open it.

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::coupled::{
    DissipativeMidpoint, EnergyBalance, Load, Newmark, SimulationBuilder, Theta,
};
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::{Bonded, ThinLayer, UnilateralCondition};
use basemat::motion::AtRest;
use basemat::results::Run;
use basemat::structure::{
    Bilinear, FemModel, RayleighDamping, RigidBlock, ShearBuilding, Storey, WithSprings,
};

use basemat_problems::scenes::{Rider, SI, block, friction, scene, shake, soil, tower};

fn run(builder: SimulationBuilder, steps: usize) -> Run {
    builder.build().unwrap().run(steps, |_| {}).unwrap()
}

/// One run of each kind, by name.
fn kinds() -> Vec<(&'static str, Run)> {
    let damped = || tower(SI, Some(RayleighDamping::from_ratios([2.0, 20.0], [0.05; 2]).unwrap()));
    let rate = friction(0.4)
        .with_unilateral_condition(UnilateralCondition::Velocity { closed_below: 1e-9 })
        .unwrap();
    let theta = Theta::new(0.6).unwrap();
    let base = || scene(SI, 0.6);
    let layer = ThinLayer::new(soil(SI), 1.0, 0.3).unwrap();
    let damping = DissipativeMidpoint::default();
    let yielding = || {
        let storeys = [Storey::new(3.0, 15e3, 25e6); 3];
        let building = ShearBuilding::new(4.0, 3e4, 8e4, &storeys).unwrap();
        let drift = building.drift(0).unwrap();
        let law = Bilinear::new(1e7, 2e4, 0.1).unwrap();
        WithSprings::new(building).spring(drift, law).unwrap()
    };
    vec![
        (
            "dissipative",
            run(base().structure(damped()).interface(friction(0.4)).scheme(damping), 300),
        ),
        (
            "dissipative, thin layer",
            run(base().structure(tower(SI, None)).interface(layer).scheme(damping), 300),
        ),
        (
            "dissipative, nonlinear",
            run(
                base()
                    .structure(Rider { block: block(SI) })
                    .interface(friction(0.4))
                    .scheme(damping),
                400,
            ),
        ),
        (
            "dissipative, yielding, thin layer",
            run(base().structure(yielding()).interface(layer).scheme(damping), 400),
        ),
        ("dissipative, loaded", {
            let push = Load::new(block(SI).horizontal_at(6.0), |t: f64| 8e4 * (30.0 * t).sin());
            let builder = base().structure(block(SI)).interface(friction(0.4)).load(push);
            run(builder.scheme(damping), 400)
        }),
        ("bonded", run(base().structure(tower(SI, None)).interface(Bonded), 300)),
        ("uplift", run(base().structure(block(SI)).interface(friction(f64::INFINITY)), 400)),
        ("sliding", run(base().structure(block(SI)).interface(friction(0.2)), 400)),
        ("flexible, sliding", run(base().structure(tower(SI, None)).interface(friction(0.3)), 300)),
        ("θ", run(base().structure(tower(SI, None)).interface(friction(0.4)).scheme(theta), 300)),
        ("Rayleigh damping", run(base().structure(damped()).interface(friction(0.4)), 300)),
        (
            "θ and Rayleigh damping, bonded",
            run(base().structure(damped()).interface(Bonded).scheme(theta), 300),
        ),
        ("thin layer", run(base().structure(block(SI)).interface(layer), 400)),
        (
            "thin layer, Newmark",
            run(base().structure(tower(SI, None)).interface(layer).scheme(Newmark::default()), 300),
        ),
        ("rate", run(base().structure(block(SI)).interface(rate), 400)),
        (
            "nonlinear",
            run(base().structure(Rider { block: block(SI) }).interface(friction(0.4)), 400),
        ),
        ("yielding damper", run(base().structure(yielding()).interface(friction(0.4)), 400)),
        ("spring bed", {
            let bed = SpringGround::new(-2.0..2.0, 8, 5e7, 4e7).unwrap();
            let bed = bed.with_dashpots(4e5, 3e5).unwrap();
            run(base().ground(bed).structure(block(SI)).interface(friction(0.4)), 400)
        }),
    ]
}

/// The terms of an energy balance, its left-hand side first.
fn terms(energy_balance: &mut EnergyBalance) -> [(&'static str, &mut f64); 10] {
    [
        ("kinetic", &mut energy_balance.kinetic),
        ("strain", &mut energy_balance.strain),
        ("hysteresis", &mut energy_balance.hysteresis),
        ("damping", &mut energy_balance.damping),
        ("algorithmic", &mut energy_balance.algorithmic),
        ("soil", &mut energy_balance.soil),
        ("contact", &mut energy_balance.contact),
        ("interface", &mut energy_balance.interface),
        ("static_contact", &mut energy_balance.static_contact),
        ("input", &mut energy_balance.input),
    ]
}

#[test]
fn energy_balance_closes_and_every_term_counts() {
    let mut seen = [false; 10];
    for (name, run) in kinds() {
        let residual = run.energy_balance.residual();
        println!("{name}: largest {:.1e}, end {residual:.1e}", run.energy_error);
        assert!(run.energy_error < 1e-10, "{name}: {:e}", run.energy_error);
        for k in 0..10 {
            let mut energy_balance = run.energy_balance;
            let (term, value) = terms(&mut energy_balance).into_iter().nth(k).unwrap();
            let size = value.abs();
            *value *= 1.0 + 1e-3;
            // Residuals are relative to the largest energy of the run.
            let share = size / energy_balance.largest;
            // Terms that matter open the residual when they are off by one in a thousand.
            if share > 1e-4 {
                seen[k] = true;
                let opened = energy_balance.residual();
                assert!(opened > 0.5e-3 * share, "{name}: {term} may be off, {opened:e}");
            }
        }
    }
    assert_eq!(seen, [true; 10], "a term was never put to the test");
}

/// A stiff structure that moves far with the ground: K u and ½ u·K u belong to a deformation of micrometres on a
/// displacement of decimetres. Rounding of that displacement opens the energy balance in proportion to the stiffness,
/// most while the motion is still weak, and no more than that.
#[test]
fn large_displacements_of_the_ground_open_the_energy_balance_by_rounding_only() {
    for (modulus, strength) in [(2e8, 1.0), (2e10, 1.0), (2e10, 10.0), (2e12, 10.0)] {
        let material = Material::new(modulus, 0.2, 1500.0).unwrap();
        let mesh = Mesh::layered_block(-2.0..2.0, 6, &[Layer::new(6.0, 6, material)]).unwrap();
        let model = FemModel::on_base(mesh).unwrap();
        let bonded = scene(SI, strength).motion(shake(SI, strength)).interface(Bonded);
        let run = run(bonded.structure(model), 300);
        let (largest, end) = (run.energy_error, run.energy_balance.residual());
        println!("E = {modulus:e}, strength {strength}: {largest:.1e}, at the end {end:.1e}");
        assert!(largest < 1e-21 * modulus, "E = {modulus:e}, strength {strength}: {largest:e}");
        assert!(end < 3e-22 * modulus, "E = {modulus:e}, strength {strength}: {end:e}");
    }
}

/// At rest only rounding is booked, and an interface that yields holds its weight.
#[test]
fn rest_closes_the_energy_balance() {
    let layer = ThinLayer::new(soil(SI), 1.0, 0.3).unwrap();
    let builder = scene(SI, 0.0).motion(AtRest).structure(block(SI)).interface(layer);
    let run = run(builder, 400);
    assert!(run.energy_balance.kinetic < 1e-25, "{}", run.energy_balance);
    assert!(run.energy_error < 1e-14 && run.warnings.is_empty(), "{}", run.energy_error);
}

/// Residuals are relative to the largest energy so far: they do not rise when energies decay, and a
/// structure that the ground leaves behind is measured by the ground's motion.
#[test]
fn residuals_are_relative_to_the_largest_energy_so_far() {
    let builder = scene(SI, 0.6).structure(tower(SI, None)).interface(friction(0.3));
    let mut simulation = builder.build().unwrap();
    let mut largest = 0.0_f64;
    for _ in 0..600 {
        let mut energy_balance = simulation.step().unwrap().energy_balance;
        for (_, value) in terms(&mut energy_balance) {
            largest = largest.max(value.abs());
        }
        assert!(energy_balance.largest >= largest && energy_balance.residual() < 1e-12);
        let open = 1e-3 * energy_balance.largest;
        energy_balance.input += open;
        assert!((energy_balance.residual() / 1e-3 - 1.0).abs() < 2e-3);
    }
    assert!(largest > 0.0);
    // Without friction the ground's horizontal motion passes below.
    let smooth = scene(SI, 0.0).motion(basemat::motion::el_centro_1940());
    let mut simulation = smooth.structure(block(SI)).interface(friction(0.0)).build().unwrap();
    let mass = block(SI).total_mass();
    let (mut before, mut fastest) = ([0.0; 2], 0.0_f64);
    for _ in 0..400 {
        let state = simulation.step().unwrap();
        let [dx, dy] = [0, 1].map(|k| (state.free_field[k] - before[k]) / 2.5e-3);
        before = state.free_field;
        fastest = fastest.max(0.5 * mass * (dx * dx + dy * dy));
        assert!(
            (state.energy_balance.largest / fastest - 1.0).abs() < 1e-9,
            "{}",
            state.energy_balance
        );
    }
}

/// Without its energy balance a run goes the same way, and claims nothing of its energies.
#[test]
fn a_energy_balance_that_is_left_out_changes_nothing_else() {
    let builder = || scene(SI, 0.6).structure(tower(SI, None)).interface(friction(0.3));
    let mut with = builder().build().unwrap();
    let mut without = builder().without_energy_balance().build().unwrap();
    let (kept, left_out) = (with.run(200, |_| {}).unwrap(), without.run(200, |_| {}).unwrap());
    assert!(kept.energy_error < 1e-9);
    assert!(left_out.energy_error.is_nan() && left_out.energy_balance.soil.is_nan());
    assert!(left_out.to_string().contains("energy balance left out"));
    assert_eq!(left_out.warnings, kept.warnings);
    let (a, b) = (with.state(), without.state());
    assert_eq!((&a.contact, &a.probes), (&b.contact, &b.probes));
    assert_eq!(a.displacement(), b.displacement());
    // A checkpoint contains whether there is an energy balance.
    assert!(with.resume(&without.checkpoint().unwrap()).is_err());
    let saved = without.checkpoint().unwrap();
    let mut other = builder().without_energy_balance().build().unwrap();
    other.resume(&saved).unwrap();
    assert!(other.step().unwrap().energy_balance.residual().is_nan());
}

/// Absolute and relative input energy differ by the kinetic energies that go with them (Uang and
/// Bertero 1990, eq. 12), so they agree once the ground has come to rest, and not before.
#[test]
fn relative_input_meets_the_absolute_one_when_the_ground_rests() {
    let of = |steps: usize| {
        let builder = scene(SI, 0.6).structure(tower(SI, None)).interface(Bonded);
        run(builder.gravity(0.0), steps).energy_balance
    };
    let (shaking, at_rest) = (of(130), of(600));
    assert!((shaking.relative_input / shaking.input - 1.0).abs() > 0.2);
    assert!((at_rest.relative_input / at_rest.input - 1.0).abs() < 2e-3);
}

/// GOAL: Newmark's method treats a step's tractions as tractions at its end; on springs with tractions at mid-step it
/// feeds the structure as a dashpot of ratio −ωΔt/4 would, on springs that act at the end it keeps the energy. SCENE: a
/// block that bounces on springs without dashpots. REFERENCE: the oscillator's energy e^(ω²Δt t/2), and the midpoint
/// rule's.
#[test]
fn newmark_on_springs_needs_theta_one() {
    let (width, height, density, stiffness, time_step) = (4.0, 4.0, 2000.0, 5.0e7, 5.0e-4);
    let bounce = |newmark: bool, theta: f64| {
        let block = RigidBlock::new(width, height, density).unwrap();
        let ground = SpringGround::under(&block, 4, stiffness, stiffness).unwrap();
        let mut builder = Simulation::builder(time_step)
            .ground(ground.with_theta(theta).unwrap())
            .structure(block)
            .interface(Bonded)
            .gravity(0.0)
            .initial_velocity([0.0, 0.01, 0.0]);
        if newmark {
            builder = builder.scheme(Newmark::default());
        }
        run(builder, 2000)
    };
    let fed = bounce(true, 0.5);
    let squared_frequency = stiffness / (density * height);
    let wanted = (squared_frequency * time_step * fed.end / 2.0).exp();
    let energy =
        (fed.energy_balance.input - fed.energy_balance.algorithmic) / fed.energy_balance.input;
    assert!((energy.ln() / wanted.ln() - 1.0).abs() < 0.02, "{energy} {wanted}");
    let kinetic = [bounce(false, 0.5), bounce(true, 1.0)].map(|run| run.energy_balance.kinetic);
    assert!((kinetic[0] / kinetic[1] - 1.0).abs() < 1e-9, "{kinetic:?}");
}
