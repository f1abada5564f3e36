//! Writer of Matrix Market files.

use std::io::{Result, Write};

use crate::linalg::SparseMatrix;

/// Coordinate format; `{:e}` prints the shortest digits that read back as the same number.
pub(super) fn write(matrix: &SparseMatrix, sink: &mut dyn Write) -> Result<()> {
    let symmetric = matrix.asymmetry() == 0.0;
    let wanted =
        |&(row, column, value): &(usize, usize, f64)| value != 0.0 && (!symmetric || row >= column);
    let order = matrix.order();
    let count = matrix.entries().filter(wanted).count();
    let symmetry = if symmetric { "symmetric" } else { "general" };
    writeln!(sink, "%%MatrixMarket matrix coordinate real {symmetry}")?;
    writeln!(sink, "{order} {order} {count}")?;
    for (row, column, value) in matrix.entries().filter(wanted) {
        writeln!(sink, "{} {} {value:e}", row + 1, column + 1)?;
    }
    sink.flush()
}
