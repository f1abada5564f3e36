//! Random masts, portals and blocks with P–Δ, and their ground.

use basemat::Soil;
use basemat::bem::{ElasticGround, Ground, SpringGround};
use basemat::fem::{Beam, BeamSection, Direction, LumpedMass, Material, Mesh, SpaceBeam};
use basemat::structure::{FemModel, RigidBlock, Structure};
use basemat_problems::random::Random;

pub(super) const GRAVITY_ACCELERATION: f64 = 9.81;

/// A mast in the plane on a rigid base: flexible, with a mass on its top beside its axis.
fn mast(random: &mut Random, offset: f64) -> FemModel {
    let width = random.within(2.0, 8.0);
    let height = random.log_within(4.0, 40.0);
    let inertia = random.log_within(0.02, 2.0);
    let mut mesh = Mesh::new();
    let count = random.pick(&[2, 3, 5]);
    let nodes: Vec<usize> = (0..=count)
        .map(|k| {
            let fraction = k as f64 / count as f64;
            mesh.add_node(offset * fraction * width, height * fraction).unwrap()
        })
        .collect();
    for pair in nodes.windows(2) {
        mesh.add(Beam::new([pair[0], pair[1]], 30e9, 0.5, inertia, 2500.0).unwrap()).unwrap();
    }
    mesh.add(LumpedMass::new(nodes[count], random.log_within(10e3, 500e3)).unwrap())
        .unwrap();
    on_rigid_base(mesh, nodes[0], width)
}

/// Two columns and a beam on a rigid base.
fn portal(random: &mut Random, offset: f64) -> FemModel {
    let width = random.within(3.0, 8.0);
    let height = random.log_within(4.0, 25.0);
    let mut mesh = Mesh::new();
    let center = mesh.add_node(0.0, 0.0).unwrap();
    let half = 0.3 * width;
    let feet = [-half, half].map(|x| mesh.add_node(x, 0.0).unwrap());
    let lateral_offset = 0.5 * offset * width;
    let tops = [-half, half].map(|x| mesh.add_node(x + lateral_offset, height).unwrap());
    for (k, column) in feet.into_iter().zip(tops).enumerate() {
        let inertia = random.log_within(0.005, 0.2);
        mesh.add(Beam::new(column.into(), 30e9, 0.3, inertia, 2500.0).unwrap()).unwrap();
        let mass = random.log_within(10e3, 200e3) * if k == 0 { 1.0 } else { 1.0 + offset };
        mesh.add(LumpedMass::new(tops[k], mass).unwrap()).unwrap();
    }
    mesh.add(Beam::new(tops, 30e9, 0.2, 0.01, 2500.0).unwrap()).unwrap();
    for foot in feet {
        mesh.add(Beam::new([center, foot], 30e9, 2.0, 2.0, 2500.0).unwrap()).unwrap();
    }
    on_rigid_base(mesh, center, width)
}

/// Ends of a rigid base around `center`, with its mass.
fn on_rigid_base(mut mesh: Mesh, center: usize, width: f64) -> FemModel {
    let ends = [-0.5, 0.5].map(|side| {
        let end = mesh.add_node(side * width, 0.0).unwrap();
        mesh.add(LumpedMass::new(end, 2e3 * width).unwrap()).unwrap();
        end
    });
    FemModel::new(mesh, &ends).unwrap().with_rigid_link(center, &ends).unwrap()
}

/// A mast in space on a rigid rectangle.
fn mast_in_space(random: &mut Random, offset: f64) -> FemModel {
    let sides = [random.within(2.0, 8.0), random.within(2.0, 8.0)];
    let height = random.log_within(4.0, 40.0);
    let mut mesh = Mesh::in_space();
    let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(|[x, y]| {
        let corner = mesh.add_node_at([x * sides[0], y * sides[1], 0.0]).unwrap();
        mesh.add(LumpedMass::in_space(corner, 5e3, [1.0; 3]).unwrap()).unwrap();
        corner
    });
    let concrete = Material::new(30e9, 0.2, 2500.0).unwrap();
    let inertias = [0, 1].map(|_| random.log_within(0.05, 5.0));
    let section = BeamSection::new(2.0, inertias, 1.0).unwrap();
    let lateral_offset = [offset * sides[0], random.within(-1.0, 1.0) * offset * sides[1]];
    let nodes: Vec<usize> = (0..=3)
        .map(|k| {
            let fraction = f64::from(k) / 3.0;
            mesh.add_node_at([
                lateral_offset[0] * fraction,
                lateral_offset[1] * fraction,
                height * fraction,
            ])
            .unwrap()
        })
        .collect();
    for pair in nodes.windows(2) {
        let beam = SpaceBeam::new([pair[0], pair[1]], concrete, section, [1.0, 0.0, 0.0]).unwrap();
        mesh.add(beam).unwrap();
    }
    let top_mass = random.log_within(50e3, 3e6);
    mesh.add(LumpedMass::in_space(nodes[3], top_mass, [1e3; 3]).unwrap()).unwrap();
    let model = FemModel::on_faces(mesh, &[corners.to_vec()]).unwrap();
    model.with_rigid_link(nodes[0], &corners).unwrap()
}

/// A structure with P–Δ, its ground, and whether its interface is bonded.
pub(super) struct RandomScene {
    pub(super) structure: Box<dyn Structure>,
    pub(super) vertical_translation: Vec<f64>,
    pub(super) ground: Box<dyn Ground>,
    pub(super) is_bonded: bool,
}

/// A structure with P–Δ and its vertical translation; `None` if it buckles on a fixed base.
fn with_p_delta(model: FemModel, upwards: Direction) -> Option<(Box<dyn Structure>, Vec<f64>)> {
    let model = model.with_p_delta(GRAVITY_ACCELERATION).ok()?;
    let vertical_translation = model.rigid_motion(upwards, [0.0; 3]);
    Some((Box::new(model), vertical_translation))
}

/// A random scene; `None` if the structure buckles on a fixed base.
pub(super) fn random_scene(number: usize) -> Option<RandomScene> {
    let mut random = Random(500 + number as u64);
    let kind = random.pick(&[0, 0, 1, 2, 3]);
    let offset = if random.chance(0.4) { 0.0 } else { random.log_within(1e-3, 0.4) };
    let (structure, vertical_translation) = match kind {
        0 => with_p_delta(mast(&mut random, offset), Direction::Y)?,
        1 => with_p_delta(portal(&mut random, offset), Direction::Y)?,
        2 => {
            let width = random.within(1.0, 5.0);
            let height = random.within(4.0, 40.0);
            let block = RigidBlock::new(width, height, random.log_within(300.0, 3000.0)).unwrap();
            let block: Box<dyn Structure> =
                Box::new(block.with_p_delta(GRAVITY_ACCELERATION).unwrap());
            (block, vec![0.0, 1.0, 0.0])
        }
        _ => with_p_delta(mast_in_space(&mut random, offset), Direction::Z)?,
    };
    let count = if kind == 3 { random.pick(&[3, 4]) } else { random.pick(&[6, 10]) };
    let speed = random.log_within(30.0, 250.0);
    let soil = Soil::from_shear_wave_speed(speed, 0.3, 1800.0).unwrap();
    let ground: Box<dyn Ground> = if random.chance(0.6) {
        Box::new(ElasticGround::under(soil, structure.as_ref(), count).unwrap())
    } else {
        let bedding = 0.5 * speed * speed * 1800.0;
        Box::new(SpringGround::under(structure.as_ref(), count, bedding, 0.7 * bedding).unwrap())
    };
    Some(RandomScene { structure, vertical_translation, ground, is_bonded: random.chance(0.2) })
}
