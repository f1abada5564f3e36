//! A rigid rectangle that rocks without inertia on strips of soil that settle in every cycle, above an elastic half-space.
//!
//! Strips run across the base, and each has a uniform pressure. Love's solution (1929), averaged over each strip, is their
//! elastic displacement; the settlement of each strip adds to it. The base has a constant weight, and its rotation is
//! prescribed.

use std::f64::consts::PI;

use crate::settling_law::SettlingLaw;

/// Points along each side of a strip over which its displacement is averaged.
const SAMPLE_COUNT: usize = 16;
/// Bound of the sweeps over all strips.
const MAX_RELAXATION_SWEEPS: usize = 2000;
/// Change of a pressure at which the sweeps end, relative to the initial capacity.
const PRESSURE_TOLERANCE: f64 = 1e-9;
/// Vertical force out of balance at which the search for the settlement ends, relative to the weight.
const FORCE_TOLERANCE: f64 = 1e-7;

/// The base: length along the rotation and width, m; weight, N.
#[derive(Debug, Clone, Copy)]
pub struct RockingBase {
    pub length: f64,
    pub width: f64,
    pub weight: f64,
}

/// Strips under the base, and its last position.
pub struct SettlingStrips {
    base: RockingBase,
    law: SettlingLaw,
    middles: Vec<f64>,
    /// Displacement of each strip by a unit pressure on each, m/Pa, row by row.
    compliance: Vec<f64>,
    levels: Vec<f64>,
    thresholds: Vec<f64>,
    pressures: Vec<f64>,
    /// Settlement of the middle of the base, m.
    pub settlement: f64,
}

/// ∬ dA/r over a rectangle from a corner at the origin to (a, b).
fn corner_integral(a: f64, b: f64) -> f64 {
    let r = a.hypot(b);
    let term = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a * ((b + r) / a.abs()).ln() };
    term(a, b) + term(b, a)
}

/// Mean over a rectangle of ∬ dA/r over another one of the same `sides`, at a distance along the first side.
fn mean_integral(distance: f64, sides: [f64; 2]) -> f64 {
    let points = (0..SAMPLE_COUNT).map(|k| (k as f64 + 0.5) / SAMPLE_COUNT as f64 - 0.5);
    let mut sum = 0.0;
    for x in points.clone() {
        let right = 0.5 * sides[0] - distance - x * sides[0];
        let left = right - sides[0];
        for y in points.clone() {
            let far_end = (0.5 - y) * sides[1];
            let near_end = far_end - sides[1];
            sum += corner_integral(right, far_end)
                - corner_integral(left, far_end)
                - corner_integral(right, near_end)
                + corner_integral(left, near_end);
        }
    }
    sum / (SAMPLE_COUNT * SAMPLE_COUNT) as f64
}

impl SettlingStrips {
    /// `count` strips on a half-space of shear modulus `modulus` (Pa), before the weight acts.
    pub fn new(
        base: RockingBase,
        count: usize,
        modulus: f64,
        poisson: f64,
        law: SettlingLaw,
    ) -> Self {
        let side = base.length / count as f64;
        let middles: Vec<f64> =
            (0..count).map(|i| (i as f64 + 0.5) * side - 0.5 * base.length).collect();

        let mut compliance = Vec::new();
        for receiver in &middles {
            for source in &middles {
                let integral = mean_integral(receiver - source, [side, base.width]);
                compliance.push((1.0 - poisson) / (2.0 * PI * modulus) * integral);
            }
        }
        let zero = vec![0.0; count];
        Self {
            base,
            law,
            middles,
            compliance,
            levels: zero.clone(),
            thresholds: zero.clone(),
            pressures: zero,
            settlement: 0.0,
        }
    }

    fn bearing_pressure(&self, strip: usize) -> f64 {
        self.law.capacity(self.levels[strip])
    }

    /// Settlement at which the backbone of a strip reaches a pressure.
    fn virgin_settlement(&self, strip: usize, pressure: f64) -> f64 {
        let ratio = (pressure / self.bearing_pressure(strip)).min(1.0 - 1e-13);
        self.law.reference_settlement * ratio / (1.0 - ratio)
    }

    /// Displacement of a strip by the pressures on the others, m.
    fn displacement_by_others(&self, strip: usize) -> f64 {
        let row = &self.compliance[strip * self.middles.len()..][..self.middles.len()];
        let total_displacement: f64 =
            row.iter().zip(&self.pressures).map(|(entry, p)| entry * p).sum();
        total_displacement - row[strip] * self.pressures[strip]
    }

    /// Pressure of a strip at a `penetration` (m) of the base below the surface without this pressure.
    fn strip_pressure(&self, strip: usize, penetration: f64) -> f64 {
        let compliance = self.compliance[strip * (self.middles.len() + 1)];
        let elastic = penetration / compliance;
        let threshold = self.thresholds[strip];
        if elastic <= threshold {
            return elastic.max(0.0);
        }
        let start = self.virgin_settlement(strip, threshold);
        let mut low = threshold;
        let mut high = elastic.min(self.bearing_pressure(strip));
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            let settlement_increment = self.virgin_settlement(strip, middle) - start;
            if compliance * middle + settlement_increment < penetration {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    /// Relaxes the pressures at a position of the base; returns their force minus the weight, N.
    fn relax(&mut self, settlement: f64, rotation: f64) -> f64 {
        for _ in 0..MAX_RELAXATION_SWEEPS {
            let mut max_pressure_change = 0.0_f64;
            for strip in 0..self.middles.len() {
                let surface_level = self.displacement_by_others(strip) + self.levels[strip];
                let position = settlement + rotation * self.middles[strip];
                let pressure = self.strip_pressure(strip, position - surface_level);
                max_pressure_change =
                    max_pressure_change.max((pressure - self.pressures[strip]).abs());
                self.pressures[strip] = pressure;
            }
            if max_pressure_change < PRESSURE_TOLERANCE * self.law.initial_capacity {
                break;
            }
        }
        self.pressures.iter().sum::<f64>() * self.strip_area() - self.base.weight
    }

    fn strip_area(&self) -> f64 {
        self.base.length * self.base.width / self.middles.len() as f64
    }

    /// Turns the base to a `rotation`; returns the moment about its middle, N m.
    pub fn turn(&mut self, rotation: f64) -> f64 {
        let mut low = self.settlement - 1e-5;
        while self.relax(low, rotation) > 0.0 {
            low -= 2.0 * (self.settlement - low);
        }
        let mut high = self.settlement + 1e-5;
        while self.relax(high, rotation) < 0.0 {
            high += 2.0 * (high - self.settlement);
        }
        let mut force_low = self.relax(low, rotation);
        let mut force_high = self.relax(high, rotation);
        let mut settlement = high;
        for attempt in 0..100 {
            let middle = 0.5 * (low + high);
            let secant = high - force_high * (high - low) / (force_high - force_low);
            settlement = if attempt % 3 == 2 { middle } else { secant };
            let force = self.relax(settlement, rotation);
            if force.abs() < FORCE_TOLERANCE * self.base.weight {
                break;
            }
            if force > 0.0 {
                (high, force_high) = (settlement, force);
            } else {
                (low, force_low) = (settlement, force);
            }
        }
        self.settlement = settlement;
        self.end_step(rotation);
        let moments = self.pressures.iter().zip(&self.middles).map(|(p, x)| p * x);
        moments.sum::<f64>() * self.strip_area()
    }

    fn end_step(&mut self, rotation: f64) {
        for strip in 0..self.middles.len() {
            let pressure = self.pressures[strip];
            if pressure > self.thresholds[strip] {
                let compliance = self.compliance[strip * (self.middles.len() + 1)];
                let surface = self.displacement_by_others(strip) + compliance * pressure;
                let position = self.settlement + rotation * self.middles[strip];
                self.levels[strip] = self.levels[strip].max(position - surface);
                self.thresholds[strip] = pressure;
            }
            let range = self.law.elastic_range * self.bearing_pressure(strip);
            self.thresholds[strip] = self.thresholds[strip].min(pressure + range);
        }
    }
}
