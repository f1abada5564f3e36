//! The paper's conclusions, one by one, in figures.

use std::path::Path;

use super::AnyError;
use super::case::{Kind, Outcome};
use super::containment::{PAPER_SHEARS, pounds_per_foot};

/// Root mean square.
fn size(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for value in values {
        sum += value * value;
        count += 1.0;
    }
    (sum / count.max(1.0)).sqrt()
}

/// Change against `other`, percent.
fn change(value: f64, other: f64) -> f64 {
    100.0 * (value / other - 1.0)
}

/// Shear of a superstructure that moves as the foundation's top does: difference from the computed
/// one, root mean square over that of the computed one.
pub(crate) fn rigid_difference(outcome: &Outcome) -> f64 {
    let kept = &outcome.histories;
    let apart = kept.shear.iter().zip(&kept.rigid_shear).map(|(real, rigid)| real - rigid);
    size(apart) / size(kept.shear.iter().copied())
}

/// A table of the quantities that the paper concludes about, against uplift only; what sliding without
/// deformation would give; the checks of service.
pub(crate) fn print(results: &[Outcome], weights: [f64; 2]) {
    let Some(uplift) = results.get(1) else { return };
    println!(
        "\n| case | base shear | slip of the base, mm | A to a side, mm | A up, mm | shear if the \
         superstructure were rigid, rms difference | A against the base, mm |\n\
         |---|---|---|---|---|---|---|"
    );
    let mut last: Option<f64> = None;
    for outcome in results {
        let against = |value: f64, other: f64| format!("{:+.1} %", change(value, other));
        println!(
            "| {} | {:.1} kN/m ({}; {}) | {:.1} | {:.1} ({}) | {:.1} ({}) | {:.0} % | {:.1} ({}) |",
            outcome.case.name,
            1e-3 * outcome.peak_shear,
            against(outcome.peak_shear, uplift.peak_shear),
            last.map_or_else(
                || "–".to_owned(),
                |last| format!("{} on the row before", against(outcome.peak_shear, last))
            ),
            1e3 * outcome.run.whole.mean_slip.magnitude(),
            1e3 * outcome.peak_roof,
            against(outcome.peak_roof, uplift.peak_roof),
            1e3 * outcome.peak_lift,
            against(outcome.peak_lift, uplift.peak_lift),
            100.0 * rigid_difference(outcome),
            1e3 * outcome.peak_sway,
            against(outcome.peak_sway, uplift.peak_sway),
        );
        last = Some(outcome.peak_shear);
    }
    print_rigid_sliding(results, weights);
    println!("\nserviceability");
    for outcome in results {
        let checks: Vec<_> = outcome.run.serviceability.iter().map(ToString::to_string).collect();
        println!("{}: {}", outcome.case.name, checks.join("; "));
    }
}

/// Base shear over the friction coefficient, which in rigid sliding is the superstructure's weight,
/// kip/ft.
fn print_rigid_sliding(results: &[Outcome], weights: [f64; 2]) {
    let [all, superstructure] = weights.map(pounds_per_foot);
    println!(
        "\nweight {all:.0} lb/ft, of it superstructure {superstructure:.0}; base shear over friction, \
         which is the latter in rigid sliding, kip/ft:"
    );
    for outcome in results {
        let Kind::Coulomb(friction) = outcome.case.kind else { continue };
        let paper = [0.4, 0.3, 0.2].iter().zip(&PAPER_SHEARS[2..]).find(|row| *row.0 == friction);
        if let Some((_, shear)) = paper {
            let found = pounds_per_foot(outcome.peak_shear);
            let [found, paper] = [found, *shear].map(|shear| 1e-3 * shear / friction);
            println!("{}: {found:.1}, in Table 1 {paper:.1}", outcome.case.name);
        }
    }
}

/// Peaks and time series of two meshes, and `meshes.csv`: root mean square differences over the finer
/// mesh's root mean squares.
pub(crate) fn compare_meshes(
    folder: &Path,
    coarse: &[Outcome],
    fine: &[Outcome],
) -> Result<(), AnyError> {
    let mut writer = csv::Writer::from_path(folder.join("meshes.csv"))?;
    writer.write_record([
        "case",
        "peak_base_shear_n_per_m",
        "peak_base_shear_15_elements_n_per_m",
        "rms_roof_x",
        "rms_roof_y",
        "rms_base_shear",
    ])?;
    println!(
        "\n| 10 against 15 elements | peak shear, lb/ft | rms difference: A to a side | A up and down | \
         base shear |\n|---|---|---|---|---|"
    );
    for (coarse, fine) in coarse.iter().zip(fine) {
        let apart = |value: fn(&Outcome, usize) -> f64| {
            let times = &fine.histories.time;
            let at = |time: f64| {
                let next = times.partition_point(|t| *t < time).clamp(1, times.len() - 1);
                let part = (time - times[next - 1]) / (times[next] - times[next - 1]);
                (1.0 - part) * value(fine, next - 1) + part * value(fine, next)
            };
            let pairs = coarse.histories.time.iter().enumerate();
            let pairs: Vec<_> = pairs.map(|(k, &time)| (value(coarse, k), at(time))).collect();
            size(pairs.iter().map(|(a, b)| a - b)) / size(pairs.iter().map(|(_, b)| *b))
        };
        let differences = [
            apart(|o, k| o.histories.roof[k][0]),
            apart(|o, k| o.histories.roof[k][1]),
            apart(|o, k| o.histories.shear[k]),
        ];
        let peaks = [coarse.peak_shear, fine.peak_shear];
        let name = coarse.case.name.clone();
        let percent = differences.map(|difference| format!("{:.1} %", 100.0 * difference));
        let pounds = peaks.map(|shear| format!("{:.0}", pounds_per_foot(shear)));
        println!("| {name} | {} | {} |", pounds.join(", "), percent.join(" | "));
        let numbers = peaks.iter().chain(&differences).map(ToString::to_string);
        writer.write_record([name].into_iter().chain(numbers))?;
    }
    writer.flush()?;
    Ok(())
}
