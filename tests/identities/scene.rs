//! Runs of scenes, and responses that can be compared.

use basemat::coupled::{
    Coordinates, DissipativeMidpoint, EnergyTerm, HhtAlpha, Load, Midpoint, Newmark, Probe,
    SimulationBuilder, State, Theta,
};
use basemat::{Error, Result, Simulation};
use basemat_problems::scenes::GRAVITY;

use super::grounds;
use super::numbers::{Numbers, STEPS};
use super::parts::{Choice, Coordinate, Motion, Scheme, Space};
use super::structures::{self, Made};
use super::view::View;

/// Tolerance of reduced structures.
const REDUCTION: f64 = 1e-7;
/// Limit of their responses: errors of the reduction add up over a run, and contact amplifies them.
pub(crate) const REDUCED_LIMIT: f64 = 1e3 * REDUCTION;

/// Ways to write a scene with parts in place of the usual ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Writing {
    Usual,
    /// Shaking, soil and friction that differ by so many times 1e-10: how much the scene amplifies.
    Nearly([f64; 3]),
    /// Structure, law and ground behind traits that a user implements.
    ByUser,
    In(Coordinate),
    /// Time steps divided by a number.
    Divided(usize),
    /// Time steps so many times as long.
    Longer(usize),
}

impl Writing {
    /// Factor of the time step.
    fn of_step(self) -> f64 {
        match self {
            Self::Divided(parts) => 1.0 / parts as f64,
            Self::Longer(factor) => factor as f64,
            _ => 1.0,
        }
    }

    /// Steps over the motion.
    fn steps(self) -> usize {
        match self {
            Self::Divided(parts) => STEPS * parts,
            Self::Longer(factor) => STEPS.div_ceil(factor),
            _ => STEPS,
        }
    }
}

/// The builder of a choice in a view, without its coordinates' part.
pub(crate) fn builder(choice: &Choice, view: &View, writing: Writing) -> Result<SimulationBuilder> {
    let mut numbers = Numbers::draw(choice.seed);
    if let Writing::Nearly([shaking, modulus, friction]) = writing {
        numbers.peaks = numbers.peaks.map(|peak| peak * (1.0 + 1e-10 * shaking));
        numbers.modulus *= 1.0 + 1e-10 * modulus;
        numbers.friction *= 1.0 + 1e-10 * friction;
    }
    let made = structures::structure(choice, &numbers, view)?;
    builder_with(choice, &numbers, view, writing, made)
}

/// The builder of a choice on a structure of these numbers.
pub(crate) fn builder_with(
    choice: &Choice,
    numbers: &Numbers,
    view: &View,
    writing: Writing,
    Made { structure, top }: Made,
) -> Result<SimulationBuilder> {
    let ground = grounds::ground(choice, numbers, structure.as_ref(), view)?;
    let law = grounds::law(choice.law, numbers, view)?;
    let frame = view.frame;
    let mut builder = Simulation::builder(writing.of_step() * numbers.time_step * frame.time)
        .gravity(GRAVITY * frame.acceleration())
        .motion(grounds::motion(choice, numbers, view)?)
        .expected_steps(writing.steps());
    builder = if writing == Writing::ByUser {
        builder
            .ground(super::user::Ground(ground))
            .structure(super::user::Structure(structure))
            .interface(super::user::Law(law))
    } else {
        builder.ground(ground).structure(structure).interface(law)
    };
    for (name, row) in ["x", "y", "up"].into_iter().zip(&top) {
        if !row.is_empty() {
            builder = builder.probe(Probe::displacement(name, row.clone()));
        }
    }
    if choice.motion == Motion::Loads {
        for load in loads(choice, numbers, view, &top) {
            builder = builder.load(load);
        }
    }
    let coordinate = match writing {
        Writing::In(coordinate) => coordinate,
        _ => choice.coordinate,
    };
    builder = builder.coordinates(match coordinate {
        Coordinate::Physical => Coordinates::Physical,
        Coordinate::Modes => Coordinates::Modes,
        Coordinate::Reduced => Coordinates::Reduced { tolerance: REDUCTION },
    });
    Ok(match choice.scheme {
        Scheme::Midpoint => builder.scheme(Midpoint),
        Scheme::Theta => builder.scheme(Theta::new(0.7)?),
        Scheme::Dissipative => builder.scheme(DissipativeMidpoint::new(0.7)?),
        Scheme::Newmark => builder.scheme(Newmark::new(0.6, 0.35)?),
        Scheme::Hht => builder.scheme(HhtAlpha::new(-0.1)?),
    })
}

/// Forces on the top along x and y that begin in the static state and swing.
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
const GROUPS: [&str; 5] = ["forces", "moments", "rotations", "top", "energies"];

/// Numbers of all steps in SI units along the axes of the scene, by group.
#[derive(Debug, Clone, Default)]
pub(crate) struct Response {
    groups: [Vec<f64>; GROUPS.len()],
    /// Length over the largest displacement of the top, for rotations and moments.
    length: f64,
    pub(crate) steps: usize,
}

impl Response {
    fn add(&mut self, choice: &Choice, view: &View, state: &State) {
        let in_plan = choice.space == Space::Plan;
        let frame = view.frame;
        let depth = if in_plan { frame.length } else { 1.0 };
        let force = 1.0 / (frame.pressure() * frame.length * depth);
        let moment = force / frame.length;
        for foundation in foundations(view, state) {
            let push = view.vector_back(foundation.force_vector_in_space(in_plan));
            self.groups[0].extend(push.map(|part| part * force));
            let turn = view.axial_back(foundation.moment_in_space(in_plan));
            self.groups[1].extend(turn.map(|part| part * moment));
            let rotation = view.axial_back(foundation.rotation_in_space(in_plan));
            self.groups[2].extend(rotation);
        }
        let probes = &state.probes;
        let top =
            if in_plan { [probes[0], probes[1], probes[2]] } else { [probes[0], 0.0, probes[1]] };
        self.groups[3].extend(view.vector_back(top).map(|part| part / frame.length));
        let energy = state.energy_balance;
        self.groups[4].extend(EnergyTerm::ALL.map(|term| energy.term(term) * moment));
        self.steps += 1;
    }

    fn largest(&self, group: usize) -> f64 {
        self.groups[group].iter().fold(0.0, |largest: f64, value| largest.max(value.abs()))
    }

    /// Largest difference of any group, relative to the group's largest number.
    ///
    /// Moments are relative to forces times the length too, and rotations to displacements over it.
    pub(crate) fn apart(&self, other: &Self) -> (f64, &'static str) {
        self.apart_in(other, &GROUPS)
    }

    /// As [`Response::apart`], of some groups.
    pub(crate) fn apart_in(&self, other: &Self, groups: &[&str]) -> (f64, &'static str) {
        let mut worst = (0.0, "");
        if self.steps != other.steps {
            return (f64::INFINITY, "numbers of steps");
        }
        for (group, name) in GROUPS.iter().enumerate().filter(|(_, name)| groups.contains(name)) {
            let scale = match group {
                1 => self.largest(1).max(self.length * self.largest(0)),
                2 => self.largest(2).max(self.largest(3) / self.length),
                _ => self.largest(group),
            };
            let pairs = self.groups[group].iter().zip(&other.groups[group]);
            let difference = pairs.fold(0.0, |largest: f64, (a, b)| {
                let difference = (a - b).abs();
                if difference.is_nan() { f64::NAN } else { largest.max(difference) }
            });
            let part = if difference == 0.0 { 0.0 } else { difference / scale };
            if part.is_nan() || part > worst.0 {
                worst = (part, *name);
            }
        }
        worst
    }
}

/// Vectors of a foundation along x, y and up, also in the plane.
struct Turned<'a>(&'a basemat::coupled::Foundation);

impl Turned<'_> {
    fn force_vector_in_space(&self, in_plan: bool) -> [f64; 3] {
        if in_plan { self.0.force_vector() } else { [self.0.base_shear, 0.0, -self.0.normal_force] }
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
fn foundations<'a>(view: &View, state: &'a State) -> Vec<Turned<'a>> {
    let mut all: Vec<_> = state.foundations.iter().map(Turned).collect();
    if view.frame.mirrored {
        all.reverse();
    }
    all
}

/// Runs a scene to its end.
pub(crate) fn run(choice: &Choice, view: &View, writing: Writing) -> Result<Response> {
    run_of(choice, view, builder(choice, view, writing)?)
}

/// Runs a choice on a structure of these numbers.
pub(crate) fn run_with(
    choice: &Choice,
    numbers: &Numbers,
    view: &View,
    made: Made,
) -> Result<Response> {
    run_of(choice, view, builder_with(choice, numbers, view, Writing::Usual, made)?)
}

/// Runs a builder of a choice to its end.
pub(crate) fn run_of(choice: &Choice, view: &View, builder: SimulationBuilder) -> Result<Response> {
    let mut simulation = builder.build()?;
    let mut response =
        Response { length: Numbers::draw(choice.seed).sides[0], ..Response::default() };
    response.add(choice, view, simulation.state());
    for _ in 0..STEPS {
        response.add(choice, view, simulation.step()?);
    }
    Ok(response)
}

/// Kind of an error: two writings of a scene must be refused for the same reason.
pub(crate) fn kind(error: &Error) -> String {
    let text = format!("{error:?}");
    text.split([' ', '(', '{']).next().unwrap_or_default().to_owned()
}
