//! GOAL: static push-over: force against displacement with uplift and sliding, up to the limit.
//! SCENE: rigid blocks on springs without tension, on stiff springs, on slippery ones, on the half-plane; in plan.
//! REFERENCE: the closed form of the Winkler strip and its table; W b/2 on rigid ground; μ W; symmetry.

use basemat::analyses::{PushControl, PushOver, push_over};
use basemat::bem::{ElasticGround, SpringGround};
use basemat::coupled::Load;
use basemat::interface::Coulomb;
use basemat::structure::{DofCombination, RigidBlock};
use basemat::{Error, Result, Simulation, Soil};
use basemat_problems::table;

/// Gravity of the table, m/s².
const TABLE_GRAVITY: f64 = 9.81;
/// Weight of the block on springs, N/m.
const BLOCK_WEIGHT: f64 = 80.0e3 * TABLE_GRAVITY;

/// A block 5 m wide and 8 m high on springs, with the height of the force on it.
struct BlockOnSprings {
    elements: usize,
    stiffness: f64,
    friction: f64,
    force_height: f64,
}

impl BlockOnSprings {
    /// Pushed at its top, with friction that never slips.
    const ROCKING_SCENE: Self =
        Self { elements: 100, stiffness: 3.0e7, friction: 5.0, force_height: 8.0 };
    /// On stiff springs, pushed at its top.
    const OVERTURNING_SCENE: Self =
        Self { elements: 50, stiffness: 3.0e9, friction: 5.0, force_height: 8.0 };
    /// On stiff springs, pushed at a tenth of its height.
    const SLIDING_SCENE: Self =
        Self { elements: 50, stiffness: 3.0e9, friction: 0.3, force_height: 0.8 };

    fn push_over(&self, path: &PushControl) -> PushOver {
        let block = RigidBlock::new(5.0, 8.0, 2000.0).unwrap();
        let row = block.horizontal_at(self.force_height);
        push_over(&row, path, |force| {
            let stiffness = self.stiffness;
            Simulation::builder(0.01)
                .gravity(TABLE_GRAVITY)
                .ground(SpringGround::under(&block, self.elements, stiffness, stiffness)?)
                .structure(block.clone())
                .interface(Coulomb::new(self.friction)?)
                .load(Load::constant(row.clone(), force))
                .build()
        })
        .unwrap()
    }

    /// Rotation at which the base starts to uplift.
    fn uplift_rotation(&self) -> f64 {
        BLOCK_WEIGHT / (2.0 * self.stiffness * 2.5 * 2.5)
    }
}

/// A row of the table of the Winkler strip.
#[derive(Debug, Clone, Copy)]
struct WinklerRow {
    /// Rotation over the rotation at uplift.
    rotation_ratio: f64,
    /// Moment over the weight times half the width.
    moment_ratio: f64,
    contact_fraction: f64,
}

/// At most eight rows of the table whose moments grow by 45 % or more.
fn winkler_rows() -> Vec<WinklerRow> {
    let mut rows: Vec<WinklerRow> = Vec::new();
    for [rotation_ratio, moment_ratio, contact_fraction] in
        table("winkler_static_M_theta.csv").rows(["theta_over_thu", "M_over_NB", "contact_over_2B"])
    {
        let grows = rows.last().is_none_or(|last| moment_ratio > 1.45 * last.moment_ratio);
        if (0.2..6.0).contains(&rotation_ratio) && rows.len() < 8 && grows {
            rows.push(WinklerRow { rotation_ratio, moment_ratio, contact_fraction });
        }
    }
    assert!(rows.len() > 3 && rows.iter().any(|row| row.contact_fraction < 0.8), "{rows:?}");
    rows
}

/// The moments have the rotations of the table; 100 elements err by 1/100.
#[test]
fn a_block_on_springs_without_tension_has_the_winkler_strips_curve() {
    let scene = BlockOnSprings::ROCKING_SCENE;
    let rows = winkler_rows();
    let forces = rows.iter().map(|row| row.moment_ratio * BLOCK_WEIGHT * 2.5 / 8.0).collect();
    let curve = scene.push_over(&PushControl::Forces(forces));
    assert!(curve.limit.is_none() && curve.points.len() == rows.len() + 1);
    for (point, row) in curve.points[1..].iter().zip(rows) {
        let rotation_ratio = -point.base_rotation / scene.uplift_rotation();
        assert!((rotation_ratio / row.rotation_ratio - 1.0).abs() < 0.02, "{point:?} {row:?}");
        let contact_fraction = 1.0 - point.uplifted_fraction;
        assert!((contact_fraction - row.contact_fraction).abs() < 0.011, "{point:?}");
        let moment = row.moment_ratio * BLOCK_WEIGHT * 2.5;
        assert!((point.base_moment.abs() / moment - 1.0).abs() < 1e-6, "{point:?}");
        assert!((point.base_shear - point.force).abs() < 1e-6 * BLOCK_WEIGHT);
        // The base slips by F/k per metre of closed springs, and turns.
        let slip = point.force / (scene.stiffness * 5.0 * (1.0 - point.uplifted_fraction));
        let expected = slip - 8.0 * point.base_rotation;
        let displacement = point.displacement;
        assert!((displacement / expected - 1.0).abs() < 0.02, "{displacement} {expected}");
    }
}

/// Prescribed displacements follow the tilted strip: M/(N B) = 1 − 2/3 (θ_u/θ)^½ beyond uplift.
#[test]
fn displacements_are_met_by_their_forces() {
    let scene = BlockOnSprings::ROCKING_SCENE;
    let targets = vec![0.01, 0.03, 0.1, 0.3];
    let path = PushControl::Displacements { targets: targets.clone(), first_force: 20.0e3 };
    let curve = scene.push_over(&path);
    assert_eq!(curve.points.len(), targets.len() + 1);
    for (point, target) in curve.points[1..].iter().zip(targets) {
        assert!((point.displacement - target).abs() < 1.01e-4 * target, "{point:?}");
        let ratio = -point.base_rotation / scene.uplift_rotation();
        let moment_ratio = if ratio > 1.0 { 1.0 - 2.0 / 3.0 / ratio.sqrt() } else { ratio / 3.0 };
        let expected = BLOCK_WEIGHT * 2.5 * moment_ratio;
        assert!((point.force * 8.0 / expected - 1.0).abs() < 0.01, "{point:?} {ratio}");
    }
    // The curve of pushing to the left is the mirror image.
    let to_the_left = PushControl::Displacements { targets: vec![-0.03], first_force: -20.0e3 };
    let mirrored_curve = scene.push_over(&to_the_left);
    assert!((mirrored_curve.points[1].force / curve.points[2].force + 1.0).abs() < 1e-2);
}

/// Thirty forces that grow by `increment`.
fn growing_forces(increment: f64) -> PushControl {
    PushControl::Forces((1..=30).map(|k| increment * f64::from(k)).collect())
}

/// Overturning needs W times the distance of the outer element from the middle, half an element less than b/2.
#[test]
fn the_limits_are_overturning_and_friction() {
    let scene = BlockOnSprings::OVERTURNING_SCENE;
    let curve = scene.push_over(&growing_forces(12.0e3));
    let [limit, force_beyond_limit] = curve.limit.unwrap();
    let expected = BLOCK_WEIGHT * (2.5 - 0.5 * 5.0 / scene.elements as f64) / 8.0;
    assert!(limit <= expected * 1.0001 && limit > 0.99 * expected, "{limit} {expected}");
    assert!(force_beyond_limit >= limit && force_beyond_limit < limit * 1.001);
    assert!(curve.cause.is_some_and(|cause| cause.contains("overturn")));
    assert!(curve.points[curve.points.len() - 1].uplifted_fraction > 0.85);

    let curve = BlockOnSprings::SLIDING_SCENE.push_over(&growing_forces(20.0e3));
    let limit = curve.limit.unwrap()[0];
    let expected = 0.3 * BLOCK_WEIGHT;
    assert!((limit / expected - 1.0).abs() < 1e-3, "{limit} {expected}");
    assert!(curve.cause.is_some_and(|cause| cause.contains("pushes it off")));
    // A curve by displacements ends at the same force.
    let displacement_control =
        PushControl::Displacements { targets: vec![1e-4, 50.0], first_force: 1e3 };
    let limit = BlockOnSprings::SLIDING_SCENE.push_over(&displacement_control).limit.unwrap()[0];
    assert!((limit / expected - 1.0).abs() < 1e-3, "{limit} {expected}");
}

/// Pushed at half its height, the block slides first at the edge with less pressure.
#[test]
fn sliding_spreads_on_elastic_ground() {
    let block = RigidBlock::new(6.0, 6.0, 2000.0).unwrap();
    let row = block.horizontal_at(3.0);
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    let limit = 0.4 * 72.0e3 * TABLE_GRAVITY;
    let forces: Vec<f64> = [0.2, 0.4, 0.6, 0.8, 0.95].map(|ratio| ratio * limit).to_vec();
    let curve = push_over(&row, &PushControl::Forces(forces), |force| {
        Simulation::builder(0.005)
            .gravity(TABLE_GRAVITY)
            .ground(ElasticGround::under(soil, &block, 12)?)
            .structure(block.clone())
            .interface(Coulomb::new(0.4)?)
            .load(Load::constant(row.clone(), force))
            .build()
    })
    .unwrap();
    assert_eq!(curve.points.len(), 6);
    let sliding: Vec<f64> = curve.points.iter().map(|point| point.sliding_fraction).collect();
    assert!(sliding.windows(2).all(|pair| pair[1] >= pair[0] - 1e-12), "{sliding:?}");
    assert!(sliding[5] > 0.0 && sliding[5] > sliding[1], "{sliding:?}");
}

/// Displacements of the top, from a first force.
fn displacements(targets: &[f64], first_force: f64) -> PushControl {
    PushControl::Displacements { targets: targets.to_vec(), first_force }
}

/// The block on eight springs under a force at its top.
fn coarse_scene(force: f64) -> Result<Simulation> {
    let block = RigidBlock::new(5.0, 8.0, 2000.0).unwrap();
    Simulation::builder(0.01)
        .ground(SpringGround::under(&block, 8, 3e7, 3e7)?)
        .load(Load::constant(block.horizontal_at(8.0), force))
        .structure(block)
        .interface(Coulomb::new(0.5)?)
        .build()
}

#[test]
fn wrong_paths_are_errors() {
    let top = RigidBlock::new(5.0, 8.0, 2000.0).unwrap().horizontal_at(8.0);
    let no_forces = push_over(&top, &PushControl::Forces(vec![]), coarse_scene);
    assert!(matches!(no_forces, Err(Error::Size { .. })));
    for path in [
        PushControl::Forces(vec![f64::NAN]),
        displacements(&[0.1], 0.0),
        displacements(&[0.2, 0.1], 1.0),
        displacements(&[0.1, -0.2], 1.0),
        displacements(&[f64::INFINITY], 1.0),
    ] {
        let result = push_over(&top, &path, coarse_scene);
        assert!(matches!(result, Err(Error::Input { .. })), "{path:?}");
    }
    let unknown_dof = DofCombination::from(99);
    let result = push_over(&unknown_dof, &PushControl::Forces(vec![1.0]), |_| coarse_scene(0.0));
    assert!(matches!(result, Err(Error::Index { .. })));
}
