//! Warnings about cells and steps that do not resolve the motion of a body in space and its ground.

use std::f64::consts::TAU;

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Ground, SpringGround};
use basemat::coupled::{Load, Mistake, Warning};
use basemat::interface::{Bonded, Cohesive, Coulomb};
use basemat::motion::{FreeField, Record, TravellingWave, Triaxial, el_centro_1940};
use basemat::results::Run;
use basemat::structure::{PlanStorey, RigidBlock, RigidBody, StoreyBuilding};
use basemat::{Simulation, Soil};

use super::cells::{BED_PROPERTIES, SpringCells};

fn motion_along_x(record: Record) -> Triaxial {
    Triaxial { x: Some(record), ..Triaxial::default() }
}

fn motion_along_y(record: Record) -> Triaxial {
    Triaxial { y: Some(record), ..Triaxial::default() }
}

/// A bonded body on a half-space, shaken for five seconds.
struct ShakenBody {
    sides: [f64; 3],
    /// Speed of shear waves in the soil, m/s.
    soil_speed: f64,
    motion: Triaxial,
    /// Number along the shorter side.
    cells: usize,
    time_step: f64,
}

/// Results of [`ShakenBody`].
struct ShakenResult {
    /// The run, without warnings that do not concern resolution.
    run: Run,
    /// Largest rotation about a horizontal axis.
    max_rotation: f64,
    max_base_shear: f64,
}

impl ShakenBody {
    fn run(self) -> ShakenResult {
        let body = RigidBody::cuboid(self.sides, 2000.0).unwrap();
        let soil = Soil::from_shear_wave_speed(self.soil_speed, 1.0 / 3.0, 1900.0).unwrap();
        let mut simulation = Simulation::builder(self.time_step)
            .ground(ElasticGround::under(soil, &body, self.cells).unwrap())
            .structure(body)
            .interface(Bonded)
            .motion(self.motion)
            .build()
            .unwrap();
        let mut max_rotation = 0.0_f64;
        let mut max_base_shear = 0.0_f64;
        let mut run = simulation
            .run(simulation.steps_for(5.0), |state| {
                let u = state.displacement();
                max_rotation = max_rotation.max(u[3].hypot(u[4]));
                let foundation = &state.foundations[0];
                let base_shear = foundation.base_shear.hypot(foundation.shear_across);
                max_base_shear = max_base_shear.max(base_shear);
            })
            .unwrap();
        run.warnings.retain(|warning| {
            !matches!(warning, Warning::Tension { .. } | Warning::EndsEarly { .. })
        });
        ShakenResult { run, max_rotation, max_base_shear }
    }
}

/// The one warning of a run.
fn only_warning(run: &Run) -> Warning {
    let [warning] = run.warnings[..] else { panic!("{:?}", run.warnings) };
    assert!(run.to_string().contains(&format!("warning: {warning}")));
    warning
}

/// The warning appears under motion along x and along y.
#[test]
fn cells_longer_than_a_twelfth_of_waves_give_a_warning() {
    for motion in [motion_along_x(el_centro_1940()), motion_along_y(el_centro_1940())] {
        let [coarse, fine] = [4, 9].map(|cells| {
            let sides = [20.0, 20.0, 8.0];
            let motion = motion.clone();
            ShakenBody { sides, soil_speed: 60.0, motion, cells, time_step: 5e-3 }.run()
        });
        assert_eq!(fine.run.warnings, []);
        let Warning::LongElements { element_length, wavelength, needed } =
            only_warning(&coarse.run)
        else {
            panic!("{:?}", coarse.run.warnings)
        };
        assert!((element_length - 20.0 / 3.79).abs() < 1e-12, "{element_length}");
        assert!((needed - wavelength / 12.0).abs() < 1e-12 && needed < element_length);
        let error = coarse.max_rotation / fine.max_rotation - 1.0;
        assert!(error.abs() > 0.005, "{} {}", coarse.max_rotation, fine.max_rotation);
    }
}

/// Of a mat twice as long as wide, the side with fewer cells determines the warning.
#[test]
fn rows_and_columns_of_cells_are_counted() {
    let [coarse, fine] = [2, 4].map(|cells| {
        let sides = [8.0, 4.0, 12.0];
        let motion = motion_along_y(el_centro_1940());
        ShakenBody { sides, soil_speed: 250.0, motion, cells, time_step: 2e-3 }.run()
    });
    let expected = Warning::FewElements { foundation: 0, elements: 2, needed: 4, axis: Some('y') };
    assert_eq!(only_warning(&coarse.run), expected);
    assert_eq!(fine.run.warnings, []);
}

/// A square body of this height on stiff soil, shaken along y.
fn run_of_height(height: f64, time_step: f64) -> ShakenResult {
    let sides = [10.0, 10.0, height];
    let motion = motion_along_y(el_centro_1940());
    ShakenBody { sides, soil_speed: 400.0, motion, cells: 4, time_step }.run()
}

/// A tower that rocks along y: steps that waves cross its base in damp it; a flat block follows the ground.
#[test]
fn steps_as_long_as_waves_cross_the_base_give_a_warning() {
    let fine_result = run_of_height(20.0, 2.5e-3);
    assert_eq!(fine_result.run.warnings, []);
    let coarse_result = run_of_height(20.0, 1e-2);
    let Warning::UnresolvedRadiation { crossing, time_step, needed } =
        only_warning(&coarse_result.run)
    else {
        panic!("{:?}", coarse_result.run.warnings)
    };
    assert!((crossing - 10.0 / 400.0).abs() < 0.1 * crossing && time_step == 1e-2);
    assert!((needed - crossing / 8.0).abs() < 1e-15);
    let ratio = coarse_result.max_base_shear / fine_result.max_base_shear;
    assert!((ratio - 1.0).abs() > 0.05, "{ratio}");
    let flat_coarse = run_of_height(1.5, 1e-2);
    assert_eq!(flat_coarse.run.warnings, []);
    let flat_fine = run_of_height(1.5, 2.5e-3);
    let ratio = flat_coarse.max_base_shear / flat_fine.max_base_shear;
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
}

/// Steps that do not resolve a motion along y alone.
#[test]
fn unresolved_motions_along_y_give_a_warning() {
    let slow_record = el_centro_1940().scaled(0.1).unwrap();
    let fast_record = Record::new(0.002, slow_record.accelerations().to_vec()).unwrap();
    let body = ShakenBody {
        sides: [20.0, 20.0, 4.0],
        soil_speed: 2000.0,
        motion: motion_along_y(fast_record),
        cells: 4,
        time_step: 2e-2,
    };
    let run = body.run().run;
    let is_unresolved = |warning: &Warning| matches!(warning, Warning::UnresolvedMotion { .. });
    assert!(run.warnings.iter().any(is_unresolved), "{:?}", run.warnings);
}

/// A pair along and across an axis, as a pair along x and y.
fn along_axis(axis: usize, pair: [f64; 2]) -> [f64; 2] {
    if axis == 0 { pair } else { [pair[1], pair[0]] }
}

/// Warnings of a base that reaches beyond its cells along an axis, under a storey that is nearly a mechanism.
fn soft_storey_warnings(axis: usize) -> Vec<Warning> {
    let half = along_axis(axis, [2.0, 4.0]);
    let plan = Plan::rectangle(-half[0]..half[0], -half[1]..half[1], 4).unwrap();
    let stiffness = along_axis(axis, [1e4, 1e8]);
    let mat = RigidBody::cuboid([8.0, 8.0, 1.0], 2400.0).unwrap();
    let storey = PlanStorey::new(4.0, 1e5, [8.0; 2], [stiffness[0], stiffness[1], 1e9]);
    let building = StoreyBuilding::new(mat, &[storey]).unwrap();
    let mut simulation = Simulation::builder(1e-3)
        .structure(building)
        .ground(SpringGround::in_plan(plan, [4e7, 3e7, 3e7]).unwrap())
        .interface(Bonded)
        // About y, or about x.
        .load(Load::new(4 - axis, |time| if time > 0.0 { 2e8 } else { 0.0 }))
        .build()
        .unwrap();
    simulation.run(100, |_| {}).unwrap().warnings
}

/// Along y as along x: a base that reaches beyond its cells, a storey that is nearly a mechanism, a base that turns far.
#[test]
fn warnings_along_y_are_those_along_x() {
    let expected_period = TAU * (1e5 / 1e4_f64).sqrt();
    for (axis, name) in [(0, 'x'), (1, 'y')] {
        let warnings = soft_storey_warnings(axis);
        let has_long_period = warnings.iter().any(|warning| match warning {
            Warning::Mistake(Mistake::LongPeriod { period }) => {
                (period / expected_period - 1.0).abs() < 0.02
            }
            _ => false,
        });
        assert!(has_long_period, "{warnings:?}");
        let has_large_rotation = warnings.iter().any(|warning| match warning {
            Warning::LargeRotation { rotation } => *rotation > 0.11,
            _ => false,
        });
        assert!(has_large_rotation, "{warnings:?}");
        let uncovered = warnings.iter().find(|warning| match warning {
            Warning::UncoveredBase { axis, reach, .. } => {
                *axis == Some(name) && (reach - 2.0).abs() < 1e-12
            }
            _ => false,
        });
        let text = uncovered.expect("a warning of the base").to_string();
        assert!(text.contains(&format!("2.00 m along {name} beyond")), "{text}");
        let tension = warnings.iter().find(|warning| matches!(warning, Warning::Tension { .. }));
        assert!(tension.unwrap().to_string().contains(" m, y = "), "{warnings:?}");
    }
}

/// An elastic ground of `cells` × `cells`.
fn square_ground(cells: usize) -> ElasticGround {
    let plan = Plan::rectangle(-1.0..1.0, -1.0..1.0, cells).unwrap();
    ElasticGround::in_plan(Soil::new(8e7, 0.3, 1900.0).unwrap(), plan).unwrap()
}

/// Warnings of a ground that samples some of its cells.
fn sampling_warnings(sampled_cells: Option<[usize; 2]>) -> Vec<Warning> {
    let mut cells = SpringCells::under([4.0; 2], [0.0; 2], [4, 4], BED_PROPERTIES);
    cells.sampled_cells = sampled_cells;
    let body = RigidBody::cuboid([4.0; 3], 2000.0).unwrap();
    let builder = Simulation::builder(0.01).structure(body).ground(cells);
    builder.interface(Bonded).build().unwrap().run(2, |_| {}).unwrap().warnings
}

/// Of more than 512 cells the passivity check samples some; a user's ground may do so too.
#[test]
fn sampled_passivity_gives_a_warning() {
    assert_eq!(square_ground(22).description().sampled_cells, None);
    assert_eq!(square_ground(23).description().sampled_cells, Some([256, 529]));
    assert_eq!(sampling_warnings(None), []);
    let expected = Warning::SampledPassivity { checked: 9, cells: 16 };
    assert_eq!(sampling_warnings(Some([9, 16])), [expected]);
}

/// Text of the warning of substituted friction beside a bond.
fn substituted_friction(friction: f64) -> Option<String> {
    let record = el_centro_1940().scaled(2.0).unwrap();
    let motion = Triaxial { x: Some(record.clone()), y: Some(record), up: None };
    let mut simulation = Simulation::builder(4e-3)
        .structure(RigidBody::cuboid([6.0, 6.0, 3.0], 2000.0).unwrap())
        .ground(SpringCells::under([6.0; 2], [0.0; 2], [4, 4], BED_PROPERTIES))
        .interface(Cohesive::new(1e6, 1.0, friction).unwrap())
        .motion(motion)
        .build()
        .unwrap();
    let run = simulation.run(600, |_| {}).unwrap();
    println!("{:?}", run.warnings);
    let mut warnings = run.warnings.iter();
    let warning = warnings.find(|warning| matches!(warning, Warning::LessFriction { .. }));
    warning.map(ToString::to_string)
}

/// Beside a bond, infinite friction is replaced by a finite one where it slides, with a warning.
#[test]
fn substituted_friction_gives_a_warning() {
    assert!(substituted_friction(f64::INFINITY).unwrap().contains("friction 10000 "));
    assert_eq!(substituted_friction(5.0), None);
}

/// Whether a run in the plane warns that its ground leaves out a motion along y.
fn warns_of_motion_across(motion: impl FreeField + 'static) -> bool {
    let soil = Soil::from_shear_wave_speed(250.0, 0.3, 1900.0).unwrap();
    let block = RigidBlock::new(6.0, 6.0, 2000.0).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .ground(ElasticGround::under(soil, &block, 8).unwrap())
        .structure(block)
        .interface(Bonded)
        .motion(motion)
        .build()
        .unwrap();
    let run = simulation.run(10, |_| {}).unwrap();
    let warns = run.warnings.contains(&Warning::MotionAcross);
    assert_eq!(warns, run.to_string().contains("along y"));
    warns
}

/// El Centro, travelling along x.
fn travelling_wave() -> TravellingWave {
    TravellingWave::new(el_centro_1940(), 800.0, -3.0).unwrap()
}

/// A ground in the plane that leaves out a motion along y causes a warning.
#[test]
fn motion_along_y_on_a_ground_in_the_plane_gives_a_warning() {
    let record = el_centro_1940();
    assert!(!warns_of_motion_across(record.clone()));
    assert!(!warns_of_motion_across(travelling_wave()));
    assert!(!warns_of_motion_across(motion_along_x(record.clone())));
    assert!(warns_of_motion_across(motion_along_y(record)));
    assert!(warns_of_motion_across(travelling_wave().with_azimuth(0.3).unwrap()));
    assert!(!warns_of_motion_across(travelling_wave().with_azimuth(std::f64::consts::PI).unwrap()));
}

/// Warnings of a base of 6 × 6 m on columns and rows of cells within a rectangle.
fn cell_warnings(half_sides: [f64; 2], counts: [usize; 2], friction: f64) -> Vec<Warning> {
    let pitch = [0, 1].map(|axis| 2.0 * half_sides[axis] / counts[axis] as f64);
    let mask = vec![true; counts[0] * counts[1]];
    let origin = [-half_sides[0], -half_sides[1]];
    let plan = Plan::masked(origin, pitch, counts[0], &mask).unwrap();
    let mut simulation = Simulation::builder(5e-3)
        .ground(SpringGround::in_plan(plan, [4e8, 3e8, 3e8]).unwrap())
        .structure(RigidBody::cuboid([6.0, 6.0, 1.0], 2400.0).unwrap())
        .interface(Coulomb::new(friction).unwrap())
        .motion(motion_along_x(el_centro_1940().scaled(0.1).unwrap()))
        .build()
        .unwrap();
    simulation.run(100, |_| {}).unwrap().warnings
}

fn is_uncovered_by_a_metre(warning: &Warning) -> bool {
    matches!(warning, Warning::UncoveredBase { reach, .. } if *reach == 1.0)
}

fn is_single_row(warning: &Warning) -> bool {
    matches!(warning, Warning::FewElements { elements: 1, needed: 2, axis: Some('y'), .. })
}

fn is_high_friction(warning: &Warning) -> bool {
    matches!(warning, Warning::HighFriction { .. })
}

/// A base of 6 × 6 m on cells of 4 × 4 m; one row of cells on springs; friction with several solutions.
#[test]
fn a_base_beyond_few_cells_a_single_row_and_high_friction_give_warnings() {
    let warnings = cell_warnings([2.0; 2], [3, 3], 0.5);
    assert!(warnings.iter().any(is_uncovered_by_a_metre), "{warnings:?}");
    for friction in [3.0, 99.0, f64::INFINITY] {
        let warnings = cell_warnings([3.0; 2], [4, 4], friction);
        assert!(warnings.iter().any(is_high_friction), "{friction}");
    }
    let warnings = cell_warnings([3.0; 2], [4, 4], 2.9);
    for predicate in [is_uncovered_by_a_metre, is_single_row, is_high_friction] {
        assert!(!warnings.iter().any(predicate), "{warnings:?}");
    }
    let warnings = cell_warnings([3.0, 3.0], [6, 1], 0.5);
    assert!(warnings.iter().any(is_single_row), "{warnings:?}");
}
