//! Iteration for strain-compatible properties of a soil column.

use std::sync::Arc;

use super::part_progress::{PartProgress, after_filter};
use super::site_motion::SiteMotion;
use super::soil_column::SoilColumn;
use super::transform::Transform;
use super::vertical::{ColumnQuantity, ControlPoint, VerticalWave};
use crate::error::{Error, ProgressReporter, Result, positive, require, require_part, same_length};
use crate::motion::Record;
use crate::soil::{
    Bedrock, GeneralizedMaxwell, Hysteretic, Relaxation, ResolvedCurves, Soil, SoilLayer,
    SoilProfile, StrainCurves, layer_name,
};

/// Smallest effective strain of the iteration, whose unknowns are logarithms of strains.
const MIN_EFFECTIVE_STRAIN: f64 = 1e-12;
/// Upper limit, excluded, of ξ for [`ComplexModulus::Magnitude`].
///
/// At this ξ the equivalent ratio ξ' is nearly 1, the limit of damping laws.
const MAX_MAGNITUDE_DAMPING: f64 = 0.52;
/// Smallest relaxation factor: smaller ones delay the convergence of oscillating iterations.
const MIN_RELAXATION_FACTOR: f64 = 0.3;
/// Largest relaxation factor: larger ones extrapolate too far from two residuals.
const MAX_RELAXATION_FACTOR: f64 = 20.0;

/// Options of [`SoilColumn::equivalent_linear`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EquivalentLinearOptions {
    /// Position of the input motion in the column.
    pub control: ControlPoint,
    /// Ratio of the effective strain to the largest strain, at most 1.
    pub strain_ratio: f64,
    /// Tolerance of the relative change of a modulus or damping ratio by all further iterations.
    pub tolerance: f64,
    /// Largest number of iterations, at least 1.
    pub most_iterations: usize,
    /// Frequencies (Hz) over which the damping of the resulting profile is constant.
    pub band: [f64; 2],
    /// Convention for the complex modulus of the layers.
    pub complex_modulus: ComplexModulus,
}

/// Convention for the complex modulus of a layer with shear modulus G and damping ratio ξ.
///
/// The stiffness of the two forms differs by 2ξ². Peaks at the surface therefore differ by some per cent above about
/// 10 % damping. Use the convention of the program with which you compare results.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum ComplexModulus {
    /// G(1 + 2iξ): its real part is G, as in SHAKE (Schnabel, Lysmer & Seed 1972).
    #[default]
    RealPart,
    /// G(1 − 2ξ² + 2iξ√(1 − ξ²)): its magnitude is G, as in SHAKE91 (Idriss & Sun 1992). ξ must be below 0.52.
    Magnitude,
}

/// Properties of a layer at one effective strain.
#[derive(Debug, Clone, Copy)]
pub(super) struct LayerProperties {
    /// Ratio of the shear modulus to that at small strain.
    pub(super) modulus_ratio: f64,
    /// Damping ratio ξ.
    pub(super) damping_ratio: f64,
}

impl ComplexModulus {
    /// Properties G' and ξ' for which G'(1 + 2iξ') is the complex modulus of a layer.
    ///
    /// `layer_index`: from 0, for errors.
    fn equivalent(
        self,
        layer_index: usize,
        properties: LayerProperties,
    ) -> Result<LayerProperties> {
        if self == Self::RealPart {
            return Ok(properties);
        }
        let LayerProperties { modulus_ratio, damping_ratio } = properties;
        if damping_ratio >= MAX_MAGNITUDE_DAMPING {
            let quantity = "strain-compatible damping ratio";
            let needed = "below 0.52 for a complex modulus by its magnitude";
            let error = Error::Input { quantity, value: damping_ratio, needed };
            return Err(error.within(layer_name(layer_index)));
        }
        let squared_ratio = damping_ratio * damping_ratio;
        let real_part = 1.0 - 2.0 * squared_ratio;
        Ok(LayerProperties {
            modulus_ratio: modulus_ratio * real_part,
            damping_ratio: damping_ratio * (1.0 - squared_ratio).sqrt() / real_part,
        })
    }
}

/// Defaults: a motion of the rock outcrop, and the complex modulus G(1 + 2iξ).
///
/// The effective strain is 0.65 of the largest one, the tolerance 1e-3 in at most 50 iterations, the band 0.1 to 30 Hz.
impl Default for EquivalentLinearOptions {
    fn default() -> Self {
        Self {
            control: ControlPoint::Outcrop,
            strain_ratio: 0.65,
            tolerance: 1e-3,
            most_iterations: 50,
            band: [0.1, 30.0],
            complex_modulus: ComplexModulus::RealPart,
        }
    }
}

impl EquivalentLinearOptions {
    /// The default options, with the strain ratio (M − 1)/10 of a `magnitude` M (Idriss & Sun 1992).
    pub fn of_magnitude(magnitude: f64) -> Self {
        Self { strain_ratio: 0.1 * (magnitude - 1.0), ..Self::default() }
    }

    /// Error for an option out of its range.
    fn check(&self) -> Result<()> {
        let strain_ratio = self.strain_ratio;
        let needed = "above 0 and at most 1 (a magnitude above 1 and at most 11)";
        require(
            "effective strain ratio",
            strain_ratio,
            strain_ratio > 0.0 && strain_ratio <= 1.0,
            needed,
        )?;
        let iterations = self.most_iterations;
        require("largest number of iterations", iterations as f64, iterations > 0, "at least 1")?;
        positive("tolerance of strain-compatible properties", self.tolerance)?;
        GeneralizedMaxwell::constant_q(0.0, self.band, self.band[0]).map(drop)
    }
}

impl SoilColumn {
    /// Profile whose layers have these properties.
    ///
    /// `law_of_ratio`: returns the damping law of a layer for its damping ratio.
    pub(super) fn compatible_profile<L: Relaxation + 'static>(
        &self,
        properties: &[LayerProperties],
        complex_modulus: ComplexModulus,
        law_of_ratio: impl Fn(f64) -> Result<L>,
    ) -> Result<SoilProfile> {
        let mut layers = Vec::with_capacity(properties.len());
        for (index, (layer, properties)) in self.profile.layers().iter().zip(properties).enumerate()
        {
            let LayerProperties { modulus_ratio, damping_ratio } =
                complex_modulus.equivalent(index, *properties)?;
            let shear_modulus = modulus_ratio * layer.soil.shear_modulus();
            let soil = Soil::new(shear_modulus, layer.soil.poisson(), layer.soil.density());
            let soil = soil.map_err(|error| layer_error(index, damping_ratio, error))?;
            let law = law_of_ratio(damping_ratio)
                .map_err(|error| layer_error(index, damping_ratio, error))?;
            let thickness = layer.thickness;
            layers.push(SoilLayer { soil, thickness, damping: Arc::new(law) });
        }
        SoilProfile::new(layers, self.profile.bedrock().clone())
    }
}

/// Iteration for strain-compatible properties of a column under a motion.
pub(super) struct Iteration<'a> {
    column: &'a SoilColumn,
    motion: &'a Record,
    /// Strain curves of the layers.
    pub(super) curves: Vec<ResolvedCurves>,
    options: &'a EquivalentLinearOptions,
    /// Spectrum of the motion on the contour of the last linear calculation.
    transform: Option<Transform>,
}

/// Result of an iteration.
pub(super) struct ConvergedProperties {
    /// Properties of each layer.
    pub(super) properties: Vec<LayerProperties>,
    /// Largest strain of each layer.
    pub(super) strains: Vec<f64>,
    /// Number of linear calculations.
    pub(super) iterations: usize,
    /// Estimated largest relative change of a property by all further iterations.
    pub(super) last_change: f64,
}

/// Accelerations (m/s²) in a column, during its input motion.
pub(super) struct ColumnAccelerations {
    /// Motion of the surface.
    pub(super) surface: SiteMotion,
    /// Accelerations at the tops of the layers and of the base.
    pub(super) top_accelerations: Vec<Vec<f64>>,
}

impl<'a> Iteration<'a> {
    /// Checks the arguments, and prepares the iteration; `curves` has one entry for each layer.
    pub(super) fn new(
        column: &'a SoilColumn,
        motion: &'a Record,
        curves: &[StrainCurves],
        options: &'a EquivalentLinearOptions,
    ) -> Result<Self> {
        options.check()?;
        let is_shear = column.wave == VerticalWave::Shear;
        let needed = "strain curves are those of shear: shear waves are needed";
        require_part("soil column", is_shear, needed)?;
        let layer_count = column.profile.layers().len();
        same_length("list of strain curves, one for each layer,", curves.len(), layer_count)?;
        let base = column.profile.bedrock();
        let has_total_reflection =
            matches!(base, Bedrock::Rigid) || options.control == ControlPoint::Within;
        let mut layer_curves = Vec::with_capacity(layer_count);
        for (index, layer_curve) in curves.iter().enumerate() {
            let resolved_curves =
                layer_curve.resolved().map_err(|error| error.within(layer_name(index)))?;
            if has_total_reflection && resolved_curves.at(0.0)[1] == 0.0 {
                let quantity = "damping ratio at small strain";
                let needed = "above 0 on rigid bedrock or under a motion within: no energy radiates into the base";
                return Err(Error::Input { quantity, value: 0.0, needed }.within(layer_name(index)));
            }
            layer_curves.push(resolved_curves);
        }
        Ok(Self { column, motion, curves: layer_curves, options, transform: None })
    }

    /// Properties of the layers at effective strains, from their logarithms.
    fn properties_at(&self, log_strains: &[f64]) -> Vec<LayerProperties> {
        let mut properties = Vec::with_capacity(log_strains.len());
        for (curves, log_strain) in self.curves.iter().zip(log_strains) {
            let [modulus_ratio, damping_ratio] = curves.at(log_strain.exp());
            properties.push(LayerProperties { modulus_ratio, damping_ratio });
        }
        properties
    }

    /// Spectra of a quantity in the linear column with these properties.
    fn response(
        &mut self,
        properties: &[LayerProperties],
        quantity: ColumnQuantity,
        progress: &mut PartProgress<'_, '_>,
    ) -> Result<&mut Transform> {
        let profile = self.column.compatible_profile(
            properties,
            self.options.complex_modulus,
            Hysteretic::new,
        )?;
        let column = SoilColumn { profile, wave: self.column.wave };
        let samples = self.motion.accelerations();
        let contour = column.contour(self.motion.time_step(), samples.len())?;
        let transform = match self.transform.take() {
            Some(transform) if *transform.contour() == contour => transform,
            _ => Transform::new(contour, samples)?,
        };
        let transform = self.transform.insert(transform);
        column.response(quantity, self.options.control, transform, progress)?;
        Ok(transform)
    }

    /// Largest strains of the layers with these properties.
    fn strains(
        &mut self,
        properties: &[LayerProperties],
        progress: &mut PartProgress<'_, '_>,
    ) -> Result<Vec<f64>> {
        let layer_count = properties.len();
        let transform = self.response(properties, ColumnQuantity::Strains, progress)?;
        let mut strains = Vec::with_capacity(layer_count);
        for index in 0..layer_count {
            strains.push(transform.peak(index)?);
            let finished_fraction = (index + 1) as f64 / layer_count as f64;
            progress.report(after_filter(finished_fraction))?;
        }
        Ok(strains)
    }

    /// Accelerations of the column with these properties.
    pub(super) fn accelerations(
        &mut self,
        properties: &[LayerProperties],
        progress: &mut PartProgress<'_, '_>,
    ) -> Result<ColumnAccelerations> {
        let sample_count = self.motion.len();
        let transform = self.response(properties, ColumnQuantity::Accelerations, progress)?;
        let mut surface = transform.motion(0)?;
        surface.truncate(sample_count);
        let mut top_accelerations = vec![surface.samples.clone()];
        for index in 1..=properties.len() {
            top_accelerations.push(transform.samples(index)?);
            progress.report(after_filter(index as f64 / properties.len() as f64))?;
        }
        Ok(ColumnAccelerations { surface, top_accelerations })
    }

    /// Iterates moduli and damping ratios from their values at small strain.
    pub(super) fn run(
        &mut self,
        reporter: &mut ProgressReporter<'_>,
    ) -> Result<ConvergedProperties> {
        let EquivalentLinearOptions { strain_ratio, tolerance, most_iterations, .. } =
            *self.options;
        let mut log_strains = vec![f64::NEG_INFINITY; self.curves.len()];
        let mut properties = self.properties_at(&log_strains);
        let mut aitken = Aitken::default();
        let mut iterations = 0;
        loop {
            let strains =
                self.strains(&properties, &mut PartProgress::of_part(reporter, iterations))?;
            iterations += 1;
            let trial_log_strains: Vec<f64> = strains
                .iter()
                .map(|strain| (strain_ratio * strain).max(MIN_EFFECTIVE_STRAIN).ln())
                .collect();
            log_strains = if iterations == 1 {
                trial_log_strains.clone()
            } else {
                aitken.next(&log_strains, &trial_log_strains)
            };
            let trial_properties = self.properties_at(&trial_log_strains);
            let relaxed_properties = self.properties_at(&log_strains);
            let last_change = max_change(&properties, &trial_properties)
                .max(max_change(&properties, &relaxed_properties));
            if last_change <= tolerance || iterations == most_iterations {
                return Ok(ConvergedProperties { properties, strains, iterations, last_change });
            }
            properties = relaxed_properties;
        }
    }
}

/// Fixed-point iteration with one relaxation factor, from the last two residuals (Irons & Tuck 1969).
///
/// The factor is about 1/(1 − ρ) if each iteration reduces the distance to the solution by the factor ρ. The relaxed step
/// then estimates the whole remaining distance.
#[derive(Debug, Default)]
struct Aitken {
    /// Residual of the last iteration.
    residual: Vec<f64>,
    /// Relaxation factor of the last iteration.
    relaxation_factor: f64,
}

impl Aitken {
    /// Next argument of the iteration, from an argument and its image.
    fn next(&mut self, argument: &[f64], image: &[f64]) -> Vec<f64> {
        let residual: Vec<f64> =
            argument.iter().zip(image).map(|(argument, image)| image - argument).collect();
        let mut product = 0.0;
        let mut change_square = 0.0;
        for (previous, residual) in self.residual.iter().zip(&residual) {
            let change = residual - previous;
            product += previous * change;
            change_square += change * change;
        }
        let factor = -self.relaxation_factor * product / change_square;
        // The step is not relaxed without a previous residual, or if the last step diverged.
        self.relaxation_factor = if factor > 0.0 {
            factor.clamp(MIN_RELAXATION_FACTOR, MAX_RELAXATION_FACTOR)
        } else {
            1.0
        };
        let next_argument = argument
            .iter()
            .zip(&residual)
            .map(|(argument, residual)| argument + self.relaxation_factor * residual)
            .collect();
        self.residual = residual;
        next_argument
    }
}

/// Largest change of a modulus or damping ratio, relative to the new one.
fn max_change(old: &[LayerProperties], new: &[LayerProperties]) -> f64 {
    let mut max_so_far = 0.0;
    for (old, new) in old.iter().zip(new) {
        let modulus_change = relative_change(old.modulus_ratio, new.modulus_ratio);
        let damping_change = relative_change(old.damping_ratio, new.damping_ratio);
        max_so_far = modulus_change.max(damping_change).max(max_so_far);
    }
    max_so_far
}

/// Change of a value relative to the new one; 0 for equal values, also if they are 0.
fn relative_change(old: f64, new: f64) -> f64 {
    if old == new { 0.0 } else { (new - old).abs() / new }
}

/// Adds the name of a layer to an error.
///
/// `index`: of the layer, from 0. An error of accuracy is replaced by one that states the damping ratio.
fn layer_error(index: usize, damping_ratio: f64, error: Error) -> Error {
    let has_no_damping_law = matches!(error, Error::Accuracy { .. });
    let quantity = "strain-compatible damping ratio";
    let needed = "one that `constant_q` reproduces over the band (a shorter band helps)";
    let error = if has_no_damping_law {
        Error::Input { quantity, value: damping_ratio, needed }
    } else {
        error
    };
    error.within(layer_name(index))
}
