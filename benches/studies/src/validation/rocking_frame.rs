//! Frames of two rocking columns under a cap on hinges, with rigid columns and columns that bend.

use std::f64::consts::PI;

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::coupled::Load;
use basemat::fem::{Beam, Direction, LumpedMass, Mesh, Truss};
use basemat::interface::Coulomb;
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::FemModel;

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome, milli_curve, worse};
use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_RED, Figure, FigurePanel};
use basemat_problems::rocking::{Rocker, crossings};
use basemat_problems::series::{RelativeError, nearest_integer};

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "rocking_frame",
    title: "Rocking frame of two columns",
    reference: "rigid columns: Housner's block of the frame's mass, inertia and height, event by event; columns that bend: separate integration, event by event",
    settings: "two stiff elements under each column, Δt = 0.02 ms; pushed at the cap for half a second",
    run,
};

/// Half width of a column's base, height of the hinges, distance of the columns (m).
const B: f64 = 0.5;
const HINGE_HEIGHT: f64 = 4.0;
const COLUMN_SPAN: f64 = 8.0;
/// Mass of a rigid column, kg/m, and of the cap over both columns' mass.
const COLUMN_MASS: f64 = 10e3;
const CAP_MASS_RATIO: f64 = 0.5;
/// Mass of the footing of a column that bends and of the cap on it, kg/m; rates of its sway and axial motion, 1/s.
const FOOTING_MASS: f64 = 2e3;
const CAP_MASS: f64 = 10e3;
const SWAY_RATE: f64 = 12.0;
const AXIAL_RATE: f64 = 60.0;
/// Moment of the push about the base over the largest moment of the weight, and its duration, s.
const PUSH_FACTOR: f64 = 1.6;
const PUSH_DURATION: f64 = 0.5;
/// Interval of the samples, s.
const SAMPLE_INTERVAL: f64 = 0.01;
/// Number of impacts that are compared.
const IMPACT_COUNT: usize = 4;

/// The push relative to its largest value.
fn pulse(time: f64) -> f64 {
    if time > 0.0 && time < PUSH_DURATION {
        (PI * time / PUSH_DURATION).sin()
    } else {
        0.0
    }
}

/// Displacement of the cap to the right and tilt of the footings, at every sample.
type FrameSeries = [Vec<f64>; 2];

/// The frame, the nodes of its hinges, and the left foot.
struct RockingFrame {
    model: FemModel,
    hinges: [usize; 2],
    left_foot: usize,
}

/// The frame with columns that bend if their feet have the mass `footing`, or with rigid columns.
fn frame(
    footing: Option<f64>,
    cap: f64,
    column: impl Fn([usize; 2]) -> basemat::Result<Beam>,
) -> Result<RockingFrame, AnyError> {
    let mut mesh = Mesh::new();
    let mut lines = Vec::new();
    let mut tops = Vec::new();
    for x in [-0.5 * COLUMN_SPAN, 0.5 * COLUMN_SPAN] {
        // Pressures of two elements act at ±b.
        let line = [x - 2.0 * B, x, x + 2.0 * B].map(|x| mesh.add_node(x, 0.0));
        let line = line.into_iter().collect::<Result<Vec<_>, _>>()?;
        let top = mesh.add_node(x, HINGE_HEIGHT)?;
        for ends in [[line[0], line[1]], [line[1], line[2]]] {
            mesh.add(Beam::new(ends, 1e9, 1.0, 1.0, 0.0)?)?;
        }
        mesh.add(column([line[1], top])?)?;
        mesh.add(LumpedMass::new(top, 0.5 * cap)?)?;
        if let Some(mass) = footing {
            let lumped = LumpedMass::new(line[1], mass)?;
            mesh.add(lumped.with_rotary_inertia(mass * B * B / 3.0)?)?;
        }
        lines.push(line);
        tops.push(top);
    }
    mesh.add(Truss::new([tops[0], tops[1]], 1e11, 1.0, 0.0)?)?;
    let mut model = FemModel::on_foundations(mesh, &lines)?;
    for (line, top) in lines.iter().zip(&tops) {
        let linked = [line[0], line[2], *top];
        let count = if footing.is_some() { 2 } else { 3 };
        model = model.with_rigid_link(line[1], &linked[..count])?;
    }
    Ok(RockingFrame { model, hinges: [tops[0], tops[1]], left_foot: lines[0][1] })
}

/// Marches the frame, pushed to the right at each hinge by `push` (N/m) at most.
fn march(
    RockingFrame { model, hinges, left_foot }: RockingFrame,
    push: f64,
    time_step: f64,
    duration: f64,
) -> Result<FrameSeries, AnyError> {
    // The stiff bed is damped, so that a corner lands without rebound.
    let bed = SpringGround::under(&model, 2, 4e12, 1e13)?
        .with_dashpots(2e8, 0.0)?
        .with_theta(1.0)?;
    let pushed_row = model.row(hinges[0], Direction::X)? + model.row(hinges[1], Direction::X)?;
    let rows = [model.row(hinges[0], Direction::X)?, model.row(left_foot, Direction::Rotation)?];
    let mut simulation = Simulation::builder(time_step)
        .structure(model)
        .ground(bed)
        .interface(Coulomb::uplift_only())
        .load(Load::new(pushed_row, move |time| push * pulse(time)))
        .build()?;
    let stride = nearest_integer(SAMPLE_INTERVAL / time_step);
    let mut series: FrameSeries = [vec![0.0], vec![0.0]];
    let run = simulation.run(nearest_integer(duration / time_step), |state| {
        if state.step % stride == 0 {
            for (values, row) in series.iter_mut().zip(&rows) {
                values.push(row.value(state.displacement()));
            }
        }
    })?;
    if run.energy_error > 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(series)
}

/// Marches rigid columns 1 m × 4 m with P–Δ under a cap.
fn rigid(push: f64, time_step: f64, duration: f64) -> Result<FrameSeries, AnyError> {
    let cap = 2.0 * COLUMN_MASS * CAP_MASS_RATIO;
    let width = 2.0 * B;
    let compression = STANDARD_GRAVITY * (0.5 * cap + 0.5 * COLUMN_MASS);
    let density = COLUMN_MASS / (width * HINGE_HEIGHT);
    let frame = frame(None, cap, |ends| {
        let beam = Beam::new(ends, 1e10, width, width.powi(3) / 12.0, density)?;
        beam.with_rotary_inertia().with_compression(compression)
    })?;
    march(frame, push, time_step, duration)
}

/// A column with its part of the cap; the hinges are in the middle of its top, 2h above the base.
fn single_column() -> Rocker {
    let half_height = 0.5 * HINGE_HEIGHT;
    let inertia =
        COLUMN_MASS * ((B * B + half_height * half_height) / 3.0 + half_height * half_height);
    Rocker {
        half_width: B,
        mass: COLUMN_MASS * (1.0 + CAP_MASS_RATIO),
        height: half_height * (1.0 + 2.0 * CAP_MASS_RATIO) / (1.0 + CAP_MASS_RATIO),
        inertia: inertia + CAP_MASS_RATIO * COLUMN_MASS * HINGE_HEIGHT * HINGE_HEIGHT,
    }
}

/// Marches light columns that bend and shorten, without P–Δ, on footings with a mass.
fn flexible(push: f64, time_step: f64, duration: f64) -> Result<FrameSeries, AnyError> {
    let sway = CAP_MASS * SWAY_RATE * SWAY_RATE;
    let axial = CAP_MASS * AXIAL_RATE * AXIAL_RATE;
    let frame = frame(Some(FOOTING_MASS), 2.0 * CAP_MASS, |ends| {
        Beam::new(ends, 1.0, axial * HINGE_HEIGHT, sway * HINGE_HEIGHT.powi(3) / 3.0, 0.0)
    })?;
    march(frame, push, time_step, duration)
}

/// One column of `flexible` and its part of the cap.
///
/// The cap's part moves by x and y, the footing turns by θ about one corner (side s) or stands:
/// m ẍ = F − k(x + lθ), m ÿ = N − m g, N = k_a (s b θ − y), (I₀ + m₀ b²) θ̈ = −l k(x + lθ) − s b (N + m₀ g).
struct BendingColumn {
    push: f64,
    sway_stiffness: f64,
    axial_stiffness: f64,
    /// 1 or −1 for a corner, 0 if the footing stands.
    side: f64,
    /// x, y, θ and their rates.
    state: [f64; 6],
}

impl BendingColumn {
    fn rates(&self, time: f64, state: [f64; 6]) -> [f64; 6] {
        let footing_inertia = FOOTING_MASS * B * B * (1.0 / 3.0 + 1.0);
        let shear = self.sway_stiffness * (state[0] + HINGE_HEIGHT * state[2]);
        let thrust = self.axial_stiffness * (self.side * B * state[2] - state[1]);
        let weight = self.side * B * (thrust + FOOTING_MASS * STANDARD_GRAVITY);
        let turn = if self.side == 0.0 {
            0.0
        } else {
            (-HINGE_HEIGHT * shear - weight) / footing_inertia
        };
        let cap = (self.push * pulse(time) - shear) / CAP_MASS;
        [state[3], state[4], state[5], cap, thrust / CAP_MASS - STANDARD_GRAVITY, turn]
    }

    /// Computes a step of Runge–Kutta integration.
    fn step(&mut self, time: f64, step: f64) {
        let start = self.state;
        let advanced = |rates: &[f64; 6], part: f64| -> [f64; 6] {
            std::array::from_fn(|i| start[i] + part * step * rates[i])
        };
        let first = self.rates(time, start);
        let second = self.rates(time + 0.5 * step, advanced(&first, 0.5));
        let third = self.rates(time + 0.5 * step, advanced(&second, 0.5));
        let last_rates = self.rates(time + step, advanced(&third, 1.0));
        for i in 0..6 {
            self.state[i] +=
                step / 6.0 * (first[i] + 2.0 * second[i] + 2.0 * third[i] + last_rates[i]);
        }
    }

    /// Lifts the footing where the column's moment exceeds b (N + m₀ g), or lets it land; returns whether it landed.
    ///
    /// It lands flat: the column does not push at once, and the footing's moment of momentum about the other corner
    /// would turn it back.
    fn change_side(&mut self) -> bool {
        if self.side == 0.0 {
            let moment = -HINGE_HEIGHT * self.sway_stiffness * self.state[0];
            let thrust = FOOTING_MASS * STANDARD_GRAVITY - self.axial_stiffness * self.state[1];
            if moment.abs() > B * thrust {
                self.side = moment.signum();
            }
            return false;
        }
        let lands = self.side * self.state[2] < 0.0;
        if lands {
            self.state[2] = 0.0;
            self.state[5] = 0.0;
            self.side = 0.0;
        }
        lands
    }
}

/// Displacement and tilt of one column of `flexible` from event to event, and the number of landings.
fn by_events(push: f64, step: f64, duration: f64) -> (FrameSeries, usize) {
    let axial_stiffness = CAP_MASS * AXIAL_RATE * AXIAL_RATE;
    let mut column = BendingColumn {
        push,
        sway_stiffness: CAP_MASS * SWAY_RATE * SWAY_RATE,
        axial_stiffness,
        side: 0.0,
        state: [0.0, -CAP_MASS * STANDARD_GRAVITY / axial_stiffness, 0.0, 0.0, 0.0, 0.0],
    };
    let mut landings = 0;
    let mut series: FrameSeries = [vec![0.0], vec![0.0]];
    let stride = nearest_integer(SAMPLE_INTERVAL / step);
    for n in 0..nearest_integer(duration / step) {
        column.step(n as f64 * step, step);
        landings += usize::from(column.change_side());
        if (n + 1) % stride == 0 {
            series[0].push(column.state[0]);
            series[1].push(column.state[2]);
        }
    }
    (series, landings)
}

fn relative(computed: &[f64], reference: &[f64]) -> f64 {
    let mut error = RelativeError::default();
    computed.iter().zip(reference).for_each(|(a, b)| error.add(*a, *b));
    error.relative()
}

fn panel(label: &str, reference: &[f64], computed: &[f64]) -> FigurePanel {
    FigurePanel::new("time, s", label)
        .room(0.05, 0.3)
        .reference("event by event", CURVE_RED, milli_curve(SAMPLE_INTERVAL, reference))
        .line("basemat, Δt = 0.02 ms", CURVE_BLUE, milli_curve(SAMPLE_INTERVAL, computed))
}

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let duration = if short { 2.5 } else { 4.0 };
    let column = single_column();
    let push = PUSH_FACTOR * column.weight() * B / HINGE_HEIGHT;
    let (reference, impacts) =
        column.tilts(|time| -HINGE_HEIGHT * push * pulse(time), SAMPLE_INTERVAL, duration);
    let tilts = &rigid(push, 2e-5, duration)?[1];
    let mut checks = vec![ValidationCheck::below(
        "rigid columns: tilt, relative L2",
        relative(tilts, &reference),
        2e-2,
    )];
    let times = crossings(tilts, SAMPLE_INTERVAL);
    let count = impacts.len().min(IMPACT_COUNT);
    if times.len() < count {
        return Err("fewer impacts than are compared".into());
    }
    checks.push(ValidationCheck::within(
        "rigid columns: impacts",
        impacts.len() as f64,
        2.0..=100.0,
    ));
    let differences = times.iter().zip(&impacts).take(count).map(|(a, b)| (a - b).abs());
    let time_error = differences.fold(0.0, worse);
    checks.push(ValidationCheck::below("rigid columns: times of impacts, s", time_error, 2e-3));
    // Without the cap the tilt differs.
    let without_cap = Rocker {
        mass: COLUMN_MASS,
        height: 0.5 * HINGE_HEIGHT,
        inertia: column.inertia - CAP_MASS_RATIO * COLUMN_MASS * HINGE_HEIGHT * HINGE_HEIGHT,
        ..column
    };
    let tilts_without_cap = without_cap.tilts(
        |time| -HINGE_HEIGHT * push * pulse(time) / (1.0 + CAP_MASS_RATIO),
        SAMPLE_INTERVAL,
        duration,
    );
    let name = "rigid columns without the cap: tilt, relative difference";
    checks.push(ValidationCheck::within(
        name,
        relative(&tilts_without_cap.0, &reference),
        0.1..=2.0,
    ));

    let push = PUSH_FACTOR * (CAP_MASS + FOOTING_MASS) * STANDARD_GRAVITY * B / HINGE_HEIGHT;
    let (fine, landings) = by_events(push, 1e-5, duration);
    let coarse = by_events(push, 2e-5, duration).0;
    let computed = flexible(push, 2e-5, duration)?;
    for (k, name) in ["displacement of the cap", "tilt of the footings"].into_iter().enumerate() {
        let label = format!("columns that bend: {name}, relative L2");
        checks.push(ValidationCheck::below(label, relative(&computed[k], &fine[k]), 1.5e-2));
        let label = format!("columns that bend: {name}, reference against twice its step");
        checks.push(ValidationCheck::below(label, relative(&coarse[k], &fine[k]), 5e-4));
    }
    checks.push(ValidationCheck::within(
        "columns that bend: landings",
        landings as f64,
        2.0..=100.0,
    ));

    let panels = vec![
        panel("tilt of rigid columns, mrad", &reference, tilts),
        panel("displacement of the cap, mm (columns that bend)", &fine[0], &computed[0]),
        panel("tilt of the footings, mrad (columns that bend)", &fine[1], &computed[1]),
    ];
    let title = "Two columns 4 m high under a cap on hinges, pushed for half a second";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 3, panels) })
}
