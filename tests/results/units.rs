//! GOAL: numbers in another unit cause a warning of the run, and usual numbers none; every page states its ground motion.

use basemat::bem::ElasticGround;
use basemat::coupled::{Mistake, SimulationBuilder, Warning};
use basemat::motion::{AtRest, FreeFieldFn, TravellingWave, VerticalIncidence};
use basemat::prelude::*;
use basemat::results::Run;
use basemat::soil::SoilProfile;
use basemat::structure::{MatrixModel, Triplets};

use super::resolution::bonded_run;

fn soil(speed: f64) -> Soil {
    Soil::from_shear_wave_speed(speed, 0.33, 1900.0).unwrap()
}

/// Five storeys of this height (m) and mass (kg/m).
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
        .ground(ElasticGround::under(soil(250.0), &structure, 10).unwrap())
        .structure(structure)
        .interface(Coulomb::new(0.5).unwrap())
        .motion(motion)
}

fn run(scene: SimulationBuilder, steps: usize) -> Run {
    let run = scene.build().unwrap().run(steps, |_| {}).unwrap();
    for warning in run.warnings.iter().filter(|warning| is_of_units(warning)) {
        let line = format!("warning: {warning}");
        assert!(run.to_string().contains(&line) && line.chars().count() <= 100, "{line}");
    }
    run
}

fn is_of_units(warning: &Warning) -> bool {
    matches!(warning, Warning::Mistake(_) | Warning::EndsEarly { .. } | Warning::PeakAtEnd { .. })
}

/// Asserts a warning of units with these words.
#[track_caller]
fn assert_warning(run: &Run, words: &str) {
    let mut texts =
        run.warnings.iter().filter(|warning| is_of_units(warning)).map(ToString::to_string);
    assert!(texts.any(|text| text.contains(words)), "{words}: {:?}", run.warnings);
}

/// Mass of a storey, kg/m.
const FLOOR_MASS: f64 = 20e3;
/// Steps of 0.01 s to the end of El Centro.
const EL_CENTRO_STEPS: usize = 3118;

#[test]
fn usual_numbers_cause_no_warning() {
    let usual_run = run(scene(building(3.0, FLOOR_MASS), el_centro_1940()), EL_CENTRO_STEPS);
    assert!(!usual_run.warnings.iter().any(is_of_units), "{:?}", usual_run.warnings);
    let ten_seconds = run(scene(building(3.0, FLOOR_MASS), el_centro_1940()), 1000);
    assert!(!ten_seconds.warnings.iter().any(is_of_units), "{:?}", ten_seconds.warnings);
    let rest = run(scene(building(3.0, FLOOR_MASS), AtRest), 20);
    assert!(!rest.warnings.iter().any(is_of_units), "{:?}", rest.warnings);
}

#[test]
fn a_record_in_another_unit_causes_a_warning() {
    let record = el_centro_1940();
    let in_g = record.scaled(1.0 / STANDARD_GRAVITY).unwrap();
    assert_warning(
        &run(scene(building(3.0, FLOOR_MASS), in_g), EL_CENTRO_STEPS),
        "0.319 m/s²: motion in g?",
    );
    let to_peak = record.scaled_to_peak(0.3).unwrap();
    let motion_in_two_directions =
        VerticalIncidence { horizontal: Some(to_peak.clone()), vertical: Some(to_peak) };
    assert_warning(
        &run(scene(building(3.0, FLOOR_MASS), motion_in_two_directions), EL_CENTRO_STEPS),
        "0.300 m/s²: motion in g?",
    );
    let in_gal = record.scaled(100.0).unwrap();
    assert_warning(&run(scene(building(3.0, FLOOR_MASS), in_gal), 300), "motion in cm/s²?");
    // The steps of 20 ms are given in milliseconds, and divided by a thousand.
    for (step, words) in [(20.0, "steps of 2.00e1 s"), (2e-5, "steps of 2.00e-5 s")] {
        let wrong_record = Record::new(step, record.accelerations().to_vec()).unwrap();
        assert_warning(&run(scene(building(3.0, FLOOR_MASS), wrong_record), 300), words);
    }
}

#[test]
fn numbers_of_a_structure_in_another_unit_cause_a_warning() {
    let in_tonnes = scene(building(3.0, 1e-3 * FLOOR_MASS), el_centro_1940());
    assert_warning(&run(in_tonnes, EL_CENTRO_STEPS), "masses in t");
    let in_gal = scene(building(3.0, FLOOR_MASS), el_centro_1940()).gravity(981.0);
    assert_warning(&run(in_gal, EL_CENTRO_STEPS), "gravity of 981 m/s²");
    for friction in [30.0, 50.0] {
        let law = Coulomb::new(friction).unwrap();
        let degrees = scene(building(3.0, FLOOR_MASS), el_centro_1940()).interface(law);
        assert_warning(
            &run(degrees, EL_CENTRO_STEPS),
            &format!("friction coefficient of {friction}: in degrees"),
        );
    }
}

#[test]
fn a_run_that_ends_early_causes_a_warning() {
    // 5 s have half of the intensity.
    let run_to_the_middle = run(scene(building(3.0, FLOOR_MASS), el_centro_1940()), 500);
    assert_warning(
        &run_to_the_middle,
        "run ends at 5.00 s, its record at 31.18 s: 51 % of the record's intensity",
    );
    // A ground that moves ever faster.
    let ramp = FreeFieldFn::new(|_, time| [0.05 * time.powi(3), 0.0]);
    assert_warning(
        &run(scene(building(3.0, FLOOR_MASS), ramp), 100),
        "largest in the last step, at 1.00 s",
    );
}

/// The page of a run of 20 steps of the building.
fn page(motion: impl FreeField + 'static) -> String {
    run(scene(building(3.0, FLOOR_MASS), motion), 20).to_string()
}

#[test]
fn every_page_states_its_motion() {
    let record = page(el_centro_1940());
    assert!(
        record.starts_with("Run of 20 steps of 0.01 s from t = 0.000 s to 0.200 s\n"),
        "{record}"
    );
    let line = record.lines().nth(1).unwrap();
    for words in ["peak 3.12", " m/s² (0.318", " g), record of 31.18 s in steps of 0.02 s"] {
        assert!(line.contains(words), "{line}");
    }
    let page_at_rest = page(AtRest);
    assert_eq!(page_at_rest.lines().nth(1), Some("Ground motion: none"));
    let page_of_fast_ground = page(FreeFieldFn::new(|_, time| [1.5 * time * time, 0.0]));
    let line = page_of_fast_ground.lines().nth(1).unwrap();
    assert!(
        line.contains("peak 3") && line.ends_with("at the steps of the run, no record"),
        "{line}"
    );
    let travelling = TravellingWave::new(el_centro_1940(), 500.0, -5.0).unwrap();
    assert!(page(travelling).contains("record of 31.18 s in steps of 0.02 s"));
}

/// Slip and warning of a sliding block with damping.
struct BrakedBlock {
    residual_slip: f64,
    /// Rate of damping (1/s) and lost part of the slip of the warning.
    warning: Option<(f64, f64)>,
}

/// Lets a block slide on its base with a damping of its mass (1/s).
fn slide_with_damping(damping: f64) -> BrakedBlock {
    let block = RigidBlock::new(6.0, 2.0, 2000.0).unwrap();
    let mut mass = Triplets::new(3);
    block.mass(&mut mass).unwrap();
    let mass_damping = mass.entries().iter().map(|&(i, j, value)| (i, j, damping * value));
    let drag = Triplets::from_entries(3, mass_damping);
    let model = MatrixModel::new(mass, Triplets::new(3), block.base()).unwrap();
    let mut simulation = Simulation::builder(0.005)
        .ground(ElasticGround::under(soil(250.0), &model, 8).unwrap())
        .structure(model.with_damping(drag).unwrap())
        .interface(Coulomb::new(0.1).unwrap())
        .initial_velocity(vec![1.5, 0.0, 0.0])
        .gravity_stage(basemat::coupled::GravityStage::Frictional)
        .build()
        .unwrap();
    let run = simulation.run(400, |_| {}).unwrap();
    let warning = run.warnings.iter().find_map(|warning| match warning {
        Warning::DampedSliding { rate, loss } => Some((*rate, *loss)),
        _ => None,
    });
    BrakedBlock { residual_slip: run.whole.residual_slip, warning }
}

/// A block on its base that slides, with damping of its mass and without.
#[test]
fn damping_that_brakes_a_sliding_block_causes_a_warning() {
    let free = slide_with_damping(0.0);
    let free_slip = free.residual_slip;
    // v²/2μg.
    let expected = 1.5 * 1.5 / (0.2 * STANDARD_GRAVITY);
    assert!((free_slip / expected - 1.0).abs() < 0.05, "{free_slip}");
    assert_eq!(free.warning, None);
    let braked_block = slide_with_damping(0.5);
    let (rate, loss) = braked_block.warning.unwrap();
    assert!((rate - 0.5).abs() < 1e-9);
    let braked_slip = braked_block.residual_slip;
    assert!(
        (loss - (1.0 - braked_slip / free_slip)).abs() < 0.05,
        "{loss} {braked_slip} {free_slip}"
    );
    // A hundredth of this damping shortens the slip by half a per cent; rounding has no effect.
    for damping in [0.005, 1e-9, 1e-12, 1e-14, 1e-16] {
        assert_eq!(slide_with_damping(damping).warning, None, "{damping}");
    }
}

/// Numbers in the warnings of a structure and a motion in other units.
#[derive(Debug, Default, PartialEq)]
struct UnitWarnings {
    period: Option<f64>,
    /// Peak acceleration, relative to that of El Centro.
    acceleration: Option<f64>,
}

/// Three equal storeys under El Centro with these factors.
fn unit_warnings(stiffness_factor: f64, motion_factor: f64, soil: Soil) -> UnitWarnings {
    let storeys = [Storey::new(3.0, 30e3, 60e6 * stiffness_factor); 3];
    let building = ShearBuilding::new(8.0, 60e3, 4e5, &storeys).unwrap();
    let peak = el_centro_1940().peaks().acceleration;
    let motion = el_centro_1940().scaled(motion_factor).unwrap();
    let run = bonded_run(building, motion, soil, 8, 5e-3);
    let mut found = UnitWarnings::default();
    for warning in &run.warnings {
        match warning {
            Warning::Mistake(Mistake::LongPeriod { period }) => found.period = Some(*period),
            Warning::Mistake(Mistake::UnusualMotion { acceleration }) => {
                found.acceleration = Some(acceleration / peak);
            }
            _ => {}
        }
    }
    found
}

/// Stiffnesses in kN/m and a motion in cm/s² cause warnings; the same in their units, or on a soil that is not to scale, do
/// not.
#[test]
fn stiffnesses_and_motions_in_another_unit_cause_warnings() {
    assert_eq!(unit_warnings(1.0, 1.0, soil(250.0)), UnitWarnings::default());
    let UnitWarnings { period, acceleration } = unit_warnings(1e-3, 100.0, soil(250.0));
    // Equal storeys deflect by 3, 5 and 6 times m g/k under their weight to the side: ω² = 14/70 k/m.
    let expected = 2.0 * std::f64::consts::PI * (5.0 * 30e3_f64 / 60e3).sqrt();
    assert!((period.unwrap() / expected - 1.0).abs() < 0.02, "{period:?} {expected}");
    assert!((acceleration.unwrap() / 100.0 - 1.0).abs() < 0.03, "{acceleration:?}");
    let not_to_scale = Soil::new(1.0, 0.25, 1.0).unwrap();
    assert_eq!(unit_warnings(1e-3, 100.0, not_to_scale), UnitWarnings::default());
}

/// Two steps of a light block on this soil.
fn two_steps_on(soil: Soil) -> Run {
    let block = RigidBlock::new(4.0, 2.0, 1.0).unwrap();
    let mut simulation = Simulation::builder(1e-3)
        .ground(ElasticGround::under(soil, &block, 4).unwrap())
        .structure(block)
        .interface(Bonded)
        .gravity(0.0)
        .build()
        .unwrap();
    simulation.run(2, |_| {}).unwrap()
}

/// Soils whose numbers are of another unit cause a warning; soft and hard soils cause none.
#[test]
fn soils_in_other_units_cause_a_warning() {
    for (modulus, density, hint) in [
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
        let run = two_steps_on(soil);
        let speed = soil.shear_wave_speed();
        let expected = Warning::Mistake(Mistake::UnusualSoil { shear_wave_speed: speed, density });
        assert_eq!(run.warnings, [expected], "{modulus} {density}");
        let line = format!("warning: {expected}");
        assert!(line.ends_with(hint) && line.chars().count() <= 100, "{line}");
        assert!(run.to_string().contains(&line));
    }
    for (speed, density) in [(10.001, 500.0), (25.0, 1100.0), (4999.0, 10_000.0)] {
        let soil = Soil::from_shear_wave_speed(speed, 0.33, density).unwrap();
        assert_eq!(two_steps_on(soil).warnings, [], "{speed} {density}");
    }
    // The description has each layer.
    let profile = SoilProfile::on_half_plane(soil(800.0)).with_layer(soil(200.0), 4.0).unwrap();
    let light_soil = Soil::from_shear_wave_speed(150.0, 0.33, 18.0).unwrap();
    let profile = profile.with_layer(light_soil, 3.0).unwrap();
    let block = RigidBlock::new(4.0, 2.0, 1000.0).unwrap();
    let ground = ElasticGround::under(profile, &block, 2).unwrap();
    assert_eq!(ground.description().soils.len(), 3);
    assert_eq!(ground.description().soils[1], light_soil);
}
