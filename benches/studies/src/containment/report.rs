//! Table 1, the paper's conclusions in figures, comma-separated files, and the pictures of the paper.

use std::path::Path;

use basemat::plot::{Curve, curves};
use basemat::results::Quantity;
use basemat_problems::containment::{
    PAPER_SHEARS, POUND_FORCE_PER_FOOT, TABLE_1_ROWS, pounds_per_foot,
};

use super::case::ContainmentOutcome;
use crate::AnyError;
use crate::document::write_csv;

/// Root mean square.
fn root_mean_square(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    (values.map(|value| value * value).sum::<f64>() / count).sqrt()
}

/// Change in percent, with its sign.
fn change(value: f64, reference: f64) -> String {
    format!("{:+.1} %", 100.0 * (value / reference - 1.0))
}

/// Difference between the shear of a rigid superstructure and the computed shear, as a ratio of root mean squares.
///
/// The rigid superstructure moves as the top of the foundation.
fn rigid_difference(outcome: &ContainmentOutcome) -> Result<f64, AnyError> {
    let shear = outcome.time_series.probe("base shear")?;
    let foundation = outcome.time_series.probe("foundation")?;
    let pairs = shear.iter().zip(foundation);
    let difference = pairs.map(|(shear, a)| shear + outcome.superstructure_mass * a);
    Ok(root_mean_square(difference) / root_mean_square(shear.iter().copied()))
}

/// Prints peaks beside Table 1 and beside uplift only, shears of rigid sliding, and checks of serviceability.
pub(crate) fn print(results: &[ContainmentOutcome], weights: [f64; 2]) {
    let [bonded, uplift, ..] = results else { return };
    println!(
        "| case | Table 1, lb/ft | here | over bonded | uplift | slip of the base, mm | A to a side, mm | A up, mm \
         | A against the base, mm | energy balance |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    for outcome in results {
        let paper_shear =
            outcome.case.printed_shear().map_or("–".into(), |shear| format!("{shear:.0}"));
        println!(
            "| {} | {paper_shear} | {:.0} ({}) | {:.3} | {:.0} % | {:.1} | {:.1} ({}) | {:.1} ({}) | {:.1} ({}) | {:.0e} |",
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
    println!(
        "\nweight {:.0} lb/ft, of it superstructure {:.0}; base shear over friction, \
         which is the latter in rigid sliding, kip/ft:",
        pounds_per_foot(weights[0]),
        pounds_per_foot(weights[1])
    );
    for outcome in &results[2..] {
        let (Some(friction), Some(paper)) = (outcome.case.friction, outcome.case.printed_shear())
        else {
            continue;
        };
        println!(
            "{}: {:.1}, in Table 1 {:.1}",
            outcome.case.name,
            1e-3 * pounds_per_foot(outcome.peak_shear) / friction,
            1e-3 * paper / friction
        );
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
pub(crate) fn write(folder: &Path, results: &[ContainmentOutcome]) -> Result<(), AnyError> {
    let mut rows = Vec::new();
    for outcome in results {
        let run = &outcome.run;
        let case = &outcome.case;
        let friction = case.friction.map_or_else(String::new, |friction| friction.to_string());
        let mut row = vec![case.name.clone(), friction];
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
        row.extend(numbers.map(|number| number.to_string()));
        rows.push(<[String; 14]>::try_from(row).map_err(|_| "a row of 14 cells")?);
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
    let checks = results
        .iter()
        .flat_map(|outcome| outcome.run.serviceability.iter().map(move |check| (outcome, check)));
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

/// Root mean square difference of a probe on two meshes over the root mean square on the finer mesh.
fn mesh_difference(
    coarse: &ContainmentOutcome,
    fine: &ContainmentOutcome,
    probe: &str,
) -> Result<f64, AnyError> {
    let times = fine.time_series.times();
    let values = fine.time_series.probe(probe)?;
    let mut differences = Vec::new();
    let mut references = Vec::new();
    for (time, value) in coarse.curve(probe, 1.0)? {
        let next_index = times.partition_point(|t| *t < time).clamp(1, times.len() - 1);
        let fraction = (time - times[next_index - 1]) / (times[next_index] - times[next_index - 1]);
        let reference = (1.0 - fraction) * values[next_index - 1] + fraction * values[next_index];
        differences.push(value - reference);
        references.push(reference);
    }
    Ok(root_mean_square(differences.into_iter()) / root_mean_square(references.into_iter()))
}

/// Prints peaks and time series of two meshes, and writes them to `meshes.csv`.
///
/// Root mean square differences are relative to the root mean squares on the finer mesh.
pub(crate) fn compare_meshes(
    folder: &Path,
    coarse: &[ContainmentOutcome],
    fine: &[ContainmentOutcome],
) -> Result<(), AnyError> {
    println!(
        "\n| 10 against 15 elements | peak shear, lb/ft | rms difference: A to a side | A up and down | \
         base shear |\n|---|---|---|---|---|"
    );
    let mut rows = Vec::new();
    for (coarse, fine) in coarse.iter().zip(fine) {
        let differences = [
            mesh_difference(coarse, fine, "roof x")?,
            mesh_difference(coarse, fine, "roof y")?,
            mesh_difference(coarse, fine, "base shear")?,
        ];
        let peaks = [coarse.peak_shear, fine.peak_shear];
        let name = coarse.case.name.clone();
        let percent = differences.map(|difference| format!("{:.1} %", 100.0 * difference));
        let pounds = peaks.map(|shear| format!("{:.0}", pounds_per_foot(shear)));
        println!("| {name} | {} | {} |", pounds.join(", "), percent.join(" | "));
        let mut row = vec![name];
        row.extend(peaks.map(|peak| peak.to_string()));
        row.extend(differences.map(|difference| difference.to_string()));
        rows.push(<[String; 6]>::try_from(row).map_err(|_| "a row of 6 cells")?);
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

/// Draws Figs. 4, 5 and 6 of the paper, uplift only and friction 0.4, and the slip of the base.
pub(crate) fn draw(folder: &Path, results: &[ContainmentOutcome]) -> Result<(), AnyError> {
    let shown_results: Vec<&ContainmentOutcome> = results
        .iter()
        .filter(|outcome| [TABLE_1_ROWS[1].1, TABLE_1_ROWS[2].1].contains(&outcome.case.friction))
        .collect();
    for (file, title, unit, probe, factor) in [
        ("figure_4", "Fig. 4: absolute horizontal displacement at A", "mm", "roof x", 1e3),
        ("figure_5", "Fig. 5: vertical displacement at A", "mm", "roof y", 1e3),
        ("figure_6", "Fig. 6: base shear", "kN/m", "base shear", 1e-3),
    ] {
        let mut lines = Vec::new();
        for outcome in &shown_results {
            let points = outcome.curve(probe, factor)?;
            lines.push(Curve { name: outcome.case.name.clone(), points });
        }
        curves(title, "time, s", unit, &lines)?.save(folder.join(format!("{file}.svg")))?;
    }
    let lines: Vec<_> = shown_results
        .iter()
        .map(|outcome| (outcome.case.name.as_str(), &outcome.time_series))
        .collect();
    let title = "Displacement of the base relative to the soil";
    basemat::plot::time_series(title, &lines, Quantity::MeanSlip)?
        .save(folder.join("base_slip.svg"))?;
    Ok(())
}

/// Horizontal line at a shear (N/m) up to the friction coefficient `end`.
fn level(name: &str, end: f64, shear: f64) -> Curve {
    Curve { name: name.into(), points: vec![(0.0, 1e-3 * shear), (end, 1e-3 * shear)] }
}

/// Draws the peak base shear over friction, with uplift only as a level, and the paper's rows as points.
pub(crate) fn draw_sweep(
    folder: &Path,
    frictions: &[f64],
    runs: &[ContainmentOutcome],
    uplift_only: f64,
) -> Result<(), AnyError> {
    let end = frictions.last().copied().unwrap_or(1.0);
    let peaks =
        frictions.iter().zip(runs).map(|(friction, run)| (*friction, 1e-3 * run.peak_shear));
    let paper =
        TABLE_1_ROWS[2..]
            .iter()
            .zip(&PAPER_SHEARS[2..])
            .filter_map(|((_, friction), shear)| {
                Some(((*friction)?, 1e-3 * shear * POUND_FORCE_PER_FOOT))
            });
    let lines = [
        Curve { name: "here".into(), points: peaks.collect() },
        level("here, uplift only", end, uplift_only),
        Curve { name: "Table 1".into(), points: paper.collect() },
        level("Table 1, uplift only", end, PAPER_SHEARS[1] * POUND_FORCE_PER_FOOT),
    ];
    curves("Peak base shear over friction", "friction coefficient", "shear, kN/m", &lines)?
        .save(folder.join("friction_sweep.svg"))?;
    Ok(())
}
