//! GOAL: large displacements of the ground cost no accuracy of the structure's deformation.
//! SCENE: stiff and light structures on grounds that drift by kilometres, sticking and sliding,
//! with four time schemes; two buildings whose grounds move apart.
//! REFERENCE: the energy balance; the same run without the travel.

use std::f64::consts::TAU;

use basemat::Simulation;
use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::coupled::{DissipativeMidpoint, HhtAlpha, Midpoint, Newmark, Probe, TimeScheme};
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::Bonded;
use basemat::motion::{FreeField, FreeFieldFn};
use basemat::structure::{
    Base, Bilinear, FemModel, NonlinearForce, RayleighDamping, RigidBlock, ShearBuilding, Storey,
    Structure, StructureGroup, Triplets, WithSprings,
};

use basemat_problems::own_force;
use basemat_problems::scenes::{SCENE_GRAVITY, SI_UNITS, friction, shake, soil};

fn schemes() -> Vec<(&'static str, Box<dyn TimeScheme>)> {
    vec![
        ("midpoint", Box::new(Midpoint)),
        ("dissipative", Box::new(DissipativeMidpoint::default())),
        ("Newmark", Box::new(Newmark::default())),
        ("HHT", Box::new(HhtAlpha::new(-0.1).unwrap())),
    ]
}

fn building() -> ShearBuilding {
    let storeys = [Storey::new(3.0, 2.0e4, 2.0e7); 3];
    ShearBuilding::new(4.0, 3.0e4, 8.0e4, &storeys)
        .unwrap()
        .with_stiffness_damping(0.03)
        .unwrap()
}

/// A concrete wall, much stiffer than its ground.
fn wall() -> FemModel {
    let concrete = Material::new(3e10, 0.2, 2400.0).unwrap();
    let mesh = Mesh::layered_block(-2.0..2.0, 6, &[Layer::new(6.0, 6, concrete)]).unwrap();
    let damping = RayleighDamping::from_ratios([5.0, 50.0], [0.03; 2]).unwrap();
    FemModel::on_base(mesh).unwrap().with_rayleigh(damping)
}

/// The building with a yielding damper in its second storey.
fn yielding_building() -> WithSprings {
    let drift = building().drift(1).unwrap();
    let law = Bilinear::new(4e6, 2e4, 0.1).unwrap();
    WithSprings::new(building()).spring(drift, law).unwrap()
}

fn structures() -> Vec<(&'static str, Box<dyn Structure>)> {
    vec![
        ("block", Box::new(RigidBlock::new(4.0, 6.0, 1500.0).unwrap())),
        ("building", Box::new(building())),
        ("wall", Box::new(wall())),
        ("yielding", Box::new(yielding_building())),
    ]
}

fn ground() -> ElasticGround {
    let strip = Strip::new(-2.0..2.0, 6, Grading::Cosine).unwrap();
    ElasticGround::new(soil(SI_UNITS), strip).unwrap()
}

/// Slow harmonic travel of the ground from rest.
#[derive(Clone, Copy)]
struct GroundTravel {
    /// Horizontal distance from end to end, m.
    distance: f64,
    /// Period, s.
    period: f64,
}

impl GroundTravel {
    fn displacement(self, time: f64) -> [f64; 2] {
        let horizontal = 0.5 * self.distance * (1.0 - (TAU * time / self.period).cos());
        [horizontal, 0.3 * horizontal]
    }
}

/// Largest displacement of any degree of freedom, relative to the ground.
fn largest_displacement(simulation: &Simulation) -> f64 {
    let displacement = simulation.state().displacement();
    displacement.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()))
}

#[test]
fn energy_balance_closes_while_a_sticking_structure_travels() {
    let travel = GroundTravel { distance: 1e6, period: 6e4 };
    let structure_count = structures().len();
    for structure_index in 0..structure_count {
        for (scheme_name, scheme) in schemes() {
            let (structure_name, structure) = structures().swap_remove(structure_index);
            let mut simulation = Simulation::builder(5.0)
                .structure(structure)
                .ground(ground())
                .interface(friction(f64::INFINITY))
                .scheme(scheme)
                .motion(FreeFieldFn::new(move |_, time| travel.displacement(time)))
                .gravity(SCENE_GRAVITY)
                .build()
                .unwrap();
            let mut deformation = 0.0_f64;
            let mut residual = 0.0_f64;
            for _ in 0..400 {
                let state = simulation.step().unwrap();
                residual = residual.max(state.energy_balance.residual());
                deformation = deformation.max(largest_displacement(&simulation));
            }
            println!(
                "{structure_name}, {scheme_name}: travel {:.1e} of the deformation, {residual:.1e}",
                travel.distance / deformation
            );
            assert!(residual < 1e-9, "{structure_name}, {scheme_name}: {residual:.1e}");
        }
    }
}

#[test]
fn energy_balance_closes_while_a_sliding_structure_is_left_behind() {
    for (name, structure) in structures() {
        let travel = GroundTravel { distance: 400.0, period: 40.0 };
        let mut simulation = Simulation::builder(5e-3)
            .structure(structure)
            .ground(ground())
            .interface(friction(0.05))
            .motion(FreeFieldFn::new(move |_, time| travel.displacement(time)))
            .gravity(SCENE_GRAVITY)
            .build()
            .unwrap();
        let run = simulation.run(2000, |_| {}).unwrap();
        println!(
            "{name}: slip {:.1e} m, {:.1e}",
            run.whole.largest_slip.largest().value,
            run.energy_error
        );
        assert!(run.whole.largest_slip.magnitude() > 10.0, "{name}");
        assert!(run.energy_error < 1e-9, "{name}: {:.1e}", run.energy_error);
    }
}

/// Checks two buildings whose grounds move more than a thousand kilometres apart.
fn assert_members_travel_apart(name: &str, left: Box<dyn Structure>, right: Box<dyn Structure>) {
    let group = StructureGroup::new().with(left, -10.0).unwrap().with(right, 10.0).unwrap();
    let travel = GroundTravel { distance: 1e6, period: 6e4 };
    let motion = FreeFieldFn::new(move |x, time| {
        let direction = if x < 0.0 { 1.0 } else { -0.7 };
        travel.displacement(time).map(|value| direction * value)
    });
    let ground =
        ElasticGround::new(soil(SI_UNITS), Strip::under(&group, 6, Grading::Uniform).unwrap())
            .unwrap();
    let mut simulation = Simulation::builder(5.0)
        .structure(group)
        .ground(ground)
        .interface(friction(0.5))
        .motion(motion)
        .gravity(SCENE_GRAVITY)
        .build()
        .unwrap();
    let mut residual = 0.0_f64;
    for _ in 0..400 {
        residual = residual.max(simulation.step().unwrap().energy_balance.residual());
    }
    let displacement = largest_displacement(&simulation);
    println!("{name}: {residual:.1e}, displacement {displacement:.1e} m");
    assert!(residual < 1e-9, "{name}: {residual:.1e}");
    assert!(displacement < 1.0, "{name}: only the grounds have moved");
}

#[test]
fn buildings_of_a_group_travel_apart() {
    assert_members_travel_apart("linear", Box::new(building()), Box::new(building()));
    let left = Box::new(yielding_building());
    assert_members_travel_apart("yielding", left, Box::new(yielding_building()));
}

/// Two blocks that a spring joins once their gap is closed.
struct PoundingBlocks {
    blocks: StructureGroup,
    rows: [usize; 2],
}

/// Gap between the blocks at rest, m.
const POUNDING_GAP: f64 = 0.02;
/// Stiffness of the spring between the blocks, N/m per metre of thickness.
const POUNDING_STIFFNESS: f64 = 5e6;

impl PoundingBlocks {
    fn new() -> Self {
        let block = RigidBlock::new(4.0, 6.0, 1500.0).unwrap();
        let blocks = StructureGroup::new().with(block.clone(), -3.0).unwrap();
        Self { blocks: blocks.with(block, 3.0).unwrap(), rows: [0, 3] }
    }

    /// Overlap of the left block with the right block.
    fn overlap(&self, u: &[f64]) -> f64 {
        (u[self.rows[0]] - u[self.rows[1]] - POUNDING_GAP).max(0.0)
    }
}

impl Structure for PoundingBlocks {
    fn dofs(&self) -> usize {
        self.blocks.dofs()
    }

    fn base(&self) -> Base {
        self.blocks.base()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.blocks.mass(matrix)
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.blocks.stiffness(matrix)
    }

    own_force!();
}

impl NonlinearForce for PoundingBlocks {
    fn force(&self, u: &[f64], force: &mut [f64]) -> basemat::Result<()> {
        let push = POUNDING_STIFFNESS * self.overlap(u);
        force[self.rows[0]] += push;
        force[self.rows[1]] -= push;
        Ok(())
    }

    fn tangent(&self, u: &[f64], matrix: &mut Triplets) -> basemat::Result<()> {
        if self.overlap(u) > 0.0 {
            matrix.add_spring(self.rows[0], self.rows[1], POUNDING_STIFFNESS);
        }
        Ok(())
    }
}

/// Blocks meet when their grounds approach each other by five gaps, though nothing joins them at rest.
#[test]
fn a_force_between_parts_depends_on_their_distance() {
    let structure = PoundingBlocks::new();
    let ground =
        ElasticGround::new(soil(SI_UNITS), Strip::under(&structure, 6, Grading::Uniform).unwrap())
            .unwrap();
    let approach = FreeFieldFn::new(|x: f64, t: f64| {
        let phase = 1.0 - (TAU * t.min(1.0)).cos();
        [-x.signum() * 0.5 * 5.0 * POUNDING_GAP * phase / 2.0, 0.0]
    });
    let mut simulation = Simulation::builder(2.5e-3)
        .structure(structure)
        .ground(ground)
        .interface(Bonded)
        .motion(approach)
        .gravity(SCENE_GRAVITY)
        .build()
        .unwrap();
    let mut smallest_distance = f64::INFINITY;
    let mut largest_push = 0.0_f64;
    simulation
        .run(400, |state| {
            let u = state.absolute_displacement();
            smallest_distance = smallest_distance.min(u[3] - u[0]);
            largest_push = largest_push.max(-state.foundations[0].base_shear);
            assert!(state.energy_balance.residual() < 1e-9);
        })
        .unwrap();
    // The gap closes, but less than the grounds approach: the blocks push each other back.
    assert!(smallest_distance < -POUNDING_GAP, "{smallest_distance}");
    assert!(smallest_distance > -5.0 * POUNDING_GAP, "{smallest_distance}");
    let overlap = -smallest_distance - POUNDING_GAP;
    assert!(largest_push > 0.1 * POUNDING_STIFFNESS * overlap, "{largest_push}");
}

/// Displacement and acceleration of the roof and base shear of the building in every step.
fn building_response(motion: FreeFieldFn) -> Vec<[f64; 3]> {
    let building = building();
    let mut simulation = Simulation::builder(2.5e-3)
        .probe(Probe::displacement("roof", building.roof()))
        .probe(Probe::acceleration("roof acceleration", building.roof()))
        .structure(building)
        .ground(ground())
        .interface(Bonded)
        .motion(motion)
        .gravity(SCENE_GRAVITY)
        .build()
        .unwrap();
    let mut response = Vec::new();
    simulation
        .run(800, |state| response.push([state.probes[0], state.probes[1], state.base_shear]))
        .unwrap();
    response
}

/// Sum of two pulses and slow travel with these factors.
fn combined_motion(pulse_factor: f64, travel_factor: f64) -> FreeFieldFn {
    let travel = GroundTravel { distance: 1e3, period: 400.0 };
    let pulses = shake(SI_UNITS, 0.6);
    FreeFieldFn::new(move |x, time| {
        let slow_displacement = travel.displacement(time);
        let fast_displacement = pulses.displacement(x, time);
        [0, 1].map(|k| travel_factor * slow_displacement[k] + pulse_factor * fast_displacement[k])
    })
}

#[test]
fn travel_superposes_on_a_record() {
    let combined_response = building_response(combined_motion(1.0, 1.0));
    let by_travel = building_response(combined_motion(0.0, 1.0));
    let by_pulses = building_response(combined_motion(1.0, 0.0));
    for k in 0..3 {
        let mut peak = 0.0_f64;
        let mut difference = 0.0_f64;
        for ((combined_response, travel), pulses) in
            combined_response.iter().zip(&by_travel).zip(&by_pulses)
        {
            peak = peak.max(pulses[k].abs());
            difference = difference.max((combined_response[k] - travel[k] - pulses[k]).abs());
        }
        println!("quantity {k}: {:.1e} of the peak", difference / peak);
        assert!(difference < 1e-9 * peak, "quantity {k}: {:.1e}", difference / peak);
    }
}
