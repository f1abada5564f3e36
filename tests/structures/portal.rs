//! GOAL: a frame of beam elements on two strip footings: its frequency on a fixed base, and statics while the footings
//! uplift and slide.
//! SCENE: a portal, each column on a rigid footing, under El Centro.
//! REFERENCE: the slope-deflection method; the moment of the inertia forces equals that of the footing forces, in
//! every step.

use basemat::Result;
use basemat::fem::{Beam, Direction, LumpedMass, Mesh};
use basemat::prelude::*;
use basemat::structure::{CraigBampton, DofCombination};

/// Height of the columns and span of the beam, m.
const COLUMN_HEIGHT: f64 = 5.0;
const BEAM_SPAN: f64 = 8.0;
/// Areas (m²/m) and second moments of area (m⁴/m): columns 0.6 × 0.6 m and a beam 0.4 × 0.8 m, every 5 m.
const COLUMN_AREA: f64 = 0.072;
const COLUMN_SECOND_MOMENT: f64 = 2.16e-3;
const BEAM_AREA: f64 = 0.064;
const BEAM_SECOND_MOMENT: f64 = 3.413e-3;
const YOUNG_MODULUS: f64 = 30.0e9;
/// Mass of the roof, frame included, kg/m.
const ROOF_MASS: f64 = 30.0e3;
/// Thickness of the footings, m.
const FOOTING_DEPTH: f64 = 0.6;
/// Density of the footings, kg/m³.
const FOOTING_DENSITY: f64 = 2400.0;

/// A member without mass.
fn member(ends: [usize; 2], area: f64, second_moment: f64) -> Result<Beam> {
    Beam::new(ends, YOUNG_MODULUS, area, second_moment, 0.0)
}

/// The frame, and its results as weighted sums of its degrees of freedom.
struct Portal {
    model: FemModel,
    /// Mass of one footing, kg/m.
    footing_mass: f64,
    /// Moment that inertia exerts on the ground about the frame's middle, from accelerations.
    overturning: DofCombination,
}

impl Portal {
    /// On footings of `width` (m); the areas of columns and beam are multiplied by `area_factor`.
    fn new(width: f64, area_factor: f64) -> Result<Self> {
        let mut mesh = Mesh::new();
        let mut lines = Vec::new();
        for x in [-0.5 * BEAM_SPAN, 0.5 * BEAM_SPAN] {
            let line = [x - 0.5 * width, x, x + 0.5 * width].map(|x| mesh.add_node(x, 0.0));
            let line = line.into_iter().collect::<Result<Vec<_>>>()?;
            for ends in [[line[0], line[1]], [line[1], line[2]]] {
                let second_moment = FOOTING_DEPTH.powi(3) / 12.0;
                mesh.add(Beam::new(
                    ends,
                    YOUNG_MODULUS,
                    FOOTING_DEPTH,
                    second_moment,
                    FOOTING_DENSITY,
                )?)?;
            }
            let top = mesh.add_node(x, COLUMN_HEIGHT)?;
            let column = member([line[1], top], area_factor * COLUMN_AREA, COLUMN_SECOND_MOMENT)?;
            mesh.add(column)?;
            mesh.add(LumpedMass::new(top, 0.5 * ROOF_MASS)?)?;
            lines.push(line);
        }
        let left = mesh.node_at(-0.5 * BEAM_SPAN, COLUMN_HEIGHT)?;
        let right = mesh.node_at(0.5 * BEAM_SPAN, COLUMN_HEIGHT)?;
        mesh.add(member([left, right], area_factor * BEAM_AREA, BEAM_SECOND_MOMENT)?)?;
        let mut model = FemModel::on_foundations(mesh, &lines)?;
        for line in &lines {
            model = model.with_rigid_link(line[1], &[line[0], line[2]])?;
        }

        let roof = 0.5 * ROOF_MASS;
        let footing_mass = FOOTING_DENSITY * FOOTING_DEPTH * width;
        let mut overturning = DofCombination::default();
        for x in [-0.5 * BEAM_SPAN, 0.5 * BEAM_SPAN] {
            let foot = model.mesh().node_at(x, 0.0)?;
            let top = model.mesh().node_at(x, COLUMN_HEIGHT)?;
            let sway = model.row(top, Direction::X)?;
            overturning += roof * COLUMN_HEIGHT * sway
                - x * roof * model.row(top, Direction::Y)?
                - x * footing_mass * model.row(foot, Direction::Y)?
                - footing_mass * width.powi(2) / 12.0 * model.row(foot, Direction::Rotation)?;
        }
        Ok(Self { model, footing_mass, overturning })
    }

    /// Lowest frequency (Hz) with fixed footings: the sway of the roof, the only mass.
    fn fixed_base_frequency(self) -> Result<f64> {
        Ok(CraigBampton::new(1).reduce(self.model)?.frequencies()[0])
    }

    /// Checks equilibrium at rest and in every step under El Centro.
    fn shake(self, law: impl InterfaceLaw + 'static) -> Result<()> {
        let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0)?;
        // 5 % of critical damping in the sway on a fixed base.
        let beta = 0.05 / (std::f64::consts::PI * closed_form_frequency());
        let model = self.model.with_rayleigh(RayleighDamping::new(0.0, beta)?);
        let mut simulation = Simulation::builder(0.005)
            .ground(ElasticGround::under(soil, &model, 8)?)
            .structure(model)
            .interface(law)
            .motion(el_centro_1940())
            .probe(Probe::acceleration("overturning", self.overturning).in_unit("N·m/m"))
            .build()?;

        let weight = STANDARD_GRAVITY * (ROOF_MASS + 2.0 * self.footing_mass);
        assert!((simulation.state().normal_force / weight - 1.0).abs() < 1e-9);
        let mut max_magnitude = 0.0_f64;
        let mut error = 0.0_f64;
        simulation.run(simulation.steps_for(8.0), |state| {
            // The axial pair of the footings and their base moments balance the inertia forces.
            let [left, right] = &state.foundations[..] else {
                unreachable!("two foundations")
            };
            let pair = 0.5 * BEAM_SPAN * (left.normal_force - right.normal_force);
            let moment = pair + left.base_moment + right.base_moment;
            max_magnitude = max_magnitude.max(moment.abs());
            error = error.max((moment - state.probes[0]).abs());
        })?;
        assert!(error < 1e-9 * max_magnitude, "moments differ by {error} of {max_magnitude}");
        Ok(())
    }
}

/// First frequency (Hz) on a fixed base when no member changes its length: lateral stiffness
/// 24 E I_c/h³ · (1 + 6k)/(4 + 6k) with k = (I_b/l)/(I_c/h) (slope-deflection method).
fn closed_form_frequency() -> f64 {
    let k = BEAM_SECOND_MOMENT / BEAM_SPAN / (COLUMN_SECOND_MOMENT / COLUMN_HEIGHT);
    let ends = (1.0 + 6.0 * k) / (4.0 + 6.0 * k);
    let stiffness = 24.0 * YOUNG_MODULUS * COLUMN_SECOND_MOMENT / COLUMN_HEIGHT.powi(3) * ends;
    (stiffness / ROOF_MASS).sqrt() / std::f64::consts::TAU
}

/// Error of the frequency on a fixed base of the portal with member areas multiplied by `area_factor`.
fn fixed_base_error(area_factor: f64) -> f64 {
    let portal = Portal::new(2.0, area_factor).unwrap();
    portal.fixed_base_frequency().unwrap() / closed_form_frequency() - 1.0
}

#[test]
fn the_frequency_on_a_fixed_base_is_the_closed_form() {
    let stiff_error = fixed_base_error(1e5);
    let real = fixed_base_error(1.0);
    // Extensible members make the frame softer.
    assert!(stiff_error.abs() < 1e-6 && (-0.01..0.0).contains(&real), "{stiff_error:e}, {real:e}");
}

#[test]
fn footing_forces_balance_inertia_forces_in_every_step() {
    Portal::new(2.0, 1.0).unwrap().shake(Bonded).unwrap();
    Portal::new(2.0, 1.0).unwrap().shake(Coulomb::new(0.3).unwrap()).unwrap();
    Portal::new(2.0, 1.0).unwrap().shake(Coulomb::new(0.5).unwrap()).unwrap();
}
