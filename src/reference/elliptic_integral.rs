//! Carlson's symmetric elliptic integral of the first kind.

/// `R_F`(x, y, z) for non-negative arguments, at most one of them zero.
///
/// Duplication theorem and series to sixth order: Carlson, "Computing elliptic integrals by
/// duplication", Numer. Math. 33 (1979), 1–16; NIST DLMF 19.36.1.
pub(super) fn carlson_rf(x: f64, y: f64, z: f64) -> f64 {
    let (mut x, mut y, mut z) = (x, y, z);
    loop {
        let mean = (x + y + z) / 3.0;
        let (dx, dy) = (1.0 - x / mean, 1.0 - y / mean);
        let dz = -(dx + dy);
        // neglected terms are of sixth order in these differences
        if dx.abs().max(dy.abs()).max(dz.abs()) < 1e-3 || !mean.is_finite() {
            let e2 = dx * dy - dz * dz;
            let e3 = dx * dy * dz;
            let series = 1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0;
            return series / mean.sqrt();
        }
        let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        (x, y, z) = ((x + lambda) / 4.0, (y + lambda) / 4.0, (z + lambda) / 4.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of Carlson, "Numerical computation of real or complex elliptic integrals", Numer.
    /// Algorithms 10 (1995), 13–26, section 3.
    #[test]
    fn carlson_1995_values() {
        assert!((carlson_rf(1.0, 2.0, 0.0) - 1.311_028_777_146_1).abs() < 1e-13);
        assert!((carlson_rf(2.0, 3.0, 4.0) - 0.584_082_841_677_15).abs() < 1e-13);
        assert!((carlson_rf(0.5, 1.0, 0.0) - 1.854_074_677_301_4).abs() < 1e-13);
    }
}
