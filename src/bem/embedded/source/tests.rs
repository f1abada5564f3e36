use super::*;
use crate::bem::embedded::Trench;
use crate::bem::layered::{CirclePoint, on_circle};
use crate::bem::{ElasticGround, Strip};
use crate::history::PairClasses;
use crate::soil::{KelvinVoigt, Soil, SoilProfile};
use crate::unobserved;

const TIME_STEP: f64 = 0.8;
const LAG_COUNT: usize = 128;

/// A layer on rigid bedrock in which waves die out within the first block of lags.
fn profile() -> SoilProfile {
    SoilProfile::on_rigid_bedrock()
        .with_layer(Soil::new(1.0, 0.3, 1.0).unwrap(), 2.0)
        .unwrap()
        .with_damping(KelvinVoigt::new(1.0).unwrap())
}

fn source(depth: f64, base: usize, wall: usize) -> TrenchSource {
    let elements = Trench::new(-1.0..1.0, depth).unwrap().elements(base, wall).unwrap();
    let soil = TrenchSoil::new(profile(), elements).unwrap();
    TrenchSource { soil, stages: None, file: None }
}

/// All lags of a class, one list for each kind.
fn lags(weights: &dyn ConvolutionWeights, class: usize) -> [Vec<f64>; TRENCH_KINDS] {
    let mut lags = [(); TRENCH_KINDS].map(|()| vec![0.0; LAG_COUNT]);
    let mut slices = lags.each_mut().map(Vec::as_mut_slice);
    weights.coefficients(class, 1, &mut slices).unwrap();
    lags
}

/// Σ Gⁿ is the compliance at rest, and (1 − z) Σ Gⁿ zⁿ⁻¹ the mobility at z.
#[test]
fn weights_are_the_coefficients_of_the_mobility() {
    let source = source(1.0, 4, 2);
    let weights = source.weights(TIME_STEP).unwrap();
    weights.prepare(LAG_COUNT, &mut unobserved).unwrap();
    let compliances = source.soil.static_compliances().unwrap();
    let mut at_rest = vec![[Complex::default(); TRENCH_KINDS]; weights.classes.count()];
    TrenchPairs::new(source.soil.clone(), ELEMENT_DEGREE).fill_classes(&compliances, &mut at_rest);
    let place = [0.8_f64.ln(), 0.7];
    let CirclePoint { z, one_less_z } = on_circle(place[0], place[1]);
    let mut mobility = at_rest.clone();
    let mut work = crate::bem::layered::LayeredCompliance::default();
    let mut scratch = at_rest.clone();
    weights.quadrature.mobility(place, &mut work, &mut scratch, &mut mobility).unwrap();
    let largest = at_rest.iter().flatten().map(|value| value.re.abs()).fold(0.0, f64::max);
    let mut worst = [0.0_f64; 2];
    for class in 0..weights.classes.count() {
        for (kind, lags) in lags(&weights, class).iter().enumerate() {
            let sum: f64 = lags.iter().sum();
            worst[0] = worst[0].max((sum - at_rest[class][kind].re).abs());
            let mut power = one_less_z;
            let mut sum = Complex::default();
            for lag in lags {
                sum += power.scale(*lag);
                power = power * z;
            }
            worst[1] = worst[1].max((sum - mobility[class][kind]).abs());
        }
    }
    println!("{:e} {:e}", worst[0] / largest, worst[1] / largest);
    assert!(worst[0] < 1e-5 * largest && worst[1] < 1e-6 * largest, "{worst:?}");
}

/// The work of any tractions is not negative where these eigenvalues are not.
#[test]
fn symbols_are_positive_at_short_and_long_steps() {
    let half_plane = Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap();
    for step in [0.05, 0.3, 2.0] {
        let elements = Trench::new(-1.0..1.0, 1.0).unwrap().elements(4, 3).unwrap();
        let soil = TrenchSoil::new(half_plane.into(), elements).unwrap();
        let weights = TrenchSource { soil, stages: None, file: None }.weights(step).unwrap();
        let classes = &weights.classes;
        let mut sums = vec![[Complex::default(); TRENCH_KINDS]; classes.count()];
        let mut work = crate::bem::layered::LayeredCompliance::default();
        let mut scratch = sums.clone();
        let mut smallest_ratio = f64::INFINITY;
        for k in 0..12 {
            let place = [0.0, std::f64::consts::PI * (f64::from(k) + 0.5) / 12.0];
            weights.quadrature.mobility(place, &mut work, &mut scratch, &mut sums).unwrap();
            let mut matrix = vec![Complex::default(); classes.layout().square()];
            classes.scatter(&mut matrix, |_, pair| sums[pair.class]);
            let matrix: Vec<_> = matrix.iter().map(|value| value.inner()).collect();
            let eigenvalues =
                crate::linalg::hermitian_range(&matrix, classes.layout().len()).unwrap();
            smallest_ratio = smallest_ratio.min(eigenvalues[0] / eigenvalues[1]);
        }
        println!("{step}: {smallest_ratio:e}");
        assert!(smallest_ratio > -1e-8, "{step}: {smallest_ratio:e}");
    }
}

/// A trench without depth is a strip, whose weights are integrals over wavenumbers; elements of degree 4.
#[test]
fn weights_without_depth_are_the_weights_of_a_strip() {
    let source = source(0.0, 4, 0);
    let weights = source.weights(TIME_STEP).unwrap();
    let strip = ElasticGround::new(profile(), Strip::graded(-1.0..1.0, 4).unwrap()).unwrap();
    let strip = strip.with_stages(source.stages(TIME_STEP)).weights(TIME_STEP).unwrap();
    let found = matrix_of_sums(&weights.classes, |class, values| {
        weights.coefficients(class, 1, values).unwrap();
    });
    let wanted = matrix_of_sums(strip.classes(), |class, values| {
        strip.coefficients(class, 1, values).unwrap();
    });
    let largest = wanted.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let worst = found.iter().zip(&wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("{:e}", worst / largest);
    assert!(worst < 2e-3 * largest, "{:e}", worst / largest);
}

/// Matrix of all pairs: sums over lags with the factor cos(0.3 n).
///
/// `fill` gets a class, and overwrites one list of lags for each kind.
fn matrix_of_sums(classes: &PairClasses, fill: impl Fn(usize, &mut [&mut [f64]])) -> Vec<f64> {
    let layout = classes.layout();
    let mut matrix = vec![0.0; layout.square()];
    classes.each(|[receiver, source], pair, terms| {
        let mut lags = vec![vec![0.0; LAG_COUNT]; classes.kinds()];
        let mut slices: Vec<_> = lags.iter_mut().map(Vec::as_mut_slice).collect();
        fill(pair.class, &mut slices);
        for term in terms {
            let row = layout.place(term.components[0], receiver);
            let column = layout.place(term.components[1], source);
            let lags = lags[term.kind].iter().enumerate();
            let sum: f64 = lags.map(|(n, lag)| lag * (0.3 * n as f64).cos()).sum();
            matrix[row * layout.len() + column] = sum * term.factor * pair.scale;
        }
    });
    matrix
}

/// Without depth on a half-plane: the strip's closed form, but for a translation down and one to the right.
#[test]
fn static_compliance_without_depth_is_the_strips_up_to_translations() {
    let half_plane = Soil::new(1.0, 0.3, 1.0).unwrap();
    let trench = Trench::new(-1.0..1.0, 0.0).unwrap().elements(8, 0).unwrap();
    let soil = TrenchSoil::new(half_plane.into(), trench).unwrap();
    let source = TrenchSource { soil, stages: None, file: None };
    let strip = Strip::graded(-1.0..1.0, 8).unwrap();
    let count = 8;
    let size = 16;
    let mut found = vec![0.0; size * size];
    let mut wanted = vec![0.0; size * size];
    source.static_compliance(&strip.elements(), &mut found).unwrap();
    let ground = ElasticGround::new(half_plane, strip).unwrap();
    crate::bem::Ground::static_compliance(&ground, &mut wanted).unwrap();
    // Tractions of the same force are compared: a translation is proportional to the force.
    let lengths: Vec<f64> =
        source.soil.elements().elements().iter().map(ContactElement::length).collect();
    let mut worst = 0.0_f64;
    for i in 0..size {
        for j in 0..size {
            let first = j / count * count;
            let in_direction_of_force = i / count == j / count;
            let per_force = [&found, &wanted].map(|matrix| {
                let datum = matrix[first * size + first] / lengths[first % count];
                let value = matrix[i * size + j] / lengths[j % count];
                if in_direction_of_force { value - datum } else { value }
            });
            worst = worst.max((per_force[0] - per_force[1]).abs());
        }
    }
    // Finite elements of degree 4; the largest entry is about 1.
    println!("{worst:e}");
    assert!(worst < 5e-3, "{worst:e}");
}

/// (L R)ᵀ S⁻¹ (L R) of the static compliance S between all elements is the stiffness of the half models.
#[test]
fn rigid_body_has_the_static_impedance() {
    let source = source(1.2, 4, 3);
    let elements = source.soil.elements().elements();
    let count = elements.len();
    let size = 2 * elements.len();
    let mut matrix = vec![0.0; size * size];
    source.static_compliance(&elements, &mut matrix).unwrap();
    // To the right, down, and a rotation about the middle of the base that lowers the right end.
    let mut rows: Vec<[f64; 3]> = vec![];
    for place in 0..size {
        let element = &elements[place % count];
        let center = element.center();
        let direction = element.directions()[place / count];
        let moment = direction[0] * (1.2 + center[2]) - direction[2] * center[0];
        rows.push([direction[0], -direction[2], moment]);
    }
    let mut factor = crate::linalg::DenseFactor::with_columns(size, 1);
    assert!(factor.factor(&matrix, size));
    let mut stiffness = [[0.0; 3]; 3];
    for k in 0..3 {
        let mut solved: Vec<f64> = rows.iter().map(|row| row[k]).collect();
        factor.solve(&mut solved);
        for i in 0..3 {
            let parts = (0..size).map(|p| rows[p][i] * elements[p % count].length() * solved[p]);
            stiffness[i][k] = parts.sum();
        }
    }
    let wanted = source.soil.response(
        Complex::default(),
        &source.soil.mesh_of_depth(Complex::default(), 24.0, ELEMENT_DEGREE),
    );
    let wanted = wanted.unwrap().stiffness.map(|value| value.re);
    for (found, wanted) in [
        (stiffness[0][0], wanted[0]),
        (stiffness[1][1], wanted[1]),
        (stiffness[2][2], wanted[2]),
        (stiffness[0][2], wanted[3]),
        (stiffness[2][0], wanted[3]),
    ] {
        assert!((found - wanted).abs() < 1e-9 * stiffness[2][2], "{found} {wanted}");
    }
}
