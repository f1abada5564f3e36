//! A flexible structure on a mat that uplifts from springs and dashpots, by Yim & Chopra 1984.

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{Base, BaseNode, Structure, Triplets};
use plotters::prelude::SeriesLabelPosition;

use super::newmark_block::interpolated;
use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome, worse};
use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_GRAY, CURVE_RED, Figure, FigurePanel};
use basemat_problems::series::{RelativeError, nearest_integer};

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "yim_chopra",
    title: "Flexible structure that uplifts from a spring bed",
    reference: "separate Runge–Kutta integration of mat, mass and 400 strips of bed",
    settings: "40 elements, Δt = 1 ms, 10 s of El Centro",
    run,
};

/// Mass m on a massless column of height h, on a mat of mass m₀ and half width b.
#[derive(Debug, Clone, Copy)]
struct UpliftModel {
    mass: f64,
    mat: f64,
    height: f64,
    half_width: f64,
    /// Stiffness and dashpot of the column.
    stiffness: f64,
    damping: f64,
    /// Stiffness and dashpot of the bed per unit of area.
    bed_stiffness: f64,
    bed_dashpot: f64,
}

impl UpliftModel {
    /// Fixed-base period 0.6 s and damping 5 %; h/b = 5, m₀/m = 0.2; vertical frequency on the bed
    /// eight times the column's, with damping 40 %.
    fn new() -> Self {
        let mass = 1e5;
        let mat = 2e4;
        let height = 15.0;
        let half_width = 3.0;
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

    /// m g/h, the negative stiffness by the weight of the leaning column.
    fn p_delta_stiffness(&self) -> f64 {
        self.mass * STANDARD_GRAVITY / self.height
    }

    /// Moment of inertia of the mat about its middle.
    fn mat_inertia(&self) -> f64 {
        self.mat * self.half_width.powi(2) / 3.0
    }
}

/// Degrees of freedom `[u_x, u_y, θ, u_top]`.
impl Structure for UpliftModel {
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
        matrix.add_outer([(3, 1.0), (0, -1.0)], -self.p_delta_stiffness());
        Ok(())
    }

    fn damping(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_outer([(3, 1.0), (0, -1.0), (2, self.height)], self.damping);
        Ok(())
    }
}

/// Deformation of the column, settlement (m), tilt (rad, counter-clockwise) and uplifted part at every sample.
type UpliftSeries = [Vec<f64>; 4];

/// Interval of the samples, s.
const SAMPLE_INTERVAL: f64 = 0.01;

/// The equations of motion with the mat fixed to the ground sideways.
///
/// m ü = −k d − c ḋ + (m g/h) u − m a_g,  d = u + h θ, u from the ground,
/// (m+m₀) v̈ = Σ p l − (m+m₀) g,  I₀ θ̈ = −h (k d + c ḋ) + Σ p l x.
///
/// Each strip of the bed presses with p = k s + c ṡ while it touches the mat and p > 0. Where p
/// would become tension the mat leaves it, and it returns by k s + c ṡ = 0 until they meet.
struct StripBed {
    model: UpliftModel,
    /// Width of a strip, m.
    length: f64,
    /// Middles of the strips, m.
    positions: Vec<f64>,
    settlements: Vec<f64>,
    touching: Vec<bool>,
    /// u, v, θ and their rates.
    state: [f64; 6],
}

impl StripBed {
    fn new(model: &UpliftModel, strips: usize) -> Self {
        let weight = (model.mass + model.mat) * STANDARD_GRAVITY;
        let settlement = weight / (model.bed_stiffness * 2.0 * model.half_width);
        let length = 2.0 * model.half_width / strips as f64;
        Self {
            model: *model,
            length,
            positions: (0..strips)
                .map(|strip| (strip as f64 + 0.5) * length - model.half_width)
                .collect(),
            settlements: vec![settlement; strips],
            touching: vec![true; strips],
            state: [0.0, -settlement, 0.0, 0.0, 0.0, 0.0],
        }
    }

    /// Pressure of a strip that follows the mat.
    fn pressure(&self, state: &[f64; 6], x: f64) -> f64 {
        let settlement = -(state[1] + x * state[2]);
        self.model.bed_stiffness * settlement - self.model.bed_dashpot * (state[4] + x * state[5])
    }

    fn rates(&self, ground_acceleration: f64, state: &[f64; 6]) -> [f64; 6] {
        let UpliftModel { mass, mat, height, half_width, stiffness, damping, .. } = self.model;
        let mut force = 0.0;
        let mut moment = 0.0;
        for (x, _) in self.positions.iter().zip(&self.touching).filter(|(_, touches)| **touches) {
            let pressure = self.pressure(state, *x).max(0.0) * self.length;
            force += pressure;
            moment += pressure * x;
        }
        let column =
            stiffness * (state[0] + height * state[2]) + damping * (state[3] + height * state[5]);
        [
            state[3],
            state[4],
            state[5],
            (-column + mass * STANDARD_GRAVITY / height * state[0]) / mass - ground_acceleration,
            force / (mass + mat) - STANDARD_GRAVITY,
            (moment - height * column) / (mat * half_width * half_width / 3.0),
        ]
    }

    /// Computes a step of the midpoint method, then changes the contact.
    fn step(&mut self, record: &Record, time: f64, step: f64) {
        let first = self.rates(interpolated(record, time), &self.state);
        let middle = std::array::from_fn(|i| self.state[i] + 0.5 * step * first[i]);
        let second = self.rates(interpolated(record, time + 0.5 * step), &middle);
        for (value, rate) in self.state.iter_mut().zip(second) {
            *value += step * rate;
        }
        let creep = (-self.model.bed_stiffness / self.model.bed_dashpot * step).exp();
        for (strip, x) in self.positions.iter().enumerate() {
            let settlement = -(self.state[1] + x * self.state[2]);
            let free = self.settlements[strip] * creep;
            // A free strip touches the mat where the mat is at least as deep as the strip.
            self.touching[strip] = if self.touching[strip] {
                self.pressure(&self.state, *x) > 0.0
            } else {
                settlement >= free
            };
            self.settlements[strip] = if self.touching[strip] { settlement } else { free };
        }
    }

    fn uplifted_part(&self) -> f64 {
        let open_springs = self.touching.iter().filter(|touches| !**touches).count();
        open_springs as f64 / self.touching.len() as f64
    }
}

fn reference(
    model: &UpliftModel,
    record: &Record,
    strips: usize,
    step: f64,
    duration: f64,
) -> UpliftSeries {
    let mut bed = StripBed::new(model, strips);
    let stride = nearest_integer(SAMPLE_INTERVAL / step);
    let mut series: UpliftSeries = [vec![0.0], vec![-bed.state[1]], vec![0.0], vec![0.0]];
    for n in 0..nearest_integer(duration / step) {
        bed.step(record, n as f64 * step, step);
        if (n + 1) % stride == 0 {
            let y = &bed.state;
            series[0].push(y[0] + model.height * y[2]);
            series[1].push(-y[1]);
            series[2].push(y[2]);
            series[3].push(bed.uplifted_part());
        }
    }
    series
}

/// Time series of a run, and its energy error.
struct UpliftRun {
    series: UpliftSeries,
    energy_error: f64,
}

fn computed(
    model: UpliftModel,
    elements: usize,
    time_step: f64,
    duration: f64,
    uplifts: bool,
) -> Result<UpliftRun, AnyError> {
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
    let builder = if uplifts {
        builder.interface(Coulomb::uplift_only())
    } else {
        builder.interface(Bonded)
    };
    let mut simulation = builder.build()?;
    let settlement = -simulation.static_displacement()[1];
    let stride = nearest_integer(SAMPLE_INTERVAL / time_step);
    let mut series: UpliftSeries = [vec![0.0], vec![settlement], vec![0.0], vec![0.0]];
    let run = simulation.run(nearest_integer(duration / time_step), |state| {
        if state.step % stride == 0 {
            let u = state.absolute_displacement();
            series[0].push(u[3] - u[0] + model.height * u[2]);
            series[1].push(settlement - u[1]);
            series[2].push(u[2]);
            series[3].push(state.uplifted_fraction);
        }
    })?;
    Ok(UpliftRun { series, energy_error: run.energy_error })
}

fn errors(computed: &UpliftSeries, reference: &UpliftSeries) -> [f64; 4] {
    std::array::from_fn(|k| {
        let mut error = RelativeError::default();
        computed[k].iter().zip(&reference[k]).for_each(|(a, b)| error.add(*a, *b));
        error.relative()
    })
}

fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |peak, value| worse(peak, value.abs()))
}

/// Curve of samples multiplied by a factor.
fn scaled_curve(values: &[f64], factor: f64) -> Vec<(f64, f64)> {
    let samples = values.iter().enumerate();
    samples.map(|(k, value)| (k as f64 * SAMPLE_INTERVAL, factor * value)).collect()
}

fn panel(label: &str, reference: &[f64], computed: &[f64], factor: f64) -> FigurePanel {
    FigurePanel::new("time, s", label)
        .reference("Runge–Kutta, 400 strips", CURVE_RED, scaled_curve(reference, factor))
        .line("basemat, 40 elements, 1 ms", CURVE_BLUE, scaled_curve(computed, factor))
}

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let model = UpliftModel::new();
    let record = el_centro_1940();
    let duration = if short { 5.0 } else { 10.0 };
    let strips = if short { 200 } else { 400 };
    let step = if short { 5e-5 } else { 2e-5 };
    let fine = reference(&model, &record, strips, step, duration);
    let coarse = reference(&model, &record, strips / 2, 2.0 * step, duration);
    let UpliftRun { series, energy_error } = computed(model, 40, 1e-3, duration, true)?;
    let bonded = computed(model, 40, 1e-3, duration, false)?.series;
    let names = [
        "deformation of the column, relative L2",
        "settlement, relative L2",
        "tilt, relative L2",
        "uplifted part of the mat, relative L2",
    ];
    let mut checks =
        ValidationCheck::list(&names, &errors(&series, &fine), &[4e-3, 5e-3, 4e-3, 2.5e-2]);
    let ratio = peak(&series[0]) / peak(&fine[0]);
    checks.push(ValidationCheck::below("peak deformation, relative", (ratio - 1.0).abs(), 2e-3));
    let coarse_errors = errors(&coarse, &fine);
    let reference_error = coarse_errors[..3].iter().fold(0.0_f64, |worst, e| worse(worst, *e));
    let name = "reference against half its strips and steps";
    checks.push(ValidationCheck::below(name, reference_error, 1e-3));
    checks.push(ValidationCheck::below("energy balance, residual", energy_error, 1e-9));
    let peak_ratio = peak(&series[0]) / peak(&bonded[0]);
    checks.push(ValidationCheck::within(
        "peak deformation over that without uplift",
        peak_ratio,
        0.2..=0.6,
    ));
    // The weight balances a moment of at most (m+m₀) g b at the column's foot.
    let weight = (model.mass + model.mat) * STANDARD_GRAVITY;
    let limit = weight * model.half_width / (model.height * model.stiffness);
    let name = "peak deformation over (m+m₀)gb/(hk), which the weight can hold";
    checks.push(ValidationCheck::within(name, peak(&series[0]) / limit, 0.7..=1.0));
    let deformation = FigurePanel::new("time, s", "deformation of the column, mm")
        .dashed("basemat, no uplift", CURVE_GRAY, scaled_curve(&bonded[0], 1e3))
        .reference("Runge–Kutta, 400 strips", CURVE_RED, scaled_curve(&fine[0], 1e3))
        .line("basemat, 40 elements, 1 ms", CURVE_BLUE, scaled_curve(&series[0], 1e3))
        .legend(SeriesLabelPosition::UpperRight);
    let panels = vec![
        deformation.room(0.05, 0.6),
        panel("tilt of the mat, mrad", &fine[2], &series[2], 1e3).room(0.05, 0.3),
        panel("settlement of its middle (down), mm", &fine[1], &series[1], 1e3).room(0.05, 0.5),
        panel("uplifted part of the mat", &fine[3], &series[3], 1.0).room(0.05, 0.5),
    ];
    let title =
        "Column of 0.6 s on a mat on springs and dashpots without tension, El Centro 1940 NS";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 2, panels) })
}
