//! A static push-over: load against displacement, with uplift and sliding, up to the largest load.

use crate::Simulation;
use crate::analyses::base_rotations::base_rotations;
use crate::analyses::displacement_search::{
    DisplacementSearch, ForceDisplacement, LIMIT_FORCE_TOLERANCE,
};
use crate::error::{Error, Result, StabilityError, at_least, finite, require};
use crate::interface::Mode;
use crate::linalg::largest;
use crate::structure::DofCombination;

/// Largest accepted difference of a displacement from its target, relative to the target.
const DISPLACEMENT_TOLERANCE: f64 = 1e-4;
/// Shear traction that counts as rounding, relative to the largest traction.
const SHEAR_ROUNDING_TOLERANCE: f64 = 1e-9;
/// Largest number of static states for one target displacement; the regula falsi needs about ten.
const MAX_STATES_PER_TARGET: usize = 60;

/// Loading path of a [`push_over`]: forces or displacements.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum PushControl {
    /// The forces of the path, N (N/m in the plane), in this order.
    Forces(Vec<f64>),
    /// Displacements of the controlled degree of freedom, m or rad.
    ///
    /// Their magnitudes ascend, and all have the same sign. The force of each is found among the stable states: the curve
    /// ends at the largest load. [`push_over_by_displacement`](super::push_over_by_displacement) passes it.
    Displacements {
        /// The displacements, relative to the state without force.
        targets: Vec<f64>,
        /// Force of the first trial, N (N/m in the plane); all forces have its sign.
        first_force: f64,
    },
}

/// A static state of a [`PushOver`].
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PushPoint {
    /// Factor of the load pattern: the force that the scene was built with.
    pub force: f64,
    /// Displacement of the controlled degree of freedom, relative to the state without force, m or rad.
    pub displacement: f64,
    /// Rotation of the base, relative to the state without force, counter-clockwise, rad.
    ///
    /// In plan it is about the axis along y by the right-hand rule. With several foundations it is the largest rotation.
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
    /// Largest force with an equilibrium, and smallest force without one.
    ///
    /// `None` if the push-over did not reach its limit.
    pub limit: Option<[f64; 2]>,
    /// Error text of the first force without equilibrium; it names the cause of the failure.
    pub cause: Option<String>,
}

/// Pushes a structure on its ground with growing static forces.
///
/// `scene` builds a simulation in which the load pattern has the force of its argument in the static state. Use
/// [`Load::constant`](crate::coupled::Load::constant) on one degree of freedom or, for a pattern over the height, on a
/// weighted sum of degrees of freedom. The weight acts first, as the [`GravityStage`](crate::coupled::GravityStage)
/// defines. The load follows, in increments if elements slide or yield. In each state the load has grown from zero.
/// The structure has P–Δ and [nonlinear forces](crate::structure::NonlinearForce) as the scene defines. The internal
/// variables of the nonlinear forces stay as they were before the load. `control` is a degree of freedom of the
/// structure, or a weighted sum of degrees of freedom, whose displacement is reported.
///
/// The curve ends at the first force without equilibrium, for example because the structure overturns or slides away.
/// The limit then lies between two forces that differ by a ten-thousandth. Elements bear at their middles, so that a
/// base of n elements overturns at (1 − 1/n) of W b/2. A curve with a falling branch ends at its peak.
/// On a half-plane displacements have no datum: control a rotation or a drift there.
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
/// // The block overturns at W b/2 over its height, here 157 kN/m.
/// let overturning = 48.0e3 * 9.81 * 2.0 / 6.0;
/// let last = curve.points.last().unwrap();
/// assert!(last.uplifted_fraction > 0.5 && last.force < overturning);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Size`] without forces or displacements; [`Error::Input`] for numbers that are not finite, displacements
/// out of order, or a first force of zero; [`Error::Index`] for a degree of freedom that the structure does not have;
/// [`Error::Part`] for a displacement whose force is not found in 60 static states;
/// any error of `scene` without force, and any other error of `scene` except a missing equilibrium.
pub fn push_over(
    control: &DofCombination,
    path: &PushControl,
    scene: impl FnMut(f64) -> Result<Simulation>,
) -> Result<PushOver> {
    check_path(path)?;
    let mut analysis = PushOverAnalysis::new(control, scene)?;
    match path {
        PushControl::Forces(forces) => {
            for &force in forces {
                if !analysis.add_force(force)? {
                    break;
                }
            }
        }
        PushControl::Displacements { targets, first_force } => {
            for &target in targets {
                if !analysis.add_displacement(target, *first_force)? {
                    break;
                }
            }
        }
    }
    Ok(analysis.curve)
}

/// Error for numbers that are not finite or out of order.
fn check_path(path: &PushControl) -> Result<()> {
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
                "other than zero: all forces have its sign",
            )?;
            let mut previous_magnitude = 0.0;
            for &target in targets {
                finite("displacement of the push-over", target)?;
                let is_ascending = target.abs() > previous_magnitude && target * targets[0] > 0.0;
                let needed = "larger in magnitude than the one before, with the same sign";
                require("displacement of the push-over", target, is_ascending, needed)?;
                previous_magnitude = target.abs();
            }
            Ok(())
        }
    }
}

/// Displacements of a static state that a push-over reports.
#[derive(Clone, Copy, Default)]
struct ReportedMotion {
    /// Displacement of the controlled degree of freedom, m or rad.
    displacement: f64,
    /// Rotations of the base about the axes along y and x, rad.
    base_rotations: [f64; 2],
}

/// State of a push-over: its curve so far, and the data for further points.
struct PushOverAnalysis<'a, S> {
    control: &'a DofCombination,
    scene: S,
    /// Motion without force, which is subtracted from all reported motions.
    datum: ReportedMotion,
    curve: PushOver,
    last_state: ForceDisplacement,
}

impl<'a, S: FnMut(f64) -> Result<Simulation>> PushOverAnalysis<'a, S> {
    fn new(control: &'a DofCombination, mut scene: S) -> Result<Self> {
        let unloaded_simulation = scene(0.0)?;
        control
            .check("degree of freedom of the push-over", unloaded_simulation.structure().dofs())?;
        let curve = PushOver { points: Vec::new(), limit: None, cause: None };
        let datum = ReportedMotion::default();
        let last_state = ForceDisplacement { force: 0.0, displacement: 0.0 };
        let mut analysis = Self { control, scene, datum, curve, last_state };
        analysis.datum = analysis.reported_motion(&unloaded_simulation);
        let point = analysis.point(0.0, &unloaded_simulation);
        analysis.curve.points.push(point);
        Ok(analysis)
    }

    /// Displacement of the control and rotations of the base, under weight and load.
    fn reported_motion(&self, simulation: &Simulation) -> ReportedMotion {
        let displacement = simulation.static_displacement();
        ReportedMotion {
            displacement: self.control.value(displacement),
            base_rotations: base_rotations(simulation.structure(), displacement),
        }
    }

    /// Point of the curve for the static state of a simulation.
    fn point(&self, force: f64, simulation: &Simulation) -> PushPoint {
        let motion = self.reported_motion(simulation);
        let state = simulation.state();
        let areas = simulation.elements().areas();
        // The modes of `state` are those at the start of the first step, in which elements stick after sliding.
        let static_state = &simulation.scene.static_state;
        PushPoint {
            force,
            displacement: motion.displacement - self.datum.displacement,
            base_rotation: motion.base_rotations[0] - self.datum.base_rotations[0],
            rotation_across: motion.base_rotations[1] - self.datum.base_rotations[1],
            uplifted_fraction: state.uplifted_fraction,
            sliding_fraction: sliding_fraction(&static_state.modes, &static_state.traction, areas),
            base_shear: state.base_shear,
            base_moment: state.base_moment,
        }
    }

    /// Computes the static state under a force.
    ///
    /// Without equilibrium the result is `None`, and the curve stores the first cause.
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

    /// Adds a point to the curve.
    fn add(&mut self, point: PushPoint) {
        self.last_state =
            ForceDisplacement { force: point.force, displacement: point.displacement };
        self.curve.points.push(point);
    }

    /// Ends the curve at its limit: with the last point below it, if that point is new.
    fn end_at_limit(
        &mut self,
        last_point: Option<PushPoint>,
        carried_force: f64,
        failed_force: f64,
    ) {
        self.curve.points.extend(last_point);
        self.curve.limit = Some([carried_force, failed_force]);
    }

    /// Adds the state under a force to the curve.
    ///
    /// Without equilibrium it bisects the force, ends the curve at its limit and returns `false`.
    fn add_force(&mut self, force: f64) -> Result<bool> {
        if let Some(point) = self.state(force)? {
            self.add(point);
            return Ok(true);
        }
        let mut carried_force = self.last_state.force;
        let mut failed_force = force;
        let mut last_point = None;
        while (failed_force - carried_force).abs() > LIMIT_FORCE_TOLERANCE * failed_force.abs() {
            let middle_force = 0.5 * (carried_force + failed_force);
            match self.state(middle_force)? {
                Some(point) => {
                    carried_force = middle_force;
                    last_point = Some(point);
                }
                None => failed_force = middle_force,
            }
        }
        self.end_at_limit(last_point, carried_force, failed_force);
        Ok(false)
    }

    /// Adds the state with a displacement to the curve; returns `false` if the limit is below this displacement.
    fn add_displacement(&mut self, target: f64, first_force: f64) -> Result<bool> {
        let mut search = DisplacementSearch::new(target, first_force, self.last_state);
        let mut lower_point = None;
        for _ in 0..MAX_STATES_PER_TARGET {
            let force = search.next_force();
            let Some(point) = self.state(force)? else {
                search.failed_force = Some(force);
                if search.is_limit(force, force) {
                    self.end_at_limit(lower_point, search.lower_state.force, force);
                    return Ok(false);
                }
                continue;
            };
            let displacement = point.displacement;
            if (displacement - target).abs() <= DISPLACEMENT_TOLERANCE * target.abs() {
                self.add(point);
                return Ok(true);
            }
            if search.update(ForceDisplacement { force, displacement }) {
                continue;
            }
            lower_point = Some(point);
            if let Some(failed_force) = search.failed_force.filter(|_| search.upper_state.is_none())
                && search.is_limit(failed_force, force)
            {
                self.end_at_limit(lower_point, force, failed_force);
                return Ok(false);
            }
        }
        let reason = format!("no force was found for it in {MAX_STATES_PER_TARGET} static states");
        Err(Error::part(format!("displacement {target} of the push-over"), reason))
    }
}

/// Area of elements that slide against friction over the area of the base.
///
/// `traction`: of all elements, whose number is that of `modes`; `areas`: of the elements of the ground.
pub(super) fn sliding_fraction(modes: &[Mode], traction: &[f64], areas: &[f64]) -> f64 {
    let shear_rounding = SHEAR_ROUNDING_TOLERANCE * largest(traction);
    // Under a weight without friction all elements may be in slip without any shear.
    let has_shear = |element: usize| {
        let mut shears = traction[modes.len()..].iter().skip(element).step_by(modes.len());
        shears.any(|shear| shear.abs() > shear_rounding)
    };
    let elements = modes.iter().zip(areas).enumerate();
    let sliding_elements =
        elements.filter(|(element, (mode, _))| mode.is_slip() && has_shear(*element));
    let sliding_area = sliding_elements.fold(0.0, |sum, (_, (_, area))| sum + area);
    sliding_area / areas.iter().sum::<f64>()
}

/// Whether an error states that the loads have no equilibrium.
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
