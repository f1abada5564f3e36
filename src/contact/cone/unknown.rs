//! Unknowns of the linear system of statuses.

/// A weighted sum of components: one with weight 1, or the three of an element.
#[derive(Clone, Copy)]
pub(super) struct Mix {
    pub(super) places: [usize; 3],
    pub(super) weights: [f64; 3],
}

impl Mix {
    pub(super) fn single(place: usize) -> Self {
        Self { places: [place; 3], weights: [1.0, 0.0, 0.0] }
    }

    pub(super) fn is_single(&self) -> bool {
        self.places[1] == self.places[0]
    }

    pub(super) fn sum(&self, values: &[f64]) -> f64 {
        self.weights[0] * values[self.places[0]]
            + self.weights[1] * values[self.places[1]]
            + self.weights[2] * values[self.places[2]]
    }

    pub(super) fn add_to(&self, values: &mut [f64], factor: f64) {
        for (place, weight) in self.places.into_iter().zip(self.weights) {
            values[place] += factor * weight;
        }
    }
}

/// An unknown and its condition. x are the unknown forces or motions, A x the quantities of the other kind. The
/// unknown adds multiples of `column` to x, and row · A x + coefficient weighted · x = goal.
pub(super) struct Unknown {
    pub(super) row: Mix,
    pub(super) column: Mix,
    pub(super) coefficient: f64,
    /// Sum of x in the condition: the column, but for a p that hardens without the shear that it lets slip.
    pub(super) weighted: Mix,
    pub(super) goal: f64,
}

impl Unknown {
    /// Condition in which the column itself is weighted.
    pub(super) fn new(row: Mix, column: Mix, coefficient: f64, goal: f64) -> Self {
        Self { row, column, coefficient, weighted: column, goal }
    }

    /// Entry that the coefficient adds to the diagonal; columns have length one.
    pub(super) fn diagonal(&self) -> f64 {
        if self.weighted.is_single() {
            self.coefficient * self.column.weights[0]
        } else {
            self.coefficient
        }
    }
}
