//! GOAL: section forces.
//! SCENE: a frame on a block, under a static load and in any motion.
//! REFERENCE: the free body above the section as a separate model.

use basemat::fem::{
    Beam, Dashpot, Direction, Layer, LumpedMass, Material, Mesh, Quad4, QuadFormulation,
};
use basemat::structure::{FemModel, RayleighDamping, Structure};
use basemat_problems::dense::{
    damping, dot, form, mass, multiply, noise, solve_with_prescribed, stiffness,
};

/// Height of the section, m.
const CUT_HEIGHT: f64 = 2.0;

/// A frame on a block, and everything above the section as a separate model.
struct CutFrame {
    whole: FemModel,
    upper: FemModel,
}

fn frame_on_block() -> CutFrame {
    let concrete = Material::new(2.0e8, 0.2, 2400.0).unwrap();
    let layers = [Layer::new(CUT_HEIGHT, 2, concrete), Layer::new(3.0, 3, concrete)];
    let models = [Mesh::layered_block(-1.0..3.0, 2, &layers), {
        let mut mesh = Mesh::new();
        let block = Mesh::layered_block(-1.0..3.0, 2, &layers[1..]).unwrap();
        for [x, y, _] in block.nodes() {
            mesh.add_node(*x, y + CUT_HEIGHT).unwrap();
        }
        for element in block.elements() {
            let nodes: [usize; 4] = element.nodes().try_into().unwrap();
            mesh.add(Quad4::new(nodes, concrete, QuadFormulation::default())).unwrap();
        }
        Ok(mesh)
    }];
    let [whole, upper] = models.map(|mesh| {
        let mut mesh = mesh.unwrap();
        let roof = mesh.node_at(1.0, 5.0).unwrap();
        let foot = mesh.node_at(3.0, CUT_HEIGHT).unwrap();
        let top = mesh.add_node(3.5, 6.0).unwrap();
        // The second beam stands on the cut itself: its foot's moment passes through, too.
        for nodes in [[roof, top], [foot, top]] {
            mesh.add(Beam::new(nodes, 2.0e8, 0.5, 0.02, 2400.0).unwrap()).unwrap();
        }
        mesh.add(LumpedMass::new(top, 3000.0).unwrap().with_rotary_inertia(500.0).unwrap())
            .unwrap();
        mesh.add(Dashpot::axial([foot, roof], 6.0e4).unwrap()).unwrap();
        let base_height = mesh.nodes().iter().map(|node| node[1]).fold(f64::INFINITY, f64::min);
        let base = mesh.nodes_at_height(base_height, 1e-9).unwrap();
        let model = FemModel::new(mesh, &base).unwrap();
        model.with_rayleigh(RayleighDamping::new(0.0, 0.003).unwrap())
    });
    CutFrame { whole, upper }
}

/// Static: load at the top, base fixed; the section passes on exactly that load and its moment.
#[test]
fn static_load_passes_through_every_section() {
    let model = frame_on_block().whole;
    let top = model.mesh().node_at(3.5, 6.0).unwrap();
    let mut load = vec![0.0; model.dofs()];
    load[model.dof(top, Direction::X).unwrap()] = 700.0;
    load[model.dof(top, Direction::Y).unwrap()] = -300.0;
    load[model.dof(top, Direction::Rotation).unwrap()] = 50.0;
    let fixed: Vec<(usize, f64)> = (0..6).map(|index| (index, 0.0)).collect();
    let u = solve_with_prescribed(&stiffness(&model), &load, &fixed);
    for height in [0.0, 1.0, CUT_HEIGHT] {
        let section = model.section(height, 1.0).unwrap();
        let shear = section.shear.value(&u, &[], &[]);
        assert!((shear - 700.0).abs() < 1e-6);
        let compression = section.compression.value(&u, &[], &[]);
        assert!((compression - 300.0).abs() < 1e-6);
        let expected = -300.0 * (3.5 - 1.0) - 700.0 * (6.0 - height) + 50.0;
        let moment = section.moment.value(&u, &[], &[]);
        assert!((moment - expected).abs() < 1e-5);
    }
}

/// Any motion: force on the nodes above, less the rate of momentum of the upper part,
/// is what the section passes on.
#[test]
fn moving_structure_keeps_the_balance_of_its_upper_part() {
    let CutFrame { whole: model, upper } = frame_on_block();
    let n = model.dofs();
    let first = model.mesh().node_at(-1.0, CUT_HEIGHT).unwrap();
    assert_eq!(model.dofs() - upper.dofs(), 2 * first);
    let [u, v, a] = [1, 2, 3].map(|seed| noise(n, seed));
    let force: Vec<f64> = multiply(&stiffness(&model), &u)
        .iter()
        .zip(multiply(&damping(&model), &v))
        .zip(multiply(&mass(&model), &a))
        .map(|((k, c), m)| k + c + m)
        .collect();
    // The upper model's nodes are the full model's from the cut upwards.
    let skip = 2 * first;
    let mut on_upper = force[skip..].to_vec();
    for node in 0..3 {
        for direction in [Direction::X, Direction::Y, Direction::Rotation] {
            if let Some(index) = upper.dof(node, direction) {
                on_upper[index] = 0.0;
            }
        }
    }
    let section = model.section(CUT_HEIGHT, 0.3).unwrap();
    let inertia = mass(&upper);
    for (rows, direction, sign) in [
        (&section.shear, Direction::X, 1.0),
        (&section.compression, Direction::Y, -1.0),
        (&section.moment, Direction::Rotation, 1.0),
    ] {
        let motion = upper.rigid_motion(direction, [0.3, CUT_HEIGHT, 0.0]);
        let balance = dot(&motion, &on_upper) - form(&motion, &inertia, &a[skip..]);
        let computed = rows.value(&u, &v, &a);
        assert!(
            (computed - sign * balance).abs() < 1e-11 * 2.0e8,
            "{direction:?} {computed} {balance}"
        );
        assert!(computed.abs() > 1e3, "the balance is not an empty one");
    }
}

#[test]
fn section_needs_a_row_of_nodes_with_elements_above() {
    let model = frame_on_block().whole;
    for (height, reference) in
        [(0.5, 0.0), (3.0, 0.0), (6.0, 0.0), (9.0, 0.0), (f64::NAN, 0.0), (0.0, f64::INFINITY)]
    {
        assert!(model.section(height, reference).is_err(), "{height}");
    }
}
