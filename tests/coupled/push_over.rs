//! GOAL: static push-over: force against displacement with uplift and sliding, up to the limit.
//! SCENE: rigid blocks on springs without tension, on stiff springs, on slippery ones, on the half-plane; in plan.
//! REFERENCE: the closed form of the Winkler strip and its table; W b/2 on rigid ground; μ W; symmetry.

use basemat::analyses::{PushControl, PushOver, push_over};
use basemat::bem::{ElasticGround, SpringGround};
use basemat::coupled::Load;
use basemat::interface::Coulomb;
use basemat::structure::RigidBlock;
use basemat::{Error, Simulation, Soil};
use basemat_problems::table;

const GRAVITY: f64 = 9.81;

/// A block 5 m wide and 8 m high on springs; pushed at its middle or top.
fn pushed(
    elements: usize,
    stiffness: f64,
    friction: f64,
    height: f64,
    path: &PushControl,
) -> PushOver {
    let block = RigidBlock::new(5.0, 8.0, 2000.0).unwrap();
    let row = block.horizontal_at(height);
    push_over(&row, path, |force| {
        Simulation::builder(0.01)
            .gravity(GRAVITY)
            .ground(SpringGround::under(&block, elements, stiffness, stiffness)?)
            .structure(block.clone())
            .interface(Coulomb::new(friction)?)
            .load(Load::constant(row.clone(), force))
            .build()
    })
    .unwrap()
}

const WEIGHT: f64 = 80.0e3 * GRAVITY;

/// Moments at the rotations of the table; the middles of 100 cells err by 1/100.
#[test]
fn a_block_on_springs_without_tension_has_the_winkler_strips_curve() {
    let stiffness = 3.0e7;
    let uplift = WEIGHT / (2.0 * stiffness * 2.5 * 2.5);
    let mut forces = Vec::new();
    let mut wanted: Vec<[f64; 3]> = Vec::new();
    for [ratio, moment, contact] in
        table("winkler_static_M_theta.csv").rows(["theta_over_thu", "M_over_NB", "contact_over_2B"])
    {
        if (0.2..6.0).contains(&ratio)
            && forces.len() < 8
            && (forces.is_empty() || moment > 1.45 * wanted[wanted.len() - 1][1])
        {
            forces.push(moment * WEIGHT * 2.5 / 8.0);
            wanted.push([ratio, moment, contact]);
        }
    }
    assert!(forces.len() > 3 && wanted.iter().any(|row| row[2] < 0.8), "{wanted:?}");
    let curve = pushed(100, stiffness, 5.0, 8.0, &PushControl::Forces(forces));
    assert!(curve.limit.is_none() && curve.points.len() == wanted.len() + 1);
    for (point, [ratio, moment, contact]) in curve.points[1..].iter().zip(wanted) {
        let found = -point.base_rotation / uplift;
        assert!((found / ratio - 1.0).abs() < 0.02, "{found} {ratio}");
        assert!((1.0 - point.uplifted_fraction - contact).abs() < 0.011, "{point:?}");
        assert!(
            (point.base_moment.abs() / (moment * WEIGHT * 2.5) - 1.0).abs() < 1e-6,
            "{point:?}"
        );
        assert!((point.base_shear - point.force).abs() < 1e-6 * WEIGHT);
        // The base slips by F/k per metre of springs along it, and turns.
        let shear = point.force / (stiffness * 5.0 * (1.0 - point.uplifted_fraction));
        let wanted = shear - 8.0 * point.base_rotation;
        assert!(
            (point.displacement / wanted - 1.0).abs() < 0.02,
            "{} {wanted}",
            point.displacement
        );
    }
}

/// Closed form of the tilted strip: M/(N B) = 1 − 2/3 (θ_u/θ)^½ beyond uplift, at prescribed displacements.
#[test]
fn displacements_are_met_by_their_forces() {
    let stiffness = 3.0e7;
    let uplift = WEIGHT / (2.0 * stiffness * 2.5 * 2.5);
    let targets = vec![0.01, 0.03, 0.1, 0.3];
    let path = PushControl::Displacements { targets: targets.clone(), first_force: 20.0e3 };
    let curve = pushed(100, stiffness, 5.0, 8.0, &path);
    assert_eq!(curve.points.len(), targets.len() + 1);
    for (point, target) in curve.points[1..].iter().zip(targets) {
        assert!((point.displacement - target).abs() < 1.01e-4 * target, "{point:?}");
        let ratio = -point.base_rotation / uplift;
        let moment = if ratio > 1.0 { 1.0 - 2.0 / 3.0 / ratio.sqrt() } else { ratio / 3.0 };
        assert!(
            (point.force * 8.0 / (WEIGHT * 2.5 * moment) - 1.0).abs() < 0.01,
            "{point:?} {ratio}"
        );
    }
    // The other way it is the mirror image.
    let back = PushControl::Displacements { targets: vec![-0.03], first_force: -20.0e3 };
    let mirrored = pushed(100, stiffness, 5.0, 8.0, &back);
    assert!((mirrored.points[1].force / curve.points[2].force + 1.0).abs() < 1e-2);
}

/// The limit is W times the distance of the middle of the last cell, b/2 less half a cell, from the middle.
#[test]
fn the_limits_are_overturning_and_friction() {
    let path = |factor: f64| PushControl::Forces((1..=30).map(|k| factor * f64::from(k)).collect());
    let elements = 50;
    let over = pushed(elements, 3.0e9, 5.0, 8.0, &path(12.0e3));
    let [found, beyond] = over.limit.unwrap();
    let wanted = WEIGHT * (2.5 - 0.5 * 5.0 / elements as f64) / 8.0;
    assert!(found <= wanted * 1.0001 && found > 0.99 * wanted, "{found} {wanted}");
    assert!(beyond >= found && beyond < found * 1.001);
    assert!(over.cause.is_some_and(|cause| cause.contains("overturn")));
    assert!(over.points[over.points.len() - 1].uplifted_fraction > 0.85);
    // Pushed at a tenth of its height it slides.
    let slide = pushed(elements, 3.0e9, 0.3, 0.8, &path(20.0e3));
    let [found, _] = slide.limit.unwrap();
    let wanted = 0.3 * WEIGHT;
    assert!((found / wanted - 1.0).abs() < 1e-3, "{found} {wanted}");
    assert!(slide.cause.is_some_and(|cause| cause.contains("pushes it off")));
    // By displacements the curve ends there, too.
    let far = PushControl::Displacements { targets: vec![1e-4, 50.0], first_force: 1e3 };
    let [found, _] = pushed(elements, 3.0e9, 0.3, 0.8, &far).limit.unwrap();
    assert!((found / wanted - 1.0).abs() < 1e-3, "{found} {wanted}");
}

/// Pushed at half its height, the block slides first at the edge with less pressure.
#[test]
fn sliding_spreads_on_elastic_ground() {
    let block = RigidBlock::new(6.0, 6.0, 2000.0).unwrap();
    let row = block.horizontal_at(3.0);
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    let limit = 0.4 * 72.0e3 * GRAVITY;
    let forces: Vec<f64> = [0.2, 0.4, 0.6, 0.8, 0.95].map(|part| part * limit).to_vec();
    let curve = push_over(&row, &PushControl::Forces(forces), |force| {
        Simulation::builder(0.005)
            .gravity(GRAVITY)
            .ground(ElasticGround::under(soil, &block, 12)?)
            .structure(block.clone())
            .interface(Coulomb::new(0.4)?)
            .load(Load::constant(row.clone(), force))
            .build()
    })
    .unwrap();
    assert_eq!(curve.points.len(), 6);
    let sliding: Vec<f64> = curve.points.iter().map(|point| point.sliding_fraction).collect();
    assert!(
        sliding.windows(2).all(|pair| pair[1] >= pair[0] - 1e-12)
            && sliding[5] > 0.0
            && sliding[5] > sliding[1],
        "{sliding:?}"
    );
}

#[test]
fn wrong_paths_are_refused() {
    let block = RigidBlock::new(5.0, 8.0, 2000.0).unwrap();
    let row = block.horizontal_at(8.0);
    let run = |path: PushControl| {
        push_over(&row, &path, |force| {
            Simulation::builder(0.01)
                .ground(SpringGround::under(&block, 8, 3e7, 3e7)?)
                .structure(block.clone())
                .interface(Coulomb::new(0.5)?)
                .load(Load::constant(block.horizontal_at(8.0), force))
                .build()
        })
    };
    let displacements = |targets: &[f64], first_force| PushControl::Displacements {
        targets: targets.to_vec(),
        first_force,
    };
    assert!(matches!(run(PushControl::Forces(vec![])), Err(Error::Size { .. })));
    for path in [
        PushControl::Forces(vec![f64::NAN]),
        displacements(&[0.1], 0.0),
        displacements(&[0.2, 0.1], 1.0),
        displacements(&[0.1, -0.2], 1.0),
        displacements(&[f64::INFINITY], 1.0),
    ] {
        assert!(matches!(run(path.clone()), Err(Error::Input { .. })), "{path:?}");
    }
    let beyond = basemat::structure::DofCombination::from(99);
    let other = push_over(&beyond, &PushControl::Forces(vec![1.0]), |_| {
        Simulation::builder(0.01)
            .ground(SpringGround::under(&block, 8, 3e7, 3e7)?)
            .structure(block.clone())
            .interface(Coulomb::new(0.5)?)
            .build()
    });
    assert!(matches!(other, Err(Error::Index { .. })));
}
