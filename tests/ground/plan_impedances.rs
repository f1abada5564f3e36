//! GOAL: stiffnesses of rigid mats in plan are right up to the cells.
//! SCENE: rectangles and discs on half-space and layer, welded and relaxed, statics and up to ωb/c = 2.
//! REFERENCE: tables of other programs (one spectral, for the disc), a closed form, the strip in its plane.

use std::f64::consts::TAU;

use basemat::bem::layered::StripContact;
use basemat::bem::plan::{Plan, PlanImpedance, impedances_in_plan};
use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::soil::{Hysteretic, SoilProfile};
use basemat::{Complex, Soil, unobserved};

use basemat_problems::profiles::p1;

fn half_space(poisson: f64) -> SoilProfile {
    SoilProfile::on_half_plane(Soil::new(1.0, poisson, 1.0).unwrap())
}

fn at(profile: &SoilProfile, plan: &Plan, a0: f64, contact: StripContact) -> PlanImpedance {
    impedances_in_plan(profile, plan, &[a0 / TAU], contact, &mut unobserved).unwrap()[0]
}

/// The component of a table. Its w = x Ry is down, so ry equals the crate's; Rx and Hy alike.
fn component(found: &PlanImpedance, name: &str) -> Complex {
    let [row, column] = match name {
        "V" => [2, 2],
        "Hx" => [0, 0],
        "Hy" => [1, 1],
        "Rx" | "R" => [3, 3],
        "Ry" => [4, 4],
        "T" => [5, 5],
        "HxRy" => [0, 4],
        _ => panic!("{name}"),
    };
    found.matrix[row][column]
}

fn contact(name: &str) -> StripContact {
    if name == "welded" { StripContact::Bonded } else { StripContact::Relaxed }
}

fn rows(table: &'static str) -> Vec<Vec<&'static str>> {
    table.lines().skip(2).map(|line| line.split(',').collect()).collect()
}

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

/// Largest errors of static rectangles against the table: of translations and torsion, of rocking with ν = 0, of
/// rocking of squares and of others, of all with sides 1 : 4, whose values in the table are of coarser cells.
fn worst_of_static_rectangles(longest: f64, plan: impl Fn(f64) -> Plan) -> [f64; 5] {
    let rows = rows(include_str!("../data/plan/static_rectangle.csv"));
    let mut worst = [0.0_f64; 5];
    for group in rows.chunk_by(|a, b| a[..2] == b[..2]) {
        let (length, poisson) = (number(group[0][0]), number(group[0][1]));
        if length > longest {
            continue;
        }
        let profile = half_space(if poisson == 0.3333 { 1.0 / 3.0 } else { poisson });
        let found = [StripContact::Bonded, StripContact::Relaxed]
            .map(|contact| at(&profile, &plan(length), 0.0, contact));
        for row in group {
            for (found, wanted) in found.iter().zip(&row[3..]) {
                let error = (component(found, row[2]).re / number(wanted) - 1.0).abs();
                let place = match (length, poisson, row[2].starts_with('R')) {
                    (4.0, ..) => 4,
                    (_, _, false) => 0,
                    (_, 0.0, _) => 1,
                    (1.0, ..) => 2,
                    _ => 3,
                };
                worst[place] = worst[place].max(error);
            }
        }
    }
    println!("{worst:.5?} (translations, rocking of ν = 0, squares, others, L/b = 4)");
    worst
}

fn rectangle(length: f64, cells: usize) -> Plan {
    Plan::rectangle(-length..length, -1.0..1.0, cells).unwrap()
}

#[test]
fn static_rectangles_match_the_table() {
    // Rocking about the longer axis is worst, and the more so the smaller ν is: shear at welded edges oscillates. Extrapolated
    // values of the table are low themselves, by 0.04 % (ν = 1/3) to 0.11 % (ν = 0) of the square's rocking, as 48 cells
    // tell.
    let all =
        [(8, [4e-3, 1.13e-2, 4.5e-3, 7e-3, 1.1e-2]), (12, [2.5e-3, 6e-3, 2.5e-3, 3.3e-3, 5e-3])];
    for (cells, gates) in all {
        let worst = worst_of_static_rectangles(4.0, |length| rectangle(length, cells));
        assert!(worst.iter().zip(gates).all(|(worst, gate)| *worst < gate), "{worst:?}");
    }
}

/// The same elements of a square by another program: static compliances of the cells in closed form, summed over elements.
#[test]
fn static_graded_elements_are_those_of_another_program() {
    let graded = [1, 2, 2, 3, 3, 2, 2, 1];
    let plan = rectangle(1.0, 16).with_unions(&graded, &graded).unwrap();
    let found = at(&half_space(0.25), &plan, 0.0, StripContact::Bonded);
    let wanted = [
        ("V", 6.377_488_707_3),
        ("Hx", 5.358_107_421_5),
        ("Ry", 5.887_225_947_6),
        ("T", 8.515_075_039_9),
    ];
    for (name, wanted) in wanted {
        let found = component(&found, name).re;
        assert!((found / wanted - 1.0).abs() < 1e-8, "{name} {found} {wanted}");
    }
}

/// Elements of a lattice twice as fine, graded, as many along the shorter side, halve the largest errors.
#[test]
fn static_rectangles_of_graded_elements_match_the_table() {
    let all = [
        (4.0, 16, vec![2, 2, 3, 3, 2, 2], [4e-3, 1.1e-2, 4e-3, 4e-3, 1e-2]),
        (2.0, 24, vec![2, 2, 2, 2, 3, 3, 2, 2, 2, 2], [2.5e-3, 6e-3, 2.5e-3, 2.5e-3, 0.0]),
    ];
    for (longest, cells, inner, gates) in all {
        let across = [&[1][..], &inner, &[1]].concat();
        let worst = worst_of_static_rectangles(longest, |length| {
            let plan = rectangle(length, cells);
            let more = plan.count() / cells - cells;
            let (front, back) = across.split_at(across.len() / 2);
            let along = [front, &vec![2; more / 2], &vec![1; more % 2], back].concat();
            plan.with_unions(&along, &across).unwrap()
        });
        assert!(worst.iter().zip(gates).all(|(worst, gate)| *worst <= gate), "{worst:?}");
    }
}

/// A square punch without friction: 4.6092 μb/(1 − ν), from the capacity of the unit square, 0.3667892.
#[test]
fn static_punch_is_the_closed_form() {
    let without = |cells| {
        let plan = Plan::rectangle(-1.0..1.0, -1.0..1.0, cells).unwrap();
        [plan.clone(), plan.without_overhang().unwrap()].map(|plan| {
            let found = at(&half_space(0.3), &plan, 0.0, StripContact::Relaxed);
            (found.matrix[2][2].re * 0.7 / 4.6092 - 1.0).abs()
        })
    };
    let [coarse, fine] = [8, 16].map(without);
    println!("with {:.1e} {:.1e}, without {:.1e} {:.1e}", coarse[0], fine[0], coarse[1], fine[1]);
    assert!(coarse[0] < 1.5e-3 && fine[0] < 4e-4);
    let order = (coarse[1] / fine[1]).log2();
    assert!((0.9..1.1).contains(&order), "without overhang: order {order}");
}

#[test]
fn dynamic_rectangles_match_the_table() {
    let rows = rows(include_str!("../data/plan/impedance_rectangle.csv"));
    let mut worst = [0.0_f64; 2];
    for group in rows.chunk_by(|a, b| a[..4] == b[..4]) {
        let ([shape, ground], a0) = ([group[0][0], group[0][1]], number(group[0][3]));
        // Undamped ground takes eight points to a frequency.
        if ground != "layer" && (shape == "2:1" || ground == "nu_1/4") && a0 != 1.0
            || shape == "2:1" && ground == "nu_1/4"
        {
            continue;
        }
        let length = if shape == "square" { 1.0 } else { 2.0 };
        let plan = Plan::rectangle(-length..length, -1.0..1.0, 16).unwrap();
        let damping = |ratio: f64| Hysteretic::new(ratio).unwrap();
        // The table's coupling has the other sign on the layer.
        let (profile, sign) = match ground {
            "layer" => (p1(damping(0.05), damping(0.01)), -1.0),
            "nu_1/3" => (half_space(1.0 / 3.0), 1.0),
            _ => (half_space(0.25), 1.0),
        };
        let found = at(&profile, &plan, a0, contact(group[0][2]));
        let place = usize::from(a0 > 1.0);
        for row in group {
            let sign = if row[4] == "HxRy" { sign } else { 1.0 };
            let wanted = Complex::new(sign * number(row[5]), sign * number(row[6]));
            let error = (component(&found, row[4]) - wanted).abs() / wanted.abs();
            worst[place] = worst[place].max(error);
            assert!(error < [5e-3, 1e-2][place], "{row:?} {error:e}");
        }
    }
    println!("16 cells: {:.1e} up to a0 = 1, {:.1e} at 2", worst[0], worst[1]);
}

#[test]
fn discs_match_a_spectral_solution() {
    let rows = rows(include_str!("../data/plan/impedance_disc.csv"));
    for (poisson, cells, gate) in [(0.25, 16, 2.5e-2), (1.0 / 3.0, 32, 1.2e-2)] {
        let plan = Plan::disc([0.3, -0.1], 1.0, cells).unwrap();
        let profile = half_space(poisson);
        for group in rows.chunk_by(|a, b| a[..4] == b[..4]) {
            let a0 = number(group[0][3]);
            if number(group[0][2]) != poisson || a0 == 1.0 {
                continue;
            }
            let found = at(&profile, &plan, a0, StripContact::Relaxed);
            for row in group {
                let wanted = Complex::new(number(row[5]), number(row[6]));
                let error = (component(&found, row[4]) - wanted).abs() / wanted.abs();
                println!("{cells} {} {} {error:.1e}", row[3], row[4]);
                assert!(error < gate, "{cells} {row:?} {error:e}");
            }
        }
    }
}

/// The difference of rectangles of 20b × 2b and 16b × 2b is 4b of a strip, and the coupling has the strip's sign.
#[test]
fn long_mats_are_strips() {
    let frequencies = [0.5 / TAU, 1.0 / TAU];
    let profile = half_space(1.0 / 3.0);
    let strip = Strip::new(-1.0..1.0, 24, Grading::Cosine).unwrap();
    let ground = ElasticGround::new(profile.clone(), strip).unwrap();
    let contact = StripContact::Bonded;
    let strips = ground.impedances(&frequencies, contact, &mut unobserved).unwrap();
    // Across the strip is along y here.
    let [long, short] = [10.0, 8.0].map(|half| {
        let plan = Plan::rectangle(-half..half, -1.0..1.0, 6).unwrap();
        impedances_in_plan(&profile, &plan, &frequencies, contact, &mut unobserved).unwrap()
    });
    for (place, (strip, gate)) in strips.into_iter().zip([0.07, 0.03]).enumerate() {
        let [long, short] = [&long, &short].map(|found| found[place].matrix);
        for ([i, j], wanted) in [
            ([2, 2], strip.vertical),
            ([1, 1], strip.horizontal),
            ([3, 3], strip.rocking),
            // rx lowers the end at −y: the strip's rotation is −rx.
            ([1, 3], -strip.coupling),
        ] {
            let found = (long[i][j] - short[i][j]) * 0.25;
            let error = (found - wanted).abs() / wanted.abs();
            println!("{place} {i}{j} {found:?} {wanted:?} {error:.1e}");
            let gate = if i == j { gate } else { 0.05 };
            assert!(error < gate, "{place} {i}{j} {error:e}");
        }
    }
}

/// A square mat taken for a piece of a strip: what the guide says of plane strain.
#[test]
fn plane_strain_misleads_on_square_mats() {
    let (profile, frequency) = (half_space(1.0 / 3.0), 0.5 / TAU);
    let strip = Strip::new(-1.0..1.0, 24, Grading::Cosine).unwrap();
    let ground = ElasticGround::new(profile.clone(), strip).unwrap();
    let contact = StripContact::Bonded;
    let strip = ground.impedances(&[frequency], contact, &mut unobserved).unwrap()[0];
    let mat = at(&profile, &Plan::rectangle(-1.0..1.0, -1.0..1.0, 16).unwrap(), 0.5, contact);
    for (axis, strip, ratios) in [
        (0, strip.horizontal, [0.57, 1.40]),
        (2, strip.vertical, [0.49, 1.25]),
        (4, strip.rocking, [0.74, 2.28]),
    ] {
        let mat = mat.matrix[axis][axis];
        let found = [2.0 * strip.re / mat.re, 2.0 * strip.im / mat.im];
        println!(
            "{axis}: {found:.3?}, damping {:.4} {:.4}",
            mat.im / mat.re / 2.0,
            strip.im / strip.re / 2.0
        );
        for (found, wanted) in found.into_iter().zip(ratios) {
            assert!((found - wanted).abs() < 6e-3, "{axis} {found}");
        }
    }
}

fn ell(turned: bool) -> Plan {
    let turn = |[x, y]: [f64; 2]| if turned { [-y, x] } else { [x, y] };
    let face = |x: [f64; 2], y: [f64; 2]| -> Vec<[f64; 2]> {
        [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]].map(turn).to_vec()
    };
    Plan::on_faces(&[face([0.0, 3.0], [0.0, 1.0]), face([0.0, 1.4], [1.0, 2.5])], 9).unwrap()
}

/// A quarter turn of the plan turns the matrix; and it is symmetric, and damps.
#[test]
fn turned_plans_have_turned_stiffness() {
    let profile = p1(Hysteretic::new(0.05).unwrap(), Hysteretic::new(0.01).unwrap());
    let [mat, turned] =
        [false, true].map(|turned| at(&profile, &ell(turned), 0.7, StripContact::Bonded).matrix);
    // Motion in the turned frame: x → y, y → −x.
    let to = |i: usize| [(1, 1.0), (0, -1.0), (2, 1.0), (4, 1.0), (3, -1.0), (5, 1.0)][i];
    for i in 0..6 {
        assert!(mat[i][i].im > 0.0 && mat[i][i].re > 0.0);
        for j in 0..6 {
            let ((row, one), (column, two)) = (to(i), to(j));
            let size = (mat[i][i].abs() * mat[j][j].abs()).sqrt();
            let error = (turned[row][column] * (one * two) - mat[i][j]).abs() / size;
            assert!(error < 1e-10, "{i}{j} {error:e}");
            assert_eq!(mat[i][j], mat[j][i]);
        }
    }
    // An L couples all that a rectangle does not.
    assert!(mat[0][5].abs() > 1e-2 && mat[2][3].abs() > 1e-2);
}
