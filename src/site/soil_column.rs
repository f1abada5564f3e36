//! Motions of a soil profile under vertical waves.

use std::f64::consts::TAU;

use super::part_progress::PartProgress;
use super::sampled::{SiteFunctions, evaluate};
use super::site_motion::SiteMotion;
use super::transform::{Contour, ContourPoint, Transform};
use super::vertical::{ColumnFunctions, ColumnQuantity, ControlPoint, VerticalWave};
use crate::error::{Observer, ProgressReporter, Result, not_negative};
use crate::linalg::Complex;
use crate::motion::{Record, Triaxial};
use crate::soil::SoilProfile;

/// Number of frequencies of a transfer function between two reports of progress.
const FREQUENCIES_PER_BLOCK: usize = 256;

/// Soil column: a profile under vertical waves of one kind.
///
/// Simulations use the motion of the free *surface*. A column computes this motion from a motion at depth, or a motion at
/// depth from the motion of the surface (deconvolution).
///
/// ```
/// use basemat::Soil;
/// use basemat::site::{SoilColumn, ControlPoint, VerticalWave};
/// use basemat::soil::{GeneralizedMaxwell, SoilProfile};
/// let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1800.0)?;
/// let profile = SoilProfile::on_rigid_bedrock()
///     .with_layer(soil, 10.0)?
///     .with_damping(GeneralizedMaxwell::constant_q(0.05, [0.5, 50.0], 5.0)?);
/// let column = SoilColumn::new(profile, VerticalWave::Shear)?;
/// // At the first frequency, 5 Hz, the amplification is about 2/(πξ).
/// let amplification = column.transfer(ControlPoint::Within, 5.0)?.abs();
/// assert!((amplification - 12.7).abs() < 0.2);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct SoilColumn {
    /// Layers and base.
    pub(super) profile: SoilProfile,
    /// Kind of the vertical waves.
    pub(super) wave: VerticalWave,
}

impl SoilColumn {
    /// Column of `profile` for one kind of wave.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for rigid bedrock without layers.
    pub fn new(profile: SoilProfile, wave: VerticalWave) -> Result<Self> {
        profile.check()?;
        Ok(Self { profile, wave })
    }

    /// Motion of the surface per unit motion e^(iωt) of `control` at `frequency` (Hz).
    ///
    /// Infinite at a resonance without damping.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a frequency that is negative or not finite; an error for damping laws
    /// that are not passive.
    pub fn transfer(&self, control: ControlPoint, frequency: f64) -> Result<Complex> {
        not_negative("frequency of a transfer function", frequency)?;
        let functions = ColumnFunctions::exact(
            &self.profile,
            self.wave,
            control,
            ColumnQuantity::InverseTransfer,
        );
        let mut values = [Complex::default(); 2];
        functions.evaluate_at(
            &ContourPoint::at_frequency(Complex::new(0.0, TAU * frequency)),
            &mut values,
        )?;
        Ok(surface_per_control(values[0], values[1]))
    }

    /// Motion of the surface per unit motion e^(iωt) of `control`, at many frequencies.
    ///
    /// `frequencies`: Hz. This method is faster than [`transfer`](SoilColumn::transfer) for each frequency, and has an
    /// observer.
    ///
    /// ```
    /// # use basemat::Soil;
    /// # use basemat::site::{ControlPoint, SoilColumn, VerticalWave};
    /// # use basemat::soil::SoilProfile;
    /// use std::ops::ControlFlow::Continue;
    /// let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1800.0)?;
    /// let profile = SoilProfile::on_rigid_bedrock().with_layer(soil, 10.0)?;
    /// let column = SoilColumn::new(profile, VerticalWave::Shear)?;
    /// let transfers = column.transfers(ControlPoint::Within, &[1.0, 2.5], &mut |_| Continue(()))?;
    /// // 1/cos(ωh/c), at 2.5 Hz with ωh/c = π/4.
    /// assert!((transfers[1].abs() - 2.0_f64.sqrt()).abs() < 1e-12);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Stopped`](crate::Error::Stopped); as for [`transfer`](SoilColumn::transfer).
    pub fn transfers(
        &self,
        control: ControlPoint,
        frequencies: &[f64],
        observer: &mut Observer<'_>,
    ) -> Result<Vec<Complex>> {
        let mut reporter = ProgressReporter::new("transfer function", frequencies.len(), observer);
        let functions = ColumnFunctions::exact(
            &self.profile,
            self.wave,
            control,
            ColumnQuantity::InverseTransfer,
        );
        let mut transfer_values = Vec::with_capacity(frequencies.len());
        let mut moduli = vec![];
        for block in frequencies.chunks(FREQUENCIES_PER_BLOCK) {
            for frequency in block {
                not_negative("frequency of a transfer function", *frequency)?;
            }
            let points: Vec<ContourPoint> = block
                .iter()
                .map(|frequency| ContourPoint::at_frequency(Complex::new(0.0, TAU * frequency)))
                .collect();
            let mut values = vec![Complex::default(); 2 * block.len()];
            evaluate(&functions, &points, &mut moduli, &mut values)?;
            transfer_values.extend(
                (0..block.len()).map(|k| surface_per_control(values[k], values[block.len() + k])),
            );
            reporter.reach(transfer_values.len())?;
        }
        Ok(transfer_values)
    }

    /// Motion of the surface from `motion` at `control`.
    ///
    /// The samples, `time_step` seconds apart, are displacements, velocities or accelerations. The column is initially at
    /// rest. It still moves after the end of `motion`: add quiet time there if this part is needed, as it is for a
    /// deconvolution of the result.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a time step that is not positive or samples that are not finite,
    /// [`Error::Size`](crate::Error::Size) for none, [`SoilError::NotCausal`](crate::soil::SoilError::NotCausal) for
    /// hysteretic damping, [`Error::Stopped`](crate::Error::Stopped) by the observer.
    pub fn to_surface(
        &self,
        control: ControlPoint,
        time_step: f64,
        motion: &[f64],
        observer: &mut Observer<'_>,
    ) -> Result<SiteMotion> {
        let mut reporter =
            ProgressReporter::new("motion of the surface", PartProgress::STEPS_PER_PART, observer);
        self.filtered(control, time_step, motion, surface_per_control, &mut reporter)
    }

    /// Motion at `control` from `motion` of the surface (deconvolution).
    ///
    /// Motion at depth precedes motion of the surface. The record should therefore begin and end with rest for as long
    /// as waves take through the layers: outside the record the motion of the surface is zero. In deconvolution damped
    /// layers amplify high frequencies. Remove noise from the record first.
    ///
    /// ```
    /// # use basemat::{Soil, unobserved};
    /// # use basemat::motion::el_centro_1940;
    /// # use basemat::site::{SoilColumn, ControlPoint, VerticalWave};
    /// # use basemat::soil::{GeneralizedMaxwell, SoilProfile};
    /// let rock = Soil::from_shear_wave_speed(1000.0, 0.25, 2200.0)?;
    /// let profile = SoilProfile::on_half_plane(rock)
    ///     .with_layer(Soil::from_shear_wave_speed(200.0, 0.3, 1900.0)?, 15.0)?
    ///     .with_damping(GeneralizedMaxwell::constant_q(0.05, [0.1, 30.0], 1.0)?);
    /// let column = SoilColumn::new(profile, VerticalWave::Shear)?;
    /// // Time for the motion before and after the record.
    /// let record = el_centro_1940().padded(30.0, 30.0)?;
    /// let samples = record.accelerations();
    /// let surface = column.to_surface(ControlPoint::Outcrop, 0.02, samples, &mut unobserved)?;
    /// let back = column.from_surface(ControlPoint::Outcrop, 0.02, &surface.samples, &mut unobserved)?;
    /// assert!(surface.is_whole() && back.is_whole(), "{surface}; {back}");
    /// for (computed, original) in back.samples.iter().zip(record.accelerations()) {
    ///     assert!((computed - original).abs() < 1e-9 * record.peaks().acceleration);
    /// }
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`to_surface`](SoilColumn::to_surface).
    pub fn from_surface(
        &self,
        control: ControlPoint,
        time_step: f64,
        motion: &[f64],
        observer: &mut Observer<'_>,
    ) -> Result<SiteMotion> {
        let mut reporter =
            ProgressReporter::new("motion at depth", PartProgress::STEPS_PER_PART, observer);
        self.filtered(control, time_step, motion, control_per_surface, &mut reporter)
    }

    /// Motion of the surface of `profile` in three directions from `motion` of `control`.
    ///
    /// The components along x and y are shear waves, the vertical one is a pressure wave. Each component continues after
    /// its record's end until the layers are at rest. Other losses are as for [`to_surface`](SoilColumn::to_surface).
    ///
    /// ```
    /// use basemat::{Soil, unobserved};
    /// use basemat::motion::{Triaxial, el_centro_1940};
    /// use basemat::site::{ControlPoint, SoilColumn};
    /// use basemat::soil::SoilProfile;
    /// let rock = Soil::from_shear_wave_speed(900.0, 0.25, 2300.0)?;
    /// let profile = SoilProfile::on_half_plane(rock)
    ///     .with_layer(Soil::from_shear_wave_speed(300.0, 0.3, 1900.0)?, 20.0)?;
    /// let record = el_centro_1940();
    /// let outcrop = Triaxial {
    ///     x: Some(record.clone()),
    ///     y: Some(record.scaled(0.8)?),
    ///     up: Some(record.scaled(0.5)?),
    /// };
    /// let control = ControlPoint::Outcrop;
    /// let surface = SoilColumn::surface_in_plan(&profile, control, &outcrop, &mut unobserved)?;
    /// let peak = |record: &Option<_>| record.as_ref().map_or(0.0, |record: &basemat::motion::Record| record.peaks().acceleration);
    /// assert!(peak(&surface.x) > peak(&outcrop.x));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`new`](SoilColumn::new) and [`to_surface`](SoilColumn::to_surface).
    pub fn surface_in_plan(
        profile: &SoilProfile,
        control: ControlPoint,
        motion: &Triaxial,
        observer: &mut Observer<'_>,
    ) -> Result<Triaxial> {
        let step_count = 3 * PartProgress::STEPS_PER_PART;
        let reporter = &mut ProgressReporter::new("motion of the surface", step_count, observer);
        let mut surface_record = |part_index, wave, record: Option<&Record>| {
            let mut progress = PartProgress::of_part(reporter, part_index);
            Self::surface_record(profile, wave, control, record, &mut progress)
        };
        Ok(Triaxial {
            x: surface_record(0, VerticalWave::Shear, motion.x.as_ref())?,
            y: surface_record(1, VerticalWave::Shear, motion.y.as_ref())?,
            up: surface_record(2, VerticalWave::Pressure, motion.up.as_ref())?,
        })
    }

    /// Record of the surface until the layers are at rest; `None` without a record at `control`.
    fn surface_record(
        profile: &SoilProfile,
        wave: VerticalWave,
        control: ControlPoint,
        record: Option<&Record>,
        progress: &mut PartProgress<'_, '_>,
    ) -> Result<Option<Record>> {
        let Some(record) = record else {
            progress.report(1.0)?;
            return Ok(None);
        };
        let time_step = record.time_step();
        let motion = record.accelerations();
        let column = Self::new(profile.clone(), wave)?;
        let mut surface =
            column.complete_motion(control, time_step, motion, surface_per_control, progress)?;
        surface.truncate(surface.moving_sample_count().max(motion.len()));
        Record::new(time_step, surface.samples).map(Some)
    }

    /// Filters a motion; the result has as many samples.
    fn filtered(
        &self,
        control: ControlPoint,
        time_step: f64,
        motion: &[f64],
        filter: Filter,
        reporter: &mut ProgressReporter<'_>,
    ) -> Result<SiteMotion> {
        let mut result = self.complete_motion(
            control,
            time_step,
            motion,
            filter,
            &mut PartProgress::of_whole_call(reporter),
        )?;
        result.truncate(motion.len());
        Ok(result)
    }

    /// Filters a motion; the result includes the time after the end of `motion`.
    fn complete_motion(
        &self,
        control: ControlPoint,
        time_step: f64,
        motion: &[f64],
        filter: Filter,
        progress: &mut PartProgress<'_, '_>,
    ) -> Result<SiteMotion> {
        self.profile.check_causal()?;
        let contour = Contour::new(time_step, motion.len(), self.profile.travel_time())?;
        let exact_functions = ColumnFunctions::exact(
            &self.profile,
            self.wave,
            control,
            ColumnQuantity::InverseTransfer,
        );
        let functions = exact_functions.sampled(contour.end()?)?;
        let mut moduli = vec![];
        let mut values = vec![];
        let [result] = contour.filtered(motion, progress, |points, filter_values| {
            values.resize(2 * points.len(), Complex::default());
            evaluate(&functions, points, &mut moduli, &mut values)?;
            for (k, value) in filter_values.iter_mut().enumerate() {
                *value = filter(values[k], values[points.len() + k]);
            }
            Ok(())
        })?;
        Ok(result)
    }

    /// Computes the spectra of a quantity in the column, for any damping law.
    ///
    /// `transform`: spectrum of the motion at `control`; it receives the spectra.
    pub(super) fn response(
        &self,
        quantity: ColumnQuantity,
        control: ControlPoint,
        transform: &mut Transform,
        progress: &mut PartProgress<'_, '_>,
    ) -> Result<()> {
        let exact_functions = ColumnFunctions::exact(&self.profile, self.wave, control, quantity);
        let functions = exact_functions.sampled(transform.contour().end()?)?;
        let mut moduli = vec![];
        transform.filter(functions.function_count(), false, progress, |points, results| {
            evaluate(&functions, points, &mut moduli, results)
        })
    }

    /// Contour for motions inside the column, along real frequencies.
    pub(super) fn contour(&self, time_step: f64, sample_count: usize) -> Result<Contour> {
        let contour = Contour::new(time_step, sample_count, self.profile.travel_time())?;
        Ok(contour.at_real_frequencies())
    }
}

/// Function that returns a filter from the inverse transfer function without its factor e^x, and from x.
type Filter = fn(Complex, Complex) -> Complex;

/// Surface motion per control motion.
fn surface_per_control(inverse_transfer: Complex, exponent: Complex) -> Complex {
    inverse_transfer.inverse() * (-exponent).exp()
}

/// Control motion per surface motion.
fn control_per_surface(inverse_transfer: Complex, exponent: Complex) -> Complex {
    inverse_transfer * exponent.exp()
}
