//! A shear building of three storeys on a massive base, under a vertically incident SV pulse.

use basemat::coupled::State;
use basemat_problems::tabled_structures::three_storeys;

use super::outcome::{Case, Outcome};
use super::transient::{Quantity, base_motion, checks, histories, moment, panel, rotation, shear};
use crate::AnyError;
use crate::figure::Figure;

pub(crate) const CASE: Case = Case {
    name: "three_storeys",
    title: "Three-storey building on the strip",
    reference: "frequency-domain table, Fourier synthesis",
    settings: "16 cosine-graded elements, Δt = 0.05 b/c_S, bonded, ν = 1/3",
    run,
};

fn run(_short: bool) -> Result<Outcome, AnyError> {
    let building = three_storeys()?;
    let rows = building.shear(0)?;
    let storey_shear =
        move |s: &State| rows.value(s.absolute_displacement(), s.velocity(), s.acceleration());
    // Storey displacements relative to the frame of the base.
    let relative = |j: u8| {
        move |state: &State| {
            let u = state.absolute_displacement();
            u[2 + usize::from(j)] - u[0] + f64::from(j) * u[2]
        }
    };
    let (first, third) = (relative(1), relative(3));
    let (found, ledger) = histories(
        "td_shearbuilding3_SV_nu0333_sig1.csv",
        building,
        1.0 / 3.0,
        &[
            Quantity::at_end("u_base", "base displacement", &base_motion, 3.1e-3),
            Quantity::at_end("theta", "rotation", &rotation, 4.3e-3),
            Quantity::at_end("v1", "first floor, relative", &first, 3.6e-3),
            Quantity::at_end("v3", "third floor, relative", &third, 7.2e-3),
            Quantity::at_end("V1", "first storey's shear", &storey_shear, 3.3e-3),
            Quantity::mean("V", "base shear", &shear, 2e-3),
            Quantity::mean("M", "base moment", &moment, 1.1e-2),
        ],
    )?;
    let units = [" / A", " b / A", " / A", " / A", " / (μ A)", " / (μ A)", " / (μ A b)"];
    let panels = [0, 3, 4, 6].map(|k| panel(&found[k], units[k]));
    let title =
        "Three storeys of height b on a massive rigid base, 5 % damping in the first mode, ν = 1/3";
    let figure = Figure::new(title, 2, panels.into());
    Ok(Outcome { checks: checks(&found, ledger), figure })
}
