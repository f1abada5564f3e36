//! Axes and ends of beams, for the forces at their ends.

/// Axes of a beam, and the places of its ends relative to its nodes.
pub(crate) struct EndFrame {
    /// Along the beam, y and z of its section, right-handed.
    pub(crate) axes: [[f64; 3]; 3],
    /// From the nodes to the ends, m.
    pub(crate) offsets: [[f64; 3]; 2],
}
