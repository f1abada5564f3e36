//! Vertical waves at the faces of a trench.
//!
//! | symbol | meaning |
//! |---|---|
//! | z, ρ | depth, density |
//! | I | momentum of the soil above a depth, ∫ρ v dz: the impulse of the stress there |

use super::{ControlPoint, SoilColumn, VerticalWave};
use crate::bem::embedded::TrenchGround;
use crate::bem::{ContactElement, Ground};
use crate::error::{Observer, Result, require, require_part};
use crate::motion::{FreeField, Record, VerticalIncidence};
use crate::soil::SoilProfile;

/// Free field of a trench: vertical waves below a surface with recorded motion.
///
/// Motion and stresses at depth are computed in the profile without trench. Motion at depth precedes the motion of the
/// surface. A run starts from rest, so the record should begin with rest for as long as waves take from the base to the
/// surface ([`Record::padded`]).
///
/// A run on another ground is refused: other elements, soils or backfill. Soils with a damping law of your own are
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
    surface: VerticalIncidence,
    elements: Vec<ContactElement>,
    soils: Option<Vec<f64>>,
    levels: Vec<Level>,
}

/// Motion of the soil between two depths: horizontal and vertical.
#[derive(Debug, Clone)]
struct Level {
    /// Depth of the middle, m.
    middle: f64,
    waves: [Option<Wave>; 2],
}

/// Mean motion of a level in one direction, by records that begin before the motion of the surface.
#[derive(Debug, Clone)]
struct Wave {
    /// Time by which the records begin earlier, s.
    lead: f64,
    /// Velocity of the surface at the beginning of its motion in such a record, m/s: not part of the motion.
    drift: f64,
    /// Displacement of the soil, m.
    moved: Record,
    /// A record whose velocity is the mean of I, Pa s.
    impulse: Record,
    /// A record whose velocity is the mean of I ν/(1 − ν), the impulse of the pressure to the sides.
    aside: Record,
}

/// Rest before and after a record, in travel times to the base, and in samples.
const REST: [f64; 2] = [2.0, 32.0];
/// Places and weights of Gauss's rule on an interval of length one.
const GAUSS: [[f64; 2]; 4] = [
    [0.069_431_844_202_973_71, 0.173_927_422_568_726_93],
    [0.330_009_478_207_571_87, 0.326_072_577_431_273_07],
    [0.669_990_521_792_428_1, 0.326_072_577_431_273_07],
    [0.930_568_155_797_026_3, 0.173_927_422_568_726_93],
];

impl TrenchMotion {
    /// Motion around the trench of `ground`, from the `motion` of the surface without it.
    ///
    /// Shear waves carry the horizontal record, pressure waves the vertical one.
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene) for a ground with backfill;
    /// [`Error::Input`](crate::Error::Input) for a record that the soil amplifies more than a hundredfold on the way
    /// down; as for [`SoilColumn::from_surface`].
    pub fn new(
        ground: &TrenchGround,
        motion: impl Into<VerticalIncidence>,
        observer: &mut Observer<'_>,
    ) -> Result<Self> {
        let (surface, elements) = (motion.into(), ground.trench_elements().elements());
        let needed = "a trench without it: waves beside it do not travel vertically";
        require_part("backfill", !ground.has_backfill(), needed)?;
        let is_left = |own: &&ContactElement| own.directions()[0][0] < -0.5;
        let mut depths: Vec<[f64; 2]> = elements
            .iter()
            .filter(is_left)
            .map(|own| {
                let (middle, half) = (-own.center()[2], 0.5 * own.length());
                [middle - half, middle + half]
            })
            .collect();
        let bottom = ground.trench_elements().trench().depth();
        depths.push([bottom, bottom]);
        let records = [&surface.horizontal, &surface.vertical];
        let kinds = [VerticalWave::Shear, VerticalWave::Pressure];
        let level =
            |ends: &[f64; 2]| Level { middle: 0.5 * (ends[0] + ends[1]), waves: [None, None] };
        let mut levels: Vec<Level> = depths.iter().map(level).collect();
        for (k, (record, wave)) in records.into_iter().zip(kinds).enumerate() {
            let Some(record) = record else { continue };
            let found = waves(ground.profile(), wave, record, &depths, observer)?;
            levels.iter_mut().zip(found).for_each(|(level, own)| level.waves[k] = Some(own));
        }
        let soils = ground.description().identity;
        Ok(Self { surface, elements, soils, levels })
    }

    /// Level of an element: the one nearest in depth; the last one for the base.
    fn level(&self, element: &ContactElement) -> &Level {
        let last = self.levels.len() - 1;
        if element.faces_down() {
            return &self.levels[last];
        }
        let apart = |level: &&Level| (level.middle + element.center()[2]).abs();
        let walls = self.levels[..last].iter();
        walls.min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap_or(&self.levels[last])
    }
}

impl FreeField for TrenchMotion {
    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        self.surface.displacement(x, time)
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
        for (e, element) in elements.iter().enumerate() {
            let is_base = element.faces_down();
            let [horizontal, vertical] = &self.level(element).waves;
            let moved = |wave: &Option<Wave>| {
                let at = |own: &Wave| own.moved.at(time + own.lead).displacement - own.drift * time;
                wave.as_ref().map_or(0.0, at)
            };
            let [normal, tangential, _] =
                element.components([moved(horizontal), 0.0, moved(vertical)]);
            let impulse_of = |wave: &Option<Wave>, aside: bool| {
                let Some(own) = wave else { return 0.0 };
                let record = if aside { &own.aside } else { &own.impulse };
                record.at(time + own.lead).velocity
            };
            let shear = impulse_of(horizontal, false);
            let pressure = impulse_of(vertical, !is_base);
            // σ_xz acts on the soil below to the left, and on the soil beside the walls along their tangents.
            let shear = if is_base { -shear } else { shear };
            let count = elements.len();
            (displacement[e], displacement[count + e]) = (normal, tangential);
            (impulse[e], impulse[count + e]) = (pressure, shear);
        }
        true
    }

    fn soils(&self) -> Option<&[f64]> {
        self.soils.as_deref()
    }

    fn records(&self) -> Vec<&Record> {
        self.surface.records()
    }

    fn velocity(&self, x: f64, time: f64) -> [f64; 2] {
        self.surface.velocity(x, time)
    }
}

/// Waves of one kind in levels (upper and lower depth), from the surface down.
fn waves(
    profile: &SoilProfile,
    kind: VerticalWave,
    surface: &Record,
    levels: &[[f64; 2]],
    observer: &mut Observer<'_>,
) -> Result<Vec<Wave>> {
    let (step, layers): (_, Vec<_>) = (surface.time_step(), profile.soils_to().collect());
    let deepest = levels.last().map_or(0.0, |[_, bottom]| *bottom);
    let rest = REST[0] * profile.above(deepest).travel_time() + REST[1] * step;
    let own = surface.padded(rest, rest)?;
    let lead = (own.len() - surface.len()) as f64 / 2.0 * step;
    let drift = own.at(lead).velocity;
    let surface = &own;
    let none = vec![0.0; surface.len()];
    // dI/dt at the lower end of the last level.
    let mut above = none.clone();
    let mut found = Vec::with_capacity(levels.len());
    for &[top, bottom] in levels {
        let length = bottom - top;
        if length == 0.0 {
            let moved = at_depth(profile, kind, surface, bottom, observer)?;
            let wave = [moved, above.clone(), none.clone()].map(|own| Record::new(step, own));
            let [moved, impulse, aside] = wave;
            found.push(Wave { lead, drift, moved: moved?, impulse: impulse?, aside: aside? });
            continue;
        }
        let [mut moved, mut impulse, mut aside] = [none.clone(), none.clone(), none.clone()];
        let mut start = top;
        for (soil, end) in layers.iter().filter(|(_, end)| *end > top) {
            let aside_ratio = soil.poisson() / (1.0 - soil.poisson());
            let end = end.min(bottom);
            let height = end - start;
            if height <= 0.0 {
                break;
            }
            let mut add_impulse = |share: f64, own: &[f64]| {
                add(share, own, &mut impulse);
                add(aside_ratio * share, own, &mut aside);
            };
            add_impulse(height / length, &above);
            for [place, weight] in GAUSS {
                let depth = start + place * height;
                let own = at_depth(profile, kind, surface, depth, observer)?;
                let weight = weight * height;
                add(weight / length, &own, &mut moved);
                add_impulse(weight * soil.density() * (end - depth) / length, &own);
                add(weight * soil.density(), &own, &mut above);
            }
            start = end;
        }
        let [moved, impulse, aside] = [moved, impulse, aside].map(|own| Record::new(step, own));
        found.push(Wave { lead, drift, moved: moved?, impulse: impulse?, aside: aside? });
    }
    Ok(found)
}

/// sum ← sum + factor · values.
fn add(factor: f64, values: &[f64], sum: &mut [f64]) {
    sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += factor * value);
}

/// Acceleration at a depth (m) from the motion of the surface.
fn at_depth(
    profile: &SoilProfile,
    kind: VerticalWave,
    surface: &Record,
    depth: f64,
    observer: &mut Observer<'_>,
) -> Result<Vec<f64>> {
    if depth == 0.0 {
        return Ok(surface.accelerations().to_vec());
    }
    let column = SoilColumn::new(profile.above(depth), kind)?;
    let (step, samples) = (surface.time_step(), surface.accelerations());
    let found = column.from_surface(ControlPoint::Within, step, samples, observer)?;
    if let Some(frequency) = found.amplified_from {
        let needed = "none: the soil above the base amplifies this motion on the way down more than a hundredfold";
        require("frequency of the record (Hz)", frequency, false, needed)?;
    }
    Ok(found.samples)
}
