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

const BLOCK_HALF_WIDTH: f64 = 5.0;
const BLOCK_DEPTH: f64 = 5.0;
const MESH_COLUMNS: usize = 6;
const MESH_ROWS: usize = 8;
const TIME_STEP: f64 = 0.003;
const RUN_STEPS: usize = 150;

/// A block of solids whose base is its outline in a trench.
struct SolidBlock {
    model: FemModel,
    nodes: Vec<BaseNode>,
}

impl SolidBlock {
    fn new(material: Material) -> Result<Self> {
        let mut mesh = Mesh::new();
        let grid = mesh.add_grid(MESH_ROWS + 1, MESH_COLUMNS + 1, |row, column| {
            let x = column as f64 / MESH_COLUMNS as f64;
            let z = row as f64 / MESH_ROWS as f64;
            [BLOCK_HALF_WIDTH * (2.0 * x - 1.0), BLOCK_DEPTH * (z - 1.0), 0.0]
        })?;
        for row in 0..MESH_ROWS {
            for column in 0..MESH_COLUMNS {
                let lower = grid.row(row);
                let upper = grid.row(row + 1);
                let nodes = [lower[column], lower[column + 1], upper[column + 1], upper[column]];
                mesh.add(Quad4::new(nodes, material, QuadFormulation::default()))?;
            }
        }
        let mut outline: Vec<usize> = (1..=MESH_ROWS).rev().map(|row| grid.row(row)[0]).collect();
        outline.extend(grid.row(0));
        outline.extend((1..=MESH_ROWS).map(|row| grid.row(row)[MESH_COLUMNS]));
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

impl Structure for SolidBlock {
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

/// Motion of a block in a trench beside the free field.
#[derive(Debug)]
struct BlockMotion {
    /// Largest difference between the top of the block and the surface over the largest displacement.
    difference: f64,
    always_stuck: bool,
}

/// Runs a block with the stiffness of the soil and this density.
fn block_motion(soil: Soil, density: f64, kernels: &SharedKernels) -> BlockMotion {
    let young = 2.0 * soil.shear_modulus() * (1.0 + soil.poisson());
    let block = SolidBlock::new(Material::new(young, soil.poisson(), density).unwrap()).unwrap();
    let top = block.nodes[0].horizontal.clone();
    let trench = Trench::new(-BLOCK_HALF_WIDTH..BLOCK_HALF_WIDTH, BLOCK_DEPTH).unwrap();
    let elements = trench.elements(4, 4).unwrap();
    let laws = elements.interfaces(Coulomb::new(0.8).unwrap(), Coulomb::new(0.8).unwrap());
    let ground = TrenchGround::new(soil, elements).unwrap().with_shared_kernels(kernels);
    // A pulse of 0.1 g with ωd/c of about 1.
    let pulse = Record::from_fn(0.002, 0.5, |time: f64| {
        let square = (20.0 * (time - 0.2)).powi(2);
        (-6.0 + square * (24.0 - 8.0 * square)) * (-square).exp()
    });
    let record = pulse.unwrap().scaled_to_peak(1.0).unwrap();
    let motion = TrenchMotion::new(&ground, record.clone(), &mut unobserved).unwrap();
    let mut simulation = Simulation::builder(TIME_STEP)
        .structure(block)
        .ground(ground)
        .interfaces(laws)
        .motion(motion)
        .expected_steps(RUN_STEPS)
        .build()
        .unwrap();
    let mut difference = 0.0_f64;
    let mut max_magnitude = 0.0_f64;
    let mut always_stuck = true;
    let run = simulation
        .run(RUN_STEPS, |state| {
            let surface = record.at(state.time).displacement;
            let computed = top.value(state.absolute_displacement());
            difference = difference.max((computed - surface).abs());
            max_magnitude = max_magnitude.max(surface.abs());
            always_stuck &= state.modes.iter().all(|mode| *mode == Mode::Stick);
        })
        .unwrap();
    assert!(run.energy_error < 1e-9);
    BlockMotion { difference: difference / max_magnitude, always_stuck }
}

#[test]
fn soil_in_its_trench_moves_with_the_free_field() {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap();
    let kernels = SharedKernels::default();
    let soil_block = block_motion(soil, 1900.0, &kernels);
    let heavy_block = block_motion(soil, 2.0 * 1900.0, &kernels);
    println!("{soil_block:?} {heavy_block:?}");
    assert!(soil_block.difference < 0.004 && soil_block.always_stuck, "{soil_block:?}");
    assert!(heavy_block.difference > 0.1, "{heavy_block:?}");
}
