//! A flexible structure on a mat that uplifts from a bed of springs and dashpots: the model of
//! Yim & Chopra 1984.

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{Base, BaseNode, Structure, Triplets};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{Case, Check, Outcome, worse};
use crate::AnyError;
use crate::figure::{BLUE, Figure, GRAY, Panel, RED};
use basemat_problems::series::{Error, whole};

pub(crate) const CASE: Case = Case {
    name: "yim_chopra",
    title: "Flexible structure that uplifts from a spring bed",
    reference: "own Runge–Kutta integration of mat, mass and 400 strips of bed",
    settings: "40 elements, Δt = 1 ms, 10 s of El Centro",
    run,
};

/// Mass m on a massless column of height h, on a mat of mass m₀ and half width b.
#[derive(Debug, Clone, Copy)]
struct Model {
    mass: f64,
    mat: f64,
    height: f64,
    half_width: f64,
    /// Of the column.
    stiffness: f64,
    damping: f64,
    /// Of the bed, per unit of area.
    bed_stiffness: f64,
    bed_dashpot: f64,
}

impl Model {
    /// Fixed-base period 0.6 s and damping 5 %; h/b = 5, m₀/m = 0.2; vertical frequency on the bed
    /// eight times the column's, with damping 40 %.
    fn new() -> Self {
        let (mass, mat, height, half_width) = (1e5, 2e4, 15.0, 3.0);
        let omega = std::f64::consts::TAU / 0.6;
        let vertical = 8.0 * omega;
        Self {
            mass,
            mat,
            height,
            half_width,
            stiffness: mass * omega * omega,
            damping: 2.0 * 0.05 * mass * omega,
            bed_stiffness: (mass + mat) * vertical * vertical / (2.0 * half_width),
            bed_dashpot: 2.0 * 0.4 * (mass + mat) * vertical / (2.0 * half_width),
        }
    }

    /// m g/h: what the weight takes off the column's stiffness when it leans.
    fn leaning(&self) -> f64 {
        self.mass * STANDARD_GRAVITY / self.height
    }

    /// Of the mat, about its middle.
    fn mat_inertia(&self) -> f64 {
        self.mat * self.half_width.powi(2) / 3.0
    }
}

/// Degrees of freedom `[u_x, u_y, θ, u_top]`.
impl Structure for Model {
    fn dofs(&self) -> usize {
        4
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-self.half_width, self.half_width, [0, 1, 2]).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add(0, 0, self.mat);
        matrix.add(1, 1, self.mass + self.mat);
        matrix.add(2, 2, self.mat_inertia());
        matrix.add(3, 3, self.mass);
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_outer([(3, 1.0), (0, -1.0), (2, self.height)], self.stiffness);
        matrix.add_outer([(3, 1.0), (0, -1.0)], -self.leaning());
        Ok(())
    }

    fn damping(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_outer([(3, 1.0), (0, -1.0), (2, self.height)], self.damping);
        Ok(())
    }
}

/// Deformation of the column, settlement (m) and tilt (rad, counter-clockwise) every `SAMPLE`,
/// and the part of the mat that is off the ground.
type History = [Vec<f64>; 4];

/// Samples of histories, s.
const SAMPLE: f64 = 0.01;

/// The equations of motion once more, with the mat fixed to the ground sideways:
///
/// m ü = −k d − c ḋ + (m g/h) u − m a_g,  d = u + h θ, u from the ground,
/// (m+m₀) v̈ = Σ p l − (m+m₀) g,  I₀ θ̈ = −h (k d + c ḋ) + Σ p l x.
///
/// Each strip of the bed presses with p = k s + c ṡ while it touches the mat and p > 0; where p
/// would turn to tension the mat leaves it, and it creeps back by k s + c ṡ = 0 until they meet.
fn reference(model: &Model, record: &Record, strips: usize, step: f64, duration: f64) -> History {
    let Model { mass, mat, height, half_width, stiffness, damping, bed_stiffness, bed_dashpot } =
        *model;
    let length = 2.0 * half_width / strips as f64;
    let places: Vec<f64> = (0..strips).map(|e| (e as f64 + 0.5) * length - half_width).collect();
    let samples = record.accelerations();
    let ground = |time: f64| {
        let place = time / record.time_step();
        let k = whole(place.floor()).min(samples.len() - 2);
        let part = place - k as f64;
        samples[k] * (1.0 - part) + samples[k + 1] * part
    };
    let static_settlement = (mass + mat) * STANDARD_GRAVITY / (bed_stiffness * 2.0 * half_width);
    let mut bed = vec![static_settlement; strips];
    let mut touching = vec![true; strips];
    // Displacements and rates of u, v, θ.
    let mut y = [0.0, -static_settlement, 0.0, 0.0, 0.0, 0.0];
    let rates = |time: f64, y: &[f64; 6], touching: &[bool]| {
        let (mut force, mut moment) = (0.0, 0.0);
        for (x, _) in places.iter().zip(touching).filter(|(_, touches)| **touches) {
            let settled = -(y[1] + x * y[2]);
            let pressure = bed_stiffness * settled - bed_dashpot * (y[4] + x * y[5]);
            let pressure = pressure.max(0.0) * length;
            force += pressure;
            moment += pressure * x;
        }
        let column = stiffness * (y[0] + height * y[2]) + damping * (y[3] + height * y[5]);
        [
            y[3],
            y[4],
            y[5],
            (-column + mass * STANDARD_GRAVITY / height * y[0]) / mass - ground(time),
            force / (mass + mat) - STANDARD_GRAVITY,
            (moment - height * column) / (mat * half_width * half_width / 3.0),
        ]
    };
    let every = whole(SAMPLE / step);
    let creep = (-bed_stiffness / bed_dashpot * step).exp();
    let mut history: History = [vec![0.0], vec![static_settlement], vec![0.0], vec![0.0]];
    for n in 0..whole(duration / step) {
        let time = n as f64 * step;
        let first = rates(time, &y, &touching);
        let middle = std::array::from_fn(|i| y[i] + 0.5 * step * first[i]);
        let second = rates(time + 0.5 * step, &middle, &touching);
        for (y, rate) in y.iter_mut().zip(second) {
            *y += step * rate;
        }
        for (e, x) in places.iter().enumerate() {
            let settled = -(y[1] + x * y[2]);
            let pressed = bed_stiffness * settled - bed_dashpot * (y[4] + x * y[5]) > 0.0;
            let free = bed[e] * creep;
            // It touches if the mat is where the bed would be without it, or deeper.
            touching[e] = if touching[e] { pressed } else { settled >= free };
            bed[e] = if touching[e] { settled } else { free };
        }
        if (n + 1) % every == 0 {
            let open = touching.iter().filter(|touches| !**touches).count();
            let values = [y[0] + height * y[2], -y[1], y[2], open as f64 / strips as f64];
            history.iter_mut().zip(values).for_each(|(list, value)| list.push(value));
        }
    }
    history
}

fn computed(
    model: Model,
    elements: usize,
    time_step: f64,
    duration: f64,
    uplifts: bool,
) -> Result<(History, f64), AnyError> {
    let bed = SpringGround::new(
        -model.half_width..model.half_width,
        elements,
        model.bed_stiffness,
        1e14,
    )?
    .with_dashpots(model.bed_dashpot, 0.0)?;
    let builder = Simulation::builder(time_step)
        .structure(model)
        .ground(bed)
        .motion(el_centro_1940())
        .gravity(STANDARD_GRAVITY);
    let builder =
        if uplifts { builder.interface(Coulomb::uplift_only()) } else { builder.interface(Bonded) };
    let mut simulation = builder.build()?;
    let settled = -simulation.static_displacement()[1];
    let every = whole(SAMPLE / time_step);
    let mut history: History = [vec![0.0], vec![settled], vec![0.0], vec![0.0]];
    let run = simulation.run(whole(duration / time_step), |state| {
        if state.step % every == 0 {
            let u = state.absolute_displacement();
            let values =
                [u[3] - u[0] + model.height * u[2], settled - u[1], u[2], state.uplifted_fraction];
            history.iter_mut().zip(values).for_each(|(list, value)| list.push(value));
        }
    })?;
    Ok((history, run.energy_error))
}

fn errors(found: &History, wanted: &History) -> [f64; 4] {
    std::array::from_fn(|k| {
        let mut error = Error::default();
        found[k].iter().zip(&wanted[k]).for_each(|(a, b)| error.add(*a, *b));
        error.relative()
    })
}

fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| worse(most, value.abs()))
}

fn run(short: bool) -> Result<Outcome, AnyError> {
    let (model, record) = (Model::new(), el_centro_1940());
    let duration = if short { 5.0 } else { 10.0 };
    let (strips, step) = if short { (200, 5e-5) } else { (400, 2e-5) };
    let wanted = reference(&model, &record, strips, step, duration);
    let coarser = reference(&model, &record, strips / 2, 2.0 * step, duration);
    let (found, energy_balance) = computed(model, 40, 1e-3, duration, true)?;
    let (bonded, _) = computed(model, 40, 1e-3, duration, false)?;
    let names = [
        "deformation of the column, relative L2",
        "settlement, relative L2",
        "tilt, relative L2",
        "uplifted part of the mat, relative L2",
    ];
    let mut checks = Check::list(&names, &errors(&found, &wanted), &[4e-3, 5e-3, 4e-3, 2.5e-2]);
    let ratio = peak(&found[0]) / peak(&wanted[0]);
    checks.push(Check::below("peak deformation, relative", (ratio - 1.0).abs(), 2e-3));
    let own = errors(&coarser, &wanted)[..3].iter().fold(0.0_f64, |m, e| worse(m, *e));
    checks.push(Check::below("reference against half its strips and steps", own, 1e-3));
    checks.push(Check::below("energy balance, residual", energy_balance, 1e-9));
    let reduced = peak(&found[0]) / peak(&bonded[0]);
    checks.push(Check::within("peak deformation over that without uplift", reduced, 0.2..=0.6));
    // The weight holds the column's foot by a moment of (m+m₀) g b at most.
    let weight = (model.mass + model.mat) * STANDARD_GRAVITY;
    let held = weight * model.half_width / (model.height * model.stiffness);
    let name = "peak deformation over (m+m₀)gb/(hk), which the weight can hold";
    checks.push(Check::within(name, peak(&found[0]) / held, 0.7..=1.0));
    let points = |values: &[f64], unit: f64| {
        let each = values.iter().enumerate();
        each.map(|(k, value)| (k as f64 * SAMPLE, unit * value)).collect::<Vec<_>>()
    };
    let panel = |label: &str, k: usize, unit: f64| {
        Panel::new("time, s", label)
            .reference("Runge–Kutta, 400 strips", RED, points(&wanted[k], unit))
            .line("basemat, 40 elements, 1 ms", BLUE, points(&found[k], unit))
    };
    let deformation = Panel::new("time, s", "deformation of the column, mm")
        .dashed("basemat, no uplift", GRAY, points(&bonded[0], 1e3))
        .reference("Runge–Kutta, 400 strips", RED, points(&wanted[0], 1e3))
        .line("basemat, 40 elements, 1 ms", BLUE, points(&found[0], 1e3))
        .legend(SeriesLabelPosition::UpperRight);
    let panels = vec![
        deformation.room(0.05, 0.6),
        panel("tilt of the mat, mrad", 2, 1e3).room(0.05, 0.3),
        panel("settlement of its middle (down), mm", 1, 1e3).room(0.05, 0.5),
        panel("uplifted part of the mat", 3, 1.0).room(0.05, 0.5),
    ];
    let title =
        "Column of 0.6 s on a mat on springs and dashpots without tension, El Centro 1940 NS";
    Ok(Outcome { checks, figure: Figure::new(title, 2, panels) })
}
