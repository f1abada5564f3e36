//! Warnings of a run.

use crate::coupled::run::Quantity;
use crate::coupled::run::mistake::Mistake;
use crate::coupled::run::warning_text::{refinement_text, y_text, z_text};
use crate::error::{axis_text, units_hint};

/// Warning that a run exceeds assumptions of the model, or is too coarse.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
#[non_exhaustive]
pub enum Warning {
    /// Slip beyond the mean length of the elements, in plan of their shorter sides.
    ///
    /// Base and ground elements are then no longer opposite each other.
    #[error(
        "slip of {slip:.3e} m is beyond an element, {element_length:.3e} m on average: \
         contact pairs are accurate for small displacements only"
    )]
    LargeSlip {
        /// Largest slip, m.
        slip: f64,
        /// Mean length of the elements, m.
        element_length: f64,
    },
    /// Rotation of the base beyond 0.1 rad, in plan about any axis: small-rotation geometry is inaccurate.
    #[error(
        "base rotation of {rotation:.3e} rad: the geometry is accurate for small rotations only"
    )]
    LargeRotation {
        /// Largest rotation, rad.
        rotation: f64,
    },
    /// A foundation has settled by more than a tenth of its width: bearing failure.
    #[error(
        "foundation {foundation} settles by {settlement:.3e} m, width {width:.3} m: beyond a tenth of the width \
         the soil has failed in bearing"
    )]
    LargeSettlement {
        /// Number of the foundation, from the left, from 0.
        foundation: usize,
        /// Largest settlement since the static state, relative to the free field, m.
        settlement: f64,
        /// Width of the foundation, in plan of its shorter side, m.
        width: f64,
    },
    /// Tension under a base that cannot open, above 1 % of the largest static pressure.
    ///
    /// A real base would open; this model cannot.
    #[error("base pulled up by {tension:.2e} Pa, x = {x:.2} m{}{} at {time:.2} s: its law cannot open", y_text(*y), z_text(*z))]
    Tension {
        /// Largest tension of any element, Pa.
        tension: f64,
        /// Coordinate x of the middle of that element, m.
        x: f64,
        /// In plan: coordinate y of the middle of that element, m.
        y: Option<f64>,
        /// With walls: height of the middle of that element, m.
        z: Option<f64>,
        /// Time of that tension, s.
        time: f64,
    },
    /// The energy balance does not close to 1e-9 at the end.
    #[error("energy balance open by {residual:.1e}")]
    EnergyBalance {
        /// Residual of the balance, relative to the largest energy of the run.
        #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
        residual: f64,
    },
    /// The time scheme has created energy, more than 2 % of the run's largest energy.
    ///
    /// See [`Newmark`](crate::coupled::Newmark).
    #[error("time scheme made {:.1} % of the largest energy: take `Midpoint`, or shorter steps", 100.0 * made)]
    AlgorithmicEnergy {
        /// Largest created energy at any time, relative to the largest energy of the run.
        #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
        made: f64,
    },
    /// The time step does not resolve the period of the base shear.
    ///
    /// There are fewer than twelve steps a period.
    ///
    /// Five steps are enough where the base shear follows the ground. The ground's acceleration needs 13 steps a period
    /// itself, or 8 where the base shear follows it. [`refine`](crate::analyses::refine()) finds the error.
    #[error(
        "steps of {time_step:.2e} s for a base shear of period {period:.2e} s: take {needed:.1e} s"
    )]
    UnresolvedPeriod {
        /// Root-mean-square period of the base shear, s.
        period: f64,
        /// The time step, s.
        time_step: f64,
        /// Time step that resolves the motion, s.
        needed: f64,
    },
    /// Ground and base shear vary faster than five steps a period resolve.
    #[error(
        "steps of {time_step:.2e} s for a ground motion of {frequency:.3} Hz: take {needed:.1e} s"
    )]
    UnresolvedMotion {
        /// Root-mean-square frequency of the ground acceleration, Hz.
        frequency: f64,
        /// The time step, s.
        time_step: f64,
        /// Time step that resolves the motion, s.
        needed: f64,
    },
    /// In plan, shear waves cross the base of a vibrating body in less than four steps.
    ///
    /// The body vibrates at its natural period. Such steps damp its rocking more than radiation does.
    #[error(
        "steps of {time_step:.2e} s damp rocking: shear waves cross the base in {crossing:.2e} s; \
         take {needed:.1e} s"
    )]
    UnresolvedRadiation {
        /// Time in which shear waves cross the shorter side of the base, s.
        crossing: f64,
        /// The time step, s.
        time_step: f64,
        /// Time step that resolves the motion, s.
        needed: f64,
    },
    /// Fewer elements under a foundation than its rocking stiffness needs.
    #[error("elements{} under foundation {foundation}: {elements}, its rocking needs {needed}", axis_text(*axis))]
    FewElements {
        /// Number of the foundation, from the left, from 0.
        foundation: usize,
        /// Elements of the foundation; in plan of a row or of a column.
        elements: usize,
        /// Smallest number needed.
        needed: usize,
        /// In plan: `x` for elements of a row, `y` for elements of a column.
        axis: Option<char>,
    },
    /// A flexible base on too few contact elements.
    ///
    /// Between the middles of elements only the structure resists deformation of the base. The structure is too soft there,
    /// relative to the soil that is neglected.
    #[error("elements{} under foundation {foundation}: {elements}, its flexible base needs {needed}{}{}", axis_text(*axis),
        refinement_text(*difference), units_hint(*elements, *needed))]
    CoarseBase {
        /// Number of the foundation, from the left, from 0.
        foundation: usize,
        /// Elements of the foundation; in plan along its shorter side.
        elements: usize,
        /// Approximate number needed.
        needed: usize,
        /// Relative change of the static shape with twice the elements.
        ///
        /// `None` if it was not computed.
        difference: Option<f64>,
        /// In plan: `x` for elements of a row, `y` for elements of a column.
        ///
        /// In the plane `z` for elements of a wall.
        axis: Option<char>,
    },
    /// A flexible side of a joint on fewer contact elements than segments between its nodes.
    ///
    /// The contact of the joint does not resist bending between the middles of its elements.
    #[error("elements of joint {joint}: {elements}, its flexible side needs {needed}")]
    CoarseJoint {
        /// Number of the joint, in the order of the builder, from 0.
        joint: usize,
        /// Elements of the joint.
        elements: usize,
        /// Number needed: one for each segment between nodes, along the elements.
        needed: usize,
    },
    /// The base extends too far beyond the ground's elements.
    ///
    /// By more than one element, or a tenth of its length. That part of the base has no ground.
    #[error("foundation {foundation} reaches {reach:.2} m{} beyond the ground's elements: no ground supports it there",
        axis_text(*axis))]
    UncoveredBase {
        /// Number of the foundation, from the left, from 0.
        foundation: usize,
        /// Distance from the outermost element to the end of the foundation, m.
        reach: f64,
        /// In plan: axis along which the base extends too far, `x` or `y`.
        axis: Option<char>,
    },
    /// The passivity of a ground in plan was checked on a sample of its cells.
    ///
    /// There are too many cells for a full check.
    ///
    /// The check searches for errors of the quadrature and for damping laws that are not passive. Steps are the
    /// same as with a full check.
    #[error("passivity of the ground checked on {checked} of {cells} cells")]
    SampledPassivity {
        /// Number of cells that were checked together.
        checked: usize,
        /// Number of all cells.
        cells: usize,
    },
    /// In plan, steps were solved with less friction than the law's.
    ///
    /// The law's friction is infinite or above 100. In these steps an element slid with the lower coefficient times its
    /// pressure. Steps are counted since the simulation was built, the static state as one.
    #[error(
        "steps with friction {friction:.0} instead of the law's larger one: {steps}; shear is too small there"
    )]
    LessFriction {
        /// Number of such steps.
        steps: usize,
        /// Smallest coefficient used.
        friction: f64,
    },
    /// A base in plan may slide with friction of 3 or more.
    ///
    /// Some steps then have several solutions, and the mirror image of a scene may follow another solution. In one
    /// scene of a hundred this changes peaks by tens of per cent.
    #[error(
        "friction of {friction} in plan: steps may have several solutions; run a mirror image too"
    )]
    HighFriction {
        /// Largest friction coefficient.
        #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
        friction: f64,
    },
    /// The motion has a component along y, which a ground in the plane ignores.
    #[error("motion along y: a ground in the plane ignores it")]
    MotionAcross,
    /// The run ended before two thirds of its record's Arias intensity had passed.
    #[error("run ends at {end:.2} s, its record at {duration:.2} s: {:.0} % of the record's intensity has passed",
        100.0 * passed)]
    EndsEarly {
        /// Time at the end of the run, s.
        end: f64,
        /// Time of the last sample of the record, s.
        duration: f64,
        /// Fraction of the record's Arias intensity until the end of the run.
        passed: f64,
    },
    /// A response to the ground motion was largest in the last step: it may grow further.
    #[error("{} largest in the last step, at {end:.2} s: run longer", quantity.name())]
    PeakAtEnd {
        /// The response.
        quantity: Quantity,
        /// Time at the end of the run, s.
        end: f64,
    },
    /// The run ended because a base exceeded the rotation limit: it has overturned.
    ///
    /// See [`SimulationBuilder::rotation_limit`](crate::coupled::SimulationBuilder::rotation_limit); small
    /// rotations cannot describe further motion. A further run continues from there.
    #[error("run ended at {time:.2} s: base turned by more than {limit} rad (`rotation_limit`)")]
    Overturned {
        /// Rotation limit, rad.
        limit: f64,
        /// Time at which the limit was exceeded, s.
        time: f64,
    },
    /// Damping that resists a rigid translation has slowed a sliding base.
    ///
    /// Mass-proportional damping does so.
    #[error("damping resists translation ({rate:.2}/s): longest slip event short by about {:.0} %", 100.0 * loss)]
    DampedSliding {
        /// Damping of the translation, divided by the mass that it moves, 1/s.
        rate: f64,
        /// Estimated relative reduction of the longest slip event, for a block that slides to rest.
        loss: f64,
    },
    /// Elements too long for waves that run along the base.
    ///
    /// Longer than a quarter of the soil's shear wavelength at the frequency of the base shear; in plan, cells
    /// longer than a twelfth.
    #[error(
        "elements of {element_length:.2e} m for shear waves of {wavelength:.2e} m: take {needed:.1e} m"
    )]
    LongElements {
        /// Length of the longest element, m; in plan the longer side of a cell.
        element_length: f64,
        /// Wavelength at the root-mean-square frequency of the base shear, m.
        wavelength: f64,
        /// Length that resolves the wave, m.
        needed: f64,
    },
    /// More than a tenth of a wall's thrust exceeds the passive pressure of strong soil.
    ///
    /// Real soil would yield there. The passive pressure is that of a friction angle of 45° without cohesion. It is compared
    /// with the largest pressure of each element whose law has no largest pressure. Element pressures near the surface grow
    /// as the mesh is refined.
    #[error(
        "wall presses with {pressure:.2e} Pa on soil under {above:.2e} Pa, x = {x:.2} m, z = {z:.2} m, at {time:.2} s: \
         soil of 45° yields; give the walls passive pressures (`TrenchGround::interfaces`)"
    )]
    WallPressure {
        /// Largest pressure of the element that exceeds the limit by the largest force, Pa.
        pressure: f64,
        /// Pressure of the soil above the middle of that element, Pa.
        above: f64,
        /// Coordinate x of the middle of that element, m.
        x: f64,
        /// Height of the middle of that element, m.
        z: f64,
        /// Time of that pressure, s.
        time: f64,
    },
    /// More than a tenth of a base under water opens.
    ///
    /// The pressure of the water stays that at rest. Real water must flow into the gap and out of it again, which damps
    /// rocking and changes the pressure.
    #[error(
        "{:.0} % of the base opens under water, at {time:.2} s: flow into the gap and out of it is neglected",
        100.0 * fraction
    )]
    WaterInGap {
        /// Largest open fraction of the base.
        fraction: f64,
        /// Time of that fraction, s.
        time: f64,
    },
    /// A number, mesh or ground that is probably a mistake.
    #[error(transparent)]
    Mistake(Mistake),
}
