//! The law of soil that settles in every cycle, from its equations in the documents, solved by bisection.

use basemat::interface::CyclicYielding;

use crate::random::Random;

/// Parameters: capacity q = `initial_capacity` + `depth_gradient` · level, backbone q h/(h + `reference_settlement`).
#[derive(Debug, Clone, Copy)]
pub struct SettlingLaw {
    /// Bearing pressure at level zero, Pa.
    pub initial_capacity: f64,
    /// Growth of the bearing pressure with the level, Pa/m.
    pub depth_gradient: f64,
    /// Settlement at which the backbone reaches half of the capacity, m.
    pub reference_settlement: f64,
    /// Rise of pressure without yielding, relative to the capacity.
    pub elastic_range: f64,
}

/// State of an element at the start of a step.
#[derive(Debug, Clone, Copy, Default)]
pub struct SettlingState {
    /// Depth of the soil's surface at zero pressure, m.
    pub level: f64,
    /// Pressure up to which the soil does not yield, Pa.
    pub threshold: f64,
}

/// Zero of a rising function between zero and `end`.
fn bisect(function: impl Fn(f64) -> f64, end: f64) -> f64 {
    let mut low = 0.0;
    let mut high = end;
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if function(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

impl SettlingLaw {
    /// A dimensionless law.
    pub fn random(random: &mut Random) -> Self {
        let short_range = random.within(0.01, 1.0);
        Self {
            initial_capacity: random.log_within(0.3, 3.0),
            depth_gradient: random.pick(&[0.0, 1.0]) * random.log_within(0.1, 3.0),
            reference_settlement: random.log_within(1e-3, 1.0),
            elastic_range: random.pick(&[1.0, 0.1, short_range]),
        }
    }

    /// The law of the crate with these parameters.
    pub fn cyclic_yielding(&self, friction: f64) -> CyclicYielding {
        CyclicYielding::new(self.initial_capacity, self.reference_settlement, friction)
            .and_then(|law| law.with_elastic_range(self.elastic_range))
            .and_then(|law| law.with_depth_gradient(self.depth_gradient))
            .unwrap()
    }

    pub fn capacity(&self, level: f64) -> f64 {
        self.initial_capacity + self.depth_gradient * level.max(0.0)
    }

    /// Pressure of soil that yields, after a further settlement in the step.
    fn yield_pressure(&self, start: &SettlingState, settlement: f64) -> f64 {
        let capacity = self.capacity(start.level);
        let reference = self.reference_settlement;
        if reference == 0.0 {
            return capacity;
        }
        let backbone = |settlement: f64| capacity * settlement / (settlement + reference);
        let virgin_settlement = bisect(|h| backbone(h) - start.threshold, 1e9 * reference);
        backbone(virgin_settlement + settlement)
    }

    /// Pressure of a base on a spring that has moved down by `penetration` beyond the level.
    pub fn pressure(&self, start: &SettlingState, penetration: f64, spring: f64) -> f64 {
        if penetration <= 0.0 {
            return 0.0;
        }
        if penetration * spring <= start.threshold {
            return penetration * spring;
        }
        let settlement = bisect(
            |settlement| self.yield_pressure(start, settlement) / spring + settlement - penetration,
            penetration,
        );
        self.yield_pressure(start, settlement)
    }

    /// State at the end of a step with a pressure, in which the soil has settled.
    pub fn end(&self, start: &SettlingState, pressure: f64, settlement: f64) -> SettlingState {
        let is_yielding = pressure > start.threshold;
        let level = if is_yielding { start.level + settlement } else { start.level };
        let threshold = if is_yielding { pressure } else { start.threshold };
        let range = self.elastic_range * self.capacity(level);
        SettlingState { level, threshold: threshold.min(pressure + range) }
    }

    /// Violation of the law by a pressure and a gap (m), relative to the capacity.
    pub fn violation(&self, start: &SettlingState, pressure: f64, gap: f64) -> f64 {
        let capacity = self.capacity(start.level);
        let settlement = -start.level - gap;
        let length = 1e-12 + 1e-9 * start.level.abs();
        if settlement < -length {
            // The element is open.
            return pressure.abs() / capacity;
        }
        let yield_pressure = self.yield_pressure(start, settlement.max(0.0));
        let initial_yield_pressure =
            if self.reference_settlement == 0.0 { capacity } else { start.threshold };
        if settlement > length {
            (pressure - yield_pressure).abs() / capacity
        } else {
            (pressure - yield_pressure.max(initial_yield_pressure)).max(-pressure).max(0.0)
                / capacity
        }
    }
}
