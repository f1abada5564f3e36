//! Growth and passivity of boundary equations, over kernels and steps.

use basemat::Soil;
use basemat::bem::full_plane::{
    BoundaryCondition, BoundaryKernel, ConvolutionQuadrature, CqMethod, Segment, Stability,
    TimeKernel,
};

use super::report::growth_of;
use crate::AnyError;
use basemat_problems::boundary_passivity::boundary_passivity;

const ELEMENT_COUNT: usize = 20;
const SMALLEST_GROWTH: f64 = 1e-3;

const STEP_BETAS: [f64; 6] = [0.1, 0.25, 0.5, 1.0, 2.0, 5.0];

const KERNEL_NAMES: [&str; 3] = ["in time", "BDF2", "BDF1"];

/// Coefficients of unit elements in a soil with ν = 1/3.
fn kernel(name: &str, segments: &[Segment], beta: f64) -> basemat::Result<Box<dyn BoundaryKernel>> {
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0)?;
    let step = beta / soil.pressure_wave_speed();
    let method = match name {
        "BDF2" => CqMethod::Bdf2,
        "BDF1" => CqMethod::Bdf1,
        _ => return Ok(Box::new(TimeKernel::new(soil, segments, step)?)),
    };
    Ok(Box::new(ConvolutionQuadrature::new(soil, segments, step, method)?))
}

/// Unit elements between nodes.
fn chain(nodes: &[[f64; 2]]) -> Vec<Segment> {
    nodes.windows(2).map(|pair| Segment { from: pair[0], to: pair[1] }).collect()
}

/// Prints the table of a flat boundary of 20 equal elements, free of traction or fixed, then of a trench.
pub(crate) fn print_table() -> Result<(), AnyError> {
    let nodes: Vec<_> = (0..=ELEMENT_COUNT).map(|k| [k as f64, 0.0]).collect();
    let flat_surface = chain(&nodes);
    println!("| kernel | β | free: growth per step | held: growth per step | held: passivity |");
    println!("|---|---|---|---|---|");
    for name in KERNEL_NAMES {
        for beta in STEP_BETAS {
            let kernel = kernel(name, &flat_surface, beta)?;
            let assess = |condition| {
                Stability::assess(kernel.as_ref(), &[condition; ELEMENT_COUNT], SMALLEST_GROWTH)
            };
            let free = assess(BoundaryCondition::TractionFree)?;
            let fixed = assess(BoundaryCondition::PrescribedDisplacement)?;
            let passivity = boundary_passivity(kernel.as_ref())[0];
            println!(
                "| {name} | {beta} | {} | {} | {passivity:.1e} |",
                growth_of(&free),
                growth_of(&fixed)
            );
        }
    }
    print_trench()
}

/// Prints the table of a trench 2 wide and 4 deep with 6 of surface on either side, free of traction.
fn print_trench() -> Result<(), AnyError> {
    let mut nodes: Vec<_> = (0..=6).map(|k| [f64::from(k), 0.0]).collect();
    nodes.extend((1..=4).map(|k| [6.0, f64::from(k)]));
    nodes.extend([[7.0, 4.0], [8.0, 4.0]]);
    nodes.extend((0..4).rev().map(|k| [8.0, f64::from(k)]));
    nodes.extend((9..=14).map(|k| [f64::from(k), 0.0]));
    let trench = chain(&nodes);
    let conditions = vec![BoundaryCondition::TractionFree; trench.len()];
    println!("\n| trench: β | {} |\n|---|---|---|---|", KERNEL_NAMES.join(" | "));
    for beta in STEP_BETAS {
        print!("| {beta} |");
        for name in KERNEL_NAMES {
            let kernel = kernel(name, &trench, beta)?;
            let stability = Stability::assess(kernel.as_ref(), &conditions, SMALLEST_GROWTH)?;
            print!(" {} |", growth_of(&stability));
        }
        println!();
    }
    Ok(())
}
