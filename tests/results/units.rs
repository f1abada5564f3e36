//! Numbers in another unit earn a warning of the run, and usual numbers none; every page states its ground motion.

use basemat::bem::ElasticGround;
use basemat::coupled::{SimulationBuilder, Warning};
use basemat::motion::{AtRest, FreeFieldFn, TravellingWave, VerticalIncidence};
use basemat::prelude::*;
use basemat::results::Run;
use basemat::structure::{MatrixModel, Triplets};

fn soil() -> Soil {
    Soil::from_shear_wave_speed(250.0, 0.33, 1900.0).unwrap()
}

/// Five storeys of this height (m) and mass (kg/m) under a record.
fn building(height: f64, mass: f64) -> ShearBuilding {
    let storeys = [Storey::new(height, mass, 2e3 * mass); 5];
    let building = ShearBuilding::new(10.0, 2.5 * mass, 20.0 * mass, &storeys).unwrap();
    building.with_stiffness_damping(0.05).unwrap()
}

fn scene(
    structure: impl Structure + 'static,
    motion: impl FreeField + 'static,
) -> SimulationBuilder {
    Simulation::builder(0.01)
        .ground(ElasticGround::under(soil(), &structure, 10).unwrap())
        .structure(structure)
        .interface(Coulomb::new(0.5).unwrap())
        .motion(motion)
}

fn run(scene: SimulationBuilder, steps: usize) -> Run {
    let run = scene.build().unwrap().run(steps, |_| {}).unwrap();
    for warning in run.warnings.iter().filter(|own| of_units(own)) {
        let line = format!("warning: {warning}");
        assert!(run.to_string().contains(&line) && line.chars().count() <= 100, "{line}");
    }
    run
}

fn of_units(warning: &Warning) -> bool {
    matches!(warning, Warning::Mistake(_) | Warning::EndsEarly { .. } | Warning::PeakAtEnd { .. })
}

/// The warnings of units, of which there must be one with these words.
#[track_caller]
fn warned(run: &Run, words: &str) {
    let own: Vec<String> =
        run.warnings.iter().filter(|own| of_units(own)).map(ToString::to_string).collect();
    assert!(own.iter().any(|text| text.contains(words)), "{words}: {own:?}");
}

const MASS: f64 = 20e3;
/// Steps of 0.01 s to the end of El Centro.
const WHOLE: usize = 3118;

#[test]
fn usual_numbers_earn_no_warning() {
    let usual = run(scene(building(3.0, MASS), el_centro_1940()), WHOLE);
    assert!(!usual.warnings.iter().any(of_units), "{:?}", usual.warnings);
    let ten_seconds = run(scene(building(3.0, MASS), el_centro_1940()), 1000);
    assert!(!ten_seconds.warnings.iter().any(of_units), "{:?}", ten_seconds.warnings);
    let rest = run(scene(building(3.0, MASS), AtRest), 20);
    assert!(!rest.warnings.iter().any(of_units), "{:?}", rest.warnings);
}

#[test]
fn a_record_in_another_unit_is_told() {
    let record = el_centro_1940();
    let in_g = record.scaled(1.0 / STANDARD_GRAVITY).unwrap();
    warned(&run(scene(building(3.0, MASS), in_g), WHOLE), "0.319 m/s²: motion in g?");
    let to_peak = record.scaled_to_peak(0.3).unwrap();
    let both = VerticalIncidence { horizontal: Some(to_peak.clone()), vertical: Some(to_peak) };
    warned(&run(scene(building(3.0, MASS), both), WHOLE), "0.300 m/s²: motion in g?");
    let in_gal = record.scaled(100.0).unwrap();
    warned(&run(scene(building(3.0, MASS), in_gal), 300), "motion in cm/s²?");
    // 20 ms, and 20 µs.
    for (step, words) in [(20.0, "steps of 2.00e1 s"), (2e-5, "steps of 2.00e-5 s")] {
        let other = Record::new(step, record.accelerations().to_vec()).unwrap();
        warned(&run(scene(building(3.0, MASS), other), 300), words);
    }
}

#[test]
fn numbers_of_a_structure_in_another_unit_are_told() {
    let in_tonnes = scene(building(3.0, 1e-3 * MASS), el_centro_1940());
    warned(&run(in_tonnes, WHOLE), "masses in t");
    let in_gal = scene(building(3.0, MASS), el_centro_1940()).gravity(981.0);
    warned(&run(in_gal, WHOLE), "gravity of 981 m/s²");
    for friction in [30.0, 50.0] {
        let law = Coulomb::new(friction).unwrap();
        let degrees = scene(building(3.0, MASS), el_centro_1940()).interface(law);
        warned(&run(degrees, WHOLE), &format!("friction coefficient of {friction}: in degrees"));
    }
}

#[test]
fn the_end_of_a_run_is_told() {
    // 5 s have half of the intensity.
    let early = run(scene(building(3.0, MASS), el_centro_1940()), 500);
    warned(&early, "run ends at 5.00 s, its record at 31.18 s: 51 % of the record's intensity");
    // A ground that moves ever faster.
    let ramp = FreeFieldFn::new(|_, time| [0.05 * time.powi(3), 0.0]);
    warned(&run(scene(building(3.0, MASS), ramp), 100), "largest in the last step, at 1.00 s");
}

#[test]
fn every_page_states_its_motion() {
    let page = |scene| run(scene, 20).to_string();
    let built = || building(3.0, MASS);
    let record = page(scene(built(), el_centro_1940()));
    assert!(
        record.starts_with("Run of 20 steps of 0.01 s from t = 0.000 s to 0.200 s\n"),
        "{record}"
    );
    let line = record.lines().nth(1).unwrap();
    for words in ["peak 3.12", " m/s² (0.318", " g), record of 31.18 s in steps of 0.02 s"] {
        assert!(line.contains(words), "{line}");
    }
    let none = page(scene(built(), AtRest));
    assert_eq!(none.lines().nth(1), Some("Ground motion: none"));
    let fast = page(scene(built(), FreeFieldFn::new(|_, time| [1.5 * time * time, 0.0])));
    let line = fast.lines().nth(1).unwrap();
    assert!(
        line.contains("peak 3") && line.ends_with("at the steps of the run, no record"),
        "{line}"
    );
    let travelling = TravellingWave::new(el_centro_1940(), 500.0, -5.0).unwrap();
    assert!(page(scene(built(), travelling)).contains("record of 31.18 s in steps of 0.02 s"));
}

/// A block on its base that slides, with damping of its mass and without.
#[test]
fn damping_that_brakes_a_sliding_block_is_told() {
    let block = RigidBlock::new(6.0, 2.0, 2000.0).unwrap();
    let slid = |damping: f64| {
        let [mut mass, mut drag] = [(); 2].map(|()| Triplets::new(3));
        block.mass(&mut mass).unwrap();
        block.mass(&mut drag).unwrap();
        let scaled = drag.entries().iter().map(|&(i, j, value)| (i, j, damping * value));
        let drag = Triplets::from_entries(3, scaled);
        let model = MatrixModel::new(mass, Triplets::new(3), block.base()).unwrap();
        let mut simulation = Simulation::builder(0.005)
            .ground(ElasticGround::under(soil(), &model, 8).unwrap())
            .structure(model.with_damping(drag).unwrap())
            .interface(Coulomb::new(0.1).unwrap())
            .initial_velocity(vec![1.5, 0.0, 0.0])
            .gravity_stage(basemat::coupled::GravityStage::Frictional)
            .build()
            .unwrap();
        let run = simulation.run(400, |_| {}).unwrap();
        let told = run.warnings.iter().find_map(|warning| match warning {
            Warning::DampedSliding { rate, loss } => Some((*rate, *loss)),
            _ => None,
        });
        (run.whole.residual_slip, told)
    };
    let (free, none) = slid(0.0);
    // v²/2μg.
    assert!((free / (1.5 * 1.5 / (0.2 * STANDARD_GRAVITY)) - 1.0).abs() < 0.05, "{free}");
    assert_eq!(none, None);
    let (braked, told) = slid(0.5);
    let (rate, loss) = told.unwrap();
    assert!((rate - 0.5).abs() < 1e-9);
    assert!((loss - (1.0 - braked / free)).abs() < 0.05, "{loss} {braked} {free}");
    // A hundredth of that brakes by half a per cent; rounding does not brake.
    for damping in [0.005, 1e-9, 1e-12, 1e-14, 1e-16] {
        assert_eq!(slid(damping).1, None, "{damping}");
    }
}
