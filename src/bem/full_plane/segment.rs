//! Straight boundary elements.

/// A straight boundary element, with the soil on the right-hand side of the way from `from` to
/// `to` as seen with x to the right and z **down** (on a flat surface: from left to right).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Where it begins, (x, z), m.
    pub from: [f64; 2],
    /// Where it ends, (x, z), m.
    pub to: [f64; 2],
}

impl Segment {
    /// Length, m.
    pub fn length(&self) -> f64 {
        (self.to[0] - self.from[0]).hypot(self.to[1] - self.from[1])
    }

    /// Midpoint (x, z), m: where the boundary equation is collocated.
    pub fn center(&self) -> [f64; 2] {
        [0.5 * (self.from[0] + self.to[0]), 0.5 * (self.from[1] + self.to[1])]
    }

    /// Unit vector (x, z) along the element.
    pub fn direction(&self) -> [f64; 2] {
        let length = self.length();
        [(self.to[0] - self.from[0]) / length, (self.to[1] - self.from[1]) / length]
    }

    /// Unit normal (x, z) pointing out of the soil: (0, −1) on a flat surface.
    pub fn normal(&self) -> [f64; 2] {
        let [along, down] = self.direction();
        [down, -along]
    }
}
