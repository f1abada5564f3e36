//! Evidence for and against readings: geometries.

use super::options::{InterfaceReading, PaperReading, SchemeReading};
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
        Self {
            widths: evenly_spaced(15.0, 120.0, if short { 3 } else { 14 }),
            heights: evenly_spaced(20.0, 200.0, if short { 3 } else { 17 }),
        }
    }

    fn pairs(&self) -> impl Iterator<Item = [f64; 2]> {
        self.widths
            .iter()
            .flat_map(|width| self.heights.iter().map(|height| [*width, *height]))
    }
}

fn evenly_spaced(first: f64, last: f64, count: usize) -> Vec<f64> {
    (0..count).map(|k| first + (last - first) * k as f64 / (count - 1) as f64).collect()
}

/// The reading with hard contact and the midpoint rule, the crate's scheme.
fn with_crate_scheme(reading: &PaperReading) -> PaperReading {
    PaperReading { law: InterfaceReading::Hard, scheme: SchemeReading::Midpoint, ..reading.clone() }
}

/// Peak shear with friction 0.4 relative to the peak with uplift only.
fn sliding_ratio(reading: &PaperReading) -> Option<f64> {
    let uplift = reading.run(1).ok()?.shear[0];
    let sliding = reading.run(2).ok()?.shear[0];
    Some(sliding / uplift)
}

/// Prints the smallest sliding ratio over geometries, then over soil densities.
pub(crate) fn print_geometries(reading: &PaperReading, short: bool) {
    let sizes = Sizes::new(short);
    let mut best_geometry = [f64::INFINITY, 0.0, 0.0];
    let mut tried_count = 0;
    let mut failed_count = 0;
    for [width, height] in sizes.pairs() {
        tried_count += 1;
        match sliding_ratio(&PaperReading { width, height, ..with_crate_scheme(reading) }) {
            Some(ratio) if ratio < best_geometry[0] => best_geometry = [ratio, width, height],
            Some(_) => {}
            None => failed_count += 1,
        }
    }
    println!(
        "\nfriction 0.4 over uplift only, {tried_count} geometries ({failed_count} do not stand or end early): \
         never below {:.2} (at {:.0} x {:.0} ft); Table 1 has {:.2}",
        best_geometry[0],
        best_geometry[1],
        best_geometry[2],
        PAPER_SHEARS[2] / PAPER_SHEARS[1]
    );
    let densities: &[f64] = if short { &[2.8, 4.2] } else { &[2.0, 2.8, 3.5, 4.2, 5.0] };
    let sizes = Sizes { widths: vec![20.0, 34.0, 60.0, 100.0], heights: vec![40.0, 80.0, 120.0] };
    let sizes = if short { Sizes { widths: vec![34.0], heights: vec![80.0] } } else { sizes };
    let mut best_geometry = [f64::INFINITY, 0.0, 0.0, 0.0];
    for &soil_density in densities {
        for [width, height] in sizes.pairs() {
            let reading =
                PaperReading { width, height, soil_density, ..with_crate_scheme(reading) };
            if let Some(ratio) = sliding_ratio(&reading).filter(|ratio| *ratio < best_geometry[0]) {
                best_geometry = [ratio, soil_density, width, height];
            }
        }
    }
    println!(
        "the same over soil densities: never below {:.2} (at {} slug/ft³, {:.0} x {:.0} ft)",
        best_geometry[0], best_geometry[1], best_geometry[2], best_geometry[3]
    );
}

/// Root mean square of the logarithms of some rows relative to those of the paper.
fn misfit(reading: &PaperReading, rows: &[usize]) -> f64 {
    let logarithms: Result<Vec<f64>, _> = rows
        .iter()
        .map(|&row| reading.run(row).map(|results| (results.shear[0] / PAPER_SHEARS[row]).ln()))
        .collect();
    logarithms.map_or(f64::INFINITY, |logarithms| root_mean_square(&logarithms))
}

/// Width and height (ft), and the misfit there.
#[derive(Clone, Copy)]
struct Geometry {
    sizes: [f64; 2],
    misfit: f64,
}

/// Geometry of the smallest `misfit` near `start`, by decreasing steps; with `short` one step.
fn refine(misfit: &impl Fn([f64; 2]) -> f64, start: Geometry, short: bool) -> Geometry {
    let mut best_point = start;
    let mut step = 0.16;
    for _ in 0..if short { 1 } else { usize::MAX } {
        if step <= 0.008 {
            break;
        }
        let before = best_point.misfit;
        for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
            let mut sizes = best_point.sizes;
            sizes[axis] *= 1.0 + sign * step;
            let trial = Geometry { sizes, misfit: misfit(sizes) };
            if trial.misfit < best_point.misfit {
                best_point = trial;
            }
        }
        if best_point.misfit == before {
            step *= 0.5;
        }
    }
    best_point
}

/// Prints geometries that fit the bonded and the uplift-only row, and the misfit of the sliding rows there.
///
/// They are found by searches from several heights.
pub(crate) fn print_calibration(reading: &PaperReading, short: bool) {
    let reading = with_crate_scheme(reading);
    let misfit_of = |[width, height]: [f64; 2], rows: &[usize]| {
        misfit(&PaperReading { width, height, ..reading.clone() }, rows)
    };
    let first_rows = |sizes: [f64; 2]| misfit_of(sizes, &[0, 1]);
    println!("\ngeometries that meet the bonded and the uplift-only row of Table 1 best:");
    let heights: &[f64] = if short { &[80.0] } else { &[50.0, 80.0, 110.0, 140.0, 170.0, 200.0] };
    for &height in heights {
        let sizes = [34.0, height];
        let start = Geometry { sizes, misfit: first_rows(sizes) };
        let Geometry { sizes, misfit } = refine(&first_rows, start, short);
        println!(
            "from {height:.0} ft: {:.1} x {:.1} ft, rms of log ratios {misfit:.3}; sliding rows {:.2}",
            sizes[0],
            sizes[1],
            misfit_of(sizes, &[2, 3, 4])
        );
    }
}

/// Prints width and height that fit Table 1 best, by a coarse grid, then decreasing steps.
pub(crate) fn print_search(reading: &PaperReading, short: bool) {
    let reading = with_crate_scheme(reading);
    println!();
    let count = if short { 2 } else { 7 };
    let sizes = Sizes {
        widths: (0..count).map(|k| 15.0 * 1.4_f64.powi(k)).collect(),
        heights: (0..count).map(|k| 25.0 * 1.4_f64.powi(k)).collect(),
    };
    for length_left_out in [false, true] {
        for rows in [&[0, 1, 2, 3, 4][..], &[2, 3, 4]] {
            let misfit_of = |[width, height]: [f64; 2]| {
                misfit(&PaperReading { length_left_out, width, height, ..reading.clone() }, rows)
            };
            let coarse = sizes
                .pairs()
                .map(|sizes| Geometry { sizes, misfit: misfit_of(sizes) })
                .min_by(|a, b| a.misfit.total_cmp(&b.misfit))
                .unwrap_or(Geometry { sizes: [f64::NAN; 2], misfit: f64::INFINITY });
            let best_point = refine(&misfit_of, coarse, short);
            println!(
                "best geometry for {} of Table 1, friction {}: {:.1} x {:.1} ft, rms of log ratios \
                 {:.3}",
                if rows.len() == 5 { "all rows" } else { "the sliding rows" },
                if length_left_out { "without the element's length" } else { "as printed" },
                best_point.sizes[0],
                best_point.sizes[1],
                best_point.misfit
            );
        }
    }
}
