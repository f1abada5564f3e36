//! Profile of horizontal soil layers on a half-plane or on rigid bedrock.

use std::fmt;
use std::sync::Arc;

use super::Soil;
use super::relaxation::{Elastic, Relaxation};
use crate::error::{Error, Result, SoilError, at_least, positive, require, require_part};
use crate::fem::StressAtRest;

/// Layer: an elastic soil, its thickness and its damping.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct SoilLayer {
    /// Elastic constants.
    ///
    /// The moduli are those at the frequency where the modulus ratio μ/μ₀ of the damping law is 1.
    pub soil: Soil,
    /// Thickness, m.
    pub thickness: f64,
    /// Damping law.
    #[cfg_attr(feature = "serde", serde(with = "super::damping_form"))]
    pub damping: Arc<dyn Relaxation>,
}

/// The ground under the last layer.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
pub enum Bedrock {
    /// A half-plane, into which waves radiate.
    HalfPlane {
        /// Elastic constants of the half-plane.
        soil: Soil,
        /// Damping law of the half-plane.
        #[cfg_attr(feature = "serde", serde(with = "super::damping_form"))]
        damping: Arc<dyn Relaxation>,
    },
    /// Bedrock that does not move and reflects all waves.
    Rigid,
}

/// Horizontal layers, from the surface down, on a half-plane or rigid bedrock.
///
/// Layers are linear: the far field of a ground does not yield. Soil that yields near a foundation is a mesh with a
/// [`SharedMaterial`](crate::fem::SharedMaterial).
///
/// With the feature `serde`, profiles with the crate's damping laws can be serialized and deserialized. Serializing a
/// user's damping law returns an error.
///
/// ```
/// use basemat::Soil;
/// use basemat::soil::{GeneralizedMaxwell, SoilProfile};
/// let band = [0.1, 30.0];
/// let profile = SoilProfile::on_half_plane(Soil::from_shear_wave_speed(500.0, 0.3, 2200.0)?)
///     .with_bedrock_damping(GeneralizedMaxwell::constant_q(0.01, band, 1.0)?)
///     .with_layer(Soil::from_shear_wave_speed(150.0, 0.33, 1800.0)?, 6.0)?
///     .with_damping(GeneralizedMaxwell::constant_q(0.05, band, 1.0)?);
/// assert_eq!(profile.depth(), 6.0);
/// assert_eq!(profile.first_frequency(), Some(150.0 / 24.0));
/// println!("{profile}");
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "SoilProfileForm"))]
pub struct SoilProfile {
    layers: Vec<SoilLayer>,
    bedrock: Bedrock,
    /// Whether `with_damping` was called before any layer.
    #[cfg_attr(feature = "serde", serde(skip))]
    has_damping_before_layers: bool,
}

validated! {
    SoilProfile as SoilProfileForm { layers: Vec<SoilLayer>, bedrock: Bedrock }
    => SoilProfile::new(layers, bedrock)
}

/// Largest number of layers of a profile, far above that of any sounding: a longer list is a mistake.
const MAX_LAYERS: usize = 1000;

impl SoilProfile {
    /// Creates a profile without layers on a half-plane of an elastic soil.
    pub fn on_half_plane(soil: Soil) -> Self {
        let bedrock = Bedrock::HalfPlane { soil, damping: Arc::new(Elastic) };
        Self { layers: vec![], bedrock, has_damping_before_layers: false }
    }

    /// Creates a profile without layers on rigid bedrock; add at least one layer.
    pub fn on_rigid_bedrock() -> Self {
        Self { layers: vec![], bedrock: Bedrock::Rigid, has_damping_before_layers: false }
    }

    /// Profile from its layers, from the surface down, and its bedrock.
    ///
    /// # Errors
    /// [`Error::Item`](crate::Error::Item) for a thickness that is not finite and positive, [`Error::Input`](crate::Error::Input) for
    /// more than 1000 layers, [`Error::Size`](crate::Error::Size) for rigid bedrock without layers.
    pub fn new(layers: Vec<SoilLayer>, bedrock: Bedrock) -> Result<Self> {
        let profile = Self { layers, bedrock, has_damping_before_layers: false };
        profile.check_depth()?;
        profile.check()?;
        Ok(profile)
    }

    /// Adds a layer below all others.
    ///
    /// The layer is elastic until [`with_damping`](SoilProfile::with_damping) is called.
    ///
    /// # Errors
    /// [`Error::Item`](crate::Error::Item) for a thickness that is not finite and positive, [`Error::Input`](crate::Error::Input) for
    /// more than 1000 layers, [`Error::Scene`](crate::Error::Scene) for the first layer after
    /// [`with_damping`](SoilProfile::with_damping), which would not damp this layer.
    pub fn with_layer(mut self, soil: Soil, thickness: f64) -> Result<Self> {
        let needed = "it damps the layer added last: call it after `with_layer`, or `with_bedrock_damping` for the bedrock";
        require_part(
            "`with_damping` before the first soil layer",
            !self.has_damping_before_layers,
            needed,
        )?;
        self.layers.push(SoilLayer { soil, thickness, damping: Arc::new(Elastic) });
        self.check_depth()?;
        Ok(self)
    }

    /// Sets the damping of the layer added last.
    ///
    /// Before the first layer it sets the damping of the bedrock; a layer added after that is an error.
    #[must_use]
    pub fn with_damping(mut self, damping: impl Relaxation + 'static) -> Self {
        match self.layers.last_mut() {
            Some(layer) => layer.damping = Arc::new(damping),
            None => {
                return Self {
                    has_damping_before_layers: true,
                    ..self.with_bedrock_damping(damping)
                };
            }
        }
        self
    }

    /// Sets the damping of the half-plane below; has no effect on rigid bedrock.
    #[must_use]
    pub fn with_bedrock_damping(mut self, law: impl Relaxation + 'static) -> Self {
        if let Bedrock::HalfPlane { damping, .. } = &mut self.bedrock {
            *damping = Arc::new(law);
        }
        self
    }

    /// The layers, from the surface down.
    pub fn layers(&self) -> &[SoilLayer] {
        &self.layers
    }

    /// Bedrock under the layers.
    pub fn bedrock(&self) -> &Bedrock {
        &self.bedrock
    }

    /// Thickness of all layers, m.
    pub fn depth(&self) -> f64 {
        self.layers.iter().map(|layer| layer.thickness).sum()
    }

    /// The soil at the surface; `None` for rigid bedrock without layers.
    pub fn surface(&self) -> Option<Soil> {
        self.soils().next().map(|(soil, _)| soil)
    }

    /// First natural frequency of the layers in shear on rigid bedrock, Hz.
    ///
    /// Estimated from the travel time: 1/(4 Σ h/`c_S`). `None` without layers.
    pub fn first_frequency(&self) -> Option<f64> {
        (!self.layers.is_empty()).then(|| 0.25 / self.travel_time())
    }

    /// Time that shear waves take through all layers, s; damping is neglected.
    pub fn travel_time(&self) -> f64 {
        self.layers.iter().map(|layer| layer.thickness / layer.soil.shear_wave_speed()).sum()
    }

    /// Stresses of these soils at rest, for finite elements that begin with them.
    ///
    /// `gravity` in m/s². `ratio`: K₀ of all soils, the horizontal over the vertical pressure; `None`: ν/(1 − ν) of each soil,
    /// as for a trench. The last layer on rigid bedrock extends to any depth.
    ///
    /// ```
    /// use basemat::Soil;
    /// use basemat::soil::SoilProfile;
    ///
    /// let profile = SoilProfile::on_half_plane(Soil::new(100.0e6, 0.25, 2000.0)?)
    ///     .with_layer(Soil::new(50.0e6, 0.4, 1800.0)?, 2.0)?;
    /// let stress = profile.stress_at_rest(10.0, None)?;
    /// assert_eq!(stress.at([0.0, -3.0])[1], -56.0e3);
    /// assert!((stress.at([0.0, -3.0])[0] + 56.0e3 / 3.0).abs() < 1e-9);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless gravity is above zero, the ratio not negative, and both finite;
    /// [`Error::Size`](crate::Error::Size) for rigid bedrock without layers.
    pub fn stress_at_rest(&self, gravity: f64, ratio: Option<f64>) -> Result<StressAtRest> {
        let ratio_of = |soil: Soil| ratio.unwrap_or(soil.poisson() / (1.0 - soil.poisson()));
        let quantity = "soil layers on rigid bedrock";
        let surface = self.surface().ok_or(Error::Size { quantity, found: 0, needed: 1 })?;
        let mut stress = StressAtRest::new(gravity, surface.density(), ratio_of(surface))?;
        let mut depth = 0.0;
        for (layer, (soil, _)) in self.layers.iter().zip(self.soils().skip(1)) {
            depth += layer.thickness;
            stress = stress.with_soil_below(depth, soil.density(), ratio_of(soil))?;
        }
        Ok(stress)
    }

    /// Whether the profile is a half-plane without layers or damping, which has a closed form.
    pub(crate) fn is_elastic_half_plane(&self) -> bool {
        let Bedrock::HalfPlane { damping, .. } = &self.bedrock else { return false };
        self.layers.is_empty() && damping.identity() == Elastic.identity()
    }

    /// Numbers that are equal only for equal profiles; `None` if a damping law has no identity.
    pub(crate) fn identity(&self) -> Option<Vec<f64>> {
        let mut identity = vec![self.layers.len() as f64];
        for layer in &self.layers {
            identity.push(layer.thickness);
        }
        for (soil, damping) in self.soils() {
            identity.extend([soil.shear_modulus(), soil.poisson(), soil.density()]);
            let law_identity = damping.identity()?;
            identity.push(law_identity.len() as f64);
            identity.extend(law_identity);
        }
        Some(identity)
    }

    /// Soils and damping laws from the surface down; the half-plane comes last.
    pub(crate) fn soils(&self) -> impl Iterator<Item = (Soil, &dyn Relaxation)> {
        let bedrock = match &self.bedrock {
            Bedrock::HalfPlane { soil, damping } => Some((*soil, &**damping)),
            Bedrock::Rigid => None,
        };
        self.layers.iter().map(|layer| (layer.soil, &*layer.damping)).chain(bedrock)
    }

    /// Error for rigid bedrock without layers.
    pub(crate) fn check(&self) -> Result<()> {
        at_least("list of soil layers", self.soils().count(), 1)
    }

    /// Error for too many layers, and for thicknesses or a depth that are not finite and positive.
    fn check_depth(&self) -> Result<()> {
        let layer_count = self.layers.len();
        require(
            "number of soil layers",
            layer_count as f64,
            layer_count <= MAX_LAYERS,
            "at most 1000",
        )?;
        for (index, layer) in self.layers.iter().enumerate() {
            positive("thickness (m)", layer.thickness)
                .map_err(|error| error.within(layer_name(index)))?;
        }
        if !self.layers.is_empty() {
            positive("depth of the soil layers", self.depth())?;
        }
        Ok(())
    }

    /// Error if a damping law is not causal, and so cannot be used in the time domain.
    pub(crate) fn check_causal(&self) -> Result<()> {
        for (index, (_, damping)) in self.soils().enumerate() {
            if !damping.is_causal() {
                let law = damping.describe();
                return Err(SoilError::NotCausal { law, layer: index + 1 }.into());
            }
        }
        Ok(())
    }
}

#[cfg(feature = "embedded")]
impl SoilProfile {
    /// Soils from the surface down, each with the depth of its lower end, m; infinite for a half-plane.
    pub(crate) fn soils_to(&self) -> impl Iterator<Item = (Soil, f64)> {
        let mut bottom = 0.0;
        self.soils().enumerate().map(move |(index, (soil, _))| {
            bottom += self.layers.get(index).map_or(f64::INFINITY, |layer| layer.thickness);
            (soil, bottom)
        })
    }

    /// Profile of the soils above a depth (m), on rigid bedrock at this depth.
    pub(crate) fn above(&self, depth: f64) -> Self {
        let mut remaining_depth = depth;
        let mut layers = Vec::new();
        for layer in &self.layers {
            let thickness = layer.thickness.min(remaining_depth);
            if thickness > 0.0 {
                layers.push(SoilLayer { thickness, ..layer.clone() });
            }
            remaining_depth -= thickness;
        }
        if remaining_depth > 0.0
            && let Bedrock::HalfPlane { soil, damping } = &self.bedrock
        {
            layers.push(SoilLayer {
                soil: *soil,
                thickness: remaining_depth,
                damping: damping.clone(),
            });
        }
        Self { layers, ..Self::on_rigid_bedrock() }
    }
}

/// Name of a layer, from 0 at the surface, in errors.
pub(crate) fn layer_name(index: usize) -> String {
    format!("layer {}", index + 1)
}

/// A half-plane without layers.
impl From<Soil> for SoilProfile {
    fn from(soil: Soil) -> Self {
        Self::on_half_plane(soil)
    }
}

/// Elastic constants in the columns of the table of a profile.
fn constants_text(soil: &Soil) -> String {
    format!(
        "{:>9.1} {:>9.1} {:>9.1} {:>7.4}",
        soil.shear_wave_speed(),
        soil.pressure_wave_speed(),
        soil.density(),
        soil.poisson()
    )
}

/// A table: one line per layer, then the bedrock and the first frequency of the layers.
impl fmt::Display for SoilProfile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:>10} {:>9} {:>9} {:>9} {:>7} {:>9}  damping",
            "h (m)", "c_S (m/s)", "c_P (m/s)", "kg/m3", "nu", "c_S/4h Hz"
        )?;
        for SoilLayer { soil, thickness, damping } in &self.layers {
            let frequency = 0.25 * soil.shear_wave_speed() / thickness;
            let constants = constants_text(soil);
            writeln!(f, "{thickness:>10.3} {constants} {frequency:>9.3}  {}", damping.describe())?;
        }
        match &self.bedrock {
            Bedrock::HalfPlane { soil, damping } => {
                write!(
                    f,
                    "{:>10} {} {:>9}  {}",
                    "half-plane",
                    constants_text(soil),
                    "",
                    damping.describe()
                )?;
            }
            Bedrock::Rigid => write!(f, "rigid bedrock")?,
        }
        if let Some(frequency) = self.first_frequency() {
            write!(f, "\nfirst frequency of the layers: {frequency:.3} Hz")?;
        }
        Ok(())
    }
}
