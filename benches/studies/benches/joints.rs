//! Time of steps of a building with a joint, beside the building without one on as many more base elements.

use std::hint::black_box;

use basemat::bem::ElasticGround;
use basemat::coupled::Joint;
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::Coulomb;
use basemat::motion::el_centro_1940;
use basemat::structure::{FemModel, StructureGroup};
use basemat::{Result, Simulation, Soil};
use criterion::{Criterion, criterion_group, criterion_main};

const WALL_WIDTH: f64 = 8.0;
const BASE_ELEMENTS: usize = 16;
const JOINT_ELEMENTS: usize = 16;
const STEP_COUNT: usize = 1_000;

/// A wall of this height on a mesh of 16 elements along its width.
fn wall(height: f64, rows: usize) -> Result<FemModel> {
    let concrete = Material::new(30.0e9, 0.2, 2400.0)?;
    let half_width = 0.5 * WALL_WIDTH;
    let layers = [Layer::new(height, rows, concrete)];
    FemModel::on_base(Mesh::layered_block(-half_width..half_width, JOINT_ELEMENTS, &layers)?)
}

/// Nodes of a wall at a height, from left to right.
fn nodes_at(model: &FemModel, height: f64) -> Result<Vec<usize>> {
    (0..=JOINT_ELEMENTS)
        .map(|k| {
            let fraction = k as f64 / JOINT_ELEMENTS as f64;
            model.mesh().node_at(WALL_WIDTH * (fraction - 0.5), height)
        })
        .collect()
}

/// The wall with a joint at half its height, or whole on more base elements.
fn scene(has_joint: bool) -> Result<Simulation> {
    let soil = Soil::new(80.0e6, 1.0 / 3.0, 1900.0)?;
    let law = Coulomb::new(0.5)?;
    let builder = Simulation::builder(0.005).interface(law).motion(el_centro_1940());
    if !has_joint {
        let whole_wall = wall(12.0, 12)?;
        let ground = ElasticGround::under(soil, &whole_wall, BASE_ELEMENTS + JOINT_ELEMENTS)?;
        return builder.ground(ground).structure(whole_wall).build();
    }
    let lower = wall(6.0, 6)?;
    let upper = wall(6.0, 6)?;
    let top = lower.contact_nodes(&nodes_at(&lower, 6.0)?)?;
    let bottom = upper.contact_nodes(&nodes_at(&upper, 0.0)?)?;
    let group = StructureGroup::new().with(lower, 0.0)?.with_above(upper, [0.0, 6.0])?;
    let upper_nodes = group.contact_nodes(1, bottom)?;
    let joint = Joint::between(upper_nodes, group.contact_nodes(0, top)?, JOINT_ELEMENTS)?;
    let ground = ElasticGround::under(soil, &group, BASE_ELEMENTS)?;
    builder.ground(ground).structure(group).joint(joint.with_law(law)).build()
}

fn steps(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("1000 steps of a wall");
    group.sample_size(10);
    for (name, has_joint) in
        [("16 + 16 base elements", false), ("16 base, 16 joint elements", true)]
    {
        group.bench_function(name, |bencher| {
            bencher.iter_batched(
                || scene(has_joint).expect("a valid scene"),
                |mut simulation| black_box(simulation.run(STEP_COUNT, |_| {}).expect("every step")),
                criterion::BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, steps);
criterion_main!(benches);
