//! The equations of motion of a cuboid on its cells, without code of the crate, integrated by Runge and Kutta's method.

use basemat::motion::FreeField;

use super::cells::{BedProperties, SpringCells};

/// A cuboid whose middle of the base is at `center`.
#[derive(Clone, Copy)]
pub(crate) struct Cuboid {
    pub(crate) sides: [f64; 3],
    pub(crate) density: f64,
    pub(crate) center: [f64; 2],
}

/// Motions along x, y and z, and rotations about them; or forces and moments.
type SixComponents = [f64; 6];

/// Displacement and velocity of a rigid body.
type MotionState = [SixComponents; 2];

impl Cuboid {
    pub(crate) fn mass(&self) -> f64 {
        self.density * self.sides.iter().product::<f64>()
    }

    /// Moments of inertia about axes through the centre of gravity.
    fn central_inertia(&self) -> [f64; 3] {
        let [l, b, h] = self.sides;
        let m = self.mass();
        [(b * b + h * h), (l * l + h * h), (l * l + b * b)].map(|square| m * square / 12.0)
    }

    /// M a, by the motion of slices of the cuboid: forces and moments about the middle of the base.
    pub(crate) fn inertia_forces(&self, a: SixComponents) -> SixComponents {
        let m = self.mass();
        let middle = 0.5 * self.sides[2];
        let inertia = self.central_inertia();
        let force = [m * (a[0] + middle * a[4]), m * (a[1] - middle * a[3]), m * a[2]];
        [
            force[0],
            force[1],
            force[2],
            inertia[0] * a[3] - middle * force[1],
            inertia[1] * a[4] + middle * force[0],
            inertia[2] * a[5],
        ]
    }

    /// Accelerations a of M a = f: the inverse of `inertia_forces`.
    fn acceleration(&self, f: SixComponents) -> SixComponents {
        let m = self.mass();
        let middle = 0.5 * self.sides[2];
        let inertia = self.central_inertia();
        let about_x = (f[3] + middle * f[1]) / inertia[0];
        let about_y = (f[4] - middle * f[0]) / inertia[1];
        [
            f[0] / m - middle * about_y,
            f[1] / m + middle * about_x,
            f[2] / m,
            about_x,
            about_y,
            f[5] / inertia[2],
        ]
    }

    /// Displacement after `steps` steps of Runge and Kutta's method from rest.
    pub(crate) fn march(
        &self,
        cells: &SpringCells,
        bed: BedProperties,
        field: &dyn FreeField,
        step: f64,
        steps: usize,
    ) -> SixComponents {
        let equations = EquationsOfMotion { cuboid: self, cells, bed, field };
        let mut y = [[0.0; 6]; 2];
        for n in 0..steps {
            let time = n as f64 * step;
            let a = equations.rate(time, y);
            let b = equations.rate(time + 0.5 * step, advanced(y, 0.5 * step, a));
            let c = equations.rate(time + 0.5 * step, advanced(y, 0.5 * step, b));
            let d = equations.rate(time + step, advanced(y, 1.0 * step, c));
            for (factor, k) in [(1.0, a), (2.0, b), (2.0, c), (1.0, d)] {
                y = advanced(y, factor * step / 6.0, k);
            }
        }
        y[0]
    }
}

/// y + duration · rate.
fn advanced(y: MotionState, duration: f64, rate: MotionState) -> MotionState {
    [0, 1].map(|j| std::array::from_fn(|i| y[j][i] + duration * rate[j][i]))
}

/// Displacement by the rigid motion `w` at a point of the base, from its middle.
fn point_displacement(w: SixComponents, x: f64, y: f64) -> [f64; 3] {
    [w[0] - y * w[5], w[1] + x * w[5], w[2] + y * w[3] - x * w[4]]
}

/// A cuboid on a bed under a moving ground.
struct EquationsOfMotion<'a> {
    cuboid: &'a Cuboid,
    cells: &'a SpringCells,
    bed: BedProperties,
    field: &'a dyn FreeField,
}

impl EquationsOfMotion<'_> {
    /// Velocity and acceleration.
    fn rate(&self, time: f64, [u, v]: MotionState) -> MotionState {
        [v, self.cuboid.acceleration(self.bed_forces(time, u, v))]
    }

    /// Forces of the bed on the base, for its displacement `u` and velocity `v`.
    fn bed_forces(&self, time: f64, u: SixComponents, v: SixComponents) -> SixComponents {
        const HALF_INTERVAL: f64 = 1e-5;
        let mut sum = [0.0; 6];
        for e in 0..self.cells.elements.len() {
            let area = self.cells.area(e);
            let middle = self.cells.middle(e);
            let x = middle[0] - self.cuboid.center[0];
            let y = middle[1] - self.cuboid.center[1];
            let ground_before = self.field.displacement_at(middle, time + -HALF_INTERVAL);
            let ground_now = self.field.displacement_at(middle, time + 0.0);
            let ground_after = self.field.displacement_at(middle, time + HALF_INTERVAL);
            let displacement = point_displacement(u, x, y);
            let velocity = point_displacement(v, x, y);
            let force: [f64; 3] = std::array::from_fn(|k| {
                let component = [1, 2, 0][k];
                let rate = (ground_after[k] - ground_before[k]) / (2.0 * HALF_INTERVAL);
                -area
                    * (self.bed.stiffness[component] * (displacement[k] - ground_now[k])
                        + self.bed.dashpot[component] * (velocity[k] - rate))
            });
            let moments = [y * force[2], -x * force[2], x * force[1] - y * force[0]];
            for (sum, value) in sum.iter_mut().zip(force.into_iter().chain(moments)) {
                *sum += value;
            }
        }
        sum
    }
}
