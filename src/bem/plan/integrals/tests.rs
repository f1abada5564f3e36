//! Compliances of cells against a table and themselves.

use realfft::num_complex::Complex64;

use super::*;
use crate::bem::layered::test_profiles::{gmb, p1};
use crate::bem::layered::{Stages, on_circle};
use crate::geometry::offset;
use crate::soil::Soil;

fn all(
    lattice: &Lattice,
    profile: &SoilProfile,
    s: Complex,
    tolerance: f64,
) -> (Vec<[Complex; SERIES]>, usize) {
    let mut watch = Watch::nobody();
    let integrals = Integrals::new(lattice, profile, [s], tolerance, &mut watch).unwrap();
    let mut work = Workspace::default();
    let mut values = vec![[Complex::default(); SERIES]; integrals.table.classes];
    integrals.compliance(profile, s, &mut work, &mut values).unwrap();
    (values, work.evaluations)
}

fn half_space() -> SoilProfile {
    SoilProfile::on_half_plane(Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap())
}

/// `compliance_4x4.csv`: another program, good to about 1e-8.
#[test]
fn agrees_with_the_table_of_sixteen_cells() {
    let lattice = Lattice { pitch: [0.5; 2], counts: [4, 4] };
    let table = include_str!("../../../../tests/data/plan/compliance_4x4.csv");
    let mut worst = [0.0_f64; 2];
    let rows: Vec<Vec<&str>> = table.lines().skip(2).map(|l| l.split(',').collect()).collect();
    for group in rows.chunk_by(|a, b| a[..3] == b[..3]) {
        let layered = group[0][0] == "layer_rock";
        let profile = if layered { p1(gmb(5), gmb(1)) } else { half_space() };
        let number = |text: &str| text.parse::<f64>().unwrap();
        let s = Complex::new(number(group[0][1]), number(group[0][2]));
        let (values, evaluations) = all(&lattice, &profile, s, 1e-10);
        let largest = lattice.block(&values, [0, 0])[1][1].abs();
        let mut own = [0.0_f64; SERIES];
        for row in group {
            let [i, j] = [4, 5].map(|column| row[column].parse::<isize>().unwrap());
            let block = lattice.block(&values, [i, j]);
            let place = |letter: char| "zxy".find(letter).unwrap();
            let [to, from] = [0, 1].map(|at| place(row[3].chars().nth(at).unwrap()));
            let wanted = Complex::new(number(row[6]), number(row[7]));
            let error = (block[to][from] - wanted).abs() / largest;
            own[(2 * to + from).min(5)] = own[(2 * to + from).min(5)].max(error);
            worst[usize::from(layered)] = worst[usize::from(layered)].max(error);
        }
        println!("{} {s:?} {own:?} {evaluations}", group[0][0]);
    }
    println!("{worst:?}");
    assert!(worst[0].max(worst[1]) < 1e-8, "{worst:?}");
}

fn largest_difference(one: &[[Complex; SERIES]], two: &[[Complex; SERIES]]) -> f64 {
    let pairs = one.as_flattened().iter().zip(two.as_flattened());
    pairs.map(|(one, two)| (*one - *two).abs()).fold(0.0, f64::max) / one[0][1].abs()
}

/// A half-space cut into layers is integrated further, and its tail begins elsewhere, but it is the same.
#[test]
fn cut_half_space_is_whole() {
    let soil = Soil::new(1.0, 0.3, 1.0).unwrap();
    let one = SoilProfile::on_half_plane(soil);
    let lattice = Lattice { pitch: [0.5, 0.4], counts: [4, 3] };
    for s in
        [Complex::new(0.2, 1.5), Complex::new(3.0, 8.0), Complex::real(12.0), Complex::default()]
    {
        let (wanted, _) = all(&lattice, &one, s, 1e-11);
        for thickness in [0.25, 3.0] {
            let cut = one.clone().with_layer(soil, thickness).unwrap();
            let (found, _) = all(&lattice, &cut.with_layer(soil, 0.6).unwrap(), s, 1e-11);
            let error = largest_difference(&wanted, &found);
            println!("{s:?} {thickness} {error:e}");
            assert!(error < 2e-9, "{s:?} {thickness} {error:e}");
        }
    }
}

/// Slow motions tend to statics, which a layer stiffens.
#[test]
fn statics_are_the_limit_of_slow_motions() {
    let lattice = Lattice { pitch: [0.5; 2], counts: [5, 3] };
    let profile = p1(gmb(5), gmb(1));
    let (still, _) = all(&lattice, &profile, Complex::default(), 1e-11);
    let (slow, _) = all(&lattice, &profile, Complex::real(1e-6), 1e-11);
    let error = largest_difference(&still, &slow);
    assert!(error < 1e-5, "{error:e}");
    assert!(still.as_flattened().iter().all(|value| value.im == 0.0));
}

/// All cells: factor × F.
fn assembled(
    lattice: &Lattice,
    values: &[[Complex; SERIES]],
    factor: Complex,
) -> (Vec<Complex64>, usize) {
    let count = lattice.counts[0] * lattice.counts[1];
    let cell = |n: usize| [n % lattice.counts[0], n / lattice.counts[0]];
    let order = 3 * count;
    let mut matrix = vec![Complex64::default(); order * order];
    for p in 0..count {
        for q in 0..count {
            let offset = offset(cell(p), cell(q));
            for (i, row) in lattice.block(values, offset).into_iter().enumerate() {
                for (j, value) in row.into_iter().enumerate() {
                    matrix[(3 * p + i) * order + 3 * q + j] = (factor * value).inner();
                }
            }
        }
    }
    (matrix, order)
}

/// Herm(sF) ≥ 0 for Re s > 0: random layers, damping, lattices; of masks and unions it is a congruence.
#[test]
fn mobility_is_passive() {
    let mut state = 7_u64;
    let mut random = move |least: f64, most: f64| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        least * (most / least).powf((state >> 11) as f64 / (1_u64 << 53) as f64)
    };
    let mut least = f64::INFINITY;
    for case in 0..200 {
        let soil = |random: &mut dyn FnMut(f64, f64) -> f64| {
            Soil::new(random(0.1, 10.0), random(0.05, 0.49), random(0.8, 1.25)).unwrap()
        };
        let mut profile = if case % 4 == 0 {
            SoilProfile::on_rigid_base()
        } else {
            SoilProfile::on_half_plane(soil(&mut random))
        };
        for layer in 0..=case % 3 {
            let soil = soil(&mut random);
            profile = profile.with_layer(soil, random(0.3, 3.0)).unwrap();
            if (case + layer) % 2 == 0 {
                profile = profile.with_damping(gmb(5));
            }
        }
        let pitch = [0.5, if case % 2 == 0 { 0.5 } else { random(0.25, 1.0) }];
        let lattice = Lattice { pitch, counts: [2 + case % 3, 1 + case % 4] };
        let s = Complex::new(random(0.02, 5.0), random(0.02, 20.0));
        let (values, _) = all(&lattice, &profile, s, 1e-11);
        let (matrix, order) = assembled(&lattice, &values, s);
        let [low, high] = crate::linalg::hermitian_range(&matrix, order).unwrap();
        least = least.min(low / high);
        assert!(low > -1e-10 * high, "{case} {s:?} {low:e} {high:e}");
    }
    println!("least/greatest {least:e}");
    assert!(least > 0.0);
}

/// Mobilities of convolution quadrature with two stages, Σ wⱼ λⱼ F(λⱼ/Δt) = (1−z) Ĝ(z).
struct Quadrature<'a> {
    integrals: Integrals,
    profile: &'a SoilProfile,
    work: Workspace,
}

const STEP: f64 = 0.2;

impl<'a> Quadrature<'a> {
    fn new(lattice: &Lattice, profile: &'a SoilProfile) -> Self {
        // |λ| is at most 6 on the unit disc.
        let list = [Complex::default(), Complex::real(6.1 / STEP)];
        let mut watch = Watch::nobody();
        let integrals = Integrals::new(lattice, profile, list, 1e-11, &mut watch).unwrap();
        Self { integrals, profile, work: Workspace::default() }
    }

    fn mobility(&mut self, logarithm: f64, angle: f64) -> Vec<[Complex; SERIES]> {
        let [z, rest] = on_circle(logarithm, angle);
        let mut sums = vec![[Complex::default(); SERIES]; self.integrals.table.classes];
        let mut values = sums.clone();
        for node in Stages::Two.nodes(z, rest) {
            let s = node.lambda.scale(1.0 / STEP);
            self.integrals.compliance(self.profile, s, &mut self.work, &mut values).unwrap();
            for (sum, value) in sums.as_flattened_mut().iter_mut().zip(values.as_flattened()) {
                *sum += node.weight * *value;
            }
        }
        sums
    }
}

/// Convolution weights are those of the table and sum up to statics; (1−z) Ĝ is positive on circles.
#[test]
fn weights_of_convolution_quadrature_match_the_table() {
    const POINTS: usize = 512;
    let lattice = Lattice { pitch: [0.5; 2], counts: [4, 4] };
    let table = include_str!("../../../../tests/data/plan/weights_4x4.csv");
    let rows: Vec<Vec<&str>> = table.lines().skip(2).map(|l| l.split(',').collect()).collect();
    for rows in rows.chunk_by(|a, b| a[0] == b[0]) {
        let layered = rows[0][0] == "layer_rock";
        let profile = if layered { p1(gmb(5), gmb(1)) } else { half_space() };
        let mut quadrature = Quadrature::new(&lattice, &profile);
        let mut range = [f64::INFINITY, 0.0_f64];
        for logarithm in [0.99_f64.ln(), -1e-3] {
            for point in 0..20 {
                let angle = std::f64::consts::PI * (f64::from(point) + 0.5) / 20.0;
                let values = quadrature.mobility(logarithm, angle);
                let (matrix, order) = assembled(&lattice, &values, Complex::real(1.0));
                let [low, high] = crate::linalg::hermitian_range(&matrix, order).unwrap();
                range = [range[0].min(low / high), range[1].max(low / high)];
            }
        }
        println!("{} least over greatest: {range:?}", rows[0][0]);
        assert!(range[0] > 0.0);

        let logarithm = 1e-8_f64.ln() / POINTS as f64;
        let angle = |point: usize| std::f64::consts::TAU * point as f64 / POINTS as f64;
        let spectra: Vec<Vec<[Complex; SERIES]>> = (0..=POINTS / 2)
            .map(|point| {
                let over = on_circle(logarithm, angle(point))[1].inverse();
                let values = quadrature.mobility(logarithm, angle(point));
                values.into_iter().map(|value| value.map(|x| x * over)).collect()
            })
            .collect();
        let weights = |lag: usize| -> Vec<[Complex; SERIES]> {
            let (n, mut sums) = (lag - 1, vec![[Complex::default(); SERIES]; spectra[0].len()]);
            for (point, values) in spectra.iter().enumerate() {
                let twice = if point == 0 || point == POINTS / 2 { 1.0 } else { 2.0 };
                let size = twice * (-logarithm * n as f64).exp() / POINTS as f64;
                let turn = Complex::polar(size, -angle(point * n % POINTS));
                for (sum, value) in sums.as_flattened_mut().iter_mut().zip(values.as_flattened()) {
                    sum.re += (*value * turn).re;
                }
            }
            sums
        };
        let largest = weights(1)[0][1].re;
        let mut worst = 0.0_f64;
        for rows in rows.chunk_by(|a, b| a[1] == b[1]) {
            let weights = weights(rows[0][1].parse().unwrap());
            for row in rows {
                let offset = [3, 4].map(|column| row[column].parse::<isize>().unwrap());
                let place = |at: usize| "zxy".find(row[2].chars().nth(at).unwrap()).unwrap();
                let found = lattice.block(&weights, offset)[place(0)][place(1)].re;
                worst = worst.max((found - row[5].parse::<f64>().unwrap()).abs() / largest);
            }
        }
        let (mut sums, mut halfway) = (vec![[0.0; SERIES]; spectra[0].len()], vec![]);
        for lag in 1..=256 {
            for (sum, value) in sums.as_flattened_mut().iter_mut().zip(weights(lag).as_flattened())
            {
                *sum += value.re;
            }
            if lag == 128 {
                halfway.clone_from(&sums);
            }
        }
        let (still, _) = all(&lattice, &profile, Complex::default(), 1e-11);
        let rest = |sums: &[[f64; SERIES]], series: std::ops::Range<usize>| {
            let rows = sums.iter().zip(&still);
            let errors = rows.flat_map(|(sum, still)| {
                series.clone().map(move |kind| (sum[kind] - still[kind].re).abs())
            });
            errors.fold(0.0, f64::max) / still[0][1].re
        };
        let [even, odd] = [0..4, 4..6].map(|series| rest(&sums, series));
        let before = rest(&halfway, 4..6);
        println!("{}: lags {worst:.1e}, sum {even:.1e}, {odd:.1e} (128: {before:.1e})", rows[0][0]);
        assert!(worst < 1e-6, "{worst:e}");
        let gates = if layered { [5e-5, 5e-5] } else { [1e-7, 2e-5] };
        assert!(even < gates[0] && odd < gates[1], "{even:e} {odd:e}");
        // Shear and pressure forget each other like n⁻³.
        assert!(layered || (2.0..8.0).contains(&(before / odd)), "{before:e} {odd:e}");
    }
}
