//! Rigid blocks on the half-plane under a vertically incident SV pulse.

use basemat::coupled::State;
use basemat::structure::RigidBlock;

use super::outcome::{Case, Check, Outcome, worse};
use super::transient::{History, Quantity, base_motion, histories, moment, panel, rotation, shear};
use crate::AnyError;
use crate::figure::Figure;

pub(crate) const CASE: Case = Case {
    name: "block_sv_pulse",
    title: "Rigid block under an SV pulse",
    reference: "frequency-domain tables, Fourier synthesis",
    settings: "16 cosine-graded elements, Δt = 0.05 b/c_S, bonded, six blocks",
    run,
};

fn block(
    name: &str,
    poisson: f64,
    height: f64,
    density: f64,
) -> Result<(Vec<History>, f64), AnyError> {
    let roof = |state: &State| {
        state.absolute_displacement()[0] - height * state.absolute_displacement()[2]
    };
    histories(
        &format!("td_block_SV_{name}.csv"),
        RigidBlock::new(2.0, height, density)?,
        poisson,
        &[
            Quantity::at_end("u_base", "base displacement", &base_motion, 4e-3),
            Quantity::at_end("theta", "rotation", &rotation, 7.5e-3),
            Quantity::at_end("u_roof", "roof displacement", &roof, 8e-3),
            Quantity::mean("V", "base shear", &shear, 2.5e-3),
            Quantity::mean("M", "base moment", &moment, 1.3e-2),
        ],
    )
}

fn run(short: bool) -> Result<Outcome, AnyError> {
    let third = 1.0 / 3.0;
    let list = [
        ("nu0333_h2_rho1", third, 2.0, 1.0),
        ("nu025_h2_rho1", 0.25, 2.0, 1.0),
        ("nu0333_h1_rho1", third, 1.0, 1.0),
        ("nu025_h1_rho1", 0.25, 1.0, 1.0),
        ("nu0333_h4_rho0.5", third, 4.0, 0.5),
        ("nu025_h4_rho0.5", 0.25, 4.0, 0.5),
    ];
    let list = if short { &list[..2] } else { &list[..] };
    let mut checks: Vec<Check> = Vec::new();
    let mut worst_ledger = 0.0_f64;
    let mut shown = Vec::new();
    for (name, poisson, height, density) in list {
        let (found, ledger) = block(name, *poisson, *height, *density)?;
        worst_ledger = worse(worst_ledger, ledger);
        for (k, history) in found.iter().enumerate() {
            match checks.get_mut(k) {
                Some(check) => check.value = worse(check.value, history.error),
                None => checks.push(Check::below(
                    format!("{}, relative L2, worst block", history.name),
                    history.error,
                    history.limit,
                )),
            }
        }
        if shown.is_empty() {
            shown = found;
        }
    }
    checks.push(Check::below("energy ledger, residual", worst_ledger, 1e-10));
    let units = [" / A", " b / A", " / A", " / (μ A)", " / (μ A b)"];
    let panels = [0, 1, 3, 4].map(|k| panel(&shown[k], units[k]));
    let title = "Block of height 2b and the soil's density, ν = 1/3; the free field is a Ricker pulse of amplitude A";
    Ok(Outcome { checks, figure: Figure::new(title, 2, panels.into()) })
}
