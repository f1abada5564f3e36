//! Warnings of a run.

use crate::coupled::run::Quantity;
use crate::coupled::run::warning_text::{
    across, height, likely_slip, places, unit_of_motion, with_twice_as_many,
};
use crate::error::{along, of_units};

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
         contact is paired for small displacements"
    )]
    LargeSlip {
        /// Largest slip, m.
        slip: f64,
        /// Mean length of the elements, m.
        element_length: f64,
    },
    /// Rotation of the base beyond 0.1 rad, in plan about any axis: small-rotation geometry is inaccurate.
    #[error("base rotation of {rotation:.3e} rad: geometry is that of small rotations")]
    LargeRotation {
        /// Largest rotation, rad.
        rotation: f64,
    },
    /// A foundation has settled by more than a tenth of its width, which counts as bearing failure.
    #[error(
        "foundation {foundation} settles by {settlement:.3e} m, width {width:.3} m: beyond a tenth of it \
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
    /// In reality the base would open; this model cannot.
    #[error("base pulled up by {tension:.2e} Pa, x = {x:.2} m{}{} at {time:.2} s: its law cannot open", across(*y), height(*z))]
    Tension {
        /// Largest tension of any element, Pa.
        tension: f64,
        /// Middle of that element, m.
        x: f64,
        /// In plan: middle of that element along y, m.
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
    /// The base shear vibrates with a period that the time step does not resolve.
    #[error("base shear off by about {:.0} %: steps of {time_step:.2e} s, period {period:.2e} s; \
         take {needed:.1e} s", 100.0 * error)]
    UnresolvedPeriod {
        /// Root-mean-square period of the base shear, s.
        period: f64,
        /// The time step, s.
        time_step: f64,
        /// Time step that resolves the motion, s.
        needed: f64,
        /// Estimated relative error of the largest base shear, from frequencies alone.
        ///
        /// In nine cases of ten it is at least half the true error. A run with half the step shows the true one.
        error: f64,
    },
    /// Ground and base shear vary faster than the time step resolves.
    #[error("base shear off by about {:.0} %: steps of {time_step:.2e} s, ground {frequency:.3} Hz; \
         take {needed:.1e} s", 100.0 * error)]
    UnresolvedMotion {
        /// Root-mean-square frequency of the ground acceleration, Hz.
        frequency: f64,
        /// The time step, s.
        time_step: f64,
        /// Time step that resolves the motion, s.
        needed: f64,
        /// Estimated relative error of the largest base shear: see [`UnresolvedPeriod`](Self::UnresolvedPeriod).
        error: f64,
    },
    /// In plan, shear waves cross the base of a vibrating body in less than four steps.
    ///
    /// The body vibrates at its own period. Such steps damp its rocking more than radiation does.
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
    #[error("elements{} under foundation {foundation}: {elements}, its rocking needs {needed}", along(*axis))]
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
    /// Between elements only the structure resists deformation of the base. It is softer there than the neglected
    /// soil, or not stiff enough relative to it.
    #[error("elements{} under foundation {foundation}: {elements}, its flexible base needs {needed}{}{}", along(*axis),
        with_twice_as_many(*difference), of_units(*elements, *needed))]
    CoarseBase {
        /// Number of the foundation, from the left, from 0.
        foundation: usize,
        /// Elements of the foundation; in plan along its shorter side.
        elements: usize,
        /// Approximate number needed.
        needed: usize,
        /// Relative change of its static shape with twice the elements, if known.
        difference: Option<f64>,
        /// In plan: `x` for elements of a row, `y` for elements of a column. In the plane `z` for elements of a wall.
        axis: Option<char>,
    },
    /// Triangles of a doubly curved thin shell with sides above √(R t), for the radius R and the thickness t.
    ///
    /// Their membrane resists bending. The load points of a pinched hemisphere move by 0.93 of their displacement with
    /// sides of 1.4 √(R t), and by half of it with 2.8 √(R t).
    #[error(
        "triangles of {side:.2} m are too stiff on a doubly curved thin shell: take quadrilaterals, or sides of {longest:.2} m"
    )]
    LongTriangles {
        /// Mean side of the triangles, m.
        side: f64,
        /// √(R t), m.
        longest: f64,
    },
    /// The base extends beyond the ground's elements, by more than one element or a tenth of its length.
    ///
    /// That part of the base has no ground.
    #[error("foundation {foundation} reaches {reach:.2} m{} beyond the ground's elements: nothing carries it there",
        along(*axis))]
    UncoveredBase {
        /// Number of the foundation, from the left, from 0.
        foundation: usize,
        /// Distance from the outermost element to the end of the foundation, m.
        reach: f64,
        /// In plan: axis along which the base extends too far, `x` or `y`.
        axis: Option<char>,
    },
    /// Too many cells in plan for a full passivity check: only a sample of them was checked.
    ///
    /// The check searches for errors of the quadrature and for damping laws that are not passive. Steps are the
    /// same as with a full check.
    #[error("passivity of the ground checked on {checked} of {cells} cells")]
    SampledPassivity {
        /// Cells that were checked together.
        checked: usize,
        /// All cells.
        cells: usize,
    },
    /// Coarse cells at an outline oblique to them make the rocking stiffness of a mat wrong by more than 1 %.
    ///
    /// The error is estimated from the length of oblique edges, the area and the cells. The vertical stiffness has about
    /// a fourth of it.
    #[error(
        "rocking stiffness off by about {:.1} %: outline oblique to the cells; take {factor:.1} times as many cells",
        100.0 * error
    )]
    ObliqueOutline {
        /// Estimated relative error of the rocking stiffness.
        error: f64,
        /// Multiple of the cells along a side with an error of 1 %.
        factor: f64,
    },
    /// Faces of a base in plan meet and move apart: nodes at one point that nothing ties together, or a node on the edge
    /// of another face.
    ///
    /// There the base is cut, as where two meshes were put side by side.
    #[error(
        "base torn at {}, first at x = {x:.2} m, y = {y:.2} m: faces meet there and move apart (merge coincident nodes, \
         tie nodes on an edge to its ends)",
        places(*points)
    )]
    TornBase {
        /// Number of points where faces move apart.
        points: usize,
        /// The first of these points, m.
        x: f64,
        /// The first of these points along y, m.
        y: f64,
    },
    /// Shells or sides of solids at the height of the base do not touch the ground: the base does not name them.
    #[error(
        "faces at the height of the base that do not touch the ground: {faces}, first at x = {x:.2} m, y = {y:.2} m; name \
         them, too, if they stand on it"
    )]
    FacesOffGround {
        /// Number of these faces.
        faces: usize,
        /// Middle of the first of them, m.
        x: f64,
        /// Middle of the first of them along y, m.
        y: f64,
    },
    /// In plan, steps were solved with less friction than the law's, which is infinite or above 100.
    ///
    /// In these steps an element slid with the lower coefficient times its pressure. Steps are counted since the
    /// simulation was built, the static state as one.
    #[error(
        "steps with friction {friction:.0} in place of more: {steps}; shear is too small there"
    )]
    LessFriction {
        /// Number of such steps.
        steps: usize,
        /// Smallest coefficient used.
        friction: f64,
    },
    /// A base in plan may slide with friction of 3 or more.
    ///
    /// Some steps then have several solutions, and the mirror image of a scene may use others. In one scene of a
    /// hundred this changes peaks by tens of per cent.
    #[error(
        "friction of {friction} in plan: steps may have several solutions; run a mirror image too"
    )]
    HighFriction {
        /// Largest friction coefficient.
        #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
        friction: f64,
    },
    /// An elastic part of a ground of your own takes the traction of a step as the traction at its end, s₁ = C τ.
    ///
    /// The ground is then of first order in the time step, and damps the motion without any damping. See
    /// [`Ground`](crate::bem::Ground#elastic-parts-in-the-mid-step-form).
    #[error(
        "ground of first order: an elastic part follows the traction of the step, which damps; \
         the traction belongs to the middle of the step"
    )]
    FirstOrderGround,
    /// The motion has a component along y, which a ground in the plane ignores.
    #[error("motion along y: a ground in the plane leaves it out")]
    MotionAcross,
    /// A soil with impossible numbers: probably in another unit, unless the model is not to scale.
    #[error("soil of {density:.3e} kg/m³, shear waves of {shear_wave_speed:.2e} m/s: {}",
        likely_slip(*shear_wave_speed, *density))]
    UnusualSoil {
        /// Speed of its shear waves, m/s.
        shear_wave_speed: f64,
        /// Density, kg/m³.
        density: f64,
    },
    /// A structure with an unusually long period: probably a stiffness in another unit.
    #[error("structure with a period of {period:.3} s on a fixed base: stiffness in kN/m or kPa?")]
    LongPeriod {
        /// Period on a fixed base, s (Rayleigh's quotient of the deflection under its weight to the side).
        period: f64,
    },
    /// Ground acceleration above 2 g, or a record too weak in m/s²: probably in another unit.
    ///
    /// Numbers of a weak record are probably in g, above 60 m/s² in cm/s².
    #[error("ground acceleration of {acceleration:.3} m/s²: motion in {}?", unit_of_motion(*acceleration))]
    UnusualMotion {
        /// Largest component at any step or sample, m/s².
        acceleration: f64,
    },
    /// A record with a time step that no recorder has: probably in another unit.
    #[error("record in steps of {time_step:.2e} s: interval in another unit?")]
    UnusualInterval {
        /// Time step of the record, s.
        time_step: f64,
    },
    /// The time step is longer than half the mean period of a record: it does not see the record.
    #[error(
        "steps of {time_step:.2e} s miss a record of period {period:.2e} s; take {needed:.1e} s"
    )]
    LongTimeStep {
        /// The time step, s.
        time_step: f64,
        /// Time step of the record, s.
        interval: f64,
        /// Mean period of the record's acceleration, by the root mean square of its frequency, s.
        period: f64,
        /// Time step that resolves the record, and a structure with a longer period, s.
        needed: f64,
    },
    /// The velocity of a record does not return to zero: an offset of the recorder, or a record that is cut off.
    ///
    /// The ground drifts with this velocity. [`Record::with_baseline`](crate::motion::Record::with_baseline) removes
    /// an offset.
    #[error("record ends at {velocity:.3} m/s: baseline not corrected, or cut off?")]
    DriftingRecord {
        /// Velocity at the end of the record, m/s.
        velocity: f64,
    },
    /// A weight that no soil of this stiffness carries, over 2.5 % of its shear modulus.
    ///
    /// Probably masses, a thickness or the soil's modulus in another unit, or a mass that is not per metre of thickness.
    #[error(
        "weight of {pressure:.2e} Pa on soil of G = {shear_modulus:.2e} Pa: no soil carries this"
    )]
    HeavyStructure {
        /// Weight over the area of the contact elements, Pa.
        pressure: f64,
        /// Shear modulus of the soil, Pa: at the surface, with walls of the stiffest soil.
        shear_modulus: f64,
    },
    /// Masses of vertical and of horizontal motion that differ by more than a tenth.
    ///
    /// The weight follows from the vertical mass. Where the masses of floors are missing in it, the base bears too little
    /// pressure. Water that moves with a structure to the side has no weight on the base.
    #[error("mass moving up {vertical:.3e} kg, sideways {horizontal:.3e} kg: floors left out?")]
    UnequalMasses {
        /// Mass of the structure moving up, kg (in the plane kg/m).
        vertical: f64,
        /// Mass of the structure moving along x, in plan along x or y, kg (in the plane kg/m).
        horizontal: f64,
    },
    /// A material with a density that no material has: probably in another unit.
    #[error("material of {density:.4} kg/m³: density in t/m³, kN/m³ or N/m³?")]
    UnusualDensity {
        /// Density, kg/m³.
        density: f64,
    },
    /// A bond much weaker than the pressure under the weight: its strength is probably in kPa.
    #[error("bond of {strength:.3} Pa under a weight of {pressure:.2e} Pa: strength in kPa?")]
    WeakBond {
        /// Smallest tensile or shear strength of an element, Pa.
        strength: f64,
        /// Weight over the area of the contact elements, Pa.
        pressure: f64,
    },
    /// A structure lighter than any building: probably masses in another unit.
    #[error("weight of {pressure:.3} Pa over the base: masses in t, or gravity in another unit?")]
    LightStructure {
        /// Weight over the area of the contact elements, Pa.
        pressure: f64,
    },
    /// A friction coefficient that no material has: probably an angle in degrees, or a percentage.
    #[error("friction coefficient of {friction}: in degrees, or in per cent?")]
    UnusualFriction {
        /// The coefficient.
        friction: f64,
    },
    /// A storey above 100 m: probably a height in another unit, or a mass in its place.
    #[error("storey of {height:.1} m: in another unit, or in place of the mass?")]
    TallStorey {
        /// Height of the storey, m.
        height: f64,
    },
    /// A gravity that no planet has: probably in another unit.
    #[error("gravity of {gravity} m/s²: in another unit?")]
    UnusualGravity {
        /// Acceleration of gravity, m/s².
        gravity: f64,
    },
    /// The run ended before the larger part of its record: more than a third of the Arias intensity was left.
    #[error("run ends at {end:.2} s, its record at {duration:.2} s: {:.0} % of the record's intensity until then",
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
    /// A wall presses on the soil with more than even strong soil bears, in more than a tenth of its thrust.
    ///
    /// The soil would yield there. It is held against a friction angle of 45° without cohesion, with the largest pressure
    /// of each element under a law without a largest pressure. Element pressures near the surface grow with the mesh.
    #[error(
        "wall presses with {pressure:.2e} Pa on soil under {above:.2e} Pa, x = {x:.2} m, z = {z:.2} m, at {time:.2} s: \
         soil of 45° yields; give the walls passive pressures (`TrenchGround::interfaces`)"
    )]
    WallPressure {
        /// Largest pressure of the element that exceeds the limit by the largest force, Pa.
        pressure: f64,
        /// Pressure of the soil above the middle of that element, Pa.
        above: f64,
        /// Middle of that element, m.
        x: f64,
        /// Height of the middle of that element, m.
        z: f64,
        /// Time of that pressure, s.
        time: f64,
    },
}
