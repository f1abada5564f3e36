//! Trait of free fields (motions of the surface without the structure), and simple fields.

use super::Record;
use crate::error::{Result, finite, positive, require};
use crate::geometry::ContactElement;

/// Motion of the ground surface without the structure.
#[auto_impl::auto_impl(Box)]
pub trait FreeField: Send {
    /// Displacement `[horizontal, vertical up]` (m) at surface point `x` (m) and `time` (s).
    ///
    /// A run starts at rest and subtracts the displacement of each element at t = 0. If the ground moves at t = 0, its
    /// velocity jumps there.
    fn displacement(&self, x: f64, time: f64) -> [f64; 2];

    /// Displacement `[along x, along y, up]` (m) for a ground in plan.
    ///
    /// `place`: surface point `[x, y]`, m. Default: [`FreeField::displacement`] at x, the same for all y.
    fn displacement_at(&self, place: [f64; 2], time: f64) -> [f64; 3] {
        let [horizontal, vertical] = self.displacement(place[0], time);
        [horizontal, 0.0, vertical]
    }

    /// Displacement and tractions at contact elements below the surface, for a ground with walls.
    ///
    /// Overwrites `displacement` (m) and `impulse`, the integral of the tractions on the soil from the beginning to
    /// `time` (Pa s). Both are means over the elements, 2Q numbers in the order of the [contact vectors](crate::bem). A
    /// pressure is positive in compression. Returns `false` (the default) for a field that has a motion at the surface
    /// only.
    fn at_faces(
        &self,
        _elements: &[ContactElement],
        _time: f64,
        _displacement: &mut [f64],
        _impulse: &mut [f64],
    ) -> bool {
        false
    }

    /// Identity of the soils for which [`at_faces`](FreeField::at_faces) is valid.
    ///
    /// The numbers are equal only for equal soils. A run on a ground whose description has another `identity` returns an
    /// error. Default: `None`, for any soils.
    fn soils(&self) -> Option<&[f64]> {
        None
    }

    /// Elements at whose centres alone the motion is defined. Default: `None`, anywhere.
    ///
    /// A run on a ground with other elements returns an error.
    fn elements(&self) -> Option<&[ContactElement]> {
        None
    }

    /// Whether the motion has a component along y. Default: no.
    ///
    /// A ground in the plane ignores that component, with a warning.
    fn moves_across(&self) -> bool {
        false
    }

    /// Records of the motion. Default: none.
    ///
    /// The summary of a run contains their peak, duration and time step.
    fn records(&self) -> Vec<&Record> {
        Vec::new()
    }

    /// Velocity `[horizontal, vertical up]` (m/s) at surface point `x` and `time`.
    ///
    /// Simulations use displacements only. `bem::full_plane::VerticalWaves` computes stresses from velocities, and
    /// other grounds may do so.
    ///
    /// Default: the central difference of displacements 10 µs before and after. The velocity of a motion of f Hz
    /// is too small by the fraction (2πf · 10 µs)²/6 (7e-8 at 10 Hz), and rounding adds about 2e-11 of the displacement per
    /// second. A jump or a kink is spread over 20 µs. Implement this method if you have a formula for the velocity.
    fn velocity(&self, x: f64, time: f64) -> [f64; 2] {
        difference_velocity(self, x, time)
    }
}

/// Half the interval of the central difference, s: short beside periods, long beside rounding errors of times.
const HALF_DIFFERENCE_INTERVAL: f64 = 1e-5;
/// Smallest half interval relative to the time, a thousand times the rounding error of the time.
const RELATIVE_HALF_INTERVAL: f64 = 1e-13;

/// Velocity (m/s) of a field by the central difference of its displacements.
pub(super) fn difference_velocity(
    field: &(impl FreeField + ?Sized),
    x: f64,
    time: f64,
) -> [f64; 2] {
    if time.is_nan() || time <= 0.0 {
        return [0.0; 2];
    }
    let half_interval = HALF_DIFFERENCE_INTERVAL.max(RELATIVE_HALF_INTERVAL * time);
    let start_time = time - half_interval;
    let end_time = time + half_interval;
    let start_displacement = field.displacement(x, start_time);
    let end_displacement = field.displacement(x, end_time);
    // The rounded times differ by slightly more or less than twice the half interval.
    [0, 1].map(|k| (end_displacement[k] - start_displacement[k]) / (end_time - start_time))
}

/// Ground at rest, for structures under loads only.
///
/// ```
/// use basemat::motion::{AtRest, FreeField};
/// assert_eq!(AtRest.displacement(3.0, 1.0), [0.0, 0.0]);
/// assert_eq!(AtRest.velocity(3.0, 1.0), [0.0, 0.0]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct AtRest;

impl FreeField for AtRest {
    fn displacement(&self, _x: f64, _time: f64) -> [f64; 2] {
        [0.0; 2]
    }

    fn at_faces(
        &self,
        _elements: &[ContactElement],
        _time: f64,
        displacement: &mut [f64],
        impulse: &mut [f64],
    ) -> bool {
        displacement.fill(0.0);
        impulse.fill(0.0);
        true
    }

    fn velocity(&self, _x: f64, _time: f64) -> [f64; 2] {
        [0.0; 2]
    }
}

/// A function of x and time that returns the horizontal and the vertical component.
type FieldFunction = Box<dyn Fn(f64, f64) -> [f64; 2] + Send>;

/// Free field from closures for the displacement and, optionally, the velocity.
///
/// The arguments of both are `(x, time)` (m, s), with time > 0; they return `[horizontal, vertical up]` (m, m/s). At
/// earlier times the field is zero. The displacement should start from zero: its value just after t = 0 acts as a jump.
///
/// A wave that runs to the right at 1000 m/s:
/// ```
/// use basemat::motion::{FreeField, FreeFieldFn};
/// let phase = |x: f64, t: f64| (t - x / 1000.0).max(0.0);
/// let wave = FreeFieldFn::new(move |x, t| [phase(x, t).powi(2), 0.0]);
/// assert_eq!(wave.displacement(500.0, 2.5), [4.0, 0.0]);
/// assert_eq!(wave.displacement(-500.0, 0.0), [0.0, 0.0]);
/// assert!((wave.velocity(500.0, 2.5)[0] - 4.0).abs() < 1e-9);
/// let exact = wave.with_velocity(move |x, t| [2.0 * phase(x, t), 0.0]);
/// assert_eq!(exact.velocity(500.0, 2.5), [4.0, 0.0]);
/// ```
pub struct FreeFieldFn {
    displacement: FieldFunction,
    velocity: Option<FieldFunction>,
}

impl FreeFieldFn {
    /// Free field from its `displacement(x, time)`.
    ///
    /// The velocity is the central difference that [`FreeField::velocity`] computes by default.
    pub fn new(displacement: impl Fn(f64, f64) -> [f64; 2] + Send + 'static) -> Self {
        Self { displacement: Box::new(displacement), velocity: None }
    }

    /// Adds the `velocity(x, time)`, the time derivative of the displacement.
    #[must_use]
    pub fn with_velocity(self, velocity: impl Fn(f64, f64) -> [f64; 2] + Send + 'static) -> Self {
        Self { velocity: Some(Box::new(velocity)), ..self }
    }
}

short_debug! { FreeFieldFn; self; exact_velocity: self.velocity.is_some() }

impl FreeField for FreeFieldFn {
    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        if time > 0.0 { (self.displacement)(x, time) } else { [0.0; 2] }
    }

    fn velocity(&self, x: f64, time: f64) -> [f64; 2] {
        match &self.velocity {
            None => difference_velocity(self, x, time),
            Some(velocity) if time > 0.0 => velocity(x, time),
            Some(_) => [0.0; 2],
        }
    }
}

/// Vertically incident S and P waves, under which all points of the surface have one motion.
///
/// The records are the motion of the free *surface* (twice the incident wave): the horizontal component of the S wave, and
/// the vertical component of the P wave. A plain [`Record`] is a horizontal free field too.
///
/// ```
/// use basemat::motion::{FreeField, Record, VerticalIncidence};
/// let shake = Record::new(0.5, vec![1.0, 1.0, 1.0])?;
/// let vertical = Some(shake.scaled(0.5)?);
/// let field = VerticalIncidence { horizontal: Some(shake), vertical };
/// assert_eq!(field.displacement(7.0, 1.0), [0.5, 0.25]);
/// assert_eq!(field.velocity(-7.0, 1.0), [1.0, 0.5]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct VerticalIncidence {
    /// Horizontal motion of the surface, positive to the right.
    pub horizontal: Option<Record>,
    /// Vertical motion of the surface, positive up; its time step may differ.
    pub vertical: Option<Record>,
}

impl From<Record> for VerticalIncidence {
    fn from(record: Record) -> Self {
        Self { horizontal: Some(record), vertical: None }
    }
}

impl FreeField for VerticalIncidence {
    fn displacement(&self, _x: f64, time: f64) -> [f64; 2] {
        [&self.horizontal, &self.vertical]
            .map(|record| record.as_ref().map_or(0.0, |record| record.at(time).displacement))
    }

    fn velocity(&self, _x: f64, time: f64) -> [f64; 2] {
        [&self.horizontal, &self.vertical]
            .map(|record| record.as_ref().map_or(0.0, |record| record.at(time).velocity))
    }

    fn records(&self) -> Vec<&Record> {
        [&self.horizontal, &self.vertical].into_iter().flatten().collect()
    }
}

impl FreeField for Record {
    fn displacement(&self, _x: f64, time: f64) -> [f64; 2] {
        [self.at(time).displacement, 0.0]
    }

    fn velocity(&self, _x: f64, time: f64) -> [f64; 2] {
        [self.at(time).velocity, 0.0]
    }

    fn records(&self) -> Vec<&Record> {
        vec![self]
    }
}

/// Motion in three directions, the same at all points, for a ground in plan.
///
/// ```
/// use basemat::motion::{FreeField, Record, Triaxial};
/// let shake = Record::new(0.5, vec![1.0, 1.0, 1.0])?;
/// let y = Some(shake.scaled(-0.5)?);
/// let up = Some(shake.scaled(0.25)?);
/// let field = Triaxial { x: Some(shake), y, up };
/// assert_eq!(field.displacement_at([7.0, -2.0], 1.0), [0.5, -0.25, 0.125]);
/// assert_eq!(field.displacement(7.0, 1.0), [0.5, 0.125]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Triaxial {
    /// Motion of the surface along x, positive to the right.
    ///
    /// It is a record to the east, if x points to the east.
    pub x: Option<Record>,
    /// Motion along y, positive away from the reader (to the north).
    pub y: Option<Record>,
    /// Vertical motion, positive up.
    pub up: Option<Record>,
}

impl FreeField for Triaxial {
    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        let displacement = self.displacement_at([x, 0.0], time);
        [displacement[0], displacement[2]]
    }

    fn displacement_at(&self, _place: [f64; 2], time: f64) -> [f64; 3] {
        [&self.x, &self.y, &self.up]
            .map(|record| record.as_ref().map_or(0.0, |record| record.at(time).displacement))
    }

    fn moves_across(&self) -> bool {
        self.y.is_some()
    }

    fn records(&self) -> Vec<&Record> {
        [&self.x, &self.y, &self.up].into_iter().flatten().collect()
    }

    fn velocity(&self, _x: f64, time: f64) -> [f64; 2] {
        [&self.x, &self.up]
            .map(|record| record.as_ref().map_or(0.0, |record| record.at(time).velocity))
    }
}

/// Ricker pulse of displacement, the same at all points.
///
/// u(t) = A (1 − 2a²) e^(−a²), a = (t − center)/sigma.
///
/// Displacement and velocity are exact. The peak A is at t = `center`; the spectrum peaks at 1/(π sigma) Hz (Ricker,
/// "The form and laws of propagation of seismic wavelets", Geophysics 18 (1953), 10–40). At and before t = 0 the field
/// is zero, so the pulse starts with a jump of A (1 − 2a₀²) e^(−a₀²), a₀ = center/sigma: 7e-10 A for a₀ = 5.
///
/// ```
/// use basemat::motion::{FreeField, RickerDisplacement};
/// let pulse = RickerDisplacement::new(0.1, 0.5, 3.0)?;
/// assert_eq!(pulse.displacement(0.0, 3.0), [0.1, 0.0]);
/// assert_eq!(pulse.velocity(0.0, 3.0), [0.0, 0.0]);
/// // a = 1: u = −A/e, v = −2 A/(e sigma)
/// assert!((pulse.displacement(0.0, 3.5)[0] + 0.1 * (-1.0_f64).exp()).abs() < 1e-16);
/// assert!((pulse.velocity(0.0, 3.5)[0] + 0.4 * (-1.0_f64).exp()).abs() < 1e-15);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RickerDisplacement {
    /// Peak, horizontal and vertical, m.
    amplitudes: [f64; 2],
    /// Width, s.
    sigma: f64,
    /// Time of the peak, s.
    center: f64,
}

/// Smallest center/sigma, at which the jump at t = 0 is 3.5e-6 of the peak.
const MIN_CENTER_RATIO: f64 = 4.0;

impl RickerDisplacement {
    /// Creates a horizontal pulse of peak `amplitude` at the time `center`.
    ///
    /// `amplitude`: m, any sign. `sigma`: width, s. `center`: s.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `amplitude` is finite, `sigma` positive and
    /// `center` at least 4 `sigma`, so that the pulse grows from rest.
    pub fn new(amplitude: f64, sigma: f64, center: f64) -> Result<Self> {
        finite("amplitude of the Ricker pulse", amplitude)?;
        positive("width of the Ricker pulse", sigma)?;
        let quantity = "center of the Ricker pulse";
        let needed = "finite and at least four times its width";
        require(
            quantity,
            center,
            center.is_finite() && center >= MIN_CENTER_RATIO * sigma,
            needed,
        )?;
        Ok(Self { amplitudes: [amplitude, 0.0], sigma, center })
    }

    /// This pulse as vertical motion (positive up).
    #[must_use]
    pub fn vertical(self) -> Self {
        Self { amplitudes: [self.amplitudes[1], self.amplitudes[0]], ..self }
    }
}

impl FreeField for RickerDisplacement {
    fn displacement(&self, _x: f64, time: f64) -> [f64; 2] {
        if time <= 0.0 {
            return [0.0; 2];
        }
        let squared_phase = ((time - self.center) / self.sigma).powi(2);
        self.amplitudes
            .map(|amplitude| amplitude * (1.0 - 2.0 * squared_phase) * (-squared_phase).exp())
    }

    fn velocity(&self, _x: f64, time: f64) -> [f64; 2] {
        if time <= 0.0 {
            return [0.0; 2];
        }
        let phase = (time - self.center) / self.sigma;
        let squared_phase = phase * phase;
        let velocity_ratio =
            phase * (4.0 * squared_phase - 6.0) * (-squared_phase).exp() / self.sigma;
        self.amplitudes.map(|amplitude| amplitude * velocity_ratio)
    }
}
