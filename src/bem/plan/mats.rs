//! Which cells are of which mat.

use std::collections::HashMap;

use super::faces::Face;
use crate::error::{PlanError, Result};

/// Mat of each cell: one that comes within the overhang of the cell's centre.
pub(super) fn owners(
    faces: &[Face],
    mats: &[usize],
    [corner, pitch]: [[f64; 2]; 2],
    [columns, rows]: [usize; 2],
    overhang: f64,
) -> Result<Vec<Option<usize>>> {
    let mut owners = vec![None; columns * rows];
    for (place, owner) in owners.iter_mut().enumerate() {
        let cell = [place % columns, place / columns];
        let near = |face: &Face| {
            (0..9).any(|point| {
                let steps = [f64::from(point % 3) - 1.0, f64::from(point / 3) - 1.0];
                face.contains([0, 1].map(|axis| {
                    let place = cell[axis] as f64 + 0.5 + overhang * steps[axis];
                    corner[axis] + pitch[axis] * place
                }))
            })
        };
        for (face, mat) in faces.iter().zip(mats) {
            if *owner != Some(*mat)
                && near(face)
                && let Some(other) = owner.replace(*mat)
            {
                return Err(PlanError::TooClose { mats: [other, *mat], pitch }.into());
            }
        }
    }
    Ok(owners)
}

/// Error for cells of two mats side by side or corner to corner.
pub(super) fn apart(owners: &[Option<usize>], columns: usize, pitch: [f64; 2]) -> Result<()> {
    for (place, owner) in owners.iter().enumerate() {
        let Some(owner) = owner else { continue };
        let (left, right) = (place % columns > 0, place % columns + 1 < columns);
        let steps = [(right, 1), (left, columns - 1), (true, columns), (right, columns + 1)];
        for (_, step) in steps.into_iter().filter(|(there, _)| *there) {
            if let Some(Some(other)) = owners.get(place + step)
                && other != owner
            {
                return Err(PlanError::TooClose { mats: [*owner, *other], pitch }.into());
            }
        }
    }
    Ok(())
}

/// The cells of each mat after those of the one before: mats in the order of their first cells, and the cells of each in
/// the order in which they come. Cells that touch, corners too, are of one mat.
pub(super) fn mat_by_mat(cells: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let places: HashMap<_, _> = cells.iter().enumerate().map(|(k, cell)| (*cell, k)).collect();
    let mut mats = vec![usize::MAX; cells.len()];
    for first in 0..cells.len() {
        if mats[first] != usize::MAX {
            continue;
        }
        mats[first] = first;
        let mut stack = vec![cells[first]];
        while let Some([i, j]) = stack.pop() {
            for step in 0..9 {
                let around = [(i + step % 3).checked_sub(1), (j + step / 3).checked_sub(1)];
                let [Some(column), Some(row)] = around else { continue };
                if let Some(&cell) = places.get(&[column, row])
                    && mats[cell] == usize::MAX
                {
                    mats[cell] = first;
                    stack.push([column, row]);
                }
            }
        }
    }
    let mut order: Vec<usize> = (0..cells.len()).collect();
    order.sort_by_key(|cell| mats[*cell]);
    order.into_iter().map(|cell| cells[cell]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two mats beside each other, and a third whose rows end between theirs.
    #[test]
    fn cells_of_a_mat_follow_one_another() {
        let text = ["##.#", "##.#", "....", ".##."];
        let on = |[i, j]: [usize; 2]| text[j].as_bytes()[i] == b'#';
        let all = (0..16).map(|place| [place % 4, place / 4]);
        let cells: Vec<_> = all.filter(|cell| on(*cell)).collect();
        let sorted = mat_by_mat(&cells);
        let expected = [[0, 0], [1, 0], [0, 1], [1, 1], [3, 0], [3, 1], [1, 3], [2, 3]];
        assert_eq!(sorted, expected);
        // A ring and cells that share corners are one.
        for text in ["####.##.", "#..##..#"] {
            let on = |place: usize| text.as_bytes()[place] == b'#';
            let cells: Vec<_> = (0..8).filter(|k| on(*k)).map(|k| [k % 3, k / 3]).collect();
            assert_eq!(mat_by_mat(&cells), cells, "{text}");
        }
    }
}
