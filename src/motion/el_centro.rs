//! The El Centro record of 1940.

use super::{AccelerationUnit, ColumnFormat, Record};

const TEXT: &str = include_str!("../../data/elcentro1940_NS_peknold_0319g.csv");

/// El Centro 1940-05-18, component North–South, in the version of textbooks.
///
/// 1560 samples every 0.02 s, peak 0.31882 g at 2.04 s: the digitisation by Peknold, as tabulated
/// in Chopra, *Dynamics of Structures*, Appendix 6. No baseline treatment: it ends with a
/// velocity of 0.0007 m/s and a displacement of −5 mm.
///
/// ```
/// let record = basemat::motion::el_centro_1940();
/// assert_eq!(record.len(), 1560);
/// assert!((record.peak_acceleration() - 0.31882 * 9.80665).abs() < 1e-12);
/// ```
#[expect(clippy::missing_panics_doc, reason = "the embedded text is read by the tests")]
pub fn el_centro_1940() -> Record {
    let format = ColumnFormat::new(AccelerationUnit::StandardGravity).with_samples(1560);
    Record::from_reader("El Centro 1940", TEXT.as_bytes(), &format)
        .expect("the embedded record is valid")
}
