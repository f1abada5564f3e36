//! Checks of sections for beams in the plane and in space.

use super::section::FiberSection;
use crate::error::{Error, Result, at_least, require};

/// Bending stiffness, relative to that about the line of the nodes, below which it is rounding.
const MIN_RELATIVE_BENDING_STIFFNESS: f64 = 1e-12;
/// Largest bending stiffness that the strains of fibres may leave out, relative to that of the section.
///
/// Two fibres across a rectangle leave out a third of their stiffness, one fibre all.
const MAX_NEGLECTED_STIFFNESS_RATIO: f64 = 0.5;

impl FiberSection {
    /// Returns an error for a section of fewer than two fibres, or that cannot bend along y.
    pub(in crate::fem) fn check_plane(&self) -> Result<()> {
        at_least("fibres of a section", self.fiber_count(), 2)?;
        let [[axial, moment], [_, bending]] = self.elastic_stiffness();
        self.check_bending(0, bending - moment * moment / axial, bending)
    }

    /// Torsional stiffness G J (N m²) of a section that can bend along y and z.
    ///
    /// # Errors
    /// [`Error::Size`] for fewer than three fibres, [`Error::Input`] for fibres on a line and for a shape that is not cut
    /// into several fibres along y and z, [`Error::Scene`] without a torsional stiffness.
    pub(in crate::fem) fn check_space(&self) -> Result<f64> {
        at_least("fibres of a section in space", self.fiber_count(), 3)?;
        let [[axial, moment_y, moment_z], [_, bending_y, coupling], [_, _, bending_z]] =
            self.elastic_stiffness();
        let along_y = bending_y - moment_y * moment_y / axial;
        let along_z = bending_z - moment_z * moment_z / axial;
        self.check_bending(0, along_y, bending_y)?;
        self.check_bending(1, along_z, bending_z)?;
        let central_coupling = coupling - moment_y * moment_z / axial;
        // One less the squared correlation of y and z: it vanishes for fibres on an inclined line.
        let spread = 1.0 - central_coupling * central_coupling / (along_y * along_z);
        let quantity = "relative bending stiffness of a section of fibres about its weak axis";
        let needed = "above 1e-12: fibres that do not lie on a line";
        require(quantity, spread, spread > MIN_RELATIVE_BENDING_STIFFNESS, needed)?;
        let quantity = "section of fibres in space";
        let needed = "a torsional stiffness: FiberSection::with_torsional_stiffness";
        self.torsional_stiffness.ok_or(Error::Scene { quantity, needed })
    }

    /// Returns an error unless the section can bend along y (`axis` 0) or z (1).
    ///
    /// `stiffness`: about the centroid, `line_stiffness`: about the line of the nodes, N m².
    fn check_bending(&self, axis: usize, stiffness: f64, line_stiffness: f64) -> Result<()> {
        let quantity =
            ["bending stiffness along y of fibres", "bending stiffness along z of fibres"];
        let is_bending = stiffness > MIN_RELATIVE_BENDING_STIFFNESS * line_stiffness;
        let needed = "above zero and finite: fibres at different places along this axis";
        require(quantity[axis], stiffness, is_bending && stiffness.is_finite(), needed)?;
        let quantity = [
            "bending stiffness along y that undivided fibres leave out, relative to the section's",
            "bending stiffness along z that undivided fibres leave out, relative to the section's",
        ];
        let ratio = self.neglected_stiffness[axis] / stiffness;
        let needed = "at most 0.5: rectangles cut into more fibres along this axis";
        require(quantity[axis], ratio, ratio <= MAX_NEGLECTED_STIFFNESS_RATIO, needed).map(drop)
    }
}
