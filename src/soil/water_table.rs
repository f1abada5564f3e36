//! Water table: water at rest in the ground.

use crate::error::{Result, finite, positive};

/// Density of fresh water, kg/m³.
const FRESH_WATER_DENSITY: f64 = 1000.0;

/// Water table: the level below which water at rest presses on a structure.
///
/// The pressure of the water at a depth z is ρ g (z − d), with the depth d of the table, and zero above the table. It
/// acts up on a base and inwards on walls, also on elements that are open: water fills the gap. Tractions of a run are then
/// effective, between structure and soil without the water. The pressure is that of water at rest: shaking, gaps and
/// settlements do not change it.
///
/// On the surface give the water table to
/// [`SimulationBuilder::water_table`](crate::coupled::SimulationBuilder::water_table), in a trench to
/// `TrenchGround::with_water_table`.
///
/// ```
/// use basemat::bem::ElasticGround;
/// use basemat::interface::Coulomb;
/// use basemat::motion::STANDARD_GRAVITY;
/// use basemat::soil::WaterTable;
/// use basemat::structure::RigidBlock;
/// use basemat::{Simulation, Soil};
///
/// // A base of 20 m, 3 m below the water table.
/// let block = RigidBlock::new(20.0, 10.0, 1500.0)?;
/// let simulation = Simulation::builder(0.01)
///     .ground(ElasticGround::under(Soil::new(80.0e6, 0.33, 1900.0)?, &block, 12)?)
///     .structure(block)
///     .interface(Coulomb::new(0.5)?)
///     .water_table(WaterTable::at_depth(-3.0)?)
///     .build()?;
/// let weight = 1500.0 * STANDARD_GRAVITY * 20.0 * 10.0;
/// let buoyancy = 1000.0 * STANDARD_GRAVITY * 3.0 * 20.0;
/// assert!((simulation.state().normal_force / (weight - buoyancy) - 1.0).abs() < 1e-9);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "WaterTableForm"))]
pub struct WaterTable {
    depth: f64,
    density: f64,
}

validated! {
    WaterTable as WaterTableForm { depth: f64, density: f64 }
    => WaterTable::at_depth(depth)?.with_density(density)
}

impl WaterTable {
    /// Fresh water (1000 kg/m³) below a `depth` under the surface of the ground, m.
    ///
    /// The depth is negative for water above a base on the surface: a base that lies below the water table in reality, and
    /// on the surface in the model.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a depth that is not finite.
    pub fn at_depth(depth: f64) -> Result<Self> {
        Ok(Self { depth: finite("depth of a water table", depth)?, density: FRESH_WATER_DENSITY })
    }

    /// Replaces the density of the water, kg/m³.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a density that is not finite and above zero.
    pub fn with_density(self, density: f64) -> Result<Self> {
        Ok(Self { density: positive("density of water", density)?, ..self })
    }

    /// Depth of the water table below the surface, m.
    pub(crate) fn depth(&self) -> f64 {
        self.depth
    }

    /// Density of the water, kg/m³.
    #[cfg(feature = "embedded")]
    pub(crate) fn density(&self) -> f64 {
        self.density
    }

    /// Mass of the water above a `depth`, kg/m²; zero above the table.
    pub(crate) fn mass_above(&self, depth: f64) -> f64 {
        self.density * (depth - self.depth).max(0.0)
    }
}
