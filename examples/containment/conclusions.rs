//! The paper's conclusions, one by one, in figures.

use super::case::Outcome;

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

/// A table of the quantities that the paper concludes about, against uplift only.
pub(crate) fn print(results: &[Outcome]) {
    let Some(uplift) = results.get(1) else { return };
    println!(
        "\n| case | base shear | slip of the base, mm | A to a side, mm | A up, mm | rigid share of \
         the shear, rms | sway of A, mm |\n|---|---|---|---|---|---|---|"
    );
    let mut last: Option<f64> = None;
    for outcome in results {
        let kept = &outcome.histories;
        // Shear of a superstructure that moves as the foundation's top does, against the real one.
        let apart = kept.shear.iter().zip(&kept.rigid_shear).map(|(real, rigid)| real - rigid);
        let rigid = 1.0 - size(apart) / size(kept.shear.iter().copied());
        let against = |value: f64, other: f64| format!("{:+.1} %", change(value, other));
        println!(
            "| {} | {:.1} kN/m ({}; {}) | {:.1} | {:.1} ({}) | {:.1} ({}) | {rigid:.2} | {:.1} ({}) |",
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
            1e3 * outcome.peak_sway,
            against(outcome.peak_sway, uplift.peak_sway),
        );
        last = Some(outcome.peak_shear);
    }
    println!("\nserviceability");
    for outcome in results {
        let checks: Vec<_> = outcome.run.serviceability.iter().map(ToString::to_string).collect();
        println!("{}: {}", outcome.case.name, checks.join("; "));
    }
}

/// Root mean square difference of the time series of two meshes over that of the finer one.
pub(crate) fn print_meshes(coarse: &[Outcome], fine: &[Outcome]) {
    println!(
        "\n| time series of 10 against 15 elements, rms | A to a side | A up and down | base shear |\n\
         |---|---|---|---|"
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
            100.0 * size(pairs.iter().map(|(a, b)| a - b)) / size(pairs.iter().map(|(_, b)| *b))
        };
        println!(
            "| {} | {:.1} % | {:.1} % | {:.1} % |",
            coarse.case.name,
            apart(|o, k| o.histories.roof[k][0]),
            apart(|o, k| o.histories.roof[k][1]),
            apart(|o, k| o.histories.shear[k]),
        );
    }
}
