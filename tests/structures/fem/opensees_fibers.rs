//! GOAL: laws of fibres and cantilevers of fibres agree with OpenSees' laws and elements of the same definitions.
//! SCENE: paths of strain; a column under its weight whose top moves to and fro, by both formulations.
//! REFERENCE: tables of OpenSees 3.7.1 (`tests/data/fibers`), which `opensees.py` beside them writes.

use basemat::fem::{
    BeamFormulation, BeamQuadrature, BilinearSteel, Concrete, FiberBeam, FiberSection,
    InelasticForce, MenegottoPinto, UniaxialMaterial,
};
use basemat::structure::Triplets;
use basemat_problems::dense::{dense, largest, solve_with_prescribed};
use basemat_problems::table;

/// Dimensions, materials and loads of `opensees.py`.
const COLUMN_HEIGHT: f64 = 3.0;
const TOP_WEIGHT: f64 = 400.0e3;
const LAYER_COUNT: usize = 20;
const BAR_AREA: f64 = 491.0e-6;

fn bilinear_steel() -> BilinearSteel {
    BilinearSteel::new(420.0e6, 200.0e9, 0.015).unwrap()
}

fn curved_steel() -> MenegottoPinto {
    let steel = MenegottoPinto::new(420.0e6, 200.0e9, 0.015).unwrap();
    steel.with_transition(18.0, 0.925, 0.15).unwrap()
}

fn concrete() -> Concrete {
    Concrete::new(28.0e6, 0.0021, 5.6e6, 0.007).unwrap()
}

fn law(name: &str) -> Box<dyn UniaxialMaterial> {
    match name {
        "bilinear" => Box::new(bilinear_steel()),
        "curved" => Box::new(curved_steel()),
        "hardening" => {
            Box::new(curved_steel().with_isotropic_hardening([0.05, 8.0, 0.04, 9.0]).unwrap())
        }
        _ => Box::new(concrete()),
    }
}

#[test]
fn laws_have_the_stresses_of_opensees() {
    let table = table("fibers/opensees_laws.csv");
    let names = table.text("law");
    let rows = table.rows(["strain", "stress_pa"]);
    for name in ["bilinear", "curved", "hardening", "concrete"] {
        let law = law(name);
        let mut variables = vec![0.0; law.variable_count()];
        law.initialize(&mut variables);
        let mut max_error = 0.0_f64;
        let mut max_stress = 0.0_f64;
        for (_, [strain, stress]) in names.iter().zip(&rows).filter(|(text, _)| **text == name) {
            let response = law.response(*strain, &variables).unwrap();
            max_error = max_error.max((response.stress - stress).abs());
            max_stress = max_stress.max(stress.abs());
            law.commit(*strain, &mut variables);
        }
        println!("{name}: {:.1e}", max_error / max_stress);
        assert!(max_error < 1e-12 * max_stress, "{name}: {max_error}");
    }
}

/// A column of beams, fixed at its foot.
struct Column {
    beams: Vec<FiberBeam>,
    coordinates: Vec<Vec<[f64; 3]>>,
    variables: Vec<Vec<f64>>,
    /// Displacements of all nodes, x, y and rotation of each.
    displacement: Vec<f64>,
}

impl Column {
    fn new(section: &FiberSection, formulation: BeamFormulation, beam_count: usize) -> Self {
        let mut column = Self {
            beams: Vec::new(),
            coordinates: Vec::new(),
            variables: Vec::new(),
            displacement: vec![0.0; 3 * (beam_count + 1)],
        };
        let node = |index: usize| [0.0, COLUMN_HEIGHT * index as f64 / beam_count as f64, 0.0];
        for index in 0..beam_count {
            let nodes = [index, index + 1];
            let beam = FiberBeam::new(nodes, section, BeamQuadrature::Lobatto(5), 0.0).unwrap();
            let beam = beam.with_formulation(formulation);
            let coordinates = nodes.map(node).to_vec();
            let mut variables = vec![0.0; beam.variable_count()];
            beam.initialize(&coordinates, &mut variables).unwrap();
            column.beams.push(beam);
            column.coordinates.push(coordinates);
            column.variables.push(variables);
        }
        column
    }

    /// Solves equilibrium with `prescribed` displacements and commits it; returns all nodal forces.
    fn solve(&mut self, load: &[f64], prescribed: &[(usize, f64)]) -> Vec<f64> {
        let dof_count = self.displacement.len();
        for iteration in 0.. {
            assert!(iteration < 60, "no equilibrium");
            let mut force = vec![0.0; dof_count];
            let mut tangent = Triplets::new(dof_count);
            for (index, beam) in self.beams.iter().enumerate() {
                let dofs: Vec<usize> = (3 * index..3 * index + 6).collect();
                let u = &self.displacement[3 * index..3 * index + 6];
                let coordinates = &self.coordinates[index];
                let mut matrix = vec![0.0; 36];
                let beam_force = &mut force[3 * index..3 * index + 6];
                beam.force(coordinates, u, &self.variables[index], beam_force).unwrap();
                beam.tangent(coordinates, u, &self.variables[index], &mut matrix).unwrap();
                tangent.add_block(&dofs, &matrix);
            }
            let residual: Vec<f64> = load.iter().zip(&force).map(|(p, f)| p - f).collect();
            let changes =
                prescribed.iter().map(|&(dof, value)| (dof, value - self.displacement[dof]));
            let changes: Vec<_> = changes.collect();
            let increment = solve_with_prescribed(&dense(&tangent), &residual, &changes);
            if largest(&increment) < 1e-14 {
                self.commit();
                return force;
            }
            for (value, change) in self.displacement.iter_mut().zip(increment) {
                *value += change;
            }
        }
        unreachable!()
    }

    fn commit(&mut self) {
        for (index, beam) in self.beams.iter().enumerate() {
            let u = &self.displacement[3 * index..3 * index + 6];
            beam.commit(&self.coordinates[index], u, &mut self.variables[index]);
        }
    }

    /// Axial strain, curvature, moment, and stresses of the lowest fibre and the first bar, of the section at the foot.
    fn foot(&self) -> [f64; 5] {
        let u = &self.displacement[..6];
        let sections = self.beams[0].sections(&self.coordinates[0], u, &self.variables[0]).unwrap();
        let section = &sections[0];
        let stresses = [0, LAYER_COUNT].map(|fiber| section.fibers[fiber].stress);
        [section.axial_strain, section.curvature, section.moment, stresses[0], stresses[1]]
    }
}

/// Columns of the table of cantilevers.
const TABLE_QUANTITIES: [&str; 9] = [
    "x_m",
    "y_m",
    "rotation",
    "force_n",
    "axial_strain",
    "curvature_per_m",
    "moment_n_m",
    "concrete_stress_pa",
    "bar_stress_pa",
];

/// Largest difference of each quantity from the table, relative to the largest value.
fn differences(element: &str, formulation: BeamFormulation, beam_count: usize, steel: &str) -> f64 {
    let table = table("fibers/opensees_cantilevers.csv");
    let elements = table.text("element");
    let steels = table.text("steel");
    let mut rows = table.rows(TABLE_QUANTITIES);
    let mut index = 0;
    rows.retain(|_| {
        index += 1;
        elements[index - 1] == element && steels[index - 1] == steel
    });
    assert!(rows.len() > 100);
    let section = FiberSection::new()
        .with_rectangle([[-0.25, -0.2], [0.25, 0.2]], [LAYER_COUNT, 1], concrete())
        .unwrap();
    let section = [-0.2, 0.2].iter().fold(section, |section, &y| {
        section.with_bars([[y, -0.15], [y, 0.15]], 3, BAR_AREA, law(steel)).unwrap()
    });
    let mut column = Column::new(&section, formulation, beam_count);
    let top = 3 * beam_count;
    let mut load = vec![0.0; 3 * (beam_count + 1)];
    load[top + 1] = -TOP_WEIGHT;
    let foot = [(0, 0.0), (1, 0.0), (2, 0.0)];
    let mut errors = [0.0_f64; 9];
    let mut scales = [0.0_f64; 9];
    for (step, expected) in rows.iter().enumerate() {
        let mut prescribed = foot.to_vec();
        if step > 0 {
            prescribed.push((top, expected[0]));
        }
        let force = column.solve(&load, &prescribed);
        let displacement = column.displacement[top..top + 3].iter().copied();
        let computed: Vec<f64> = displacement.chain([force[top]]).chain(column.foot()).collect();
        for k in 0..9 {
            errors[k] = errors[k].max((computed[k] - expected[k]).abs());
            scales[k] = scales[k].max(expected[k].abs());
        }
    }
    let relative_differences: Vec<f64> =
        errors.iter().zip(scales).map(|(error, scale)| error / scale).collect();
    println!("{element}, {steel}: {relative_differences:?}");
    largest(&relative_differences)
}

#[test]
fn displacement_based_columns_move_as_those_of_opensees() {
    for steel in ["bilinear", "curved"] {
        let formulation = BeamFormulation::DisplacementBased;
        let difference = differences("dispBeamColumn", formulation, 4, steel);
        assert!(difference < 1e-8, "{steel}: {difference:e}");
    }
}

#[test]
fn force_based_columns_move_as_those_of_opensees() {
    for steel in ["bilinear", "curved"] {
        let difference = differences("forceBeamColumn", BeamFormulation::ForceBased, 1, steel);
        assert!(difference < 1e-6, "{steel}: {difference:e}");
    }
}
