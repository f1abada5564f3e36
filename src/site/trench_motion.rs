//! Waves from below at the faces of a trench.

use super::part_progress::PartProgress;
use super::trench_waves::{LevelRecords, SurfaceRecords, TrenchWaves, VALUES_PER_LEVEL};
use crate::bem::ContactElement;
use crate::bem::embedded::TrenchGround;
use crate::error::{Observer, ProgressReporter, Result};
use crate::linalg::gauss;
use crate::motion::{FreeField, Record, SlownessAndOrigin, TravellingWave, VerticalIncidence};

/// Free field of a trench: waves from below a surface whose motion is known.
///
/// Motion and stresses at depth are computed in the profile without trench. Motion at depth precedes the motion of the
/// surface. A run starts from rest, so the record should begin with rest for as long as waves take from the base to the
/// surface ([`Record::padded`]).
///
/// A run on a ground with other elements, soils or backfill returns an error. Soils with a user's damping law are
/// compared only if the law has an [identity](crate::soil::Relaxation::identity).
///
/// ```
/// use basemat::bem::embedded::{Trench, TrenchGround};
/// use basemat::motion::{FreeField, el_centro_1940};
/// use basemat::site::TrenchMotion;
/// use basemat::{Soil, unobserved};
/// let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0)?;
/// let elements = Trench::new(-6.0..6.0, 5.0)?.elements(6, 4)?;
/// let ground = TrenchGround::new(soil, elements.clone())?;
/// let record = el_centro_1940().padded(1.0, 1.0)?;
/// let motion = TrenchMotion::new(&ground, record.clone(), &mut unobserved)?;
/// // Waves of the half-plane: the mean of the surface's motion 5 m/(200 m/s) earlier and later.
/// let [mut displacement, mut impulse] = [vec![0.0; 28], vec![0.0; 28]];
/// assert!(motion.at_faces(&elements.elements(), 4.0, &mut displacement, &mut impulse));
/// let shear_at_base = 14 + 4;
/// let at = |time: f64| record.at(time).displacement;
/// assert!((displacement[shear_at_base] - 0.5 * (at(3.975) + at(4.025))).abs() < 2e-6);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct TrenchMotion {
    /// Motion of the surface at the origin.
    surface: VerticalIncidence,
    /// Time by which the records of `surface` begin before those of the wave, s.
    lead_time: f64,
    /// Records of the motion that the caller passed.
    input_records: Vec<Record>,
    /// Contact elements of the trench.
    elements: Vec<ContactElement>,
    /// Numbers that are equal only for equal soils; `None` for soils without an identity.
    soil_identity: Option<Vec<f64>>,
    /// Horizontal slowness, s/m.
    slowness: f64,
    /// The x at which the surface has the motion `surface`, m.
    origin: f64,
    /// Motion at depth due to the components of `surface`.
    components: Vec<DepthMotion>,
}

/// Motion at depth due to one component of the surface's motion.
#[derive(Debug, Clone)]
struct DepthMotion {
    /// Time by which the records begin before the motion of the surface, s.
    lead_time: f64,
    /// Velocity (m/s) of the padded record at the beginning of the surface's motion.
    ///
    /// The motion at depth is corrected by this velocity.
    drift_velocity: f64,
    /// Records for the elements of a wall, from the surface down, and for the base.
    records_by_level: Vec<LevelRecords>,
}

impl TrenchMotion {
    /// Vertical waves around the trench of `ground`, from the `motion` of the surface without it.
    ///
    /// The horizontal record is that of shear waves, the vertical record that of pressure waves.
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene) for a ground with backfill;
    /// [`Error::Input`](crate::Error::Input) for a record that the soil amplifies more than a hundredfold on the way
    /// down; [`SoilError::NotCausal`](crate::soil::SoilError::NotCausal) for hysteretic damping;
    /// [`Error::Stopped`](crate::Error::Stopped) by the observer.
    pub fn new(
        ground: &TrenchGround,
        motion: impl Into<VerticalIncidence>,
        observer: &mut Observer<'_>,
    ) -> Result<Self> {
        let surface: VerticalIncidence = motion.into();
        let input_records = surface.records().into_iter().cloned().collect();
        let waves = TrenchWaves::new(ground, 0.0)?;
        let surface_components = [&surface.horizontal, &surface.vertical];
        let component_count = surface_components.iter().filter(|record| record.is_some()).count();
        let mut reporter = ProgressReporter::new(
            "motion at depth",
            component_count * PartProgress::STEPS_PER_PART,
            observer,
        );
        let mut components = vec![];
        for (component_index, record) in surface_components.into_iter().enumerate() {
            let Some(record) = record else { continue };
            let rest_duration = waves.rest_duration(record.time_step());
            let padded_record = record.padded(rest_duration, rest_duration)?;
            let lead_time = (padded_record.len() - record.len()) as f64 / 2.0 * record.time_step();
            let drift_velocity = padded_record.at(lead_time).velocity;
            let mut progress = PartProgress::of_part(&mut reporter, components.len());
            let records_by_level =
                waves.level_records(component_index, &padded_record, &mut progress)?;
            components.push(DepthMotion { lead_time, drift_velocity, records_by_level });
        }
        let TrenchWaves { elements, soil_identity, slowness, .. } = waves;
        Ok(Self {
            surface,
            lead_time: 0.0,
            input_records,
            elements,
            soil_identity,
            slowness,
            origin: 0.0,
            components,
        })
    }

    /// Inclined waves or Rayleigh waves, from the motion of `wave` at the surface.
    ///
    /// The wave must be a wave of the profile of `ground`. The field at depth is computed in this profile from the motion of
    /// the surface and the apparent velocity, without a check. Motion before and after the wave's record fades within half
    /// of its length.
    ///
    /// ```
    /// use basemat::bem::embedded::{Trench, TrenchGround};
    /// use basemat::motion::{FreeField, PlaneWave, Record};
    /// use basemat::site::TrenchMotion;
    /// use basemat::{Soil, unobserved};
    /// let soil = Soil::from_shear_wave_speed(200.0, 0.25, 1900.0)?;
    /// let elements = Trench::new(-6.0..6.0, 5.0)?.elements(2, 4)?;
    /// let ground = TrenchGround::new(soil, elements.clone())?;
    /// // Acceleration of a pulse of one hertz.
    /// let pulse = |t: f64| (std::f64::consts::TAU * t).cos() * (-(t / 3.0).powi(2)).exp();
    /// let samples = (0..4000).map(|k| 0.01 * k as f64 - 20.0);
    /// let second_derivative = |t: f64| (pulse(t + 0.01) - 2.0 * pulse(t) + pulse(t - 0.01)) / 1e-4;
    /// let record = Record::new(0.01, samples.map(second_derivative).collect())?;
    /// let wave = PlaneWave::rayleigh(soil).field_from_horizontal(&record, -6.0)?;
    /// let motion = TrenchMotion::travelling(&ground, &wave, &mut unobserved)?;
    /// let [mut displacement, mut impulse] = [vec![0.0; 20], vec![0.0; 20]];
    /// // At −3 m, the middle of the base's left half.
    /// let time = 20.0 + 3.0 / soil.rayleigh_wave_speed();
    /// assert!(motion.at_faces(&elements.elements(), time, &mut displacement, &mut impulse));
    /// let surface = motion.displacement(-3.0, time)[0];
    /// // Achenbach 1973, § 5.11: 0.770 at a depth of 0.0272 wavelengths.
    /// assert!((displacement[10 + 4] / surface - 0.770).abs() < 2e-3);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene) for a wave without records or with motion along y;
    /// [`Error::Input`](crate::Error::Input) for a wave that is slower than surface waves; as for [`new`](Self::new).
    pub fn travelling(
        ground: &TrenchGround,
        wave: &TravellingWave,
        observer: &mut Observer<'_>,
    ) -> Result<Self> {
        let SlownessAndOrigin { slowness, origin } = wave.slowness_along_x()?;
        let waves = TrenchWaves::new(ground, slowness)?;
        let mut reporter =
            ProgressReporter::new("motion at depth", 2 * PartProgress::STEPS_PER_PART, observer);
        let SurfaceRecords { lead_time, records } = waves.surface_records(wave, origin)?;
        let mut components = vec![];
        for (component_index, record) in records.iter().enumerate() {
            let records_by_level = waves.level_records(
                component_index,
                record,
                &mut PartProgress::of_part(&mut reporter, component_index),
            )?;
            components.push(DepthMotion { lead_time, drift_velocity: 0.0, records_by_level });
        }
        let TrenchWaves { elements, soil_identity, .. } = waves;
        let [horizontal, vertical] = records.map(Some);
        let surface = VerticalIncidence { horizontal, vertical };
        let input_records = wave.records().into_iter().cloned().collect();
        Ok(Self {
            surface,
            lead_time,
            input_records,
            elements,
            soil_identity,
            slowness,
            origin,
            components,
        })
    }
}

impl TrenchMotion {
    /// Time (s) at which the origin had the motion that x (m) has at `time` (s).
    fn arrival(&self, x: f64, time: f64) -> f64 {
        time - self.slowness * (x - self.origin)
    }
}

impl FreeField for TrenchMotion {
    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        self.surface.displacement(x, self.lead_time + self.arrival(x, time))
    }

    fn at_faces(
        &self,
        elements: &[ContactElement],
        time: f64,
        displacement: &mut [f64],
        impulse: &mut [f64],
    ) -> bool {
        if elements != self.elements {
            return false;
        }
        let element_count = elements.len();
        for (e, element) in elements.iter().enumerate() {
            let is_base = element.faces_down();
            // An inclined wave varies along the base: two Gauss points give its mean.
            let gauss_offset = 0.5 * element.length() * gauss::rule(2).nodes[1];
            let varies_along_base = is_base && self.slowness != 0.0;
            let offsets: &[f64] =
                if varies_along_base { &[-gauss_offset, gauss_offset] } else { &[0.0] };
            let weight = 1.0 / offsets.len() as f64;
            let mut sums = [0.0; VALUES_PER_LEVEL];
            for component in &self.components {
                let level_records = &component.records_by_level
                    [e.min(element_count - 1 - e).min(component.records_by_level.len() - 1)];
                for offset in offsets {
                    let arrival = self.arrival(element.center()[0] + offset, time);
                    for (k, (sum, record)) in sums.iter_mut().zip(level_records).enumerate() {
                        let Some(record) = record else { continue };
                        let motion = record.at(arrival + component.lead_time);
                        let corrected_displacement =
                            motion.displacement - component.drift_velocity * arrival;
                        *sum +=
                            weight * if k < 2 { corrected_displacement } else { motion.velocity };
                    }
                }
            }
            let [right, up, shear, pressure] = sums;
            let element_components = element.components([right, 0.0, up]);
            displacement[e] = element_components[0];
            displacement[element_count + e] = element_components[1];
            // σ_xz acts to the left on the soil below the base, and along the tangents on the soil beside the walls.
            impulse[e] = pressure;
            impulse[element_count + e] = if is_base { -shear } else { shear };
        }
        true
    }

    fn soils(&self) -> Option<&[f64]> {
        self.soil_identity.as_deref()
    }

    fn records(&self) -> Vec<&Record> {
        self.input_records.iter().collect()
    }

    fn velocity(&self, x: f64, time: f64) -> [f64; 2] {
        self.surface.velocity(x, self.lead_time + self.arrival(x, time))
    }
}
