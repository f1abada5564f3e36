use super::*;
use crate::bem::embedded::Trench;
use crate::bem::layered::{CirclePoint, on_circle};
use crate::bem::{ElasticGround, Strip};
use crate::error::ProgressReporter;
use crate::history::PairClasses;
use crate::soil::{GeneralizedMaxwell, KelvinVoigt, Soil, SoilProfile};
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

/// Sums of the weights Gⁿ are the compliance at rest, and the mobility.
///
/// Σ Gⁿ is the compliance at rest, and (1 − z) Σ Gⁿ zⁿ⁻¹ the mobility at z.
#[test]
fn weights_are_the_coefficients_of_the_mobility() {
    let source = source(1.0, 4, 2);
    let weights = source.weights(TIME_STEP).unwrap();
    weights.prepare(LAG_COUNT, &mut unobserved).unwrap();
    let compliances = source.soil.static_compliances().unwrap();
    let mut at_rest = vec![[Complex::default(); TRENCH_KINDS]; weights.classes.count()];
    TrenchPairs::new(source.soil.clone(), ELEMENT_DEGREE).fill_classes(&compliances, &mut at_rest);
    let log_radius_and_angle = [0.8_f64.ln(), 0.7];
    let CirclePoint { z, one_less_z } = on_circle(log_radius_and_angle[0], log_radius_and_angle[1]);
    let mut mobility = at_rest.clone();
    let mut work = crate::bem::layered::LayeredCompliance::default();
    let mut scratch = at_rest.clone();
    weights
        .quadrature
        .mobility(log_radius_and_angle, &mut work, &mut scratch, &mut mobility)
        .unwrap();
    let largest = at_rest.iter().flatten().map(|value| value.re.abs()).fold(0.0, f64::max);
    let mut max_error_at_rest = 0.0_f64;
    let mut max_mobility_error = 0.0_f64;
    for class in 0..weights.classes.count() {
        for (kind, lags) in lags(&weights, class).iter().enumerate() {
            let sum: f64 = lags.iter().sum();
            max_error_at_rest = max_error_at_rest.max((sum - at_rest[class][kind].re).abs());
            let mut power = one_less_z;
            let mut power_sum = Complex::default();
            for lag in lags {
                power_sum += power.scale(*lag);
                power = power * z;
            }
            let error = (power_sum - mobility[class][kind]).abs();
            max_mobility_error = max_mobility_error.max(error);
        }
    }
    println!("{:e} {:e}", max_error_at_rest / largest, max_mobility_error / largest);
    assert!(max_error_at_rest < 1e-5 * largest, "{max_error_at_rest:e}");
    assert!(max_mobility_error < 1e-6 * largest, "{max_mobility_error:e}");
}

/// Grounds of the table of weights: half-plane, damped layer on rock, and on rigid bedrock.
fn grounds_of_table() -> [SoilProfile; 3] {
    let damping = |ratio| GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0).unwrap();
    let clay = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0).unwrap();
    let rock = Soil::from_shear_wave_speed(600.0, 0.3, 2200.0).unwrap();
    let on_rock = SoilProfile::on_half_plane(rock).with_bedrock_damping(damping(0.01));
    let with_layer =
        |bedrock: SoilProfile| bedrock.with_layer(clay, 15.0).unwrap().with_damping(damping(0.05));
    [clay.into(), with_layer(on_rock), with_layer(SoilProfile::on_rigid_bedrock())]
}

/// REFERENCE: a table by compliances at all points of the quadrature.
///
/// On half-planes they have finer stretched elements, on rigid bedrock whole vertical lines were eliminated as dense
/// matrices. Errors are relative to the largest weight of a lag.
#[test]
fn weights_are_those_of_compliances_at_all_points() {
    let table = basemat_testkit::table("embedded/weights.csv");
    let rows = table.rows(["ground", "class", "kind", "lag_1", "lag_2", "lag_10", "lag_100"]);
    for (ground, profile) in grounds_of_table().into_iter().enumerate() {
        let elements = Trench::new(-12.0..12.0, 6.0).unwrap().elements(4, 2).unwrap();
        let soil = TrenchSoil::new(profile, elements).unwrap();
        let source = TrenchSource { soil, stages: None, file: None };
        let weights = source.weights(0.01).unwrap();
        let mut max_weights = [0.0_f64; 4];
        let mut max_errors = [0.0_f64; 4];
        for class in 0..weights.classes.count() {
            for (kind, lags) in lags(&weights, class).iter().enumerate() {
                let labels = [ground, class, kind].map(|label| label as f64);
                let row = rows.iter().find(|row| row[..3] == labels).unwrap();
                for (k, lag) in [1, 2, 10, 100].into_iter().enumerate() {
                    let expected = row[3 + k];
                    max_weights[k] = max_weights[k].max(expected.abs());
                    max_errors[k] = max_errors[k].max((lags[lag - 1] - expected).abs());
                }
            }
        }
        for k in 0..4 {
            let error = max_errors[k] / max_weights[k];
            println!("{ground} {k}: {error:e}");
            assert!(error < 1e-8, "{ground} {k}: {error:e}");
        }
    }
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
            let angle = std::f64::consts::PI * (f64::from(k) + 0.5) / 12.0;
            let log_radius_and_angle = [0.0, angle];
            weights
                .quadrature
                .mobility(log_radius_and_angle, &mut work, &mut scratch, &mut sums)
                .unwrap();
            let mut matrix = vec![Complex::default(); classes.layout().matrix_len()];
            classes.scatter(&mut matrix, |_, pair| sums[pair.class]);
            let matrix: Vec<_> = matrix.iter().map(|value| value.to_complex64()).collect();
            let eigenvalues =
                crate::linalg::hermitian_range(&matrix, classes.layout().len()).unwrap();
            smallest_ratio = smallest_ratio.min(eigenvalues[0] / eigenvalues[1]);
        }
        println!("{step}: {smallest_ratio:e}");
        assert!(smallest_ratio > -1e-8, "{step}: {smallest_ratio:e}");
    }
}

/// A trench without depth is a strip, whose weights are integrals over wavenumbers.
///
/// The finite elements have degree 4.
#[test]
fn weights_without_depth_are_the_weights_of_a_strip() {
    let source = source(0.0, 4, 0);
    let weights = source.weights(TIME_STEP).unwrap();
    let strip = ElasticGround::new(profile(), Strip::graded(-1.0..1.0, 4).unwrap()).unwrap();
    let strip = strip.with_stages(source.stages(TIME_STEP)).weights(TIME_STEP).unwrap();
    let computed = matrix_of_sums(&weights.classes, |class, values| {
        weights.coefficients(class, 1, values).unwrap();
    });
    let expected = matrix_of_sums(strip.classes(), |class, values| {
        strip.coefficients(class, 1, values).unwrap();
    });
    let largest = expected.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let differences = computed.iter().zip(&expected).map(|(a, b)| (a - b).abs());
    let max_difference = differences.fold(0.0, f64::max);
    println!("{:e}", max_difference / largest);
    assert!(max_difference < 2e-3 * largest, "{:e}", max_difference / largest);
}

/// Matrix of all pairs: sums over lags with the factor cos(0.3 n).
///
/// `fill` overwrites one list of lags for each kind of a class.
fn matrix_of_sums(classes: &PairClasses, fill: impl Fn(usize, &mut [&mut [f64]])) -> Vec<f64> {
    let layout = classes.layout();
    let mut matrix = vec![0.0; layout.matrix_len()];
    classes.each(|[receiver, source], pair, terms| {
        let mut lags = vec![vec![0.0; LAG_COUNT]; classes.kinds()];
        let mut slices: Vec<_> = lags.iter_mut().map(Vec::as_mut_slice).collect();
        fill(pair.class, &mut slices);
        for term in terms {
            let row = layout.index_of(term.components[0], receiver);
            let column = layout.index_of(term.components[1], source);
            let lags = lags[term.kind].iter().enumerate();
            let sum: f64 = lags.map(|(n, lag)| lag * (0.3 * n as f64).cos()).sum();
            matrix[row * layout.len() + column] = sum * term.factor * pair.scale;
        }
    });
    matrix
}

/// Without depth the compliance is the strip's closed form.
///
/// On a half-plane both differ by a translation down and a translation to the right.
#[test]
fn static_compliance_without_depth_is_the_strips_up_to_translations() {
    let half_plane = Soil::new(1.0, 0.3, 1.0).unwrap();
    let trench = Trench::new(-1.0..1.0, 0.0).unwrap().elements(8, 0).unwrap();
    let soil = TrenchSoil::new(half_plane.into(), trench).unwrap();
    let source = TrenchSource { soil, stages: None, file: None };
    let strip = Strip::graded(-1.0..1.0, 8).unwrap();
    let element_count = 8;
    let order = 16;
    let mut computed = vec![0.0; order * order];
    let mut expected = vec![0.0; order * order];
    source.static_compliance(&strip.elements(), &mut computed).unwrap();
    let ground = ElasticGround::new(half_plane, strip).unwrap();
    crate::bem::Ground::static_compliance(&ground, &mut expected).unwrap();
    // Tractions of the same force are compared: a translation is proportional to the force.
    let lengths: Vec<f64> =
        source.soil.elements().elements().iter().map(ContactElement::length).collect();
    let mut max_difference = 0.0_f64;
    for i in 0..order {
        for j in 0..order {
            let first_row = j / element_count * element_count;
            let is_in_direction_of_force = i / element_count == j / element_count;
            let compliances = [&computed, &expected].map(|matrix| {
                let translation =
                    matrix[first_row * order + first_row] / lengths[first_row % element_count];
                let value = matrix[i * order + j] / lengths[j % element_count];
                if is_in_direction_of_force { value - translation } else { value }
            });
            max_difference = max_difference.max((compliances[0] - compliances[1]).abs());
        }
    }
    // Finite elements of degree 4; the largest entry is about 1.
    println!("{max_difference:e}");
    assert!(max_difference < 5e-3, "{max_difference:e}");
}

/// The static compliance S of all elements has the stiffness of the half models.
///
/// The stiffness of a rigid body is Rᵀ L S⁻¹ R, with R its motions and L the lengths of the elements.
#[test]
fn rigid_body_has_the_static_impedance() {
    let source = source(1.2, 4, 3);
    let elements = source.soil.elements().elements();
    let element_count = elements.len();
    let order = 2 * element_count;
    let mut matrix = vec![0.0; order * order];
    source.static_compliance(&elements, &mut matrix).unwrap();
    // To the right, down, and a rotation about the middle of the base that lowers the right end.
    let mut rows: Vec<[f64; 3]> = vec![];
    for row in 0..order {
        let element = &elements[row % element_count];
        let center = element.center();
        let direction = element.directions()[row / element_count];
        let moment = direction[0] * (1.2 + center[2]) - direction[2] * center[0];
        rows.push([direction[0], -direction[2], moment]);
    }
    let mut factor = crate::linalg::DenseFactor::with_columns(order, 1);
    assert!(factor.factor(&matrix, order));
    let mut stiffness = [[0.0; 3]; 3];
    for k in 0..3 {
        let mut tractions: Vec<f64> = rows.iter().map(|row| row[k]).collect();
        factor.solve(&mut tractions);
        for i in 0..3 {
            let terms = (0..order)
                .map(|p| rows[p][i] * elements[p % element_count].length() * tractions[p]);
            stiffness[i][k] = terms.sum();
        }
    }
    let response = source.soil.response(
        Complex::default(),
        &source.soil.mesh_of_depth(Complex::default(), 24.0, ELEMENT_DEGREE),
    );
    let expected = response.unwrap().stiffness.map(|value| value.re);
    for (computed, expected) in [
        (stiffness[0][0], expected[0]),
        (stiffness[1][1], expected[1]),
        (stiffness[2][2], expected[2]),
        (stiffness[0][2], expected[3]),
        (stiffness[2][0], expected[3]),
    ] {
        assert!((computed - expected).abs() < 1e-9 * stiffness[2][2], "{computed} {expected}");
    }
}

/// Rational functions through samples have the weights of finite elements at each point of the quadrature.
///
/// Errors are relative to the largest weight.
#[test]
fn rational_functions_give_the_weights_of_all_points() {
    for (ground, profile) in grounds_of_table().into_iter().enumerate() {
        let elements = Trench::new(-12.0..12.0, 6.0).unwrap().elements(4, 2).unwrap();
        let soil = TrenchSoil::new(profile, elements).unwrap();
        let source = TrenchSource { soil, stages: None, file: None };
        let rational = source.weights(0.01).unwrap();
        let mut direct = source.weights(0.01).unwrap();
        direct.quadrature.integrals = TrenchPairs::new(source.soil.clone(), ELEMENT_DEGREE);
        rational.check_passivity(&mut ProgressReporter::unobserved()).unwrap();
        let node_count = rational.quadrature.integrals.node_count();
        assert!(node_count.is_some_and(|count| count < 120), "{ground}: {node_count:?}");
        let mut largest = 0.0_f64;
        let mut difference = 0.0_f64;
        for class in 0..rational.classes.count() {
            let computed = lags(&rational, class);
            let expected = lags(&direct, class);
            for (a, b) in computed.iter().flatten().zip(expected.iter().flatten()) {
                largest = largest.max(b.abs());
                difference = difference.max((a - b).abs());
            }
        }
        let error = difference / largest;
        assert!(error < 2e-9, "{ground}: {error:e}");
        println!("{ground}: {node_count:?} nodes, {error:e}");
    }
}
