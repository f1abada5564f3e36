//! GOAL: structures in a trench start from the soil's pressures at rest, and walls bear no more than yielding soil does.
//! SCENE: blocks in half-planes and layers, as heavy as the soil dug out, heavier and lighter; rigid, and bonded.
//! REFERENCE: the soil itself; frictionless equilibrium on the ground's compliance, solved by elimination; Rankine's
//! passive thrust.

use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::bem::{ContactElement, Ground};
use basemat::coupled::{Face, GravityStage, Load};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw, Yielding};
use basemat::motion::STANDARD_GRAVITY;
use basemat::results::Recorder;
use basemat::soil::SoilProfile;
use basemat::structure::{DofCombination, RigidBlock, WithWalls};
use basemat::{Simulation, Soil};
use basemat_problems::dense::solve;

use super::embedded::{DENSITY, DEPTH, WIDTH, soil};

/// K₀.
const AT_REST: f64 = 0.5;

fn elements() -> TrenchElements {
    Trench::new(-0.5 * WIDTH..0.5 * WIDTH, DEPTH).unwrap().elements(4, 2).unwrap()
}

fn ground(profile: impl Into<SoilProfile>) -> TrenchGround {
    TrenchGround::new(profile, elements()).unwrap().with_pressure_at_rest(AT_REST).unwrap()
}

/// Block of the trench's size and this density, in place of the soil.
fn simulation(profile: impl Into<SoilProfile>, density: f64, bonded: bool) -> Simulation {
    let block = RigidBlock::new(WIDTH, DEPTH, density).unwrap();
    let builder = Simulation::builder(0.01)
        .structure(WithWalls::new(block, DEPTH).unwrap())
        .ground(ground(profile))
        .gravity_stage(GravityStage::WishedInPlace)
        .expected_steps(4);
    let friction = Coulomb::new(0.4).unwrap();
    let builder = if bonded { builder.interface(Bonded) } else { builder.interface(friction) };
    builder.build().unwrap()
}

/// Pressures and shear tractions at rest.
fn tractions(simulation: &Simulation) -> [Vec<f64>; 2] {
    let contact = &simulation.state().contact;
    [
        contact.iter().map(|own| own.pressure).collect(),
        contact.iter().map(|own| own.shear).collect(),
    ]
}

/// Soil put back into its trench: its own pressures, no shear, no displacement, for ever.
#[test]
fn a_block_of_soil_changes_nothing() {
    let upper = Soil::from_shear_wave_speed(150.0, 0.35, 1600.0).unwrap();
    let layered = SoilProfile::on_half_plane(soil()).with_layer(upper, 2.0).unwrap();
    let heavy = DENSITY * DEPTH;
    for (profile, mass) in
        [(soil().into(), heavy), (layered, 2.0 * 1600.0 + (DEPTH - 2.0) * DENSITY)]
    {
        for bonded in [false, true] {
            let mut simulation = simulation(profile.clone(), mass / DEPTH, bonded);
            let [pressures, shear] = tractions(&simulation);
            let description = ground(profile.clone()).description();
            for (found, wanted) in pressures.iter().zip(description.pressure_at_rest) {
                assert!(
                    (found - STANDARD_GRAVITY * wanted).abs() < 1e-9 * STANDARD_GRAVITY * heavy
                );
            }
            assert!(shear.iter().all(|own| own.abs() < 1e-9 * STANDARD_GRAVITY * heavy));
            let thrust = simulation.state().face(Face::Base).thrust;
            assert!((thrust / (STANDARD_GRAVITY * mass * WIDTH) - 1.0).abs() < 1e-9);
            let at_rest = simulation.state().contact.clone();
            for _ in 0..4 {
                let state = simulation.step().unwrap();
                for (found, own) in state.contact.iter().zip(&at_rest) {
                    assert!(
                        (found.pressure - own.pressure).abs() < 1e-9 * STANDARD_GRAVITY * heavy
                    );
                }
            }
        }
    }
}

/// Pressures at rest act at their own height, whatever the elements: ∫K₀σ_v z dz by hand.
#[test]
fn thrusts_at_rest_act_at_their_own_height() {
    const BOUNDARY: f64 = 2.3;
    const BOTTOM: f64 = 6.0;
    let upper = Soil::from_shear_wave_speed(150.0, 0.35, 1600.0).unwrap();
    let lower = Soil::from_shear_wave_speed(220.0, 0.3, 2000.0).unwrap();
    let profile = SoilProfile::on_half_plane(lower).with_layer(upper, BOUNDARY).unwrap();
    for (ratio, ratios, height) in
        [(Some(0.5), [0.5, 0.5], 1.9334), (None, [0.35 / 0.65, 0.3 / 0.7], 2.0177)]
    {
        let below = BOTTOM - BOUNDARY;
        let masses = [
            [0.5 * 1600.0 * BOUNDARY * BOUNDARY, below + BOUNDARY / 3.0],
            [1600.0 * BOUNDARY * below, 0.5 * below],
            [0.5 * 2000.0 * below * below, below / 3.0],
        ];
        let parts: Vec<[f64; 2]> =
            (0..3).map(|k| [ratios[k.min(1)] * masses[k][0], masses[k][1]]).collect();
        let thrust: f64 = parts.iter().map(|own| own[0]).sum();
        let wanted = parts.iter().map(|own| own[0] * own[1]).sum::<f64>() / thrust;
        assert!((wanted - height).abs() < 1e-4, "{wanted}");
        for walls in [2, 6] {
            let elements = Trench::new(-5.0..5.0, BOTTOM).unwrap().elements(2, walls).unwrap();
            let ground = TrenchGround::new(profile.clone(), elements).unwrap();
            let ground = match ratio {
                Some(ratio) => ground.with_pressure_at_rest(ratio).unwrap(),
                None => ground,
            };
            let block = WithWalls::new(RigidBlock::new(10.0, 12.0, 900.0).unwrap(), BOTTOM);
            let simulation = Simulation::builder(0.02)
                .structure(block.unwrap())
                .ground(ground)
                .interface(Coulomb::new(0.4).unwrap())
                .expected_steps(1)
                .build()
                .unwrap();
            let series = Recorder::new().contact(1).start(&simulation).unwrap();
            for wall in [Face::LeftWall, Face::RightWall] {
                let face = simulation.state().face(wall);
                assert!((face.thrust / (STANDARD_GRAVITY * thrust) - 1.0).abs() < 1e-12);
                assert!((face.place - wanted).abs() < 1e-12 * BOTTOM, "{} {wanted}", face.place);
                assert_eq!(series.face(wall).next(), Some(face));
            }
        }
    }
}

/// Weight on the base, K₀ on the walls: without motion nothing changes.
#[test]
fn a_block_in_its_trench_stays_at_rest() {
    let block = RigidBlock::new(WIDTH, 3.0 * DEPTH, 0.5 * DENSITY).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(WithWalls::new(block, DEPTH).unwrap())
        .ground(ground(soil()))
        .interface(Coulomb::new(0.4).unwrap())
        .expected_steps(200)
        .build()
        .unwrap();
    let at_rest = tractions(&simulation);
    let start = simulation.static_displacement().to_vec();
    simulation.run(200, |_| {}).unwrap();
    let most = at_rest[0].iter().fold(0.0_f64, |most, own| most.max(*own));
    for (found, wanted) in tractions(&simulation).iter().flatten().zip(at_rest.iter().flatten()) {
        assert!((found - wanted).abs() < 1e-12 * most, "{found} {wanted}");
    }
    let settled = start.iter().fold(0.0_f64, |most, own| most.max(own.abs()));
    for own in simulation.state().displacement() {
        assert!(own.abs() < 1e-12 * settled, "{own}");
    }
}

/// A wall pushed into soil that yields under K_p times its weight bears K_p γ d²/2 and no more.
#[test]
fn a_pushed_wall_bears_the_passive_thrust() {
    let friction_angle = 30.0_f64.to_radians();
    let passive = (0.25 * std::f64::consts::PI + 0.5 * friction_angle).tan().powi(2);
    let unit_weight = DENSITY * STANDARD_GRAVITY;
    let law = |own: &ContactElement| -> Box<dyn InterfaceLaw> {
        if own.directions()[0][2] < -0.5 {
            return Box::new(Coulomb::new(0.0).unwrap());
        }
        // The mean stress of the soil above over the element.
        let strength = -passive * unit_weight * own.center()[2];
        Box::new(Yielding::new(strength, 0.0).unwrap())
    };
    let block = RigidBlock::new(WIDTH, DEPTH, DENSITY).unwrap();
    let block = WithWalls::new(block, DEPTH).unwrap();
    let wanted = 0.5 * passive * unit_weight * DEPTH * DEPTH;
    // Through the middle of the walls' thrust, so that all of the wall is pushed in.
    let right = DofCombination::of_base(&block, [0.0, 0.0, DEPTH / 3.0]).unwrap()[0].clone();
    let push = Load::table(right, &[0.0, 0.5, 10.0], &[0.0, 3.0 * wanted, 3.0 * wanted]).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(block)
        .ground(ground(soil()))
        .interfaces(elements().elements().iter().map(law).collect())
        .load(push)
        .expected_steps(100)
        .build()
        .unwrap();
    let mut most = 0.0_f64;
    let run =
        simulation.run(100, |state| most = most.max(state.face(Face::RightWall).thrust)).unwrap();
    assert!((most / wanted - 1.0).abs() < 1e-9, "{most} {wanted}");
    let state = simulation.state();
    assert!((state.face(Face::RightWall).thrust / wanted - 1.0).abs() < 1e-9);
    assert_eq!(state.face(Face::LeftWall).open_fraction, 1.0);
    assert!(run.energy_error < 1e-9 && state.energy_balance.contact > 0.0);
}

/// A heavy block, without friction: S_nn (p − p₀) = B u with Σ p = W, all closed.
#[test]
fn a_heavy_block_presses_its_walls() {
    let density = 2.5 * DENSITY;
    let [pressures, shear] = tractions(&simulation(soil(), density, false));
    let ground = ground(soil());
    let (list, count) = (ground.elements().to_vec(), pressures.len());
    let mut soil = vec![0.0; 4 * count * count];
    ground.static_compliance(&mut soil).unwrap();
    let at_rest: Vec<f64> =
        ground.description().pressure_at_rest.iter().map(|own| STANDARD_GRAVITY * own).collect();
    // Motion into the soil by a settlement; a wall does not feel it, and by symmetry there is no other.
    let down = |e: usize| f64::from(u8::from(list[e].heights()[0] == list[e].heights()[1]));
    let mut matrix = vec![vec![0.0; count + 1]; count + 1];
    let mut load = vec![0.0; count + 1];
    for i in 0..count {
        for j in 0..count {
            matrix[i][j] = soil[i * 2 * count + j];
            load[i] += soil[i * 2 * count + j] * at_rest[j];
        }
        matrix[i][count] = -down(i);
        matrix[count][i] = down(i) * list[i].length();
    }
    load[count] = STANDARD_GRAVITY * density * WIDTH * DEPTH;
    let wanted = solve(&matrix, &load);
    let above = STANDARD_GRAVITY * DENSITY * DEPTH;
    for e in 0..count {
        assert!(wanted[e] > 0.0 && (pressures[e] - wanted[e]).abs() < 1e-6 * above, "{e}");
        assert!(shear[e].abs() < 1e-9 * above);
    }
    // Walls keep the soil beside the base from moving in.
    assert!(pressures[0] > 1.5 * at_rest[0], "{pressures:?} {at_rest:?}");
}

/// A light block opens its base; a bonded block hangs on its walls.
#[test]
fn a_light_block_opens_unless_it_is_bonded() {
    let density = 0.2 * DENSITY;
    let weight = STANDARD_GRAVITY * density * WIDTH * DEPTH;
    let open = simulation(soil(), density, false);
    let base = open.state().face(Face::Base);
    assert!(base.open_fraction > 0.0 && (base.thrust / weight - 1.0).abs() < 1e-9, "{base:?}");
    let bonded = simulation(soil(), density, true);
    let state = bonded.state();
    let [left, base, right] =
        [Face::LeftWall, Face::Base, Face::RightWall].map(|face| state.face(face));
    // Upwards on the soil.
    let hung = right.shear - left.shear;
    assert!(base.open_fraction == 0.0 && hung.abs() > 0.1 * weight, "{hung} {weight}");
    assert!((base.thrust - hung - weight).abs() < 1e-9 * weight);
}
