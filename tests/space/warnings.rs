//! Warnings of cells and steps that miss what a body in plan and its ground do.

use std::f64::consts::TAU;

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Ground, SpringGround};
use basemat::coupled::{Load, Mistake, Warning};
use basemat::interface::{Bonded, Cohesive, Coulomb};
use basemat::motion::{FreeField, Record, TravellingWave, Triaxial, el_centro_1940};
use basemat::results::Run;
use basemat::structure::{PlanStorey, RigidBlock, RigidBody, StoreyBuilding};
use basemat::{Simulation, Soil};

use super::cells::{BED, Cells};

fn motion(record: Record, along_y: bool) -> Triaxial {
    let [x, y] = if along_y { [None, Some(record)] } else { [Some(record), None] };
    Triaxial { x, y, ..Triaxial::default() }
}

/// Five seconds of a bonded body, its largest rotation about an axis on the surface and its largest base shear.
fn run(sides: [f64; 3], speed: f64, motion: Triaxial, cells: usize, step: f64) -> (Run, f64, f64) {
    let body = RigidBody::cuboid(sides, 2000.0).unwrap();
    let soil = Soil::from_shear_wave_speed(speed, 1.0 / 3.0, 1900.0).unwrap();
    let mut simulation = Simulation::builder(step)
        .ground(ElasticGround::under(soil, &body, cells).unwrap())
        .structure(body)
        .interface(Bonded)
        .motion(motion)
        .build()
        .unwrap();
    let (mut rotation, mut shear) = (0.0_f64, 0.0_f64);
    let mut run = simulation
        .run(simulation.steps_for(5.0), |state| {
            let u = state.displacement();
            rotation = rotation.max(u[3].hypot(u[4]));
            let own = &state.foundations[0];
            shear = shear.max(own.base_shear.hypot(own.shear_across));
        })
        .unwrap();
    // They end before their record; here is looked at resolution.
    let other = |own: &Warning| matches!(own, Warning::Tension { .. } | Warning::EndsEarly { .. });
    run.warnings.retain(|warning| !other(warning));
    (run, rotation, shear)
}

/// The one warning of a run.
fn only(run: &Run) -> Warning {
    let [warning] = run.warnings[..] else { panic!("{:?}", run.warnings) };
    assert!(run.to_string().contains(&format!("warning: {warning}")));
    warning
}

/// The same along x and along y.
#[test]
fn cells_longer_than_a_twelfth_of_waves() {
    let sides = [20.0, 20.0, 8.0];
    let shake = |along_y, cells| run(sides, 60.0, motion(el_centro_1940(), along_y), cells, 5e-3);
    for along_y in [false, true] {
        let [(coarse, angle, _), (fine, wanted, _)] = [4, 9].map(|cells| shake(along_y, cells));
        assert_eq!(fine.warnings, []);
        let Warning::LongElements { element_length, wavelength, needed } = only(&coarse) else {
            panic!("{:?}", coarse.warnings)
        };
        assert!((element_length - 20.0 / 3.79).abs() < 1e-12, "{element_length}");
        assert!((needed - wavelength / 12.0).abs() < 1e-12 && needed < element_length);
        assert!((angle / wanted - 1.0).abs() > 0.005, "{angle} {wanted}");
    }
}

/// Of a mat twice as long as wide, the side with the fewer cells counts; unions of many cells do not.
#[test]
fn rows_and_columns_are_counted() {
    let tall = [8.0, 4.0, 12.0];
    let (few, _, _) = run(tall, 250.0, motion(el_centro_1940(), true), 2, 2e-3);
    let wanted = Warning::FewElements { foundation: 0, elements: 2, needed: 4, axis: Some('y') };
    assert_eq!(only(&few), wanted);
    let (enough, _, _) = run(tall, 250.0, motion(el_centro_1940(), true), 4, 2e-3);
    assert_eq!(enough.warnings, []);
}

/// A tower that rocks along y: steps that waves cross its base in damp it; a flat block follows the ground.
#[test]
fn steps_as_long_as_waves_take_across() {
    let shake =
        |height, step| run([10.0, 10.0, height], 400.0, motion(el_centro_1940(), true), 4, step);
    let (fine, _, wanted) = shake(20.0, 2.5e-3);
    assert_eq!(fine.warnings, []);
    let (coarse, _, found) = shake(20.0, 1e-2);
    let Warning::UnresolvedRadiation { crossing, time_step, needed } = only(&coarse) else {
        panic!("{:?}", coarse.warnings)
    };
    assert!((crossing - 10.0 / 400.0).abs() < 0.1 * crossing && time_step == 1e-2);
    assert!((needed - crossing / 8.0).abs() < 1e-15);
    assert!((found / wanted - 1.0).abs() > 0.05, "{found} {wanted}");
    let (flat, _, found) = shake(1.5, 1e-2);
    assert_eq!(flat.warnings, []);
    let (_, _, wanted) = shake(1.5, 2.5e-3);
    assert!((found / wanted - 1.0).abs() < 0.02, "{found} {wanted}");
}

/// Steps that miss a motion along y alone.
#[test]
fn motions_along_y_are_judged() {
    let slow = el_centro_1940().scaled(0.1).unwrap();
    let fast = Record::new(0.002, slow.accelerations().to_vec()).unwrap();
    let (run, _, _) = run([20.0, 20.0, 4.0], 2000.0, motion(fast, true), 4, 2e-2);
    let found = |warning: &Warning| matches!(warning, Warning::UnresolvedMotion { .. });
    assert!(run.warnings.iter().any(found), "{:?}", run.warnings);
}

/// Along y as along x: a base that reaches beyond its cells, a storey that is all but a mechanism, a base that turns far.
#[test]
fn what_is_said_of_x_is_said_of_y() {
    for (axis, name) in [(0, 'x'), (1, 'y')] {
        let swapped = |pair: [f64; 2]| if axis == 0 { pair } else { [pair[1], pair[0]] };
        let [x, y] = swapped([2.0, 4.0]);
        let plan = Plan::rectangle(-x..x, -y..y, 4).unwrap();
        let [kx, ky] = swapped([1e4, 1e8]);
        let mat = RigidBody::cuboid([8.0, 8.0, 1.0], 2400.0).unwrap();
        let storey = PlanStorey::new(4.0, 1e5, [8.0; 2], [kx, ky, 1e9]);
        let building = StoreyBuilding::new(mat, &[storey]).unwrap();
        let mut simulation = Simulation::builder(1e-3)
            .structure(building)
            .ground(SpringGround::in_plan(plan, [4e7, 3e7, 3e7]).unwrap())
            .interface(Bonded)
            // About y, or about x.
            .load(Load::new(4 - axis, |time| if time > 0.0 { 2e8 } else { 0.0 }))
            .build()
            .unwrap();
        let warnings = simulation.run(100, |_| {}).unwrap().warnings;
        let has = |of: &dyn Fn(&Warning) -> bool| assert!(warnings.iter().any(of), "{warnings:?}");
        let long = TAU * (1e5 / 1e4_f64).sqrt();
        has(
            &|own| matches!(own, Warning::Mistake(Mistake::LongPeriod { period }) if (period / long - 1.0).abs() < 0.02),
        );
        has(&|own| matches!(own, Warning::LargeRotation { rotation } if *rotation > 0.11));
        has(&|own| match own {
            Warning::UncoveredBase { axis, reach, .. } => {
                *axis == Some(name) && (reach - 2.0).abs() < 1e-12
            }
            _ => false,
        });
        let uncovered = warnings.iter().find(|own| matches!(own, Warning::UncoveredBase { .. }));
        assert!(uncovered.unwrap().to_string().contains(&format!("2.00 m along {name} beyond")));
        let tension = warnings.iter().find(|own| matches!(own, Warning::Tension { .. }));
        assert!(tension.unwrap().to_string().contains(" m, y = "), "{warnings:?}");
    }
}

/// More than 512 cells are too many for the gate; a ground of one's own may say so too.
#[test]
fn samples_of_the_passivity_gate_are_told() {
    let ground = |cells| {
        let plan = Plan::rectangle(-1.0..1.0, -1.0..1.0, cells).unwrap();
        ElasticGround::in_plan(Soil::new(8e7, 0.3, 1900.0).unwrap(), plan).unwrap()
    };
    assert_eq!(ground(22).description().sampled_cells, None);
    assert_eq!(ground(23).description().sampled_cells, Some([256, 529]));
    let build = |sample| {
        let mut cells = Cells::under([4.0; 2], [0.0; 2], [4, 4], BED);
        cells.sampled = sample;
        let body = RigidBody::cuboid([4.0; 3], 2000.0).unwrap();
        let builder = Simulation::builder(0.01).structure(body).ground(cells);
        builder.interface(Bonded).build().unwrap().run(2, |_| {}).unwrap().warnings
    };
    assert_eq!(build(None), []);
    assert_eq!(build(Some([9, 16])), [Warning::SampledPassivity { checked: 9, cells: 16 }]);
}

/// Beside a bond, endless friction is a finite one where it slides: that is said, and nowhere else.
#[test]
fn friction_that_was_less_is_told() {
    let shake = |law: Cohesive| {
        let motion = || Some(el_centro_1940().scaled(2.0).unwrap());
        let mut simulation = Simulation::builder(4e-3)
            .structure(RigidBody::cuboid([6.0, 6.0, 3.0], 2000.0).unwrap())
            .ground(Cells::under([6.0; 2], [0.0; 2], [4, 4], BED))
            .interface(law)
            .motion(Triaxial { x: motion(), y: motion(), ..Triaxial::default() })
            .build()
            .unwrap();
        simulation.run(600, |_| {}).unwrap()
    };
    let bond = |friction| Cohesive::new(1e6, 1.0, friction).unwrap();
    let [endless, finite] = [f64::INFINITY, 5.0].map(|friction| shake(bond(friction)));
    println!("{:?} {:?}", endless.warnings, finite.warnings);
    let found = |run: &Run| {
        let less = run.warnings.iter().find(|w| matches!(w, Warning::LessFriction { .. }));
        less.map(ToString::to_string)
    };
    assert!(found(&endless).unwrap().contains("friction 10000 "));
    assert_eq!(found(&finite), None);
}

/// A ground in the plane says so if it leaves out what moves along y.
#[test]
fn motion_along_y_has_no_place_in_the_plane() {
    let record = el_centro_1940();
    let warns = |motion: Box<dyn FreeField>| {
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
        assert_eq!(
            run.warnings.contains(&Warning::MotionAcross),
            run.to_string().contains("along y")
        );
        run.warnings.contains(&Warning::MotionAcross)
    };
    let wave = || TravellingWave::new(record.clone(), 800.0, -3.0).unwrap();
    assert!(!warns(Box::new(record.clone())));
    assert!(!warns(Box::new(wave())));
    assert!(!warns(Box::new(Triaxial { x: Some(record.clone()), ..Triaxial::default() })));
    assert!(warns(Box::new(motion(record.clone(), true))));
    assert!(warns(Box::new(wave().with_azimuth(0.3).unwrap())));
    assert!(!warns(Box::new(wave().with_azimuth(std::f64::consts::PI).unwrap())));
}

/// A base of 6 × 6 m on cells of 4 × 4 m; one row of cells on springs; friction with several solutions.
#[test]
fn a_base_beyond_few_cells_a_single_row_and_high_friction_are_told() {
    let found = |half: [f64; 2], counts: [usize; 2], law: Coulomb| {
        let [columns, rows] = counts;
        let pitch = [2.0 * half[0] / columns as f64, 2.0 * half[1] / rows as f64];
        let mask = vec![true; columns * rows];
        let plan = Plan::masked([-half[0], -half[1]], pitch, columns, &mask).unwrap();
        let mut simulation = Simulation::builder(5e-3)
            .ground(SpringGround::in_plan(plan, [4e8, 3e8, 3e8]).unwrap())
            .structure(RigidBody::cuboid([6.0, 6.0, 1.0], 2400.0).unwrap())
            .interface(law)
            .motion(motion(el_centro_1940().scaled(0.1).unwrap(), false))
            .build()
            .unwrap();
        simulation.run(100, |_| {}).unwrap().warnings
    };
    let law = |friction| Coulomb::new(friction).unwrap();
    let has = |warnings: &[Warning], of: &dyn Fn(&Warning) -> bool| warnings.iter().any(of);
    let uncovered =
        |own: &Warning| matches!(own, Warning::UncoveredBase { reach, .. } if *reach == 1.0);
    let few = |own: &Warning| {
        matches!(own, Warning::FewElements { elements: 1, needed: 2, axis: Some('y'), .. })
    };
    let high = |own: &Warning| matches!(own, Warning::HighFriction { .. });
    assert!(has(&found([2.0; 2], [3, 3], law(0.5)), &uncovered));
    for friction in [3.0, 99.0, f64::INFINITY] {
        assert!(has(&found([3.0; 2], [4, 4], law(friction)), &high), "{friction}");
    }
    let warnings = found([3.0; 2], [4, 4], law(2.9));
    assert!(!has(&warnings, &|own| uncovered(own) || few(own) || high(own)), "{warnings:?}");
    let row = found([3.0, 3.0], [6, 1], law(0.5));
    assert!(has(&row, &few), "{row:?}");
}
