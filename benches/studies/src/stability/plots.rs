//! Heat maps with one panel per scheme, and one for the solves of the mode search.
//!
//! Panels of the sweep over time schemes show the algorithmic energy.

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axes::{SCHEME_MAP, StabilityMap};
use super::run::{MapCell, Verdict};
use super::scene::StabilityScheme;
use crate::AnyError;

/// Width and height of a cell, pixels.
const CELL_SIZE: [i32; 2] = [36, 22];
/// Room for labels to the left of a panel, above it and below it, pixels.
const LABEL_ROOM: [i32; 3] = [128, 66, 76];
const PANEL_GAP: i32 = 26;
const LEGEND_HEIGHT: i32 = 96;
const ACTIVE_COLOR: RGBColor = RGBColor(240, 158, 56);
const ERROR_COLOR: RGBColor = RGBColor(110, 110, 116);

type PlotArea<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Draws a map: verdicts of every scheme, then solves per step of the crate's scheme.
pub(crate) fn draw(path: &Path, map: &StabilityMap, cells: &[&MapCell]) -> Result<(), AnyError> {
    let columns = count(&map.x.labels);
    let rows = count(&map.y.labels);
    let has_cells = |scheme: &StabilityScheme| cells.iter().any(|cell| cell.scheme == *scheme);
    let schemes: Vec<StabilityScheme> = map.schemes.iter().copied().filter(has_cells).collect();
    let compares_schemes = map.name == SCHEME_MAP;
    let panels = schemes.len() + usize::from(!compares_schemes);
    // More than two panels in a row would be too small in a page's column.
    let panel = [
        LABEL_ROOM[0] + columns * CELL_SIZE[0] + PANEL_GAP,
        LABEL_ROOM[1] + rows * CELL_SIZE[1] + LABEL_ROOM[2],
    ];
    let panel_corner = |k: usize| {
        [count_of(k % 2) * panel[0] + LABEL_ROOM[0], count_of(k / 2) * panel[1] + LABEL_ROOM[1]]
    };
    let width = (count_of(panels.min(2)) * panel[0]).max(920);
    let height = count_of(panels.div_ceil(2)) * panel[1] + LEGEND_HEIGHT;
    let size = (u32::try_from(width)?, u32::try_from(height)?);
    let root = SVGBackend::new(path, size).into_drawing_area();
    root.fill(&WHITE)?;
    text(&root, map.title, [14, 22], 20, HPos::Left)?;
    for (k, &scheme) in schemes.iter().enumerate() {
        let corner = panel_corner(k);
        let caption = match scheme {
            StabilityScheme::Basemat if compares_schemes => "midpoint rule",
            StabilityScheme::Basemat => "basemat: log₁₀ of energy error",
            StabilityScheme::Dissipative => "dissipative midpoint rule, γ = 0.8",
            StabilityScheme::Newmark => "Newmark, average acceleration",
            StabilityScheme::Hht => "HHT-α, α = −0.1",
            StabilityScheme::Paper => "paper, as printed",
            StabilityScheme::Quadrature => "convolution quadrature",
        };
        frame(&root, map, corner, caption)?;
        for cell in cells.iter().filter(|cell| cell.scheme == scheme) {
            let label = if compares_schemes { energy_label(cell) } else { verdict_label(cell) };
            square(&root, corner, rows, cell.place, &label)?;
        }
    }
    if !compares_schemes {
        trials(&root, map, panel_corner(schemes.len()), cells)?;
    }
    legend(&root, height - LEGEND_HEIGHT + 14, compares_schemes)?;
    root.present()?;
    drop(root);
    // Attributes with default values take a fifth of the file.
    let mut text = std::fs::read_to_string(path)?;
    for attribute in [" opacity=\"1\"", " stroke=\"none\"", " fill=\"#000000\""] {
        text = text.replace(attribute, "");
    }
    Ok(std::fs::write(path, text)?)
}

/// The panel of solves per step.
fn trials(
    root: &PlotArea,
    map: &StabilityMap,
    corner: [i32; 2],
    cells: &[&MapCell],
) -> Result<(), AnyError> {
    let rows = count(&map.y.labels);
    frame(root, map, corner, "basemat: solves per step")?;
    for cell in cells.iter().filter(|cell| cell.scheme == StabilityScheme::Basemat) {
        let outcome = &cell.outcome;
        let mark = match outcome.fallbacks {
            [0, 0] => "",
            [_, 0] => "*",
            _ => "**",
        };
        let result = outcome.verdict == Verdict::Refused;
        let shade = ((outcome.trials[0] - 1.0) / 4.0).clamp(0.0, 1.0);
        let color = blend(RGBColor(236, 240, 246), RGBColor(106, 81, 163), shade);
        let text =
            if result { "–".to_owned() } else { format!("{:.1}{mark}", outcome.trials[0]) };
        square(root, corner, rows, cell.place, &CellLabel { color, text })?;
    }
    Ok(())
}

fn count(labels: &[String]) -> i32 {
    count_of(labels.len())
}

fn count_of(n: usize) -> i32 {
    i32::try_from(n).unwrap_or(i32::MAX)
}

fn text(root: &PlotArea, word: &str, at: [i32; 2], size: i32, side: HPos) -> Result<(), AnyError> {
    let style = TextStyle::from(("sans-serif", size).into_font()).pos(Pos::new(side, VPos::Center));
    Ok(root.draw(&Text::new(word.to_owned(), (at[0], at[1]), style))?)
}

/// Caption and axes of a panel whose upper left cell is at `corner`.
fn frame(
    root: &PlotArea,
    map: &StabilityMap,
    corner: [i32; 2],
    caption: &str,
) -> Result<(), AnyError> {
    let left = corner[0];
    let top = corner[1];
    let columns = count(&map.x.labels);
    let rows = count(&map.y.labels);
    text(root, caption, [left, top - 14], 14, HPos::Left)?;
    let bottom = top + rows * CELL_SIZE[1];
    for (row, word) in map.y.labels.iter().enumerate() {
        let y = bottom - count_of(row) * CELL_SIZE[1] - CELL_SIZE[1] / 2;
        text(root, word, [left - 6, y], 12, HPos::Right)?;
    }
    let style = TextStyle::from(("sans-serif", 14).into_font().transform(FontTransform::Rotate270))
        .pos(Pos::new(HPos::Center, VPos::Center));
    root.draw(&Text::new(
        map.y.name,
        (left - LABEL_ROOM[0] + 14, top + rows * CELL_SIZE[1] / 2),
        style,
    ))?;
    for (column, word) in map.x.labels.iter().enumerate() {
        let x = left + count_of(column) * CELL_SIZE[0] + CELL_SIZE[0] / 2;
        let font = ("sans-serif", 11).into_font().transform(FontTransform::Rotate90);
        let style = TextStyle::from(font).pos(Pos::new(HPos::Left, VPos::Center));
        root.draw(&Text::new(word.clone(), (x, bottom + 6), style))?;
    }
    text(root, map.x.name, [left + columns * CELL_SIZE[0] / 2, bottom + 64], 14, HPos::Center)
}

fn square(
    root: &PlotArea,
    corner: [i32; 2],
    rows: i32,
    place: [usize; 2],
    label: &CellLabel,
) -> Result<(), AnyError> {
    let x = corner[0] + count_of(place[0]) * CELL_SIZE[0];
    let y = corner[1] + (rows - 1 - count_of(place[1])) * CELL_SIZE[1];
    let corners = [(x, y), (x + CELL_SIZE[0] - 1, y + CELL_SIZE[1] - 1)];
    root.draw(&Rectangle::new(corners, label.color.filled()))?;
    let RGBColor(r, g, b) = label.color;
    let brightness = u32::from(r) * 3 + u32::from(g) * 6 + u32::from(b);
    let ink = if brightness > 1300 { BLACK } else { WHITE };
    let style = TextStyle::from(("sans-serif", 10).into_font())
        .color(&ink)
        .pos(Pos::new(HPos::Center, VPos::Center));
    let middle = (x + CELL_SIZE[0] / 2, y + CELL_SIZE[1] / 2);
    Ok(root.draw(&Text::new(label.text.clone(), middle, style))?)
}

/// Colour and text of a cell.
struct CellLabel {
    color: RGBColor,
    text: String,
}

fn verdict_label(cell: &MapCell) -> CellLabel {
    let outcome = &cell.outcome;
    let (color, text) = match outcome.verdict {
        Verdict::Bounded => {
            let exponent = outcome.energy_balance[0].max(1e-17).log10();
            (balance_color(exponent), format!("{exponent:.0}"))
        }
        Verdict::Active => {
            // From 1e-9 up; adding 0 to −0 gives 0.
            let exponent = outcome.smallest_soil_work.abs().max(1e-17).log10().round() + 0.0;
            (ACTIVE_COLOR, format!("{exponent}"))
        }
        Verdict::Grows => {
            (growth_color(outcome.growth_per_step), format!("{:.0e}", outcome.growth_per_step))
        }
        Verdict::Refused | Verdict::Failed => (ERROR_COLOR, outcome.letter().to_owned()),
    };
    CellLabel { color, text: if outcome.is_unstable() { format!("U {text}") } else { text } }
}

/// Label of the energy that the time scheme has created.
fn energy_label(cell: &MapCell) -> CellLabel {
    let outcome = &cell.outcome;
    let energy = outcome.created_energy;
    if matches!(outcome.verdict, Verdict::Refused | Verdict::Failed) {
        return CellLabel { color: ERROR_COLOR, text: outcome.letter().to_owned() };
    }
    let color = if energy > CREATED_ENERGY_LIMIT {
        growth_color(0.1 * energy)
    } else {
        balance_color(-17.0 + 400.0 * energy)
    };
    CellLabel { color, text: percent(energy) }
}

/// Energy that a scheme may create before a run warns, over the largest energy.
const CREATED_ENERGY_LIMIT: f64 = 0.02;

fn percent(fraction: f64) -> String {
    format!("{:.*}", usize::from(fraction > 5e-4 && fraction < 0.0995), 100.0 * fraction)
}

/// From blue (10⁻¹⁷) to pale green (10⁻⁹).
fn balance_color(exponent: f64) -> RGBColor {
    blend(RGBColor(49, 84, 160), RGBColor(196, 226, 168), (exponent + 17.0) / 8.0)
}

/// From pale red (0.1 % per step) to dark red (all in a step).
fn growth_color(growth: f64) -> RGBColor {
    blend(RGBColor(232, 120, 110), RGBColor(120, 0, 20), (growth.max(1e-3).log10() + 3.0) / 3.0)
}

fn blend(from: RGBColor, to: RGBColor, fraction: f64) -> RGBColor {
    RGBColor(
        blend_channel(from.0, to.0, fraction),
        blend_channel(from.1, to.1, fraction),
        blend_channel(from.2, to.2, fraction),
    )
}

fn blend_channel(from: u8, to: u8, fraction: f64) -> u8 {
    let value = f64::from(from) + fraction.clamp(0.0, 1.0) * (f64::from(to) - f64::from(from));
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 255")]
    let value = value.round() as u8;
    value
}

fn legend(root: &PlotArea, top: i32, compares_schemes: bool) -> Result<(), AnyError> {
    let mut x = 14;
    let mut entry = |color: RGBColor, name: &str, width: i32| -> Result<(), AnyError> {
        root.draw(&Rectangle::new([(x, top), (x + 22, top + 14)], color.filled()))?;
        text(root, name, [x + 28, top + 7], 12, HPos::Left)?;
        x += width;
        Ok(())
    };
    if compares_schemes {
        entry(balance_color(-16.0), "made by the time scheme, % of the run's largest energy", 350)?;
        entry(growth_color(0.05), "more than 2 %: the run warns", 220)?;
        return entry(ERROR_COLOR, "error", 80);
    }
    entry(balance_color(-16.0), "bounded: log₁₀ of the energy error", 268)?;
    entry(ACTIVE_COLOR, "not growing, but the soil gives energy: log₁₀ of its share", 370)?;
    entry(growth_color(0.03), "grows: growth per step", 180)?;
    entry(ERROR_COLOR, "error", 80)?;
    let notes = [
        "U: growth is foretold, and the crate refuses unless told otherwise",
        "errors: C contact modes not found, N not finite, P no static state, M matrix singular, \
         I ill-conditioned, S another step error, E other",
        "solves per step: * some steps by Gauss–Seidel, ** some by path following",
    ];
    for (k, note) in notes.into_iter().enumerate() {
        text(root, note, [14, top + 30 + 18 * count_of(k)], 12, HPos::Left)?;
    }
    Ok(())
}
