//! A slab of plate elements with columns: its nodes are free to go up and down, and cells must be small enough for its
//! bending.

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Ground};
use basemat::coupled::CoarseBaseError;
use basemat::coupled::Warning;
use basemat::interface::Coulomb;
use basemat::structure::{Base, BaseNode, MatrixModel, Structure, Triplets};
use basemat::{Error, Result, Simulation, Soil};

use super::cells::{BED, Cells};

/// Displacement and rotations about x and y of a node: w, ∂w/∂y, −∂w/∂x.
const NODE: usize = 3;
/// Plate element: degrees of freedom.
const PLATE: usize = 4 * NODE;
/// Points of Gauss' rule of three.
const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// The twelve monomials of an ACM rectangle: powers of x and y.
const POWERS: [[i32; 2]; PLATE] = [
    [0, 0],
    [1, 0],
    [0, 1],
    [2, 0],
    [1, 1],
    [0, 2],
    [3, 0],
    [2, 1],
    [1, 2],
    [0, 3],
    [3, 1],
    [1, 3],
];

/// A derivative of the monomials at a point.
fn monomials([x, y]: [f64; 2], [by_x, by_y]: [i32; 2]) -> [f64; PLATE] {
    let derived = |value: f64, power: i32, times: i32| {
        let factor: i32 = (0..times).map(|k| power - k).product();
        if power < times { 0.0 } else { f64::from(factor) * value.powi(power - times) }
    };
    POWERS.map(|[a, b]| derived(x, a, by_x) * derived(y, b, by_y))
}

/// The inverse of a matrix, by Gauss and Jordan.
fn inverse(mut rows: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = rows.len();
    for (k, row) in rows.iter_mut().enumerate() {
        row.extend((0..n).map(|j| if j == k { 1.0 } else { 0.0 }));
    }
    for k in 0..n {
        let most = |i: &usize, j: &usize| rows[*i][k].abs().total_cmp(&rows[*j][k].abs());
        let pivot = (k..n).max_by(most).unwrap();
        rows.swap(k, pivot);
        let scale = rows[k][k];
        rows[k].iter_mut().for_each(|x| *x /= scale);
        let own = rows[k].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = row[k];
            row.iter_mut().zip(&own).for_each(|(x, own)| *x -= factor * own);
        }
    }
    rows.into_iter().map(|row| row[n..].to_vec()).collect()
}

/// Stiffness of the ACM plate rectangle (Adini, Clough, Melosh; Kirchhoff's theory) with these sides, row-major;
/// corners counter-clockwise from the left front one.
fn plate([a, b]: [f64; 2], rigidity: f64, poisson: f64) -> Vec<f64> {
    let mut values = Vec::new();
    for point in [[0.0, 0.0], [a, 0.0], [a, b], [0.0, b]] {
        values.push(monomials(point, [0, 0]).to_vec());
        values.push(monomials(point, [0, 1]).to_vec());
        values.push(monomials(point, [1, 0]).map(|x| -x).to_vec());
    }
    let shapes = inverse(values);
    let mut stiffness = vec![0.0; PLATE * PLATE];
    for (s, one) in GAUSS {
        for (t, two) in GAUSS {
            let point = [0.5 * a * (1.0 + s), 0.5 * b * (1.0 + t)];
            let weight = 0.25 * a * b * one * two * rigidity;
            let [xx, yy, xy] = [[2, 0], [0, 2], [1, 1]].map(|by| {
                let own = monomials(point, by);
                let column = |j: usize| (0..PLATE).map(|k| own[k] * shapes[k][j]).sum::<f64>();
                (0..PLATE).map(column).collect::<Vec<_>>()
            });
            for i in 0..PLATE {
                for j in 0..PLATE {
                    let bending = xx[i] * xx[j] + yy[i] * yy[j];
                    let both = poisson * (xx[i] * yy[j] + yy[i] * xx[j]);
                    let twist = 2.0 * (1.0 - poisson) * xy[i] * xy[j];
                    stiffness[i * PLATE + j] += weight * (bending + both + twist);
                }
            }
        }
    }
    stiffness
}

/// A square slab of `count` × `count` plates, rigid in its plane, with masses on some nodes.
struct Slab {
    side: f64,
    count: usize,
    /// Thickness, m.
    thickness: f64,
    /// Columns, node along x and along y, and mass, kg.
    columns: Vec<([usize; 2], f64)>,
}

impl Slab {
    const YOUNG: f64 = 30e9;
    const POISSON: f64 = 0.2;
    const DENSITY: f64 = 2400.0;

    fn place(&self, node: usize) -> f64 {
        self.side * (node as f64 / self.count as f64 - 0.5)
    }

    /// First degree of freedom of a node; the three motions in the plane come before all.
    fn dof(&self, [i, j]: [usize; 2]) -> usize {
        3 + NODE * (j * (self.count + 1) + i)
    }

    fn rigidity(&self) -> f64 {
        Self::YOUNG * self.thickness.powi(3) / (12.0 * (1.0 - Self::POISSON.powi(2)))
    }

    fn corners([i, j]: [usize; 2]) -> [[usize; 2]; 4] {
        [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]]
    }

    fn model(&self) -> Result<MatrixModel> {
        let n = 3 + NODE * (self.count + 1).pow(2);
        let (mut mass, mut stiffness) = (Triplets::new(n), Triplets::new(n));
        let pitch = self.side / self.count as f64;
        let own = plate([pitch; 2], self.rigidity(), Self::POISSON);
        let mut add = |node: [usize; 2], m: f64| {
            let [x, y] = node.map(|k| self.place(k));
            let terms = [[(0, 1.0), (2, -y)], [(1, 1.0), (2, x)]];
            for row in &terms {
                mass.add_outer(row, m);
            }
            let first = self.dof(node);
            // Rotary inertia, small.
            let turned = m * 1e-2 * pitch * pitch;
            [m, turned, turned]
                .iter()
                .enumerate()
                .for_each(|(k, m)| mass.add(first + k, first + k, *m));
        };
        let mut faces = Vec::new();
        for j in 0..self.count {
            for i in 0..self.count {
                let corners = Self::corners([i, j]);
                let dofs: Vec<_> = corners
                    .iter()
                    .flat_map(|node| (0..NODE).map(|k| self.dof(*node) + k))
                    .collect();
                stiffness.add_block(&dofs, &own);
                let quarter = 0.25 * pitch * pitch * self.thickness * Self::DENSITY;
                for node in &corners {
                    add(*node, quarter);
                }
                faces.push(corners.map(|node| self.node(node)).to_vec());
            }
        }
        self.columns.iter().for_each(|(node, m)| add(*node, *m));
        MatrixModel::new(mass, stiffness, Base::Faces(faces))
    }

    fn node(&self, node: [usize; 2]) -> BaseNode {
        let [x, y] = node.map(|k| self.place(k));
        BaseNode {
            x,
            y,
            z: 0.0,
            horizontal: [(0, 1.0), (2, -y)].into(),
            across: [(1, 1.0), (2, x)].into(),
            vertical: self.dof(node).into(),
        }
    }

    fn soil() -> Soil {
        Soil::from_shear_wave_speed(200.0, 0.33, 1900.0).unwrap()
    }

    /// The simulation on `cells` × `cells`.
    fn build(&self, cells: usize) -> Result<Simulation> {
        let half = 0.5 * self.side;
        let plan = Plan::rectangle(-half..half, -half..half, cells)?;
        Simulation::builder(0.01)
            .structure(self.model()?)
            .ground(ElasticGround::in_plan(Self::soil(), plan)?)
            .interface(Coulomb::new(0.5)?)
            .build()
    }
}

/// Patch test: fields of constant curvature leave no force at a node within a patch of unequal rectangles, and have the
/// energy of Kirchhoff's plate; rigid motions have none.
#[test]
fn plates_pass_the_patch_test() {
    let (rigidity, poisson) = (3.0, 0.3);
    let sides = [[1.0, 2.0], [0.7, 1.1]];
    let ends = sides.map(|[first, second]| [0.0, first, first + second]);
    for (field, curvatures) in [
        ([1.0, 0.0, 0.0], [0.0; 3]),
        ([0.0, 2.0, -3.0], [0.0; 3]),
        ([0.0; 3], [1.0, 0.0, 0.0]),
        ([0.0; 3], [0.3, -0.8, 0.6]),
    ] {
        let [xx, yy, xy] = curvatures;
        let at = |i: usize, j: usize| {
            let [x, y] = [ends[0][i], ends[1][j]];
            let w = field[0] + field[1] * x + field[2] * y;
            let bent = 0.5 * xx * x * x + 0.5 * yy * y * y + xy * x * y;
            [w + bent, field[2] + yy * y + xy * x, -(field[1] + xx * x + xy * y)]
        };
        let (mut inner, mut energy) = ([0.0; NODE], 0.0);
        for j in 0..2 {
            for i in 0..2 {
                let stiffness = plate([sides[0][i], sides[1][j]], rigidity, poisson);
                let corners = Slab::corners([i, j]);
                let u: Vec<f64> = corners.iter().flat_map(|[i, j]| at(*i, *j)).collect();
                let force: Vec<f64> = stiffness
                    .chunks(PLATE)
                    .map(|row| row.iter().zip(&u).map(|(k, u)| k * u).sum())
                    .collect();
                energy += 0.5 * force.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>();
                let corner = corners.iter().position(|node| *node == [1, 1]).unwrap();
                for (sum, f) in inner.iter_mut().zip(&force[NODE * corner..]) {
                    *sum += f;
                }
            }
        }
        let area = ends[0][2] * ends[1][2];
        let exact = 0.5
            * rigidity
            * area
            * (xx * xx + yy * yy + 2.0 * poisson * xx * yy + 2.0 * (1.0 - poisson) * xy * xy);
        assert!((energy - exact).abs() < 1e-10, "{energy} {exact}");
        assert!(inner.iter().all(|f| f.abs() < 1e-10), "{inner:?}");
    }
}

/// A column in the middle of a slab of 12 × 12 m: its settlement against the middle of an edge is 2.75 mm on 16 × 16
/// cells.
#[test]
fn too_few_cells_under_a_slab_are_told() {
    let slab = Slab { side: 12.0, count: 24, thickness: 0.25, columns: vec![([12, 12], 120e3)] };
    let error = slab.build(4).expect_err("an error");
    let Error::CoarseBase(CoarseBaseError {
        foundation: 0,
        elements: 4,
        needed,
        difference,
        axis: Some('x'),
    }) = error
    else {
        panic!("{error}")
    };
    assert!((9..=13).contains(&needed) && (0.5..0.7).contains(&difference.unwrap()), "{error}");
    for (cells, most) in [(6, 0.17), (8, 0.07), (12, 0.02)] {
        let mut simulation = slab.build(cells).unwrap();
        let u = simulation.static_displacement();
        let settlement = u[slab.dof([12, 0])] - u[slab.dof([12, 12])];
        assert!((settlement / 2.7466e-3 - 1.0).abs() < most, "{cells}: {settlement}");
        let warnings = simulation.run(1, |_| {}).unwrap().warnings;
        let found = warnings.iter().find_map(|own| match own {
            Warning::CoarseBase { elements, needed, .. } => Some([*elements, *needed]),
            _ => None,
        });
        let is_told = found.is_some_and(|[elements, needed]| elements == cells && needed <= 14);
        assert_eq!(is_told, cells < 12, "{cells}: {warnings:?}");
    }
}

/// As many cells as faces at least under a flexible slab, as many as wanted under a rigid one.
#[test]
fn a_slab_gets_as_many_cells_as_faces() {
    let slab = Slab { side: 12.0, count: 10, thickness: 0.25, columns: vec![] };
    let model = slab.model().unwrap();
    for (wanted, along) in [(4, 10), (10, 10), (12, 12)] {
        let ground = ElasticGround::under(Slab::soil(), &model, wanted).unwrap();
        assert_eq!(ground.elements().len(), along * along);
    }
    assert!(Plan::under(&model, 1).is_err());
    let rigid = basemat::structure::RigidBody::cuboid([12.0, 12.0, 1.0], 2400.0).unwrap();
    assert_eq!(Plan::under(&rigid, 4).unwrap().count(), 16);
    assert_eq!(model.base().nodes().count(), 400);
    // A mesh that is much finer than cells can be: `build` judges whether these do.
    let fine = Slab { count: 50, ..slab }.model().unwrap();
    assert_eq!(Plan::under(&fine, 12).unwrap().count(), 31 * 31);
    assert_eq!(Plan::under(&fine, 40).unwrap().count(), 40 * 40);
}

/// A soft plate under its own weight sinks as the soil under a uniform pressure q does: 1.1222 q B (1 − ν)/(2G) in the
/// middle (Boussinesq), for D/(G B³) of 1e-6 and 1e-7.
#[test]
fn soft_plates_sink_as_a_uniform_pressure_does() {
    let soil = Slab::soil();
    for thickness in [0.036_9, 0.017_14] {
        let errors = [8, 12, 16].map(|count| {
            let slab = Slab { side: 12.0, count, thickness, columns: vec![] };
            let stiffness = soil.shear_modulus() * slab.side.powi(3);
            let rigidity = slab.rigidity() / stiffness;
            assert!((1e7 * rigidity - 10.0).abs() < 0.1 || (1e7 * rigidity - 1.0).abs() < 0.01);
            let model = slab.model().unwrap();
            let ground = ElasticGround::under(soil, &model, count).unwrap();
            let simulation = Simulation::builder(0.01).structure(model).ground(ground);
            let simulation = simulation.interface(Coulomb::new(0.5).unwrap()).build().unwrap();
            let pressure = thickness * Slab::DENSITY * 9.806_65;
            let found = -simulation.static_displacement()[slab.dof([count / 2; 2])];
            let wanted = 1.1222 * pressure * slab.side * (1.0 - soil.poisson())
                / (2.0 * soil.shear_modulus());
            found / wanted - 1.0
        });
        println!("{thickness}: {errors:.4?}");
        assert!(errors.iter().all(|error| error.abs() < 0.03), "{errors:?}");
        assert!(errors.is_sorted_by(|one, other| other.abs() <= one.abs()), "{errors:?}");
    }
}

/// Without the static state on twice as many cells, cells that may be too few warn: a soft slab with an even pressure is
/// right on few.
#[test]
fn a_soft_slab_on_a_ground_without_finer_cells_is_no_error() {
    let slab = Slab { side: 12.0, count: 8, thickness: 0.017_14, columns: vec![] };
    let lines: Vec<f64> = (0..=slab.count).map(|node| slab.place(node)).collect();
    let bed = Cells::between(&lines, &lines, BED);
    let simulation = Simulation::builder(0.01).structure(slab.model().unwrap()).ground(bed);
    let mut simulation = simulation.interface(Coulomb::new(0.5).unwrap()).build().unwrap();
    let warnings = simulation.run(1, |_| {}).unwrap().warnings;
    let is_told = |own: &Warning| {
        matches!(own, Warning::CoarseBase { elements: 8, difference: None, axis: Some('x'), .. })
    };
    assert!(warnings.iter().any(is_told), "{warnings:?}");
    let found = -simulation.static_displacement()[slab.dof([4; 2])];
    let wanted = slab.thickness * Slab::DENSITY * 9.806_65 / BED.stiffness[0];
    assert!((found / wanted - 1.0).abs() < 0.01, "{found} {wanted}");
}

/// Settlement at a point by a uniform pressure on a square about the origin (Boussinesq), m.
fn settlement(soil: Soil, point: [f64; 2], side: f64, pressure: f64) -> f64 {
    let corner = |u: f64, v: f64| u * (v / u.abs()).asinh() + v * (u / v.abs()).asinh();
    let [x, y] = point.map(|place| [-0.5 * side - place, 0.5 * side - place]);
    let sum = corner(x[1], y[1]) - corner(x[0], y[1]) - corner(x[1], y[0]) + corner(x[0], y[0]);
    pressure * (1.0 - soil.poisson()) / (std::f64::consts::TAU * soil.shear_modulus()) * sum
}

/// Soft plates, D/(G B³) of 1e-6 and 1e-7, with ten times their weight on the middle half: the four cells in the middle
/// sink as the soil under these two pressures does.
#[test]
fn soft_plates_sink_as_the_pressure_on_their_middle_does() {
    let soil = Slab::soil();
    for (thickness, count) in [(0.036_9, 8), (0.017_14, 8)] {
        let mut slab = Slab { side: 12.0, count, thickness, columns: vec![] };
        let pitch = slab.side / count as f64;
        let quarter = 0.25 * pitch * pitch * thickness * Slab::DENSITY;
        for i in count / 4..3 * count / 4 {
            for corners in (count / 4..3 * count / 4).map(|j| Slab::corners([i, j])) {
                slab.columns.extend(corners.map(|node| (node, 10.0 * quarter)));
            }
        }
        let model = slab.model().unwrap();
        let ground = ElasticGround::under(soil, &model, count).unwrap();
        let simulation = Simulation::builder(0.01).structure(model).ground(ground);
        let simulation = simulation.interface(Coulomb::new(0.5).unwrap()).build().unwrap();
        let pressure = thickness * Slab::DENSITY * 9.806_65;
        let (mut found, mut wanted) = (0.0, 0.0);
        for k in 0..9 {
            let node = [k % 3, k / 3].map(|step| count / 2 + step - 1);
            let weight = [0.25, 0.5, 0.25][k % 3] * [0.25, 0.5, 0.25][k / 3];
            found -= weight * simulation.static_displacement()[slab.dof(node)];
        }
        for k in 0..64_u32 {
            let point = [k % 8, k / 8].map(|step| pitch * (0.25 * f64::from(step) - 0.875));
            wanted += settlement(soil, point, slab.side, pressure) / 64.0;
            wanted += settlement(soil, point, 0.5 * slab.side, 10.0 * pressure) / 64.0;
        }
        let error = found / wanted - 1.0;
        println!("{thickness}, {count} cells: {error:.5}");
        assert!(error.abs() < 5e-3, "{thickness}, {count} cells: {error}");
    }
}
