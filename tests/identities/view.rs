//! A scene in another form: translated, turned, mirrored, renumbered, in other units.

use basemat_problems::random::Random;
use basemat_problems::scenes::{SI_UNITS, UnitFrame};

/// Form in which a scene in SI units is built.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View {
    /// Units, and whether x is mirrored.
    pub(crate) frame: UnitFrame,
    /// Quarter turns about the vertical, counter-clockwise; in plan only.
    pub(crate) turns: usize,
    /// Translation along x and y after the turn, m; in the plane along x.
    pub(crate) shift: [f64; 2],
    /// Nodes, elements, faces and degrees of freedom in the reverse order.
    pub(crate) renumbered: bool,
    /// Finite elements behind the trait that a user implements.
    pub(crate) by_user: bool,
    /// The mesh written as a Gmsh file and read again; in SI units and as the scene stands only.
    pub(crate) read_from_gmsh: bool,
}

/// The scene in SI units, as it stands.
pub(crate) const PLAIN_VIEW: View = View {
    frame: SI_UNITS,
    turns: 0,
    shift: [0.0; 2],
    renumbered: false,
    by_user: false,
    read_from_gmsh: false,
};

/// Units of length, time and mass that differ from SI units by up to a thousand.
pub(crate) fn random_units(random: &mut Random) -> UnitFrame {
    let length = 10.0_f64.powf(random.within(-3.0, 3.0));
    let time = 10.0_f64.powf(random.within(-3.0, 3.0));
    let mass = 10.0_f64.powf(random.within(-3.0, 3.0));
    UnitFrame { length, time, mass, mirrored: false }
}

impl View {
    /// A vector `[x, y, z]` of the scene, in any unit, along the axes of the view.
    pub(crate) fn vector(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let mirrored_vector = [self.frame.sign() * x, y];
        let turned_vector = (0..self.turns).fold(mirrored_vector, |[x, y], _| [0.0 - y, x]);
        [turned_vector[0], turned_vector[1], z]
    }

    /// The vector of the scene that [`View::vector`] writes as `[x, y, z]`.
    pub(crate) fn vector_back(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let turned_back = (0..self.turns).fold([x, y], |[x, y], _| [y, 0.0 - x]);
        [self.frame.sign() * turned_back[0], turned_back[1], z]
    }

    /// A moment or a rotation of the view as in the scene: a mirror reverses it.
    pub(crate) fn axial_back(&self, vector: [f64; 3]) -> [f64; 3] {
        self.vector_back(vector).map(|part| self.frame.sign() * part)
    }

    /// A point of the scene (m) in the view's unit.
    pub(crate) fn point(&self, point: [f64; 3]) -> [f64; 3] {
        let turned_point = self.vector(point);
        [turned_point[0] + self.shift[0], turned_point[1] + self.shift[1], turned_point[2]]
            .map(|part| part * self.frame.length)
    }

    /// A point `[x, y]` of the surface (m) in the view's unit.
    pub(crate) fn surface_point(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let point = self.point([x, y, 0.0]);
        [point[0], point[1]]
    }

    /// Values along x and y of the scene, along the axes of the view.
    pub(crate) fn along_axes<T>(&self, [x, y]: [T; 2]) -> [T; 2] {
        if self.turns.is_multiple_of(2) { [x, y] } else { [y, x] }
    }

    /// Reverses a list if the view renumbers.
    pub(crate) fn ordered<T>(&self, mut list: Vec<T>) -> Vec<T> {
        if self.renumbered {
            list.reverse();
        }
        list
    }
}
