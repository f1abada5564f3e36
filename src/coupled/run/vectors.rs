//! Forces, moments and rotations of a state as vectors.

use super::Quantity;
use crate::coupled::State;
use crate::coupled::state::foundation::in_axes;
use crate::geometry::COMPONENTS_IN_SPACE;

impl State {
    /// Force on the soil as a vector, N/m; in plan along x, y and up, N.
    ///
    /// In the plane axes point to the right, up and towards the reader.
    pub fn force_vector(&self) -> [f64; COMPONENTS_IN_SPACE] {
        let shear_x = self.value(Quantity::BaseShear);
        let shear_y = self.value(Quantity::ShearAcross);
        let normal_force = self.value(Quantity::NormalForce);
        in_axes(self.is_plan(), [shear_x, shear_y, -normal_force])
    }

    /// In plan: horizontal force on the soil along y, N; zero in the plane.
    ///
    /// Along x it is [`base_shear`](State::base_shear). It is the sum of the foundations'
    /// [`shear_across`](crate::coupled::Foundation::shear_across).
    pub fn shear_across(&self) -> f64 {
        self.value(Quantity::ShearAcross)
    }

    /// In plan: moment on the soil about the axis along x, N·m; zero in the plane.
    ///
    /// By the right-hand rule, about the point of [`base_moment`](State::base_moment), which is the moment about the
    /// axis along y.
    pub fn moment_across(&self) -> f64 {
        self.value(Quantity::MomentAcross)
    }

    /// Moment on the soil as a vector by the right-hand rule, N·m/m.
    ///
    /// About the point of [`base_moment`](State::base_moment), with axes as in
    /// [`force_vector`](State::force_vector).
    ///
    /// ```
    /// use basemat::bem::ElasticGround;
    /// use basemat::interface::Bonded;
    /// use basemat::motion::STANDARD_GRAVITY;
    /// use basemat::structure::RigidBody;
    /// use basemat::{Simulation, Soil};
    ///
    /// // The weight W of a machine stands 1 m to the right of the middle of its mat: M = r × F.
    /// let mat = vec![[-4.0, -3.0], [4.0, -3.0], [4.0, 3.0], [-4.0, 3.0]];
    /// let inertia = [[2e6, 0.0, 0.0], [0.0, 3e6, 0.0], [0.0, 0.0, 3e6]];
    /// let block = RigidBody::from_mass(mat, 4e5, inertia, [1.0, 0.0, 2.0])?;
    /// let weight = STANDARD_GRAVITY * block.total_mass();
    /// let soil = Soil::from_shear_wave_speed(300.0, 0.3, 1900.0)?;
    /// let simulation = Simulation::builder(0.01)
    ///     .ground(ElasticGround::under(soil, &block, 4)?)
    ///     .structure(block)
    ///     .interface(Bonded)
    ///     .build()?;
    /// let [x, y, vertical] = simulation.state().moment_vector();
    /// assert!((y / weight - 1.0).abs() < 1e-6);
    /// assert!(x.abs().max(vertical.abs()) < 1e-6 * weight);
    /// let state = simulation.state();
    /// assert!((state.force_vector()[2] / weight + 1.0).abs() < 1e-9);
    /// assert_eq!(state.force_vector()[1], state.shear_across());
    /// assert_eq!(x, state.moment_across());
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn moment_vector(&self) -> [f64; COMPONENTS_IN_SPACE] {
        let quantities = [Quantity::MomentAcross, Quantity::BaseMoment, Quantity::Torque];
        in_axes(self.is_plan(), quantities.map(|quantity| self.value(quantity)))
    }

    /// Rotation of the base as a vector by the right-hand rule, rad.
    ///
    /// Of several foundations the largest of each component, with axes as in
    /// [`force_vector`](State::force_vector).
    pub fn rotation_vector(&self) -> [f64; COMPONENTS_IN_SPACE] {
        let quantities = [Quantity::RotationAcross, Quantity::BaseRotation, Quantity::Twist];
        in_axes(self.is_plan(), quantities.map(|quantity| self.value(quantity)))
    }
}
