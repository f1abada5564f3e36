//! Evidence for and against readings: geometries.

use super::options::{Law, Reading, Scheme};
use super::run::root_mean_square;
use basemat_problems::containment::PAPER_SHEARS;

/// Sizes of a sweep, ft.
struct Sizes {
    widths: Vec<f64>,
    heights: Vec<f64>,
}

impl Sizes {
    /// 14 widths by 17 heights, or 3 by 3.
    fn new(short: bool) -> Self {
        let spread = |first: f64, last: f64, count: usize| {
            (0..count).map(|k| first + (last - first) * k as f64 / (count - 1) as f64).collect()
        };
        let [widths, heights] = if short { [3, 3] } else { [14, 17] };
        Self { widths: spread(15.0, 120.0, widths), heights: spread(20.0, 200.0, heights) }
    }

    fn pairs(&self) -> impl Iterator<Item = [f64; 2]> {
        self.widths.iter().flat_map(|w| self.heights.iter().map(|h| [*w, *h]))
    }
}

/// Hard contact and the midpoint rule: a table of peaks for the crate's own scheme.
fn own(reading: &Reading) -> Reading {
    Reading { law: Law::Hard, scheme: Scheme::Midpoint, ..reading.clone() }
}

/// Least ratio of the row at 0.4 over the uplift-only row, friction as printed, over geometries,
/// then over soil densities.
pub(crate) fn print_geometries(reading: &Reading, short: bool) {
    let ratio = |reading: &Reading| {
        let [uplift, sliding] = [1, 2].map(|row| reading.run(row).map(|r| r.shear[0]));
        Some(sliding.ok()? / uplift.ok()?)
    };
    let sizes = Sizes::new(short);
    let (mut least, mut tried, mut failed) = ([f64::INFINITY, 0.0, 0.0], 0, 0);
    for [width, height] in sizes.pairs() {
        tried += 1;
        match ratio(&Reading { width, height, ..own(reading) }) {
            Some(found) if found < least[0] => least = [found, width, height],
            Some(_) => {}
            None => failed += 1,
        }
    }
    println!(
        "\nfriction 0.4 over uplift only, {tried} geometries ({failed} do not stand or end early): \
         never below {:.2} (at {:.0} x {:.0} ft); Table 1 has {:.2}",
        least[0],
        least[1],
        least[2],
        PAPER_SHEARS[2] / PAPER_SHEARS[1]
    );
    let densities: &[f64] = if short { &[2.8, 4.2] } else { &[2.0, 2.8, 3.5, 4.2, 5.0] };
    let sizes = Sizes { widths: vec![20.0, 34.0, 60.0, 100.0], heights: vec![40.0, 80.0, 120.0] };
    let sizes = if short { Sizes { widths: vec![34.0], heights: vec![80.0] } } else { sizes };
    let mut least = [f64::INFINITY, 0.0, 0.0, 0.0];
    for &soil_density in densities {
        for [width, height] in sizes.pairs() {
            let reading = Reading { width, height, soil_density, ..own(reading) };
            if let Some(found) = ratio(&reading).filter(|found| *found < least[0]) {
                least = [found, soil_density, width, height];
            }
        }
    }
    println!(
        "the same over soil densities: never below {:.2} (at {} slug/ft³, {:.0} x {:.0} ft)",
        least[0], least[1], least[2], least[3]
    );
}

/// Root mean square of the log ratios of some rows to the paper's.
fn misfit(reading: &Reading, rows: &[usize]) -> f64 {
    let logarithms: Result<Vec<f64>, _> = rows
        .iter()
        .map(|&row| reading.run(row).map(|found| (found.shear[0] / PAPER_SHEARS[row]).ln()))
        .collect();
    logarithms.map_or(f64::INFINITY, |logarithms| root_mean_square(&logarithms))
}

/// Width and height of least `misfit` near `start`, by smaller and smaller steps; with `short`
/// one step.
fn refine(
    misfit: &impl Fn([f64; 2]) -> f64,
    start: ([f64; 2], f64),
    short: bool,
) -> ([f64; 2], f64) {
    let mut best = start;
    let mut step = 0.16;
    for _ in 0..if short { 1 } else { usize::MAX } {
        if step <= 0.008 {
            break;
        }
        let before = best.1;
        for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
            let mut trial = best.0;
            trial[axis] *= 1.0 + sign * step;
            let found = misfit(trial);
            if found < best.1 {
                best = (trial, found);
            }
        }
        if best.1 == before {
            step *= 0.5;
        }
    }
    best
}

/// Geometries that meet the bonded and the uplift-only row, by searches from several heights, and how
/// far the sliding rows are from Table 1 there.
pub(crate) fn print_calibration(reading: &Reading, short: bool) {
    let own = own(reading);
    let at = |[width, height]: [f64; 2], rows: &[usize]| {
        misfit(&Reading { width, height, ..own.clone() }, rows)
    };
    let first = |place: [f64; 2]| at(place, &[0, 1]);
    println!("\ngeometries that meet the bonded and the uplift-only row of Table 1 best:");
    let heights: &[f64] = if short { &[80.0] } else { &[50.0, 80.0, 110.0, 140.0, 170.0, 200.0] };
    for &height in heights {
        let start = [34.0, height];
        let (place, found) = refine(&first, (start, first(start)), short);
        println!(
            "from {height:.0} ft: {:.1} x {:.1} ft, rms of log ratios {found:.3}; sliding rows {:.2}",
            place[0],
            place[1],
            at(place, &[2, 3, 4])
        );
    }
}

/// Searches width and height that fit Table 1 best: a coarse grid, then smaller and smaller steps.
pub(crate) fn print_search(reading: &Reading, short: bool) {
    let own = own(reading);
    println!();
    let count = if short { 2 } else { 7 };
    let sizes = Sizes {
        widths: (0..count).map(|k| 15.0 * 1.4_f64.powi(k)).collect(),
        heights: (0..count).map(|k| 25.0 * 1.4_f64.powi(k)).collect(),
    };
    for length_left_out in [false, true] {
        for rows in [&[0, 1, 2, 3, 4][..], &[2, 3, 4]] {
            let at = |[width, height]: [f64; 2]| {
                misfit(&Reading { length_left_out, width, height, ..own.clone() }, rows)
            };
            let best = sizes
                .pairs()
                .map(|place| (place, at(place)))
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .unwrap_or(([f64::NAN; 2], f64::INFINITY));
            let best = refine(&at, best, short);
            println!(
                "best geometry for {} of Table 1, friction {}: {:.1} x {:.1} ft, rms of log ratios \
                 {:.3}",
                if rows.len() == 5 { "all rows" } else { "the sliding rows" },
                if length_left_out { "without the element's length" } else { "as printed" },
                best.0[0],
                best.0[1],
                best.1
            );
        }
    }
}
