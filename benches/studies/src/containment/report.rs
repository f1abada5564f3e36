//! Table 1, the paper's conclusions in figures, comma-separated files, and the paper's pictures as it draws them.

use std::path::Path;

use basemat::plot::{Curve, curves};
use basemat::results::Quantity;
use basemat_problems::containment::{PAPER_SHEARS, POUND_FORCE_PER_FOOT, ROWS, pounds_per_foot};

use super::case::Outcome;
use crate::AnyError;
use crate::document::write_csv;

/// Root mean square.
fn size(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    (values.map(|value| value * value).sum::<f64>() / count).sqrt()
}

/// Change in percent, with its sign.
fn change(value: f64, other: f64) -> String {
    format!("{:+.1} %", 100.0 * (value / other - 1.0))
}

/// Shear of a superstructure that moves as the foundation's top does: difference from the computed shear, as a ratio of
/// root mean squares.
fn rigid_difference(outcome: &Outcome) -> Result<f64, AnyError> {
    let shear = outcome.time_series.probe("base shear")?;
    let foundation = outcome.time_series.probe("foundation")?;
    let apart = shear.iter().zip(foundation);
    let apart = apart.map(|(shear, a)| shear + outcome.superstructure_mass * a);
    Ok(size(apart) / size(shear.iter().copied()))
}

/// Peaks beside Table 1; what the paper concludes about, against uplift only; what sliding without deformation
/// would give; the checks of service.
pub(crate) fn print(results: &[Outcome], weights: [f64; 2]) {
    let [bonded, uplift, ..] = results else { return };
    println!(
        "| case | Table 1, lb/ft | here | over bonded | uplift | slip of the base, mm | A to a side, mm | A up, mm \
         | A against the base, mm | energy balance |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    for outcome in results {
        let printed =
            outcome.case.printed_shear().map_or("–".into(), |shear| format!("{shear:.0}"));
        println!(
            "| {} | {printed} | {:.0} ({}) | {:.3} | {:.0} % | {:.1} | {:.1} ({}) | {:.1} ({}) | {:.1} ({}) | {:.0e} |",
            outcome.case.name,
            pounds_per_foot(outcome.peak_shear),
            change(outcome.peak_shear, uplift.peak_shear),
            outcome.peak_shear / bonded.peak_shear,
            100.0 * outcome.run.whole.uplifted_fraction.largest().value,
            1e3 * outcome.run.whole.mean_slip.magnitude(),
            1e3 * outcome.peak_roof,
            change(outcome.peak_roof, uplift.peak_roof),
            1e3 * outcome.peak_lift,
            change(outcome.peak_lift, uplift.peak_lift),
            1e3 * outcome.peak_sway,
            change(outcome.peak_sway, uplift.peak_sway),
            outcome.run.energy_error,
        );
    }
    let [all, superstructure] = weights.map(pounds_per_foot);
    println!(
        "\nweight {all:.0} lb/ft, of it superstructure {superstructure:.0}; base shear over friction, \
         which is the latter in rigid sliding, kip/ft:"
    );
    for outcome in &results[2..] {
        let (Some(friction), Some(paper)) = (outcome.case.friction, outcome.case.printed_shear())
        else {
            continue;
        };
        let [found, paper] =
            [pounds_per_foot(outcome.peak_shear), paper].map(|shear| 1e-3 * shear / friction);
        println!("{}: {found:.1}, in Table 1 {paper:.1}", outcome.case.name);
    }
    println!("\nserviceability");
    for outcome in results {
        let checks: Vec<_> = outcome.run.serviceability.iter().map(ToString::to_string).collect();
        println!("{}: {}", outcome.case.name, checks.join("; "));
    }
    for outcome in results {
        for warning in &outcome.run.warnings {
            println!("{}: {warning}", outcome.case.name);
        }
    }
}

/// Writes `summary.csv`, a row per case, and `serviceability.csv`, a row per case and criterion.
pub(crate) fn write(folder: &Path, results: &[Outcome]) -> Result<(), AnyError> {
    let mut rows = Vec::new();
    for outcome in results {
        let (run, case) = (&outcome.run, &outcome.case);
        let numbers = [
            outcome.peak_shear,
            run.whole.base_shear.magnitude(),
            outcome.peak_shear / results[0].peak_shear,
            run.whole.uplifted_fraction.largest().value,
            run.whole.largest_slip.magnitude(),
            run.whole.residual_slip,
            outcome.peak_roof,
            run.energy_error,
            outcome.peak_lift,
            run.whole.mean_slip.magnitude(),
            outcome.peak_sway,
            rigid_difference(outcome)?,
        ];
        let [a, b, c, d, e, f, g, h, i, j, k, l] = numbers.map(|number| number.to_string());
        let friction = case.friction.map_or_else(String::new, |friction| friction.to_string());
        rows.push([case.name.clone(), friction, a, b, c, d, e, f, g, h, i, j, k, l]);
    }
    write_csv(
        folder.join("summary.csv"),
        [
            "case",
            "friction",
            "peak_base_shear_n_per_m",
            "peak_contact_shear_n_per_m",
            "ratio_to_bonded",
            "max_uplift_fraction",
            "max_slip_m",
            "residual_slip_m",
            "peak_roof_displacement_m",
            "energy_error",
            "peak_roof_rise_m",
            "peak_mean_slip_m",
            "peak_roof_over_base_m",
            "rigid_superstructure_rms_difference",
        ],
        rows,
    )?;
    let checks = results.iter().flat_map(|o| o.run.serviceability.iter().map(move |c| (o, c)));
    write_csv(
        folder.join("serviceability.csv"),
        ["case", "criterion", "largest", "limit", "margin", "first_excess_s"],
        checks.map(|(outcome, check)| {
            [
                outcome.case.name.clone(),
                check.criterion.name().to_owned(),
                check.largest.value.to_string(),
                check.limit.to_string(),
                check.margin().to_string(),
                check.first_excess.map_or_else(String::new, |time| time.to_string()),
            ]
        }),
    )
}

/// Peaks and time series of two meshes, and `meshes.csv`: root mean square differences over the finer
/// mesh's root mean squares.
pub(crate) fn compare_meshes(
    folder: &Path,
    coarse: &[Outcome],
    fine: &[Outcome],
) -> Result<(), AnyError> {
    println!(
        "\n| 10 against 15 elements | peak shear, lb/ft | rms difference: A to a side | A up and down | \
         base shear |\n|---|---|---|---|---|"
    );
    let mut rows = Vec::new();
    for (coarse, fine) in coarse.iter().zip(fine) {
        let times = fine.time_series.times();
        let apart = |probe: &str| -> Result<f64, AnyError> {
            let values = fine.time_series.probe(probe)?;
            let at = |time: f64| {
                let next = times.partition_point(|t| *t < time).clamp(1, times.len() - 1);
                let part = (time - times[next - 1]) / (times[next] - times[next - 1]);
                (1.0 - part) * values[next - 1] + part * values[next]
            };
            let found = coarse.curve(probe, 1.0)?;
            let differences = found.iter().map(|(time, value)| value - at(*time));
            Ok(size(differences) / size(found.iter().map(|(time, _)| at(*time))))
        };
        let differences = [apart("roof x")?, apart("roof y")?, apart("base shear")?];
        let peaks = [coarse.peak_shear, fine.peak_shear];
        let name = coarse.case.name.clone();
        let percent = differences.map(|difference| format!("{:.1} %", 100.0 * difference));
        let pounds = peaks.map(|shear| format!("{:.0}", pounds_per_foot(shear)));
        println!("| {name} | {} | {} |", pounds.join(", "), percent.join(" | "));
        let [a, b] = peaks.map(|peak| peak.to_string());
        let [c, d, e] = differences.map(|difference| difference.to_string());
        rows.push([name, a, b, c, d, e]);
    }
    write_csv(
        folder.join("meshes.csv"),
        [
            "case",
            "peak_base_shear_n_per_m",
            "peak_base_shear_15_elements_n_per_m",
            "rms_roof_x",
            "rms_roof_y",
            "rms_base_shear",
        ],
        rows,
    )
}

/// The paper's Figs. 4, 5 and 6 as it draws them, uplift only and friction 0.4, and the slip of the base.
pub(crate) fn draw(folder: &Path, results: &[Outcome]) -> Result<(), AnyError> {
    let both = || results.iter().filter(|o| [ROWS[1].1, ROWS[2].1].contains(&o.case.friction));
    for (file, title, unit, probe, factor) in [
        ("figure_4", "Fig. 4: absolute horizontal displacement at A", "mm", "roof x", 1e3),
        ("figure_5", "Fig. 5: vertical displacement at A", "mm", "roof y", 1e3),
        ("figure_6", "Fig. 6: base shear", "kN/m", "base shear", 1e-3),
    ] {
        let lines = both()
            .map(|o| Ok(Curve { name: o.case.name.clone(), points: o.curve(probe, factor)? }));
        let lines = lines.collect::<basemat::Result<Vec<_>>>()?;
        curves(title, "time, s", unit, &lines)?.save(folder.join(format!("{file}.svg")))?;
    }
    let lines: Vec<_> = both().map(|o| (o.case.name.as_str(), &o.time_series)).collect();
    let title = "Displacement of the base relative to the soil";
    basemat::plot::time_series(title, &lines, Quantity::MeanSlip)?
        .save(folder.join("base_slip.svg"))?;
    Ok(())
}

/// Peak base shear over friction, with uplift only as a level, and the paper's rows as points.
pub(crate) fn draw_sweep(
    folder: &Path,
    frictions: &[f64],
    runs: &[Outcome],
    uplift_only: f64,
) -> Result<(), AnyError> {
    let end = frictions.last().copied().unwrap_or(1.0);
    let level = |name: &str, shear: f64| Curve {
        name: name.into(),
        points: vec![(0.0, 1e-3 * shear), (end, 1e-3 * shear)],
    };
    let peaks = frictions.iter().zip(runs).map(|(mu, run)| (*mu, 1e-3 * run.peak_shear));
    let paper = ROWS[2..].iter().zip(&PAPER_SHEARS[2..]).filter_map(|((_, friction), shear)| {
        Some(((*friction)?, 1e-3 * shear * POUND_FORCE_PER_FOOT))
    });
    let lines = [
        Curve { name: "here".into(), points: peaks.collect() },
        level("here, uplift only", uplift_only),
        Curve { name: "Table 1".into(), points: paper.collect() },
        level("Table 1, uplift only", PAPER_SHEARS[1] * POUND_FORCE_PER_FOOT),
    ];
    curves("Peak base shear over friction", "friction coefficient", "shear, kN/m", &lines)?
        .save(folder.join("friction_sweep.svg"))?;
    Ok(())
}
