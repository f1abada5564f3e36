//! Strain-compatible properties of a soil column, as in SHAKE (Schnabel, Lysmer & Seed 1972; Kramer 1996, § 7.2).

use std::f64::consts::TAU;
use std::fmt;
use std::sync::Arc;

use super::SiteWarning;
use super::soil_column::{ControlPoint, Inside, SoilColumn, VerticalWave};
use super::transform::SiteMotion;
use crate::error::{Error, LayeredError, Result, SiteError, positive, require};
use crate::linalg::Complex;
use crate::motion::{Record, STANDARD_GRAVITY};
use crate::soil::{
    Base, Elastic, GeneralizedMaxwell, Hysteretic, Relaxation, Resolved, Soil, SoilLayer,
    SoilProfile, StrainCurves,
};

/// Effective strain that stands for none.
const LEAST_STRAIN: f64 = 1e-12;
/// Least and largest relaxation factor.
const FACTORS: [f64; 2] = [0.3, 20.0];

/// Options of [`SoilColumn::equivalent_linear`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EquivalentLinearOptions {
    /// Place at which the motion is given.
    pub control: ControlPoint,
    /// Effective strain over the largest, at most 1.
    pub strain_ratio: f64,
    /// Largest relative change of a modulus or damping ratio by all further iterations, as estimated, that passes for
    /// none.
    pub tolerance: f64,
    /// Most iterations, at least 1.
    pub most_iterations: usize,
    /// Frequencies (Hz) over which the damping of the resulting profile is constant.
    pub band: [f64; 2],
}

/// The rock's outcrop, 0.65 of the largest strain, 1e-3 in at most 50 iterations, 0.1 to 30 Hz.
impl Default for EquivalentLinearOptions {
    fn default() -> Self {
        let (control, band) = (ControlPoint::Outcrop, [0.1, 30.0]);
        Self { control, strain_ratio: 0.65, tolerance: 1e-3, most_iterations: 50, band }
    }
}

impl EquivalentLinearOptions {
    /// The default with the strain ratio (M − 1)/10 of a `magnitude` M (Idriss & Sun 1992).
    pub fn of_magnitude(magnitude: f64) -> Self {
        Self { strain_ratio: 0.1 * (magnitude - 1.0), ..Self::default() }
    }

    fn check(&self) -> Result<()> {
        let (ratio, most) = (self.strain_ratio, self.most_iterations);
        let needed = "above 0 and at most 1 (a magnitude above 1 and at most 11)";
        require("effective strain ratio", ratio, ratio > 0.0 && ratio <= 1.0, needed)?;
        require("most iterations of a site", most as f64, most > 0, "at least 1")?;
        positive("tolerance of strain-compatible properties", self.tolerance)?;
        GeneralizedMaxwell::constant_q(0.0, self.band, self.band[0]).map(drop)
    }
}

/// Strain-compatible properties of one layer and the strains they belong to.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LayerResponse {
    /// Depth of the layer's top, m.
    pub depth: f64,
    /// Shear modulus, Pa.
    pub shear_modulus: f64,
    /// Shear modulus over that at small strain.
    pub modulus_ratio: f64,
    /// Damping ratio.
    pub damping: f64,
    /// Largest shear strain in the layer's middle.
    pub largest_strain: f64,
    /// Effective shear strain, at which the curves were read.
    pub effective_strain: f64,
}

/// Response of a soil column with strain-compatible properties. Printed, it is a table.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct EquivalentLinear {
    /// The site for a ground: strain-compatible moduli at its own first frequency, damping constant over the band.
    pub profile: SoilProfile,
    /// Motion of the free surface, for [`VerticalIncidence`](crate::motion::VerticalIncidence) or a builder's `motion`.
    /// Use this one: `profile` disperses, and the peak of its own surface motion ([`SoilColumn::to_surface`]) differs
    /// by up to 5 %.
    pub surface: Record,
    /// Properties and strains from the surface down.
    pub layers: Vec<LayerResponse>,
    /// Acceleration (m/s²) at the tops of all layers and of the base within, as many samples as the motion's.
    pub accelerations: Vec<Vec<f64>>,
    /// Largest absolute value of each, m/s².
    pub peak_accelerations: Vec<f64>,
    /// Linear calculations made.
    pub iterations: usize,
    /// Largest relative change of a modulus or damping ratio that all further iterations would make, as estimated.
    pub last_change: f64,
    /// Assumptions of the method that the response strains.
    pub warnings: Vec<SiteWarning>,
}

impl SoilColumn {
    /// Strain-compatible properties under `motion`, by as many linear calculations as it takes, and the response with
    /// them. `curves` has one entry for each layer; the damping laws of layers are not used, that of the base is.
    ///
    /// Each layer has one strain, that of its middle, where waves A up and B down at the layer's top have du/dz = κ(A
    /// e^(κh/2) − B e^(−κh/2)), κ = s/c: divide layers in which it varies. Curves are read at a share of its largest
    /// value. This is in the frequency domain, s = iω, with the modulus G(1 + 2iξ), as in SHAKE. The resulting profile
    /// has [`GeneralizedMaxwell::constant_q`] in its place, of the same modulus at its first frequency, under the
    /// layers too if the base's law cannot march in time. That disperses: what [`SoilColumn::to_surface`] makes with it
    /// is some per cent off `surface`. Poisson's ratio stays, so pressure waves slow down with shear waves (below the
    /// water table they would not).
    ///
    /// ```
    /// use basemat::Soil;
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
    /// let found = column.equivalent_linear(&el_centro_1940(), &curves, &options)?;
    /// assert!(found.last_change < 1e-3 && found.layers[3].modulus_ratio < 0.9);
    /// println!("{found}");
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`SiteError`] for curves that do not fit the layers or have parameters out of their range, and a column of
    /// pressure waves; [`Error::Input`] for options out of theirs and motions that overflow.
    pub fn equivalent_linear(
        &self,
        motion: &Record,
        curves: &[StrainCurves],
        options: &EquivalentLinearOptions,
    ) -> Result<EquivalentLinear> {
        let iteration = Iteration::new(self, motion, curves, options)?;
        let Converged { properties, strains, iterations, last_change } = iteration.converged()?;
        let mut found = iteration.inside(&properties, Inside::Accelerations)?;
        for motion in &mut found {
            motion.cut(iteration.motion.len());
        }
        let peak_accelerations = found.iter().map(SiteMotion::peak).collect();
        let surface = found.first().cloned().unwrap_or_default();
        let (mut depth, mut layers) = (0.0, Vec::with_capacity(strains.len()));
        let given = self.profile.layers().iter().zip(&properties).zip(&strains);
        for ((layer, [modulus_ratio, damping]), strain) in given {
            layers.push(LayerResponse {
                depth,
                shear_modulus: modulus_ratio * layer.soil.shear_modulus(),
                modulus_ratio: *modulus_ratio,
                damping: *damping,
                largest_strain: *strain,
                effective_strain: options.strain_ratio * strain,
            });
            depth += layer.thickness;
        }
        let mut result = EquivalentLinear {
            layers,
            profile: self.causal(&properties, options.band)?,
            surface: Record::new(motion.time_step(), surface.samples.clone())?,
            accelerations: found.into_iter().map(|motion| motion.samples).collect(),
            peak_accelerations,
            iterations,
            last_change,
            warnings: vec![],
        };
        let cut_off = surface.before.max(surface.after) / surface.peak();
        result.warn(options.tolerance, &iteration.curves, cut_off);
        Ok(result)
    }

    /// The profile with these modulus ratios and damping ratios, by a damping law of the ratio.
    fn compatible<L: Relaxation + 'static>(
        &self,
        properties: &[[f64; 2]],
        law: impl Fn(f64) -> Result<L>,
    ) -> Result<SoilProfile> {
        let layer = |(k, (layer, [modulus, damping])): (usize, (&SoilLayer, &[f64; 2]))| {
            let SoilLayer { soil, thickness, .. } = layer;
            let made = Soil::new(modulus * soil.shear_modulus(), soil.poisson(), soil.density());
            let made = made.and_then(|soil| Ok((soil, law(*damping)?)));
            let (soil, damping) = made.map_err(|error| of_layer(k, error))?;
            Ok(SoilLayer { soil, thickness: *thickness, damping: Arc::new(damping) })
        };
        let layers = self.profile.layers().iter().zip(properties).enumerate().map(layer);
        SoilProfile::new(layers.collect::<Result<_>>()?, self.profile.base().clone())
    }

    /// Profile of these properties with causal laws of damping, whose moduli are theirs at its first frequency.
    fn causal(&self, properties: &[[f64; 2]], band: [f64; 2]) -> Result<SoilProfile> {
        let soft = self.compatible(properties, |_| Ok(Elastic))?;
        let reference = soft.first_frequency().unwrap_or(band[0]).clamp(band[0], band[1]);
        let law = |ratio| GeneralizedMaxwell::constant_q(ratio, band, reference);
        let profile = self.compatible(properties, law)?;
        match profile.base() {
            Base::HalfPlane { damping, .. } if !damping.is_causal() => {
                let modulus = damping.modulus(Complex::new(0.0, TAU * reference));
                let law = law(0.5 * modulus.im / modulus.re)?;
                Ok(profile.with_base_damping(law))
            }
            _ => Ok(profile),
        }
    }
}

/// Input of an iteration: column, motion, curves of its layers and options.
struct Iteration<'a> {
    column: &'a SoilColumn,
    motion: &'a Record,
    curves: Vec<Resolved>,
    options: &'a EquivalentLinearOptions,
}

/// Modulus ratio and damping ratio of each layer, and the largest strains with them.
struct Converged {
    properties: Vec<[f64; 2]>,
    strains: Vec<f64>,
    iterations: usize,
    last_change: f64,
}

impl<'a> Iteration<'a> {
    fn new(
        column: &'a SoilColumn,
        motion: &'a Record,
        curves: &[StrainCurves],
        options: &'a EquivalentLinearOptions,
    ) -> Result<Self> {
        options.check()?;
        if column.wave != VerticalWave::Shear {
            return Err(SiteError::PressureWaves.into());
        }
        let layers = column.profile.layers().len();
        if curves.len() != layers {
            return Err(SiteError::Curves { curves: curves.len(), layers }.into());
        }
        let base = column.profile.base();
        let reflects = matches!(base, Base::Rigid) || options.control == ControlPoint::Within;
        let resolved = |(index, curves): (usize, &StrainCurves)| {
            let resolved = curves.resolved().map_err(|error| of_layer(index, error))?;
            if reflects && resolved.at(0.0)[1] == 0.0 {
                let (quantity, layer) = ("damping ratio at small strain", index + 1);
                let needed = "above 0 on a rigid base or under a motion within: nothing leaves";
                return Err(SiteError::Layer { layer, quantity, value: 0.0, needed }.into());
            }
            Ok(resolved)
        };
        let curves = curves.iter().enumerate().map(resolved).collect::<Result<_>>()?;
        Ok(Self { column, motion, curves, options })
    }

    /// Modulus ratios and damping ratios at the logarithms of effective strains.
    fn read(&self, logs: &[f64]) -> Vec<[f64; 2]> {
        self.curves.iter().zip(logs).map(|(curves, log)| curves.at(log.exp())).collect()
    }

    /// Motions in the linear column with these properties.
    fn inside(&self, properties: &[[f64; 2]], what: Inside) -> Result<Vec<SiteMotion>> {
        let profile = self.column.compatible(properties, Hysteretic::new)?;
        let column = SoilColumn { profile, wave: self.column.wave };
        let (step, samples) = (self.motion.time_step(), self.motion.accelerations());
        column.inside(what, self.options.control, step, samples)
    }

    /// Iterates the moduli and damping ratios, beginning at small strain.
    fn converged(&self) -> Result<Converged> {
        let EquivalentLinearOptions { strain_ratio, tolerance, most_iterations, .. } =
            *self.options;
        let mut logs = vec![f64::NEG_INFINITY; self.curves.len()];
        let (mut properties, mut aitken) = (self.read(&logs), Aitken::default());
        let mut iterations = 0;
        loop {
            iterations += 1;
            let found = self.inside(&properties, Inside::Strains)?;
            let strains: Vec<f64> = found.iter().map(SiteMotion::peak).collect();
            let log = |strain: &f64| (strain_ratio * strain).max(LEAST_STRAIN).ln();
            let found: Vec<f64> = strains.iter().map(log).collect();
            logs = if iterations == 1 { found.clone() } else { aitken.next(&logs, &found) };
            let [plain, next] = [self.read(&found), self.read(&logs)];
            let changes = [plain, next.clone()].map(|other| largest_change(&properties, &other));
            let last_change = changes[0].max(changes[1]);
            if last_change <= tolerance || iterations == most_iterations {
                return Ok(Converged { properties, strains, iterations, last_change });
            }
            properties = next;
        }
    }
}

/// Fixed-point iteration with one relaxation factor, from the last two residuals (Irons & Tuck 1969): about 1/(1 − ρ)
/// where each iteration leaves the share ρ of the distance, so that its step is an estimate of all that is left.
#[derive(Debug, Default)]
struct Aitken {
    residual: Vec<f64>,
    factor: f64,
}

impl Aitken {
    /// Next argument after `old`, whose image is `new`.
    fn next(&mut self, old: &[f64], new: &[f64]) -> Vec<f64> {
        let residual: Vec<f64> = old.iter().zip(new).map(|(old, new)| new - old).collect();
        let pairs =
            || self.residual.iter().zip(&residual).map(|(before, now)| [*before, now - before]);
        let [along, size] = pairs().fold([0.0; 2], |[a, b], [r, d]| [a + r * d, b + d * d]);
        let factor = -self.factor * along / size;
        // Without a residual before, or if the last step went astray: a plain step.
        self.factor = if factor > 0.0 { factor.clamp(FACTORS[0], FACTORS[1]) } else { 1.0 };
        let next = old.iter().zip(&residual).map(|(old, r)| old + self.factor * r).collect();
        self.residual = residual;
        next
    }
}

/// Largest change of a modulus or damping ratio, relative to the new one.
fn largest_change(old: &[[f64; 2]], new: &[[f64; 2]]) -> f64 {
    let pairs = old.as_flattened().iter().zip(new.as_flattened());
    let changes = pairs.map(|(old, new)| if old == new { 0.0 } else { (new - old).abs() / new });
    changes.fold(0.0, f64::max)
}

/// An error with its layer, counted from 0; that of a damping ratio which no law fits, as one of the layer.
fn of_layer(index: usize, error: Error) -> Error {
    let Error::Layered(LayeredError::Fit { ratio, .. }) = error else {
        return SiteError::of_layer(index, error);
    };
    let quantity = "strain-compatible damping ratio";
    let needed = "one that `constant_q` reproduces over the band (a shorter band helps)";
    SiteError::Layer { layer: index + 1, quantity, value: ratio, needed }.into()
}

impl EquivalentLinear {
    fn warn(&mut self, tolerance: f64, curves: &[Resolved], cut_off: f64) {
        for (k, (response, curves)) in self.layers.iter().zip(curves).enumerate() {
            let (layer, largest) = (k + 1, curves.largest());
            let (most, effective) = (response.largest_strain, response.effective_strain);
            if most > SiteWarning::STRAIN_LIMIT {
                self.warnings.push(SiteWarning::LargeStrain { layer, strain: most });
            }
            if effective > largest {
                self.warnings.push(SiteWarning::Extrapolated { layer, strain: effective, largest });
            }
        }
        if self.last_change > tolerance {
            let (change, iterations) = (self.last_change, self.iterations);
            self.warnings.push(SiteWarning::NotConverged { change, iterations });
        }
        if cut_off > 0.01 {
            self.warnings.push(SiteWarning::CutOff { share: cut_off });
        }
    }
}

/// A line per layer, that of the base, iterations and warnings.
impl fmt::Display for EquivalentLinear {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:>9} {:>9} {:>7} {:>9} {:>11} {:>11} {:>8}",
            "top (m)", "c_S (m/s)", "G/Gmax", "damping %", "strain %", "effective %", "peak (g)"
        )?;
        let mut peaks = self.peak_accelerations.iter().map(|peak| peak / STANDARD_GRAVITY);
        for (own, layer) in self.layers.iter().zip(self.profile.layers()) {
            writeln!(
                f,
                "{:>9.2} {:>9.1} {:>7.3} {:>9.2} {:>11.4} {:>11.4} {:>8.3}",
                own.depth,
                layer.soil.shear_wave_speed(),
                own.modulus_ratio,
                100.0 * own.damping,
                100.0 * own.largest_strain,
                100.0 * own.effective_strain,
                peaks.next().unwrap_or(f64::NAN)
            )?;
        }
        let base = peaks.next().unwrap_or(f64::NAN);
        writeln!(f, "{:>9.2} {:>60} {base:>8.3}", self.profile.depth(), "base, within")?;
        let (count, change) = (self.iterations, 100.0 * self.last_change);
        write!(f, "{count} iterations, to {change:.2} % of strain-compatible properties")?;
        self.warnings.iter().try_for_each(|warning| write!(f, "\n{warning}"))
    }
}
