//! Runs of scenes, and responses that can be compared.

use basemat::coupled::{
    Coordinates, DissipativeMidpoint, EnergyTerm, HhtAlpha, Load, Midpoint, Newmark, Probe,
    SimulationBuilder, State, Theta,
};
use basemat::{Error, Result, Simulation};
use basemat_problems::dense::largest;
use basemat_problems::scenes::SCENE_GRAVITY;

use super::grounds;
use super::numbers::{Numbers, RUN_STEPS};
use super::parts::{Choice, CoordinatePart, MotionPart, SchemePart, Space};
use super::structures::{self, ProbedStructure};
use super::view::View;

/// Tolerance of reduced structures.
const REDUCTION_TOLERANCE: f64 = 1e-7;
/// Limit of their responses: errors of the reduction accumulate over a run, and contact amplifies them.
pub(crate) const REDUCED_LIMIT: f64 = 1e3 * REDUCTION_TOLERANCE;

/// A scene as usual, or with other parts, coordinates or time steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SceneVariant {
    Usual,
    /// Shaking, soil and friction increased by these multiples of 1e-10.
    Perturbed([f64; 3]),
    /// Structure, law and ground behind traits that a user implements.
    ByUser,
    InCoordinates(CoordinatePart),
    /// Time steps divided by a number.
    Divided(usize),
    /// Time steps longer by a factor.
    Longer(usize),
}

impl SceneVariant {
    fn time_step_factor(self) -> f64 {
        match self {
            Self::Divided(parts) => 1.0 / parts as f64,
            Self::Longer(factor) => factor as f64,
            _ => 1.0,
        }
    }

    /// Steps over the motion.
    fn steps(self) -> usize {
        match self {
            Self::Divided(parts) => RUN_STEPS * parts,
            Self::Longer(factor) => RUN_STEPS.div_ceil(factor),
            _ => RUN_STEPS,
        }
    }
}

/// The builder of a choice in a view, without its coordinates.
pub(crate) fn builder(
    choice: &Choice,
    view: &View,
    variant: SceneVariant,
) -> Result<SimulationBuilder> {
    let mut numbers = Numbers::draw(choice.seed);
    if let SceneVariant::Perturbed([shaking, modulus, friction]) = variant {
        numbers.peaks = numbers.peaks.map(|peak| peak * (1.0 + 1e-10 * shaking));
        numbers.modulus *= 1.0 + 1e-10 * modulus;
        numbers.friction *= 1.0 + 1e-10 * friction;
    }
    let probed_structure = structures::structure(choice, &numbers, view)?;
    builder_with(choice, &numbers, view, variant, probed_structure)
}

/// The builder of a choice on a structure of these numbers.
pub(crate) fn builder_with(
    choice: &Choice,
    numbers: &Numbers,
    view: &View,
    variant: SceneVariant,
    ProbedStructure { structure, top }: ProbedStructure,
) -> Result<SimulationBuilder> {
    let ground = grounds::ground(choice, numbers, structure.as_ref(), view)?;
    let law = grounds::law(choice.law, numbers, view)?;
    let frame = view.frame;
    let time_step = variant.time_step_factor() * numbers.time_step * frame.time;
    let mut builder = Simulation::builder(time_step)
        .gravity(SCENE_GRAVITY * frame.acceleration())
        .motion(grounds::motion(choice, numbers, view)?)
        .expected_steps(variant.steps());
    builder = if variant == SceneVariant::ByUser {
        builder
            .ground(super::user::UserGround(ground))
            .structure(super::user::UserStructure(structure))
            .interface(super::user::UserLaw(law))
    } else {
        builder.ground(ground).structure(structure).interface(law)
    };
    for (name, row) in ["x", "y", "up"].into_iter().zip(&top) {
        if !row.is_empty() {
            builder = builder.probe(Probe::displacement(name, row.clone()));
        }
    }
    if choice.motion == MotionPart::Loads {
        for load in loads(choice, numbers, view, &top) {
            builder = builder.load(load);
        }
    }
    let coordinate = match variant {
        SceneVariant::InCoordinates(coordinate) => coordinate,
        _ => choice.coordinate,
    };
    builder = builder.coordinates(match coordinate {
        CoordinatePart::Physical => Coordinates::Physical,
        CoordinatePart::Modes => Coordinates::Modes,
        CoordinatePart::Reduced => Coordinates::Reduced { tolerance: REDUCTION_TOLERANCE },
    });
    Ok(match choice.scheme {
        SchemePart::Midpoint => builder.scheme(Midpoint),
        SchemePart::Theta => builder.scheme(Theta::new(0.7)?),
        SchemePart::Dissipative => builder.scheme(DissipativeMidpoint::new(0.7)?),
        SchemePart::Newmark => builder.scheme(Newmark::new(0.6, 0.35)?),
        SchemePart::Hht => builder.scheme(HhtAlpha::new(-0.1)?),
    })
}

/// Forces on the top along x and y that act in the static state and then vary.
fn loads(
    choice: &Choice,
    numbers: &Numbers,
    view: &View,
    top: &[basemat::structure::DofCombination; 3],
) -> Vec<Load> {
    let in_plan = choice.space == Space::Plan;
    let frame = view.frame;
    let unit = frame.pressure() * frame.length * if in_plan { frame.length } else { 1.0 };
    let mass = 0.1 * numbers.mass(in_plan);
    let across = if in_plan { 0.5 * numbers.peaks[1] } else { 0.0 };
    let force = view.vector([numbers.peaks[0], across, 0.0]).map(|part| part * mass * unit);
    let mut loads = Vec::new();
    for (row, force) in top.iter().zip(force) {
        if force != 0.0 {
            let numbers = *numbers;
            let value = move |time: f64| force * (0.5 + numbers.shape(time / frame.time));
            loads.push(Load::new(row.clone(), value));
        }
    }
    loads
}

/// Groups of numbers of a step: forces, moments, rotations, displacements of the top, energies.
pub(crate) const RESPONSE_GROUPS: [&str; 5] = ["forces", "moments", "rotations", "top", "energies"];

/// Largest difference of two responses, relative to the largest number of its group.
pub(crate) struct GroupDifference {
    pub(crate) value: f64,
    pub(crate) group: &'static str,
}

/// Numbers of all steps in SI units along the axes of the scene, by group.
#[derive(Debug, Clone, Default)]
pub(crate) struct SceneResponse {
    groups: [Vec<f64>; RESPONSE_GROUPS.len()],
    /// Length that relates moments to forces and rotations to displacements.
    length: f64,
    pub(crate) steps: usize,
}

impl SceneResponse {
    fn add(&mut self, choice: &Choice, view: &View, state: &State) {
        let in_plan = choice.space == Space::Plan;
        let frame = view.frame;
        let depth = if in_plan { frame.length } else { 1.0 };
        let force = 1.0 / (frame.pressure() * frame.length * depth);
        let moment = force / frame.length;
        for foundation in foundations(view, state) {
            let force_vector = view.vector_back(foundation.force_in_space(in_plan));
            self.groups[0].extend(force_vector.map(|part| part * force));
            let moment_vector = view.axial_back(foundation.moment_in_space(in_plan));
            self.groups[1].extend(moment_vector.map(|part| part * moment));
            let rotation = view.axial_back(foundation.rotation_in_space(in_plan));
            self.groups[2].extend(rotation);
        }
        let probes = &state.probes;
        let top =
            if in_plan { [probes[0], probes[1], probes[2]] } else { [probes[0], 0.0, probes[1]] };
        self.groups[3].extend(view.vector_back(top).map(|part| part / frame.length));
        let energy = state.energy_balance;
        self.groups[4].extend(EnergyTerm::ALL_TERMS.map(|term| energy.term(term) * moment));
        self.steps += 1;
    }

    fn largest(&self, group: usize) -> f64 {
        largest(&self.groups[group])
    }

    /// Largest difference of any group, relative to the group's largest number.
    ///
    /// Moments are relative to forces times the length too, and rotations to displacements over it.
    pub(crate) fn difference(&self, other: &Self) -> GroupDifference {
        self.difference_in(other, &RESPONSE_GROUPS)
    }

    /// As [`SceneResponse::difference`], of some groups.
    pub(crate) fn difference_in(&self, other: &Self, groups: &[&str]) -> GroupDifference {
        if self.steps != other.steps {
            return GroupDifference { value: f64::INFINITY, group: "numbers of steps" };
        }
        let mut max_difference = GroupDifference { value: 0.0, group: "" };
        for (group, name) in
            RESPONSE_GROUPS.iter().enumerate().filter(|(_, name)| groups.contains(name))
        {
            let scale = match group {
                1 => self.largest(1).max(self.length * self.largest(0)),
                2 => self.largest(2).max(self.largest(3) / self.length),
                _ => self.largest(group),
            };
            let pairs = self.groups[group].iter().zip(&other.groups[group]);
            let difference = pairs.fold(0.0, |max_difference: f64, (a, b)| {
                let difference = (a - b).abs();
                if difference.is_nan() { f64::NAN } else { max_difference.max(difference) }
            });
            let value = if difference == 0.0 { 0.0 } else { difference / scale };
            if value.is_nan() || value > max_difference.value {
                max_difference = GroupDifference { value, group: name };
            }
        }
        max_difference
    }
}

/// Vectors of a foundation along x, y and up, also in the plane.
struct FoundationVectors<'a>(&'a basemat::coupled::Foundation);

impl FoundationVectors<'_> {
    fn force_in_space(&self, in_plan: bool) -> [f64; 3] {
        if in_plan {
            self.0.force_vector()
        } else {
            [self.0.base_shear, 0.0, -self.0.normal_force]
        }
    }

    /// In the plane a moment is about the axis towards the reader, −y.
    fn moment_in_space(&self, in_plan: bool) -> [f64; 3] {
        if in_plan { self.0.moment_vector() } else { [0.0, -self.0.base_moment, 0.0] }
    }

    fn rotation_in_space(&self, in_plan: bool) -> [f64; 3] {
        if in_plan { self.0.rotation_vector() } else { [0.0, -self.0.base_rotation, 0.0] }
    }
}

/// Foundations in the order of the scene: a mirror exchanges left and right.
fn foundations<'a>(view: &View, state: &'a State) -> Vec<FoundationVectors<'a>> {
    let mut foundations: Vec<_> = state.foundations.iter().map(FoundationVectors).collect();
    if view.frame.mirrored {
        foundations.reverse();
    }
    foundations
}

/// Runs a scene to its end.
pub(crate) fn run(choice: &Choice, view: &View, variant: SceneVariant) -> Result<SceneResponse> {
    run_of(choice, view, builder(choice, view, variant)?)
}

/// Runs a choice on a structure of these numbers.
pub(crate) fn run_with(
    choice: &Choice,
    numbers: &Numbers,
    view: &View,
    made: ProbedStructure,
) -> Result<SceneResponse> {
    run_of(choice, view, builder_with(choice, numbers, view, SceneVariant::Usual, made)?)
}

/// Runs a builder of a choice to its end.
pub(crate) fn run_of(
    choice: &Choice,
    view: &View,
    builder: SimulationBuilder,
) -> Result<SceneResponse> {
    let mut simulation = builder.build()?;
    let mut response =
        SceneResponse { length: Numbers::draw(choice.seed).sides[0], ..SceneResponse::default() };
    response.add(choice, view, simulation.state());
    for _ in 0..RUN_STEPS {
        response.add(choice, view, simulation.step()?);
    }
    Ok(response)
}

/// Name of the variant of an error.
pub(crate) fn error_kind(error: &Error) -> String {
    let text = format!("{error:?}");
    text.split([' ', '(', '{']).next().unwrap_or_default().to_owned()
}
