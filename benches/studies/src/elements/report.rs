//! Table of the benchmarks for the documents.

use std::fmt::Write as _;

use super::row::{BenchmarkRow, BenchmarkRows};
use crate::AnyError;

/// Benchmark, quantities and meshes of the table, by the names in the tables of `tests/data/elements`.
type TableLine = (&'static str, &'static [&'static str], &'static [&'static str]);

const SHEAR_QUANTITIES: &[&str] = &["in-plane shear", "out-of-plane shear"];
const TIP_QUANTITIES: &[&str] = &["along the width of the tip (in-plane)", "across (out-of-plane)"];
const WAVE_QUANTITIES: &[&str] = &["n=1 (pair)", "n=2 (pair)", "n=3 (pair)"];
const SETTLEMENT_QUANTITIES: &[&str] =
    &["settlement middle, mm", "settlement middle of a side, mm", "settlement corner, mm"];

const TABLE_LINES: &[TableLine] = &[
    ("MacNeal-Harder straight cantilever", &["twist"], &["6"]),
    (
        "MacNeal-Harder straight cantilever, rectangles",
        SHEAR_QUANTITIES,
        &["Shell4 6x1", "6x1x1"],
    ),
    ("MacNeal-Harder straight cantilever, rectangles", &["twist"], &["Shell4 6x1", "6x1x1"]),
    ("MacNeal-Harder straight cantilever, parallelograms", SHEAR_QUANTITIES, &["Shell4 6x1"]),
    (
        "MacNeal-Harder straight cantilever, trapezoids",
        SHEAR_QUANTITIES,
        &["Shell4 6x1", "6x1x1"],
    ),
    ("MacNeal-Harder curved cantilever", &["in-plane", "out-of-plane"], &["48", "Shell4 24x4"]),
    ("MacNeal-Harder twisted beam t=0.32", TIP_QUANTITIES, &["96", "Shell4 12x2", "12x2x1"]),
    ("MacNeal-Harder twisted beam t=0.0032", TIP_QUANTITIES, &["96"]),
    ("MacNeal-Harder thick cylinder, nu = 0.4999 (Lame)", &["ur inside"], &["5x1x1"]),
    (
        "Scordelis-Lo roof",
        &["uz at the middle of the free edge"],
        &["Shell4 8x8", "Shell4 16x16"],
    ),
    (
        "pinched cylinder with diaphragms",
        &["uz under the load"],
        &["Shell4 16x16", "Shell4 32x32"],
    ),
    (
        "hemisphere with 18 degree hole",
        &["ux under the load"],
        &["Shell4 8x8", "Shell4 16x16", "Shell4 32x32", "Shell3 8x8", "Shell3 32x32"],
    ),
    (
        "NAFEMS LE3 hemisphere, point loads",
        &["ux at A, m"],
        &["Shell4 3 patches 8x8", "Shell4 3 patches 16x16"],
    ),
    (
        "NAFEMS LE5 Z-section in torsion",
        &["sxx at the flange tip, x = 2.5, MPa"],
        &["Shell4 8x(1+2+1)", "Shell4 32x(4+8+4)"],
    ),
    (
        "NAFEMS LE10 thick elliptic plate",
        &["syy at D from the Gauss points, MPa"],
        &["6x4x2", "24x16x8"],
    ),
    (
        "NAFEMS FV5 deep simply supported beam",
        &["mode 1, Hz", "mode 3, Hz", "mode 4, Hz", "mode 5, Hz"],
        &["10"],
    ),
    ("FV5, closed form", &["mode 1, Hz", "mode 3, Hz", "mode 5, Hz"], &["40"]),
    (
        "NAFEMS FV12 free thin square plate",
        &["mode 4, Hz", "mode 5, Hz", "mode 7, Hz", "mode 9, Hz"],
        &["Shell4 16x16"],
    ),
    (
        "NAFEMS FV16 cantilevered thin square plate",
        &["mode 1, Hz", "mode 2, Hz", "mode 6, Hz"],
        &["Shell4 16x16"],
    ),
    (
        "simply supported Mindlin plate t=1.0, closed form",
        &["mode 1, Hz", "mode 2, Hz", "mode 4, Hz"],
        &["Shell4 16x16", "Shell4 32x32"],
    ),
    ("NAFEMS FV52 solid simply supported plate", &["mode 4, Hz"], &["8x8x2", "24x24x6"]),
    (
        "hard simply supported thick plate, Rayleigh-Lamb",
        &["flexural mode 1, Hz", "flexural mode 2, Hz", "flexural mode 4, Hz"],
        &["16x16x4", "16x16x4 lumped"],
    ),
    (
        "Timoshenko cantilever 3 x 4 x 20 m, consistent mass",
        &["mode 1 along e2, Hz", "mode 2 along e2, Hz"],
        &["8"],
    ),
    ("buckling Euler, cantilever", &["N"], &["4"]),
    ("buckling with shear (Engesser), pinned", &["N"], &["4"]),
    ("buckling with shear (Engesser), fixed-fixed", &["N"], &["4"]),
    ("buckling of a cantilever by its weight", &["q L, N"], &["4"]),
    ("buckling of a cantilever with a rigid upper part (offset)", &["N"], &["4"]),
    ("Winkler 20 MN/m3", SETTLEMENT_QUANTITIES, &["Shell4 16x16", "Shell4 32x32"]),
    (
        "Winkler 20 MN/m3",
        &["moment mx = my under the load, kNm/m"],
        &["Shell4 16x16", "Shell4 32x32"],
    ),
    (
        "half-space E=80 MPa nu=0.3",
        SETTLEMENT_QUANTITIES,
        &["Shell4 16x16, 16x16 cells", "Shell4 32x32, 32x32 cells"],
    ),
    ("containment R=20 H=45 t=1.2/0.9", WAVE_QUANTITIES, &["48x(24+15) consistent"]),
];

/// A number with five digits.
fn digits(value: f64) -> String {
    let magnitude = value.abs();
    if (1e-3..1e5).contains(&magnitude) {
        let before = magnitude.log10().floor() + 1.0;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 8")]
        let decimals = (5.0 - before).max(0.0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.4e}")
    }
}

/// The table, in Markdown.
pub(super) fn benchmarks(rows: &BenchmarkRows) -> Result<String, AnyError> {
    let mut text =
        "| benchmark | quantity | mesh | computed | target | ratio | gate |\n|---|---|---|---|---|---|---|\n".to_owned();
    for (benchmark, quantities, meshes) in TABLE_LINES {
        for mesh in *meshes {
            for quantity in *quantities {
                let row = rows.get(benchmark, quantity, mesh);
                let row = row.ok_or_else(|| format!("no row {benchmark}, {quantity}, {mesh}"))?;
                let computed = row.computed.ok_or("a row of the table was not computed")?;
                let target = row.target.map_or("–".to_owned(), |(target, _)| digits(target));
                let ratio = row.ratio().map_or("–".to_owned(), |ratio| format!("{ratio:.3}"));
                let gate = row.target.and_then(|(_, gate)| gate);
                let gate = gate
                    .map_or("–".to_owned(), |gate| format!("{} %", (1e4 * gate).round() / 100.0));
                let computed = digits(computed);
                writeln!(
                    text,
                    "| {benchmark} | {quantity} | {mesh} | {computed} | {target} | {ratio} | {gate} |"
                )?;
            }
        }
    }
    Ok(text)
}

/// Values that no table has, and the largest difference from each table.
pub(super) fn summary(rows: &BenchmarkRows) -> Result<String, AnyError> {
    let mut text = "| beside the tables | computed |\n|---|---|\n".to_owned();
    for (name, value) in &rows.others {
        writeln!(text, "| {} | {} |", name.replace(" | ", ", "), digits(*value))?;
    }
    let tables = ["gates", "containment", "raft", "invariance"];
    for table in tables {
        let table_rows: Vec<&BenchmarkRow> =
            rows.all.iter().filter(|row| row.table == table).collect();
        let computed = table_rows.iter().filter(|row| row.computed.is_some()).count();
        let differences = table_rows.iter().filter_map(|row| row.difference());
        let largest_difference = differences.fold(0.0, f64::max);
        let row_count = table_rows.len();
        writeln!(
            text,
            "| `{table}.csv`: {computed} of {row_count} values; largest difference | {largest_difference:.1e} |"
        )?;
    }
    let ratios = rows.bounds.iter().map(|(_, value, bound)| value / bound);
    let largest_ratio = ratios.fold(0.0, f64::max);
    let count = rows.bounds.len();
    writeln!(
        text,
        "| {count} patches, rigid motions, renumbered elements; largest part of a bound | {largest_ratio:.1e} |"
    )?;
    Ok(text)
}
