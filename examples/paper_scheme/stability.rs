//! Growth and passivity of boundary equations, over kernels and steps.

use basemat::Soil;
use basemat::bem::full_plane::{
    BoundaryCondition, BoundaryKernel, ConvolutionQuadrature, CqMethod, Segment, Stability,
    TimeKernel,
};

use super::AnyError;
use super::report::growth_of;

const ELEMENTS: usize = 20;
const SMALLEST_GROWTH: f64 = 1e-3;

/// A flat boundary of 20 equal elements, all free of traction or all held, ν = 1/3.
pub(crate) fn print_table() -> Result<(), AnyError> {
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0)?;
    let segments: Vec<_> = (0..ELEMENTS)
        .map(|k| Segment { from: [k as f64, 0.0], to: [(k + 1) as f64, 0.0] })
        .collect();
    println!("| kernel | β | free: growth per step | held: growth per step | held: passivity |");
    println!("|---|---|---|---|---|");
    for name in ["in time", "BDF2", "BDF1"] {
        for beta in [0.1, 0.25, 0.5, 1.0, 2.0, 5.0] {
            let step = beta / soil.pressure_wave_speed();
            let quadrature = |method| ConvolutionQuadrature::new(soil, &segments, step, method);
            let kernel: Box<dyn BoundaryKernel> = match name {
                "BDF2" => Box::new(quadrature(CqMethod::Bdf2)?),
                "BDF1" => Box::new(quadrature(CqMethod::Bdf1)?),
                _ => Box::new(TimeKernel::new(soil, &segments, step)?),
            };
            let assess = |condition| {
                Stability::assess(kernel.as_ref(), &[condition; ELEMENTS], SMALLEST_GROWTH)
            };
            let free = assess(BoundaryCondition::TractionFree)?;
            let held = assess(BoundaryCondition::PrescribedDisplacement)?;
            let passivity = held.passivity.map_or_else(|| "–".to_owned(), |p| format!("{p:.1e}"));
            println!(
                "| {name} | {beta} | {} | {} | {passivity} |",
                growth_of(&free),
                growth_of(&held)
            );
        }
    }
    Ok(())
}
