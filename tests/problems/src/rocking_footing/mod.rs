//! The slow cyclic test SSG02_03 of a footing that rocks on dry sand: measured, and computed with any interface law.
//!
//! `tests/data/rocking/README.md` has the source of the rows, their licence, and the facts of the test.

mod measured;
mod slow_test;

use basemat::interface::CyclicYielding;

pub use measured::measured_packets;
pub use slow_test::{SlowRockingRun, SlowRockingTest};

/// Sides of the base along the load and across it, m.
pub const FOOTING_SIDES: [f64; 2] = [2.8, 0.65];
/// Force P on the soil, N.
pub const VERTICAL_FORCE: f64 = 285.0e3;
/// Height of the actuator above the base, m.
pub const ACTUATOR_HEIGHT: f64 = 4.9;
/// Height of the centre of gravity above the base, m, for P–Δ in the measured moments.
pub const GRAVITY_CENTER_HEIGHT: f64 = 4.52;
/// Bearing pressure of the sand under the footing, Pa.
pub const BEARING_PRESSURE: f64 = 814.0e3;
/// Density of the sand, kg/m³.
pub const SAND_DENSITY: f64 = 1657.0;
/// Cycles of a packet.
pub const CYCLES_PER_PACKET: usize = 3;

/// Reference settlement w_r of `CyclicYielding`, fitted to this test, m.
pub const REFERENCE_SETTLEMENT: f64 = 5.0e-3;
/// Elastic range η, fitted to this test.
pub const ELASTIC_RANGE: f64 = 0.1;
/// Growth q_d of the bearing pressure with the settlement, Pa/m.
pub const DEPTH_GRADIENT: f64 = 1.4e6;
/// Friction coefficient between footing and sand.
pub const FRICTION_COEFFICIENT: f64 = 0.6;

/// Law of the sand with the parameters fitted to this test.
pub fn fitted_law(friction: f64) -> basemat::Result<CyclicYielding> {
    CyclicYielding::new(BEARING_PRESSURE, REFERENCE_SETTLEMENT, friction)?
        .with_elastic_range(ELASTIC_RANGE)?
        .with_depth_gradient(DEPTH_GRADIENT)
}

/// The footing at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FootingRow {
    /// V/P.
    pub shear: f64,
    /// 2M/(P L) about the middle of the base.
    pub moment: f64,
    /// s/L, down positive, of the middle of the base.
    pub settlement: f64,
    /// u/L.
    pub sliding: f64,
    /// Rotation, rad.
    pub rotation: f64,
}

/// Rows of three cycles of one amplitude.
#[derive(Debug, Clone, PartialEq)]
pub struct RockingPacket {
    pub name: String,
    pub rows: Vec<FootingRow>,
}

impl RockingPacket {
    /// Half the range of 2M/(P L): the mean of the moments both ways.
    pub fn moment(&self) -> f64 {
        self.half_range(|row| row.moment)
    }

    /// Largest 2M/(P L) to the left and to the right, both positive.
    pub fn moments_both_ways(&self) -> [f64; 2] {
        let moments = self.rows.iter().map(|row| row.moment);
        let max_moment = moments.clone().fold(f64::NEG_INFINITY, f64::max);
        let min_moment = moments.fold(f64::INFINITY, f64::min);
        [-min_moment, max_moment]
    }

    /// Half the range of the rotation, rad.
    pub fn rotation_amplitude(&self) -> f64 {
        self.half_range(|row| row.rotation)
    }

    /// s/L at the end.
    pub fn settlement(&self) -> f64 {
        self.rows.last().map_or(f64::NAN, |row| row.settlement)
    }

    /// ∫ M dθ over P L/2, by the trapezoidal rule.
    pub fn dissipated_energy(&self) -> f64 {
        let pairs = self.rows.windows(2);
        pairs
            .map(|pair| {
                0.5 * (pair[0].moment + pair[1].moment) * (pair[1].rotation - pair[0].rotation)
            })
            .sum()
    }

    /// Equivalent viscous damping ratio of a cycle, ΔW/(2π M θ) with the amplitudes of the packet.
    ///
    /// ΔW is a third of the packet's energy. A packet does not end at the load with which it began; ΔW therefore contains
    /// some stored energy.
    pub fn equivalent_damping(&self) -> f64 {
        let cycle_energy = self.dissipated_energy() / CYCLES_PER_PACKET as f64;
        cycle_energy / (std::f64::consts::TAU * self.moment() * self.rotation_amplitude())
    }

    fn half_range(&self, value: impl Fn(&FootingRow) -> f64) -> f64 {
        let max_value = self.rows.iter().map(&value).fold(f64::NEG_INFINITY, f64::max);
        let min_value = self.rows.iter().map(&value).fold(f64::INFINITY, f64::min);
        0.5 * (max_value - min_value)
    }
}
