//! GOAL: a ground that travels far costs no digits of what the structure does on it.
//! SCENE: stiff and light structures on grounds that drift by kilometres, sticking and sliding,
//! with three time schemes; two buildings whose grounds part.
//! REFERENCE: the energy balance; the same run without the travel.

use std::f64::consts::TAU;

use basemat::Simulation;
use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::coupled::{DissipativeMidpoint, HhtAlpha, Midpoint, Newmark, Probe, TimeScheme};
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::Bonded;
use basemat::motion::{FreeField, FreeFieldFn};
use basemat::results::Run;
use basemat::structure::{
    Base, Bilinear, FemModel, NonlinearForce, RayleighDamping, RigidBlock, ShearBuilding, Storey,
    Structure, StructureGroup, Triplets, WithSprings,
};

use basemat_problems::own_force;
use basemat_problems::scenes::{GRAVITY, SI, friction, shake, soil};

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
    ShearBuilding::new(4.0, 3.0e4, 8.0e4, &storeys).unwrap().with_stiffness_damping(0.03).unwrap()
}

/// A concrete wall, stiff against everything around it.
fn wall() -> FemModel {
    let concrete = Material::new(3e10, 0.2, 2400.0).unwrap();
    let mesh = Mesh::layered_block(-2.0..2.0, 6, &[Layer::new(6.0, 6, concrete)]).unwrap();
    let damping = RayleighDamping::from_ratios([5.0, 50.0], [0.03; 2]).unwrap();
    FemModel::on_base(mesh).unwrap().with_rayleigh(damping)
}

fn structures() -> Vec<(&'static str, Box<dyn Structure>)> {
    let shears = building();
    let drift = shears.drift(1).unwrap();
    let law = Bilinear::new(4e6, 2e4, 0.1).unwrap();
    vec![
        ("block", Box::new(RigidBlock::new(4.0, 6.0, 1500.0).unwrap())),
        ("building", Box::new(building())),
        ("wall", Box::new(wall())),
        ("yielding", Box::new(WithSprings::new(shears).spring(drift, law).unwrap())),
    ]
}

fn ground() -> ElasticGround {
    let strip = Strip::new(-2.0..2.0, 6, Grading::Cosine).unwrap();
    ElasticGround::new(soil(SI), strip).unwrap()
}

/// Sways slowly by `travel` (m) in both directions, with a period of `period` (s), from rest.
fn total_drift(travel: f64, period: f64) -> impl Fn(f64) -> [f64; 2] + Clone {
    move |t| {
        let part = 0.5 * travel * (1.0 - (TAU * t / period).cos());
        [part, 0.3 * part]
    }
}

/// Largest displacement of any degree of freedom, relative to the ground.
fn largest(simulation: &Simulation) -> f64 {
    simulation.state().displacement().iter().fold(0.0_f64, |m, u| m.max(u.abs()))
}

#[test]
fn energy_balance_closes_while_a_sticking_structure_travels() {
    let (travel, period) = (1e6, 6e4);
    for (structure_name, _) in structures() {
        for (scheme_name, _) in schemes() {
            let pick = |(name, _): &(&str, _)| *name == structure_name;
            let (_, structure) = structures().into_iter().find(pick).unwrap();
            let (_, scheme) = schemes().into_iter().find(|(name, _)| *name == scheme_name).unwrap();
            let at = total_drift(travel, period);
            let mut simulation = Simulation::builder(5.0)
                .structure(structure)
                .ground(ground())
                .interface(friction(f64::INFINITY))
                .scheme(scheme)
                .motion(FreeFieldFn::new(move |_, t| at(t)))
                .gravity(GRAVITY)
                .build()
                .unwrap();
            let mut deformation = 0.0_f64;
            let mut residual = 0.0_f64;
            for _ in 0..400 {
                let state = simulation.step().unwrap();
                residual = residual.max(state.energy_balance.residual());
                deformation = deformation.max(largest(&simulation));
            }
            println!(
                "{structure_name}, {scheme_name}: travel {:.1e} of the deformation, {residual:.1e}",
                travel / deformation
            );
            assert!(residual < 1e-9, "{structure_name}, {scheme_name}: {residual:.1e}");
        }
    }
}

#[test]
fn energy_balance_closes_while_a_sliding_structure_is_left_behind() {
    for (name, structure) in structures() {
        let at = total_drift(400.0, 40.0);
        let mut simulation = Simulation::builder(5e-3)
            .structure(structure)
            .ground(ground())
            .interface(friction(0.05))
            .motion(FreeFieldFn::new(move |_, t| at(t)))
            .gravity(GRAVITY)
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

/// Two buildings whose grounds part by more than a thousand kilometres.
fn apart(name: &str, member: impl Fn() -> Box<dyn Structure>) {
    let group = StructureGroup::new().with(member(), -10.0).unwrap();
    let group = group.with(member(), 10.0).unwrap();
    let at = total_drift(1e6, 6e4);
    let motion = FreeFieldFn::new(move |x, t| at(t).map(|u| if x < 0.0 { u } else { -0.7 * u }));
    let ground =
        ElasticGround::new(soil(SI), Strip::under(&group, 6, Grading::Uniform).unwrap()).unwrap();
    let mut simulation = Simulation::builder(5.0)
        .structure(group)
        .ground(ground)
        .interface(friction(0.5))
        .motion(motion)
        .gravity(GRAVITY)
        .build()
        .unwrap();
    let mut residual = 0.0_f64;
    for _ in 0..400 {
        residual = residual.max(simulation.step().unwrap().energy_balance.residual());
    }
    println!("{name}: {residual:.1e}, displacement {:.1e} m", largest(&simulation));
    assert!(residual < 1e-9, "{name}: {residual:.1e}");
    assert!(largest(&simulation) < 1.0, "{name}: only the grounds have moved");
}

#[test]
fn buildings_of_a_group_travel_apart() {
    apart("linear", || Box::new(building()));
    apart("yielding", || {
        let shears = building();
        let drift = shears.drift(1).unwrap();
        let law = Bilinear::new(4e6, 2e4, 0.1).unwrap();
        Box::new(WithSprings::new(shears).spring(drift, law).unwrap())
    });
}

/// Two blocks, and a spring between them beyond a gap: a nonlinear force that joins two parts.
struct Pounding {
    blocks: StructureGroup,
    rows: [usize; 2],
}

const GAP: f64 = 0.02;
const STOP: f64 = 5e6;

impl Pounding {
    fn new() -> Self {
        let block = || RigidBlock::new(4.0, 6.0, 1500.0).unwrap();
        let blocks = StructureGroup::new().with(block(), -3.0).unwrap();
        Self { blocks: blocks.with(block(), 3.0).unwrap(), rows: [0, 3] }
    }

    /// Overlap of the left block with the right block.
    fn overlap(&self, u: &[f64]) -> f64 {
        (u[self.rows[0]] - u[self.rows[1]] - GAP).max(0.0)
    }
}

impl Structure for Pounding {
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

impl NonlinearForce for Pounding {
    fn force(&self, u: &[f64], force: &mut [f64]) -> basemat::Result<()> {
        let push = STOP * self.overlap(u);
        force[self.rows[0]] += push;
        force[self.rows[1]] -= push;
        Ok(())
    }

    fn tangent(&self, u: &[f64], matrix: &mut Triplets) -> basemat::Result<()> {
        if self.overlap(u) > 0.0 {
            matrix.add_spring(self.rows[0], self.rows[1], STOP);
        }
        Ok(())
    }
}

/// The grounds of two blocks approach each other by five gaps: what stands on them must meet, though
/// nothing joins the two at rest.
#[test]
fn a_force_between_parts_sees_their_distance() {
    let structure = Pounding::new();
    let ground =
        ElasticGround::new(soil(SI), Strip::under(&structure, 6, Grading::Uniform).unwrap())
            .unwrap();
    let at =
        |x: f64, t: f64| -x.signum() * 0.5 * 5.0 * GAP * (1.0 - (TAU * t.min(1.0)).cos()) / 2.0;
    let mut simulation = Simulation::builder(2.5e-3)
        .structure(structure)
        .ground(ground)
        .interface(Bonded)
        .motion(FreeFieldFn::new(move |x, t| [at(x, t), 0.0]))
        .gravity(GRAVITY)
        .build()
        .unwrap();
    let mut nearest = f64::INFINITY;
    let mut pushed = 0.0_f64;
    simulation
        .run(400, |state| {
            let u = state.absolute_displacement();
            nearest = nearest.min(u[3] - u[0]);
            pushed = pushed.max(-state.foundations[0].base_shear);
            assert!(state.energy_balance.residual() < 1e-9);
        })
        .unwrap();
    // Beyond the gap, but less than the grounds: the blocks push each other back.
    assert!(nearest < -GAP && nearest > -5.0 * GAP, "{nearest}");
    assert!(pushed > 0.1 * STOP * (-nearest - GAP), "{pushed}");
}

#[test]
fn travel_superposes_on_a_record() {
    let carrier = total_drift(1e3, 400.0);
    let record = shake(SI, 0.6);
    let run = |motion: FreeFieldFn| -> Vec<[f64; 3]> {
        let building = building();
        let mut simulation = Simulation::builder(2.5e-3)
            .probe(Probe::displacement("roof", building.roof()))
            .probe(Probe::acceleration("roof acceleration", building.roof()))
            .structure(building)
            .ground(ground())
            .interface(Bonded)
            .motion(motion)
            .gravity(GRAVITY)
            .build()
            .unwrap();
        let mut seen = Vec::new();
        let _: Run = simulation
            .run(800, |state| {
                seen.push([state.probes[0], state.probes[1], state.base_shear]);
            })
            .unwrap();
        seen
    };
    let moved = |record_share: f64, carrier_share: f64| {
        let (carrier, record) = (carrier.clone(), shake(SI, 0.6));
        FreeFieldFn::new(move |x, t| {
            let (far, near) = (carrier(t), record.displacement(x, t));
            [0, 1].map(|k| carrier_share * far[k] + record_share * near[k])
        })
    };
    drop(record);
    let (both, far, near) = (run(moved(1.0, 1.0)), run(moved(0.0, 1.0)), run(moved(1.0, 0.0)));
    for k in 0..3 {
        let peak = near.iter().fold(0.0_f64, |m, values| m.max(values[k].abs()));
        let apart = both
            .iter()
            .zip(&far)
            .zip(&near)
            .fold(0.0_f64, |m, ((both, far), near)| m.max((both[k] - far[k] - near[k]).abs()));
        println!("quantity {k}: {:.1e} of the peak", apart / peak);
        assert!(apart < 1e-9 * peak, "quantity {k}: {:.1e}", apart / peak);
    }
}
