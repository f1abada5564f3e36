//! Warnings of time steps and elements that miss what structure and ground do.

use std::f64::consts::PI;

use basemat::bem::{ElasticGround, Grading, Ground, Strip};
use basemat::coupled::{Mistake, Warning};
use basemat::motion::{FreeFieldFn, RickerDisplacement, TravellingWave};
use basemat::prelude::*;
use basemat::results::{ElementEnvelope, Run};
use basemat::soil::SoilProfile;

/// Largest base shear of the three storeys under El Centro with steps of 1 ms, N/m.
const THREE_STOREYS: f64 = 703.6e3;
/// Root-mean-square frequency of El Centro's acceleration, Hz.
const EL_CENTRO: f64 = 3.65;
/// Period of the slender block in rocking on its soil, from the same run at 1 ms, s.
const SLENDER: f64 = 0.85;

fn soil(speed: f64) -> Soil {
    Soil::from_shear_wave_speed(speed, 0.33, 1900.0).unwrap()
}

fn storeys() -> ShearBuilding {
    let storeys = [Storey::new(3.0, 30e3, 60e6); 3];
    let building = ShearBuilding::new(8.0, 60e3, 4e5, &storeys).unwrap();
    building.with_stiffness_damping(0.05).unwrap()
}

/// Ten seconds of a bonded structure; its warnings are on its page.
fn run(
    structure: impl Structure + 'static,
    motion: impl FreeField + 'static,
    soil: Soil,
    elements: usize,
    time_step: f64,
) -> Run {
    let mut simulation = Simulation::builder(time_step)
        .ground(
            ElasticGround::new(soil, Strip::under(&structure, elements, Grading::Uniform).unwrap())
                .unwrap(),
        )
        .structure(structure)
        .motion(motion)
        .interface(Bonded)
        .build()
        .unwrap();
    let steps = simulation.steps_for(10.0);
    let mut run = simulation.run(steps, |_| {}).unwrap();
    for warning in &run.warnings {
        let line = format!("warning: {warning}");
        assert!(run.to_string().contains(&line));
        assert!(line.chars().count() <= 100, "{line}");
    }
    // These bonded bases are pulled up; here is looked at resolution.
    run.warnings.retain(|warning| !matches!(warning, Warning::Tension { .. }));
    run
}

fn ricker(frequency: f64) -> RickerDisplacement {
    RickerDisplacement::new(0.05, 1.0 / (PI * frequency), 2.0).unwrap()
}

/// The frequency is the record's, though none of these steps resolves it; a run with the recommended step is right.
#[test]
fn steps_that_miss_the_record() {
    let shake = |step| run(storeys(), el_centro_1940(), soil(250.0), 12, step);
    for time_step in [0.1, 0.2, 0.5, 1.0] {
        let run = shake(time_step);
        let error = (run.whole.base_shear.magnitude() / THREE_STOREYS - 1.0).abs();
        assert!(error > 0.15, "Δt = {time_step}: {error}");
        let [Warning::UnresolvedMotion { frequency, time_step: told, needed, .. }] =
            run.warnings[..]
        else {
            panic!("Δt = {time_step}: {:?}", run.warnings)
        };
        assert!((frequency / EL_CENTRO - 1.0).abs() < 0.05, "{frequency}");
        assert_eq!(told, time_step);
        let resolved = shake(needed);
        let error = (resolved.whole.base_shear.magnitude() / THREE_STOREYS - 1.0).abs();
        assert!(error < 0.06, "Δt = {needed}: {error}");
        assert_eq!(resolved.warnings, []);
    }
}

/// A pulse of 1 Hz is resolved by ten steps a second, the rocking that it leaves behind is not.
#[test]
fn steps_that_miss_the_structure() {
    let block = || RigidBlock::new(10.0, 25.0, 2000.0).unwrap();
    let shake = |step| run(block(), ricker(1.0), soil(200.0), 12, step);
    let fine = shake(2.5e-3);
    assert_eq!(fine.warnings, []);
    let coarse = shake(0.1);
    assert!(coarse.whole.base_shear.magnitude() < 0.75 * fine.whole.base_shear.magnitude());
    let [Warning::UnresolvedPeriod { period, time_step: 0.1, needed, .. }] = coarse.warnings[..]
    else {
        panic!("{:?}", coarse.warnings)
    };
    assert!((period / SLENDER - 1.0).abs() < 0.2, "{period}");
    let resolved = shake(needed);
    let error = resolved.whole.base_shear.magnitude() / fine.whole.base_shear.magnitude() - 1.0;
    assert!(error.abs() < 0.1, "{error}");
    assert_eq!(resolved.warnings, []);
}

/// After its motion a ground drifts at most, through zero after El Centro: differences of its displacement are
/// rounding, and tell no step.
#[test]
fn rest_after_the_motion() {
    let samples = (0..=100).map(|k| f64::sin(f64::from(k))).collect();
    for motion in [Record::new(0.02, samples).unwrap(), el_centro_1940()] {
        let block = RigidBlock::new(6.0, 9.0, 1000.0).unwrap();
        let duration = motion.duration();
        let mut simulation = Simulation::builder(0.01)
            .ground(ElasticGround::under(soil(200.0), &block, 8).unwrap())
            .structure(block)
            .motion(motion)
            .interface(Coulomb::new(0.5).unwrap())
            .build()
            .unwrap();
        let steps = simulation.steps_for(duration);
        simulation.run(steps, |_| {}).unwrap();
        let rest = simulation.run(steps, |_| {}).unwrap();
        assert!(rest.whole.base_shear.magnitude() > 1e-6 * rest.whole.static_normal_force);
        assert!(rest.warnings.is_empty(), "{:?}", rest.warnings);
    }
}

/// A squat block on stiff soil vibrates far too fast for the step, and follows the ground.
#[test]
fn stiff_structures_need_no_fine_steps() {
    let shake = |step| {
        let block = RigidBlock::new(10.0, 5.0, 2000.0).unwrap();
        run(block, ricker(1.0), soil(1500.0), 8, step)
    };
    let (fine, coarse) = (shake(2e-3), shake(0.08));
    let error = coarse.whole.base_shear.magnitude() / fine.whole.base_shear.magnitude() - 1.0;
    assert!(error.abs() < 0.06, "{error}");
    assert_eq!(coarse.warnings, []);
}

/// A run recorded by single steps is judged by the motion at these steps.
#[test]
fn recorded_by_hand() {
    let structure = storeys();
    let mut simulation = Simulation::builder(0.5)
        .ground(
            ElasticGround::new(
                soil(250.0),
                Strip::under(&structure, 12, Grading::Uniform).unwrap(),
            )
            .unwrap(),
        )
        .structure(structure)
        .motion(el_centro_1940())
        .interface(Bonded)
        .build()
        .unwrap();
    let mut run = simulation.begin_run();
    for _ in 0..20 {
        run.record(simulation.step().unwrap());
    }
    let warnings = simulation.end_run(run).warnings;
    assert!(matches!(warnings[..], [Warning::UnresolvedMotion { .. }]), "{warnings:?}");
}

/// A bonded base under weight that is pulled up says so, with the numbers of its envelope.
#[test]
fn bonded_bases_that_are_pulled_up() {
    let shake = |law: Box<dyn InterfaceLaw>, scale: f64, gravity: f64| {
        let block = RigidBlock::new(10.0, 25.0, 2000.0).unwrap();
        let mut simulation = Simulation::builder(0.01)
            .ground(ElasticGround::under(soil(200.0), &block, 12).unwrap())
            .structure(block)
            .motion(el_centro_1940().scaled(scale).unwrap())
            .interface(law)
            .gravity(gravity)
            .build()
            .unwrap();
        simulation.run(600, |_| {}).unwrap()
    };
    let warns = |run: &Run| {
        run.warnings.iter().find_map(|warning| match warning {
            Warning::Tension { tension, x, time, .. } => Some([*tension, *x, *time]),
            _ => None,
        })
    };
    let run = shake(Box::new(Bonded), 1.0, 9.81);
    let lowest = |element: &ElementEnvelope| element.pressure.lowest.value;
    let pulled = run.envelope.iter().min_by(|a, b| lowest(a).total_cmp(&lowest(b))).unwrap();
    let middle = pulled.element.center()[0];
    assert_eq!(warns(&run), Some([-lowest(pulled), middle, pulled.pressure.lowest.time]));
    assert!(lowest(pulled) < -1e4);
    // Neither a weak motion, nor a base that opens, nor one without weight.
    assert_eq!(warns(&shake(Box::new(Bonded), 0.01, 9.81)), None);
    assert_eq!(warns(&shake(Box::new(Coulomb::new(0.5).unwrap()), 1.0, 9.81)), None);
    assert_eq!(warns(&shake(Box::new(Bonded), 1.0, 0.0)), None);
}

/// A base of 8 m on elements that end 2 m within it; one that ends within an element of theirs passes.
#[test]
fn a_base_beyond_the_elements() {
    let found = |half: f64| {
        let elements = Strip::uniform(-half..half, 8).unwrap();
        let mut simulation = Simulation::builder(5e-3)
            .ground(ElasticGround::new(soil(250.0), elements).unwrap())
            .structure(storeys())
            .interface(Bonded)
            .motion(el_centro_1940())
            .build()
            .unwrap();
        let run = simulation.run(200, |_| {}).unwrap();
        run.warnings.into_iter().find(|warning| matches!(warning, Warning::UncoveredBase { .. }))
    };
    let half = 4.0;
    let Some(Warning::UncoveredBase { foundation: 0, reach, axis: None }) = found(0.5 * half)
    else {
        panic!()
    };
    assert!((reach - 0.5 * half).abs() < 1e-12, "{reach}");
    assert_eq!(found(0.9 * half), None);
    assert_eq!(found(half), None);
}

/// Stiffnesses in kN/m and a motion in cm/s² warn, the same numbers in their units do not; nor on a soil that is not
/// to scale itself.
#[test]
fn numbers_in_another_unit() {
    let found = |by_stiffness: f64, by_motion: f64, soil: Soil| {
        let storeys = [Storey::new(3.0, 30e3, 60e6 * by_stiffness); 3];
        let building = ShearBuilding::new(8.0, 60e3, 4e5, &storeys).unwrap();
        let peak = el_centro_1940().peaks().acceleration;
        let motion = el_centro_1940().scaled(by_motion).unwrap();
        let run = run(building, motion, soil, 8, 5e-3);
        let mut seen = [None; 2];
        for warning in &run.warnings {
            match warning {
                Warning::Mistake(Mistake::LongPeriod { period }) => seen[0] = Some(*period),
                Warning::Mistake(Mistake::UnusualMotion { acceleration }) => {
                    seen[1] = Some(acceleration / peak);
                }
                _ => {}
            }
        }
        seen
    };
    assert_eq!(found(1.0, 1.0, soil(250.0)), [None; 2]);
    let [period, motion] = found(1e-3, 100.0, soil(250.0));
    // Equal storeys deflect by 3, 5 and 6 times m g/k under their weight to the side: ω² = 14/70 k/m.
    let exact = 2.0 * PI * (5.0 * 30e3_f64 / 60e3).sqrt();
    assert!((period.unwrap() / exact - 1.0).abs() < 0.02, "{period:?} {exact}");
    assert!((motion.unwrap() / 100.0 - 1.0).abs() < 0.03, "{motion:?}");
    let not_to_scale = Soil::new(1.0, 0.25, 1.0).unwrap();
    assert_eq!(found(1e-3, 100.0, not_to_scale), [None; 2]);
}

/// Rocking on one element meets no stiffness, on two too little of it.
#[test]
fn too_few_elements() {
    let shake = |elements| run(storeys(), el_centro_1940(), soil(250.0), elements, 5e-3);
    let fine = shake(12).whole.base_shear.magnitude();
    for elements in [1, 2, 3] {
        let found = shake(elements).warnings;
        assert_eq!(
            found,
            [Warning::FewElements { foundation: 0, elements, needed: 4, axis: None }]
        );
    }
    assert!(shake(1).whole.base_shear.magnitude() < 0.5 * fine);
    let enough = shake(4);
    assert!((enough.whole.base_shear.magnitude() / fine - 1.0).abs() < 0.05);
    assert_eq!(enough.warnings, []);
}

/// A pulse of 8 Hz that runs along a raft of 40 m with the soil's shear wave speed.
#[test]
fn elements_longer_than_waves() {
    let shake = |elements| {
        let block = RigidBlock::new(40.0, 5.0, 2000.0).unwrap();
        let pulse = FreeFieldFn::new(|_, t| {
            let a = PI * 8.0 * (t - 1.0);
            [1e-3 * (1.0 - 2.0 * a * a) * (-a * a).exp(), 0.0]
        });
        let wave = TravellingWave::new(pulse, 100.0, -20.0).unwrap();
        run(block, wave, soil(100.0), elements, 4e-3)
    };
    let fine = shake(40);
    assert_eq!(fine.warnings, []);
    let coarse = shake(5);
    let error = coarse.whole.base_shear.magnitude() / fine.whole.base_shear.magnitude() - 1.0;
    assert!(error.abs() > 0.1, "{error}");
    let [Warning::LongElements { element_length, wavelength, needed }] = coarse.warnings[..] else {
        panic!("{:?}", coarse.warnings)
    };
    assert!((element_length - 8.0).abs() < 1e-12 && wavelength < 32.0 && needed < 4.0);
}

/// Soils whose numbers are of another unit, and those that only are soft or hard.
#[test]
fn soils_in_other_units() {
    let short = |soil: Soil| {
        let block = RigidBlock::new(4.0, 2.0, 1.0).unwrap();
        let mut simulation = Simulation::builder(1e-3)
            .ground(ElasticGround::under(soil, &block, 4).unwrap())
            .structure(block)
            .interface(Bonded)
            .gravity(0.0)
            .build()
            .unwrap();
        simulation.run(2, |_| {}).unwrap()
    };
    for (modulus, density, slip) in [
        (80.0, 1900.0, "modulus in MPa?"),
        (80e3, 1900.0, "modulus in kPa?"),
        (80e6, 19.0, "density in kN/m³?"),
        (80e6, 1.9, "density in t/m³?"),
        (80.0, 19.0, "density in kN/m³, modulus in MPa?"),
        (80e3, 1.9, "density in t/m³, modulus in kPa?"),
        (80e6, 19_000.0, "density in N/m³?"),
        (1.0, 1.0, "a model not to scale?"),
    ] {
        let soil = Soil::new(modulus, 0.33, density).unwrap();
        let run = short(soil);
        let speed = soil.shear_wave_speed();
        let wanted = Warning::Mistake(Mistake::UnusualSoil { shear_wave_speed: speed, density });
        assert_eq!(run.warnings, [wanted], "{modulus} {density}");
        let line = format!("warning: {wanted}");
        assert!(line.ends_with(slip) && line.chars().count() <= 100, "{line}");
        assert!(run.to_string().contains(&line));
    }
    for (speed, density) in [(10.001, 500.0), (25.0, 1100.0), (4999.0, 10_000.0)] {
        let soil = Soil::from_shear_wave_speed(speed, 0.33, density).unwrap();
        assert_eq!(short(soil).warnings, [], "{speed} {density}");
    }
    // Each layer has a name of its own to answer for.
    let profile = SoilProfile::on_half_plane(soil(800.0)).with_layer(soil(200.0), 4.0).unwrap();
    let thin = Soil::from_shear_wave_speed(150.0, 0.33, 18.0).unwrap();
    let profile = profile.with_layer(thin, 3.0).unwrap();
    let block = RigidBlock::new(4.0, 2.0, 1000.0).unwrap();
    let ground = ElasticGround::under(profile, &block, 2).unwrap();
    assert_eq!(ground.description().soils.len(), 3);
    assert_eq!(ground.description().soils[1], thin);
}
