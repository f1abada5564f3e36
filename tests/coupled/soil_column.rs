//! GOAL: soil put back into its trench does not disturb the waves.
//! SCENE: a block of finite elements with the stiffness and density of the soil around it, under vertical shear waves.
//! REFERENCE: the free field; a block twice as dense, which must differ.

use basemat::bem::SharedKernels;
use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::fem::{Direction, Material, Mesh, Quad4, QuadFormulation};
use basemat::interface::{Coulomb, Mode};
use basemat::motion::Record;
use basemat::site::TrenchMotion;
use basemat::structure::{Base, BaseNode, FemModel, Structure, Triplets};
use basemat::{Result, Simulation, Soil, unobserved};

const HALF: f64 = 5.0;
const DEPTH: f64 = 5.0;
const SIDES: [usize; 2] = [6, 8];
const STEP: f64 = 0.003;
const STEPS: usize = 150;

/// A finite-element model that stands in a trench.
struct Block {
    model: FemModel,
    nodes: Vec<BaseNode>,
}

impl Block {
    fn new(material: Material) -> Result<Self> {
        let [across, up] = SIDES;
        let place = |row: usize, column: usize| {
            let [x, z] = [column as f64 / across as f64, row as f64 / up as f64];
            [HALF * (2.0 * x - 1.0), DEPTH * (z - 1.0), 0.0]
        };
        let mut mesh = Mesh::new();
        let grid = mesh.add_grid(up + 1, across + 1, place)?;
        for row in 0..up {
            for column in 0..across {
                let [low, high] = [grid.row(row), grid.row(row + 1)];
                let nodes = [low[column], low[column + 1], high[column + 1], high[column]];
                mesh.add(Quad4::new(nodes, material, QuadFormulation::default()))?;
            }
        }
        let side = |column: usize| (0..=up).map(move |row| (row, column));
        let left = side(0).skip(1).map(|(row, column)| grid.row(row)[column]);
        let mut outline: Vec<usize> = left.collect();
        outline.reverse();
        outline.extend(grid.row(0));
        outline.extend(side(across).skip(1).map(|(row, column)| grid.row(row)[column]));
        let model = FemModel::new(mesh, grid.row(0))?;
        let nodes = outline.into_iter().map(|node| {
            let [x, z, _] = model.mesh().nodes()[node];
            let horizontal = model.row(node, Direction::X)?;
            let vertical = model.row(node, Direction::Y)?;
            Ok(BaseNode { x, z, horizontal, vertical, ..BaseNode::default() })
        });
        let nodes = nodes.collect::<Result<_>>()?;
        Ok(Self { model, nodes })
    }
}

impl Structure for Block {
    fn dofs(&self) -> usize {
        self.model.dofs()
    }

    fn base(&self) -> Base {
        self.nodes.clone().into()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.model.mass(matrix)
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.model.stiffness(matrix)
    }
}

/// Largest difference between the top of the block and the surface over the largest displacement; all elements stuck.
fn difference(soil: Soil, density: f64, kernels: &SharedKernels) -> (f64, bool) {
    let young = 2.0 * soil.shear_modulus() * (1.0 + soil.poisson());
    let block = Block::new(Material::new(young, soil.poisson(), density).unwrap()).unwrap();
    let top = block.nodes[0].horizontal.clone();
    let elements = Trench::new(-HALF..HALF, DEPTH).unwrap().elements(4, 4).unwrap();
    let laws = elements.interfaces(Coulomb::new(0.8).unwrap(), Coulomb::new(0.8).unwrap());
    let ground = TrenchGround::new(soil, elements).unwrap().with_shared_kernels(kernels);
    // 0.1 g; ωd/c about 1.
    let second = |time: f64| {
        let square = (20.0 * (time - 0.2)).powi(2);
        (-6.0 + square * (24.0 - 8.0 * square)) * (-square).exp()
    };
    let record = Record::from_fn(0.002, 0.5, second).unwrap().scaled_to_peak(1.0).unwrap();
    let motion = TrenchMotion::new(&ground, record.clone(), &mut unobserved).unwrap();
    let mut simulation = Simulation::builder(STEP)
        .structure(block)
        .ground(ground)
        .interfaces(laws)
        .motion(motion)
        .expected_steps(STEPS)
        .build()
        .unwrap();
    let [mut apart, mut largest] = [0.0_f64; 2];
    let mut stuck = true;
    let run = simulation
        .run(STEPS, |state| {
            let surface = record.at(state.time).displacement;
            let found = top.value(state.absolute_displacement());
            apart = apart.max((found - surface).abs());
            largest = largest.max(surface.abs());
            stuck &= state.modes.iter().all(|mode| *mode == Mode::Stick);
        })
        .unwrap();
    assert!(run.energy_error < 1e-9);
    (apart / largest, stuck)
}

#[test]
fn soil_in_its_trench_moves_with_the_free_field() {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap();
    let kernels = SharedKernels::default();
    let [same, heavy] = [1.0, 2.0].map(|ratio| difference(soil, ratio * 1900.0, &kernels));
    println!("{same:?} {heavy:?}");
    assert!(same.0 < 0.004 && same.1, "{same:?}");
    assert!(heavy.0 > 0.1, "{heavy:?}");
}
