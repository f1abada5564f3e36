//! A table on four inclined columns in space, on a square rigid footing.

use basemat::Result;
use basemat::fem::{
    BeamFormulation, BeamQuadrature, BeamSection, BilinearSteel, FiberSection, LumpedMass,
    Material, Mesh, SpaceBeam, SpaceFiberBeam,
};
use basemat::motion::{Triaxial, el_centro_1940};
use basemat::structure::{FemModel, RayleighDamping};

/// Height of the table, m.
const TABLE_HEIGHT: f64 = 3.0;
/// Mass per length of a column, kg/m.
const COLUMN_MASS: f64 = 100.0;
/// Direction of the columns' y axes from x in plan, rad.
const COLUMN_ORIENTATION: f64 = 0.45;
/// Peaks of the shaking along x and y, times those of El Centro.
const SHAKING_FACTORS: [f64; 2] = [2.0, 1.2];

/// Material of the columns of a table.
#[derive(Debug, Clone)]
pub enum TableColumns {
    Linear { material: Material, section: BeamSection },
    Fibers { section: FiberSection, formulation: BeamFormulation },
}

/// A table whose columns are divided into elements, turned about the vertical.
#[derive(Debug, Clone)]
pub struct FiberTable {
    pub columns: TableColumns,
    /// Lengths of the elements of a column, relative to that of the column.
    pub parts: Vec<f64>,
    /// Angle about the vertical, rad.
    pub angle: f64,
}

/// A model and the nodes at the corners of its plate.
#[derive(Debug)]
pub struct TableModel {
    pub model: FemModel,
    pub tops: [usize; 4],
}

/// A horizontal vector turned counter-clockwise.
pub fn turned(angle: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    [angle.cos() * x - angle.sin() * y, angle.sin() * x + angle.cos() * y]
}

/// Rectangle of steel without shear deformation, 0.12 m along y and 0.1 m along z, with this hardening.
pub fn steel_section(hardening_ratio: f64) -> Result<FiberSection> {
    let steel = BilinearSteel::new(355.0e6, 210.0e9, hardening_ratio)?;
    FiberSection::new()
        .with_rectangle([[-0.06, -0.05], [0.06, 0.05]], [8, 6], steel)?
        .with_torsional_stiffness(1.7e6)
}

impl FiberTable {
    /// Columns of steel, of one element by forces or four by displacements.
    pub fn of_steel(formulation: BeamFormulation) -> Result<Self> {
        let columns = TableColumns::Fibers { section: steel_section(0.01)?, formulation };
        let parts = match formulation {
            BeamFormulation::ForceBased => vec![1.0],
            _ => vec![0.1, 0.4, 0.4, 0.1],
        };
        Ok(Self { columns, parts, angle: 0.0 })
    }

    fn add_column(&self, mesh: &mut Mesh, ends: [usize; 2]) -> Result<()> {
        let y_axis = turned(self.angle, [COLUMN_ORIENTATION.cos(), COLUMN_ORIENTATION.sin()]);
        let orientation = [y_axis[0], y_axis[1], 0.1];
        match &self.columns {
            TableColumns::Linear { material, section } => {
                mesh.add(SpaceBeam::new(ends, *material, *section, orientation)?)
            }
            TableColumns::Fibers { section, formulation } => {
                let quadrature = BeamQuadrature::Lobatto(5);
                let beam =
                    SpaceFiberBeam::new(ends, section, quadrature, COLUMN_MASS, orientation)?;
                mesh.add(beam.with_formulation(*formulation))
            }
        }
        .map(drop)
    }

    /// The table on a face of the ground, with a rigid footing.
    pub fn model(&self) -> Result<TableModel> {
        let mut mesh = Mesh::in_space();
        let place = |x: f64, y: f64, z: f64| {
            let point = turned(self.angle, [x, y]);
            [point[0], point[1], z]
        };
        let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let leader = mesh.add_node_at([0.0, 0.0, 0.4])?;
        mesh.add(LumpedMass::in_space(leader, 20.0e3, [2.0e4, 2.0e4, 4.0e4])?)?;
        let mut corners = Vec::new();
        let mut feet = Vec::new();
        let mut tops = [0; 4];
        for (k, [x, y]) in signs.into_iter().enumerate() {
            let corner = mesh.add_node_at(place(2.0 * x, 2.0 * y, 0.0))?;
            mesh.add(LumpedMass::in_space(corner, 500.0, [1.0; 3])?)?;
            corners.push(corner);
            let foot = mesh.add_node_at(place(x, y, 0.4))?;
            feet.push(foot);
            let mut below = foot;
            let mut s = 0.0;
            for part in &self.parts {
                s += part;
                let distance = 1.0 - 0.1 * s;
                let above =
                    mesh.add_node_at(place(distance * x, distance * y, 0.4 + TABLE_HEIGHT * s))?;
                self.add_column(&mut mesh, [below, above])?;
                below = above;
            }
            tops[k] = below;
            let mass = 7.0e3 + 600.0 * k as f64;
            mesh.add(LumpedMass::in_space(below, mass, [0.0; 3])?)?;
        }
        let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
        let section = BeamSection::new(0.09, [6.75e-4; 2], 1.1e-3)?;
        for k in 0..4 {
            let ends = [tops[k], tops[(k + 1) % 4]];
            mesh.add(SpaceBeam::new(ends, concrete, section, [0.0, 0.0, 1.0])?)?;
        }
        let followers = [corners.clone(), feet].concat();
        let model = FemModel::on_faces(mesh, &[corners])?.with_rigid_link(leader, &followers)?;
        let model = model.with_rayleigh(RayleighDamping::new(0.0, 5e-4)?);
        Ok(TableModel { model, tops })
    }

    /// El Centro along both axes of the table.
    pub fn motion(&self, factor: f64) -> Result<Triaxial> {
        let factors = turned(self.angle, SHAKING_FACTORS);
        Ok(Triaxial {
            x: Some(el_centro_1940().scaled(factor * factors[0])?),
            y: Some(el_centro_1940().scaled(factor * factors[1])?),
            up: None,
        })
    }
}
