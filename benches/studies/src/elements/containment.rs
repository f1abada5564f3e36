//! Vibration of a clamped containment of shells, a cylinder under a hemisphere.

use std::f64::consts::{FRAC_PI_2, TAU};

use basemat::fem::{MassKind, Material};
use basemat_problems::supported::{CLAMPED, Part, Vibration};

use super::row::Rows;
use super::surface::{Pattern, Surface};
use crate::AnyError;

/// The shells, and the nodes of each ring.
struct Containment {
    surface: Surface,
    rings: Vec<Vec<usize>>,
}

impl Containment {
    fn new([around, rows, dome]: [usize; 3], pattern: Pattern) -> Result<Self, AnyError> {
        let mut surface = Surface::new(Material::new(32.0e9, 0.2, 2450.0)?, 1.2);
        let mut rings: Vec<Vec<usize>> = Vec::new();
        for ring in 0..rows + dome {
            let (radius, height) = if ring <= rows {
                (20.0, 45.0 * ring as f64 / rows as f64)
            } else {
                let (sine, cosine) = (FRAC_PI_2 * (ring - rows) as f64 / dome as f64).sin_cos();
                (20.0 * cosine, 45.0 + 20.0 * sine)
            };
            let mut node = |k| {
                let (sine, cosine) = (TAU * k as f64 / around as f64).sin_cos();
                surface.scene.node([radius * cosine, radius * sine, height])
            };
            rings.push((0..around).map(&mut node).collect());
        }
        let pole = surface.scene.node([0.0, 0.0, 65.0]);
        for ring in 0..rings.len() {
            let thickness = if ring < rows { 1.2 } else { 0.9 };
            for k in 0..around {
                let next = (k + 1) % around;
                let [a, b] = [rings[ring][k], rings[ring][next]];
                match rings.get(ring + 1) {
                    Some(upper) => {
                        for corners in pattern.split([a, b, upper[next], upper[k]]) {
                            surface.shell(&corners, thickness)?;
                        }
                    }
                    None => surface.shell(&[a, b, pole], thickness)?,
                }
            }
        }
        for &node in &rings[0] {
            surface.scene.hold(node, &CLAMPED);
        }
        Ok(Self { surface, rings })
    }

    /// Number of waves around the axis, and whether the motion is along the rings.
    fn waves(&self, mode: &Vibration) -> (usize, bool) {
        let around = self.rings[0].len();
        let power = |waves: usize| {
            let mut sums = [0.0; 3];
            for ring in &self.rings {
                let mut parts = [[0.0; 2]; 3];
                for (k, &node) in ring.iter().enumerate() {
                    let angle = TAU * k as f64 / around as f64;
                    let (sine, cosine) = angle.sin_cos();
                    let [x, y, z, ..] = mode.shape[node];
                    let own = [x * cosine + y * sine, y * cosine - x * sine, z];
                    let (sine, cosine) = (waves as f64 * angle).sin_cos();
                    for (part, value) in parts.iter_mut().zip(own) {
                        part[0] += cosine * value;
                        part[1] += sine * value;
                    }
                }
                let factor = if waves == 0 { 1.0 } else { 2.0 };
                for (sum, [a, b]) in sums.iter_mut().zip(parts) {
                    *sum += factor * (a * a + b * b);
                }
            }
            sums
        };
        let powers: Vec<[f64; 3]> = (0..around / 2).map(power).collect();
        let whole = |waves: &usize| powers[*waves].iter().sum::<f64>();
        let most = (0..powers.len()).max_by(|a, b| whole(a).total_cmp(&whole(b))).unwrap_or(0);
        (most, powers[most][1] > 0.5 * whole(&most))
    }
}

fn vibration(
    rows: &mut Rows,
    counts: [usize; 3],
    pattern: Pattern,
    kind: MassKind,
) -> Result<(), AnyError> {
    let shells = Containment::new(counts, pattern)?;
    let scene = &shells.surface.scene;
    let [around, rings, dome] = counts;
    let modes = scene.modes(kind, if around > 16 { 18 } else { 28 }, 0.0);
    let benchmark = "containment R=20 H=45 t=1.2/0.9";
    let mass = if kind == MassKind::Lumped { "lumped" } else { "consistent" };
    let only = if pattern == Pattern::Quadrilaterals { "" } else { ", Shell3 only" };
    let mesh = format!("{around}x({rings}+{dome}) {mass}{only}");
    let kinds: Vec<(usize, bool)> = modes.iter().map(|mode| shells.waves(mode)).collect();
    let first = |wanted: (usize, Option<bool>)| {
        let fits = |own: &(usize, bool)| own.0 == wanted.0 && wanted.1.is_none_or(|is| is == own.1);
        kinds.iter().position(fits)
    };
    for waves in 1..=5 {
        if let Some(mode) = first((waves, None)) {
            rows.put(benchmark, &format!("n={waves} (pair)"), &mesh, modes[mode].frequency);
        }
    }
    if let Some(mode) = first((0, Some(false))).filter(|_| only.is_empty()) {
        rows.put(benchmark, "n=0 breathing or vertical", &mesh, modes[mode].frequency);
    }
    if let Some(mode) = first((0, Some(true))) {
        rows.put(benchmark, "torsion", &mesh, modes[mode].frequency);
    }
    let along_x = vec![[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]; scene.mesh.nodes().len()];
    let part = Part::Mass(kind);
    let whole = scene.form(part, &along_x, &along_x);
    rows.put(benchmark, "mass, kg", &mesh, whole);
    let pair = kinds.iter().zip(&modes).filter(|((waves, _), _)| *waves == 1).take(2);
    let share: f64 = pair
        .map(|(_, mode)| {
            let own = scene.form(part, &mode.shape, &along_x);
            own * own / scene.form(part, &mode.shape, &mode.shape) / whole
        })
        .sum();
    rows.put(benchmark, "share of mass in x and y of the first n=1 pair", &mesh, share);
    Ok(())
}

pub(super) fn run(rows: &mut Rows, short: bool) -> Result<(), AnyError> {
    let quads = Pattern::Quadrilaterals;
    for counts in [[16, 8, 5], [24, 12, 8], [32, 16, 10], [48, 24, 15], [64, 32, 20]] {
        let [around, ..] = counts;
        if short && around > 16 {
            break;
        }
        vibration(rows, counts, quads, MassKind::Consistent)?;
        if around == 24 || around == 48 {
            vibration(rows, counts, quads, MassKind::Lumped)?;
        }
        if around == 32 || around == 48 {
            vibration(rows, counts, Pattern::Rising, MassKind::Consistent)?;
        }
    }
    Ok(())
}
