//! A box of soil around a foundation: accuracy beside the half-plane, and processor time of steps when the soil yields.
//!
//! ```text
//! cargo study near-field
//! ```
//!
//! First table: a box of elastic soil under a welded block beside the half-plane, and alone beside the free field
//! (`basemat_problems::near_field`). Second table: a block of 6 × 10 m on clay of 60 kPa (150 m/s) under 1.5 times
//! El Centro, with a safety of 2.6: it rocks, lifts off, and the clay yields. The box has some 2000 degrees of freedom
//! and is bonded to the 64 contact elements of its trench. The process fails if a limit is exceeded.

use basemat::bem::SharedKernels;
use basemat::bem::embedded::NearField;
use basemat::coupled::Joint;
use basemat::prelude::*;
use basemat::site::TrenchMotion;
use basemat::unobserved;
use basemat_problems::near_field::welded_block_differences;
use basemat_problems::near_field_waves::free_field_difference;
use cpu_time::ThreadTime;

use crate::AnyError;

/// A box of soil around a foundation: accuracy, and processor time of steps when the soil yields.
///
/// Fails if a limit is exceeded.
#[derive(Debug, clap::Args)]
pub(crate) struct NearFieldOptions {
    /// Few elements and steps, as a test without limit.
    #[arg(long)]
    short: bool,
}

const HALF_WIDTH: f64 = 3.0;
const BLOCK_HEIGHT: f64 = 10.0;
const BLOCK_DENSITY: f64 = 1250.0;
const CLAY_STRENGTH: f64 = 60.0e3;
const PRESSURE_RATIO: f64 = 0.8;
const FRICTION_COEFFICIENT: f64 = 0.7;
const MOTION_FACTOR: f64 = 1.5;
const TIME_STEP: f64 = 0.01;
/// Half width and depth of the box, in half widths of the foundation.
const BOX_RATIOS: [f64; 2] = [5.0, 3.0];
const FOUNDATION_ELEMENTS: usize = 8;
const STEP_COUNT: usize = 600;
/// Each time is the smaller of this many runs, which alternate.
const REPETITION_COUNT: usize = 2;
/// Largest mean processor time of a step, ms.
const MAX_STEP_TIME: f64 = 10.0;

/// Largest differences: top of a welded block, its lower corner upwards, nodes of the box alone.
const MAX_TOP_DIFFERENCE: f64 = 0.003;
const MAX_CORNER_DIFFERENCE: f64 = 0.03;
const MAX_FREE_FIELD_DIFFERENCE: f64 = 0.005;
/// Angle of inclined waves from the vertical, rad.
const WAVE_ANGLE: f64 = 0.35;

/// Size of a scene, and processor times.
#[derive(Debug, Clone, Copy)]
struct NearFieldCost {
    structure_dofs: usize,
    trench_elements: usize,
    joint_elements: usize,
    /// Until the simulation is built, s.
    building: f64,
    /// Mean and largest time of a step, ms.
    mean_step: f64,
    max_step: f64,
    /// Settlement at the end, mm.
    settlement: f64,
}

fn near_field(is_short: bool) -> basemat::Result<NearField> {
    let clay = Soil::from_shear_wave_speed(150.0, 0.45, 1800.0)?;
    let soil_box = NearField::new(clay, HALF_WIDTH)?
        .with_pressure_at_rest(STANDARD_GRAVITY, PRESSURE_RATIO)?;
    if is_short {
        return Ok(soil_box);
    }
    let [half_width, depth] = BOX_RATIOS.map(|ratio| ratio * HALF_WIDTH);
    soil_box.with_foundation_elements(FOUNDATION_ELEMENTS)?.with_size(half_width, depth)
}

fn measure(
    near_field: &NearField,
    kernels: &SharedKernels,
    steps: usize,
) -> Result<NearFieldCost, AnyError> {
    let begin = ThreadTime::try_now()?;
    let soil = FemModel::on_soil_at_rest(near_field.mesh()?)?;
    let block = RigidBlock::new(2.0 * HALF_WIDTH, BLOCK_HEIGHT, BLOCK_DENSITY)?;
    let lower = soil.contact_nodes(&near_field.foundation_nodes(soil.mesh())?)?;
    let upper = block.contact_nodes(&[[-HALF_WIDTH, 0.0], [HALF_WIDTH, 0.0]])?;
    let group = StructureGroup::new().with(soil, 0.0)?.with_above(block, [0.0, 0.0])?;
    let joint =
        Joint::around_nodes(group.contact_nodes(1, upper)?, group.contact_nodes(0, lower)?)?;
    let up = Probe::displacement("up", group.row(1, RigidBlock::VERTICAL_DOF)?);
    let structure_dofs = group.dofs();
    let ground = near_field.ground()?.with_shared_kernels(kernels);
    let trench_elements = ground.trench_elements().elements().len();
    let record = el_centro_1940().scaled(MOTION_FACTOR)?.padded(0.2, 0.0)?;
    let motion = TrenchMotion::new(&ground, record, &mut unobserved)?;
    let mut simulation = Simulation::builder(TIME_STEP)
        .ground(ground)
        .structure(group)
        .interface(Bonded)
        .joint(joint.with_law(Coulomb::new(FRICTION_COEFFICIENT)?))
        .motion(motion)
        .probes([up])
        .expected_steps(steps)
        .build()?;
    let building = begin.try_elapsed()?.as_secs_f64();
    let joint_elements = simulation.state().joints[0].modes.len();
    let mut total = 0.0;
    let mut max_step = 0.0_f64;
    for _ in 0..steps {
        let clock = ThreadTime::try_now()?;
        simulation.step()?;
        let milliseconds = 1e3 * clock.try_elapsed()?.as_secs_f64();
        total += milliseconds;
        max_step = max_step.max(milliseconds);
    }
    Ok(NearFieldCost {
        structure_dofs,
        trench_elements,
        joint_elements,
        building,
        mean_step: total / steps as f64,
        max_step,
        settlement: -1e3 * simulation.state().probes[0],
    })
}

/// Runs the study.
pub(crate) fn run(options: &NearFieldOptions) -> Result<(), AnyError> {
    let is_accurate = accuracy()?;
    let is_fast = costs(options)?;
    if is_accurate && is_fast { Ok(()) } else { Err("a limit is exceeded".into()) }
}

/// Prints differences from half-plane and free field, and returns whether all are within their limits.
fn accuracy() -> Result<bool, AnyError> {
    let [top, corner] = welded_block_differences()?;
    let rows = [
        ("top of a welded block", top, MAX_TOP_DIFFERENCE),
        ("lower corner of the block, upwards", corner, MAX_CORNER_DIFFERENCE),
        ("box alone, vertical waves", free_field_difference(0.0)?, MAX_FREE_FIELD_DIFFERENCE),
        (
            "box alone, waves of 0.35 rad",
            free_field_difference(WAVE_ANGLE)?,
            MAX_FREE_FIELD_DIFFERENCE,
        ),
    ];
    println!("| compared | difference, % | limit, % |");
    println!("|---|---|---|");
    for (name, difference, limit) in rows {
        println!("| {name} | {:.3} | {} |", 100.0 * difference, 100.0 * limit);
    }
    println!();
    Ok(rows.iter().all(|(_, difference, limit)| difference <= limit))
}

/// Prints processor times, and returns whether a mean step is within its limit.
fn costs(options: &NearFieldOptions) -> Result<bool, AnyError> {
    let (repetitions, steps) =
        if options.short { (1, 100) } else { (REPETITION_COUNT, STEP_COUNT) };
    let elastic = near_field(options.short)?;
    let yielding = elastic.clone().with_strength_profile(|_| CLAY_STRENGTH);
    let kernels = SharedKernels::default();
    let mut costs = [None::<NearFieldCost>; 2];
    for _ in 0..repetitions {
        for (cost, soil_box) in costs.iter_mut().zip([&elastic, &yielding]) {
            let measured = measure(soil_box, &kernels, steps)?;
            if cost.is_none_or(|cost| measured.mean_step < cost.mean_step) {
                *cost = Some(measured);
            }
        }
    }
    println!(
        "| box | degrees of freedom | elements of trench, joint | build, s | mean, largest step, ms | settled, mm |"
    );
    println!("|---|---|---|---|---|---|");
    for (name, cost) in ["elastic", "yielding"].into_iter().zip(costs) {
        let Some(cost) = cost else { continue };
        println!(
            "| {name} | {} | {}, {} | {:.2} | {:.2}, {:.1} | {:.1} |",
            cost.structure_dofs,
            cost.trench_elements,
            cost.joint_elements,
            cost.building,
            cost.mean_step,
            cost.max_step,
            cost.settlement
        );
    }
    let exceeds = |cost: &NearFieldCost| cost.mean_step > MAX_STEP_TIME;
    Ok(options.short || !costs.iter().flatten().any(exceeds))
}
