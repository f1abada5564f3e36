//! GOAL: six resultants across a cut in space.
//! SCENE: a column on a rigid pedestal, bricks in any motion, floors in plan.
//! REFERENCE: statics by hand, and momenta of the part above from the matrices of separate models.

use basemat::Error;
use basemat::fem::{BeamSection, Dashpot, Hex8, LumpedMass, Material, Mesh, Shell, SpaceBeam};
use basemat::structure::{
    FemModel, PlanStorey, RayleighDamping, RigidBody, SectionRows, SpaceSection, StoreyBuilding,
    Structure,
};
use basemat_problems::dense::{
    damping, dot, form, mass, multiply, noise, solve_with_prescribed, stiffness,
};
use basemat_problems::supported::CLAMPED_DIRECTIONS as DIRECTIONS;

/// Forces and moments along the six directions; the compression acts downwards.
fn rows(section: &SpaceSection) -> [(&SectionRows, f64); 6] {
    [
        (&section.shear[0], 1.0),
        (&section.shear[1], 1.0),
        (&section.compression, -1.0),
        (&section.moments[0], 1.0),
        (&section.moments[1], 1.0),
        (&section.torque, 1.0),
    ]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A column from 1 m to 5 m over a corner of a mat, on a rigid pedestal, with a rigid arm to a mass at its top.
/// Every section passes on the load of the mass, also the one below the pedestal.
#[test]
fn static_load_passes_through_every_section() {
    let concrete = Material::new(3.0e8, 0.2, 0.0).unwrap();
    let mut mesh = Mesh::in_space();
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    let mat = corners.map(|[x, y]| mesh.add_node_at([x, y, 0.0]).unwrap());
    let head = [2.0, -1.0, 5.5];
    let nodes = [[0.5, 0.5, 1.0], [0.5, 0.5, 3.0], [0.5, 0.5, 5.0], head]
        .map(|p| mesh.add_node_at(p).unwrap());
    let top = nodes[2];
    let mass = nodes[3];
    mesh.add(Shell::new(mat, concrete, 0.5).unwrap()).unwrap();
    let section = BeamSection::new(0.2, [4.0e-3, 2.0e-3], 5.0e-3).unwrap();
    for ends in [[nodes[0], nodes[1]], [nodes[1], top]] {
        mesh.add(SpaceBeam::new(ends, concrete, section, [1.0, 0.5, 0.0]).unwrap()).unwrap();
    }
    mesh.add(LumpedMass::in_space(mass, 10.0, [1.0; 3]).unwrap()).unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    let model = model.with_rigid_link(mat[0], &[nodes[0]]).unwrap();
    let model = model.with_rigid_link(top, &[mass]).unwrap();
    assert_eq!(model.dofs(), 36);

    let force = [700.0, -400.0, -300.0];
    let moment = [50.0, -80.0, 120.0];
    let mut load = vec![0.0; 36];
    for (direction, value) in DIRECTIONS.into_iter().zip(force.into_iter().chain(moment)) {
        for &(dof, weight) in &model.row(mass, direction).unwrap() {
            load[dof] += weight * value;
        }
    }
    let fixed: Vec<(usize, f64)> = (0..24).map(|dof| (dof, 0.0)).collect();
    let u = solve_with_prescribed(&stiffness(&model), &load, &fixed);
    for height in [0.0, 1.0, 3.0] {
        let section = model.section_in_space(height, [0.3, -0.2]).unwrap();
        let moment_of_force = cross([head[0] - 0.3, head[1] + 0.2, head[2] - height], force);
        let expected =
            force.into_iter().chain([0, 1, 2].map(|axis| moment_of_force[axis] + moment[axis]));
        for ((rows, sign), expected) in rows(&section).into_iter().zip(expected) {
            let computed = sign * rows.value(&u, &[], &[]);
            assert!((computed - expected).abs() < 1e-6, "{height} {computed} {expected}");
        }
        assert_eq!(rows(&section).map(|(rows, _)| rows.unit), ["N", "N", "N", "N·m", "N·m", "N·m"]);
    }
    // Planes without nodes, within a beam, or above the model are errors.
    for (height, place) in [(0.5, 0.0), (2.0, 0.0), (5.5, 0.0), (f64::NAN, 0.0), (0.0, f64::NAN)] {
        let fault = model.section_in_space(height, [0.0, place]).unwrap_err();
        assert!(matches!(fault, Error::Input { .. }), "{height} {place}");
    }
    assert!(matches!(model.section(1.0, 0.0), Err(Error::Scene { .. })));
}

/// Levels of bricks, the lowest at this place of the list.
fn pier(first_level: usize) -> FemModel {
    let levels = [0.0, 1.5, 3.0, 4.0];
    let concrete = Material::new(2.0e8, 0.2, 2400.0).unwrap();
    let mut mesh = Mesh::in_space();
    let plan = [[[0.0, 0.0], [2.0, 0.1]], [[0.2, 1.5], [2.1, 1.8]]];
    let foot = mesh
        .add_grid(2, 2, |row, column| {
            let place: [f64; 2] = plan[row][column];
            [place[0], place[1], levels[first_level]]
        })
        .unwrap();
    let above: Vec<f64> =
        levels[first_level + 1..].iter().map(|z| z - levels[first_level]).collect();
    for brick in foot.extrude(&mut mesh, &above).unwrap() {
        mesh.add(Hex8::new(brick, concrete)).unwrap();
    }
    let last_index = mesh.nodes().len() - 1;
    mesh.add(Dashpot::axial_in_space([last_index, last_index - 7], 6.0e4).unwrap())
        .unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    model.with_rayleigh(RayleighDamping::new(0.0, 0.003).unwrap())
}

/// Any motion: the force on the nodes above less the rate of momentum of the upper part is what the section passes on.
#[test]
fn moving_structure_keeps_the_balance_of_its_upper_part() {
    let model = pier(0);
    let upper = pier(1);
    let n = model.dofs();
    let skip = n - upper.dofs();
    assert_eq!(skip, 12);
    let [u, v, a] = [1, 2, 3].map(|seed| noise(n, seed));
    let terms = [(stiffness(&model), &u), (damping(&model), &v), (mass(&model), &a)]
        .map(|(matrix, motion)| multiply(&matrix, motion));
    let mut on_upper: Vec<f64> =
        (skip..n).map(|k| terms.iter().map(|term| term[k]).sum()).collect();
    // The lowest nodes of the upper part are the cut.
    on_upper[..12].fill(0.0);
    let section = model.section_in_space(1.5, [0.3, 0.7]).unwrap();
    let inertia = mass(&upper);
    for ((rows, sign), direction) in rows(&section).into_iter().zip(DIRECTIONS) {
        let motion = upper.rigid_motion(direction, [0.3, 0.7, 1.5]);
        let balance = dot(&motion, &on_upper) - form(&motion, &inertia, &a[skip..]);
        let computed = sign * rows.value(&u, &v, &a);
        assert!((computed - balance).abs() < 1e-11 * 2.0e8, "{direction:?} {computed} {balance}");
        assert!(computed.abs() > 1e3, "the balance is not an empty one");
    }
}

/// φᵀ M a over the degrees of freedom of a part of the building.
fn momentum(part: &dyn Structure, motion: &[f64], acceleration: &[f64]) -> f64 {
    let count = part.dofs();
    form(&motion[..count], &mass(part), &acceleration[..count])
}

/// Displacement above the origin at a height, of a body with this shift and turn of a place.
fn displacement_at(z: f64, place: [f64; 3], shift: [f64; 3], turn: [f64; 3]) -> [f64; 3] {
    let rotation_displacement = cross(turn, [-place[0], -place[1], z - place[2]]);
    [0, 1, 2].map(|k| shift[k] + rotation_displacement[k])
}

/// Motion of the building as a rigid body: of its mat, and of each floor in its plane.
fn rigid_building_motion(
    storeys: &[PlanStorey],
    place: [f64; 3],
    shift: [f64; 3],
    turn: [f64; 3],
) -> Vec<f64> {
    let mut motion = [displacement_at(0.0, place, shift, turn), turn].concat();
    let mut level = 0.0;
    for storey in storeys {
        level += storey.height;
        let displacement = displacement_at(level, place, shift, turn);
        motion.extend([displacement[0], displacement[1], turn[2]]);
    }
    motion
}

/// Floors above a storey's foot: the momentum of the building less the momentum of the part below.
#[test]
fn floors_pass_on_their_inertia() {
    let mat = RigidBody::cuboid([18.0, 12.0, 1.0], 2500.0).unwrap();
    let storeys: Vec<PlanStorey> = [3.0, 4.0, 2.5]
        .into_iter()
        .zip([[1.0, -2.0], [0.5, 1.5], [-1.0, 0.0]])
        .map(|(height, mass_center)| PlanStorey {
            mass_center,
            ..PlanStorey::new(height, 1.0e5 * height, [18.0, 12.0], [4.0e8, 3.0e8, 2.0e10])
        })
        .collect();
    let building = StoreyBuilding::new(mat.clone(), &storeys).unwrap();
    let acceleration = noise(building.dofs(), 5);
    let reference = [0.7, -1.2];
    for storey in 0..3 {
        let height: f64 = storeys[..storey].iter().map(|below| below.height).sum();
        let below: Box<dyn Structure> = match storey {
            0 => Box::new(mat.clone()),
            _ => Box::new(StoreyBuilding::new(mat.clone(), &storeys[..storey]).unwrap()),
        };
        let section = building.section(storey, reference).unwrap();
        assert_eq!(section.height, height);
        for (axis, (rows, sign)) in rows(&section).into_iter().enumerate() {
            let mut shift = [0.0; 3];
            let mut turn = [0.0; 3];
            if axis < 3 {
                shift[axis] = 1.0;
            } else {
                turn[axis - 3] = 1.0;
            }
            let place = [reference[0], reference[1], height];
            let motion = rigid_building_motion(&storeys, place, shift, turn);
            let expected = momentum(below.as_ref(), &motion, &acceleration)
                - momentum(&building, &motion, &acceleration);
            let computed = sign * rows.value(&[], &[], &acceleration);
            assert!(
                (computed - expected).abs() < 1e-9 * 1.0e8,
                "{storey} {axis} {computed} {expected}"
            );
            assert!(computed.abs() > 1e3, "the balance is not an empty one");
        }
    }
    assert!(matches!(building.section(3, reference), Err(Error::Index { .. })));
    assert!(matches!(building.section(0, [0.0, f64::NAN]), Err(Error::Input { .. })));
}
