//! Cells cut at the outline of mats.
//!
//! A cut cell has the traction of a whole cell in the soil, in series with a spring: with the fraction g of the cell
//! inside, its compliance C becomes about C/g, so that its force is proportional to the area inside. In the scene it is
//! a rectangle of this area, whose centre is the centre of area. Pressures then have the resultants of the outline.
//!
//! Oblique edges of rigid mats are moved outwards by less than the overhang, the less the more cells there are. Static
//! stiffnesses of turned squares, polygons and discs so fall steadily as the number of cells grows. Oblique edges of
//! flexible mats move further, the more so the softer the mat is: soil near a load then holds it, and pressures at the edge
//! count more. The distance is continuous in D and has no limit in the size of a cell, so that results do not jump.

use super::boundary::Boundary;
use super::region::{Grid, Part, Region};

/// Overhang of outer cells beyond the outline of a rigid mat, as a fraction of their side.
pub(super) const OVERHANG: f64 = 0.105;
/// Distance in cells by which oblique edges of rigid mats move outwards: the first number, plus the second over √n for n
/// cells along the shorter side. Found with discs and squares at several angles.
const SHIFT: [f64; 2] = [0.03, 0.15];
/// Distance in cells by which oblique edges of soft mats move further, and the D/(G R³) that halves it.
///
/// Found with circular plates and turned square ones under loads on the edge, on walls and everywhere, and with containments
/// that rock on rafts of D/(G R³) from 0.002 to 1. Rafts that rock under stiff walls confirm it.
const FURTHER: [f64; 2] = [0.06, 0.15];
/// Largest distance by which oblique edges of flexible mats move: in cells, and relative to the overhang.
const MOST: [f64; 2] = [0.12, 2.0];
/// Sine of the angle to the lattice from which an edge is oblique.
const OBLIQUE: f64 = 0.1;
/// Smallest fraction of a cell inside that makes it a contact element.
const SLIVER: f64 = 0.02;
/// Smallest area of a cut cell, relative to its part inside the moved outline.
const LEAST: f64 = 0.25;
/// Smallest area of a mat, relative to its area with edges moved outwards.
const NARROW: f64 = 0.5;
/// Fraction by which the spring of a cell is softer than C/g − C if it is cut along a side, or nearly whole or empty.
const SOFTER: f64 = 0.3;
/// Relative error of the rocking stiffness of a rigid mat, divided by side of a cell × length of oblique edges/area.
///
/// Measured: 0.036 to 0.053 for discs, turned squares and octagons on 8 and 16 cells, up to 0.068 on 4, and 0.03 for a
/// hexagon. Vertical stiffnesses have a fourth of this error.
const ERROR: f64 = 0.045;
/// Fraction of a cell that counts as rounding.
const ROUNDING: f64 = 1e-9;
/// Fraction of a cell inside a mat above which the cell belongs to it.
const HALF: f64 = 0.5 - ROUNDING;

/// A cell of a mat whose outline cuts cells.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cut {
    /// Ends along x and along y of the rectangle that is the contact element, m.
    pub(super) ends: [[f64; 2]; 2],
    /// Ratio of the rectangle's area to the whole cell's.
    pub(super) size: f64,
    /// Fraction of the rectangle inside the outline.
    pub(super) inside: f64,
    /// Compliance of the spring, relative to the cell's static compliance; zero for a whole cell.
    pub(super) softness: f64,
}

/// Cells of a mat row by row, and their cuts; no cuts if all cells of all mats are whole.
pub(super) type Cells = (Vec<[usize; 2]>, Vec<Cut>);

/// A cell of a mat, its part inside the moved outline, and its fraction inside the outline.
type Found = ([usize; 2], Part, f64);

/// Mat to which most of each cell belongs, and the cells of each mat; none for a mat that is too narrow.
pub(super) fn cut(
    mats: &[Boundary],
    grid: Grid,
    overhang: f64,
    rigidity: f64,
) -> (Vec<Option<usize>>, Vec<Cells>) {
    let along = grid.counts[0].min(grid.counts[1]) as f64;
    let most = if rigidity.is_infinite() { overhang } else { MOST[0].min(MOST[1] * overhang) };
    let further = FURTHER[0] / (1.0 + rigidity / FURTHER[1]);
    let oblique = (SHIFT[0] + SHIFT[1] / along.sqrt() + further).min(most);
    let distance = |normal: [f64; 2]| {
        let parallel = (1.0 - normal[0].abs().min(normal[1].abs()) / OBLIQUE).max(0.0);
        let shift = oblique + (overhang - oblique) * parallel;
        shift * (normal[0] * grid.pitch[0]).hypot(normal[1] * grid.pitch[1])
    };
    let inner: Vec<_> = mats.iter().map(|mat| Region::new(&mat.loops, grid)).collect();
    let outer: Vec<_> =
        mats.iter().map(|mat| Region::new(&mat.moved_outwards(distance), grid)).collect();
    let mut areas = vec![0.0; mats.len()];
    let mut found: Vec<Vec<Found>> = mats.iter().map(|_| vec![]).collect();
    let mut owners = vec![None; grid.counts[0] * grid.counts[1]];
    for (place, owner) in owners.iter_mut().enumerate() {
        let cell = [place % grid.counts[0], place / grid.counts[0]];
        let mut best = (0, Part::NONE, 0.0);
        for (mat, area) in areas.iter_mut().enumerate() {
            let part = outer[mat].part(cell);
            if !part.is_empty() {
                let inside = inner[mat].part(cell).area;
                *area += inside;
                if part.area > best.1.area {
                    best = (mat, part, inside);
                }
            }
        }
        let (mat, part, inside) = best;
        *owner = (part.area >= HALF).then_some(mat);
        if part.area >= SLIVER {
            found[mat].push((cell, part, inside));
        }
    }
    let is_cut = found.iter().flatten().any(|(_, part, _)| part.is_cut());
    let cells = |(own, area): (&Vec<Found>, f64)| {
        if area < NARROW * own.iter().map(|(_, part, _)| part.area).sum::<f64>() {
            return (vec![], vec![]);
        }
        let cuts = if is_cut { grid.cuts(own, area) } else { vec![] };
        (own.iter().map(|own| own.0).collect(), cuts)
    };
    let cells = found.iter().zip(areas).map(cells).collect();
    (owners, cells)
}

/// Estimated relative error of the rocking stiffness of a rigid mat, the largest of all mats.
pub(super) fn error(mats: &[Boundary], pitch: [f64; 2]) -> f64 {
    let size = (pitch[0] * pitch[1]).sqrt();
    let errors = mats.iter().map(|mat| ERROR * size * mat.oblique_length(OBLIQUE) / mat.area());
    errors.fold(0.0, f64::max)
}

impl Grid {
    /// Cuts of the cells of a mat with this area, in cells.
    ///
    /// Slivers and cells shared with other mats leave their area to the other cut cells, half whole ones most.
    fn cuts(&self, cells: &[Found], area: f64) -> Vec<Cut> {
        let first = |(_, part, inside): &Found| {
            if part.is_cut() { inside.max(LEAST * part.area) } else { *inside }
        };
        let room = |own: &Found| if own.1.is_cut() { first(own) * (1.0 - first(own)) } else { 0.0 };
        let missing = area - cells.iter().map(first).sum::<f64>();
        let rooms: f64 = cells.iter().map(room).sum();
        let ratio = if rooms > 0.0 { missing / rooms } else { 0.0 };
        let cut = |own: &Found| self.cut(own.0, &own.1, first(own) + ratio * room(own));
        let mut cuts: Vec<Cut> = cells.iter().map(cut).collect();
        // Cut cells that lie in the overhang alone are too large together: whole cells leave their area to them.
        let (whole, others): (Vec<_>, Vec<_>) = cuts.iter().partition(|cut| cut.softness == 0.0);
        let sum = |cuts: Vec<&Cut>| cuts.iter().map(|cut| cut.size * cut.inside).sum::<f64>();
        let ratio = (area - sum(others)) / sum(whole);
        for cut in cuts.iter_mut().filter(|cut| cut.softness == 0.0) {
            cut.inside = (ratio * cut.inside).min(1.0);
        }
        cuts
    }

    /// Contact element of a cell with this fraction inside: the cell, or a rectangle about the centre of area.
    fn cut(&self, cell: [usize; 2], part: &Part, area: f64) -> Cut {
        let mut center = [0.5; 2];
        let mut half = [0.5; 2];
        let mut softness = 0.0;
        if part.is_cut() {
            let area = area.clamp(0.1 * LEAST * SLIVER, 1.0);
            half = part.center.map(|x| x.min(1.0 - x));
            let grown = (0.25 * area / (half[0] * half[1])).sqrt();
            half = half.map(|x| x * grown);
            for axis in 0..2 {
                if half[axis] > 0.5 {
                    half[axis] = 0.5;
                    half[1 - axis] = 0.5 * area;
                }
            }
            center = [0, 1].map(|k| part.center[k].clamp(half[k], 1.0 - half[k]));
            let middle = 2.0 * part.area - 1.0;
            let softer = if part.is_rectangle { 1.0 } else { middle * middle };
            softness = (1.0 / part.area - 1.0) * (1.0 + SOFTER * softer);
        }
        let ends = [0, 1].map(|k| {
            [-half[k], half[k]]
                .map(|side| self.corner[k] + self.pitch[k] * (cell[k] as f64 + center[k] + side))
        });
        let inside = if part.is_cut() { 1.0 } else { area.min(1.0) };
        Cut { ends, size: 4.0 * half[0] * half[1], inside, softness }
    }
}
