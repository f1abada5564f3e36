//! All P and SV waves of one layer on a half-plane, solved at once: a reference for inclined waves.

use basemat::site::InclinedWave;
use basemat::soil::{Relaxation, SoilProfile};
use basemat::{Complex, Result, Soil};

/// P or SV waves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum BodyWave {
    P,
    Sv,
}

pub(super) const BODY_WAVES: [BodyWave; 2] = [BodyWave::Sv, BodyWave::P];

pub(super) fn inclined(wave: BodyWave, profile: SoilProfile, angle: f64) -> Result<InclinedWave> {
    match wave {
        BodyWave::Sv => InclinedWave::sv(profile, angle),
        BodyWave::P => InclinedWave::p(profile, angle),
    }
}

/// Displacements (x, z) and stresses (xz, zz)/s of one wave at a depth.
type WaveState = [Complex; 4];

/// P and SV waves of a soil, down and up, of horizontal slowness p.
pub(super) struct SoilWaves {
    lambda: Complex,
    mu: Complex,
    p: f64,
    /// Vertical slownesses of P and SV.
    pub(super) vertical_slownesses: [Complex; 2],
    /// 1/c of P and SV.
    pub(super) total_slownesses: [Complex; 2],
}

impl SoilWaves {
    pub(super) fn new(soil: Soil, law: &dyn Relaxation, p: f64, s: Complex) -> Self {
        let mu = law.modulus(s) * soil.shear_modulus();
        let lambda = mu * (2.0 * soil.poisson() / (1.0 - 2.0 * soil.poisson()));
        let total_slownesses =
            [lambda + mu * 2.0, mu].map(|modulus| (Complex::real(soil.density()) / modulus).sqrt());
        let vertical_slownesses = total_slownesses.map(|total| {
            let root = (total * total - Complex::real(p * p)).sqrt();
            if (s * root).re < -1e-12 * (s * root).abs() { -root } else { root }
        });
        Self { lambda, mu, p, vertical_slownesses, total_slownesses }
    }

    /// A wave of unit amplitude, at depth z below its origin.
    fn state(&self, wave: BodyWave, is_upward: bool, s: Complex, z: f64) -> WaveState {
        let kind = usize::from(wave == BodyWave::Sv);
        let slowness = self.vertical_slownesses[kind];
        let q = if is_upward { -slowness } else { slowness };
        // P waves move along (p, q), SV waves normal to it and to the right.
        let direction = match wave {
            BodyWave::P => [Complex::real(self.p), q],
            BodyWave::Sv if is_upward => [slowness, Complex::real(self.p)],
            BodyWave::Sv => [slowness, -Complex::real(self.p)],
        };
        self.state_of_plane_wave(direction.map(|x| x / self.total_slownesses[kind]), q, s, z)
    }

    /// A wave d e^(s(t − px − qz)) by Hooke's law, up to the factor of t and x.
    fn state_of_plane_wave(&self, d: [Complex; 2], q: Complex, s: Complex, z: f64) -> WaveState {
        let dilatation = -(d[0] * self.p + q * d[1]);
        let shear = -(self.mu * (q * d[0] + d[1] * self.p));
        let normal = self.lambda * dilatation - self.mu * q * d[1] * 2.0;
        let phase = (s * q * -z).exp();
        [d[0], d[1], shear, normal].map(|x| x * phase)
    }
}

/// Gauss–Jordan elimination with pivots of a matrix whose last column is the right-hand side.
fn solve(mut matrix: Vec<Vec<Complex>>) -> Vec<Complex> {
    let n = matrix.len();
    for k in 0..n {
        let pivot =
            (k..n).max_by(|&i, &j| matrix[i][k].abs().total_cmp(&matrix[j][k].abs())).unwrap();
        matrix.swap(k, pivot);
        for i in (0..n).filter(|&i| i != k) {
            let factor = matrix[i][k] / matrix[k][k];
            for j in k..=n {
                let change = factor * matrix[k][j];
                matrix[i][j] = matrix[i][j] - change;
            }
        }
    }
    (0..n).map(|i| matrix[i][n] / matrix[i][i]).collect()
}

/// A layer on a half-plane, at one s and p.
pub(super) struct LayerOnHalfPlane {
    pub(super) layer: SoilWaves,
    pub(super) base: SoilWaves,
    pub(super) height: f64,
    pub(super) s: Complex,
}

impl LayerOnHalfPlane {
    /// Down- and upward waves of the layer; upward waves have their origin at its bottom.
    fn layer_states(&self, z: f64) -> [WaveState; 4] {
        let below_bottom = z - self.height;
        [
            self.layer.state(BodyWave::P, false, self.s, z),
            self.layer.state(BodyWave::Sv, false, self.s, z),
            self.layer.state(BodyWave::P, true, self.s, below_bottom),
            self.layer.state(BodyWave::Sv, true, self.s, below_bottom),
        ]
    }

    /// Surface displacements (x, up) under surface stresses (xz, zz)/s and an incident wave at the bottom of the layer.
    ///
    /// Six unknown waves: four in the layer, two that leave it downwards.
    pub(super) fn surface(&self, load: [Complex; 2], incident: Option<BodyWave>) -> [Complex; 2] {
        let top = self.layer_states(0.0);
        let bottom = self.layer_states(self.height);
        let refracted =
            [BodyWave::P, BodyWave::Sv].map(|wave| self.base.state(wave, false, self.s, 0.0));
        let incident = incident
            .map_or([Complex::default(); 4], |wave| self.base.state(wave, true, self.s, 0.0));
        // Stresses are divided by the soil's impedance, so that all rows have similar size.
        let impedance = self.layer.mu.abs() * self.layer.total_slownesses[1].abs();
        let mut matrix = vec![];
        for row in 2..4 {
            let mut equation: Vec<_> =
                top.iter().map(|wave| wave[row] * (1.0 / impedance)).collect();
            equation.extend([Complex::default(); 2]);
            equation.push(load[row - 2] * (1.0 / impedance));
            matrix.push(equation);
        }
        for row in 0..4 {
            let scale = if row < 2 { 1.0 } else { 1.0 / impedance };
            let mut equation: Vec<_> = bottom.iter().map(|wave| wave[row] * scale).collect();
            equation.extend(refracted.iter().map(|wave| wave[row] * -scale));
            equation.push(incident[row] * scale);
            matrix.push(equation);
        }
        let amplitudes = solve(matrix);
        let mut surface = [Complex::default(); 2];
        for (wave, amplitude) in top.iter().zip(&amplitudes) {
            surface[0] += wave[0] * *amplitude;
            surface[1] += -(wave[1] * *amplitude);
        }
        surface
    }
}
