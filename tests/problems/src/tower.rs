//! A tower of 51 102 degrees of freedom on soil: the large model of the benchmark `reduced`.

use basemat::bem::{ElasticGround, Strip};
use basemat::coupled::{Coordinates, Probe};
use basemat::fem::{Direction, Layer, MassKind, Material, Mesh};
use basemat::interface::Coulomb;
use basemat::motion::el_centro_1940;
use basemat::structure::{
    Base, DofCombination, FemModel, MatrixModel, RayleighDamping, Structure, Triplets,
};
use basemat::{Result, Simulation, Soil};

pub const TIME_STEP: f64 = 0.01;

/// Matrices as another program would write them.
pub struct TowerMatrices {
    pub mass: Triplets,
    pub stiffness: Triplets,
    pub base: Base,
    /// Horizontal displacement of the tower's top.
    pub top: DofCombination,
}

impl TowerMatrices {
    /// A tower 10 m wide and 100 m high, of quadrilaterals of 0.2 m.
    pub fn new() -> Result<Self> {
        let material = Material::new(5.0e9, 0.2, 600.0)?;
        let mesh = Mesh::layered_block(-5.0..5.0, 50, &[Layer::new(100.0, 500, material)])?;
        let model = FemModel::on_base(mesh)?.with_mass(MassKind::Lumped);
        let mut mass = Triplets::new(model.dofs());
        let mut stiffness = Triplets::new(model.dofs());
        model.mass(&mut mass)?;
        model.stiffness(&mut stiffness)?;
        let top = model.row(model.mesh().node_at(0.0, 100.0)?, Direction::X)?;
        Ok(Self { mass, stiffness, base: model.base(), top })
    }
}

/// The structure of these matrices, 3 % of critical damping at 0.5 and 5 Hz.
pub fn damped(mass: Triplets, stiffness: Triplets, base: Base) -> Result<MatrixModel> {
    let damping = RayleighDamping::from_ratios([0.5, 5.0], [0.03; 2])?;
    Ok(MatrixModel::new(mass, stiffness, base)?.with_rayleigh(damping))
}

/// The structure on soil, with the displacement of its top as a probe, ready to march.
pub fn scene(
    structure: impl Structure + 'static,
    top: DofCombination,
    coordinates: Coordinates,
) -> Result<Simulation> {
    let soil = Soil::new(200.0e6, 0.33, 1900.0)?;
    Simulation::builder(TIME_STEP)
        .structure(structure)
        .ground(ElasticGround::new(soil, Strip::uniform(-5.0..5.0, 20)?)?)
        .interface(Coulomb::new(0.5)?)
        .motion(el_centro_1940())
        .probe(Probe::absolute_displacement("top", top))
        .coordinates(coordinates)
        .expected_steps(3000)
        .build()
}
