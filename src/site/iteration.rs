//! Iteration for strain-compatible properties of a soil column.

use std::sync::Arc;

use super::site_motion::SiteMotion;
use super::soil_column::SoilColumn;
use super::transform::PartProgress;
use super::transform::Transform;
use super::vertical::{ColumnQuantity, ControlPoint, VerticalWave};
use crate::error::{Error, ProgressReporter, Result, positive, require, require_part, same_length};
use crate::motion::Record;
use crate::soil::{
    Bedrock, GeneralizedMaxwell, Hysteretic, Relaxation, ResolvedCurves, Soil, SoilLayer,
    SoilProfile, StrainCurves, layer_name,
};

/// Smallest effective strain of the iteration, in place of zero.
const MIN_EFFECTIVE_STRAIN: f64 = 1e-12;
/// Limit of ξ for [`ComplexModulus::Magnitude`].
///
/// There the equivalent ratio ξ' is nearly 1, the limit of damping laws.
const MAX_MAGNITUDE_DAMPING: f64 = 0.52;
/// Smallest and largest relaxation factor.
const RELAXATION_RANGE: [f64; 2] = [0.3, 20.0];

/// Options of [`SoilColumn::equivalent_linear`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EquivalentLinearOptions {
    /// Place of the given motion in the column.
    pub control: ControlPoint,
    /// Ratio of the effective strain to the largest strain, at most 1.
    pub strain_ratio: f64,
    /// Largest remaining relative change of a modulus or damping ratio.
    ///
    /// It is estimated for all further iterations together.
    pub tolerance: f64,
    /// Largest number of iterations, at least 1.
    pub most_iterations: usize,
    /// Frequencies (Hz) over which the damping of the resulting profile is constant.
    pub band: [f64; 2],
    /// Complex modulus of the layers by their shear modulus and damping ratio.
    pub complex_modulus: ComplexModulus,
}

/// Complex modulus of a layer from its shear modulus G and damping ratio ξ.
///
/// The two forms differ by 2ξ² in the stiffness, so surface peaks differ by some per cent above about 10 %
/// damping. Use the convention of the program with which you compare results.
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
    pub(super) damping_ratio: f64,
}

impl ComplexModulus {
    /// The G' and ξ' for which G'(1 + 2iξ') is the complex modulus of a layer.
    ///
    /// `index`: of the layer, from 0.
    fn equivalent(self, index: usize, properties: LayerProperties) -> Result<LayerProperties> {
        if self == Self::RealPart {
            return Ok(properties);
        }
        let LayerProperties { modulus_ratio, damping_ratio } = properties;
        if damping_ratio >= MAX_MAGNITUDE_DAMPING {
            let quantity = "strain-compatible damping ratio";
            let needed = "below 0.52 for a complex modulus by its magnitude";
            let error = Error::Input { quantity, value: damping_ratio, needed };
            return Err(error.within(layer_name(index)));
        }
        let square = damping_ratio * damping_ratio;
        let real = 1.0 - 2.0 * square;
        Ok(LayerProperties {
            modulus_ratio: modulus_ratio * real,
            damping_ratio: damping_ratio * (1.0 - square).sqrt() / real,
        })
    }
}

/// Outcrop of the rock, and G(1 + 2iξ) over 0.1 to 30 Hz.
///
/// 0.65 of the largest strain, and a tolerance of 1e-3 in at most 50 iterations.
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

    fn check(&self) -> Result<()> {
        let ratio = self.strain_ratio;
        let needed = "above 0 and at most 1 (a magnitude above 1 and at most 11)";
        require("effective strain ratio", ratio, ratio > 0.0 && ratio <= 1.0, needed)?;
        let iterations = self.most_iterations;
        require("most iterations of a site", iterations as f64, iterations > 0, "at least 1")?;
        positive("tolerance of strain-compatible properties", self.tolerance)?;
        GeneralizedMaxwell::constant_q(0.0, self.band, self.band[0]).map(drop)
    }
}

impl SoilColumn {
    /// Profile with the given properties of the layers; `law` makes a damping law from a ratio.
    pub(super) fn compatible<L: Relaxation + 'static>(
        &self,
        properties: &[LayerProperties],
        complex_modulus: ComplexModulus,
        law: impl Fn(f64) -> Result<L>,
    ) -> Result<SoilProfile> {
        let mut layers = Vec::with_capacity(properties.len());
        for (k, (layer, properties)) in self.profile.layers().iter().zip(properties).enumerate() {
            let LayerProperties { modulus_ratio, damping_ratio } =
                complex_modulus.equivalent(k, *properties)?;
            let shear_modulus = modulus_ratio * layer.soil.shear_modulus();
            let soil = Soil::new(shear_modulus, layer.soil.poisson(), layer.soil.density());
            let soil = soil.map_err(|error| layer_error(k, damping_ratio, error))?;
            let law = law(damping_ratio).map_err(|error| layer_error(k, damping_ratio, error))?;
            let thickness = layer.thickness;
            layers.push(SoilLayer { soil, thickness, damping: Arc::new(law) });
        }
        SoilProfile::new(layers, self.profile.bedrock().clone())
    }
}

/// Input of an iteration: column, motion, curves of its layers and options.
pub(super) struct Iteration<'a> {
    column: &'a SoilColumn,
    motion: &'a Record,
    pub(super) curves: Vec<ResolvedCurves>,
    options: &'a EquivalentLinearOptions,
    /// Spectrum of the motion, on the contour of the last linear calculation.
    transform: Option<Transform>,
}

/// Result of an iteration: properties of each layer, and its largest strain.
pub(super) struct Converged {
    pub(super) properties: Vec<LayerProperties>,
    pub(super) strains: Vec<f64>,
    pub(super) iterations: usize,
    pub(super) last_change: f64,
}

/// Accelerations in a column, over the length of its input.
pub(super) struct ColumnAccelerations {
    pub(super) surface: SiteMotion,
    /// At the tops of the layers and of the base.
    pub(super) tops: Vec<Vec<f64>>,
}

impl<'a> Iteration<'a> {
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
        let layers = column.profile.layers().len();
        same_length("list of strain curves, one for each layer,", curves.len(), layers)?;
        let base = column.profile.bedrock();
        let reflects_all =
            matches!(base, Bedrock::Rigid) || options.control == ControlPoint::Within;
        let mut layer_curves = Vec::with_capacity(layers);
        for (index, curves) in curves.iter().enumerate() {
            let resolved = curves.resolved().map_err(|error| error.within(layer_name(index)))?;
            if reflects_all && resolved.at(0.0)[1] == 0.0 {
                let quantity = "damping ratio at small strain";
                let needed = "above 0 on rigid bedrock or under a motion within: nothing leaves";
                return Err(Error::Input { quantity, value: 0.0, needed }.within(layer_name(index)));
            }
            layer_curves.push(resolved);
        }
        Ok(Self { column, motion, curves: layer_curves, options, transform: None })
    }

    /// Properties of the layers at the logarithms of effective strains.
    fn properties_at(&self, logs: &[f64]) -> Vec<LayerProperties> {
        let mut properties = Vec::with_capacity(logs.len());
        for (curves, log) in self.curves.iter().zip(logs) {
            let [modulus_ratio, damping_ratio] = curves.at(log.exp());
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
        let profile =
            self.column.compatible(properties, self.options.complex_modulus, Hysteretic::new)?;
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
        let count = properties.len();
        let transform = self.response(properties, ColumnQuantity::Strains, progress)?;
        let mut strains = Vec::with_capacity(count);
        for k in 0..count {
            strains.push(transform.peak(k)?);
            progress.reach(0.5 + 0.5 * (k + 1) as f64 / count as f64)?;
        }
        Ok(strains)
    }

    /// Accelerations of the column with these properties.
    pub(super) fn accelerations(
        &mut self,
        properties: &[LayerProperties],
        progress: &mut PartProgress<'_, '_>,
    ) -> Result<ColumnAccelerations> {
        let samples = self.motion.len();
        let transform = self.response(properties, ColumnQuantity::Accelerations, progress)?;
        let mut surface = transform.motion(0)?;
        surface.cut(samples);
        let mut tops = vec![surface.samples.clone()];
        for k in 1..=properties.len() {
            tops.push(transform.samples(k)?);
            progress.reach(0.5 + 0.5 * k as f64 / properties.len() as f64)?;
        }
        Ok(ColumnAccelerations { surface, tops })
    }

    /// Iterates moduli and damping ratios, starting at small strain.
    pub(super) fn converged(&mut self, watch: &mut ProgressReporter<'_>) -> Result<Converged> {
        let EquivalentLinearOptions { strain_ratio, tolerance, most_iterations, .. } =
            *self.options;
        let mut logs = vec![f64::NEG_INFINITY; self.curves.len()];
        let mut properties = self.properties_at(&logs);
        let mut aitken = Aitken::default();
        let mut iterations = 0;
        loop {
            let strains = self.strains(&properties, &mut PartProgress::part(watch, iterations))?;
            iterations += 1;
            let trial_logs: Vec<f64> = strains
                .iter()
                .map(|strain| (strain_ratio * strain).max(MIN_EFFECTIVE_STRAIN).ln())
                .collect();
            logs =
                if iterations == 1 { trial_logs.clone() } else { aitken.next(&logs, &trial_logs) };
            let unrelaxed = self.properties_at(&trial_logs);
            let next = self.properties_at(&logs);
            let last_change =
                largest_change(&properties, &unrelaxed).max(largest_change(&properties, &next));
            if last_change <= tolerance || iterations == most_iterations {
                return Ok(Converged { properties, strains, iterations, last_change });
            }
            properties = next;
        }
    }
}

/// Fixed-point iteration with one relaxation factor, from the last two residuals (Irons & Tuck 1969).
///
/// The factor is about 1/(1 − ρ) if each iteration leaves the fraction ρ of the distance. The step then estimates
/// the whole remaining distance.
#[derive(Debug, Default)]
struct Aitken {
    residual: Vec<f64>,
    factor: f64,
}

impl Aitken {
    /// Next argument after `old`; `new` is the image of `old`.
    fn next(&mut self, old: &[f64], new: &[f64]) -> Vec<f64> {
        let residual: Vec<f64> = old.iter().zip(new).map(|(old, new)| new - old).collect();
        let mut product = 0.0;
        let mut change_square = 0.0;
        for (before, now) in self.residual.iter().zip(&residual) {
            let change = now - before;
            product += before * change;
            change_square += change * change;
        }
        let factor = -self.factor * product / change_square;
        // Without an earlier residual, or if the last step diverged, the step is not relaxed.
        self.factor = if factor > 0.0 {
            factor.clamp(RELAXATION_RANGE[0], RELAXATION_RANGE[1])
        } else {
            1.0
        };
        let next = old.iter().zip(&residual).map(|(old, r)| old + self.factor * r).collect();
        self.residual = residual;
        next
    }
}

/// Largest change of a modulus or damping ratio, relative to the new one.
fn largest_change(old: &[LayerProperties], new: &[LayerProperties]) -> f64 {
    let mut largest = 0.0;
    for (old, new) in old.iter().zip(new) {
        let modulus_change = relative_change(old.modulus_ratio, new.modulus_ratio);
        let damping_change = relative_change(old.damping_ratio, new.damping_ratio);
        largest = modulus_change.max(damping_change).max(largest);
    }
    largest
}

/// Change of a value relative to the new one; 0 for equal values, also if they are 0.
fn relative_change(old: f64, new: f64) -> f64 {
    if old == new { 0.0 } else { (new - old).abs() / new }
}

/// Adds the layer (`index` from 0) to an error.
///
/// For a damping ratio that no law represents, it adds the ratio too.
fn layer_error(index: usize, ratio: f64, error: Error) -> Error {
    let has_no_law = matches!(error, Error::Accuracy { .. });
    let quantity = "strain-compatible damping ratio";
    let needed = "one that `constant_q` reproduces over the band (a shorter band helps)";
    let error = if has_no_law { Error::Input { quantity, value: ratio, needed } } else { error };
    error.within(layer_name(index))
}
