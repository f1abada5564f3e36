//! Vibration of a clamped containment of shells, a cylinder under a hemisphere.

use std::f64::consts::{FRAC_PI_2, TAU};

use basemat::fem::{MassKind, Material};
use basemat_problems::supported::{CLAMPED_DIRECTIONS, ElementMatrix, Vibration};

use super::row::BenchmarkRows;
use super::surface::{ShellPattern, ShellSurface};
use crate::AnyError;

/// The shells, and the nodes of each ring.
struct ClampedContainment {
    surface: ShellSurface,
    rings: Vec<Vec<usize>>,
}

impl ClampedContainment {
    fn new([around, rows, dome]: [usize; 3], pattern: ShellPattern) -> Result<Self, AnyError> {
        let mut surface = ShellSurface::new(Material::new(32.0e9, 0.2, 2450.0)?, 1.2);
        let mut rings: Vec<Vec<usize>> = Vec::new();
        for ring in 0..rows + dome {
            let mut radius = 20.0;
            let mut height = 45.0 * ring as f64 / rows as f64;
            if ring > rows {
                let angle = FRAC_PI_2 * (ring - rows) as f64 / dome as f64;
                radius = 20.0 * angle.cos();
                height = 45.0 + 20.0 * angle.sin();
            }
            let mut nodes = Vec::new();
            for k in 0..around {
                let angle = TAU * k as f64 / around as f64;
                nodes.push(surface.scene.node([
                    radius * angle.cos(),
                    radius * angle.sin(),
                    height,
                ]));
            }
            rings.push(nodes);
        }
        let pole = surface.scene.node([0.0, 0.0, 65.0]);
        for ring in 0..rings.len() {
            let thickness = if ring < rows { 1.2 } else { 0.9 };
            for k in 0..around {
                let next_sector = (k + 1) % around;
                let a = rings[ring][k];
                let b = rings[ring][next_sector];
                match rings.get(ring + 1) {
                    Some(upper) => {
                        for corners in pattern.split([a, b, upper[next_sector], upper[k]]) {
                            surface.shell(&corners, thickness)?;
                        }
                    }
                    None => surface.shell(&[a, b, pole], thickness)?,
                }
            }
        }
        for &node in &rings[0] {
            surface.scene.fix(node, &CLAMPED_DIRECTIONS);
        }
        Ok(Self { surface, rings })
    }

    /// Power of the radial, tangential and vertical displacements with this number of waves around the axis.
    fn power(&self, mode: &Vibration, waves: usize) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for ring in &self.rings {
            let mut parts = [[0.0; 2]; 3];
            for (k, &node) in ring.iter().enumerate() {
                let angle = TAU * k as f64 / ring.len() as f64;
                let sine = angle.sin();
                let cosine = angle.cos();
                let [x, y, z, ..] = mode.shape[node];
                let cylindrical = [x * cosine + y * sine, y * cosine - x * sine, z];
                let phase = waves as f64 * angle;
                for (part, value) in parts.iter_mut().zip(cylindrical) {
                    part[0] += phase.cos() * value;
                    part[1] += phase.sin() * value;
                }
            }
            let factor = if waves == 0 { 1.0 } else { 2.0 };
            for (sum, [a, b]) in sums.iter_mut().zip(parts) {
                *sum += factor * (a * a + b * b);
            }
        }
        sums
    }

    /// The kind of a mode, from the number of waves with the greatest power.
    fn mode_kind(&self, mode: &Vibration) -> ModeKind {
        let mut kind = ModeKind { waves: 0, is_tangential: false };
        let mut largest_power = f64::NEG_INFINITY;
        for waves in 0..self.rings[0].len() / 2 {
            let power = self.power(mode, waves);
            let total: f64 = power.iter().sum();
            if total >= largest_power {
                largest_power = total;
                kind = ModeKind { waves, is_tangential: power[1] > 0.5 * total };
            }
        }
        kind
    }
}

/// Number of waves of a mode around the axis, and whether its motion is along the rings.
struct ModeKind {
    waves: usize,
    is_tangential: bool,
}

fn vibration(
    rows: &mut BenchmarkRows,
    counts @ [around, rings, dome]: [usize; 3],
    pattern: ShellPattern,
    kind: MassKind,
) -> Result<(), AnyError> {
    let shells = ClampedContainment::new(counts, pattern)?;
    let scene = &shells.surface.scene;
    let modes = scene.modes(kind, if around > 16 { 18 } else { 28 }, 0.0);
    let benchmark = "containment R=20 H=45 t=1.2/0.9";
    let mass = if kind == MassKind::Lumped { "lumped" } else { "consistent" };
    let element = if pattern == ShellPattern::Quadrilaterals { "" } else { ", Shell3 only" };
    let mesh = format!("{around}x({rings}+{dome}) {mass}{element}");
    let kinds: Vec<ModeKind> = modes.iter().map(|mode| shells.mode_kind(mode)).collect();
    for waves in 1..=5 {
        if let Some(mode) = kinds.iter().position(|kind| kind.waves == waves) {
            rows.put(benchmark, &format!("n={waves} (pair)"), &mesh, modes[mode].frequency);
        }
    }
    let breathing = kinds.iter().position(|kind| kind.waves == 0 && !kind.is_tangential);
    if let Some(mode) = breathing.filter(|_| element.is_empty()) {
        rows.put(benchmark, "n=0 breathing or vertical", &mesh, modes[mode].frequency);
    }
    if let Some(mode) = kinds.iter().position(|kind| kind.waves == 0 && kind.is_tangential) {
        rows.put(benchmark, "torsion", &mesh, modes[mode].frequency);
    }
    let along_x = vec![[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]; scene.mesh.nodes().len()];
    let part = ElementMatrix::Mass(kind);
    let total_mass = scene.form(part, &along_x, &along_x);
    rows.put(benchmark, "mass, kg", &mesh, total_mass);
    let first_pair = kinds.iter().zip(&modes).filter(|(kind, _)| kind.waves == 1).take(2);
    let mass_fraction: f64 = first_pair
        .map(|(_, mode)| {
            let participation = scene.form(part, &mode.shape, &along_x);
            let modal_mass = scene.form(part, &mode.shape, &mode.shape);
            participation * participation / modal_mass / total_mass
        })
        .sum();
    rows.put(benchmark, "share of mass in x and y of the first n=1 pair", &mesh, mass_fraction);
    Ok(())
}

pub(super) fn run(rows: &mut BenchmarkRows, short: bool) -> Result<(), AnyError> {
    let quads = ShellPattern::Quadrilaterals;
    for counts in [[16, 8, 5], [24, 12, 8], [32, 16, 10], [48, 24, 15], [64, 32, 20]] {
        let sectors = counts[0];
        if short && sectors > 16 {
            break;
        }
        vibration(rows, counts, quads, MassKind::Consistent)?;
        if sectors == 24 || sectors == 48 {
            vibration(rows, counts, quads, MassKind::Lumped)?;
        }
        if sectors == 32 || sectors == 48 {
            vibration(rows, counts, ShellPattern::Rising, MassKind::Consistent)?;
        }
    }
    Ok(())
}
