//! GOAL: several structures on one ground move as they should.
//! SCENE: far apart on the half-plane; twins; nonlinear members.
//! REFERENCE: each structure alone, or the mirror image.

use basemat::bem::{ElasticGround, Strip};
use basemat::coupled::CheckpointError;
use basemat::coupled::{Coordinates, Probe, SimulationBuilder, State};
use basemat::history::HistoryMethod;
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{RickerDisplacement, STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{
    Base, CraigBampton, DofCombination, ModalDamping, NonlinearForce, RigidBlock, ShearBuilding,
    Storey, Structure, StructureGroup, Triplets, WithSprings,
};
use basemat::{Error, Result, Simulation, Soil};

use basemat_problems::{needed_from, own_force};

const TIME_STEP: f64 = 0.002;

fn soil() -> Soil {
    Soil::new(60.0e6, 0.3, 1900.0).unwrap()
}

pub(super) fn tower() -> ShearBuilding {
    let storeys = [Storey::new(3.0, 15.0e3, 25.0e6); 4];
    let tower = ShearBuilding::new(4.0, 30.0e3, 8.0e4, &storeys).unwrap();
    tower.with_stiffness_damping(0.04).unwrap()
}

pub(super) fn block() -> RigidBlock {
    RigidBlock::new(3.0, 7.0, 1800.0).unwrap()
}

pub(super) fn base_scene() -> SimulationBuilder {
    Simulation::builder(TIME_STEP)
        .interface(Coulomb::new(0.4).unwrap())
        .motion(el_centro_1940())
        .gravity(STANDARD_GRAVITY)
}

pub(super) fn strip(center: f64, width: f64) -> Strip {
    Strip::uniform(center - 0.5 * width..center + 0.5 * width, 6).unwrap()
}

fn half_plane(strips: &[Strip]) -> ElasticGround {
    ElasticGround::new(soil(), strips).unwrap()
}

pub(super) fn states(mut simulation: Simulation, steps: usize) -> Vec<State> {
    let mut states = Vec::new();
    simulation.run(steps, |state| states.push(state.clone())).unwrap();
    states
}

/// Largest difference of the tractions of two runs, relative to the largest traction of the part.
///
/// The part's elements begin at `first` among those of the whole.
pub(super) fn traction_difference(whole: &[State], part: &[State], first: usize) -> f64 {
    let mut difference = 0.0_f64;
    let mut scale = 0.0_f64;
    for (whole, part) in whole.iter().zip(part) {
        for (k, contact) in part.contact.iter().enumerate() {
            let whole_contact = &whole.contact[first + k];
            for (a, b) in
                [(contact.pressure, whole_contact.pressure), (contact.shear, whole_contact.shear)]
            {
                scale = scale.max(a.abs());
                difference = difference.max((a - b).abs());
            }
        }
    }
    difference / scale
}

/// A bonded run without weight in physical coordinates.
fn weightless_run(builder: SimulationBuilder, steps: usize) -> Vec<State> {
    let bonded = builder.gravity(0.0).interface(Bonded);
    states(bonded.coordinates(Coordinates::Physical).build().unwrap(), steps)
}

/// GOAL: until waves have arrived from the other structure, each moves as if it were alone.
/// CONFIG: half-plane without weight (statics act at any distance), 20 m apart, both bonded.
#[test]
fn structures_move_as_if_alone_until_waves_arrive() {
    let distance = 20.0;
    let travel = (distance - 3.5) / soil().pressure_wave_speed();
    let before = (1_u32..1000).take_while(|&n| f64::from(n) * TIME_STEP <= travel).count();
    let steps = 8 * before;
    let group = StructureGroup::new().with(tower(), 0.0).unwrap().with(block(), distance).unwrap();
    let strips = [strip(0.0, 4.0), strip(distance, 3.0)];
    let group_states =
        weightless_run(base_scene().structure(group).ground(half_plane(&strips)), steps);
    let first =
        weightless_run(base_scene().structure(tower()).ground(half_plane(&strips[..1])), steps);
    let block = block().centered_at(distance).unwrap();
    let second =
        weightless_run(base_scene().structure(block).ground(half_plane(&strips[1..])), steps);
    assert!(before > 20 && first[before - 1].contact[0].shear != 0.0);
    for (alone, from) in [(&first, 0), (&second, 6)] {
        assert!(traction_difference(&group_states[..before], &alone[..before], from) < 1e-12);
        // Later each structure responds to the other.
        let late_difference = traction_difference(&group_states, alone, from);
        assert!(late_difference > 1e-6, "{late_difference}");
    }
}

/// GOAL: under a uniform vertical pulse the motions of two equal blocks are mirror images
/// (each is pulled towards the other).
#[test]
fn twins_mirror_each_other_under_a_vertical_pulse() {
    let pulse = RickerDisplacement::new(0.05, 0.05, 0.3).unwrap().vertical();
    let group = StructureGroup::new().with(block(), -2.5).unwrap().with(block(), 2.5).unwrap();
    let strips = [strip(-2.5, 3.0), strip(2.5, 3.0)];
    let simulation =
        base_scene().structure(group).motion(pulse).ground(half_plane(&strips)).build();
    let states_of_twins = states(simulation.unwrap(), 400);
    let peak = states_of_twins
        .iter()
        .fold(0.0_f64, |m, s| m.max(s.foundations[0].base_rotation.abs()));
    assert!(peak > 1e-6);
    for state in &states_of_twins {
        let [left, right] = &state.foundations[..] else { panic!() };
        assert!((left.base_rotation + right.base_rotation).abs() < 1e-8 * peak.max(1e-3));
        assert!(
            (left.base_shear + right.base_shear).abs() < 1e-7 * left.normal_force.abs().max(1.0e3)
        );
    }
}

/// A member with internal variables and a nonlinear force.
struct Softening {
    block: RigidBlock,
    memory: f64,
}

impl Structure for Softening {
    needed_from!(block);

    own_force!();
}

impl NonlinearForce for Softening {
    /// P–Δ of a dead weight, as a force.
    fn force(&self, u: &[f64], force: &mut [f64]) -> Result<()> {
        force[RigidBlock::ROTATION_DOF] -= 2.0e5 * u[RigidBlock::ROTATION_DOF];
        Ok(())
    }

    fn tangent(&self, _: &[f64], matrix: &mut Triplets) -> Result<()> {
        matrix.add(RigidBlock::ROTATION_DOF, RigidBlock::ROTATION_DOF, -2.0e5);
        Ok(())
    }

    fn commit(&mut self, u: &[f64]) {
        self.memory = u[0];
    }

    fn save(&self) -> Result<Vec<f64>> {
        Ok(vec![self.memory])
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        let [memory] = values else {
            return Err(CheckpointError::Corrupt { quantity: "memory" }.into());
        };
        self.memory = *memory;
        Ok(())
    }
}

fn softening_pair() -> StructureGroup {
    let softening = Softening { block: block(), memory: 0.0 };
    StructureGroup::new().with(block(), 0.0).unwrap().with(softening, 5.0).unwrap()
}

fn softening_scene(strips: &[Strip]) -> Simulation {
    let ground = half_plane(strips).with_history(HistoryMethod::Direct).unwrap();
    base_scene().structure(softening_pair()).ground(ground).build().unwrap()
}

#[test]
fn nonlinear_members_act_on_their_degrees_of_freedom() {
    let strips = [strip(0.0, 3.0), strip(5.0, 3.0)];
    let mut simulation = softening_scene(&strips);
    simulation.run(100, |_| {}).unwrap();
    let checkpoint = simulation.checkpoint().unwrap();
    let states_after_checkpoint = states(simulation, 50);
    let mut other_simulation = softening_scene(&strips);
    other_simulation.resume(&checkpoint).unwrap();
    let resumed_states = states(other_simulation, 50);
    assert_eq!(
        states_after_checkpoint[49].absolute_displacement(),
        resumed_states[49].absolute_displacement()
    );
    // The same motion with a linear P–Δ of the second block.
    let linear_block = block().with_p_delta(2.0e5 / (block().total_mass() * 3.5)).unwrap();
    let pair = StructureGroup::new().with(block(), 0.0).unwrap().with(linear_block, 5.0).unwrap();
    let reference = base_scene().structure(pair).ground(half_plane(&strips));
    let reference = states(reference.build().unwrap(), 150);
    let difference = traction_difference(&reference[100..], &states_after_checkpoint, 0);
    assert!(difference < 1e-6, "{difference:e}");
}

fn block_pair() -> StructureGroup {
    StructureGroup::new().with(block(), 0.0).unwrap().with(block(), 5.0).unwrap()
}

#[test]
fn invalid_groups_are_errors() {
    let two = StructureGroup::new().with(block(), 0.0).unwrap();
    assert!(matches!(two.with(block(), 2.9), Err(Error::Input { .. })));
    let two = StructureGroup::new().with(block(), 0.0).unwrap();
    assert!(matches!(two.with(block(), f64::NAN), Err(Error::Input { .. })));
    // An element between the two blocks, and a foundation without elements.
    let across = [strip(0.0, 3.0), Strip::uniform(1.7..2.3, 1).unwrap(), strip(5.0, 3.0)];
    let result = base_scene().structure(block_pair()).ground(half_plane(&across)).build();
    assert!(matches!(result, Err(Error::Part { .. })), "{:?}", result.err());
    let result = base_scene().structure(block_pair()).ground(half_plane(&across[..1])).build();
    assert!(matches!(result, Err(Error::Size { .. })), "{:?}", result.err());
    let empty_foundation = base_scene()
        .structure(StructureGroup::new())
        .ground(half_plane(&across[..1]))
        .build();
    assert!(empty_foundation.is_err());
}

/// A block whose `mass` replaces the matrix that it should fill.
struct Replacing(RigidBlock);

impl Structure for Replacing {
    fn dofs(&self) -> usize {
        self.0.dofs()
    }

    fn base(&self) -> Base {
        self.0.base()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        let mut replacement = Triplets::new(self.0.dofs());
        self.0.mass(&mut replacement)?;
        *matrix = replacement;
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.0.stiffness(matrix)
    }
}

/// A single structure may replace the matrix; in a group the entries of the other members would be lost.
#[test]
fn members_that_replace_the_matrix_of_their_group_are_errors() {
    let single_structure =
        base_scene().structure(Replacing(block())).ground(half_plane(&[strip(0.0, 3.0)]));
    assert!(single_structure.build().is_ok());
    let pair = StructureGroup::new().with(block(), 0.0).unwrap();
    let pair = pair.with(Replacing(block()), 5.0).unwrap();
    let strips = [strip(0.0, 3.0), strip(5.0, 3.0)];
    let result = base_scene().structure(pair).ground(half_plane(&strips)).build();
    assert!(matches!(result, Err(Error::Size { .. })), "{:?}", result.err());
}

fn tower_and_block() -> StructureGroup {
    StructureGroup::new().with(tower(), 0.0).unwrap().with(block(), 5.0).unwrap()
}

#[test]
fn foundations_stay_separate_in_every_wrapper() {
    let wrapped_groups: [Box<dyn Structure>; 3] = [
        Box::new(WithSprings::new(tower_and_block())),
        Box::new(ModalDamping::new(&[0.05]).unwrap().on(tower_and_block()).unwrap()),
        Box::new(CraigBampton::new(2).reduce(tower_and_block()).unwrap()),
    ];
    let boxed_group: Box<dyn Structure> = Box::new(tower_and_block());
    for structure in wrapped_groups.into_iter().chain([boxed_group]) {
        let Base::Lines(lines) = structure.base() else {
            panic!("a base in the plane")
        };
        assert_eq!(lines.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
    }
    let strips = [strip(0.0, 4.0), strip(5.0, 3.0)];
    let group_with_springs = WithSprings::new(tower_and_block());
    let simulation = base_scene().structure(group_with_springs).ground(half_plane(&strips));
    assert_eq!(simulation.build().unwrap().state().foundations.len(), 2);
}

/// A block on two foundations: its ends, one node each.
struct Stilts(RigidBlock);

impl Structure for Stilts {
    fn dofs(&self) -> usize {
        self.0.dofs()
    }

    fn base(&self) -> Base {
        Base::Lines(self.0.base().nodes().map(|node| vec![node.clone()]).collect())
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.0.mass(matrix)
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.0.stiffness(matrix)
    }
}

#[test]
fn foundations_of_one_node_are_errors() {
    let strips = [strip(0.0, 3.0), strip(5.0, 3.0)];
    let pair = StructureGroup::new().with(block(), 0.0).unwrap().with(Stilts(block()), 5.0);
    let result = base_scene().structure(pair.unwrap()).ground(half_plane(&strips)).build();
    let Err(Error::Size { quantity, found: 1, needed: 2 }) = result else {
        panic!("{:?}", result.err())
    };
    assert_eq!(quantity, "list of contact nodes of a foundation");
}

/// GOAL: a probe of one member has no degrees of freedom of another.
/// CONFIG: a tower of seven degrees of freedom before a block of three.
#[test]
fn rows_and_probes_stay_within_their_member() {
    let group = StructureGroup::new().with(tower(), 0.0).unwrap().with(block(), 5.0).unwrap();
    assert_eq!(group.row(0, tower().roof()).unwrap(), DofCombination::from(6));
    assert_eq!(group.row(1, 2).unwrap(), DofCombination::from(9));
    // The tower's eighth degree of freedom would be the block's first.
    let quantity = "degree of freedom of a structure of the group";
    assert_eq!(group.row(0, 7), Err(Error::Index { quantity, index: 7, bound: 7 }));
    for index in [3, usize::MAX] {
        assert_eq!(group.row(1, index), Err(Error::Index { quantity, index, bound: 3 }));
    }
    let quantity = "structure of the group";
    assert_eq!(group.row(2, 0), Err(Error::Index { quantity, index: 2, bound: 2 }));
    assert!(matches!(group.row(0, (0, f64::NAN)), Err(Error::Input { .. })));

    // A section has displacements and velocities, whose indices are all shifted.
    let rows = tower().shear(1).unwrap();
    let member_probe = Probe::section("shear", &rows);
    let group = StructureGroup::new().with(block(), -5.0).unwrap().with(tower(), 0.0).unwrap();
    let group_probe = group.probe(1, member_probe.clone()).unwrap();
    assert_eq!(group_probe.name, "shear");
    for (group_probe, member_probe) in [
        (&group_probe.displacement, &member_probe.displacement),
        (&group_probe.velocity, &member_probe.velocity),
    ] {
        assert!(!member_probe.is_empty());
        let expected: DofCombination =
            member_probe.into_iter().map(|&(index, weight)| (index + 3, weight)).collect();
        assert_eq!(*group_probe, expected);
    }
    assert!(group_probe.acceleration.is_empty());
    let error = group.probe(0, member_probe).unwrap_err();
    let source = Error::Index {
        quantity: "degree of freedom of a structure of the group",
        index: 4,
        bound: 3,
    };
    assert_eq!(error, Error::Item { item: "probe 'shear'".to_owned(), source: Box::new(source) });
}
