//! Impedances and kinematic motion of a rigid block in a trench as deep as half its width.

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::{Complex, Soil, unobserved};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome, worse};
use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_RED, Figure, FigurePanel};
use basemat_problems::table;
use basemat_problems::welded_block::{self, Cause};

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "embedded",
    title: "Rigid block in a trench",
    reference: "finite elements of degree 8 and collocation boundary elements, which agree to 2.5e-4",
    settings: "20 and 40 cosine-graded elements, d = b, ν = 1/3, 0.25 ≤ ωb/c_S ≤ 3",
    run,
};

/// Stiffness (hh, vv, rr, hr), and horizontal motion and rotation of the block without mass, at each frequency.
struct TrenchCurves {
    frequencies: Vec<f64>,
    values: Vec<[Complex; 6]>,
}

fn tabled() -> TrenchCurves {
    let stiffness = table("embedded/impedance_embedded_nu0333.csv");
    let motion = table("embedded/kinematic_embedded_nu0333.csv");
    let columns =
        ["a0", "re_khh", "im_khh", "re_kvv", "im_kvv", "re_krr", "im_krr", "re_khr", "im_khr"];
    let stiffness = stiffness.rows(columns);
    let motion = motion.rows(["re_ux", "im_ux", "re_theta", "im_theta"]);
    let mut values = Vec::new();
    for (k, u) in stiffness.iter().zip(&motion) {
        let parts: Vec<f64> = k[1..].iter().chain(u).copied().collect();
        values.push(std::array::from_fn(|i| Complex::new(parts[2 * i], parts[2 * i + 1])));
    }
    TrenchCurves { frequencies: stiffness.iter().map(|row| row[0]).collect(), values }
}

fn computed(base: usize, wall: usize, a0: &[f64]) -> basemat::Result<Vec<[Complex; 6]>> {
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0)?;
    let ground = TrenchGround::new(soil, Trench::new(-1.0..1.0, 1.0)?.elements(base, wall)?)?;
    let frequencies: Vec<f64> = a0.iter().map(|a0| a0 / std::f64::consts::TAU).collect();
    let stiffness = ground.impedances(&frequencies, &mut unobserved)?;
    let motions = ground.kinematic_motions(&frequencies, &mut unobserved)?;
    let mut rows = Vec::new();
    for (k, u) in stiffness.iter().zip(&motions) {
        rows.push([k.horizontal, k.vertical, k.rocking, k.coupling, u.horizontal, u.rotation]);
    }
    Ok(rows)
}

/// Largest errors: of hh, vv, rr relative to each, of hr to the mean of hh and rr, of motions to the horizontal one.
fn errors(computed: &[[Complex; 6]], references: &[[Complex; 6]]) -> [f64; 6] {
    let mut max_errors = [0.0; 6];
    for (computed, reference) in computed.iter().zip(references) {
        for k in 0..6 {
            let scale = match k {
                0..=2 => reference[k].abs(),
                3 => (reference[0].abs() * reference[2].abs()).sqrt(),
                _ => reference[4].abs(),
            };
            max_errors[k] = worse(max_errors[k], (computed[k] - reference[k]).abs() / scale);
        }
    }
    max_errors
}

/// A block welded to 20 elements, stepped under waves and forces, against Fourier synthesis with the same elements.
fn steps() -> Result<Vec<ValidationCheck>, AnyError> {
    let mut checks = vec![];
    for (step, step_name, count, limit) in [(0.2, "dt02", 128, 1e-2), (0.1, "dt01", 256, 2.5e-3)] {
        let elements = Trench::new(-1.0..1.0, 1.0)?.elements(8, 6)?;
        let mut ground = TrenchGround::new(Soil::new(1.0, 1.0 / 3.0, 1.0)?, elements)?;
        for (cause, name) in [(Cause::Waves(1.0), "SV"), (Cause::Force, "force")] {
            let march = welded_block::march(&mut ground, step, count, cause);
            let table = format!("{name}_h1f_{step_name}");
            for (motion, error) in
                ["motion", "rotation"].iter().zip(welded_block::errors(&march, &table))
            {
                checks.push(ValidationCheck::below(
                    format!("cΔt/b = {step}, {name}, {motion}"),
                    error,
                    limit,
                ));
            }
        }
    }
    Ok(checks)
}

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let TrenchCurves { frequencies, values } = tabled();
    let step = if short { 4 } else { 1 };
    let frequencies: Vec<f64> = frequencies.into_iter().step_by(step).collect();
    let references: Vec<_> = values.into_iter().step_by(step).collect();
    let names = ["horizontal", "vertical", "rocking", "coupling", "motion", "rotation"];
    let meshes = [
        ([8, 6], [5e-3, 5e-3, 5e-3, 5e-3, 1.5e-3, 1.5e-3]),
        ([16, 12], [1.2e-3, 1.2e-3, 1.2e-3, 1.2e-3, 4e-4, 4e-4]),
    ];
    let meshes = if short { &meshes[..1] } else { &meshes[..] };
    let mut checks = vec![];
    let mut shown_curves = vec![];
    for ([base, wall], limits) in meshes {
        shown_curves = computed(*base, *wall, &frequencies)?;
        let count = base + 2 * wall;
        let results = names.into_iter().zip(errors(&shown_curves, &references)).zip(limits);
        checks.extend(results.map(|((name, error), limit)| {
            ValidationCheck::below(format!("{count} elements, {name}"), error, *limit)
        }));
    }
    if !short {
        checks.extend(steps()?);
    }
    let titles = [
        "horizontal: K_hh/μ",
        "vertical: K_vv/μ",
        "rocking: K_rr/(μb²)",
        "motion of the base: u/u_surface",
    ];
    let panels = titles.iter().zip([0, 1, 2, 4]).map(|(title, k)| {
        let mut panel = FigurePanel::new("a₀ = ωb/c_S", title).room(0.05, 0.85);
        panel = panel.legend(SeriesLabelPosition::UpperMiddle);
        for (part, name, color) in [(0, "Re", CURVE_BLUE), (1, "Im", CURVE_RED)] {
            let line = |rows: &[[Complex; 6]]| -> Vec<(f64, f64)> {
                let values = rows.iter().map(|row| [row[k].re, row[k].im][part]);
                frequencies.iter().copied().zip(values).collect()
            };
            panel = panel.reference(&format!("{name}, table"), color, line(&references));
            panel = panel.line(&format!("{name}, basemat"), color, line(&shown_curves));
        }
        panel
    });
    let title = "Rigid block welded in a trench of depth b and half width b, ν = 1/3";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 2, panels.collect()) })
}
