//! Curved shells: Scordelis & Lo's roof, the pinched cylinder, hemispheres.

use std::f64::consts::FRAC_PI_2;

use basemat::fem::{Element, Material};
use basemat_problems::supported::{CLAMPED, Load, RX, RY, RZ, X, Y, Z};

use super::row::Rows;
use super::surface::{Pattern, Surface};
use crate::AnyError;

fn roof(rows: &mut Rows) -> Result<(), AnyError> {
    for count in [4, 8, 16] {
        for pattern in [Pattern::Quadrilaterals, Pattern::Falling] {
            let mut roof = Surface::new(Material::new(4.32e8, 0.0, 0.0)?, 0.25);
            let nodes = roof.grid([count, count], pattern, |along, around| {
                let (sine, cosine) = (40.0 * around).to_radians().sin_cos();
                [25.0 * along, 25.0 * sine, 25.0 * cosine]
            })?;
            for k in 0..=count {
                roof.scene.hold(nodes[0][k], &[X, RY, RZ]);
                roof.scene.hold(nodes[k][0], &[Y, RX, RZ]);
                roof.scene.hold(nodes[count][k], &[Y, Z]);
            }
            let mut loads: Vec<Load> = Vec::new();
            for shell in &roof.shells {
                let areas = shell.areas(&roof.scene.points(shell.nodes()))?;
                let own = shell.nodes().iter().zip(areas);
                loads.extend(own.map(|(&node, area)| (node, Z, -90.0 * area)));
            }
            let value = roof.scene.solve(&loads)(nodes[0][count], Z);
            let mesh = format!("{} {count}x{count}", pattern.element());
            rows.put("Scordelis-Lo roof", "uz at the middle of the free edge", &mesh, value);
        }
    }
    Ok(())
}

fn cylinder(rows: &mut Rows, short: bool) -> Result<(), AnyError> {
    for count in [4, 8, 16, 32, 48, 64] {
        if short && count > 16 {
            break;
        }
        for pattern in [Pattern::Quadrilaterals, Pattern::Falling] {
            if count > 32 && pattern == Pattern::Falling {
                continue;
            }
            let mut pipe = Surface::new(Material::new(3.0e6, 0.3, 0.0)?, 3.0);
            let nodes = pipe.grid([count, count], pattern, |along, around| {
                let (sine, cosine) = (FRAC_PI_2 * around).sin_cos();
                [300.0 * along, 300.0 * sine, 300.0 * cosine]
            })?;
            for k in 0..=count {
                pipe.scene.hold(nodes[0][k], &[X, RY, RZ]);
                pipe.scene.hold(nodes[k][0], &[Y, RX, RZ]);
                pipe.scene.hold(nodes[k][count], &[Z, RX, RY]);
                pipe.scene.hold(nodes[count][k], &[Y, Z]);
            }
            let load = nodes[0][0];
            let value = pipe.scene.solve(&[(load, Z, -0.25)])(load, Z);
            let mesh = format!("{} {count}x{count}", pattern.element());
            rows.put("pinched cylinder with diaphragms", "uz under the load", &mesh, value);
        }
    }
    Ok(())
}

fn hemisphere(rows: &mut Rows, short: bool) -> Result<(), AnyError> {
    for count in [4, 8, 16, 32] {
        if short && count > 16 {
            break;
        }
        for pattern in [Pattern::Quadrilaterals, Pattern::Rising] {
            let mut dome = Surface::new(Material::new(6.825e7, 0.3, 0.0)?, 0.04);
            let nodes = dome.grid([count, count], pattern, |around, up| {
                let (east, north) = (FRAC_PI_2 * around, (72.0 * up).to_radians());
                let radius = 10.0 * north.cos();
                [radius * east.cos(), radius * east.sin(), 10.0 * north.sin()]
            })?;
            for k in 0..=count {
                dome.scene.hold(nodes[0][k], &[Y, RX, RZ]);
                dome.scene.hold(nodes[count][k], &[X, RY, RZ]);
            }
            let [pulled, pushed] = [nodes[0][0], nodes[count][0]];
            dome.scene.hold(pulled, &[Z]);
            let value = dome.scene.solve(&[(pulled, X, 1.0), (pushed, Y, -1.0)])(pulled, X);
            let mesh = format!("{} {count}x{count}", pattern.element());
            rows.put("hemisphere with 18 degree hole", "ux under the load", &mesh, value);
        }
    }
    Ok(())
}

/// Point of the arc between two unit vectors.
fn on_arc(from: [f64; 3], to: [f64; 3], part: f64) -> [f64; 3] {
    let cosine: f64 = (0..3).map(|k| from[k] * to[k]).sum();
    let angle = cosine.clamp(-1.0, 1.0).acos();
    let [one, other] = [1.0 - part, part].map(|part| (part * angle).sin() / angle.sin());
    std::array::from_fn(|k| one * from[k] + other * to[k])
}

fn closed_hemisphere(rows: &mut Rows) -> Result<(), AnyError> {
    let middle = [1.0 / 3.0_f64.sqrt(); 3];
    for count in [4, 8, 16] {
        for pattern in [Pattern::Quadrilaterals, Pattern::Rising] {
            let mut dome = Surface::new(Material::new(68.25e9, 0.3, 0.0)?, 0.04);
            for axis in 0..3 {
                let unit = |axis: usize| std::array::from_fn(|k| if k == axis { 1.0 } else { 0.0 });
                let [a, next, last] = [0, 1, 2].map(|step| unit((axis + step) % 3));
                let [b, d] = [next, last].map(|other| on_arc(a, other, 0.5));
                let mut node = |i: usize, j: usize| {
                    let [s, t] = [i, j].map(|k| k as f64 / count as f64);
                    let point = on_arc(on_arc(a, b, s), on_arc(d, middle, s), t).map(|x| 10.0 * x);
                    // Patches share the nodes of their edges.
                    let known = dome.scene.mesh.node_at_point(point);
                    known.unwrap_or_else(|_| dome.scene.node(point))
                };
                let nodes: Vec<Vec<usize>> =
                    (0..=count).map(|i| (0..=count).map(|j| node(i, j)).collect()).collect();
                dome.fill(&nodes, pattern)?;
            }
            let points = dome.scene.mesh.nodes().to_vec();
            for (node, [x, y, _]) in points.into_iter().enumerate() {
                if x.abs() < 1e-9 {
                    dome.scene.hold(node, &[X, RY, RZ]);
                }
                if y.abs() < 1e-9 {
                    dome.scene.hold(node, &[Y, RX, RZ]);
                }
            }
            let at = |point| dome.scene.mesh.node_at_point(point);
            let (pole, pulled, pushed) =
                (at([0.0, 0.0, 10.0])?, at([10.0, 0.0, 0.0])?, at([0.0, 10.0, 0.0])?);
            dome.scene.hold(pole, &CLAMPED);
            let value = dome.scene.solve(&[(pulled, X, 2e3), (pushed, Y, -2e3)])(pulled, X);
            let mesh = format!("{} 3 patches {count}x{count}", pattern.element());
            rows.put("NAFEMS LE3 hemisphere, point loads", "ux at A, m", &mesh, value);
        }
    }
    Ok(())
}

pub(super) fn run(rows: &mut Rows, short: bool) -> Result<(), AnyError> {
    roof(rows)?;
    cylinder(rows, short)?;
    hemisphere(rows, short)?;
    closed_hemisphere(rows)
}
