//! Frames of two columns that rock under a cap which they bear on hinges: rigid columns, and columns that bend.

use std::f64::consts::PI;

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::coupled::Load;
use basemat::fem::{Beam, Direction, LumpedMass, Mesh, Truss};
use basemat::interface::Coulomb;
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::FemModel;

use super::outcome::{Case, Check, Outcome, worse};
use crate::AnyError;
use crate::figure::{BLUE, Figure, Panel, RED};
use basemat_problems::rocking::{Rocker, crossings};
use basemat_problems::series::{Error, whole};

pub(crate) const CASE: Case = Case {
    name: "rocking_frame",
    title: "Rocking frame of two columns",
    reference: "rigid columns: Housner's block of the frame's mass, inertia and height, event by event; columns that bend: own integration, event by event",
    settings: "two stiff elements under each column, Δt = 0.02 ms; pushed at the cap for half a second",
    run,
};

/// Half width of a column's base, height of the hinges, distance of the columns (m).
const B: f64 = 0.5;
const TOP: f64 = 4.0;
const SPAN: f64 = 8.0;
/// Of a rigid column, and of the cap over both columns' mass.
const COLUMN: f64 = 10e3;
const CAP: f64 = 0.5;
/// Footing of a column that bends (kg/m), the cap's mass on it, frequencies of its sway and of its axial motion (1/s).
const FOOTING: f64 = 2e3;
const LOAD: f64 = 10e3;
const SWAY: f64 = 12.0;
const AXIAL: f64 = 60.0;
/// Moment of the push about the base over the largest moment of the weight, and its duration, s.
const PUSH: f64 = 1.6;
const PUSHED: f64 = 0.5;
/// Samples of histories, s.
const SAMPLE: f64 = 0.01;
/// Impacts that are compared.
const IMPACTS: usize = 4;

/// Part of the largest push.
fn pulse(time: f64) -> f64 {
    if time > 0.0 && time < PUSHED { (PI * time / PUSHED).sin() } else { 0.0 }
}

/// Displacement of the cap to the right and tilt of the footings, every `SAMPLE`.
type History = [Vec<f64>; 2];

/// The frame, with its left hinge and the foot under it. A column whose foot `footing` has a mass of its own bends.
fn frame(
    footing: Option<f64>,
    cap: f64,
    column: impl Fn([usize; 2]) -> basemat::Result<Beam>,
) -> Result<(FemModel, [usize; 2], [usize; 2]), AnyError> {
    let mut mesh = Mesh::new();
    let (mut lines, mut tops) = (Vec::new(), Vec::new());
    for x in [-0.5 * SPAN, 0.5 * SPAN] {
        // Pressures of two elements act at ±b.
        let line = [x - 2.0 * B, x, x + 2.0 * B].map(|x| mesh.add_node(x, 0.0));
        let line = line.into_iter().collect::<Result<Vec<_>, _>>()?;
        let top = mesh.add_node(x, TOP)?;
        for ends in [[line[0], line[1]], [line[1], line[2]]] {
            mesh.add(Beam::new(ends, 1e9, 1.0, 1.0, 0.0)?)?;
        }
        mesh.add(column([line[1], top])?)?;
        mesh.add(LumpedMass::new(top, 0.5 * cap)?)?;
        if let Some(mass) = footing {
            let own = LumpedMass::new(line[1], mass)?;
            mesh.add(own.with_rotary_inertia(mass * B * B / 3.0)?)?;
        }
        lines.push(line);
        tops.push(top);
    }
    mesh.add(Truss::new([tops[0], tops[1]], 1e11, 1.0, 0.0)?)?;
    let mut model = FemModel::on_foundations(mesh, &lines)?;
    for (line, top) in lines.iter().zip(&tops) {
        let all = [line[0], line[2], *top];
        let rigid = if footing.is_some() { 2 } else { 3 };
        model = model.with_rigid_link(line[1], &all[..rigid])?;
    }
    Ok((model, [tops[0], tops[1]], [lines[0][1], lines[1][1]]))
}

/// Marches the frame, pushed to the right at each hinge by `push` (N/m) at most.
fn march(
    (model, tops, feet): (FemModel, [usize; 2], [usize; 2]),
    push: f64,
    time_step: f64,
    duration: f64,
) -> Result<History, AnyError> {
    // Stiff, and damped enough that a corner lands without rebound.
    let bed =
        SpringGround::under(&model, 2, 4e12, 1e13)?.with_dashpots(2e8, 0.0)?.with_theta(1.0)?;
    let hinges = model.row(tops[0], Direction::X)? + model.row(tops[1], Direction::X)?;
    let rows = [model.row(tops[0], Direction::X)?, model.row(feet[0], Direction::Rotation)?];
    let mut simulation = Simulation::builder(time_step)
        .structure(model)
        .ground(bed)
        .interface(Coulomb::uplift_only())
        .load(Load::new(hinges, move |time| push * pulse(time)))
        .build()?;
    let every = whole(SAMPLE / time_step);
    let mut history: History = [vec![0.0], vec![0.0]];
    let run = simulation.run(whole(duration / time_step), |state| {
        if state.step % every == 0 {
            let displacement = state.displacement();
            let values = rows.iter().map(|row| row.value(displacement));
            history.iter_mut().zip(values).for_each(|(list, value)| list.push(value));
        }
    })?;
    if run.energy_error > 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(history)
}

/// Columns 1 m × 4 m of stone that do not bend, with P–Δ, under a cap of `CAP` times their mass.
fn rigid(push: f64, time_step: f64, duration: f64) -> Result<History, AnyError> {
    let cap = 2.0 * COLUMN * CAP;
    let [width, compression] = [2.0 * B, STANDARD_GRAVITY * (0.5 * cap + 0.5 * COLUMN)];
    let density = COLUMN / (width * TOP);
    let column = |ends| {
        let beam = Beam::new(ends, 1e10, width, width.powi(3) / 12.0, density)?;
        beam.with_rotary_inertia().with_compression(compression)
    };
    march(frame(None, cap, column)?, push, time_step, duration)
}

/// A column with its part of the cap: the hinges are in the middle of its top, 2h above the base.
fn solitary() -> Rocker {
    let half = 0.5 * TOP;
    let inertia = COLUMN * ((B * B + half * half) / 3.0 + half * half);
    Rocker {
        half_width: B,
        mass: COLUMN * (1.0 + CAP),
        height: half * (1.0 + 2.0 * CAP) / (1.0 + CAP),
        inertia: inertia + CAP * COLUMN * TOP * TOP,
    }
}

/// Light columns that bend and shorten, without P–Δ, on footings with a mass.
fn flexible(push: f64, time_step: f64, duration: f64) -> Result<History, AnyError> {
    let [sway, axial] = [SWAY, AXIAL].map(|rate| LOAD * rate * rate);
    let column = |ends| Beam::new(ends, 1.0, axial * TOP, sway * TOP.powi(3) / 3.0, 0.0);
    march(frame(Some(FOOTING), 2.0 * LOAD, column)?, push, time_step, duration)
}

/// Displacement and tilt of one column of `flexible` from event to event, in steps of `step`, and the number of landings.
///
/// The cap's part moves by x and y, the footing turns by θ about one corner (side s) or stands:
/// m ẍ = F − k(x + lθ), m ÿ = N − m g, N = k_a (s b θ − y), (I₀ + m₀ b²) θ̈ = −l k(x + lθ) − s b (N + m₀ g).
/// It lifts where the column's moment exceeds b (N + m₀ g). It lands flat: the column does not push at once, and the
/// footing's own moment of momentum about the other corner would turn it back.
fn by_events(push: f64, step: f64, duration: f64) -> (History, usize) {
    let [sway, axial] = [SWAY, AXIAL].map(|rate| LOAD * rate * rate);
    let turned = FOOTING * B * B * (1.0 / 3.0 + 1.0);
    // x, y, θ and their rates.
    let rates = |time: f64, own: [f64; 6], side: f64| {
        let shear = sway * (own[0] + TOP * own[2]);
        let thrust = axial * (side * B * own[2] - own[1]);
        let weight = side * B * (thrust + FOOTING * STANDARD_GRAVITY);
        let turn = if side == 0.0 { 0.0 } else { (-TOP * shear - weight) / turned };
        let cap = (push * pulse(time) - shear) / LOAD;
        [own[3], own[4], own[5], cap, thrust / LOAD - STANDARD_GRAVITY, turn]
    };
    let mut own = [0.0, -LOAD * STANDARD_GRAVITY / axial, 0.0, 0.0, 0.0, 0.0];
    let (mut side, mut landings) = (0.0_f64, 0);
    let mut history: History = [vec![0.0], vec![0.0]];
    let (every, steps) = (whole(SAMPLE / step), whole(duration / step));
    for n in 0..steps {
        let time = n as f64 * step;
        // Runge and Kutta's.
        let along =
            |from: &[f64; 6], part: f64| std::array::from_fn(|i| own[i] + part * step * from[i]);
        let first = rates(time, own, side);
        let second = rates(time + 0.5 * step, along(&first, 0.5), side);
        let third = rates(time + 0.5 * step, along(&second, 0.5), side);
        let last = rates(time + step, along(&third, 1.0), side);
        for i in 0..6 {
            own[i] += step / 6.0 * (first[i] + 2.0 * second[i] + 2.0 * third[i] + last[i]);
        }
        if side == 0.0 {
            let moment = -TOP * sway * own[0];
            if moment.abs() > B * (FOOTING * STANDARD_GRAVITY - axial * own[1]) {
                side = moment.signum();
            }
        } else if side * own[2] < 0.0 {
            (own[2], own[5], side) = (0.0, 0.0, 0.0);
            landings += 1;
        }
        if (n + 1) % every == 0 {
            history.iter_mut().zip([own[0], own[2]]).for_each(|(list, value)| list.push(value));
        }
    }
    (history, landings)
}

fn relative(found: &[f64], wanted: &[f64]) -> f64 {
    let mut error = Error::default();
    found.iter().zip(wanted).for_each(|(a, b)| error.add(*a, *b));
    error.relative()
}

fn run(short: bool) -> Result<Outcome, AnyError> {
    let duration = if short { 2.5 } else { 4.0 };
    let column = solitary();
    let push = PUSH * column.weight() * B / TOP;
    let (wanted, impacts) = column.tilts(|time| -TOP * push * pulse(time), SAMPLE, duration);
    let [_, found] = rigid(push, 2e-5, duration)?;
    let mut checks =
        vec![Check::below("rigid columns: tilt, relative L2", relative(&found, &wanted), 2e-2)];
    let times = crossings(&found, SAMPLE);
    let count = impacts.len().min(IMPACTS);
    if times.len() < count {
        return Err("fewer impacts than are compared".into());
    }
    checks.push(Check::within("rigid columns: impacts", impacts.len() as f64, 2.0..=100.0));
    let apart = times.iter().zip(&impacts).take(count).map(|(a, b)| (a - b).abs());
    checks.push(Check::below("rigid columns: times of impacts, s", apart.fold(0.0, worse), 2e-3));
    // Without the cap the same tilt takes another time.
    let bare = Rocker {
        mass: COLUMN,
        height: 0.5 * TOP,
        inertia: column.inertia - CAP * COLUMN * TOP * TOP,
        ..column
    };
    let moment = |time: f64| -TOP * push * pulse(time) / (1.0 + CAP);
    let (other, _) = bare.tilts(moment, SAMPLE, duration);
    let name = "rigid columns without the cap: tilt, relative difference";
    checks.push(Check::within(name, relative(&other, &wanted), 0.1..=2.0));

    let push = PUSH * (LOAD + FOOTING) * STANDARD_GRAVITY * B / TOP;
    let (bent, landings) = by_events(push, 1e-5, duration);
    let (coarse, _) = by_events(push, 2e-5, duration);
    let marched = flexible(push, 2e-5, duration)?;
    for (k, name) in ["displacement of the cap", "tilt of the footings"].into_iter().enumerate() {
        let label = format!("columns that bend: {name}, relative L2");
        checks.push(Check::below(label, relative(&marched[k], &bent[k]), 1.5e-2));
        let label = format!("columns that bend: {name}, reference against twice its step");
        checks.push(Check::below(label, relative(&coarse[k], &bent[k]), 5e-4));
    }
    checks.push(Check::within("columns that bend: landings", landings as f64, 2.0..=100.0));

    let points = |values: &[f64]| {
        let each = values.iter().enumerate();
        each.map(|(k, value)| (k as f64 * SAMPLE, 1e3 * value)).collect::<Vec<_>>()
    };
    let panel = |label: &str, wanted: &[f64], found: &[f64]| {
        Panel::new("time, s", label)
            .room(0.05, 0.3)
            .reference("event by event", RED, points(wanted))
            .line("basemat, Δt = 0.02 ms", BLUE, points(found))
    };
    let panels = vec![
        panel("tilt of rigid columns, mrad", &wanted, &found),
        panel("displacement of the cap, mm (columns that bend)", &bent[0], &marched[0]),
        panel("tilt of the footings, mrad (columns that bend)", &bent[1], &marched[1]),
    ];
    let title = "Two columns 4 m high under a cap on hinges, pushed for half a second";
    Ok(Outcome { checks, figure: Figure::new(title, 3, panels) })
}
