//! Matrix Market files, read and written.
//!
//! The format of Boisvert, Pozo & Remington (NIST IR 5935, 1996): coordinate or array, real or
//! integer, general or symmetric, as far as a structure's matrices need it.

mod reader;

use std::fs::File;
use std::io::{Read, Write};
use std::path::Path;

use crate::error::{Error, MatrixFileError, Result};
use crate::linalg::SparseMatrix;
use crate::structure::Triplets;

impl Triplets {
    /// Reads a square matrix from a Matrix Market file (`.mtx`).
    ///
    /// Understood are `coordinate` and `array`, `real`, `double` and `integer`, `general` and
    /// `symmetric`. Entries given twice add up.
    ///
    /// # Errors
    /// [`Error::MatrixFile`] with the line and the reason.
    pub fn read_matrix_market(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let name = path.display().to_string();
        match File::open(path) {
            Ok(file) => Self::from_matrix_market(&name, file),
            Err(error) => Err(whole(name, MatrixFileError::Unreadable(error.kind()))),
        }
    }

    /// Reads the same from any source of bytes; `name` is what errors call it.
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
    /// assert_eq!(error.to_string(), "spring, line 5: index 3, but the matrix has 2 rows and columns");
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::MatrixFile`] with the line and the reason.
    pub fn from_matrix_market(name: &str, mut source: impl Read) -> Result<Self> {
        reader::read(&mut source).map_err(|(line, reason)| Error::MatrixFile {
            file: name.to_owned(),
            line,
            reason,
        })
    }

    /// Writes the matrix to a Matrix Market file, in the coordinate format.
    ///
    /// Entries at the same place are summed, zeros left out, and a matrix that is symmetric to the last bit is
    /// written as such. Numbers are written so that reading gives the same ones back.
    ///
    /// # Errors
    /// [`Error::Index`] or [`Error::Input`] for an entry out of range or not finite, and
    /// [`Error::Memory`] for more rows than would fit, with the file left as it was;
    /// [`Error::MatrixFile`] when it cannot be written.
    pub fn write_matrix_market(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        // Before the file is opened, which empties it.
        let matrix = self.checked()?;
        File::create(path)
            .and_then(|file| write(&matrix, &mut std::io::BufWriter::new(file)))
            .map_err(|error| unwritable(path.display().to_string(), &error))
    }

    /// Writes the same to any sink of bytes; `name` is what errors call it.
    ///
    /// # Errors
    /// As for [`Triplets::write_matrix_market`].
    pub fn to_matrix_market(&self, name: &str, mut sink: impl Write) -> Result<()> {
        write(&self.checked()?, &mut sink).map_err(|error| unwritable(name.to_owned(), &error))
    }

    fn checked(&self) -> Result<SparseMatrix> {
        SparseMatrix::new("matrix to be written", self)
    }
}

fn unwritable(file: String, error: &std::io::Error) -> Error {
    whole(file, MatrixFileError::Unwritable(error.kind()))
}

/// The error for a file as a whole.
fn whole(file: String, reason: MatrixFileError) -> Error {
    Error::MatrixFile { file, line: 0, reason }
}

/// Coordinate format; `{:e}` prints the shortest digits that read back as the same number.
fn write(matrix: &SparseMatrix, sink: &mut dyn Write) -> std::io::Result<()> {
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
