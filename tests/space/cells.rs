//! A ground in plan: springs and dashpots under each cell, of its own and by the midpoint rule.

use basemat::bem::{ContactElement, Ground, GroundDescription, SpringGround};
use basemat::coupled::{SimulationBuilder, State};
use basemat::interface::InterfaceLaw;
use basemat::motion::{FreeField, Record, Triaxial};
use basemat::structure::{RigidBlock, RigidBody};
use basemat::{Error, Observer, Result, Simulation};

/// Stiffness (Pa/m) and dashpots (Pa·s/m) per area: down, along x, along y.
#[derive(Clone, Copy)]
pub(crate) struct Bed {
    pub(crate) stiffness: [f64; 3],
    pub(crate) dashpot: [f64; 3],
}

pub(crate) const BED: Bed =
    Bed { stiffness: [3.0e7, 2.0e7, 1.4e7], dashpot: [6.0e5, 3.0e5, 4.0e5] };

#[derive(Clone)]
pub(crate) struct Cells {
    pub(crate) elements: Vec<ContactElement>,
    pub(crate) sampled: Option<[usize; 2]>,
    bed: Bed,
    time_step: f64,
    displacement: Vec<f64>,
}

impl Cells {
    /// Rectangles between neighbouring `x` and neighbouring `y`.
    pub(crate) fn between(x: &[f64], y: &[f64], bed: Bed) -> Self {
        let mut elements = Vec::new();
        for away in y.windows(2) {
            for along in x.windows(2) {
                elements.push(ContactElement::in_plan([along[0], along[1]], [away[0], away[1]]));
            }
        }
        let displacement = vec![0.0; 3 * elements.len()];
        Self { elements, sampled: None, bed, time_step: 0.0, displacement }
    }

    /// The same after elements were taken away.
    pub(crate) fn resized(mut self) -> Self {
        self.displacement = vec![0.0; 3 * self.elements.len()];
        self
    }

    /// Under a rectangle about `center`, its outer cells a tenth of their side beyond its edge.
    pub(crate) fn under(sides: [f64; 2], center: [f64; 2], counts: [usize; 2], bed: Bed) -> Self {
        let lines = |k: usize| -> Vec<f64> {
            let pitch = sides[k] / (counts[k] as f64 - 0.2);
            let line = |j: usize| center[k] + pitch * (j as f64 - 0.5 * counts[k] as f64);
            (0..=counts[k]).map(line).collect()
        };
        Self::between(&lines(0), &lines(1), bed)
    }

    /// Area and middle of a cell.
    pub(crate) fn cell(&self, e: usize) -> (f64, [f64; 2]) {
        let [x, y, _] = self.elements[e].center();
        (self.elements[e].area(), [x, y])
    }

    /// k/2 + c/Δt and c/Δt − k/2 of the number `i` of a contact vector.
    fn rule(&self, i: usize) -> [f64; 2] {
        let component = i / self.elements.len();
        let (half, dashpot) =
            (0.5 * self.bed.stiffness[component], self.bed.dashpot[component] / self.time_step);
        [dashpot + half, dashpot - half]
    }

    fn fill(&self, matrix: &mut [f64], value: impl Fn(usize) -> f64) {
        let size = self.displacement.len();
        matrix.fill(0.0);
        (0..size).for_each(|i| matrix[i * (size + 1)] = value(i));
    }
}

impl Ground for Cells {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn description(&self) -> GroundDescription {
        GroundDescription { sampled_cells: self.sampled, ..Default::default() }
    }

    fn prepare(&mut self, time_step: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.time_step = time_step;
        self.displacement.fill(0.0);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.fill(matrix, |i| 1.0 / self.rule(i)[0]);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        for (i, value) in displacement.iter_mut().enumerate() {
            let [now, before] = self.rule(i);
            *value = before * self.displacement[i] / now;
        }
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        for (i, traction) in traction.iter().enumerate() {
            let [now, before] = self.rule(i);
            self.displacement[i] = (traction + before * self.displacement[i]) / now;
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.fill(matrix, |i| 1.0 / self.bed.stiffness[i / self.elements.len()]);
        Ok(())
    }

    fn save(&self) -> Result<Vec<f64>> {
        Ok(self.displacement.clone())
    }

    fn restore(&mut self, _: usize, values: &[f64]) -> Result<()> {
        if values.len() != self.displacement.len() {
            return Err(Error::part("bed", "has other cells"));
        }
        self.displacement.copy_from_slice(values);
        Ok(())
    }
}

/// Three smooth pulses along x, along y and upwards that run three ways; turned by quarters about the vertical axis.
#[derive(Clone, Copy)]
pub(crate) struct Waves {
    pub(crate) quarters: usize,
}

impl Waves {
    /// (1 − cos ωt)² in mm, from t = 0 on.
    fn pulse(time: f64, frequency: f64) -> f64 {
        if time > 0.0 { 1e-3 * (1.0 - (frequency * time).cos()).powi(2) } else { 0.0 }
    }
}

impl FreeField for Waves {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in plan asks for three directions")
    }

    fn displacement_at(&self, [mut x, mut y]: [f64; 2], time: f64) -> [f64; 3] {
        for _ in 0..self.quarters {
            (x, y) = (y, -x);
        }
        // Where the waves come from lies beyond all bases.
        let at = |along: f64, velocity: f64| time - (along + 30.0) / velocity;
        let [mut u, mut v] = [
            Self::pulse(at(0.8 * x - 0.6 * y, 200.0), 9.0),
            -0.6 * Self::pulse(at(0.6 * x + 0.8 * y, 150.0), 12.0),
        ];
        let up = 0.4 * Self::pulse(at(0.8 * x + 0.6 * y, 500.0), 15.0);
        for _ in 0..self.quarters {
            (u, v) = (-v, u);
        }
        [u, v, up]
    }
}

/// A block of 4 m × 6 m on eight elements of the plane, and a slice of it one metre deep, shaken along x alone.
pub(crate) fn slices(
    law: impl Fn() -> Box<dyn InterfaceLaw>,
    motion: &Record,
    step: f64,
) -> [SimulationBuilder; 2] {
    let plane = Simulation::builder(step)
        .structure(RigidBlock::new(4.0, 6.0, 1500.0).unwrap())
        .ground(SpringGround::new(-2.0..2.0, 8, 3e7, 2e7).unwrap().with_dashpots(6e5, 3e5).unwrap())
        .interface(law())
        .motion(motion.clone());
    let lines: Vec<f64> = (0..=8).map(|k| -2.0 + 0.5 * f64::from(k)).collect();
    let space = Simulation::builder(step)
        .structure(RigidBody::cuboid([4.0, 1.0, 6.0], 1500.0).unwrap())
        .ground(Cells::between(&lines, &[-0.5, 0.5], BED))
        .interface(law())
        .motion(Triaxial { x: Some(motion.clone()), ..Triaxial::default() });
    [plane, space]
}

/// Numbers that are equal in the plane and in such a slice, which moves along x and turns about y alone, but for
/// `rounding`.
pub(crate) fn equal_in_slices(plane: &State, space: &State, rounding: f64) -> [[f64; 2]; 4] {
    let [u, v] = [plane.displacement(), space.displacement()];
    assert!([v[1], v[3], v[5]].iter().all(|u| u.abs() < rounding), "{v:?}");
    [
        [u[0], v[0]],
        [u[2], -v[4]],
        [plane.base_shear, space.base_shear],
        [plane.base_moment, -space.base_moment],
    ]
}
