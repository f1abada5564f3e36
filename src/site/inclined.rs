//! Inclined SV, P and SH waves over a soil profile.

use std::f64::consts::{PI, TAU};

use super::oblique::{InclinedControl, SurfaceFunctions, WaveKind};
use super::part_progress::PartProgress;
use super::sampled::{SiteFunctions, evaluate};
use super::site_motion::SiteMotion;
use super::slowness::IncidentWave;
use super::transform::{Contour, ContourPoint};
use crate::error::{
    Error, Observer, ProgressReporter, Result, SoilError, finite, not_negative, positive,
};
use crate::linalg::Complex;
use crate::motion::{PlaneWave, Record, TravellingWave, Triaxial, check_prescribed};
use crate::soil::{Bedrock, Soil, SoilProfile};

/// Plane SV, P or SH wave from the half-plane below a soil profile, at an angle.
///
/// With the horizontal slowness p = sin θ/c from the base's elastic constants, all layers move as f(t − px). The wave is
/// refracted and reflected in all layers, and the surface moves horizontally and vertically. At vertical incidence the
/// surface moves as that of a [`SoilColumn`](super::SoilColumn), without layers as under a [`PlaneWave`]. The wave speed
/// of a damped base is complex, but p is real, so that the amplitude is the same everywhere along the surface.
///
/// ```
/// use basemat::Soil;
/// use basemat::motion::{FreeField, el_centro_1940};
/// use basemat::site::{InclinedControl, InclinedWave};
/// use basemat::soil::{GeneralizedMaxwell, SoilProfile};
/// let damping = |ratio| GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0);
/// let profile = SoilProfile::on_half_plane(Soil::from_shear_wave_speed(800.0, 0.25, 2300.0)?)
///     .with_bedrock_damping(damping(0.01)?)
///     .with_layer(Soil::from_shear_wave_speed(200.0, 0.3, 1900.0)?, 12.0)?
///     .with_damping(damping(0.05)?);
/// // SV at 20° in the rock, whose outcrop moves as El Centro; x = −5 m is reached first.
/// let wave = InclinedWave::sv(profile, 20.0_f64.to_radians())?;
/// let field = wave.field(InclinedControl::OutcropHorizontal, &el_centro_1940(), -5.0)?;
/// let [there, later] = [field.displacement(-5.0, 4.0), field.displacement(5.0, 4.0 + 10.0 / wave.apparent_velocity())];
/// assert!((there[0] - later[0]).abs() < 1e-12 && there[1] != 0.0);
/// // Near the layer's first frequency the surface moves more than the outcrop.
/// let [horizontal, _] = wave.transfer(InclinedControl::OutcropHorizontal, 200.0 / 48.0)?;
/// assert!(horizontal.abs() > 2.0);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct InclinedWave {
    /// Layers, and the half-plane below.
    profile: SoilProfile,
    /// Soil of the half-plane.
    base: Soil,
    wave_kind: WaveKind,
    /// Horizontal slowness, s/m.
    slowness: f64,
    incident_wave: IncidentWave,
    /// Plane wave in the base without layers.
    outcrop: PlaneWave,
}

impl InclinedWave {
    /// SV wave below `profile`, at `angle` (rad) from the vertical in the base.
    ///
    /// The wave runs to the right if the angle is positive.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless |`angle`| < π/2, and as for [`PlaneWave::sv`];
    /// [`Error::Scene`](crate::Error::Scene) for rigid bedrock.
    pub fn sv(profile: SoilProfile, angle: f64) -> Result<Self> {
        Self::new(profile, angle, WaveKind::Sv)
    }

    /// SH wave, as for [`InclinedWave::sv`], for a ground in plan.
    ///
    /// Its horizontal motion is perpendicular to its direction: along y if it runs along x. It has no vertical motion. A
    /// mat under which it passes twists.
    ///
    /// ```
    /// use basemat::Soil;
    /// use basemat::motion::{FreeField, el_centro_1940};
    /// use basemat::site::{InclinedControl, InclinedWave};
    /// use basemat::soil::SoilProfile;
    /// let profile = SoilProfile::on_half_plane(Soil::from_shear_wave_speed(800.0, 0.25, 2300.0)?)
    ///     .with_layer(Soil::from_shear_wave_speed(200.0, 0.3, 1900.0)?, 12.0)?;
    /// let wave = InclinedWave::sh(profile, 30.0_f64.to_radians())?;
    /// let control = InclinedControl::OutcropHorizontal;
    /// // Runs along y: it moves the ground along x.
    /// let field = wave.field(control, &el_centro_1940(), -5.0)?.with_azimuth(std::f64::consts::FRAC_PI_2)?;
    /// let [x, y, up] = field.displacement_at([0.0, 5.0], 4.0);
    /// assert!(x != 0.0 && y.abs() < 1e-12 && up == 0.0);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`InclinedWave::sv`]; [`InclinedWave::field`] returns an error for
    /// [`InclinedControl::OutcropVertical`].
    pub fn sh(profile: SoilProfile, angle: f64) -> Result<Self> {
        Self::new(profile, angle, WaveKind::Sh)
    }

    /// P wave, as for [`InclinedWave::sv`].
    ///
    /// # Errors
    /// As for [`InclinedWave::sv`].
    pub fn p(profile: SoilProfile, angle: f64) -> Result<Self> {
        Self::new(profile, angle, WaveKind::P)
    }

    /// Wave of this kind at `angle` (rad) from the vertical in the base.
    fn new(profile: SoilProfile, angle: f64, wave_kind: WaveKind) -> Result<Self> {
        let Bedrock::HalfPlane { soil: base, .. } = *profile.bedrock() else {
            let needed = "waves at an angle come from a half-plane below the layers, not from rigid bedrock \
                          (site::SoilColumn computes the surface motion from that of rigid bedrock)";
            return Err(Error::Scene { quantity: "inclined wave", needed });
        };
        let outcrop = match wave_kind {
            WaveKind::Sv => PlaneWave::sv(base, angle)?,
            WaveKind::P => PlaneWave::p(base, angle)?,
            WaveKind::Sh => PlaneWave::sh(base, angle)?,
        };
        let wave_speed = match wave_kind {
            WaveKind::Sv | WaveKind::Sh => base.shear_wave_speed(),
            WaveKind::P => base.pressure_wave_speed(),
        };
        let incident_wave = IncidentWave { slowness: 1.0 / wave_speed, cosine: angle.cos() };
        Ok(Self {
            profile,
            base,
            wave_kind,
            slowness: angle.sin() / wave_speed,
            incident_wave,
            outcrop,
        })
    }

    /// Velocity (m/s) of the wave along the surface, positive to the right.
    ///
    /// Infinite at vertical incidence.
    pub fn apparent_velocity(&self) -> f64 {
        1.0 / self.slowness
    }

    /// Motion of the surface, horizontal and up, per unit motion e^(iωt) of `control`.
    ///
    /// At `frequency` (Hz). Angles beyond the critical one and any damping are allowed.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a frequency that is negative or not finite, for a prescribed
    /// component of the outcrop that is less than a tenth of the other, and for a motion that is not finite (a
    /// free surface wave of an undamped layer); as for damping laws that are not passive.
    pub fn transfer(&self, control: InclinedControl, frequency: f64) -> Result<[Complex; 2]> {
        not_negative("frequency of a transfer function", frequency)?;
        self.check_control(control)?;
        let mut motion = [Complex::default(); 2];
        let point = ContourPoint::at_frequency(Complex::new(0.0, TAU * frequency));
        self.functions(control).evaluate_at(&point, &mut motion)?;
        check_motion(&motion)?;
        Ok(motion)
    }

    /// Motion of the surface, horizontal and up, from `motion` of `control` at the same x.
    ///
    /// The samples, `time_step` seconds apart, are displacements, velocities or accelerations. The ground is initially at
    /// rest. It still moves after the end of `motion`, as in a [`SoilColumn`](super::SoilColumn).
    ///
    /// # Errors
    /// As for [`InclinedWave::transfer`] and [`SoilColumn::to_surface`](super::SoilColumn::to_surface);
    /// [`SoilError::BeyondCritical`] if waves are evanescent in a layer, so that they have no first arrival.
    pub fn to_surface(
        &self,
        control: InclinedControl,
        time_step: f64,
        motion: &[f64],
        observer: &mut Observer<'_>,
    ) -> Result<[SiteMotion; 2]> {
        let reporter = &mut ProgressReporter::new(
            "motion of the surface",
            PartProgress::STEPS_PER_PART,
            observer,
        );
        let mut components = self.filtered(control, time_step, motion, reporter)?;
        for component in &mut components {
            component.truncate(motion.len());
        }
        Ok(components)
    }

    /// Motion of the surface during and after the samples of `motion`.
    fn filtered(
        &self,
        control: InclinedControl,
        time_step: f64,
        motion: &[f64],
        reporter: &mut ProgressReporter<'_>,
    ) -> Result<[SiteMotion; 2]> {
        positive("time step of a motion", time_step)?;
        self.check_control(control)?;
        self.profile.check_causal()?;
        self.check_first_arrival(PI / time_step)?;
        let contour = Contour::new(time_step, motion.len(), self.profile.travel_time())?;
        let functions = self.functions(control).sampled(contour.end()?)?;
        let mut moduli = vec![];
        contour.filtered(motion, &mut PartProgress::of_whole_call(reporter), |points, values| {
            evaluate(&functions, points, &mut moduli, values)?;
            check_motion(values)
        })
    }

    /// The free field in which `record` is the motion of `control` below `origin` (m).
    ///
    /// `origin` is the edge of the base that the wave reaches first. The motion continues after the record's end
    /// until the layers are at rest. [`InclinedWave::to_surface`] returns the size of
    /// the parts that are lost before t = 0 and near the highest frequency.
    ///
    /// # Errors
    /// As for [`InclinedWave::to_surface`]; [`Error::Input`](crate::Error::Input) for an origin that is not finite.
    pub fn field(
        &self,
        control: InclinedControl,
        record: &Record,
        origin: f64,
    ) -> Result<TravellingWave> {
        let surface = self.surface(control, record, &mut ProgressReporter::unobserved())?;
        TravellingWave::new(surface, self.apparent_velocity(), origin)
    }

    /// Records of the surface motion of [`InclinedWave::field`], with an observer.
    ///
    /// Along x, or along y for an SH wave, and up.
    ///
    /// # Errors
    /// [`Error::Stopped`](crate::Error::Stopped); as for [`InclinedWave::to_surface`].
    pub fn surface_records(
        &self,
        control: InclinedControl,
        record: &Record,
        observer: &mut Observer<'_>,
    ) -> Result<Triaxial> {
        let mut reporter =
            ProgressReporter::new("motion of the surface", PartProgress::STEPS_PER_PART, observer);
        self.surface(control, record, &mut reporter)
    }

    /// Records of the surface until the layers are at rest.
    fn surface(
        &self,
        control: InclinedControl,
        record: &Record,
        reporter: &mut ProgressReporter<'_>,
    ) -> Result<Triaxial> {
        let time_step = record.time_step();
        let [mut horizontal, mut vertical] =
            self.filtered(control, time_step, record.accelerations(), reporter)?;
        let sample_count = horizontal
            .moving_sample_count()
            .max(vertical.moving_sample_count())
            .max(record.len());
        horizontal.truncate(sample_count);
        vertical.truncate(sample_count);
        let horizontal = Some(Record::new(time_step, horizontal.samples)?);
        if self.wave_kind == WaveKind::Sh {
            return Ok(Triaxial { y: horizontal, ..Triaxial::default() });
        }
        let up = Some(Record::new(time_step, vertical.samples)?);
        Ok(Triaxial { x: horizontal, up, y: None })
    }

    /// Error if the prescribed component of the outcrop is too small.
    fn check_control(&self, control: InclinedControl) -> Result<()> {
        let amplitudes = self.outcrop.amplification().map(|[re, im]| re.hypot(im));
        let horizontal = amplitudes[0] + self.outcrop.amplification_across();
        let vertical = amplitudes[1];
        match control {
            InclinedControl::OutcropHorizontal => check_prescribed(
                "horizontal motion of the outcrop over the largest",
                horizontal,
                vertical,
            ),
            InclinedControl::OutcropVertical => check_prescribed(
                "vertical motion of the outcrop over the largest",
                vertical,
                horizontal,
            ),
            InclinedControl::Incident => Ok(()),
        }
    }

    /// Error if waves are evanescent in a layer, where motion would precede its cause.
    ///
    /// `highest_frequency`: rad/s. Waves are fastest at the highest frequency, since layers are stiffest there.
    fn check_first_arrival(&self, highest_frequency: f64) -> Result<()> {
        let mut moduli = vec![];
        let s = Complex::real(finite("highest frequency of a motion", highest_frequency)?);
        self.profile.moduli(s, &mut moduli)?;
        for (index, ((soil, _), modulus)) in self.profile.soils().zip(&moduli).enumerate() {
            let squared_speed_ratio =
                if self.wave_kind == WaveKind::Sh { 1.0 } else { soil.speed_ratio_squared() };
            let limit = (soil.density() * squared_speed_ratio / modulus.re).sqrt();
            let slowness = self.slowness.abs();
            if slowness >= limit {
                let layer = index + 1;
                return Err(SoilError::BeyondCritical { layer, slowness, limit }.into());
            }
        }
        Ok(())
    }

    /// Motion of the surface, horizontal and up, as functions of s.
    fn functions(&self, control: InclinedControl) -> SurfaceFunctions<'_> {
        let Self { profile, base, wave_kind, slowness, incident_wave, .. } = self;
        SurfaceFunctions::exact(profile, *base, *wave_kind, control, *slowness, *incident_wave)
    }
}

/// Error for a motion that is not finite.
fn check_motion(values: &[Complex]) -> Result<()> {
    for value in values {
        finite("motion of the surface under an inclined wave", value.re + value.im)?;
    }
    Ok(())
}
