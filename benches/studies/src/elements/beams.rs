//! Cantilevers of beams: MacNeal & Harder's straight, curved and twisted ones, and a hinged one.

use std::f64::consts::{FRAC_PI_2, PI};

use basemat::fem::Material;
use basemat_problems::space_beams::{
    chain, hinged_cantilever, rectangle, section_with_shear, straight_cantilever,
    twisted_cantilever,
};
use basemat_problems::supported::{RX, X, Y, Z};

use super::row::BenchmarkRows;
use crate::AnyError;

/// St Venant's torsion constant of a rectangle, m⁴: Timoshenko & Goodier, article 109.
fn torsion_constant(width: f64, height: f64) -> f64 {
    let long_side = width.max(height);
    let short_side = width.min(height);
    let sum: f64 = (0..20)
        .map(|k| f64::from(2 * k + 1))
        .map(|n| (0.5 * n * PI * long_side / short_side).tanh() / n.powi(5))
        .sum();
    long_side * short_side.powi(3) / 3.0 * (1.0 - 192.0 / PI.powi(5) * short_side / long_side * sum)
}

fn straight(rows: &mut BenchmarkRows) {
    for count in [1, 6] {
        let beam = straight_cantilever(torsion_constant(0.2, 0.1), count);
        for (quantity, direction) in
            [("extension", X), ("in-plane shear", Y), ("out-of-plane shear", Z), ("twist", RX)]
        {
            let value = beam.work(&[(count, direction, 1.0)]);
            rows.put("MacNeal-Harder straight cantilever", quantity, &count.to_string(), value);
        }
    }
}

fn curved(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    let material = Material::new(1.0e7, 0.25, 0.0)?;
    let section = rectangle(0.1, 0.2, torsion_constant(0.1, 0.2));
    for count in [6, 12, 48] {
        let point_on_arc = |part: f64| {
            let angle = FRAC_PI_2 * part;
            let sine = angle.sin();
            let cosine = angle.cos();
            [4.22 * cosine, 4.22 * sine, 0.0]
        };
        // y of the section across the plane of the arc.
        let beam = chain(material, section, count, point_on_arc, |_| [0.0, 0.0, 1.0]);
        for (quantity, direction) in [("in-plane", Y), ("out-of-plane", Z)] {
            let value = beam.work(&[(count, direction, 1.0)]);
            for benchmark in ["MacNeal-Harder curved cantilever", "curved cantilever, closed form"]
            {
                rows.put(benchmark, quantity, &count.to_string(), value);
            }
        }
    }
    Ok(())
}

fn twisted(rows: &mut BenchmarkRows) {
    for (thickness, force) in [(0.32, 1.0), (0.0032, 1e-6)] {
        for count in [12, 96] {
            let beam = twisted_cantilever(thickness, torsion_constant(1.1, thickness), count);
            let benchmark = format!("MacNeal-Harder twisted beam t={thickness}");
            let in_plane = force * beam.work(&[(count, Z, 1.0)]);
            let out_of_plane = force * beam.work(&[(count, Y, 1.0)]);
            let mesh = count.to_string();
            rows.put(&benchmark, "along the width of the tip (in-plane)", &mesh, in_plane);
            rows.put(&benchmark, "across (out-of-plane)", &mesh, out_of_plane);
        }
    }
}

pub(super) fn run(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    straight(rows);
    curved(rows)?;
    twisted(rows);
    let stiffness = 1.0 / hinged_cantilever(section_with_shear());
    rows.put("hinge at end 2: lateral stiffness", "N/m", "1", stiffness);
    Ok(())
}
