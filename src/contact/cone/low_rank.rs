//! W of independent elements that the structure moves in few ways: W = D + L Lᵀ, element by element.

use crate::contact::OnBed;

/// D, L and the amplitudes of the present forces.
pub(super) struct LowRank {
    /// D of each element: soil and layer of its components, m/N.
    diagonal: Vec<[f64; 3]>,
    /// L of each element, mode by mode.
    modes: Vec<[f64; 3]>,
    rank: usize,
    /// Lᵀ r.
    amplitudes: Vec<f64>,
}

impl LowRank {
    /// Room for W of `count` elements.
    pub(super) fn new(count: usize) -> Self {
        Self { diagonal: vec![[0.0; 3]; count], modes: vec![], rank: 0, amplitudes: vec![] }
    }

    /// Takes D and L on elements with these areas; `layer(row)`: part of the diagonal that is neither soil nor structure.
    pub(super) fn set(&mut self, on_bed: &OnBed, areas: &[f64], layer: impl Fn(usize) -> f64) {
        let count = areas.len();
        self.rank = on_bed.rank();
        self.amplitudes.clear();
        self.amplitudes.resize(self.rank, 0.0);
        self.modes.clear();
        for (e, diagonal) in self.diagonal.iter_mut().enumerate() {
            let places = [e, count + e, 2 * count + e];
            *diagonal = places.map(|i| on_bed.soil(i) / areas[e] + layer(i));
            let modes = places.map(|i| on_bed.modes(i));
            self.modes.extend((0..self.rank).map(|k| modes.map(|mode| mode[k])));
        }
    }

    /// D of an element.
    #[inline]
    pub(super) fn diagonal(&self, e: usize) -> [f64; 3] {
        self.diagonal[e]
    }

    /// L of an element, mode by mode.
    #[inline]
    pub(super) fn modes(&self, e: usize) -> &[[f64; 3]] {
        &self.modes[e * self.rank..][..self.rank]
    }

    /// Number of modes.
    pub(super) fn rank(&self) -> usize {
        self.rank
    }

    /// Block of W between the components of an element.
    pub(super) fn block(&self, e: usize) -> [[f64; 3]; 3] {
        let mut block = [[0.0; 3]; 3];
        for mode in self.modes(e) {
            for (row, entry) in block.iter_mut().zip(mode) {
                row.iter_mut().zip(mode).for_each(|(sum, other)| *sum += entry * other);
            }
        }
        (0..3).for_each(|k| block[k][k] += self.diagonal[e][k]);
        block
    }

    /// Sets the amplitudes to Lᵀ r, and `y` to q + (W + `added`) r.
    pub(super) fn update_motions(&mut self, forces: &[f64], q: &[f64], added: f64, y: &mut [f64]) {
        let count = self.diagonal.len();
        self.amplitudes.fill(0.0);
        for e in 0..count {
            self.push(e, [forces[e], forces[count + e], forces[2 * count + e]]);
        }
        for e in 0..count {
            let places = [e, count + e, 2 * count + e];
            let motion = self.motion(e, places.map(|i| forces[i]));
            for (i, motion) in places.into_iter().zip(motion) {
                y[i] = q[i] + added * forces[i] + motion;
            }
        }
    }

    /// Motion of an element with this force.
    #[inline]
    pub(super) fn motion(&self, e: usize, force: [f64; 3]) -> [f64; 3] {
        let mut motion = self.motion_by_modes(e, &self.amplitudes);
        (0..3).for_each(|k| motion[k] += self.diagonal[e][k] * force[k]);
        motion
    }

    /// Motion L a of an element by amplitudes a of the modes.
    #[inline]
    pub(super) fn motion_by_modes(&self, e: usize, amplitudes: &[f64]) -> [f64; 3] {
        let mut motion = [0.0; 3];
        for (amplitude, mode) in amplitudes.iter().zip(self.modes(e)) {
            (0..3).for_each(|k| motion[k] += amplitude * mode[k]);
        }
        motion
    }

    /// Adds the motion of all elements by a force on one.
    #[inline]
    pub(super) fn push(&mut self, e: usize, force: [f64; 3]) {
        let modes = &self.modes[e * self.rank..][..self.rank];
        for (amplitude, mode) in self.amplitudes.iter_mut().zip(modes) {
            *amplitude += mode[0] * force[0] + mode[1] * force[1] + mode[2] * force[2];
        }
    }
}
