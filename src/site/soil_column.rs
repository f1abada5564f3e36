//! One-dimensional transfer functions of a soil profile, as in SHAKE (Schnabel, Lysmer & Seed 1972).
//!
//! Each layer carries Aⱼ e^(κz) up and Bⱼ e^(−κz) down, κ = s/c. With A₁ = B₁ = 1 at the free surface and
//! the impedance ratio aⱼ = √(ρⱼMⱼ/(ρⱼ₊₁Mⱼ₊₁)),
//!
//! Aⱼ₊₁ = ½ Aⱼ(1+aⱼ) e^(κh) + ½ Bⱼ(1−aⱼ) e^(−κh),   Bⱼ₊₁ = ½ Aⱼ(1−aⱼ) e^(κh) + ½ Bⱼ(1+aⱼ) e^(−κh)
//!
//! the outcrop of the base moves by 2Aₙ, its top within by Aₙ + Bₙ, the surface by 2.

use super::sampled::Sampled;
use super::transform::{Contour, Place, SiteMotion};
use crate::error::{Result, not_negative};
use crate::linalg::Complex;
use crate::motion::{Record, Triaxial};
use crate::soil::{Soil, SoilProfile};

/// Kind of wave that travels along a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum VerticalWave {
    /// Shear waves: horizontal motion.
    #[default]
    Shear,
    /// Pressure waves: vertical motion.
    Pressure,
}

/// Place to which a motion at depth belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum ControlPoint {
    /// The surface of the base where no layers cover it: rock outcrop.
    #[default]
    Outcrop,
    /// The base under the layers, with what they send back. The same as the outcrop if it is rigid.
    Within,
}

/// A soil profile as a column that waves travel up and down.
///
/// Simulations take the motion of the free *surface*; a column makes it of a motion at depth, or goes
/// the other way (deconvolution).
///
/// ```
/// use basemat::Soil;
/// use basemat::site::{SoilColumn, ControlPoint, VerticalWave};
/// use basemat::soil::{GeneralizedMaxwell, SoilProfile};
/// let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1800.0)?;
/// let profile = SoilProfile::on_rigid_base()
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

/// Motion inside a column that is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Inside {
    /// Acceleration at the tops of all layers and of the base.
    Accelerations,
    /// Strain in the middle of all layers.
    Strains,
}

/// Waves at the top of a layer or the base, and how far that one and those above it are, κh.
#[derive(Debug, Clone, Copy)]
struct Waves {
    up: Complex,
    down: Complex,
    above: Complex,
    own: Complex,
}

impl SoilColumn {
    /// Column of `profile` for one kind of wave.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for a rigid base without layers.
    pub fn new(profile: SoilProfile, wave: VerticalWave) -> Result<Self> {
        profile.check()?;
        Ok(Self { profile, wave })
    }

    /// Motion of the surface by that of `control` for e^(iωt) at `frequency` (Hz).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a frequency that is negative or not finite; as for damping laws that
    /// are not passive; infinite at a resonance without damping.
    pub fn transfer(&self, control: ControlPoint, frequency: f64) -> Result<Complex> {
        not_negative("frequency of a transfer function", frequency)?;
        let s = Complex::new(0.0, std::f64::consts::TAU * frequency);
        let mut layers =
            Sampled::exact(&self.profile, |soil, modulus, _| self.slowness(soil, modulus));
        let (value, decay) =
            self.inverse_transfer(control, &Place::alone(s), &mut layers, |_| ())?;
        Ok(value.inverse() * (-decay).exp())
    }

    /// Motion of the surface from `motion` at `control`, samples `time_step` seconds apart; any
    /// of displacement, velocity and acceleration. The column is at rest at first. It rings after the
    /// end of `motion`: give that quiet time if the rest matters, as it does on the way back.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a bad time step or samples that are not finite,
    /// [`Error::Size`](crate::Error::Size) for none, [`LayeredError::NotCausal`](crate::LayeredError::NotCausal) for
    /// hysteretic damping.
    pub fn to_surface(
        &self,
        control: ControlPoint,
        time_step: f64,
        motion: &[f64],
    ) -> Result<SiteMotion> {
        self.filtered(control, time_step, motion, |value, decay| value.inverse() * (-decay).exp())
    }

    /// Motion at `control` from `motion` of the surface (deconvolution). It comes before that of the
    /// surface, so the record should begin with rest for as long as waves take through the layers,
    /// and end with it: the surface is taken to stand still before and after. Damped layers
    /// amplify high frequencies on the way down, so the record should have none that are noise.
    ///
    /// ```
    /// # use basemat::Soil;
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
    /// let surface = column.to_surface(ControlPoint::Outcrop, 0.02, record.accelerations())?;
    /// let back = column.from_surface(ControlPoint::Outcrop, 0.02, &surface.samples)?;
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
    ) -> Result<SiteMotion> {
        self.filtered(control, time_step, motion, |value, decay| value * decay.exp())
    }

    /// Motion of the surface of `profile` in three directions by that of `control`: shear waves carry the components
    /// along x and y, pressure waves the vertical one. Each goes on after its record's end until the layers are at
    /// rest; [`to_surface`](SoilColumn::to_surface) says what else it loses.
    ///
    /// ```
    /// use basemat::Soil;
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
    /// let surface = SoilColumn::surface_in_plan(&profile, ControlPoint::Outcrop, &outcrop)?;
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
    ) -> Result<Triaxial> {
        let through = |wave, record: &Option<Record>| -> Result<Option<Record>> {
            let Some(record) = record else { return Ok(None) };
            let (step, motion) = (record.time_step(), record.accelerations());
            let own = Self::new(profile.clone(), wave)?;
            let mut found =
                own.whole(control, step, motion, |value, decay| value.inverse() * (-decay).exp())?;
            found.cut(found.duration().max(motion.len()));
            Record::new(step, found.samples).map(Some)
        };
        Ok(Triaxial {
            x: through(VerticalWave::Shear, &motion.x)?,
            y: through(VerticalWave::Shear, &motion.y)?,
            up: through(VerticalWave::Pressure, &motion.up)?,
        })
    }

    /// Stiffness of this kind of wave.
    fn stiffness(&self, soil: Soil, modulus: Complex) -> Complex {
        match self.wave {
            VerticalWave::Shear => modulus,
            VerticalWave::Pressure => modulus.scale(1.0 / soil.speed_ratio_squared()),
        }
    }

    /// 1/c.
    fn slowness(&self, soil: Soil, modulus: Complex) -> [Complex; 1] {
        [self.stiffness(soil, modulus).scale(1.0 / soil.density()).sqrt().inverse()]
    }

    /// Control motion by surface motion, with a factor e^decay taken out: it may leave the range of
    /// f64. Shows the waves at the tops of layers and base on the way down.
    fn inverse_transfer(
        &self,
        control: ControlPoint,
        place: &Place,
        layers: &mut Sampled<impl Fn(Soil, Complex, Complex) -> [Complex; 1], 1>,
        mut see: impl FnMut(Waves),
    ) -> Result<(Complex, Complex)> {
        let (moduli, travels) = layers.at(place)?;
        let mut impedances = self.profile.soils().zip(moduli).map(|((soil, _), modulus)| {
            let speed = self.stiffness(soil, *modulus).scale(1.0 / soil.density()).sqrt();
            speed.scale(soil.density())
        });
        let (mut up, mut down) = (Complex::real(1.0), Complex::real(1.0));
        let mut total = Complex::default();
        let Some(mut impedance) = impedances.next() else {
            return Ok((up, total));
        };
        for [travel] in travels {
            see(Waves { up, down, above: total, own: *travel });
            down = down * travel.scale(-2.0).exp();
            total += *travel;
            let Some(next) = impedances.next() else {
                see(Waves { up, down, above: total, own: Complex::default() });
                // A rigid base moves as the layer's bottom does.
                return Ok(((up + down).scale(0.5), total));
            };
            let ratio = impedance / next;
            let (sum, difference) = ((up + down).scale(0.5), (up - down) * ratio.scale(0.5));
            (up, down) = (sum + difference, sum - difference);
            impedance = next;
        }
        see(Waves { up, down, above: total, own: Complex::default() });
        Ok(match control {
            ControlPoint::Outcrop => (up, total),
            ControlPoint::Within => ((up + down).scale(0.5), total),
        })
    }

    /// `motion` times a function of the inverse transfer function and its decay.
    fn filtered(
        &self,
        control: ControlPoint,
        time_step: f64,
        motion: &[f64],
        filter: impl Fn(Complex, Complex) -> Complex,
    ) -> Result<SiteMotion> {
        let mut found = self.whole(control, time_step, motion, filter)?;
        found.cut(motion.len());
        Ok(found)
    }

    /// Motion at the surface, with its part after the end of `motion`.
    fn whole(
        &self,
        control: ControlPoint,
        time_step: f64,
        motion: &[f64],
        filter: impl Fn(Complex, Complex) -> Complex,
    ) -> Result<SiteMotion> {
        self.profile.check_causal()?;
        let contour = Contour::new(time_step, motion.len(), self.profile.travel_time())?;
        let slowness = |soil, modulus, _| self.slowness(soil, modulus);
        let mut layers = Sampled::new(&self.profile, slowness, contour.end()?)?;
        let [found] = contour.filtered(motion, |place| {
            let (value, decay) = self.inverse_transfer(control, place, &mut layers, |_| ())?;
            Ok([filter(value, decay)])
        })?;
        Ok(found)
    }

    /// Motions inside the column from `motion` at `control`, of any damping law, with what follows the end of `motion`.
    pub(super) fn inside(
        &self,
        what: Inside,
        control: ControlPoint,
        time_step: f64,
        motion: &[f64],
    ) -> Result<Vec<SiteMotion>> {
        let contour = Contour::new(time_step, motion.len(), self.profile.travel_time())?;
        let contour = contour.at_real_frequencies();
        let slowness = |soil, modulus, _| self.slowness(soil, modulus);
        let mut layers = Sampled::new(&self.profile, slowness, contour.end()?)?;
        let thicknesses = self.profile.layers().iter().map(|layer| layer.thickness);
        let thicknesses: Vec<f64> = thicknesses.collect();
        let count = thicknesses.len() + usize::from(what == Inside::Accelerations);
        let mut tops = Vec::with_capacity(count + 1);
        contour.filtered_by(motion, count, |place, found| {
            tops.clear();
            let see = |waves| tops.push(waves);
            let (value, decay) = self.inverse_transfer(control, place, &mut layers, see)?;
            let scale = value.inverse().scale(0.5);
            for (k, (found, Waves { up, down, above, own })) in
                found.iter_mut().zip(&tops).enumerate()
            {
                let (amplitude, depth) = match what {
                    Inside::Accelerations => (*up + *down, *above),
                    Inside::Strains => {
                        let half = own.scale(0.5);
                        let wavenumber = own.scale(1.0 / thicknesses[k]) / (place.s * place.s);
                        ((*up - *down * (-*own).exp()) * wavenumber, *above + half)
                    }
                };
                *found = amplitude * scale * (depth - decay).exp();
            }
            Ok(())
        })
    }
}
