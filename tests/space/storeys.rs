//! Buildings in plan: eccentric floors by closed forms, and a slice beside the plane's building.

use std::f64::consts::TAU;

use basemat::bem::SpringGround;
use basemat::coupled::{Probe, State};
use basemat::interface::Bonded;
use basemat::motion::{FreeField, Triaxial, el_centro_1940};
use basemat::structure::{
    Bilinear, DofCombination, ModalDamping, PlanStorey, RigidBody, ShearBuilding, Storey,
    StoreyBuilding, Structure, StructureError, Triplets,
};
use basemat::{Error, Simulation};

use super::cells::{BED, Cells, Waves};

fn dense(fill: impl Fn(&mut Triplets), order: usize) -> Vec<Vec<f64>> {
    let mut matrix = Triplets::new(order);
    fill(&mut matrix);
    let mut dense = vec![vec![0.0; order]; order];
    matrix.entries().iter().for_each(|&(i, j, value)| dense[i][j] += value);
    dense
}

fn product(matrix: &[Vec<f64>], vector: &[f64]) -> Vec<f64> {
    matrix.iter().map(|row| row.iter().zip(vector).map(|(a, x)| a * x).sum()).collect()
}

/// ω² of an eccentric storey: ½ (A + B) ± √(¼ (A − B)² + A B'), Chopra, Dynamics of Structures, § 9.6.
#[test]
fn an_eccentric_storey_couples_sway_and_twist() {
    let (mass, [length, width], eccentricity) = (3.0e5, [16.0, 10.0], 2.5);
    let stiffness = [5.0e8, 3.0e8, 1.5e10];
    let polar = mass * (length * length + width * width) / 12.0;
    for (across, mass_center, stiffness_center) in [
        (1, [0.0; 2], [eccentricity, 0.0]),
        (1, [1.0 - eccentricity, 3.0], [1.0, 3.0]),
        (0, [0.0; 2], [0.0, -eccentricity]),
    ] {
        let storey = PlanStorey::new(4.0, mass, [length, width], stiffness);
        let storey = PlanStorey { mass_center, stiffness_center, ..storey };
        let mat = RigidBody::cuboid([length, width, 1.0], 2500.0).unwrap();
        let building = StoreyBuilding::new(mat, &[storey]).unwrap();
        let damped = ModalDamping::new(&[0.05]).unwrap().on_fixed_base(building).unwrap();
        let sway = stiffness[across] / mass;
        let twist = (stiffness[2] + stiffness[across] * eccentricity.powi(2)) / polar;
        let coupling = stiffness[across] * eccentricity;
        let root = (0.25 * (sway - twist).powi(2) + coupling * coupling / (mass * polar)).sqrt();
        let middle = 0.5 * (sway + twist);
        let mut exact = [middle - root, middle + root, stiffness[1 - across] / mass]
            .map(|square: f64| square.sqrt() / TAU);
        exact.sort_by(f64::total_cmp);
        assert_eq!(damped.frequencies().len(), 3, "{:?}", damped.frequencies());
        for (found, exact) in damped.frequencies().iter().zip(exact) {
            assert!((found / exact - 1.0).abs() < 1e-5, "{found} {exact}");
        }
    }
}

const MAT: [f64; 3] = [12.0, 9.0, 1.0];
const HEIGHTS: [f64; 3] = [4.0, 3.0, 3.5];

/// Three storeys, eccentric both ways, turned by quarters about the vertical axis; the lowest one may yield.
fn building(quarters: usize, yields: bool) -> StoreyBuilding {
    let turned = |[x, y]: [f64; 2]| (0..quarters).fold([x, y], |[x, y], _| [-y, x]);
    let odd = quarters % 2 == 1;
    let swapped = |[x, y]: [f64; 2]| if odd { [y, x] } else { [x, y] };
    let storeys: Vec<_> = (0..3)
        .map(|k| {
            let scale = 1.0 - 0.2 * k as f64;
            let [along, across] = swapped([2.4e8 * scale, 1.6e8 * scale]);
            let storey = PlanStorey::new(
                HEIGHTS[k],
                1.5e5 * scale,
                swapped([MAT[0], MAT[1]]),
                [along, across, 4.0e9 * scale],
            );
            let [cx, cy] = swapped([3.0e5, 4.0e5]);
            PlanStorey {
                mass_center: turned([0.6, -0.4 * k as f64]),
                stiffness_center: turned([-0.8 * k as f64, 0.5]),
                damping: [cx, cy, 5.0e6],
                ..storey
            }
        })
        .collect();
    let sides = swapped([MAT[0], MAT[1]]);
    let mat = RigidBody::cuboid([sides[0], sides[1], MAT[2]], 2400.0).unwrap();
    let built = StoreyBuilding::new(mat, &storeys).unwrap().with_p_delta(9.81).unwrap();
    if !yields {
        return built;
    }
    let law = |k: usize| Bilinear::new([2.4e8, 1.6e8, 4.0e9][k], [1.0e5, 1.0e5, 4.0e5][k], 0.1);
    let [x, y] = if odd { [1, 0] } else { [0, 1] };
    let built = built.with_law(0, StoreyBuilding::ALONG, law(x).unwrap()).unwrap();
    let built = built.with_law(0, StoreyBuilding::ACROSS, law(y).unwrap()).unwrap();
    built.with_law(0, StoreyBuilding::TWIST, law(2).unwrap()).unwrap()
}

/// Rigid motions: no force without P–Δ, and the inertia of the whole as one body.
#[test]
fn rigid_motions_strain_nothing_and_move_all_masses() {
    let with = building(0, false);
    let without = with.clone().with_p_delta(0.0).unwrap();
    let n = without.dofs();
    let [stiffness, damping, mass] = [
        dense(|m| without.stiffness(m).unwrap(), n),
        dense(|m| without.damping(m).unwrap(), n),
        dense(|m| without.mass(m).unwrap(), n),
    ];
    let motions: Vec<Vec<f64>> = (0..6)
        .map(|k| {
            let mut u = vec![0.0; n];
            u[k] = 1.0;
            let mut height = 0.0;
            for storey in 0..3 {
                height += HEIGHTS[storey];
                u[6 + 3 * storey] = u[0] + height * u[4];
                u[7 + 3 * storey] = u[1] - height * u[3];
                u[8 + 3 * storey] = u[5];
            }
            u
        })
        .collect();
    // Any motion: the total drift is the sum of the storeys' drifts.
    let u: Vec<f64> = (0..n).map(|k| (1.3 * k as f64).cos()).collect();
    let total = without.total_drift(2, [1.5, -2.5]).unwrap();
    for (k, row) in total.iter().enumerate() {
        let own = |storey| without.drift_at(storey, [1.5, -2.5]).unwrap()[k].value(&u);
        assert!((row.value(&u) - (0..3).map(own).sum::<f64>()).abs() < 1e-13);
    }
    for motion in &motions {
        for row in &total {
            assert!(row.value(motion).abs() < 1e-13);
        }
        for matrix in [&stiffness, &damping] {
            let force = product(matrix, motion);
            assert!(force.iter().all(|f| f.abs() < 1e-12 * 1e11), "{force:?}");
        }
    }
    // Points (mass, place) that have the mass, its centre and its moments of inertia: six on the axes of each body.
    let mut points = Vec::new();
    let mut add = |mass: f64, [x, y, z]: [f64; 3], [jx, jy, jz]: [f64; 3]| {
        for (k, j) in [jy + jz - jx, jx + jz - jy, jx + jy - jz].into_iter().enumerate() {
            // Two of m/6 at ± r: 2 (m/6) r² = j/2.
            let r = (1.5 * j / mass).sqrt();
            for sign in [-r, r] {
                let mut place = [x, y, z];
                place[k] += sign;
                points.push((mass / 6.0, place));
            }
        }
    };
    let m = MAT.iter().product::<f64>() * 2400.0;
    let [l, b, h] = MAT;
    let own = [b * b + h * h, l * l + h * h, l * l + b * b].map(|square| m * square / 12.0);
    add(m, [0.0, 0.0, 0.5 * h], own);
    let mut height = 0.0;
    for k in 0..3 {
        height += HEIGHTS[k];
        let m = 1.5e5 * (1.0 - 0.2 * k as f64);
        let own = [b * b, l * l, l * l + b * b].map(|square| m * square / 12.0);
        add(m, [0.6, -0.4 * k as f64, height], own);
    }
    for (i, a) in motions.iter().enumerate() {
        let momentum = product(&mass, a);
        for (j, b) in motions.iter().enumerate() {
            let found: f64 = momentum.iter().zip(b).map(|(p, v)| p * v).sum();
            let at = |w: usize, [x, y, z]: [f64; 3]| match w {
                3 => [0.0, -z, y],
                4 => [z, 0.0, -x],
                5 => [-y, x, 0.0],
                w => std::array::from_fn(|k| f64::from(u8::from(k == w))),
            };
            let exact: f64 = points
                .iter()
                .map(|(m, place)| {
                    let [a, b] = [at(i, *place), at(j, *place)];
                    m * (0..3).map(|k| a[k] * b[k]).sum::<f64>()
                })
                .sum();
            assert!((found - exact).abs() < 1e-12 * 1e9, "{i} {j}: {found} {exact}");
        }
    }
}

pub(crate) fn march(
    structure: impl Structure + 'static,
    ground: Cells,
    motion: impl FreeField + 'static,
    steps: usize,
) -> Simulation {
    let mut simulation = Simulation::builder(4e-3)
        .structure(structure)
        .ground(ground)
        .interface(Bonded)
        .motion(motion)
        .build()
        .unwrap();
    let run = simulation.run(steps, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    simulation
}

/// The weight of point masses that have a floor's mass and polar inertia, lowered by the sway below them.
#[test]
fn weights_go_down_with_the_sway_of_all_storeys_below() {
    let n = building(0, false).dofs();
    let of = |gravity: f64| {
        let own = building(0, false).with_p_delta(gravity).unwrap();
        dense(|m| own.stiffness(m).unwrap(), n)
    };
    let u: Vec<f64> = (0..n).map(|k| (1.7 * k as f64).sin()).collect();
    let [with, without] = [of(9.81), of(0.0)]
        .map(|matrix| product(&matrix, &u).iter().zip(&u).map(|(f, u)| f * u).sum::<f64>());
    let level = |k: usize| {
        if k == 0 { [u[0], u[1], u[5]] } else { [u[3 * k + 3], u[3 * k + 4], u[3 * k + 5]] }
    };
    let mut exact = 0.0;
    for floor in 0..3 {
        let m = 1.5e5 * (1.0 - 0.2 * floor as f64);
        let radius = ((MAT[0].powi(2) + MAT[1].powi(2)) / 12.0).sqrt();
        for [dx, dy] in [[radius, 0.0], [-radius, 0.0], [0.0, radius], [0.0, -radius]] {
            let [x, y] = [0.6 + dx, -0.4 * floor as f64 + dy];
            for storey in 0..=floor {
                let [below, above] = [level(storey), level(storey + 1)];
                let [a, b, twist] = [0, 1, 2].map(|k| above[k] - below[k]);
                let square = (a - y * twist).powi(2) + (b + x * twist).powi(2);
                exact -= 9.81 * 0.25 * m * square / HEIGHTS[storey];
            }
        }
    }
    assert!((with - without - exact).abs() < 1e-9 * without, "{with} {without} {exact}");
    assert!(exact.abs() > 1e-4 * without);
}

/// A slice one metre deep that moves along x, or along y, is the building of the plane: P–Δ, dashpots, a storey that
/// yields.
#[test]
fn a_slice_is_the_building_of_the_plane() {
    let (steps, record) = (500, el_centro_1940().scaled(0.5).unwrap());
    let law = || Bilinear::new(4.0e7, 3.0e4, 0.1).unwrap();
    let mut storeys = [Storey::new(3.0, 2.0e4, 4.0e7); 3];
    for own in &mut storeys {
        (own.rotary_inertia, own.damping) = (1.0e5, 2.0e4);
    }
    let (base, inertia) = (6.0e4, 4.0e5);
    let plane = ShearBuilding::new(8.0, base, inertia, &storeys)
        .and_then(|own| own.with_p_delta(9.81)?.with_law(0, law()))
        .unwrap();
    let mut plane = Simulation::builder(4e-3)
        .structure(plane)
        .ground(SpringGround::new(-4.0..4.0, 8, 3e7, 2e7).unwrap().with_dashpots(6e5, 3e5).unwrap())
        .interface(Bonded)
        .motion(record.clone())
        .build()
        .unwrap();
    plane.run(steps, |_| {}).unwrap();
    let plane = plane.state();
    // Along x and about −y, along y and about x.
    for direction in [0, 1] {
        let slice = |[along, across]: [f64; 2]| {
            if direction == 0 { [along, across] } else { [across, along] }
        };
        let [x, y] = slice([4.0, 0.5]);
        let outline = vec![[-x, -y], [x, -y], [x, y], [-x, y]];
        let tensor = [[inertia, 0.0, 0.0], [0.0, inertia, 0.0], [0.0, 0.0, inertia]];
        let mat = RigidBody::from_mass(outline, base, tensor, [0.0; 3]).unwrap();
        let storey = PlanStorey {
            inertia: [1.0e5; 3],
            damping: [2.0e4; 3],
            ..PlanStorey::new(3.0, 2.0e4, [1.0; 2], [4.0e7, 4.0e7, 1.0e8])
        };
        let building = StoreyBuilding::new(mat, &[storey; 3])
            .and_then(|own| own.with_p_delta(9.81)?.with_law(0, direction, law()))
            .unwrap();
        let lines: Vec<f64> = (0..=8).map(|k| f64::from(k) - 4.0).collect();
        let deep = [-0.5, 0.5];
        let bed = super::cells::Bed { stiffness: [3e7, 2e7, 2e7], dashpot: [6e5, 3e5, 3e5] };
        let (ground, motion) = if direction == 0 {
            let x = Some(record.clone());
            (Cells::between(&lines, &deep, bed), Triaxial { x, ..Triaxial::default() })
        } else {
            let y = Some(record.clone());
            (Cells::between(&deep, &lines, bed), Triaxial { y, ..Triaxial::default() })
        };
        let space = march(building, ground, motion, steps);
        let [u, v] = [plane.displacement(), space.state().displacement()];
        let rotation = [-v[4], v[3]][direction];
        let pairs = [(u[0], v[direction]), (u[2], rotation)];
        let floors = (0..3).map(|k| (u[3 + k], v[6 + 3 * k + direction]));
        for (plane, space) in pairs.into_iter().chain(floors) {
            assert!(
                plane.abs() > 1e-6 && (plane - space).abs() < 1e-9 * plane.abs(),
                "{plane} {space}"
            );
        }
        let hysteresis = [plane, space.state()].map(|state| state.energy_balance.hysteresis);
        assert!(hysteresis[0] > 0.0 && (hysteresis[1] / hysteresis[0] - 1.0).abs() < 1e-9);
    }
}

/// A building that is turned by 90 degrees with its scene turns its displacements; torsion and yielding in both
/// directions are in it.
#[test]
fn a_turned_building_turns_its_displacements() {
    let scene = |quarters: usize| {
        let sides = if quarters % 2 == 1 { [MAT[1], MAT[0]] } else { [MAT[0], MAT[1]] };
        let counts = if quarters % 2 == 1 { [3, 4] } else { [4, 3] };
        let mut bed = BED;
        if quarters % 2 == 1 {
            bed.stiffness.swap(1, 2);
            bed.dashpot.swap(1, 2);
        }
        let ground = Cells::under(sides, [0.0; 2], counts, bed);
        march(building(quarters, true), ground, Waves { quarters }, 300)
    };
    let straight = scene(0);
    assert!(straight.state().energy_balance.hysteresis > 0.0);
    let u = straight.state().displacement();
    assert!(u.iter().all(|u| u.abs() > 1e-8), "{u:?}");
    for quarters in 1..4 {
        let mut expected = u.to_vec();
        for _ in 0..quarters {
            for first in [0, 3, 6, 9, 12] {
                (expected[first], expected[first + 1]) = (-expected[first + 1], expected[first]);
            }
        }
        let turned = scene(quarters);
        for (found, exact) in turned.state().displacement().iter().zip(&expected) {
            assert!((found - exact).abs() < 1e-11, "{quarters}: {found} {exact}");
        }
    }
}

/// Storey forces by inertia against stiffness times drift and dashpots in linear storeys, in the middle of a step.
#[test]
fn storey_forces_are_those_of_their_columns() {
    let own = building(0, false).with_p_delta(0.0).unwrap();
    let ground = Cells::under([MAT[0], MAT[1]], [0.0; 2], [4, 3], BED);
    let mut simulation = march(own.clone(), ground, Waves { quarters: 0 }, 200);
    let before = simulation.state().clone();
    let state = simulation.step().unwrap();
    let mean = |row: &DofCombination, of: fn(&State) -> &[f64]| {
        0.5 * (row.value(of(&before)) + row.value(of(state)))
    };
    for storey in 0..3 {
        let scale = 1.0 - 0.2 * storey as f64;
        let stiffness = [2.4e8, 1.6e8, 4.0e9].map(|k| scale * k);
        let drifts = own.drift(storey).unwrap();
        for (k, rows) in own.shear(storey).unwrap().iter().enumerate() {
            let found = rows.value(&[], &[], state.acceleration());
            let exact = stiffness[k] * mean(&drifts[k], State::displacement)
                + [3.0e5, 4.0e5, 5.0e6][k] * mean(&drifts[k], State::velocity);
            assert!(exact.abs() > 1e2 && (found / exact - 1.0).abs() < 1e-7, "{found} {exact}");
            assert_eq!(Probe::section("cut", rows).unit, ["N", "N", "N·m"][k]);
        }
    }
}

#[test]
fn buildings_that_are_none() {
    let mat = || RigidBody::cuboid(MAT, 2400.0).unwrap();
    let storey = PlanStorey::new(3.0, 1e5, [9.0; 2], [2e8, 3e8, 4e9]);
    assert!(matches!(StoreyBuilding::new(mat(), &[]), Err(Error::Size { found: 0, .. })));
    for wrong in [
        PlanStorey { height: 0.0, ..storey },
        PlanStorey { stiffness: [2e8, f64::NAN, 4e9], ..storey },
        PlanStorey { stiffness: [2e8, 3e8, 0.0], ..storey },
        PlanStorey { inertia: [0.0; 3], ..storey },
        PlanStorey { damping: [0.0, -1.0, 0.0], ..storey },
        PlanStorey { mass_center: [f64::INFINITY, 0.0], ..storey },
    ] {
        assert!(matches!(StoreyBuilding::new(mat(), &[wrong]), Err(Error::Input { .. })));
    }
    let own = StoreyBuilding::new(mat(), &[storey]).unwrap();
    let law = || Bilinear::new(1e8, 1e5, 0.1).unwrap();
    assert!(matches!(own.drift(1), Err(Error::Index { index: 1, bound: 1, .. })));
    assert!(matches!(own.clone().with_law(0, 3, law()), Err(Error::Index { index: 3, .. })));
    let own = own.with_law(0, 1, law()).unwrap();
    assert!(matches!(own.clone().with_law(0, 1, law()), Err(Error::Scene { .. })));
    assert_eq!(own.describe(&[4, 8]).unwrap(), "r_y of the rigid body, r_z of floor 0");
    // 100 t on columns of 2e5 N/m: they buckle under W/h.
    let weak = PlanStorey { stiffness: [2e5, 3e8, 4e9], ..storey };
    let weak = StoreyBuilding::new(mat(), &[weak]).unwrap().with_p_delta(9.81).unwrap();
    let ground = Cells::under([MAT[0], MAT[1]], [0.0; 2], [4, 3], BED);
    let built = Simulation::builder(0.01).structure(weak).ground(ground).interface(Bonded).build();
    let Err(Error::Structure(StructureError::Buckling { factor })) = built else {
        panic!("{:?}", built.err())
    };
    let exact = 2e5 * 3.0 / (1e5 * 9.81);
    assert!((factor / exact - 1.0).abs() < 1e-5, "{factor} {exact}");
}
