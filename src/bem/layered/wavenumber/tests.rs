//! Element compliances against tables, closed forms and each other.

use super::*;
use crate::bem::layered::passivity::assembled;
use crate::bem::layered::test_profiles::{gmb, p1};
use crate::bem::{Grading, Strip};
use crate::fundamental::HalfPlane;
use crate::soil::Soil;

/// Compliances, and what they cost.
struct PairCompliances {
    values: Vec<[Complex; 3]>,
    /// Number of wavenumbers at which the ground was evaluated.
    evaluations: usize,
}

fn compliances(
    profile: &SoilProfile,
    strip: &Strip,
    s: Complex,
    tolerance: f64,
) -> PairCompliances {
    let classes = PairClasses::new(strip.elements()).unwrap();
    let integrals = Wavenumbers::new(&classes, tolerance);
    let mut work = StripWorkspace::default();
    let mut values = vec![[Complex::default(); 3]; classes.count()];
    integrals.compliance(profile, s, &mut work, &mut values).unwrap();
    PairCompliances { values, evaluations: work.panels.evaluations }
}

/// `F_s_P1_gmb_Q3.csv`: another program, tolerance 1e-12.
#[test]
fn agrees_with_the_table_of_a_damped_layer_on_rock() {
    let strip = Strip::uniform(-1.0..1.0, 3).unwrap();
    let classes = PairClasses::new(strip.elements()).unwrap();
    let integrals = Wavenumbers::new(&classes, 1e-11);
    let profile = p1(gmb(5), gmb(1));
    let table = include_str!("../../../../tests/data/layered/F_s_P1_gmb_Q3.csv");
    let mut worst = 0.0_f64;
    let mut largest = 0.0_f64;
    let mut rows = 0;
    let mut values = vec![[Complex::default(); 3]; classes.count()];
    for line in table.lines().skip(2) {
        let n: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        let s = Complex::new(n[0], n[1]);
        integrals
            .compliance(&profile, s, &mut StripWorkspace::default(), &mut values)
            .unwrap();
        let mut indices = line.split(',').skip(2).map(str::parse::<usize>);
        let row = indices.next().unwrap().unwrap();
        let column = indices.next().unwrap().unwrap();
        let found = assembled(&classes, &values);
        if (row, column) == (0, 0) {
            // u_xx of an element due to its own traction.
            largest = found[3 * 6 + 3].norm();
        }
        worst = worst
            .max((found[row * 6 + column] - Complex::new(n[4], n[5]).inner()).norm() / largest);
        rows += 1;
    }
    println!("{rows} entries, {worst:e} of the largest");
    assert_eq!(rows, 252);
    assert!(worst < 1e-8, "{worst:e}");
}

/// s ∫ e^(−st) u(t) dt with the closed form of the half-plane, for a traction that is switched on.
#[test]
fn homogeneous_ground_is_the_closed_form() {
    let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
    let strip = Strip::new(-1.0..1.0, 4, Grading::Cosine).unwrap();
    let classes = PairClasses::new(strip.elements()).unwrap();
    let mut many = SoilProfile::on_half_plane(soil);
    for h in [0.4, 1.1] {
        many = many.with_layer(soil, h).unwrap();
    }
    // With panels of one width, and with wide panels.
    for (s, end) in [(1.3, 30.0), (150.0, 0.26)] {
        agrees_with(soil, &strip, &classes, &many, s, end);
    }
}

/// Integrals up to the time `end`.
fn agrees_with(
    soil: Soil,
    strip: &Strip,
    classes: &PairClasses,
    many: &SoilProfile,
    s: f64,
    end: f64,
) {
    let plane = HalfPlane::new(soil);
    let found =
        compliances(&SoilProfile::on_half_plane(soil), strip, Complex::real(s), 1e-11).values;
    let layers = compliances(many, strip, Complex::real(s), 1e-11).values;
    let rule = crate::linalg::gauss::largest();
    let largest = found.iter().fold(0.0_f64, |m, values| m.max(values[0].re));
    let mut worst = 0.0_f64;
    for class in 0..classes.count() {
        let [source, receiver] = classes.representative(class).unwrap();
        let mut sum = [0.0; 3];
        // Waves reach the elements' ends at these times; between them the integrand is smooth enough.
        let pieces = 2000;
        for piece in 0..pieces {
            let h = end / f64::from(pieces);
            for (node, weight) in rule
                .nodes
                .iter()
                .zip(&rule.weights)
                .step_by(2)
                .chain(rule.nodes.iter().zip(&rule.weights).skip(1).step_by(2))
            {
                let t = h * (f64::from(piece) + 0.5 * (1.0 + node));
                let u = plane.element_mean(receiver, source, t).unwrap();
                let factor = 0.5 * h * weight * s * (-s * t).exp() * receiver.length();
                for (sum, u) in sum.iter_mut().zip([u.zz, u.xx, u.zx]) {
                    *sum += factor * u;
                }
            }
        }
        // At large s, separate elements do not interact.
        let size = found[class][0].re.max(0.01 * largest);
        for component in 0..3 {
            worst = worst.max((found[class][component].re - sum[component]).abs() / size);
            let same = (found[class][component] - layers[class][component]).abs();
            assert!(same < 1e-11 * size, "{class} {component} {same:e}");
        }
    }
    println!("{worst:e} of each pair's zz");
    assert!(worst < 1e-7, "{worst:e}");
}

/// The tolerance holds for every kind of s, relative to the compliances of each pair's elements.
#[test]
fn tolerance_holds() {
    let strip = Strip::new(-1.0..1.0, 12, Grading::Cosine).unwrap();
    let classes = PairClasses::new(strip.elements()).unwrap();
    let elastic = p1(crate::soil::Elastic, crate::soil::Elastic);
    let mut worst = [0.0_f64; 3];
    for profile in [p1(gmb(5), gmb(1)), elastic] {
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
            let fine = compliances(&profile, &strip, s, 1e-14);
            // Smaller compliance of an element of this length with itself.
            let self_compliance = |length: f64| {
                let is_self_pair = |class: &usize| {
                    let pair = classes.representative(*class).unwrap();
                    pair[0] == pair[1] && (pair[0].length() / length - 1.0).abs() < 1e-9
                };
                let class = (0..classes.count()).find(is_self_pair).unwrap();
                fine.values[class][0].abs().min(fine.values[class][1].abs())
            };
            for (tolerance, worst) in [1e-8, 1e-10, 1e-12].into_iter().zip(&mut worst) {
                let found = compliances(&profile, &strip, s, tolerance);
                let mut largest = 0.0_f64;
                for class in 0..classes.count() {
                    let lengths = classes.representative(class).unwrap().map(|e| e.length());
                    let unit = (self_compliance(lengths[0]) * self_compliance(lengths[1])).sqrt();
                    for c in 0..3 {
                        let difference = found.values[class][c] - fine.values[class][c];
                        largest = largest.max(difference.abs() / unit);
                    }
                }
                println!(
                    "{s:?} tolerance {tolerance:e}: {largest:e}, {} of {}",
                    found.evaluations, fine.evaluations
                );
                *worst = worst.max(largest / tolerance);
            }
        }
    }
    println!("{worst:?}");
    assert!(worst.iter().all(|w| *w < 1.0), "{worst:?}");
}
