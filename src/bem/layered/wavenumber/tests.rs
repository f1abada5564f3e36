//! Tests of element compliances against a table, a closed form and finer tolerances.

use super::*;
use crate::bem::layered::passivity::assembled;
use crate::bem::layered::test_profiles::{gmb, p1};
use crate::bem::{Grading, Strip};
use crate::fundamental::HalfPlane;
use crate::soil::Soil;

/// Compliances of all pair classes, and the number of evaluations of the ground.
struct PairCompliances {
    /// zz, xx and zx of each class.
    values: Vec<[Complex; 3]>,
    /// Number of wavenumbers at which the ground was evaluated.
    evaluation_count: usize,
}

/// Profile P1 of the table: a layer with 5 % damping on rock with 1 %.
fn damped_layer_on_rock() -> SoilProfile {
    p1(gmb(5), gmb(1))
}

fn compliances(
    profile: &SoilProfile,
    strip: &Strip,
    s: Complex,
    tolerance: f64,
) -> PairCompliances {
    let classes = PairClasses::new(strip.elements()).unwrap();
    let integrals = Wavenumbers::new(&classes, tolerance);
    let mut workspace = StripWorkspace::default();
    let mut values = vec![[Complex::default(); 3]; classes.count()];
    integrals.compliance(profile, s, &mut workspace, &mut values).unwrap();
    PairCompliances { values, evaluation_count: workspace.panels.evaluation_count }
}

/// The values of `F_s_P1_gmb_Q3.csv` are from another program, with a tolerance of 1e-12.
#[test]
fn agrees_with_the_table_of_a_damped_layer_on_rock() {
    let strip = Strip::uniform(-1.0..1.0, 3).unwrap();
    let classes = PairClasses::new(strip.elements()).unwrap();
    let integrals = Wavenumbers::new(&classes, 1e-11);
    let profile = damped_layer_on_rock();
    let table = include_str!("../../../../tests/data/layered/F_s_P1_gmb_Q3.csv");
    let mut max_error = 0.0_f64;
    let mut max_compliance = 0.0_f64;
    let mut entry_count = 0;
    let mut values = vec![[Complex::default(); 3]; classes.count()];
    for line in table.lines().skip(2) {
        // Re s, Im s, row, column, and real and imaginary part of the entry.
        let numbers: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        let s = Complex::new(numbers[0], numbers[1]);
        integrals
            .compliance(&profile, s, &mut StripWorkspace::default(), &mut values)
            .unwrap();
        let mut indices = line.split(',').skip(2).map(str::parse::<usize>);
        let row = indices.next().unwrap().unwrap();
        let column = indices.next().unwrap().unwrap();
        let matrix = assembled(&classes, &values);
        if (row, column) == (0, 0) {
            // The entries of each s begin with (0, 0). The largest is u_xx of an element due to its own traction.
            max_compliance = matrix[3 * 6 + 3].norm();
        }
        max_error = max_error.max(
            (matrix[row * 6 + column] - Complex::new(numbers[4], numbers[5]).to_complex64()).norm()
                / max_compliance,
        );
        entry_count += 1;
    }
    println!("{entry_count} entries, {max_error:e} of the largest");
    assert_eq!(entry_count, 252);
    assert!(max_error < 1e-8, "{max_error:e}");
}

/// Compliances of a half-plane equal s ∫ e^(−st) u(t) dt, u the closed form for a suddenly applied traction.
#[test]
fn homogeneous_ground_agrees_with_the_closed_form() {
    let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
    let strip = Strip::new(-1.0..1.0, 4, Grading::Cosine).unwrap();
    let classes = PairClasses::new(strip.elements()).unwrap();
    let mut layered_profile = SoilProfile::on_half_plane(soil);
    for thickness in [0.4, 1.1] {
        layered_profile = layered_profile.with_layer(soil, thickness).unwrap();
    }
    // At the small s all panels have one width; the large s allows wide panels.
    for (s, end_time) in [(1.3, 30.0), (150.0, 0.26)] {
        check_closed_form(soil, &strip, &classes, &layered_profile, s, end_time);
    }
}

/// Compares compliances at `s` with integrals of the closed form up to `end_time`.
///
/// `layered_profile`: layers of the half-plane's soil.
fn check_closed_form(
    soil: Soil,
    strip: &Strip,
    classes: &PairClasses,
    layered_profile: &SoilProfile,
    s: f64,
    end_time: f64,
) {
    let half_plane = HalfPlane::new(soil);
    let half_plane_values =
        compliances(&SoilProfile::on_half_plane(soil), strip, Complex::real(s), 1e-11).values;
    let layered_values = compliances(layered_profile, strip, Complex::real(s), 1e-11).values;
    let rule = crate::linalg::gauss::largest_rule();
    let max_compliance = half_plane_values.iter().fold(0.0_f64, |m, values| m.max(values[0].re));
    let mut max_error = 0.0_f64;
    for class in 0..classes.count() {
        let [source, receiver] = classes.representative(class).unwrap();
        let mut sum = [0.0; 3];
        // Pieces are so short that the kinks at arrivals of waves do not matter.
        let piece_count = 2000;
        for piece in 0..piece_count {
            let piece_length = end_time / f64::from(piece_count);
            for (node, weight) in rule
                .nodes
                .iter()
                .zip(&rule.weights)
                .step_by(2)
                .chain(rule.nodes.iter().zip(&rule.weights).skip(1).step_by(2))
            {
                let t = piece_length * (f64::from(piece) + 0.5 * (1.0 + node));
                let u = half_plane.element_mean(receiver, source, t).unwrap();
                let factor = 0.5 * piece_length * weight * s * (-s * t).exp() * receiver.length();
                for (sum, u) in sum.iter_mut().zip([u.zz, u.xx, u.zx]) {
                    *sum += factor * u;
                }
            }
        }
        // At large s compliances between distant elements vanish; errors relative to them mean nothing.
        let error_scale = half_plane_values[class][0].re.max(0.01 * max_compliance);
        for component in 0..3 {
            let value = half_plane_values[class][component];
            max_error = max_error.max((value.re - sum[component]).abs() / error_scale);
            let difference = (value - layered_values[class][component]).abs();
            assert!(difference < 1e-11 * error_scale, "{class} {component} {difference:e}");
        }
    }
    println!("{max_error:e} of each pair's zz");
    assert!(max_error < 1e-7, "{max_error:e}");
}

/// Errors are below the tolerance for small and large s, relative to the compliances of each pair's elements.
#[test]
fn errors_are_below_the_tolerance() {
    let strip = Strip::new(-1.0..1.0, 12, Grading::Cosine).unwrap();
    let classes = PairClasses::new(strip.elements()).unwrap();
    let elastic = p1(crate::soil::Elastic, crate::soil::Elastic);
    let mut max_error_ratios = [0.0_f64; 3];
    for profile in [damped_layer_on_rock(), elastic] {
        for s in [
            Complex::real(1e-3),
            Complex::new(0.01, 0.3),
            Complex::new(0.003, 1.3),
            Complex::new(0.02, 6.0),
            Complex::new(3.0, 20.0),
            Complex::real(60.0),
            Complex::new(0.5, 200.0),
            Complex::new(90.0, 700.0),
            Complex::real(3000.0),
        ] {
            let reference = compliances(&profile, &strip, s, 1e-14);
            // The smaller of zz and xx of an element of this length, due to its own traction.
            let self_compliance = |length: f64| {
                let is_self_pair = |class: &usize| {
                    let pair = classes.representative(*class).unwrap();
                    pair[0] == pair[1] && (pair[0].length() / length - 1.0).abs() < 1e-9
                };
                let class = (0..classes.count()).find(is_self_pair).unwrap();
                reference.values[class][0].abs().min(reference.values[class][1].abs())
            };
            for (tolerance, max_error_ratio) in
                [1e-8, 1e-10, 1e-12].into_iter().zip(&mut max_error_ratios)
            {
                let coarse_compliances = compliances(&profile, &strip, s, tolerance);
                let mut max_error = 0.0_f64;
                for class in 0..classes.count() {
                    let lengths =
                        classes.representative(class).unwrap().map(|element| element.length());
                    let pair_compliance =
                        (self_compliance(lengths[0]) * self_compliance(lengths[1])).sqrt();
                    for c in 0..3 {
                        let difference =
                            coarse_compliances.values[class][c] - reference.values[class][c];
                        max_error = max_error.max(difference.abs() / pair_compliance);
                    }
                }
                println!(
                    "{s:?} tolerance {tolerance:e}: {max_error:e}, {} of {}",
                    coarse_compliances.evaluation_count, reference.evaluation_count
                );
                *max_error_ratio = max_error_ratio.max(max_error / tolerance);
            }
        }
    }
    println!("{max_error_ratios:?}");
    assert!(max_error_ratios.iter().all(|ratio| *ratio < 1.0), "{max_error_ratios:?}");
}
