//! GOAL: static stiffnesses of rigid mats with oblique outlines fall steadily to the true ones as cells become smaller.
//! SCENE: discs, squares at several angles, a hexagon, an octagon, an L and its copy at an angle, relaxed on a
//! half-space. `OUTLINE_CELLS=32` takes all numbers of cells from 4 to 32.
//! REFERENCE: closed forms of the disc; the capacity of a square; Galerkin sums over triangles, which fit each outline
//! (`tests/data/plan/static_outlines.py`).

use basemat::bem::layered::StripContact;
use basemat::bem::plan::{Plan, impedances_in_plan};
use basemat::soil::SoilProfile;
use basemat::{Result, Soil, unobserved};

/// Corners of a regular polygon; the first at an angle of `turn` degrees.
fn polygon(corners: usize, reach: f64, turn: f64) -> Vec<[f64; 2]> {
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / corners as f64 + turn.to_radians();
    (0..corners).map(|k| [reach * angle(k).cos(), reach * angle(k).sin()]).collect()
}

fn square(turn: f64) -> Vec<Vec<[f64; 2]>> {
    vec![polygon(4, f64::sqrt(2.0), 45.0 + turn)]
}

fn ell(turn: f64) -> Vec<Vec<[f64; 2]>> {
    let (sin, cos) = turn.to_radians().sin_cos();
    let long = [[-1.0, -1.0], [1.0, -1.0], [1.0, 0.0], [-1.0, 0.0]];
    let short = [[-1.0, 0.0], [0.1, 0.0], [0.1, 1.0], [-1.0, 1.0]];
    let turned = |face: [[f64; 2]; 4]| face.map(|[x, y]| [cos * x - sin * y, sin * x + cos * y]);
    [long, short].map(|face| turned(face).to_vec()).to_vec()
}

/// Vertical and rocking stiffness, times (1 − ν)/G.
fn stiffness(plan: Result<Plan>) -> [f64; 2] {
    let profile = SoilProfile::from(Soil::new(1.0, 0.3, 1.0).unwrap());
    let plan = plan.unwrap();
    assert!(plan.area_error().abs() < 1e-9);
    let contact = StripContact::Relaxed;
    let found = impedances_in_plan(&profile, &plan, &[0.0], contact, &mut unobserved).unwrap();
    [2, 3].map(|axis| found[0].matrix[axis][axis].re * 0.7)
}

/// Name, faces (none for a disc), and vertical and rocking stiffness.
type Shape = (&'static str, Option<Vec<Vec<[f64; 2]>>>, [f64; 2]);

#[test]
fn static_stiffnesses_of_oblique_outlines_fall_steadily() {
    let most = std::env::var("OUTLINE_CELLS").ok().and_then(|text| text.parse().ok());
    let counts: Vec<usize> = match most {
        Some(most) => (4..=most).collect(),
        None => vec![4, 6, 8, 12, 16],
    };
    // Polygons and the L: tests/data/plan/static_outlines.py.
    let shapes: [Shape; 9] = [
        ("disc", None, [4.0, 8.0 / 3.0]),
        ("square at 10 degrees", Some(square(10.0)), [4.6092, 4.1585]),
        ("square at 22.5 degrees", Some(square(22.5)), [4.6092, 4.1585]),
        ("square at 30 degrees", Some(square(30.0)), [4.6092, 4.1585]),
        ("square at 45 degrees", Some(square(45.0)), [4.6092, 4.1585]),
        ("hexagon", Some(vec![polygon(6, 1.0, 0.0)]), [3.6582, 2.0465]),
        ("octagon", Some(vec![polygon(8, 1.0, 0.0)]), [3.8042, 2.2965]),
        ("L", Some(ell(0.0)), [4.1850, 3.3727]),
        ("L at 20 degrees", Some(ell(20.0)), [4.1850, f64::INFINITY]),
    ];
    for (name, faces, exact) in shapes {
        let found: Vec<_> = counts
            .iter()
            .map(|cells| {
                let plan = match &faces {
                    Some(faces) => Plan::on_faces(faces, *cells),
                    None => Plan::disc([0.3, -0.1], 1.0, *cells),
                };
                let found = stiffness(plan);
                let [vertical, rocking] = [0, 1].map(|k| 100.0 * (found[k] / exact[k] - 1.0));
                [vertical, rocking]
            })
            .collect();
        println!("{name}: {found:.2?} %");
        for (pair, cells) in found.windows(2).zip(&counts) {
            // Vertical errors fall, rocking errors rise from below.
            assert!(pair[1][0] < pair[0][0] + 0.06, "{name} {cells}: {pair:?}");
            assert!(pair[1][1] > pair[0][1] - 0.1, "{name} {cells}: {pair:?}");
        }
        let at = counts.iter().position(|cells| *cells == 16).unwrap();
        let [vertical, rocking] = found[at];
        assert!(vertical.abs() < 0.4, "{name} {vertical}");
        let most = if name == "disc" { 1.2 } else { 1.7 };
        assert!(exact[1].is_infinite() || rocking.abs() < most, "{name} {rocking}");
    }
}
