//! A static push-over: load against displacement, with uplift and sliding, up to the largest load.

use crate::Simulation;
use crate::analyses::base_rotations::base_rotations;
use crate::error::{Error, Result, StabilityError, at_least, finite, require};
use crate::linalg::largest;
use crate::structure::DofCombination;

/// Width of the bracket of the largest force, relative to it, at which the search ends.
const LIMIT_TOLERANCE: f64 = 1e-4;
/// Largest difference of a displacement from its target, relative to it.
const DISPLACEMENT_TOLERANCE: f64 = 1e-4;
/// Shear that counts as rounding, relative to the largest traction.
const ROUNDING_OF_SHEAR: f64 = 1e-9;
/// Largest number of static states for one target.
const MAX_STATES: usize = 60;
/// Largest factor by which a force grows in a step towards a target that lies beyond all known states.
const MAX_GROWTH: f64 = 4.0;

/// Path of a [`push_over`]: forces or displacements.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum PushControl {
    /// By these forces, N (N/m in the plane), in this order.
    Forces(Vec<f64>),
    /// By these displacements of the controlled degree of freedom, m or rad, in ascending order of size and one sense.
    Displacements {
        /// The displacements, beside that without force.
        targets: Vec<f64>,
        /// Force of the first trial; its sign is the sense of all forces.
        first_force: f64,
    },
}

/// A static state of a [`PushOver`].
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PushPoint {
    /// Factor of the load pattern: the force that the scene was built with.
    pub force: f64,
    /// Displacement of the controlled degree of freedom beside that without force, m or rad.
    pub displacement: f64,
    /// Rotation of the base beside that without force, counter-clockwise, rad.
    ///
    /// In plan about the axis along y by the right-hand rule. Of several foundations the largest.
    pub base_rotation: f64,
    /// In plan: rotation of the base about the axis along x, by the right-hand rule, rad; zero in the plane.
    pub rotation_across: f64,
    /// Area of open elements over the area of the base.
    pub uplifted_fraction: f64,
    /// Area of elements that slide against friction over the area of the base.
    pub sliding_fraction: f64,
    /// Horizontal force on the soil along x, N (N/m in the plane).
    pub base_shear: f64,
    /// Moment on the soil, as [`State::base_moment`](crate::coupled::State::base_moment).
    pub base_moment: f64,
}

/// Curve of force against displacement, made by [`push_over`].
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PushOver {
    /// States along the path, the one without force first.
    pub points: Vec<PushPoint>,
    /// Largest force with an equilibrium that was found, and smallest without one, if the push-over came to its limit.
    pub limit: Option<[f64; 2]>,
    /// Text of the error of the first force without equilibrium: what the loads do to the structure.
    pub cause: Option<String>,
}

/// Pushes a structure on its ground with growing static forces.
///
/// `scene` builds a simulation in which the load pattern has this force in the static state, for example by
/// [`Load::constant`](crate::coupled::Load::constant) on one degree of freedom or, for a pattern over the height, on a sum of
/// them. Weight acts first, as its [`GravityStage`](crate::coupled::GravityStage) says, then the load, in increments if
/// elements slide or yield: each state follows from the load growing from zero. The structure is the one of the
/// scene, with P–Δ and [nonlinear forces](crate::structure::NonlinearForce) if it has them; inner variables of these
/// have their values before the load. `control` is a degree of freedom of the structure, or a sum of them, whose
/// displacement is reported.
///
/// Where there is no equilibrium, because the load overturns the structure or pushes it off, the curve ends, and the
/// limit is found between two forces that differ by a ten-thousandth. Elements bear at their middles, so that a base of
/// n elements overturns at (1 − 1/n) of W b/2. A curve that falls beyond its peak is not
/// followed: it ends at the peak. On a half-plane in the plane displacements have no datum: control a rotation or a
/// drift there.
///
/// ```
/// use basemat::analyses::{PushControl, push_over};
/// use basemat::bem::SpringGround;
/// use basemat::coupled::Load;
/// use basemat::interface::Coulomb;
/// use basemat::structure::RigidBlock;
/// use basemat::Simulation;
///
/// // A block 4 m wide and 6 m high on springs, pushed at its top.
/// let block = RigidBlock::new(4.0, 6.0, 2000.0)?;
/// let top = block.horizontal_at(6.0);
/// let control = PushControl::Displacements { targets: vec![0.005, 0.02, 0.08], first_force: 10e3 };
/// let curve = push_over(&top, &control, |force| {
///     Simulation::builder(0.01)
///         .ground(SpringGround::under(&block, 16, 4e7, 3e7)?)
///         .structure(block.clone())
///         .interface(Coulomb::new(0.7)?)
///         .load(Load::constant(top.clone(), force))
///         .build()
/// })?;
/// // It cannot carry more than W b/2 over the height, here 157 kN/m.
/// let overturning = 48.0e3 * 9.81 * 2.0 / 6.0;
/// let last = curve.points.last().unwrap();
/// assert!(last.uplifted_fraction > 0.5 && last.force < overturning);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Size`] without forces or displacements; [`Error::Input`] for numbers that are not finite, displacements
/// out of order, or a first force of zero; [`Error::Index`] for a degree of freedom that the structure does not have;
/// any error of `scene` without force, and any of its errors that is not the lack of an equilibrium.
pub fn push_over(
    control: &DofCombination,
    path: &PushControl,
    scene: impl FnMut(f64) -> Result<Simulation>,
) -> Result<PushOver> {
    check(path)?;
    let mut push = Push::new(control, scene)?;
    match path {
        PushControl::Forces(forces) => {
            for &force in forces {
                if !push.reach_force(force)? {
                    break;
                }
            }
        }
        PushControl::Displacements { targets, first_force } => {
            for &target in targets {
                if !push.reach_displacement(target, *first_force)? {
                    break;
                }
            }
        }
    }
    Ok(push.curve)
}

/// Error for numbers that are not finite or out of order.
fn check(path: &PushControl) -> Result<()> {
    match path {
        PushControl::Forces(forces) => {
            at_least("forces of the push-over", forces.len(), 1)?;
            forces
                .iter()
                .try_for_each(|&force| finite("force of the push-over", force).map(drop))
        }
        PushControl::Displacements { targets, first_force } => {
            at_least("displacements of the push-over", targets.len(), 1)?;
            finite("first force of the push-over", *first_force)?;
            let quantity = "first force of the push-over";
            require(
                quantity,
                *first_force,
                *first_force != 0.0,
                "other than zero: its sign is the sense of all",
            )?;
            let mut before = 0.0;
            for &target in targets {
                finite("displacement of the push-over", target)?;
                let grows = target.abs() > before && target * targets[0] > 0.0;
                let needed = "larger than the one before, in the same sense";
                require("displacement of the push-over", target, grows, needed)?;
                before = target.abs();
            }
            Ok(())
        }
    }
}

/// A push-over under way.
struct Push<'a, S> {
    control: &'a DofCombination,
    scene: S,
    /// Displacement and rotations of the base without force.
    datum: [f64; 3],
    curve: PushOver,
    /// Force and displacement of the last state.
    last: [f64; 2],
}

impl<'a, S: FnMut(f64) -> Result<Simulation>> Push<'a, S> {
    fn new(control: &'a DofCombination, mut scene: S) -> Result<Self> {
        let rest = scene(0.0)?;
        control.check("degree of freedom of the push-over", rest.structure().dofs())?;
        let curve = PushOver { points: Vec::new(), limit: None, cause: None };
        let mut push = Self { control, scene, datum: [0.0; 3], curve, last: [0.0; 2] };
        push.datum = push.motions(&rest);
        let point = push.point(0.0, &rest);
        push.curve.points.push(point);
        Ok(push)
    }

    /// Displacement of the control and rotations of the base, the weight's part included.
    fn motions(&self, simulation: &Simulation) -> [f64; 3] {
        let displacement = simulation.static_displacement();
        let [rotation, across] = base_rotations(simulation.structure(), displacement);
        [self.control.value(displacement), rotation, across]
    }

    fn point(&self, force: f64, simulation: &Simulation) -> PushPoint {
        let motions = self.motions(simulation);
        let state = simulation.state();
        let areas = simulation.elements().areas();
        // A state begins with elements that stick where the load has left them.
        let static_state = &simulation.scene.static_state;
        let modes = &static_state.modes;
        let traction = &static_state.traction;
        let rounding = ROUNDING_OF_SHEAR * largest(traction);
        // Under a weight without friction all elements may slide, and none bears shear.
        let bears_shear = |element: usize| {
            let mut shears = traction[modes.len()..].iter().skip(element).step_by(modes.len());
            shears.any(|shear| shear.abs() > rounding)
        };
        let elements = modes.iter().zip(areas).enumerate();
        let sliding =
            elements.filter(|(element, (mode, _))| mode.is_slip() && bears_shear(*element));
        PushPoint {
            force,
            displacement: motions[0] - self.datum[0],
            base_rotation: motions[1] - self.datum[1],
            rotation_across: motions[2] - self.datum[2],
            uplifted_fraction: state.uplifted_fraction,
            sliding_fraction: sliding.fold(0.0, |sum, (_, (_, area))| sum + area)
                / areas.iter().sum::<f64>(),
            base_shear: state.base_shear,
            base_moment: state.base_moment,
        }
    }

    /// The state under a force; `None` without equilibrium, whose cause is kept.
    fn state(&mut self, force: f64) -> Result<Option<PushPoint>> {
        match (self.scene)(force) {
            Ok(simulation) => Ok(Some(self.point(force, &simulation))),
            Err(error) if is_without_equilibrium(&error) => {
                self.curve.cause.get_or_insert_with(|| error.to_string());
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    fn add(&mut self, point: PushPoint) {
        self.last = [point.force, point.displacement];
        self.curve.points.push(point);
    }

    /// Adds the state under a force; `false` beyond the limit, which is then found.
    fn reach_force(&mut self, force: f64) -> Result<bool> {
        if let Some(point) = self.state(force)? {
            self.add(point);
            return Ok(true);
        }
        let mut bracket = [self.last[0], force];
        let mut best = None;
        while (bracket[1] - bracket[0]).abs() > LIMIT_TOLERANCE * bracket[1].abs() {
            let middle = 0.5 * (bracket[0] + bracket[1]);
            match self.state(middle)? {
                Some(point) => {
                    bracket[0] = middle;
                    best = Some(point);
                }
                None => bracket[1] = middle,
            }
        }
        self.curve.points.extend(best);
        self.curve.limit = Some(bracket);
        Ok(false)
    }

    /// Adds the state with a displacement; `false` if the limit comes before.
    ///
    /// Regula falsi with halved weights (Illinois) between two forces; beyond all known states the force grows with
    /// the last slope.
    fn reach_displacement(&mut self, target: f64, first: f64) -> Result<bool> {
        let mut below = self.last;
        let mut below_point = None;
        let mut above: Option<[f64; 2]> = None;
        let mut failed = None;
        let mut weights = [1.0, 1.0];
        let mut last_was_above = None;
        for _ in 0..MAX_STATES {
            let force = match (above, failed) {
                (Some(above), _) => {
                    let low = weights[0] * (target - below[1]);
                    let high = weights[1] * (above[1] - target);
                    (below[0] * high + above[0] * low) / (high + low)
                }
                (None, Some(failed)) => 0.5 * (below[0] + failed),
                (None, None) if below[1] == 0.0 => below[0] + first,
                (None, None) => below[0] * (target / below[1]).min(MAX_GROWTH),
            };
            let Some(point) = self.state(force)? else {
                failed = Some(force);
                if (force - below[0]).abs() <= LIMIT_TOLERANCE * force.abs() {
                    self.curve.points.extend(below_point);
                    self.curve.limit = Some([below[0], force]);
                    return Ok(false);
                }
                continue;
            };
            let displacement = point.displacement;
            if (displacement - target).abs() <= DISPLACEMENT_TOLERANCE * target.abs() {
                self.add(point);
                return Ok(true);
            }
            let is_above = displacement / target > 1.0;
            let repeats = last_was_above.replace(is_above) == Some(is_above);
            let other = if repeats { 0.5 } else { 1.0 };
            if is_above {
                above = Some([force, displacement]);
                weights = [other * weights[0], 1.0];
            } else {
                below = [force, displacement];
                below_point = Some(point);
                weights = [1.0, other * weights[1]];
                if let Some(failed) = failed.filter(|_| above.is_none())
                    && (failed - force).abs() <= LIMIT_TOLERANCE * force.abs()
                {
                    self.curve.points.extend(below_point);
                    self.curve.limit = Some([force, failed]);
                    return Ok(false);
                }
            }
        }
        let reason = format!("no force was found for it in {MAX_STATES} static states");
        Err(Error::part(format!("displacement {target} of the push-over"), reason))
    }
}

/// Whether an error says that the loads have no equilibrium.
fn is_without_equilibrium(error: &Error) -> bool {
    match error {
        Error::Preload { .. } => true,
        Error::Stability(cause) => matches!(
            cause.as_ref(),
            StabilityError::Uplift { .. }
                | StabilityError::Sliding { .. }
                | StabilityError::Twisting { .. }
                | StabilityError::Overturning { .. }
                | StabilityError::BearingFailure { .. }
                | StabilityError::Buckling { .. }
                | StabilityError::Toppling { .. }
                // The resultant passes beside the middles of the outermost elements.
                | StabilityError::Beyond { .. }
                | StabilityError::BondBreaks { .. }
        ),
        _ => false,
    }
}
