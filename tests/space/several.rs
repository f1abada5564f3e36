//! Several bodies on one ground in plan: each has its own forces, all of them together those about their common middle.

use basemat::bem::PlanError;
use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, SpringGround};
use basemat::coupled::State;
use basemat::interface::{Bonded, Coulomb, Mode};
use basemat::motion::{FreeField, Record, Triaxial, el_centro_1940};
use basemat::results::{Criterion, Quantity, Recorder, Run, Serviceability, TimeSeries};
use basemat::structure::{RigidBlock, RigidBody, StructureGroup};
use basemat::{Error, Simulation, Soil};

use basemat_problems::scenes::recorded;

use super::cells::{BED, Cells, Waves};

/// Sides of two bodies, and the middles of their bases.
const SIDES: [[f64; 3]; 2] = [[8.0, 6.0, 10.0], [4.0, 6.0, 9.0]];
const MIDDLES: [[f64; 2]; 2] = [[0.0, 0.0], [9.0, 0.0]];
const DENSITY: f64 = 2000.0;
/// Their elements of 1 m².
const PLACES: [std::ops::Range<usize>; 2] = [0..48, 48..72];

/// Stronger than [`Waves`].
struct Strong(usize);

impl FreeField for Strong {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in plan asks for three directions")
    }
    fn displacement_at(&self, place: [f64; 2], time: f64) -> [f64; 3] {
        Waves { quarters: self.0 }.displacement_at(place, time).map(|u| 12.0 * u)
    }
}

fn turned([x, y]: [f64; 2], quarters: usize) -> [f64; 2] {
    (0..quarters).fold([x, y], |[x, y], _| [-y, x])
}

fn body(k: usize, quarters: usize) -> RigidBody {
    let [length, width, height] = SIDES[k];
    let [length, width] = if quarters % 2 == 1 { [width, length] } else { [length, width] };
    let body = RigidBody::cuboid([length, width, height], DENSITY).unwrap();
    body.centered_at(turned(MIDDLES[k], quarters)).unwrap()
}

/// Both, turned by quarters about the vertical axis.
fn both(quarters: usize) -> StructureGroup {
    let group = StructureGroup::new().with(body(0, quarters), 0.0).unwrap();
    group.with(body(1, quarters), 0.0).unwrap()
}

/// Both lift and slide on springs, with cells of 1 m.
fn rocked(quarters: usize) -> (Simulation, TimeSeries, Run, Vec<State>) {
    let group = both(quarters);
    let ground = SpringGround::under(&group, 6, 4e7, 3e7).unwrap();
    let mut simulation = Simulation::builder(5e-3)
        .structure(group)
        .ground(ground.with_dashpots(8e5, 4e5).unwrap())
        .interface(Coulomb::new(0.35).unwrap())
        .motion(Strong(quarters))
        .serviceability(Serviceability {
            slip: Some(1e-2),
            gap: Some(1e-3),
            rotation: Some(2e-2),
            uplifted_fraction: Some(0.5),
        })
        .build()
        .unwrap();
    let (time_series, run, states) = recorded(&mut simulation, Recorder::new().contact(1), 300);
    assert!(run.energy_error < 1e-9);
    (simulation, time_series, run, states)
}

/// Forces on the soil of some elements, and moments about a point: along, across, normal, about x, counter-clockwise
/// about −y, torque; open area and area.
fn by_hand(
    time_series: &TimeSeries,
    state: &State,
    own: std::ops::Range<usize>,
    middle: [f64; 2],
) -> [f64; 8] {
    let mut sums = [0.0; 8];
    for e in own {
        let element = &time_series.elements()[e];
        let (area, center) = (element.area(), element.center());
        let [x, y] = [0, 1].map(|axis| center[axis] - middle[axis]);
        let own = &state.contact[e];
        let [fx, fy, p] = [own.shear, own.shear_across, own.pressure].map(|t| area * t);
        let open = if state.modes[e] == Mode::Open { area } else { 0.0 };
        for (sum, value) in
            sums.iter_mut().zip([fx, fy, p, -y * p, x * p, x * fy - y * fx, open, area])
        {
            *sum += value;
        }
    }
    sums
}

#[test]
fn each_body_has_its_own_forces_and_all_have_theirs_about_the_middle() {
    let (simulation, time_series, run, states) = rocked(0);
    let weights = SIDES.map(|[a, b, c]| 9.80665 * DENSITY * a * b * c);
    let start = simulation.state().foundations.iter().map(|own| own.elements.clone());
    assert!(start.eq(PLACES));
    assert_eq!(run.foundations.len(), 2);
    for (k, own) in run.foundations.iter().enumerate() {
        let ([length, width, _], [x, y]) = (SIDES[k], MIDDLES[k]);
        assert_eq!(own.ends, [x - 0.5 * length, x + 0.5 * length]);
        assert_eq!(own.depth, [y - 0.5 * width, y + 0.5 * width]);
        assert!((own.static_normal_force / weights[k] - 1.0).abs() < 1e-9);
        assert!(own.uplift.duration > 0.0 && own.sliding.path > 0.0);
    }
    let (whole, all) = ([3.5, 0.0], weights[0] + weights[1]);
    assert_eq!((run.whole.ends, run.whole.depth), ([-4.0, 11.0], [-3.0, 3.0]));
    assert!((run.whole.static_normal_force / all - 1.0).abs() < 1e-9);
    for state in &states {
        let scale = all * 10.0;
        for (k, own) in state.foundations.iter().enumerate() {
            let [fx, fy, normal, about_x, moment, torque, open, area] =
                by_hand(&time_series, state, PLACES[k].clone(), MIDDLES[k]);
            for (found, exact) in [
                (own.base_shear, fx),
                (own.shear_across, fy),
                (own.normal_force, normal),
                (own.moment_across, about_x),
                (own.base_moment, moment),
                (own.torque, torque),
            ] {
                assert!((found - exact).abs() < 1e-12 * scale, "{k}: {found} {exact}");
            }
            assert!((own.uplifted_fraction - open / area).abs() < 1e-14);
            // The body's own degrees of freedom.
            let u = &state.displacement()[6 * k..6 * k + 6];
            for (found, exact) in
                [(own.base_rotation, u[4]), (own.rotation_across, u[3]), (own.twist, u[5])]
            {
                assert!((found - exact).abs() < 1e-14, "{k}: {found} {exact}");
            }
            assert_eq!(own.force_vector(), [own.base_shear, own.shear_across, -own.normal_force]);
            assert_eq!(own.moment_vector(), [own.moment_across, own.base_moment, own.torque]);
            assert_eq!(own.rotation_vector(), [own.rotation_across, own.base_rotation, own.twist]);
        }
        let [fx, fy, normal, about_x, moment, torque, open, _] =
            by_hand(&time_series, state, 0..72, whole);
        for (found, exact) in state.moment_vector().into_iter().zip([about_x, moment, torque]) {
            assert!((found - exact).abs() < 1e-12 * scale, "{found} {exact}");
        }
        for (quantity, exact) in [
            (Quantity::BaseShear, fx),
            (Quantity::ShearAcross, fy),
            (Quantity::HorizontalForce, fx.hypot(fy)),
            (Quantity::NormalForce, normal),
            (Quantity::MomentAcross, about_x),
            (Quantity::BaseMoment, moment),
            (Quantity::Torque, torque),
            (Quantity::UpliftedArea, open),
        ] {
            let found = state.value(quantity);
            assert!((found - exact).abs() < 1e-12 * scale, "{quantity}: {found} {exact}");
        }
        let slip = |own: &basemat::interface::ContactState| own.slip_across;
        let mean = state.contact.iter().map(slip).sum::<f64>() / 72.0;
        assert!((state.value(Quantity::MeanSlipAcross) - mean).abs() < 1e-14);
        let furthest = |value: fn(&basemat::coupled::Foundation) -> f64| {
            let [a, b] = [&state.foundations[0], &state.foundations[1]].map(value);
            if b.abs() > a.abs() { b } else { a }
        };
        assert_eq!(state.value(Quantity::Twist), furthest(|own| own.twist));
        assert_eq!(state.value(Quantity::RotationAcross), furthest(|own| own.rotation_across));
    }
    let page = run.to_string();
    // Four cells a side of the narrower body: 3/4.
    for text in [
        "over the left or the right edge",
        "over the front or the back edge",
        "0.75 of the half width from the middle of the base at most:\n  a base on its edge has a factor of 1.33, not 1",
        "(1.07 or less with 16 elements a side)",
    ] {
        assert!(page.contains(text), "{text}\n{page}");
    }
    for text in ["x -4.00 to 4.00, y -3.00 to 3.00", "x 7.00 to 11.00, y -3.00 to 3.00"] {
        assert!(page.contains(text), "{page}");
    }
}

/// Limits of service hold for either body, in any direction.
#[test]
fn service_is_that_of_either_body() {
    let (_, time_series, run, states) = rocked(0);
    let furthest = |of: &dyn Fn(&State, usize) -> f64| {
        let each = states.iter().flat_map(|state| [0, 1].map(|k| of(state, k)));
        each.fold(0.0, f64::max)
    };
    let tilt = |state: &State, k: usize| {
        let u = &state.displacement()[6 * k..];
        u[3].hypot(u[4])
    };
    let slip = |state: &State, k: usize| {
        let own = &state.contact[PLACES[k].clone()];
        let [x, y] = [
            own.iter().map(|own| own.slip).sum::<f64>(),
            own.iter().map(|own| own.slip_across).sum(),
        ];
        x.hypot(y) / own.len() as f64
    };
    let open = |state: &State, k: usize| {
        let [.., open, area] = by_hand(&time_series, state, PLACES[k].clone(), [0.0; 2]);
        open / area
    };
    let gap = |state: &State, k: usize| {
        state.contact[PLACES[k].clone()].iter().fold(0.0, |most: f64, own| most.max(own.gap))
    };
    assert_eq!(run.serviceability.len(), 4);
    for check in &run.serviceability {
        let exact = match check.criterion {
            Criterion::Slip => furthest(&slip),
            Criterion::Gap => furthest(&gap),
            Criterion::UpliftedFraction => furthest(&open),
            _ => furthest(&tilt),
        };
        assert!((check.largest.value.abs() / exact - 1.0).abs() < 1e-9, "{check}: {exact}");
        assert_eq!(check.is_met(), exact <= check.limit);
    }
}

/// Turned by 90 degrees: what was along x is along y, of each body and of both.
#[test]
fn a_turned_scene_has_turned_results() {
    use Quantity as Q;
    let (_, straight, run, _) = rocked(0);
    let (_, turned, turned_run, _) = rocked(1);
    for (new, old, sign) in [
        (Q::BaseShear, Q::ShearAcross, -1.0),
        (Q::ShearAcross, Q::BaseShear, 1.0),
        (Q::HorizontalForce, Q::HorizontalForce, 1.0),
        (Q::NormalForce, Q::NormalForce, 1.0),
        (Q::MomentAcross, Q::BaseMoment, -1.0),
        (Q::BaseMoment, Q::MomentAcross, 1.0),
        (Q::Torque, Q::Torque, 1.0),
        (Q::UpliftedFraction, Q::UpliftedFraction, 1.0),
        (Q::UpliftedArea, Q::UpliftedArea, 1.0),
        (Q::MeanSlip, Q::MeanSlipAcross, -1.0),
        (Q::MeanSlipAcross, Q::MeanSlip, 1.0),
        (Q::LargestSlip, Q::LargestSlip, 1.0),
        (Q::RotationAcross, Q::BaseRotation, -1.0),
        (Q::BaseRotation, Q::RotationAcross, 1.0),
        (Q::Twist, Q::Twist, 1.0),
        (Q::FreeFieldHorizontal, Q::FreeFieldAcross, -1.0),
        (Q::FreeFieldAcross, Q::FreeFieldHorizontal, 1.0),
        (Q::FreeFieldVertical, Q::FreeFieldVertical, 1.0),
        (Q::SlidingSafety, Q::SlidingSafety, 1.0),
        (Q::OverturningSafety, Q::OverturningSafetyAcross, 1.0),
        (Q::OverturningSafetyAcross, Q::OverturningSafety, 1.0),
    ] {
        let is_safety = new.name().contains("safety");
        let seen = |value: f64| if is_safety { 1.0 / value } else { value };
        let exact: Vec<f64> = straight.series(old).iter().map(|v| sign * seen(*v)).collect();
        let largest = exact.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        assert!(largest > 0.0, "{new}");
        for (found, exact) in turned.series(new).iter().zip(&exact) {
            assert!((seen(*found) - exact).abs() < 1e-7 * largest, "{new}: {found} {exact}");
        }
        let pairs = turned_run.foundations.iter().zip(&run.foundations);
        for (own, before) in pairs.chain([(&turned_run.whole, &run.whole)]) {
            let [found, exact] = [own.peak(new).value, before.peak(old).value].map(f64::abs);
            assert!((found - exact).abs() < 1e-6 * largest.max(exact), "{new}: {found} {exact}");
        }
    }
    assert_eq!(run.foundations.len(), turned_run.foundations.len());
    let kinds = |run: &Run| -> Vec<_> { run.warnings.iter().map(std::mem::discriminant).collect() };
    assert_eq!(kinds(&run), kinds(&turned_run));
    let events =
        |run: &Run| -> usize { run.foundations.iter().map(|own| own.sliding.events.len()).sum() };
    assert_eq!(events(&run), events(&turned_run));
}

/// Bonded to elastic ground, two cubes `apart` cells from middle to middle along x, or one alone.
fn cubes(apart: Option<usize>, motion: Triaxial) -> (Simulation, Vec<Vec<f64>>) {
    let (side, cells) = (4.0, 4);
    let pitch = side / (f64::from(cells) - 0.21);
    let cube =
        |x: f64| RigidBody::cuboid([side; 3], DENSITY).unwrap().centered_at([x, 0.0]).unwrap();
    let half = 0.5 * pitch * apart.unwrap_or(0) as f64;
    let mut group = StructureGroup::new().with(cube(-half), 0.0).unwrap();
    if apart.is_some() {
        group = group.with(cube(half), 0.0).unwrap();
    }
    let soil = Soil::from_shear_wave_speed(120.0, 0.3, 1800.0).unwrap();
    let ground = ElasticGround::under(soil, &group, 4).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(group)
        .ground(ground)
        .interface(Bonded)
        .motion(motion)
        .build()
        .unwrap();
    let mut all = Vec::new();
    let run = simulation.run(150, |state| all.push(state.displacement().to_vec())).unwrap();
    assert!(run.energy_error < 1e-9);
    (simulation, all)
}

fn shaken(direction: usize) -> Triaxial {
    let record =
        || Some(Record::new(0.01, el_centro_1940().accelerations()[100..300].to_vec()).unwrap());
    match direction {
        0 => Triaxial { x: record(), ..Triaxial::default() },
        _ => Triaxial { y: record(), ..Triaxial::default() },
    }
}

/// The effect of one cube on the other falls with their distance; mirrored at the plane between them, they are the
/// same.
#[test]
fn two_cubes_couple_through_the_soil() {
    for direction in 0..2 {
        let (_, alone) = cubes(None, shaken(direction));
        let dof = |k: usize| alone.iter().fold(0.0_f64, |most, u| most.max(u[k].abs()));
        let size = dof(direction);
        let apart = [6, 12, 30].map(|cells| {
            let (simulation, pair) = cubes(Some(cells), shaken(direction));
            assert_eq!(simulation.state().foundations.len(), 2);
            // x → −x turns u_x, r_y and r_z about; a motion along x is turned about, too.
            let own = if direction == 0 { -1.0 } else { 1.0 };
            let signs = [-1.0, 1.0, 1.0, 1.0, -1.0, -1.0].map(|sign| own * sign);
            // Before the fastest waves get there.
            let pitch = 4.0 / 3.79;
            let arrival = (pitch * cells as f64 - 4.0) / (120.0 * 3.5_f64.sqrt());
            let mut worst = 0.0_f64;
            for (step, (u, alone)) in pair.iter().zip(&alone).enumerate() {
                for k in 0..6 {
                    let difference = (u[k] - signs[k] * u[6 + k]).abs();
                    assert!(difference < 1e-9 * size, "{direction} {k}: {difference:e}");
                    let lever = if k < 3 { 1.0 } else { 2.0 };
                    let other = lever * (u[k] - alone[k]).abs() / size;
                    worst = worst.max(other);
                    let is_early = 0.01 * (step as f64 + 2.0) < arrival;
                    assert!(!is_early || other < 1e-4, "{direction} {k} {step}: {other:e}");
                }
            }
            worst
        });
        println!("{direction}: {apart:?}");
        // Surface waves fall with the root of the distance.
        assert!(apart[1] < apart[0] && apart[2] < apart[1], "{apart:?}");
        assert!(apart[2] < 1.4 * apart[0] / 5.0_f64.sqrt(), "{apart:?}");
    }
}

#[test]
fn mats_that_are_no_two() {
    let group = || StructureGroup::new().with(body(0, 0), 0.0).unwrap();
    let at = |center: [f64; 2]| body(1, 0).centered_at(center).unwrap();
    // Overlapping, crossing without a corner in the other, side to side; beside it is well.
    let beam = RigidBody::cuboid([12.0, 2.0, 1.0], DENSITY).unwrap();
    for other in [at([2.0, 1.0]), at([6.0, 0.0]), beam] {
        let error = group().with(other, 0.0).err().unwrap();
        assert!(error.to_string().contains("touch or overlap"), "{error}");
    }
    assert!(group().with(at([6.0, 0.0]), 0.01).is_ok());
    assert!(group().with(at([0.0, 6.01]), 0.0).is_ok());
    let block = RigidBlock::new(4.0, 4.0, DENSITY).unwrap();
    assert!(group().with(block.clone(), 20.0).is_err());
    assert!(StructureGroup::new().with(block, 0.0).unwrap().with(body(0, 0), 20.0).is_err());
    // Half a cell between them.
    let close = group().with(at([6.75, 0.0]), 0.0).unwrap();
    let soil = Soil::from_shear_wave_speed(120.0, 0.3, 1800.0).unwrap();
    for error in [
        ElasticGround::under(soil, &close, 4).err().unwrap(),
        SpringGround::under(&close, 4, 4e7, 3e7).err().unwrap(),
    ] {
        assert!(matches!(error, Error::Plan(PlanError::TooClose { mats: [0, 1], .. })), "{error}");
    }

    let build = |ground: Cells| {
        let built = Simulation::builder(0.01).structure(both(0)).ground(ground).interface(Bonded);
        built.build().err().unwrap()
    };
    // Row by row under both: the elements of a mat do not follow one another.
    let lines: Vec<f64> = (-4..=11).map(f64::from).collect();
    let mut rows = Cells::between(&lines, &[-3.0, 0.0, 3.0], BED);
    let between = |x: f64| x > 4.0 && x < 7.0;
    rows.elements.retain(|own| !between(own.center()[0]));
    let error = build(rows.resized());
    assert!(error.to_string().contains("apart from the others of its mat"), "{error}");
    // One element reaches from one mat to the other.
    let wide = Cells::between(&[-4.0, 4.0, 7.0, 11.0], &[-3.0, 3.0], BED);
    let error = build(wide);
    assert!(error.to_string().contains("under two mats"), "{error}");
    // Nothing under the second.
    let error = build(Cells::between(&lines[..9], &[-3.0, 0.0, 3.0], BED));
    assert!(matches!(error, Error::Size { found: 0, .. }), "{error}");
    // A plan of the first alone.
    let plan = Plan::rectangle(-4.0..4.0, -3.0..3.0, 4).unwrap();
    let ground = SpringGround::in_plan(plan, [4e7, 3e7, 3e7]).unwrap();
    let built = Simulation::builder(0.01).structure(both(0)).ground(ground).interface(Bonded);
    assert!(matches!(built.build(), Err(Error::Size { found: 0, .. })));
}
