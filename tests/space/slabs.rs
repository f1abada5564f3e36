//! A slab of plate elements with columns: its nodes are free to go up and down, and cells must be small enough for its
//! bending.

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Ground};
use basemat::coupled::{CoarseBaseError, Warning};
use basemat::interface::Coulomb;
use basemat::structure::{Base, BaseNode, MatrixModel, RigidBody, Structure, Triplets};
use basemat::{Error, Result, Simulation, Soil};

use super::cells::{BED_PROPERTIES, SpringCells};
use super::plate_element::{NODE_DOFS, plate_corners, plate_stiffness};

/// A square slab of `count` × `count` plates, rigid in its plane, with masses on some nodes.
struct Slab {
    side: f64,
    count: usize,
    /// Thickness, m.
    thickness: f64,
    /// Columns, node along x and along y, and mass, kg.
    columns: Vec<([usize; 2], f64)>,
}

impl Slab {
    const YOUNG_MODULUS: f64 = 30e9;
    const POISSON_RATIO: f64 = 0.2;
    const CONCRETE_DENSITY: f64 = 2400.0;

    fn pitch(&self) -> f64 {
        self.side / self.count as f64
    }

    /// Place of a node along x or y.
    fn place(&self, node: usize) -> f64 {
        self.side * (node as f64 / self.count as f64 - 0.5)
    }

    /// First degree of freedom of a node; the three motions in the plane come before all.
    fn dof(&self, [i, j]: [usize; 2]) -> usize {
        3 + NODE_DOFS * (j * (self.count + 1) + i)
    }

    fn rigidity(&self) -> f64 {
        Self::YOUNG_MODULUS * self.thickness.powi(3) / (12.0 * (1.0 - Self::POISSON_RATIO.powi(2)))
    }

    /// Pressure of the slab's weight, Pa.
    fn pressure(&self) -> f64 {
        self.thickness * Self::CONCRETE_DENSITY * 9.806_65
    }

    /// Quarter of a plate's mass.
    fn nodal_mass(&self) -> f64 {
        let pitch = self.pitch();
        0.25 * pitch * pitch * self.thickness * Self::CONCRETE_DENSITY
    }

    /// Motions along x and y of a node, by those of the slab in its plane.
    fn horizontal_motions(&self, node: [usize; 2]) -> [[(usize, f64); 2]; 2] {
        let x = self.place(node[0]);
        let y = self.place(node[1]);
        [[(0, 1.0), (2, -y)], [(1, 1.0), (2, x)]]
    }

    fn add_mass(&self, matrix: &mut Triplets, node: [usize; 2], mass: f64) {
        for row in &self.horizontal_motions(node) {
            matrix.add_outer(row, mass);
        }
        let first_dof = self.dof(node);
        matrix.add(first_dof, first_dof, mass);
        let pitch = self.pitch();
        let small_inertia = mass * 1e-2 * pitch * pitch;
        for rotation in [first_dof + 1, first_dof + 2] {
            matrix.add(rotation, rotation, small_inertia);
        }
    }

    fn model(&self) -> Result<MatrixModel> {
        let order = 3 + NODE_DOFS * (self.count + 1).pow(2);
        let mut mass = Triplets::new(order);
        let mut stiffness = Triplets::new(order);
        let plate = plate_stiffness([self.pitch(); 2], self.rigidity(), Self::POISSON_RATIO);
        let mut faces = Vec::new();
        for j in 0..self.count {
            for i in 0..self.count {
                let corners = plate_corners([i, j]);
                let dofs: Vec<_> = corners
                    .iter()
                    .flat_map(|node| (0..NODE_DOFS).map(|k| self.dof(*node) + k))
                    .collect();
                stiffness.add_block(&dofs, &plate);
                for node in &corners {
                    self.add_mass(&mut mass, *node, self.nodal_mass());
                }
                faces.push(corners.map(|node| self.base_node(node)).to_vec());
            }
        }
        for (node, column_mass) in &self.columns {
            self.add_mass(&mut mass, *node, *column_mass);
        }
        MatrixModel::new(mass, stiffness, Base::Faces(faces))
    }

    fn base_node(&self, node: [usize; 2]) -> BaseNode {
        let motions = self.horizontal_motions(node);
        BaseNode {
            x: self.place(node[0]),
            y: self.place(node[1]),
            z: 0.0,
            horizontal: motions[0].into(),
            across: motions[1].into(),
            vertical: self.dof(node).into(),
        }
    }

    /// The simulation on `cells` × `cells` that end at the outline.
    fn build(&self, cells: usize) -> Result<Simulation> {
        let half = 0.5 * self.side;
        let plan = Plan::rectangle(-half..half, -half..half, cells)?;
        Simulation::builder(0.01)
            .structure(self.model()?)
            .ground(ElasticGround::in_plan(soil(), plan)?)
            .interface(Coulomb::new(0.5)?)
            .build()
    }

    /// Static displacement on a half-space with a cell for each plate.
    fn static_displacement(&self) -> Vec<f64> {
        let model = self.model().unwrap();
        let ground = ElasticGround::under(soil(), &model, self.count).unwrap();
        let builder = Simulation::builder(0.01).structure(model).ground(ground);
        let simulation = builder.interface(Coulomb::new(0.5).unwrap()).build().unwrap();
        simulation.static_displacement().to_vec()
    }
}

fn soil() -> Soil {
    Soil::from_shear_wave_speed(200.0, 0.33, 1900.0).unwrap()
}

/// A column in the middle of a slab of 12 × 12 m: its settlement relative to the middle of an edge is 2.75 mm on 16 × 16
/// cells.
#[test]
fn too_few_cells_under_a_slab_are_an_error_or_a_warning() {
    let slab = Slab { side: 12.0, count: 24, thickness: 0.25, columns: vec![([12, 12], 120e3)] };
    let error = slab.build(4).expect_err("an error");
    let Error::CoarseBase(CoarseBaseError {
        foundation: 0,
        elements: 4,
        needed,
        difference,
        axis: Some('x'),
    }) = error
    else {
        panic!("{error}")
    };
    assert!((9..=13).contains(&needed) && (0.5..0.7).contains(&difference.unwrap()), "{error}");
    for (cells, tolerance) in [(6, 0.17), (8, 0.07), (12, 0.02)] {
        let mut simulation = slab.build(cells).unwrap();
        let u = simulation.static_displacement();
        let settlement = u[slab.dof([12, 0])] - u[slab.dof([12, 12])];
        assert!((settlement / 2.7466e-3 - 1.0).abs() < tolerance, "{cells}: {settlement}");
        let warnings = simulation.run(1, |_| {}).unwrap().warnings;
        let counts_in_warning = warnings.iter().find_map(|warning| match warning {
            Warning::CoarseBase { elements, needed, .. } => Some([*elements, *needed]),
            _ => None,
        });
        let has_warning =
            counts_in_warning.is_some_and(|[elements, needed]| elements == cells && needed <= 14);
        assert_eq!(has_warning, cells < 12, "{cells}: {warnings:?}");
    }
}

/// At least as many cells as faces under a flexible slab, as many as requested under a rigid one.
#[test]
fn a_slab_gets_as_many_cells_as_faces() {
    let slab = Slab { side: 12.0, count: 10, thickness: 0.25, columns: vec![] };
    let model = slab.model().unwrap();
    for (requested, cells) in [(4, 10), (10, 10), (12, 12)] {
        let ground = ElasticGround::under(soil(), &model, requested).unwrap();
        assert_eq!(ground.elements().len(), cells * cells);
    }
    assert!(Plan::under(&model, 1).is_err());
    let rigid_body = RigidBody::cuboid([12.0, 12.0, 1.0], 2400.0).unwrap();
    assert_eq!(Plan::under(&rigid_body, 4).unwrap().count(), 16);
    assert_eq!(model.base().nodes().count(), 400);
    // A mesh that is much finer than cells can be: `build` checks whether there are enough.
    let fine_model = Slab { count: 50, ..slab }.model().unwrap();
    assert_eq!(Plan::under(&fine_model, 12).unwrap().count(), 31 * 31);
    assert_eq!(Plan::under(&fine_model, 40).unwrap().count(), 40 * 40);
}

/// A soft plate under its weight sinks as the soil under a uniform pressure q does: 1.1222 q B (1 − ν)/(2G) in the
/// middle (Boussinesq), for D/(G B³) of 1e-6 and 1e-7.
#[test]
fn soft_plates_sink_as_a_uniform_pressure_does() {
    let soil = soil();
    for thickness in [0.036_9, 0.017_14] {
        let errors = [8, 12, 16].map(|count| {
            let slab = Slab { side: 12.0, count, thickness, columns: vec![] };
            let rigidity = slab.rigidity() / (soil.shear_modulus() * slab.side.powi(3));
            assert!((1e7 * rigidity - 10.0).abs() < 0.1 || (1e7 * rigidity - 1.0).abs() < 0.01);
            let computed = -slab.static_displacement()[slab.dof([count / 2; 2])];
            let expected = 1.1222 * slab.pressure() * slab.side * (1.0 - soil.poisson())
                / (2.0 * soil.shear_modulus());
            computed / expected - 1.0
        });
        println!("{thickness}: {errors:.4?}");
        assert!(errors.iter().all(|error| error.abs() < 0.03), "{errors:?}");
        assert!(errors.is_sorted_by(|coarse, fine| fine.abs() <= coarse.abs()), "{errors:?}");
    }
}

/// Without the static state on twice as many cells, cells that may be too few give a warning: a soft slab
/// with an even pressure is accurate on few.
#[test]
fn a_soft_slab_on_a_ground_without_finer_cells_is_no_error() {
    let slab = Slab { side: 12.0, count: 8, thickness: 0.017_14, columns: vec![] };
    let lines: Vec<f64> = (0..=slab.count).map(|node| slab.place(node)).collect();
    let bed = SpringCells::between(&lines, &lines, BED_PROPERTIES);
    let builder = Simulation::builder(0.01).structure(slab.model().unwrap()).ground(bed);
    let mut simulation = builder.interface(Coulomb::new(0.5).unwrap()).build().unwrap();
    let warnings = simulation.run(1, |_| {}).unwrap().warnings;
    let has_warning = warnings.iter().any(|warning| {
        matches!(
            warning,
            Warning::CoarseBase { elements: 8, difference: None, axis: Some('x'), .. }
        )
    });
    assert!(has_warning, "{warnings:?}");
    let computed = -simulation.static_displacement()[slab.dof([4; 2])];
    let expected = slab.pressure() / BED_PROPERTIES.stiffness[0];
    assert!((computed / expected - 1.0).abs() < 0.01, "{computed} {expected}");
}

/// Boussinesq's function of a corner of a loaded rectangle.
fn corner_function(u: f64, v: f64) -> f64 {
    u * (v / u.abs()).asinh() + v * (u / v.abs()).asinh()
}

/// Settlement at a point by a uniform pressure on a square about the origin (Boussinesq), m.
fn settlement(soil: Soil, point: [f64; 2], side: f64, pressure: f64) -> f64 {
    let [x, y] = point.map(|place| [-0.5 * side - place, 0.5 * side - place]);
    let sum =
        corner_function(x[1], y[1]) - corner_function(x[0], y[1]) - corner_function(x[1], y[0])
            + corner_function(x[0], y[0]);
    pressure * (1.0 - soil.poisson()) / (std::f64::consts::TAU * soil.shear_modulus()) * sum
}

/// Soft plates, D/(G B³) of 1e-6 and 1e-7, with ten times their weight on the middle half: the four cells in the middle
/// sink as the soil under these two pressures does.
#[test]
fn soft_plates_sink_as_the_pressure_on_their_middle_does() {
    const PLATE_COUNT: usize = 8;
    const MEAN_WEIGHTS: [f64; 3] = [0.25, 0.5, 0.25];
    for thickness in [0.036_9, 0.017_14] {
        let mut slab = Slab { side: 12.0, count: PLATE_COUNT, thickness, columns: vec![] };
        for i in PLATE_COUNT / 4..3 * PLATE_COUNT / 4 {
            for corners in (PLATE_COUNT / 4..3 * PLATE_COUNT / 4).map(|j| plate_corners([i, j])) {
                slab.columns.extend(corners.map(|node| (node, 10.0 * slab.nodal_mass())));
            }
        }
        let displacement = slab.static_displacement();
        let mut computed = 0.0;
        for k in 0..9 {
            let node = [k % 3, k / 3].map(|step| PLATE_COUNT / 2 + step - 1);
            let weight = MEAN_WEIGHTS[k % 3] * MEAN_WEIGHTS[k / 3];
            computed -= weight * displacement[slab.dof(node)];
        }
        let mut expected = 0.0;
        for k in 0..64_u32 {
            let point = [k % 8, k / 8].map(|step| slab.pitch() * (0.25 * f64::from(step) - 0.875));
            expected += settlement(soil(), point, slab.side, slab.pressure()) / 64.0;
            let middle_pressure = 10.0 * slab.pressure();
            expected += settlement(soil(), point, 0.5 * slab.side, middle_pressure) / 64.0;
        }
        let error = computed / expected - 1.0;
        println!("{thickness}, {PLATE_COUNT} cells: {error:.5}");
        assert!(error.abs() < 5e-3, "{thickness}, {PLATE_COUNT} cells: {error}");
    }
}
