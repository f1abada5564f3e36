//! Waves from below at the faces of a trench.

use super::transform::PartProgress;
use super::trench_waves::{LevelRecords, SurfaceRecords, TrenchWaves, VALUE_COUNT};
use crate::bem::ContactElement;
use crate::bem::embedded::TrenchGround;
use crate::error::{Observer, ProgressReporter, Result};
use crate::linalg::gauss;
use crate::motion::{FreeField, Record, TravellingWave, VerticalIncidence};

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
/// let [mut moved, mut impulse] = [vec![0.0; 28], vec![0.0; 28]];
/// assert!(motion.at_faces(&elements.elements(), 4.0, &mut moved, &mut impulse));
/// let shear_at_base = 14 + 4;
/// let at = |time: f64| record.at(time).displacement;
/// assert!((moved[shear_at_base] - 0.5 * (at(3.975) + at(4.025))).abs() < 2e-6);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct TrenchMotion {
    /// Motion of the surface at the origin.
    surface: VerticalIncidence,
    /// Time by which the surface's records begin earlier than the wave's, s.
    lead: f64,
    /// Records of the motion from which the field was made.
    records: Vec<Record>,
    elements: Vec<ContactElement>,
    soils: Option<Vec<f64>>,
    /// Horizontal slowness, s/m.
    slowness: f64,
    /// Place of the surface's motion, m.
    origin: f64,
    components: Vec<Component>,
}

/// The soil's motion by one component of the surface's motion.
#[derive(Debug, Clone)]
struct Component {
    /// Time by which the records begin earlier than the motion of the surface, s.
    lead: f64,
    /// Velocity (m/s) that padding leaves at the beginning of the surface's motion.
    ///
    /// It is subtracted.
    drift: f64,
    /// Records for the elements of a wall, from the surface down, and for the base.
    levels: Vec<LevelRecords>,
}

impl TrenchMotion {
    /// Vertical waves around the trench of `ground`, from the `motion` of the surface without it.
    ///
    /// Shear waves carry the horizontal record, pressure waves the vertical one.
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
        let given_records = surface.records().into_iter().cloned().collect();
        let waves = TrenchWaves::new(ground, 0.0)?;
        let components_of_surface = [&surface.horizontal, &surface.vertical];
        let count = components_of_surface.iter().filter(|record| record.is_some()).count();
        let mut watch = ProgressReporter::new(
            "motion at depth",
            count * PartProgress::STEPS_PER_PART,
            observer,
        );
        let mut components = vec![];
        for (kind, record) in components_of_surface.into_iter().enumerate() {
            let Some(record) = record else { continue };
            let rest = waves.rest(record.time_step());
            let padded = record.padded(rest, rest)?;
            let lead = (padded.len() - record.len()) as f64 / 2.0 * record.time_step();
            let drift = padded.at(lead).velocity;
            let mut progress = PartProgress::part(&mut watch, components.len());
            let levels = waves.levels(kind, &padded, &mut progress)?;
            components.push(Component { lead, drift, levels });
        }
        let TrenchWaves { elements, soils, slowness, .. } = waves;
        Ok(Self {
            surface,
            lead: 0.0,
            records: given_records,
            elements,
            soils,
            slowness,
            origin: 0.0,
            components,
        })
    }

    /// Waves with the motion of `wave` at the surface: inclined ones, or Rayleigh's wave of a half-plane.
    ///
    /// The wave must be one of the profile of `ground`: motion of the surface and apparent velocity determine the field
    /// below, whatever they are. Motion before and after the wave's record fades within half of its length.
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
    /// let second = |t: f64| (pulse(t + 0.01) - 2.0 * pulse(t) + pulse(t - 0.01)) / 1e-4;
    /// let record = Record::new(0.01, samples.map(second).collect())?;
    /// let wave = PlaneWave::rayleigh(soil).field_from_horizontal(&record, -6.0)?;
    /// let motion = TrenchMotion::travelling(&ground, &wave, &mut unobserved)?;
    /// let [mut moved, mut impulse] = [vec![0.0; 20], vec![0.0; 20]];
    /// // At −3 m, the middle of the base's left half.
    /// let time = 20.0 + 3.0 / soil.rayleigh_wave_speed();
    /// assert!(motion.at_faces(&elements.elements(), time, &mut moved, &mut impulse));
    /// let surface = motion.displacement(-3.0, time)[0];
    /// // Achenbach 1973, § 5.11: 0.770 at a depth of 0.0272 wavelengths.
    /// assert!((moved[10 + 4] / surface - 0.770).abs() < 2e-3);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene) for a wave without records or with motion along y;
    /// [`Error::Input`](crate::Error::Input) for one slower than surface waves; as for [`new`](Self::new).
    pub fn travelling(
        ground: &TrenchGround,
        wave: &TravellingWave,
        observer: &mut Observer<'_>,
    ) -> Result<Self> {
        let [slowness, origin] = wave.along()?;
        let waves = TrenchWaves::new(ground, slowness)?;
        let mut watch =
            ProgressReporter::new("motion at depth", 2 * PartProgress::STEPS_PER_PART, observer);
        let SurfaceRecords { lead, records } = waves.surface(wave, origin)?;
        let mut components = vec![];
        for (kind, record) in records.iter().enumerate() {
            let levels = waves.levels(kind, record, &mut PartProgress::part(&mut watch, kind))?;
            components.push(Component { lead, drift: 0.0, levels });
        }
        let TrenchWaves { elements, soils, .. } = waves;
        let [horizontal, vertical] = records.map(Some);
        let surface = VerticalIncidence { horizontal, vertical };
        let records = wave.records().into_iter().cloned().collect();
        Ok(Self { surface, lead, records, elements, soils, slowness, origin, components })
    }
}

impl TrenchMotion {
    /// Time at which the motion at a place and `time` was at the origin.
    fn arrival(&self, x: f64, time: f64) -> f64 {
        time - self.slowness * (x - self.origin)
    }
}

impl FreeField for TrenchMotion {
    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        self.surface.displacement(x, self.lead + self.arrival(x, time))
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
        let count = elements.len();
        for (e, element) in elements.iter().enumerate() {
            let is_base = element.faces_down();
            // Along the base the wave needs time: a rule of two points.
            let half = 0.5 * element.length() * gauss::rule(2).nodes[1];
            let is_wide = is_base && self.slowness != 0.0;
            let points: &[f64] = if is_wide { &[-half, half] } else { &[0.0] };
            let weight = 1.0 / points.len() as f64;
            let mut sums = [0.0; VALUE_COUNT];
            for component in &self.components {
                let level = &component.levels[e.min(count - 1 - e).min(component.levels.len() - 1)];
                for point in points {
                    let arrival = self.arrival(element.center()[0] + point, time);
                    for (k, (sum, record)) in sums.iter_mut().zip(level).enumerate() {
                        let Some(record) = record else { continue };
                        let motion = record.at(arrival + component.lead);
                        let displacement = motion.displacement - component.drift * arrival;
                        *sum += weight * if k < 2 { displacement } else { motion.velocity };
                    }
                }
            }
            let [right, up, shear, pressure] = sums;
            let components = element.components([right, 0.0, up]);
            displacement[e] = components[0];
            displacement[count + e] = components[1];
            // σ_xz acts on the soil below to the left, and on the soil beside the walls along their tangents.
            impulse[e] = pressure;
            impulse[count + e] = if is_base { -shear } else { shear };
        }
        true
    }

    fn soils(&self) -> Option<&[f64]> {
        self.soils.as_deref()
    }

    fn records(&self) -> Vec<&Record> {
        self.records.iter().collect()
    }

    fn velocity(&self, x: f64, time: f64) -> [f64; 2] {
        self.surface.velocity(x, self.lead + self.arrival(x, time))
    }
}
