//! GOAL: finite-element models touch the ground with walls and base that bend.
//! SCENE: solids, walls on a slab and a box of beams in a trench, on springs and in soil.
//! REFERENCE: the rigid block with walls; bending of cantilevers; Euler's load; balances of energy and of forces.

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::bem::{ContactElement, SharedKernels};
use basemat::coupled::{CoarseBaseError, Face, Load, Warning};
use basemat::fem::{Beam, Direction, LumpedMass, Material, Mesh, Quad4, QuadFormulation};
use basemat::interface::{Coulomb, InterfaceLaw};
use basemat::motion::{STANDARD_GRAVITY, VerticalIncidence, el_centro_1940};
use basemat::site::TrenchMotion;
use basemat::soil::SoilProfile;
use basemat::structure::{DofCombination, FemModel, RigidBlock, Structure};
use basemat::{Error, Result, Simulation, Soil, unobserved};

use super::embedded::{Bed, DENSITY, DEPTH, HEIGHT, WIDTH, block, faces, laws, motion, soil};

/// Concrete in plane strain.
const YOUNG_MODULUS: f64 = 31.0e9;

/// Nodes of an outline with `wall` and `base` intervals, down, to the right and up.
fn outline(mesh: &mut Mesh, [width, depth]: [f64; 2], [base, wall]: [usize; 2]) -> Vec<usize> {
    let part = |k: usize, count: usize| k as f64 / count as f64;
    let left = (0..wall).map(|k| [-0.5 * width, -depth * part(k, wall)]);
    let along = (0..base).map(|k| [width * (part(k, base) - 0.5), -depth]);
    let right = (0..=wall).map(|k| [0.5 * width, -depth * part(wall - k, wall)]);
    left.chain(along).chain(right).map(|[x, y]| mesh.add_node(x, y).unwrap()).collect()
}

/// Beams along `nodes`, of this thickness.
fn beams(mesh: &mut Mesh, nodes: &[usize], thickness: f64, density: f64) {
    for ends in nodes.windows(2) {
        let inertia = thickness.powi(3) / 12.0;
        let beam = Beam::new([ends[0], ends[1]], YOUNG_MODULUS, thickness, inertia, density);
        mesh.add(beam.unwrap()).unwrap();
    }
}

/// A box of slab, walls and roof at the surface.
fn box_of_beams(thickness: f64, size: [f64; 2], counts: [usize; 2]) -> FemModel {
    let mut mesh = Mesh::new();
    let nodes = outline(&mut mesh, size, counts);
    beams(&mut mesh, &nodes, thickness, 2500.0);
    let roof: Vec<usize> = (1..counts[0])
        .map(|k| mesh.add_node(size[0] * (k as f64 / counts[0] as f64 - 0.5), 0.0).unwrap())
        .collect();
    let roof = [&nodes[..1], &roof, &nodes[nodes.len() - 1..]].concat();
    beams(&mut mesh, &roof, thickness, 2500.0);
    FemModel::in_trench(mesh, &nodes).unwrap()
}

/// The rigid block of these tests as stiff solids.
fn solid_block() -> FemModel {
    let material = Material::new(1e14, 0.2, 900.0).unwrap();
    let (columns, rows) = (6, 8);
    let mut mesh = Mesh::new();
    let place = |k: usize| [WIDTH * ((k % 7) as f64 / 6.0 - 0.5), HEIGHT * (k / 7) as f64 / 8.0];
    for k in 0..7 * 9 {
        let [x, y] = place(k);
        mesh.add_node(x, y - DEPTH).unwrap();
    }
    for row in 0..rows {
        for column in 0..columns {
            let low = 7 * row + column;
            let nodes = [low, low + 1, low + 8, low + 7];
            mesh.add(Quad4::new(nodes, material, QuadFormulation::default())).unwrap();
        }
    }
    // Two rows are below the surface.
    let nodes = [14, 7, 0, 1, 2, 3, 4, 5, 6, 13, 20];
    FemModel::in_trench(mesh, &nodes).unwrap()
}

/// A block of stiff solids and the rigid block open, slide, turn and press alike.
#[test]
fn stiff_solids_move_as_the_rigid_block() {
    let simulation = |structure: Box<dyn Structure>| {
        let record = el_centro_1940().scaled(2.0).unwrap().padded(0.5, 0.5).unwrap();
        let vertical = Some(record.scaled(0.6).unwrap());
        let motion = motion(VerticalIncidence { horizontal: Some(record), vertical });
        let builder = Simulation::builder(0.01).structure(structure).motion(motion);
        builder.ground(Bed::new(&faces(), 4e7, 4e5)).interfaces(laws()).build().unwrap()
    };
    let solids = solid_block();
    let top = solids.row(7 * 8 + 3, Direction::X).unwrap();
    let rigid_top = RigidBlock::new(WIDTH, HEIGHT, 900.0).unwrap().horizontal_at(HEIGHT);
    let [mut one, mut other] = [simulation(Box::new(solids)), simulation(Box::new(block()))];
    let [mut largest, mut apart] = [[0.0_f64; 8]; 2];
    for _ in 0..600 {
        let [found, wanted] = [(&mut one, &top), (&mut other, &rigid_top)].map(|(own, top)| {
            let state = own.step().unwrap();
            let wall = state.face(Face::RightWall);
            let [open, lifted] = [wall.open_fraction, state.face(Face::Base).open_fraction];
            let moved = [top.value(state.absolute_displacement()), state.base_rotation];
            let forces = [state.base_shear, state.base_moment, wall.thrust, wall.shear];
            [moved[0], moved[1], forces[0], forces[1], forces[2], forces[3], open, lifted]
        });
        for k in 0..8 {
            largest[k] = largest[k].max(wanted[k].abs());
            apart[k] = apart[k].max((found[k] - wanted[k]).abs());
        }
    }
    // Both open a wall and the base.
    assert!(largest[6] > 0.2 && largest[7] > 0.1, "{largest:?}");
    for k in 0..8 {
        assert!(apart[k] < 1e-4 * largest[k], "{k}: {apart:?} {largest:?}");
    }
}

/// Walls on a rigid slab bend as cantilevers under the pressure at rest; the base alone carries the weight.
#[test]
fn walls_bend_as_cantilevers_under_the_pressure_at_rest() {
    let mut mesh = Mesh::new();
    let (thickness, wall, base) = (0.4, 40, 6);
    let nodes = outline(&mut mesh, [WIDTH, DEPTH], [base, wall]);
    beams(&mut mesh, &nodes, thickness, 2500.0);
    let slab = &nodes[wall..=wall + base];
    let middle = slab[base / 2];
    let others: Vec<usize> = slab.iter().copied().filter(|own| *own != middle).collect();
    let model = FemModel::in_trench(mesh, &nodes).unwrap().with_rigid_link(middle, &others);
    let model = model.unwrap();
    let rows = [nodes[0], nodes[nodes.len() - 1], middle].map(|node| model.row(node, Direction::X));
    let rows = rows.map(Result::unwrap);
    let simulation = Simulation::builder(0.01)
        .structure(model)
        .ground(Bed::new(&faces(), 4e7, 4e5))
        .interfaces(laws())
        .build()
        .unwrap();
    let moved = rows.map(|row| row.value(simulation.static_displacement()));
    let [left, right] = [moved[0] - moved[2], moved[1] - moved[2]];
    // A force at the height s bends the tip of a wall of height h by s² (3h − s)/(6EI).
    let stiffness = YOUNG_MODULUS * thickness.powi(3) / 12.0;
    let integral = |s: f64| s.powi(3) * (DEPTH - 0.25 * s) / (6.0 * stiffness);
    let bent = |own: &ContactElement| {
        let [middle, half] = [own.center()[2] + DEPTH, 0.5 * own.length()];
        let pressure = 0.5 * DENSITY * STANDARD_GRAVITY * (DEPTH - middle);
        pressure * (integral(middle + half) - integral(middle - half))
    };
    let deflection: f64 = faces().elements()[..4].iter().map(bent).sum();
    assert!((left / deflection - 1.0).abs() < 1e-3, "{left} {deflection}");
    assert!((right / -deflection - 1.0).abs() < 1e-3, "{right} {deflection}");
    // K₀ ρ g h⁵/(30 EI) under a pressure that grows with depth; constant on four elements it bends 8 % more.
    let smooth = 0.5 * DENSITY * STANDARD_GRAVITY * DEPTH.powi(5) / (30.0 * stiffness);
    assert!((left / smooth - 1.0).abs() < 0.1, "{left} {smooth}");
    let state = simulation.state();
    let weight = 2500.0 * thickness * (WIDTH + 2.0 * DEPTH) * STANDARD_GRAVITY;
    assert!((state.face(Face::Base).thrust / weight - 1.0).abs() < 1e-9);
    for wall in [Face::LeftWall, Face::RightWall] {
        let thrust = 0.25 * DENSITY * STANDARD_GRAVITY * DEPTH * DEPTH;
        assert!((state.face(wall).thrust / thrust - 1.0).abs() < 1e-12);
    }
}

/// Walls carry the weight on them down to the base: their axial forces and the load at which they buckle.
#[test]
fn weight_on_walls_counts_in_p_delta() {
    let mut mesh = Mesh::new();
    let nodes = outline(&mut mesh, [WIDTH, DEPTH], [2, 4]);
    beams(&mut mesh, &nodes, 0.1, 0.0);
    let tops = [nodes[0], nodes[nodes.len() - 1]];
    for top in tops {
        mesh.add(LumpedMass::new(top, 20.0e3).unwrap()).unwrap();
    }
    let model = FemModel::in_trench(mesh, &nodes).unwrap();
    let model = model.with_rigid_link(nodes[5], &[nodes[4], nodes[6]]).unwrap();
    let model = model.with_p_delta(STANDARD_GRAVITY).unwrap();
    let weight = 20.0e3 * STANDARD_GRAVITY;
    let forces: Vec<f64> =
        model.mesh().elements().filter_map(basemat::fem::Element::compression).collect();
    for wall in [0..4, 6..10] {
        for force in &forces[wall] {
            assert!((force / weight - 1.0).abs() < 1e-9, "{forces:?}");
        }
    }
    let stiffness = YOUNG_MODULUS * 0.1_f64.powi(3) / 12.0;
    let euler = std::f64::consts::PI.powi(2) * stiffness / (4.0 * DEPTH * DEPTH);
    assert!((model.buckling_factor().unwrap() * weight / euler - 1.0).abs() < 1e-3);
}

/// Motions of a base are of its floor, with walls and without.
#[test]
fn walls_change_no_motion_of_the_base() {
    let rigid = RigidBlock::new(WIDTH, HEIGHT, 900.0).unwrap();
    let u = [0.3, -0.1, 0.02];
    let at = |own: &dyn Structure| {
        let rows = DofCombination::of_base(own, [2.0, 0.0, 7.0]).unwrap();
        rows.map(|row| row.value(&u))
    };
    let [with, without] = [at(&block()), at(&rigid)];
    for k in 0..3 {
        assert!((with[k] - without[k]).abs() < 1e-12, "{with:?} {without:?}");
    }
}

/// A box of beams opens and slides in soil under strong shaking: energy and forces balance, and the soil never gives.
#[test]
fn a_box_of_beams_opens_and_slides_and_its_balances_close() {
    let elements = Trench::new(-0.5 * WIDTH..0.5 * WIDTH, DEPTH).unwrap().elements(4, 3).unwrap();
    let laws = elements.interfaces(Coulomb::new(0.5).unwrap(), Coulomb::new(0.3).unwrap());
    let ground = TrenchGround::new(soil(), elements).unwrap().with_pressure_at_rest(0.5).unwrap();
    let record = el_centro_1940().scaled(3.0).unwrap().padded(0.2, 0.0).unwrap();
    let motion = TrenchMotion::new(&ground, record, &mut unobserved).unwrap();
    let model = box_of_beams(0.5, [WIDTH, DEPTH], [8, 6]).with_p_delta(STANDARD_GRAVITY).unwrap();
    let mut simulation = Simulation::builder(0.02)
        .structure(model)
        .ground(ground)
        .interfaces(laws)
        .motion(motion)
        .expected_steps(256)
        .build()
        .unwrap();
    let [mut least, mut most, mut open, mut slips] = [0.0_f64; 4];
    let run = simulation
        .run(256, |state| {
            least = least.min(state.energy_balance.soil);
            most = most.max(state.energy_balance.soil);
            open = open.max(state.face(Face::LeftWall).open_fraction);
            slips += state.modes.iter().filter(|mode| mode.is_slip()).count() as f64;
            let [left, right] = [Face::LeftWall, Face::RightWall].map(|wall| state.face(wall));
            let shear = right.thrust - left.thrust + state.face(Face::Base).shear;
            assert!((state.base_shear - shear).abs() < 1e-9 * state.normal_force);
        })
        .unwrap();
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    assert!(least > -1e-12 * most && open > 0.3 && slips > 10.0, "{least} {most} {open} {slips}");
}

/// How far struts between the middles of both walls push them apart, and warnings of few elements of walls.
///
/// `walls`: elements of each wall, of this thickness, m.
fn strutted(walls: usize, thickness: f64, kernels: &SharedKernels) -> Result<(f64, Vec<Warning>)> {
    let elements = Trench::new(-4.0..4.0, 8.0)?.elements(8, walls)?;
    let model = box_of_beams(thickness, [8.0, 8.0], [32, 32]);
    let struts = [16, 32 + 32 + 16].map(|node| model.row(node, Direction::X).unwrap());
    let strut = struts[1].clone() - struts[0].clone();
    let ground = TrenchGround::new(soil(), elements)?.with_pressure_at_rest(0.0)?;
    let mut simulation = Simulation::builder(0.02)
        .structure(model)
        .ground(ground.with_shared_kernels(kernels))
        .interface(Coulomb::new(0.5)?)
        .load(Load::constant(strut.clone(), 100.0e3))
        .expected_steps(1)
        .build()?;
    let apart = strut.value(simulation.static_displacement());
    let mut warnings = simulation.run(1, |_| {})?.warnings;
    warnings.retain(|own| matches!(own, Warning::CoarseBase { axis: Some('z'), .. }));
    Ok((apart, warnings))
}

/// Walls that bend need enough elements: a run tells the number, by which the deflection is off by 3 %.
///
/// So it does of a wall of one element; `build` refuses one that is ten times as thin.
#[test]
fn walls_on_too_few_elements_are_told() {
    let kernels = SharedKernels::default();
    let (exact, warnings) = strutted(8, 0.4, &kernels).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    for (walls, told) in [(2, 7..=7), (1, 3..=9)] {
        let (coarse, warnings) = strutted(walls, 0.4, &kernels).unwrap();
        assert!((coarse / exact - 1.0).abs() > 0.15, "{coarse} {exact}");
        let [Warning::CoarseBase { foundation: 0, elements, needed, .. }] = warnings[..] else {
            panic!("{warnings:?}")
        };
        assert!(elements == walls && told.contains(&needed), "{warnings:?}");
        let (found, _) = strutted(needed, 0.4, &kernels).unwrap();
        assert!((found / exact - 1.0).abs() < 0.03, "{found} {exact}");
    }
    let Err(Error::CoarseBase(CoarseBaseError {
        foundation: 0,
        elements: 1,
        needed,
        difference,
        ..
    })) = strutted(1, 0.05, &kernels)
    else {
        panic!("a thin wall on one element")
    };
    assert!(needed > 30 && difference.is_some_and(|own| own > 0.3), "{needed} {difference:?}");
}

/// A motion made for another soil, another depth or a ground without backfill is refused.
#[test]
fn a_motion_made_for_another_ground_is_refused() {
    let elements = |depth: f64| Trench::new(-6.0..6.0, depth).unwrap().elements(2, 2).unwrap();
    let layered =
        |thickness: f64| SoilProfile::on_half_plane(soil()).with_layer(soil(), thickness).unwrap();
    let ground =
        |profile: SoilProfile, depth: f64| TrenchGround::new(profile, elements(depth)).unwrap();
    let filled = |ground: TrenchGround| {
        let fill = Soil::from_shear_wave_speed(100.0, 0.3, 1800.0).unwrap();
        ground.with_backfill(3.0, fill, basemat::soil::Elastic).unwrap()
    };
    let made_for = TrenchGround::new(layered(8.0), elements(DEPTH)).unwrap();
    let motion = TrenchMotion::new(&made_for, el_centro_1940(), &mut unobserved).unwrap();
    let build = |ground: TrenchGround| {
        let builder = Simulation::builder(0.05).structure(block()).expected_steps(1);
        let laws: Vec<Box<dyn InterfaceLaw>> = vec![Box::new(Coulomb::new(0.5).unwrap())];
        builder.ground(ground).interfaces(laws).motion(motion.clone()).build()
    };
    assert!(build(ground(layered(8.0), DEPTH)).is_ok());
    for other in [
        ground(layered(9.0), DEPTH),
        ground(soil().into(), DEPTH),
        ground(layered(8.0), DEPTH - 0.5),
        filled(ground(layered(8.0), DEPTH)),
    ] {
        let refused = build(other).err();
        assert!(
            matches!(refused, Some(Error::Scene { quantity: "free field", .. })),
            "{refused:?}"
        );
    }
}

/// Outlines in another order, and nodes that do not exist or do not move.
#[test]
fn outlines_that_are_none_are_refused() {
    let model = |change: &dyn Fn(&mut Vec<usize>)| {
        let mut mesh = Mesh::new();
        let mut nodes = outline(&mut mesh, [WIDTH, DEPTH], [2, 2]);
        beams(&mut mesh, &nodes, 0.4, 2500.0);
        change(&mut nodes);
        FemModel::in_trench(mesh, &nodes)
    };
    assert!(model(&|_| {}).is_ok());
    assert!(model(&|nodes| nodes.truncate(3)).is_ok());
    for change in [
        &|nodes: &mut Vec<usize>| nodes.reverse(),
        &|nodes: &mut Vec<usize>| nodes.swap(0, 1),
        &|nodes: &mut Vec<usize>| nodes.retain(|own| *own != 2),
        &|nodes: &mut Vec<usize>| nodes.insert(1, 0),
    ] as [&dyn Fn(&mut Vec<usize>); 4]
    {
        let refused = model(change).err();
        let is_own = matches!(refused, Some(Error::Scene { quantity: "outline in a trench", .. }));
        assert!(is_own, "{refused:?}");
    }
    assert!(matches!(model(&|nodes| nodes.push(99)), Err(Error::Index { .. })));
    assert!(matches!(model(&|nodes| nodes.truncate(1)), Err(Error::Size { .. })));
    let space = FemModel::in_trench(Mesh::in_space(), &[0, 1]);
    assert!(matches!(space, Err(Error::Scene { .. })));
}
