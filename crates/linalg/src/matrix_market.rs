//! Reading and writing of Matrix Market files.
//!
//! The supported part of the format (Boisvert, Pozo & Remington, NIST IR 5935, 1996) is sufficient for structural
//! matrices: coordinate or array, real or integer, general or symmetric.

use std::io::{Read, Write};
use std::path::Path;

use super::matrix_market_reader::read;
use crate::SparseMatrix;
use crate::Triplets;
use basemat_base::error::{FileFault, Result};
use basemat_base::text::file::{open_file, replace_file, write_error};

impl Triplets {
    /// Reads a square matrix from a Matrix Market file (`.mtx`).
    ///
    /// Supported: `coordinate` and `array`; `real`, `double` and `integer`; `general` and `symmetric`.
    /// Entries with equal indices are summed. Needs the feature `io`.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) with the line and the reason.
    pub fn read_matrix_market(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        Self::from_matrix_market(&path.display().to_string(), open_file(path)?)
    }

    /// Reads a Matrix Market file from any source of bytes; errors name the source `name`.
    ///
    /// Needs the feature `io`.
    ///
    /// ```
    /// use basemat::structure::Triplets;
    /// let text = "%%MatrixMarket matrix coordinate real symmetric\n\
    ///             % a spring\n\
    ///             2 2 3\n1 1 5.0\n2 1 -5.0\n2 2 5.0\n";
    /// let spring = Triplets::from_matrix_market("spring", text.as_bytes())?;
    /// assert_eq!(spring.entries(), [(0, 0, 5.0), (1, 0, -5.0), (0, 1, -5.0), (1, 1, 5.0)]);
    ///
    /// let wrong = text.replace("2 1 -5.0", "3 1 -5.0");
    /// let error = Triplets::from_matrix_market("spring", wrong.as_bytes()).unwrap_err();
    /// assert_eq!(error.to_string(), "spring, line 5: index is 3, but must be from 1 to 2");
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) with the line and the reason.
    pub fn from_matrix_market(name: &str, mut source: impl Read) -> Result<Self> {
        read(&mut source).map_err(|(line, fault)| fault.of(name, line))
    }

    /// Writes the matrix to a Matrix Market file, in the coordinate format.
    ///
    /// If the file cannot be written completely, it is unchanged. Entries with equal indices are summed, and zeros are
    /// omitted. A matrix that is symmetric to the last bit is written as symmetric. The file reads back as the same
    /// numbers. Needs the feature `io`.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) or [`Error::Input`](crate::Error::Input) for an entry out of range or not
    /// finite, [`Error::Memory`](crate::Error::Memory) for more rows than fit into memory,
    /// [`Error::File`](crate::Error::File) when the file cannot be written.
    pub fn write_matrix_market(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let mut text = Vec::new();
        write(&self.checked_matrix()?, &mut text)
            .and_then(|()| replace_file(path, &text))
            .map_err(write_error(path))
    }

    /// Writes a Matrix Market file to any sink of bytes; errors name the sink `name`.
    ///
    /// Needs the feature `io`.
    ///
    /// # Errors
    /// As for [`Triplets::write_matrix_market`].
    pub fn to_matrix_market(&self, name: &str, mut sink: impl Write) -> Result<()> {
        write(&self.checked_matrix()?, &mut sink)
            .map_err(|error| FileFault::Unwritable(error.kind()).of(name, 0))
    }

    /// The matrix with summed entries.
    ///
    /// Returns an error for an entry that is out of range or not finite.
    fn checked_matrix(&self) -> Result<SparseMatrix> {
        SparseMatrix::new("matrix to be written", self)
    }
}

/// Writes the coordinate format; `{:e}` prints the shortest digits that read back as the same number.
fn write(matrix: &SparseMatrix, sink: &mut dyn Write) -> std::io::Result<()> {
    let is_symmetric = matrix.asymmetry() == 0.0;
    let entries: Vec<(usize, usize, f64)> = matrix
        .entries()
        .filter(|&(row, column, value)| value != 0.0 && (!is_symmetric || row >= column))
        .collect();
    let order = matrix.order();
    let symmetry = if is_symmetric { "symmetric" } else { "general" };
    writeln!(sink, "%%MatrixMarket matrix coordinate real {symmetry}")?;
    writeln!(sink, "{order} {order} {}", entries.len())?;
    for (row, column, value) in entries {
        writeln!(sink, "{} {} {value:e}", row + 1, column + 1)?;
    }
    sink.flush()
}
