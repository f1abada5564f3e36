//! Evidence for and against readings: geometries, meshes, motions at A.

use super::containment::PAPER_SHEARS;
use super::options::{Law, Reading, Scheme};
use super::run::root_mean_square;

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

/// Peaks of a reading over meshes, and the motion at A of its rows against uplift only.
pub(crate) fn print_meshes(reading: &Reading, short: bool) {
    println!(
        "\n| element's length left out of eq. 12: elements | bonded | uplift only | 0.4 | 0.3 | 0.2 | \
         roof to a side, uplift only and 0.4, mm | roof up, mm |\n|---|---|---|---|---|---|---|---|"
    );
    for elements in if short { &[10][..] } else { &[10, 15, 20] } {
        let reading = Reading { elements: *elements, length_left_out: true, ..own(reading) };
        print!("| {elements} |");
        let rows: Vec<_> = (0..5).map(|row| reading.run(row)).collect();
        for row in &rows {
            match row {
                Ok(row) => print!(" {:.0} |", row.shear[0]),
                Err(error) => print!(" {error} |"),
            }
        }
        if let [_, Ok(uplift), Ok(sliding), ..] = &rows[..] {
            for axis in [0, 1] {
                let [a, b] = [uplift, sliding].map(|row| 1e3 * row.roof[axis]);
                print!(" {a:.1}, {b:.1} |");
            }
        }
        println!();
    }
}

/// Root mean square of the log ratios of some rows to the paper's.
fn misfit(reading: &Reading, rows: &[usize]) -> f64 {
    let logarithms: Result<Vec<f64>, _> = rows
        .iter()
        .map(|&row| reading.run(row).map(|found| (found.shear[0] / PAPER_SHEARS[row]).ln()))
        .collect();
    logarithms.map_or(f64::INFINITY, |logarithms| root_mean_square(&logarithms))
}

/// Searches width and height that fit Table 1 best: a coarse grid, then smaller and smaller steps.
pub(crate) fn print_search(reading: &Reading, short: bool) {
    let own = own(reading);
    println!();
    for length_left_out in [false, true] {
        for rows in [&[0, 1, 2, 3, 4][..], &[2, 3, 4]] {
            let at = |[width, height]: [f64; 2]| {
                misfit(&Reading { length_left_out, width, height, ..own.clone() }, rows)
            };
            let count = if short { 2 } else { 7 };
            let sizes = Sizes {
                widths: (0..count).map(|k| 15.0 * 1.4_f64.powi(k)).collect(),
                heights: (0..count).map(|k| 25.0 * 1.4_f64.powi(k)).collect(),
            };
            let mut best = ([f64::NAN; 2], f64::INFINITY);
            let mut see = |place: [f64; 2]| {
                let found = at(place);
                let better = found < best.1;
                if better {
                    best = (place, found);
                }
                (better, best.0)
            };
            let mut place = [f64::NAN; 2];
            for pair in sizes.pairs() {
                place = see(pair).1;
            }
            let (mut step, least) = (0.16, if short { 0.1 } else { 0.008 });
            while step > least {
                let mut moved = false;
                for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
                    let mut trial = place;
                    trial[axis] *= 1.0 + sign * step;
                    let (better, now) = see(trial);
                    moved |= better;
                    place = now;
                }
                if !moved {
                    step *= 0.5;
                }
            }
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
