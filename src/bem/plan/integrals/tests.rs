//! Compliances of cells against a table and themselves.

use std::f64::consts::PI;

use basemat_fourier::num_complex::Complex64;

use super::super::forms::{AngularMeans, integrals};
use super::*;
use crate::bem::layered::test_profiles::{gmb, p1};
use crate::geometry::offset;
use crate::linalg::gauss::Rule;
use crate::soil::Soil;

/// Compliances, and what they cost.
struct CellCompliances {
    values: Vec<[Complex; SERIES_PER_OFFSET]>,
    /// Number of wavenumbers at which the ground was evaluated.
    evaluations: usize,
}

fn compliances(
    lattice: &Lattice,
    profile: &SoilProfile,
    s: Complex,
    tolerance: f64,
) -> CellCompliances {
    let mut progress = ProgressReporter::unobserved();
    let integrals = CellIntegrals::new(lattice, profile, [s], tolerance, &mut progress).unwrap();
    let mut work = CellWorkspace::default();
    let mut values = vec![[Complex::default(); SERIES_PER_OFFSET]; integrals.table.classes];
    integrals.compliance(profile, s, &mut work, &mut values).unwrap();
    CellCompliances { values, evaluations: work.panels.evaluations }
}

/// The complex number in the first two columns.
fn number(row: &[&str]) -> Complex {
    Complex::new(row[0].parse().unwrap(), row[1].parse().unwrap())
}

fn half_space() -> SoilProfile {
    SoilProfile::on_half_plane(Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap())
}

/// `compliance_4x4.csv` is from another program, accurate to about 1e-8.
#[test]
fn agrees_with_the_table_of_sixteen_cells() {
    let lattice = Lattice { pitch: [0.5; 2], counts: [4, 4] };
    let table = include_str!("../../../../tests/data/plan/compliance_4x4.csv");
    let mut worst = [0.0_f64; 2];
    let rows: Vec<Vec<&str>> = table.lines().skip(2).map(|l| l.split(',').collect()).collect();
    for group in rows.chunk_by(|a, b| a[..3] == b[..3]) {
        let layered = group[0][0] == "layer_rock";
        let profile = if layered { p1(gmb(5), gmb(1)) } else { half_space() };
        let s = number(&group[0][1..]);
        let CellCompliances { values, evaluations } = compliances(&lattice, &profile, s, 1e-10);
        let largest = lattice.block(&values, [0, 0])[1][1].abs();
        let mut errors = [0.0_f64; SERIES_PER_OFFSET];
        for row in group {
            let i = row[4].parse::<isize>().unwrap();
            let j = row[5].parse::<isize>().unwrap();
            let block = lattice.block(&values, [i, j]);
            let mut components = row[3].chars().map(|letter| "zxy".find(letter).unwrap());
            let to = components.next().unwrap();
            let from = components.next().unwrap();
            let wanted = number(&row[6..]);
            let error = (block[to][from] - wanted).abs() / largest;
            let pair = (2 * to + from).min(5);
            errors[pair] = errors[pair].max(error);
            worst[usize::from(layered)] = worst[usize::from(layered)].max(error);
        }
        println!("{} {s:?} {errors:?} {evaluations}", group[0][0]);
    }
    println!("{worst:?}");
    assert!(worst[0].max(worst[1]) < 1e-8, "{worst:?}");
}

fn largest_difference(
    one: &[[Complex; SERIES_PER_OFFSET]],
    two: &[[Complex; SERIES_PER_OFFSET]],
) -> f64 {
    let pairs = one.as_flattened().iter().zip(two.as_flattened());
    pairs.map(|(one, two)| (*one - *two).abs()).fold(0.0, f64::max) / one[0][1].abs()
}

/// A half-space cut into layers has the same compliance, although its integrals end and its tail begins elsewhere.
#[test]
fn cut_half_space_is_whole() {
    let soil = Soil::new(1.0, 0.3, 1.0).unwrap();
    let one = SoilProfile::on_half_plane(soil);
    let lattice = Lattice { pitch: [0.5, 0.4], counts: [4, 3] };
    for s in
        [Complex::new(0.2, 1.5), Complex::new(3.0, 8.0), Complex::real(12.0), Complex::default()]
    {
        let wanted = compliances(&lattice, &one, s, 1e-11).values;
        for thickness in [0.25, 3.0] {
            let cut = one.clone().with_layer(soil, thickness).unwrap();
            let found = compliances(&lattice, &cut.with_layer(soil, 0.6).unwrap(), s, 1e-11).values;
            let error = largest_difference(&wanted, &found);
            println!("{s:?} {thickness} {error:e}");
            assert!(error < 2e-9, "{s:?} {thickness} {error:e}");
        }
    }
}

/// Short waves: panels up to a far wavenumber and a static rest in closed form, without tables, tails or halved panels.
#[test]
fn compliances_of_short_waves_are_plain_sums() {
    let lattice = Lattice { pitch: [0.5, 0.4], counts: [2, 1] };
    let rule = Rule::new(16);
    let width = 8.0;
    let panels = 750;
    for (profile, s) in [
        (half_space(), Complex::real(30.0)),
        (half_space(), Complex::new(12.0, 25.0)),
        (p1(gmb(5), gmb(1)), Complex::new(10.0, 40.0)),
    ] {
        let found = compliances(&lattice, &profile, s, 3e-12).values;
        let mut ground = LayeredCompliance::default();
        ground.set(&profile, s).unwrap();
        let top = ground.top();
        let a2 = top.a2;
        let unit = top.modulus.inverse();
        // zz, rr, tt and zr at rest, times k.
        let rest = [1.0, 1.0, 2.0 - 2.0 * a2, -a2].map(|d| unit.scale(0.5 * d / (1.0 - a2)));
        let mut wanted = vec![[Complex::default(); SERIES_PER_OFFSET]; found.len()];
        for (wanted, offset) in wanted.iter_mut().zip(lattice.classes()) {
            add_products(wanted, rest, integrals(lattice.pitch, offset));
        }
        let mut means = AngularMeans::new(&lattice);
        for panel in 0..panels {
            for (x, weight) in rule.points_on_unit_interval() {
                let k = width * (f64::from(panel) + x);
                let SurfaceCompliance { xx, zz, xz } = ground.at(k);
                let dynamic = [zz, xx, ground.across(), xz];
                let kernel: CellKernel =
                    std::array::from_fn(|i| (dynamic[i].scale(k) - rest[i]).scale(width * weight));
                let forms = means.at(k);
                for (class, wanted) in wanted.iter_mut().enumerate() {
                    add_products(
                        wanted,
                        kernel,
                        std::array::from_fn(|form| forms[form * found.len() + class]),
                    );
                }
            }
        }
        let error = largest_difference(&found, &wanted);
        println!("{s:?} {error:e}");
        assert!(error < 3e-10, "{s:?} {error:e}");
    }
}

/// Adds kernel × forms/2π to the six series.
fn add_products(
    sums: &mut [Complex; SERIES_PER_OFFSET],
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

/// Slow motions tend to the static values, and a layer is stiffer than a half-space.
#[test]
fn statics_are_the_limit_of_slow_motions() {
    let lattice = Lattice { pitch: [0.5; 2], counts: [5, 3] };
    let profile = p1(gmb(5), gmb(1));
    let still = compliances(&lattice, &profile, Complex::default(), 1e-11).values;
    let slow = compliances(&lattice, &profile, Complex::real(1e-6), 1e-11).values;
    let error = largest_difference(&still, &slow);
    assert!(error < 1e-5, "{error:e}");
    assert!(still.as_flattened().iter().all(|value| value.im == 0.0));
}

/// All cells: factor × F.
fn assembled(
    lattice: &Lattice,
    values: &[[Complex; SERIES_PER_OFFSET]],
    factor: Complex,
) -> Vec<Complex64> {
    let count = lattice.counts[0] * lattice.counts[1];
    let cells: Vec<_> =
        (0..count).map(|n| [n % lattice.counts[0], n / lattice.counts[0]]).collect();
    let order = 3 * count;
    let mut matrix = vec![Complex64::default(); order * order];
    for p in 0..count {
        for q in 0..count {
            let offset = offset(cells[p], cells[q]);
            for (i, row) in lattice.block(values, offset).into_iter().enumerate() {
                for (j, value) in row.into_iter().enumerate() {
                    matrix[(3 * p + i) * order + 3 * q + j] = (factor * value).inner();
                }
            }
        }
    }
    matrix
}

/// Herm(sF) ≥ 0 for Re s > 0: random layers, damping, lattices; for masks and unions it is a congruence.
#[test]
fn mobility_is_passive() {
    let mut random = RandomNumbers(7);
    let mut smallest_ratio = f64::INFINITY;
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
        smallest_ratio = smallest_ratio.min(eigenvalues[0] / eigenvalues[1]);
        assert!(eigenvalues[0] > -1e-10 * eigenvalues[1], "{case} {s:?} {eigenvalues:?}");
    }
    println!("smallest/largest {smallest_ratio:e}");
    assert!(smallest_ratio > 0.0);
}

/// Random numbers of a linear congruential generator (Knuth, MMIX).
struct RandomNumbers(u64);

impl RandomNumbers {
    /// Number with an even distribution of its logarithm.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        low * (high / low).powf((self.0 >> 11) as f64 / (1_u64 << 53) as f64)
    }

    fn soil(&mut self) -> Soil {
        let modulus = self.between(0.1, 10.0);
        let poisson = self.between(0.05, 0.49);
        Soil::new(modulus, poisson, self.between(0.8, 1.25)).unwrap()
    }
}
