//! GOAL: a plane frame of fibres in space, shaken in its plane, moves as the frame in the plane.
//! SCENE: a portal that yields on a rigid mat, bonded or free to lift off and slide.
//! REFERENCE: the portal in the plane, per metre.

use basemat::bem::SpringGround;
use basemat::coupled::Probe;
use basemat::fem::{
    Beam, BeamFormulation, BeamQuadrature, BeamSection, BilinearSteel, Direction, FiberBeam,
    FiberSection, LumpedMass, Material, Mesh, SpaceBeam, SpaceFiberBeam,
};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw};
use basemat::motion::{Triaxial, el_centro_1940};
use basemat::structure::{FemModel, RayleighDamping};
use basemat::{Result, Simulation};

use super::compare::relative_difference;
use super::tally::IdentityTally;

/// Mass per length of the columns, kg/m.
const COLUMN_MASS: f64 = 200.0;
/// Length of the mat of the frame, and the width of a frame in space, m.
const MAT_SIDES: [f64; 2] = [4.0, 1.0];
/// Height of the frame, m.
const FRAME_HEIGHT: f64 = 3.0;
/// Steps of the frame's run.
const FRAME_STEPS: usize = 600;

/// A portal on a rigid mat, in the plane per metre, or in space with a mat one metre wide.
struct FiberPortal {
    in_space: bool,
    formulation: BeamFormulation,
}

impl FiberPortal {
    /// A node at a place along and above the mat.
    fn node(&self, mesh: &mut Mesh, x: f64, y: f64, up: f64) -> Result<usize> {
        if self.in_space { mesh.add_node_at([x, y, up]) } else { mesh.add_node(x, up) }
    }

    fn add_mass(&self, mesh: &mut Mesh, node: usize, mass: f64) -> Result<()> {
        let mass = if self.in_space {
            LumpedMass::in_space(node, mass, [0.0; 3])?
        } else {
            LumpedMass::new(node, mass)?
        };
        mesh.add(mass).map(drop)
    }

    fn add_column(&self, mesh: &mut Mesh, ends: [usize; 2]) -> Result<()> {
        let steel = BilinearSteel::new(355.0e6, 210.0e9, 0.01)?;
        let section = FiberSection::new()
            .with_rectangle([[-0.06, -0.05], [0.06, 0.05]], [8, 4], steel)?
            .with_fiber([0.08, 0.0], 4e-4, steel)?
            .with_torsional_stiffness(1.7e6)?;
        let quadrature = BeamQuadrature::Lobatto(5);
        if self.in_space {
            let orientation = [-1.0, 0.0, 0.0];
            let beam = SpaceFiberBeam::new(ends, &section, quadrature, COLUMN_MASS, orientation)?;
            mesh.add(beam.with_formulation(self.formulation)).map(drop)
        } else {
            let beam = FiberBeam::new(ends, &section, quadrature, COLUMN_MASS)?;
            mesh.add(beam.with_formulation(self.formulation)).map(drop)
        }
    }

    fn add_girder(&self, mesh: &mut Mesh, ends: [usize; 2]) -> Result<()> {
        let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
        if self.in_space {
            let section = BeamSection::new(0.09, [6.75e-4; 2], 1.1e-3)?;
            mesh.add(SpaceBeam::new(ends, concrete, section, [0.0, 0.0, 1.0])?).map(drop)
        } else {
            mesh.add(Beam::new(ends, 30.0e9, 0.09, 6.75e-4, 2500.0)?).map(drop)
        }
    }

    /// The model, and the node at the top of its right column.
    fn model(&self) -> Result<(FemModel, usize)> {
        let mut mesh = if self.in_space { Mesh::in_space() } else { Mesh::new() };
        let corners: &[[f64; 2]] = if self.in_space {
            &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        } else {
            &[[-1.0, 0.0], [1.0, 0.0]]
        };
        let mut contact_nodes = Vec::new();
        for [x, y] in corners {
            let node = self.node(&mut mesh, 0.5 * x * MAT_SIDES[0], 0.5 * y * MAT_SIDES[1], 0.0)?;
            self.add_mass(&mut mesh, node, 8.0e3 / corners.len() as f64)?;
            contact_nodes.push(node);
        }
        let mut feet = Vec::new();
        let mut tops = Vec::new();
        for (x, mass) in [(-1.2, 6.0e3), (1.2, 7.0e3)] {
            let foot = self.node(&mut mesh, x, 0.0, 0.3)?;
            feet.push(foot);
            let mut below = foot;
            for up in [0.2 * FRAME_HEIGHT, FRAME_HEIGHT] {
                let above = self.node(&mut mesh, x, 0.0, 0.3 + up)?;
                self.add_column(&mut mesh, [below, above])?;
                below = above;
            }
            self.add_mass(&mut mesh, below, mass)?;
            tops.push(below);
        }
        self.add_girder(&mut mesh, [tops[0], tops[1]])?;
        let model = if self.in_space {
            FemModel::on_faces(mesh, &[contact_nodes.clone()])?
        } else {
            FemModel::new(mesh, &contact_nodes)?
        };
        let model = model.with_rigid_link(feet[0], &[&contact_nodes[..], &feet[1..]].concat())?;
        let model = model.with_rayleigh(RayleighDamping::new(0.0, 5e-4)?);
        Ok((model.with_p_delta(9.81)?, tops[1]))
    }

    /// Displacements of the top, and the terms of the energy balance, of a run.
    fn run(&self, law: impl InterfaceLaw + 'static) -> Result<[Vec<f64>; 2]> {
        let (model, top) = self.model()?;
        let count = if self.in_space { 2 } else { 8 };
        let ground = SpringGround::under(&model, count, 8.0e7, 6.0e7)?;
        let up = if self.in_space { Direction::Z } else { Direction::Y };
        let mut builder = Simulation::builder(0.005).ground(ground.with_dashpots(3e5, 2e5)?);
        for (name, direction) in [("along", Direction::X), ("up", up)] {
            builder = builder.probe(Probe::displacement(name, model.row(top, direction)?));
        }
        let record = el_centro_1940().scaled(4.0)?;
        let builder = builder.structure(model).interface(law);
        let mut simulation = if self.in_space {
            builder.motion(Triaxial { x: Some(record), y: None, up: None }).build()?
        } else {
            builder.motion(record).build()?
        };
        let mut displacements = Vec::new();
        let run =
            simulation.run(FRAME_STEPS, |state| displacements.extend(state.probes.clone()))?;
        let balance = run.energy_balance;
        Ok([displacements, vec![balance.input, balance.hysteresis, balance.midstep_remainder]])
    }
}

/// GOAL: a frame of fibres in space, shaken in its plane, moves as the frame in the plane.
#[test]
fn plane_frames_of_fibres_in_space() {
    let mut tally = IdentityTally::new("plane frames of fibres in space");
    for (formulation, word) in [
        (BeamFormulation::DisplacementBased, "by displacements"),
        (BeamFormulation::ForceBased, "by forces"),
    ] {
        for friction in [None, Some(0.5)] {
            let results = [false, true].map(|in_space| {
                let portal = FiberPortal { in_space, formulation };
                match friction {
                    None => portal.run(Bonded),
                    Some(friction) => portal.run(Coulomb::new(friction)?),
                }
            });
            let law = if friction.is_some() { "Coulomb" } else { "bonded" };
            tally.scene(&["plane frame", word, law]);
            let place = format!("{word}, {law}");
            tally.compare(&place, results, |tally, expected, computed| {
                let hysteresis = expected[1][1] / expected[1][0];
                assert!(hysteresis > 0.02, "{place}: {hysteresis}");
                for (k, name) in ["displacements", "energies"].into_iter().enumerate() {
                    let difference = relative_difference(&expected[k], &computed[k]);
                    tally.within(&format!("{name}, {place}"), difference, 1e-9);
                }
            });
        }
    }
    tally.close(1.0);
}
