//! Stresses of level soil at rest.

use std::sync::Arc;

use crate::error::{Result, finite, not_negative, positive, require};

/// Stresses of level soil at rest: its weight, and K₀ times its weight sideways.
///
/// The vertical pressure at a depth is the weight of all soil above, σ_v = g ∫ρ dz; the horizontal pressure is K₀ σ_v in both
/// horizontal directions, without shear. The surface is at y = 0, and y points up.
/// [`Mesh::with_stress_at_rest`](super::Mesh::with_stress_at_rest) makes elements begin with these stresses. For sand with
/// drainage below the water table, take the density under buoyancy: the stresses are those of the grains.
///
/// ```
/// use basemat::fem::StressAtRest;
///
/// // Fill of 1700 kg/m³, and below 2 m clay of 1900 kg/m³; K₀ = 0.5 and 0.8.
/// let stress = StressAtRest::new(10.0, 1700.0, 0.5)?.with_soil_below(2.0, 1900.0, 0.8)?;
/// assert_eq!(stress.at([0.0, -1.0]), [-8.5e3, -17.0e3, -8.5e3, 0.0]);
/// assert_eq!(stress.at([0.0, -3.0]), [-42.4e3, -53.0e3, -42.4e3, 0.0]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct StressAtRest {
    gravity: f64,
    /// Layers from the surface down; the last one has no lower end.
    layers: Arc<[LayerAtRest]>,
}

/// Layer of level soil.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LayerAtRest {
    /// Depth of the upper end, m.
    top: f64,
    /// Density, kg/m³.
    density: f64,
    /// K₀: horizontal over vertical pressure.
    ratio: f64,
    /// Vertical pressure at the upper end, Pa.
    top_pressure: f64,
}

impl LayerAtRest {
    /// Layer with checked density and pressure ratio.
    fn new(top: f64, density: f64, ratio: f64, top_pressure: f64) -> Result<Self> {
        not_negative("density of the soil at rest", density)?;
        not_negative("horizontal over vertical pressure of the soil at rest", ratio)?;
        Ok(Self { top, density, ratio, top_pressure })
    }
}

impl StressAtRest {
    /// Stresses of soil with one density (kg/m³) and one ratio K₀, under `gravity` (m/s²).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless gravity is above zero, density and ratio not negative, and all finite.
    pub fn new(gravity: f64, density: f64, ratio: f64) -> Result<Self> {
        positive("gravity", gravity)?;
        let layer = LayerAtRest::new(0.0, density, ratio, 0.0)?;
        Ok(Self { gravity, layers: Arc::new([layer]) })
    }

    /// Replaces the soil below a `depth` (m) by soil with this density (kg/m³) and ratio K₀.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the depth is finite and below the upper ends of all layers so far; as for
    /// [`StressAtRest::new`].
    pub fn with_soil_below(self, depth: f64, density: f64, ratio: f64) -> Result<Self> {
        finite("depth of a layer at rest", depth)?;
        let last_top = self.layers.last().map_or(0.0, |layer| layer.top);
        let needed = "below the upper ends of the layers so far";
        require("depth of a layer at rest", depth, depth > last_top, needed)?;
        let layer = LayerAtRest::new(depth, density, ratio, self.vertical_pressure(depth))?;
        let layers = self.layers.iter().copied().chain([layer]).collect();
        Ok(Self { layers, ..self })
    }

    /// Stresses `[xx, yy, zz, xy]` at a position [x, y] (m), Pa.
    ///
    /// Tension is positive. Above the surface all stresses are zero.
    pub fn at(&self, position: [f64; 2]) -> [f64; 4] {
        let depth = (-position[1]).max(0.0);
        let vertical_pressure = self.vertical_pressure(depth);
        let horizontal_pressure =
            self.layer(depth).map_or(0.0, |layer| layer.ratio) * vertical_pressure;
        [-horizontal_pressure, -vertical_pressure, -horizontal_pressure, 0.0]
    }

    /// Weight of the soil above a depth (m), Pa.
    fn vertical_pressure(&self, depth: f64) -> f64 {
        self.layer(depth).map_or(0.0, |layer| {
            layer.top_pressure + self.gravity * layer.density * (depth - layer.top)
        })
    }

    /// Layer at a depth, m.
    fn layer(&self, depth: f64) -> Option<&LayerAtRest> {
        self.layers.iter().rev().find(|layer| layer.top <= depth)
    }
}
