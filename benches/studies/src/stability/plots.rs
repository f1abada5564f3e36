//! Heat maps: one panel per scheme, and one for the work of the mode search; of the sweep over time
//! schemes, the energy that each makes.

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axes::{Map, SCHEME_MAP};
use super::run::{Cell, Verdict};
use super::scene::Scheme;
use crate::AnyError;

const CELL: [i32; 2] = [36, 22];
/// Room for labels to the left of a panel, above it and below it.
const ROOM: [i32; 3] = [128, 66, 76];
const GAP: i32 = 26;
const LEGEND: i32 = 96;
const ACTIVE: RGBColor = RGBColor(240, 158, 56);
const ERROR: RGBColor = RGBColor(110, 110, 116);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Draws a map: verdicts of every scheme, then solves per step of the crate's own.
pub(crate) fn draw(path: &Path, map: &Map, cells: &[&Cell]) -> Result<(), AnyError> {
    let (columns, rows) = (count(&map.x.labels), count(&map.y.labels));
    let there = |scheme: Scheme| cells.iter().any(|cell| cell.scheme == scheme);
    let schemes: Vec<Scheme> = map.schemes.iter().copied().filter(|s| there(*s)).collect();
    let compared = map.name == SCHEME_MAP;
    let panels = schemes.len() + usize::from(!compared);
    // Two panels to a row: more could not be read in a page's column.
    let panel = [ROOM[0] + columns * CELL[0] + GAP, ROOM[1] + rows * CELL[1] + ROOM[2]];
    let place =
        |k: usize| [count_of(k % 2) * panel[0] + ROOM[0], count_of(k / 2) * panel[1] + ROOM[1]];
    let width = (count_of(panels.min(2)) * panel[0]).max(920);
    let height = count_of(panels.div_ceil(2)) * panel[1] + LEGEND;
    let size = (u32::try_from(width)?, u32::try_from(height)?);
    let root = SVGBackend::new(path, size).into_drawing_area();
    root.fill(&WHITE)?;
    text(&root, map.title, [14, 22], 20, HPos::Left)?;
    for (k, &scheme) in schemes.iter().enumerate() {
        let corner = place(k);
        let caption = match scheme {
            Scheme::Own if compared => "midpoint rule",
            Scheme::Own => "basemat: log₁₀ of energy error",
            Scheme::Dissipative => "dissipative midpoint rule, γ = 0.8",
            Scheme::Newmark => "Newmark, average acceleration",
            Scheme::Hht => "HHT-α, α = −0.1",
            Scheme::Paper => "paper, as printed",
            Scheme::Quadrature => "convolution quadrature",
        };
        frame(&root, map, corner, caption)?;
        for cell in cells.iter().filter(|cell| cell.scheme == scheme) {
            let (color, word) = if compared { made(cell) } else { verdict(cell) };
            square(&root, corner, rows, cell.place, color, &word)?;
        }
    }
    if !compared {
        trials(&root, map, place(schemes.len()), cells)?;
    }
    legend(&root, height - LEGEND + 14, compared)?;
    root.present()?;
    drop(root);
    // Attributes with default values take a fifth of the file.
    let mut text = std::fs::read_to_string(path)?;
    for word in [" opacity=\"1\"", " stroke=\"none\"", " fill=\"#000000\""] {
        text = text.replace(word, "");
    }
    Ok(std::fs::write(path, text)?)
}

/// The panel of solves per step.
fn trials(root: &Area, map: &Map, corner: [i32; 2], cells: &[&Cell]) -> Result<(), AnyError> {
    let rows = count(&map.y.labels);
    frame(root, map, corner, "basemat: solves per step")?;
    for cell in cells.iter().filter(|cell| cell.scheme == Scheme::Own) {
        let out = &cell.outcome;
        let mark = match out.fallbacks {
            [0, 0] => "",
            [_, 0] => "*",
            _ => "**",
        };
        let refused = out.verdict == Verdict::Refused;
        let shade = ((out.trials[0] - 1.0) / 4.0).clamp(0.0, 1.0);
        let color = blend(RGBColor(236, 240, 246), RGBColor(106, 81, 163), shade);
        let word = if refused { "–".to_owned() } else { format!("{:.1}{mark}", out.trials[0]) };
        square(root, corner, rows, cell.place, color, &word)?;
    }
    Ok(())
}

fn count(labels: &[String]) -> i32 {
    count_of(labels.len())
}

fn count_of(n: usize) -> i32 {
    i32::try_from(n).unwrap_or(i32::MAX)
}

fn text(root: &Area, word: &str, at: [i32; 2], size: i32, side: HPos) -> Result<(), AnyError> {
    let style = TextStyle::from(("sans-serif", size).into_font()).pos(Pos::new(side, VPos::Center));
    Ok(root.draw(&Text::new(word.to_owned(), (at[0], at[1]), style))?)
}

/// Caption and axes of a panel whose upper left cell is at `corner`.
fn frame(root: &Area, map: &Map, corner: [i32; 2], caption: &str) -> Result<(), AnyError> {
    let [left, top] = corner;
    let (columns, rows) = (count(&map.x.labels), count(&map.y.labels));
    text(root, caption, [left, top - 14], 14, HPos::Left)?;
    let bottom = top + rows * CELL[1];
    for (row, word) in map.y.labels.iter().enumerate() {
        let y = bottom - count_of(row) * CELL[1] - CELL[1] / 2;
        text(root, word, [left - 6, y], 12, HPos::Right)?;
    }
    let style = TextStyle::from(("sans-serif", 14).into_font().transform(FontTransform::Rotate270))
        .pos(Pos::new(HPos::Center, VPos::Center));
    root.draw(&Text::new(map.y.name, (left - ROOM[0] + 14, top + rows * CELL[1] / 2), style))?;
    for (column, word) in map.x.labels.iter().enumerate() {
        let x = left + count_of(column) * CELL[0] + CELL[0] / 2;
        let font = ("sans-serif", 11).into_font().transform(FontTransform::Rotate90);
        let style = TextStyle::from(font).pos(Pos::new(HPos::Left, VPos::Center));
        root.draw(&Text::new(word.clone(), (x, bottom + 6), style))?;
    }
    text(root, map.x.name, [left + columns * CELL[0] / 2, bottom + 64], 14, HPos::Center)
}

fn square(
    root: &Area,
    corner: [i32; 2],
    rows: i32,
    place: [usize; 2],
    color: RGBColor,
    word: &str,
) -> Result<(), AnyError> {
    let x = corner[0] + count_of(place[0]) * CELL[0];
    let y = corner[1] + (rows - 1 - count_of(place[1])) * CELL[1];
    let corners = [(x, y), (x + CELL[0] - 1, y + CELL[1] - 1)];
    root.draw(&Rectangle::new(corners, color.filled()))?;
    let RGBColor(r, g, b) = color;
    let light = u32::from(r) * 3 + u32::from(g) * 6 + u32::from(b);
    let ink = if light > 1300 { BLACK } else { WHITE };
    let style = TextStyle::from(("sans-serif", 10).into_font())
        .color(&ink)
        .pos(Pos::new(HPos::Center, VPos::Center));
    let middle = (x + CELL[0] / 2, y + CELL[1] / 2);
    Ok(root.draw(&Text::new(word.to_owned(), middle, style))?)
}

/// Colour and word of a cell.
fn verdict(cell: &Cell) -> (RGBColor, String) {
    let out = &cell.outcome;
    let (color, word) = match out.verdict {
        Verdict::Bounded => {
            let exponent = out.energy_balance[0].max(1e-17).log10();
            (balance_color(exponent), format!("{exponent:.0}"))
        }
        Verdict::Active => {
            // From 1e-9 up; adding 0 to −0 gives 0.
            let exponent = out.least_soil.abs().max(1e-17).log10().round() + 0.0;
            (ACTIVE, format!("{exponent}"))
        }
        Verdict::Grows => {
            (growth_color(out.growth_per_step), format!("{:.0e}", out.growth_per_step))
        }
        Verdict::Refused | Verdict::Failed => (ERROR, out.letter().to_owned()),
    };
    (color, if out.is_foretold() { format!("U {word}") } else { word })
}

/// Colour and word of the energy that the time scheme has made.
fn made(cell: &Cell) -> (RGBColor, String) {
    let out = &cell.outcome;
    match out.verdict {
        Verdict::Refused | Verdict::Failed => (ERROR, out.letter().to_owned()),
        _ if out.made > LIMIT => (growth_color(0.1 * out.made), percent(out.made)),
        _ => (balance_color(-17.0 + 400.0 * out.made), percent(out.made)),
    }
}

/// Energy that a scheme may make before a run warns.
const LIMIT: f64 = 0.02;

fn percent(share: f64) -> String {
    format!("{:.*}", usize::from(share > 5e-4 && share < 0.0995), 100.0 * share)
}

/// From blue (10⁻¹⁷) to pale green (10⁻⁹).
fn balance_color(exponent: f64) -> RGBColor {
    blend(RGBColor(49, 84, 160), RGBColor(196, 226, 168), (exponent + 17.0) / 8.0)
}

/// From pale red (0.1 % per step) to dark red (all in a step).
fn growth_color(growth: f64) -> RGBColor {
    blend(RGBColor(232, 120, 110), RGBColor(120, 0, 20), (growth.max(1e-3).log10() + 3.0) / 3.0)
}

fn blend(from: RGBColor, to: RGBColor, share: f64) -> RGBColor {
    let share = share.clamp(0.0, 1.0);
    let mix = |a: u8, b: u8| {
        let value = f64::from(a) + share * (f64::from(b) - f64::from(a));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 255")]
        let value = value.round() as u8;
        value
    };
    RGBColor(mix(from.0, to.0), mix(from.1, to.1), mix(from.2, to.2))
}

fn legend(root: &Area, top: i32, compared: bool) -> Result<(), AnyError> {
    let mut x = 14;
    let mut entry = |color: RGBColor, word: &str, width: i32| -> Result<(), AnyError> {
        root.draw(&Rectangle::new([(x, top), (x + 22, top + 14)], color.filled()))?;
        text(root, word, [x + 28, top + 7], 12, HPos::Left)?;
        x += width;
        Ok(())
    };
    if compared {
        entry(balance_color(-16.0), "made by the time scheme, % of the run's largest energy", 350)?;
        entry(growth_color(0.05), "more than 2 %: the run warns", 220)?;
        return entry(ERROR, "error", 80);
    }
    entry(balance_color(-16.0), "bounded: log₁₀ of the energy error", 268)?;
    entry(ACTIVE, "not growing, but the soil gives energy: log₁₀ of its share", 370)?;
    entry(growth_color(0.03), "grows: growth per step", 180)?;
    entry(ERROR, "error", 80)?;
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
