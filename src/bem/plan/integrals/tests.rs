//! Tests of the compliances of cells against a table, plain sums and limits.

use std::f64::consts::PI;

use basemat_fourier::num_complex::Complex64;

use super::super::forms::{AngularMeans, integrals};
use super::*;
use crate::bem::layered::test_profiles::{gmb, p1};
use crate::geometry::offset;
use crate::linalg::gauss::Rule;
use crate::soil::Soil;

/// Compliances, and the number of evaluations of the ground.
struct CellCompliances {
    values: Vec<[Complex; COMPLIANCES_PER_OFFSET]>,
    /// Number of wavenumbers at which the ground was evaluated.
    evaluation_count: usize,
}

fn compliances(
    lattice: &Lattice,
    profile: &SoilProfile,
    s: Complex,
    tolerance: f64,
) -> CellCompliances {
    let mut progress = ProgressReporter::unobserved();
    let integrals = CellIntegrals::new(lattice, profile, [s], tolerance, &mut progress).unwrap();
    let mut workspace = CellWorkspace::default();
    let mut values =
        vec![[Complex::default(); COMPLIANCES_PER_OFFSET]; integrals.table.class_count];
    integrals.compliance(profile, s, &mut workspace, &mut values).unwrap();
    CellCompliances { values, evaluation_count: workspace.panels.evaluation_count }
}

/// Complex number in the first two columns of a row.
fn complex_number(row: &[&str]) -> Complex {
    Complex::new(row[0].parse().unwrap(), row[1].parse().unwrap())
}

fn half_space() -> SoilProfile {
    SoilProfile::on_half_plane(Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap())
}

/// The values of `compliance_4x4.csv` are from another program, and accurate to about 1e-8.
#[test]
fn agrees_with_the_table_of_sixteen_cells() {
    let lattice = Lattice { pitch: [0.5; 2], counts: [4, 4] };
    let table = include_str!("../../../../tests/data/plan/compliance_4x4.csv");
    let mut max_errors = [0.0_f64; 2];
    let rows: Vec<Vec<&str>> = table.lines().skip(2).map(|l| l.split(',').collect()).collect();
    for group in rows.chunk_by(|a, b| a[..3] == b[..3]) {
        let is_layered = group[0][0] == "layer_rock";
        let profile = if is_layered { p1(gmb(5), gmb(1)) } else { half_space() };
        let s = complex_number(&group[0][1..]);
        let CellCompliances { values, evaluation_count } =
            compliances(&lattice, &profile, s, 1e-10);
        let max_compliance = lattice.block(&values, [0, 0])[1][1].abs();
        let mut errors = [0.0_f64; COMPLIANCES_PER_OFFSET];
        for row in group {
            let i = row[4].parse::<isize>().unwrap();
            let j = row[5].parse::<isize>().unwrap();
            let block = lattice.block(&values, [i, j]);
            let mut components = row[3].chars().map(|letter| "zxy".find(letter).unwrap());
            let receiver = components.next().unwrap();
            let source = components.next().unwrap();
            let expected = complex_number(&row[6..]);
            let error = (block[receiver][source] - expected).abs() / max_compliance;
            let series = (2 * receiver + source).min(5);
            errors[series] = errors[series].max(error);
            let profile_error = &mut max_errors[usize::from(is_layered)];
            *profile_error = profile_error.max(error);
        }
        println!("{} {s:?} {errors:?} {evaluation_count}", group[0][0]);
    }
    println!("{max_errors:?}");
    assert!(max_errors[0].max(max_errors[1]) < 1e-8, "{max_errors:?}");
}

/// Largest difference, relative to the first compliance along x.
fn largest_difference(
    expected: &[[Complex; COMPLIANCES_PER_OFFSET]],
    computed: &[[Complex; COMPLIANCES_PER_OFFSET]],
) -> f64 {
    let pairs = expected.as_flattened().iter().zip(computed.as_flattened());
    pairs.map(|(a, b)| (*a - *b).abs()).fold(0.0, f64::max) / expected[0][1].abs()
}

/// Layers of equal soil have the compliance of a half-space, with other limits of integrals and tails.
#[test]
fn equal_layers_are_a_half_space() {
    let soil = Soil::new(1.0, 0.3, 1.0).unwrap();
    let half_space = SoilProfile::on_half_plane(soil);
    let lattice = Lattice { pitch: [0.5, 0.4], counts: [4, 3] };
    for s in
        [Complex::new(0.2, 1.5), Complex::new(3.0, 8.0), Complex::real(12.0), Complex::default()]
    {
        let expected = compliances(&lattice, &half_space, s, 1e-11).values;
        for thickness in [0.25, 3.0] {
            let layered = half_space.clone().with_layer(soil, thickness).unwrap();
            let computed =
                compliances(&lattice, &layered.with_layer(soil, 0.6).unwrap(), s, 1e-11).values;
            let error = largest_difference(&expected, &computed);
            println!("{s:?} {thickness} {error:e}");
            assert!(error < 2e-9, "{s:?} {thickness} {error:e}");
        }
    }
}

/// Compliances of short waves agree with plain sums up to a far wavenumber, plus static integrals in closed form.
#[test]
fn compliances_of_short_waves_agree_with_plain_sums() {
    let lattice = Lattice { pitch: [0.5, 0.4], counts: [2, 1] };
    let rule = Rule::new(16);
    let width = 8.0;
    let panel_count = 750;
    for (profile, s) in [
        (half_space(), Complex::real(30.0)),
        (half_space(), Complex::new(12.0, 25.0)),
        (p1(gmb(5), gmb(1)), Complex::new(10.0, 40.0)),
    ] {
        let computed = compliances(&lattice, &profile, s, 3e-12).values;
        let mut ground = LayeredCompliance::default();
        ground.set(&profile, s).unwrap();
        let top = ground.top();
        let a2 = top.a2;
        let top_compliance = top.modulus.inverse();
        // Static compliances zz, rr, tt and zr, times k.
        let static_kernel =
            [1.0, 1.0, 2.0 - 2.0 * a2, -a2].map(|d| top_compliance.scale(0.5 * d / (1.0 - a2)));
        let mut expected = vec![[Complex::default(); COMPLIANCES_PER_OFFSET]; computed.len()];
        for (series, offset) in expected.iter_mut().zip(lattice.classes()) {
            add_products(series, static_kernel, integrals(lattice.pitch, offset));
        }
        let mut means = AngularMeans::new(&lattice);
        for panel in 0..panel_count {
            for (x, weight) in rule.points_on_unit_interval() {
                let k = width * (f64::from(panel) + x);
                let SurfaceCompliance { xx, zz, xz } = ground.at(k);
                let compliances_at_k = [zz, xx, ground.transverse(), xz];
                let kernel: CellKernel = std::array::from_fn(|i| {
                    (compliances_at_k[i].scale(k) - static_kernel[i]).scale(width * weight)
                });
                let forms = means.at(k);
                for (class, series) in expected.iter_mut().enumerate() {
                    add_products(
                        series,
                        kernel,
                        std::array::from_fn(|form| forms[form * computed.len() + class]),
                    );
                }
            }
        }
        let error = largest_difference(&computed, &expected);
        println!("{s:?} {error:e}");
        assert!(error < 3e-10, "{s:?} {error:e}");
    }
}

/// Adds kernel × forms/2π to the six series.
fn add_products(
    sums: &mut [Complex; COMPLIANCES_PER_OFFSET],
    [zz, rr, tt, zr]: CellKernel,
    forms: [f64; FORM_COUNT],
) {
    let [g_0, g_cc, g_ss, g_cs, g_c, g_s] = forms.map(|form| 0.5 * form / PI);
    sums[0] += zz.scale(g_0);
    sums[1] += rr.scale(g_cc) + tt.scale(g_ss);
    sums[2] += rr.scale(g_ss) + tt.scale(g_cc);
    sums[3] += (rr - tt).scale(g_cs);
    sums[4] += zr.scale(-g_c);
    sums[5] += zr.scale(-g_s);
}

/// Compliances of slow motions tend to the static compliances.
#[test]
fn statics_are_the_limit_of_slow_motions() {
    let lattice = Lattice { pitch: [0.5; 2], counts: [5, 3] };
    let profile = p1(gmb(5), gmb(1));
    let static_values = compliances(&lattice, &profile, Complex::default(), 1e-11).values;
    let slow_values = compliances(&lattice, &profile, Complex::real(1e-6), 1e-11).values;
    let error = largest_difference(&static_values, &slow_values);
    assert!(error < 1e-5, "{error:e}");
    assert!(static_values.as_flattened().iter().all(|value| value.im == 0.0));
}

/// Matrix factor × F of all cells.
fn assembled(
    lattice: &Lattice,
    values: &[[Complex; COMPLIANCES_PER_OFFSET]],
    factor: Complex,
) -> Vec<Complex64> {
    let cell_count = lattice.counts[0] * lattice.counts[1];
    let cells: Vec<_> =
        (0..cell_count).map(|n| [n % lattice.counts[0], n / lattice.counts[0]]).collect();
    let order = 3 * cell_count;
    let mut matrix = vec![Complex64::default(); order * order];
    for receiver in 0..cell_count {
        for source in 0..cell_count {
            let offset = offset(cells[receiver], cells[source]);
            for (i, row) in lattice.block(values, offset).into_iter().enumerate() {
                for (j, value) in row.into_iter().enumerate() {
                    matrix[(3 * receiver + i) * order + 3 * source + j] =
                        (factor * value).to_complex64();
                }
            }
        }
    }
    matrix
}

/// Herm(sF) ≥ 0 for Re s > 0, for random layers, damping and lattices; masks and unions then follow by congruence.
#[test]
fn mobility_is_passive() {
    let mut random = RandomNumbers(7);
    let mut min_ratio = f64::INFINITY;
    for case in 0..200 {
        let mut profile = if case % 4 == 0 {
            SoilProfile::on_rigid_bedrock()
        } else {
            SoilProfile::on_half_plane(random.soil())
        };
        for layer in 0..=case % 3 {
            let soil = random.soil();
            profile = profile.with_layer(soil, random.between(0.3, 3.0)).unwrap();
            if (case + layer) % 2 == 0 {
                profile = profile.with_damping(gmb(5));
            }
        }
        let pitch = [0.5, if case % 2 == 0 { 0.5 } else { random.between(0.25, 1.0) }];
        let lattice = Lattice { pitch, counts: [2 + case % 3, 1 + case % 4] };
        let s = Complex::new(random.between(0.02, 5.0), random.between(0.02, 20.0));
        let values = compliances(&lattice, &profile, s, 1e-11).values;
        let matrix = assembled(&lattice, &values, s);
        let order = 3 * lattice.counts[0] * lattice.counts[1];
        let eigenvalues = crate::linalg::hermitian_range(&matrix, order).unwrap();
        min_ratio = min_ratio.min(eigenvalues[0] / eigenvalues[1]);
        assert!(eigenvalues[0] > -1e-10 * eigenvalues[1], "{case} {s:?} {eigenvalues:?}");
    }
    println!("smallest/largest {min_ratio:e}");
    assert!(min_ratio > 0.0);
}

/// Random numbers of a linear congruential generator (Knuth, MMIX).
struct RandomNumbers(u64);

impl RandomNumbers {
    /// Number between two bounds, with a uniform distribution of its logarithm.
    fn between(&mut self, min: f64, max: f64) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        min * (max / min).powf((self.0 >> 11) as f64 / (1_u64 << 53) as f64)
    }

    fn soil(&mut self) -> Soil {
        let modulus = self.between(0.1, 10.0);
        let poisson = self.between(0.05, 0.49);
        Soil::new(modulus, poisson, self.between(0.8, 1.25)).unwrap()
    }
}
