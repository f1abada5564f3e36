//! The equations of motion of a cuboid on its cells, written and integrated by other means.

use basemat::motion::FreeField;

use super::cells::{Bed, Cells};

/// A cuboid whose middle of the base is at `center`.
#[derive(Clone, Copy)]
pub(crate) struct Cuboid {
    pub(crate) sides: [f64; 3],
    pub(crate) density: f64,
    pub(crate) center: [f64; 2],
}

type Six = [f64; 6];

impl Cuboid {
    pub(crate) fn mass(&self) -> f64 {
        self.density * self.sides.iter().product::<f64>()
    }

    /// M a, by the motion of slices of the cuboid: forces and moments about the middle of the base.
    pub(crate) fn inertia_forces(&self, a: Six) -> Six {
        let ([l, b, h], m) = (self.sides, self.mass());
        let middle = 0.5 * h;
        let force = [m * (a[0] + middle * a[4]), m * (a[1] - middle * a[3]), m * a[2]];
        [
            force[0],
            force[1],
            force[2],
            m * (b * b + h * h) / 12.0 * a[3] - middle * force[1],
            m * (l * l + h * h) / 12.0 * a[4] + middle * force[0],
            m * (l * l + b * b) / 12.0 * a[5],
        ]
    }

    /// a of M a = f, the inverse of the above.
    fn acceleration(&self, f: Six) -> Six {
        let ([l, b, h], m) = (self.sides, self.mass());
        let middle = 0.5 * h;
        let about_x = (f[3] + middle * f[1]) / (m * (b * b + h * h) / 12.0);
        let about_y = (f[4] - middle * f[0]) / (m * (l * l + h * h) / 12.0);
        [
            f[0] / m - middle * about_y,
            f[1] / m + middle * about_x,
            f[2] / m,
            about_x,
            about_y,
            f[5] / (m * (l * l + b * b) / 12.0),
        ]
    }

    /// Forces of the bed on the base, for its displacement `u` and velocity `v`.
    fn bed(
        &self,
        cells: &Cells,
        bed: Bed,
        field: &dyn FreeField,
        time: f64,
        u: Six,
        v: Six,
    ) -> Six {
        let mut sum = [0.0; 6];
        let half = 1e-5;
        for e in 0..cells.elements.len() {
            let (area, place) = cells.cell(e);
            let [x, y] = [0, 1].map(|k| place[k] - self.center[k]);
            let moved = |w: Six| [w[0] - y * w[5], w[1] + x * w[5], w[2] + y * w[3] - x * w[4]];
            let [before, now, after] =
                [-half, 0.0, half].map(|d| field.displacement_at(place, time + d));
            let force: [f64; 3] = std::array::from_fn(|k| {
                let component = [1, 2, 0][k];
                let rate = (after[k] - before[k]) / (2.0 * half);
                -area
                    * (bed.stiffness[component] * (moved(u)[k] - now[k])
                        + bed.dashpot[component] * (moved(v)[k] - rate))
            });
            let moments = [y * force[2], -x * force[2], x * force[1] - y * force[0]];
            for (sum, value) in sum.iter_mut().zip(force.into_iter().chain(moments)) {
                *sum += value;
            }
        }
        sum
    }

    /// Displacement after `steps` steps of Runge and Kutta from rest.
    pub(crate) fn march(
        &self,
        cells: &Cells,
        bed: Bed,
        field: &dyn FreeField,
        step: f64,
        steps: usize,
    ) -> Six {
        let add =
            |a: Six, factor: f64, b: Six| -> Six { std::array::from_fn(|i| a[i] + factor * b[i]) };
        let rate = |time: f64, [u, v]: [Six; 2]| {
            [v, self.acceleration(self.bed(cells, bed, field, time, u, v))]
        };
        let mut y = [[0.0; 6]; 2];
        for n in 0..steps {
            let time = n as f64 * step;
            let next = |k: [Six; 2], factor: f64| [0, 1].map(|j| add(y[j], factor * step, k[j]));
            let a = rate(time, y);
            let b = rate(time + 0.5 * step, next(a, 0.5));
            let c = rate(time + 0.5 * step, next(b, 0.5));
            let d = rate(time + step, next(c, 1.0));
            for (factor, k) in [(1.0, a), (2.0, b), (2.0, c), (1.0, d)] {
                y = [0, 1].map(|j| add(y[j], factor * step / 6.0, k[j]));
            }
        }
        y[0]
    }
}
