//! Motions of a soil profile under vertical waves.

use std::f64::consts::TAU;

use super::sampled::{SiteFunctions, evaluate};
use super::site_motion::SiteMotion;
use super::transform::PartProgress;
use super::transform::{Contour, ContourPoint, Transform};
use super::vertical::{ColumnFunctions, ColumnQuantity, ControlPoint, VerticalWave};
use crate::error::{Observer, ProgressReporter, Result, not_negative};
use crate::linalg::Complex;
use crate::motion::{Record, Triaxial};
use crate::soil::SoilProfile;

/// Number of frequencies of a transfer function that are computed together.
const FREQUENCIES_PER_BLOCK: usize = 256;

/// A soil profile as a column for vertical waves.
///
/// Simulations use the motion of the free *surface*. A column computes it from a motion at depth, or the motion at
/// depth from the surface (deconvolution).
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
/// // At the first frequency, 5 Hz, about 2/(πξ).
/// let found = column.transfer(ControlPoint::Within, 5.0)?.abs();
/// assert!((found - 12.7).abs() < 0.2);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct SoilColumn {
    pub(super) profile: SoilProfile,
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
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a frequency that is negative or not finite; as for damping laws
    /// that are not passive; infinite at a resonance without damping.
    pub fn transfer(&self, control: ControlPoint, frequency: f64) -> Result<Complex> {
        not_negative("frequency of a transfer function", frequency)?;
        let functions =
            ColumnFunctions::exact(&self.profile, self.wave, control, ColumnQuantity::Inverse);
        let mut found = [Complex::default(); 2];
        functions.evaluate_at(
            &ContourPoint::at_frequency(Complex::new(0.0, TAU * frequency)),
            &mut found,
        )?;
        Ok(upwards(found[0], found[1]))
    }

    /// Motion of the surface per unit motion e^(iωt) of `control`, at many frequencies.
    ///
    /// `frequencies`: Hz. With an observer; faster than [`transfer`](SoilColumn::transfer) for each frequency.
    ///
    /// ```
    /// # use basemat::Soil;
    /// # use basemat::site::{ControlPoint, SoilColumn, VerticalWave};
    /// # use basemat::soil::SoilProfile;
    /// use std::ops::ControlFlow::Continue;
    /// let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1800.0)?;
    /// let profile = SoilProfile::on_rigid_bedrock().with_layer(soil, 10.0)?;
    /// let column = SoilColumn::new(profile, VerticalWave::Shear)?;
    /// let found = column.transfers(ControlPoint::Within, &[1.0, 2.5], &mut |_| Continue(()))?;
    /// // 1/cos(ωh/c), at 2.5 Hz with ωh/c = π/4.
    /// assert!((found[1].abs() - 2.0_f64.sqrt()).abs() < 1e-12);
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
        let mut watch = ProgressReporter::new("transfer function", frequencies.len(), observer);
        let functions =
            ColumnFunctions::exact(&self.profile, self.wave, control, ColumnQuantity::Inverse);
        let mut found = Vec::with_capacity(frequencies.len());
        let mut moduli = vec![];
        for block in frequencies.chunks(FREQUENCIES_PER_BLOCK) {
            for frequency in block {
                not_negative("frequency of a transfer function", *frequency)?;
            }
            let places: Vec<ContourPoint> = block
                .iter()
                .map(|frequency| ContourPoint::at_frequency(Complex::new(0.0, TAU * frequency)))
                .collect();
            let mut values = vec![Complex::default(); 2 * block.len()];
            evaluate(&functions, &places, &mut moduli, &mut values)?;
            found.extend((0..block.len()).map(|k| upwards(values[k], values[block.len() + k])));
            watch.reach(found.len())?;
        }
        Ok(found)
    }

    /// Motion of the surface from `motion` at `control`.
    ///
    /// Samples are `time_step` seconds apart: displacement, velocity or acceleration. The column is at rest at
    /// first. It still moves after the end of `motion`: add quiet time there if this part matters, as it does on
    /// the way back.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a bad time step or samples that are not finite,
    /// [`Error::Size`](crate::Error::Size) for none, [`SoilError::NotCausal`](crate::soil::SoilError::NotCausal) for
    /// hysteretic damping, [`Error::Stopped`](crate::Error::Stopped) by the observer.
    pub fn to_surface(
        &self,
        control: ControlPoint,
        time_step: f64,
        motion: &[f64],
        observer: &mut Observer<'_>,
    ) -> Result<SiteMotion> {
        let mut watch =
            ProgressReporter::new("motion of the surface", PartProgress::STEPS_PER_PART, observer);
        self.filtered(control, time_step, motion, upwards, &mut watch)
    }

    /// Motion at `control` from `motion` of the surface (deconvolution).
    ///
    /// Motion at depth precedes motion of the surface. The record should therefore begin and end with rest for as
    /// long as waves take through the layers: outside the record the surface counts as still. On the way down
    /// damped layers amplify high frequencies, so remove noise from the record before.
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
    /// // Room for what comes before and after.
    /// let record = el_centro_1940().padded(30.0, 30.0)?;
    /// let samples = record.accelerations();
    /// let surface = column.to_surface(ControlPoint::Outcrop, 0.02, samples, &mut unobserved)?;
    /// let back = column.from_surface(ControlPoint::Outcrop, 0.02, &surface.samples, &mut unobserved)?;
    /// assert!(surface.is_whole() && back.is_whole(), "{surface}; {back}");
    /// for (found, given) in back.samples.iter().zip(record.accelerations()) {
    ///     assert!((found - given).abs() < 1e-9 * record.peaks().acceleration);
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
        let mut watch =
            ProgressReporter::new("motion at depth", PartProgress::STEPS_PER_PART, observer);
        self.filtered(control, time_step, motion, downwards, &mut watch)
    }

    /// Motion of the surface of `profile` in three directions from `motion` of `control`.
    ///
    /// Shear waves carry the components along x and y, pressure waves the vertical one. Each component continues
    /// after its record's end until the layers are at rest. Other losses are as for
    /// [`to_surface`](SoilColumn::to_surface).
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
    /// let peak = |record: &Option<_>| record.as_ref().map_or(0.0, |own: &basemat::motion::Record| own.peaks().acceleration);
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
        let steps = 3 * PartProgress::STEPS_PER_PART;
        let watch = &mut ProgressReporter::new("motion of the surface", steps, observer);
        let mut surface_record = |part, wave, record: Option<&Record>| {
            let mut progress = PartProgress::part(watch, part);
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
            progress.reach(1.0)?;
            return Ok(None);
        };
        let step = record.time_step();
        let motion = record.accelerations();
        let column = Self::new(profile.clone(), wave)?;
        let mut found = column.whole(control, step, motion, upwards, progress)?;
        found.cut(found.duration().max(motion.len()));
        Record::new(step, found.samples).map(Some)
    }

    /// `motion` times a function of the inverse transfer function and its exponent.
    fn filtered(
        &self,
        control: ControlPoint,
        time_step: f64,
        motion: &[f64],
        filter: Filter,
        watch: &mut ProgressReporter<'_>,
    ) -> Result<SiteMotion> {
        let mut found =
            self.whole(control, time_step, motion, filter, &mut PartProgress::whole(watch))?;
        found.cut(motion.len());
        Ok(found)
    }

    /// Motion at the other end, including the part after the end of `motion`.
    fn whole(
        &self,
        control: ControlPoint,
        time_step: f64,
        motion: &[f64],
        filter: Filter,
        progress: &mut PartProgress<'_, '_>,
    ) -> Result<SiteMotion> {
        self.profile.check_causal()?;
        let contour = Contour::new(time_step, motion.len(), self.profile.travel_time())?;
        let functions =
            ColumnFunctions::exact(&self.profile, self.wave, control, ColumnQuantity::Inverse);
        let functions = functions.sampled(contour.end()?)?;
        let mut moduli = vec![];
        let mut values = vec![];
        let [found] = contour.filtered(motion, progress, |places, found| {
            values.resize(2 * places.len(), Complex::default());
            evaluate(&functions, places, &mut moduli, &mut values)?;
            for (k, found) in found.iter_mut().enumerate() {
                *found = filter(values[k], values[places.len() + k]);
            }
            Ok(())
        })?;
        Ok(found)
    }

    /// Spectra inside the column from the motion at `control` in `transform`, for any damping law.
    pub(super) fn response(
        &self,
        quantity: ColumnQuantity,
        control: ControlPoint,
        transform: &mut Transform,
        progress: &mut PartProgress<'_, '_>,
    ) -> Result<()> {
        let functions = ColumnFunctions::exact(&self.profile, self.wave, control, quantity);
        let functions = functions.sampled(transform.contour().end()?)?;
        let mut moduli = vec![];
        transform.filter(functions.count(), false, progress, |places, found| {
            evaluate(&functions, places, &mut moduli, found)
        })
    }

    /// Contour for motions inside the column, which are computed at real frequencies only.
    pub(super) fn contour(&self, time_step: f64, samples: usize) -> Result<Contour> {
        let contour = Contour::new(time_step, samples, self.profile.travel_time())?;
        Ok(contour.at_real_frequencies())
    }
}

/// Function of the inverse transfer function without its factor e^x, and of x.
type Filter = fn(Complex, Complex) -> Complex;

/// Surface motion by control motion.
fn upwards(value: Complex, travel: Complex) -> Complex {
    value.inverse() * (-travel).exp()
}

/// Control motion by surface motion.
fn downwards(value: Complex, travel: Complex) -> Complex {
    value * travel.exp()
}
