//! Strain-compatible properties of a soil column, as in SHAKE (Schnabel, Lysmer & Seed 1972; Kramer 1996, § 7.2).

use std::f64::consts::TAU;
use std::fmt;

use super::SiteWarning;
use super::iteration::{
    ColumnAccelerations, ConvergedProperties, EquivalentLinearOptions, Iteration, LayerProperties,
};
use super::part_progress::PartProgress;
use super::soil_column::SoilColumn;
use crate::error::{Observer, ProgressReporter, Result};
use crate::linalg::{Complex, largest};
use crate::motion::{Record, STANDARD_GRAVITY};
use crate::soil::{
    Bedrock, Elastic, GeneralizedMaxwell, ResolvedCurves, SoilProfile, StrainCurves,
};

/// Motion outside the duration of the record, relative to the peak, above which the result has a warning.
const CUT_OFF_LIMIT: f64 = 0.01;

/// Strain-compatible properties of one layer, and its strains.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LayerResponse {
    /// Depth of the layer's top, m.
    pub depth: f64,
    /// Shear modulus, Pa.
    pub shear_modulus: f64,
    /// Ratio of the shear modulus to its value at small strain.
    pub modulus_ratio: f64,
    /// Damping ratio.
    pub damping: f64,
    /// Largest shear strain in the layer's middle.
    pub largest_strain: f64,
    /// Effective shear strain, at which the curves were read.
    pub effective_strain: f64,
}

/// Response of a soil column with strain-compatible properties; it prints as a table.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct EquivalentLinear {
    /// Profile for a ground, with strain-compatible moduli at its first frequency and constant damping over the band.
    pub profile: SoilProfile,
    /// Motion of the free surface, the input of a simulation.
    ///
    /// It is the record for [`VerticalIncidence`](crate::motion::VerticalIncidence) or a builder's `motion`. Waves disperse
    /// in `profile`, so that the peak of a surface motion computed with `profile` ([`SoilColumn::to_surface`]) differs by
    /// up to 5 %.
    pub surface: Record,
    /// Properties and strains from the surface down.
    pub layers: Vec<LayerResponse>,
    /// Acceleration (m/s²) within the profile, at the tops of all layers and of the base.
    ///
    /// Each of them has as many samples as the motion.
    pub accelerations: Vec<Vec<f64>>,
    /// Largest absolute acceleration at each of these tops, m/s².
    pub peak_accelerations: Vec<f64>,
    /// Number of iterations, each a linear calculation.
    pub iterations: usize,
    /// Estimated largest relative change of a modulus or damping ratio by all further iterations.
    pub last_change: f64,
    /// Warnings about assumptions of the method.
    pub warnings: Vec<SiteWarning>,
}

impl SoilColumn {
    /// Strain-compatible properties under `motion`, and the response with them.
    ///
    /// The properties follow from linear calculations, repeated until they converge. `curves` has one entry for
    /// each layer. The damping laws of the layers are not used; the base's law is used.
    ///
    /// The strain of a layer is the strain in its middle: with the amplitudes A of the upward and B of the downward wave
    /// at the layer's top, du/dz = κ(A e^(κh/2) − B e^(−κh/2)), κ = s/c. Divide layers in which the strain varies. The
    /// curves are evaluated at a fraction of the largest strain. The calculation is in the frequency domain, s = iω,
    /// with the [`ComplexModulus`](super::ComplexModulus) of the options, G(1 + 2iξ) by default.
    ///
    /// The layers of the resulting profile have [`GeneralizedMaxwell::constant_q`] instead, with the same modulus at its
    /// first frequency. The base has this law if its own law cannot be used in the time domain. With this law waves
    /// disperse: motions that [`SoilColumn::to_surface`] computes differ from `surface` by some per cent. Poisson's ratio
    /// is constant, so that pressure waves become slower with shear waves (below the water table they would not).
    ///
    /// The total of the observer's progress is the largest number of iterations. After the last iteration the progress is
    /// complete.
    ///
    /// ```
    /// use basemat::{Soil, unobserved};
    /// use basemat::motion::el_centro_1940;
    /// use basemat::site::{EquivalentLinearOptions, SoilColumn, VerticalWave};
    /// use basemat::soil::{SoilProfile, StrainCurves};
    /// let clay = Soil::from_shear_wave_speed(180.0, 0.4, 1800.0)?;
    /// let mut profile = SoilProfile::on_half_plane(Soil::from_shear_wave_speed(800.0, 0.25, 2300.0)?);
    /// for _ in 0..4 {
    ///     profile = profile.with_layer(clay, 3.0)?;
    /// }
    /// let curves = vec![StrainCurves::VuceticDobry { plasticity_index: 30.0 }; 4];
    /// let column = SoilColumn::new(profile, VerticalWave::Shear)?;
    /// let options = EquivalentLinearOptions::of_magnitude(6.9);
    /// let response = column.equivalent_linear(&el_centro_1940(), &curves, &options, &mut unobserved)?;
    /// assert!(response.last_change < 1e-3 && response.layers[3].modulus_ratio < 0.9);
    /// println!("{response}");
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for curves that do not fit the layers, [`Error::Item`](crate::Error::Item) for
    /// parameters of a layer out of range; [`Error::Scene`](crate::Error::Scene) for a column of pressure waves;
    /// [`Error::Input`](crate::Error::Input) for options out of range and motions that overflow;
    /// [`Error::Stopped`](crate::Error::Stopped) by the observer.
    pub fn equivalent_linear(
        &self,
        motion: &Record,
        curves: &[StrainCurves],
        options: &EquivalentLinearOptions,
        observer: &mut Observer<'_>,
    ) -> Result<EquivalentLinear> {
        let step_count = options
            .most_iterations
            .saturating_add(1)
            .saturating_mul(PartProgress::STEPS_PER_PART);
        let mut reporter =
            ProgressReporter::new("equivalent-linear response", step_count, observer);
        let mut iteration = Iteration::new(self, motion, curves, options)?;
        let ConvergedProperties { properties, strains, iterations, last_change } =
            iteration.run(&mut reporter)?;
        let mut progress = PartProgress::of_part(&mut reporter, iterations);
        let ColumnAccelerations { surface, top_accelerations } =
            iteration.accelerations(&properties, &mut progress)?;
        let peak_accelerations = top_accelerations.iter().map(|samples| largest(samples)).collect();
        let cut_off_ratio = surface.before.max(surface.after) / surface.peak();
        let mut depth = 0.0;
        let mut layers = Vec::with_capacity(strains.len());
        let converged_layers = self.profile.layers().iter().zip(&properties).zip(&strains);
        for ((layer, properties), strain) in converged_layers {
            layers.push(LayerResponse {
                depth,
                shear_modulus: properties.modulus_ratio * layer.soil.shear_modulus(),
                modulus_ratio: properties.modulus_ratio,
                damping: properties.damping_ratio,
                largest_strain: *strain,
                effective_strain: options.strain_ratio * strain,
            });
            depth += layer.thickness;
        }
        let mut result = EquivalentLinear {
            layers,
            profile: self.causal_profile(&properties, options)?,
            surface: Record::new(motion.time_step(), surface.samples)?,
            accelerations: top_accelerations,
            peak_accelerations,
            iterations,
            last_change,
            warnings: vec![],
        };
        result.warn(options.tolerance, &iteration.curves, cut_off_ratio);
        reporter.reach(step_count)?;
        Ok(result)
    }

    /// Profile with causal damping laws, and these properties at its first frequency.
    fn causal_profile(
        &self,
        properties: &[LayerProperties],
        options: &EquivalentLinearOptions,
    ) -> Result<SoilProfile> {
        let EquivalentLinearOptions { band, complex_modulus, .. } = *options;
        let elastic_profile =
            self.compatible_profile(properties, complex_modulus, |_| Ok(Elastic))?;
        let reference_frequency =
            elastic_profile.first_frequency().unwrap_or(band[0]).clamp(band[0], band[1]);
        let causal_law = |damping_ratio| {
            GeneralizedMaxwell::constant_q(damping_ratio, band, reference_frequency)
        };
        let profile = self.compatible_profile(properties, complex_modulus, causal_law)?;
        match profile.bedrock() {
            Bedrock::HalfPlane { damping, .. } if !damping.is_causal() => {
                let modulus = damping.modulus(Complex::new(0.0, TAU * reference_frequency));
                let bedrock_law = causal_law(0.5 * modulus.im / modulus.re)?;
                Ok(profile.with_bedrock_damping(bedrock_law))
            }
            _ => Ok(profile),
        }
    }
}

impl EquivalentLinear {
    /// Adds warnings about large strains, extrapolated curves, missing convergence, and motion that is cut off.
    fn warn(&mut self, tolerance: f64, curves: &[ResolvedCurves], cut_off_ratio: f64) {
        for (index, (response, curves)) in self.layers.iter().zip(curves).enumerate() {
            let layer = index + 1;
            let curve_end = curves.max_strain();
            let strain = response.largest_strain;
            if strain > SiteWarning::STRAIN_LIMIT {
                self.warnings.push(SiteWarning::LargeStrain { layer, strain });
            }
            let effective_strain = response.effective_strain;
            if effective_strain > curve_end {
                self.warnings.push(SiteWarning::Extrapolated {
                    layer,
                    strain: effective_strain,
                    largest: curve_end,
                });
            }
        }
        if self.last_change > tolerance {
            self.warnings.push(SiteWarning::NotConverged {
                change: self.last_change,
                iterations: self.iterations,
            });
        }
        if cut_off_ratio > CUT_OFF_LIMIT {
            self.warnings.push(SiteWarning::CutOff { share: cut_off_ratio });
        }
    }
}

/// One line per layer, one for the base, then iterations and warnings.
impl fmt::Display for EquivalentLinear {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:>9} {:>9} {:>7} {:>9} {:>11} {:>11} {:>8}",
            "top (m)", "c_S (m/s)", "G/Gmax", "damping %", "strain %", "effective %", "peak (g)"
        )?;
        let mut peaks = self.peak_accelerations.iter().map(|peak| peak / STANDARD_GRAVITY);
        for (response, layer) in self.layers.iter().zip(self.profile.layers()) {
            writeln!(
                f,
                "{:>9.2} {:>9.1} {:>7.3} {:>9.2} {:>11.4} {:>11.4} {:>8.3}",
                response.depth,
                (response.shear_modulus / layer.soil.density()).sqrt(),
                response.modulus_ratio,
                100.0 * response.damping,
                100.0 * response.largest_strain,
                100.0 * response.effective_strain,
                peaks.next().unwrap_or(f64::NAN)
            )?;
        }
        let bedrock = peaks.next().unwrap_or(f64::NAN);
        writeln!(f, "{:>9.2} {:>60} {bedrock:>8.3}", self.profile.depth(), "bedrock, within")?;
        let iterations = self.iterations;
        let change_percent = 100.0 * self.last_change;
        write!(
            f,
            "{iterations} iterations, to {change_percent:.2} % of strain-compatible properties"
        )?;
        self.warnings.iter().try_for_each(|warning| write!(f, "\n{warning}"))
    }
}
