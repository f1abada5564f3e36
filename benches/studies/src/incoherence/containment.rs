//! A containment of shells on a raft that lifts off and slides, under coherent and incoherent motion.

use std::fmt::Write as _;

use basemat::bem::SharedKernels;
use basemat::fem::{Direction, Material, Mesh};
use basemat::motion::{Baseline, Incoherence, LucoWong, Triaxial};
use basemat::prelude::*;
use basemat::results::log_spaced;
use basemat::structure::DofCombination;

use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_GRAY, CURVE_RED, Figure, FigurePanel};

/// Radius of the wall's middle surface, m, height of the wall, m, and thicknesses of raft, wall and dome, m.
const WALL_RADIUS: f64 = 20.0;
const WALL_HEIGHT: f64 = 30.0;
const SHELL_THICKNESSES: [f64; 3] = [3.0, 1.2, 1.0];
/// Rows of shells in raft, wall and dome, and shells around the axis.
const ROW_COUNTS: [usize; 3] = [4, 5, 3];
const SECTOR_COUNT: usize = 16;
/// Speed of shear waves in the soil, m/s, and the parameter of the coherence.
const SHEAR_WAVE_SPEED: f64 = 500.0;
const COHERENCE_PARAMETER: f64 = 0.25;
const FRICTION_COEFFICIENT: f64 = 0.5;
/// Factor of El Centro.
const RECORD_FACTOR: f64 = 1.5;
const TIME_STEP: f64 = 0.01;
/// Quiet time before the record, and duration of the run, s.
const QUIET_TIME: f64 = 3.0;
const RUN_DURATION: f64 = 13.0;
/// Damping ratio of the equipment, and periods of the table, s.
const EQUIPMENT_DAMPING: f64 = 0.05;
const TABLE_PERIODS: [f64; 4] = [0.05, 0.1, 0.2, 0.5];
/// Number of periods of the picture.
const PERIOD_COUNT: usize = 60;

/// Probes at the top of the wall: along x, upwards at the edge, and along the edge by torsion.
const PROBE_NAMES: [&str; 3] = ["horizontal", "vertical at the edge", "torsion at the edge"];

/// The containment, and the rows of its probes.
fn containment() -> Result<(FemModel, [DofCombination; 3]), AnyError> {
    let [raft_rows, wall_rows, dome_rows] = ROW_COUNTS;
    let fraction = |row: usize, rows: usize| row as f64 / rows as f64;
    let mut meridian = Vec::new();
    for row in 0..raft_rows {
        meridian.push([WALL_RADIUS * fraction(row, raft_rows), 0.0]);
    }
    for row in 0..wall_rows {
        meridian.push([WALL_RADIUS, WALL_HEIGHT * fraction(row, wall_rows)]);
    }
    for row in 0..=dome_rows {
        let angle = std::f64::consts::FRAC_PI_2 * fraction(row, dome_rows);
        let radius = if row == dome_rows { 0.0 } else { WALL_RADIUS * angle.cos() };
        meridian.push([radius, WALL_HEIGHT + WALL_RADIUS * angle.sin()]);
    }
    let concrete = Material::new(32.0e9, 0.2, 2450.0)?;
    let mut mesh = Mesh::in_space();
    let surface = mesh.revolve([0.0; 2], &meridian, SECTOR_COUNT)?;
    let thickness = |row: usize| {
        let part = usize::from(row >= raft_rows) + usize::from(row >= raft_rows + wall_rows);
        SHELL_THICKNESSES[part]
    };
    for shell in surface.shells(concrete, thickness)? {
        mesh.add(shell)?;
    }
    let damping = RayleighDamping::from_ratios([4.0, 25.0], [0.05, 0.05])?;
    let model = FemModel::on_base(mesh)?.with_rayleigh(damping);
    let dof = |x: f64, y: f64, direction: Direction| -> Result<usize, AnyError> {
        let node = model.mesh().node_at_point([x, y, WALL_HEIGHT])?;
        model.dof(node, direction).ok_or_else(|| "restrained node".into())
    };
    let front = dof(0.0, -WALL_RADIUS, Direction::X)?;
    let back_dof = dof(0.0, WALL_RADIUS, Direction::X)?;
    let rows = [
        DofCombination::from([(front, 0.5), (back_dof, 0.5)]),
        DofCombination::from([(dof(WALL_RADIUS, 0.0, Direction::Z)?, 1.0)]),
        DofCombination::from([(front, 0.5), (back_dof, -0.5)]),
    ];
    Ok((model, rows))
}

/// Peaks of a run and its floor spectra.
struct ContainmentResponse {
    peaks: Vec<f64>,
    /// Pseudo-accelerations of each probe, g.
    spectra: [Vec<f64>; 3],
    energy_error: f64,
}

/// Names, units and factors of the peaks.
const PEAK_NAMES: [(&str, &str, f64); 7] = [
    ("base shear along x", "MN", 1e-6),
    ("base moment about y", "MNm", 1e-6),
    ("torque", "MNm", 1e-6),
    ("rotation about y", "mrad", 1e3),
    ("twist", "mrad", 1e3),
    ("uplifted area", "%", 100.0),
    ("slip", "mm", 1e3),
];

/// Quantities of the peaks.
const PEAK_QUANTITIES: [Quantity; 7] = [
    Quantity::BaseShear,
    Quantity::BaseMoment,
    Quantity::Torque,
    Quantity::BaseRotation,
    Quantity::Twist,
    Quantity::UpliftedFraction,
    Quantity::MeanSlip,
];

/// What all runs have in common.
struct ContainmentScene {
    model: FemModel,
    probe_rows: [DofCombination; 3],
    records: Triaxial,
    kernels: SharedKernels,
    cells: usize,
    step_count: usize,
    periods: Vec<f64>,
}

impl ContainmentScene {
    fn new(short: bool) -> Result<Self, AnyError> {
        let (model, probe_rows) = containment()?;
        let record = el_centro_1940().scaled(RECORD_FACTOR)?;
        let record = record.with_baseline(Baseline::RestToRest { degree: 4 })?;
        let records = Triaxial {
            x: Some(record.padded(QUIET_TIME, 2.0)?),
            y: Some(record.scaled(0.7)?.padded(QUIET_TIME + 0.5, 2.0)?),
            up: Some(record.scaled(0.4)?.padded(QUIET_TIME + 1.0, 2.0)?),
        };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "thousands")]
        let step_count = (RUN_DURATION / TIME_STEP).round() as usize;
        let mut periods = log_spaced(0.03, 2.0, PERIOD_COUNT)?;
        periods.extend(TABLE_PERIODS);
        Ok(Self {
            model,
            probe_rows,
            records,
            kernels: SharedKernels::default(),
            cells: if short { 4 } else { 8 },
            step_count: if short { 20 } else { step_count },
            periods,
        })
    }

    /// Run with incoherent motion of a seed, or coherent motion.
    fn run(&self, seed: Option<u64>) -> Result<ContainmentResponse, AnyError> {
        let soil = Soil::from_shear_wave_speed(SHEAR_WAVE_SPEED, 1.0 / 3.0, 2000.0)?;
        let ground = ElasticGround::under(soil, &self.model, self.cells)?;
        let ground = ground.with_shared_kernels(&self.kernels);
        let motion: Box<dyn FreeField> = match seed {
            None => Box::new(self.records.clone()),
            Some(seed) => {
                let coherence = LucoWong::new(COHERENCE_PARAMETER, SHEAR_WAVE_SPEED)?;
                let incoherence = Incoherence::new(coherence).with_seed(seed);
                Box::new(incoherence.motion(&self.records, ground.elements())?)
            }
        };
        let mut builder = Simulation::builder(TIME_STEP)
            .ground(ground)
            .structure(self.model.clone())
            .interface(Coulomb::new(FRICTION_COEFFICIENT)?)
            .motion(motion)
            .expected_steps(self.step_count);
        for (name, row) in PROBE_NAMES.iter().zip(&self.probe_rows) {
            builder = builder.probe(Probe::acceleration(*name, row.clone()));
        }
        let mut simulation = builder.build()?;
        let mut series = Recorder::new().start(&simulation)?;
        let run = simulation.run(self.step_count, |state| series.record(state))?;
        let peaks = PEAK_QUANTITIES.map(|quantity| run.whole.extremes(quantity).magnitude());
        let mut spectra = [vec![], vec![], vec![]];
        for (spectrum, name) in spectra.iter_mut().zip(PROBE_NAMES) {
            for ordinate in series.floor_spectrum(name, &self.periods, EQUIPMENT_DAMPING)? {
                spectrum.push(ordinate.pseudo_acceleration / STANDARD_GRAVITY);
            }
        }
        Ok(ContainmentResponse { peaks: peaks.to_vec(), spectra, energy_error: run.energy_error })
    }
}

/// Mean, smallest and largest of the seeds.
fn statistics(values: &[f64]) -> [f64; 3] {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    [mean, low, values.iter().copied().fold(f64::NEG_INFINITY, f64::max)]
}

/// Table and picture of coherent and incoherent runs.
pub(super) struct IncoherenceComparison {
    pub(super) table: String,
    pub(super) figure: Figure,
}

/// Runs with coherent motion, and with incoherent motion of several seeds.
pub(super) fn compare(seed_count: u64, short: bool) -> Result<IncoherenceComparison, AnyError> {
    let scene = ContainmentScene::new(short)?;
    let coherent_run = scene.run(None)?;
    let mut incoherent = Vec::new();
    for seed in 0..seed_count {
        incoherent.push(scene.run(Some(seed))?);
        println!("seed {seed}: {:?}", incoherent[incoherent.len() - 1].peaks);
    }
    let largest_error = incoherent
        .iter()
        .map(|run| run.energy_error)
        .fold(coherent_run.energy_error, f64::max);
    let mut text = "| largest | unit | coherent | incoherent, mean | smallest | largest | mean over coherent |\n|---|---|---|---|---|---|---|\n".to_owned();
    let mut add_row = |name: &str, unit: &str, coherent_run: f64, values: &[f64]| {
        let [mean, low, high] = statistics(values);
        writeln!(
            text,
            "| {name} | {unit} | {coherent_run:.3} | {mean:.3} | {low:.3} | {high:.3} | {:.2} |",
            mean / coherent_run
        )
    };
    for (k, (name, unit, factor)) in PEAK_NAMES.into_iter().enumerate() {
        let values: Vec<f64> = incoherent.iter().map(|run| factor * run.peaks[k]).collect();
        add_row(name, unit, factor * coherent_run.peaks[k], &values)?;
    }
    for (probe, name) in PROBE_NAMES.into_iter().enumerate() {
        for (k, period) in TABLE_PERIODS.into_iter().enumerate() {
            let index = PERIOD_COUNT + k;
            let values: Vec<f64> = incoherent.iter().map(|r| r.spectra[probe][index]).collect();
            let name = format!("spectrum, {name}, {period} s");
            add_row(&name, "g", coherent_run.spectra[probe][index], &values)?;
        }
    }
    writeln!(text, "\nLargest energy error of the runs: {largest_error:.0e}.")?;
    let panels = PROBE_NAMES.iter().enumerate().map(|(probe, name)| {
        let curve = |value: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
            (0..PERIOD_COUNT).map(|k| (scene.periods[k].log10(), value(k))).collect()
        };
        let of_seeds = |k: usize, statistic: usize| {
            let values: Vec<f64> = incoherent.iter().map(|run| run.spectra[probe][k]).collect();
            statistics(&values)[statistic]
        };
        FigurePanel::new("log₁₀ of the period in s", &format!("{name}, g"))
            .line("coherent", CURVE_RED, curve(&|k| coherent_run.spectra[probe][k]))
            .line("incoherent, mean", CURVE_BLUE, curve(&|k| of_seeds(k, 0)))
            .dashed("smallest and largest", CURVE_GRAY, curve(&|k| of_seeds(k, 1)))
            .dashed("", CURVE_GRAY, curve(&|k| of_seeds(k, 2)))
    });
    let title = "Floor spectra at the top of a containment's wall, 5 % damping";
    let figure = Figure::new(title, 1, panels.collect());
    Ok(IncoherenceComparison { table: text, figure })
}
