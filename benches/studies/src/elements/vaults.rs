//! Curved shells: Scordelis & Lo's roof, the pinched cylinder, hemispheres.

use std::f64::consts::FRAC_PI_2;

use basemat::fem::{Element, Material};
use basemat_problems::supported::{CLAMPED_DIRECTIONS, NodalLoad, RX, RY, RZ, X, Y, Z};

use super::row::BenchmarkRows;
use super::surface::{ShellPattern, ShellSurface};
use crate::AnyError;

fn roof(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    for count in [4, 8, 16] {
        for pattern in [ShellPattern::Quadrilaterals, ShellPattern::Falling] {
            let mut roof = ShellSurface::new(Material::new(4.32e8, 0.0, 0.0)?, 0.25);
            let nodes = roof.grid([count, count], pattern, |along, around| {
                let angle = (40.0 * around).to_radians();
                let sine = angle.sin();
                let cosine = angle.cos();
                [25.0 * along, 25.0 * sine, 25.0 * cosine]
            })?;
            for k in 0..=count {
                roof.scene.fix(nodes[0][k], &[X, RY, RZ]);
                roof.scene.fix(nodes[k][0], &[Y, RX, RZ]);
                roof.scene.fix(nodes[count][k], &[Y, Z]);
            }
            let mut loads: Vec<NodalLoad> = Vec::new();
            for shell in &roof.shells {
                let areas = shell.areas(&roof.scene.points(shell.nodes()))?;
                let nodes_and_areas = shell.nodes().iter().zip(areas);
                loads.extend(nodes_and_areas.map(|(&node, area)| (node, Z, -90.0 * area)));
            }
            let value = roof.scene.solve(&loads)(nodes[0][count], Z);
            let mesh = format!("{} {count}x{count}", pattern.element());
            rows.put("Scordelis-Lo roof", "uz at the middle of the free edge", &mesh, value);
        }
    }
    Ok(())
}

fn cylinder(rows: &mut BenchmarkRows, short: bool) -> Result<(), AnyError> {
    for count in [4, 8, 16, 32, 48, 64] {
        if short && count > 16 {
            break;
        }
        for pattern in [ShellPattern::Quadrilaterals, ShellPattern::Falling] {
            if count > 32 && pattern == ShellPattern::Falling {
                continue;
            }
            let mut pipe = ShellSurface::new(Material::new(3.0e6, 0.3, 0.0)?, 3.0);
            let nodes = pipe.grid([count, count], pattern, |along, around| {
                let angle = FRAC_PI_2 * around;
                let sine = angle.sin();
                let cosine = angle.cos();
                [300.0 * along, 300.0 * sine, 300.0 * cosine]
            })?;
            for k in 0..=count {
                pipe.scene.fix(nodes[0][k], &[X, RY, RZ]);
                pipe.scene.fix(nodes[k][0], &[Y, RX, RZ]);
                pipe.scene.fix(nodes[k][count], &[Z, RX, RY]);
                pipe.scene.fix(nodes[count][k], &[Y, Z]);
            }
            let load = nodes[0][0];
            let value = pipe.scene.solve(&[(load, Z, -0.25)])(load, Z);
            let mesh = format!("{} {count}x{count}", pattern.element());
            rows.put("pinched cylinder with diaphragms", "uz under the load", &mesh, value);
        }
    }
    Ok(())
}

fn hemisphere(rows: &mut BenchmarkRows, short: bool) -> Result<(), AnyError> {
    for count in [4, 8, 16, 32] {
        if short && count > 16 {
            break;
        }
        for pattern in [ShellPattern::Quadrilaterals, ShellPattern::Rising] {
            let mut dome = ShellSurface::new(Material::new(6.825e7, 0.3, 0.0)?, 0.04);
            let nodes = dome.grid([count, count], pattern, |around, up| {
                let east = FRAC_PI_2 * around;
                let north = (72.0 * up).to_radians();
                let radius = 10.0 * north.cos();
                [radius * east.cos(), radius * east.sin(), 10.0 * north.sin()]
            })?;
            for k in 0..=count {
                dome.scene.fix(nodes[0][k], &[Y, RX, RZ]);
                dome.scene.fix(nodes[count][k], &[X, RY, RZ]);
            }
            let pulled_node = nodes[0][0];
            let pushed_node = nodes[count][0];
            dome.scene.fix(pulled_node, &[Z]);
            let value =
                dome.scene.solve(&[(pulled_node, X, 1.0), (pushed_node, Y, -1.0)])(pulled_node, X);
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
    let weight_from = ((1.0 - part) * angle).sin() / angle.sin();
    let weight_to = (part * angle).sin() / angle.sin();
    std::array::from_fn(|k| weight_from * from[k] + weight_to * to[k])
}

fn unit_vector(axis: usize) -> [f64; 3] {
    std::array::from_fn(|k| if k == axis { 1.0 } else { 0.0 })
}

fn closed_hemisphere(rows: &mut BenchmarkRows) -> Result<(), AnyError> {
    let middle = [1.0 / 3.0_f64.sqrt(); 3];
    for count in [4, 8, 16] {
        for pattern in [ShellPattern::Quadrilaterals, ShellPattern::Rising] {
            let mut dome = ShellSurface::new(Material::new(68.25e9, 0.3, 0.0)?, 0.04);
            for axis in 0..3 {
                let a = unit_vector(axis);
                let b = on_arc(a, unit_vector((axis + 1) % 3), 0.5);
                let d = on_arc(a, unit_vector((axis + 2) % 3), 0.5);
                let mut nodes = Vec::new();
                for i in 0..=count {
                    let s = f64::from(i) / f64::from(count);
                    let mut row = Vec::new();
                    for j in 0..=count {
                        let t = f64::from(j) / f64::from(count);
                        let unit_point = on_arc(on_arc(a, b, s), on_arc(d, middle, s), t);
                        let point = unit_point.map(|x| 10.0 * x);
                        // Patches have the nodes of their edges in common.
                        let existing = dome.scene.mesh.node_at_point(point);
                        row.push(existing.unwrap_or_else(|_| dome.scene.node(point)));
                    }
                    nodes.push(row);
                }
                dome.fill(&nodes, pattern)?;
            }
            let points = dome.scene.mesh.nodes().to_vec();
            for (node, [x, y, _]) in points.into_iter().enumerate() {
                if x.abs() < 1e-9 {
                    dome.scene.fix(node, &[X, RY, RZ]);
                }
                if y.abs() < 1e-9 {
                    dome.scene.fix(node, &[Y, RX, RZ]);
                }
            }
            let mesh = &dome.scene.mesh;
            let pole = mesh.node_at_point([0.0, 0.0, 10.0])?;
            let pulled_node = mesh.node_at_point([10.0, 0.0, 0.0])?;
            let pushed_node = mesh.node_at_point([0.0, 10.0, 0.0])?;
            dome.scene.fix(pole, &CLAMPED_DIRECTIONS);
            let value =
                dome.scene.solve(&[(pulled_node, X, 2e3), (pushed_node, Y, -2e3)])(pulled_node, X);
            let mesh = format!("{} 3 patches {count}x{count}", pattern.element());
            rows.put("NAFEMS LE3 hemisphere, point loads", "ux at A, m", &mesh, value);
        }
    }
    Ok(())
}

pub(super) fn run(rows: &mut BenchmarkRows, short: bool) -> Result<(), AnyError> {
    roof(rows)?;
    cylinder(rows, short)?;
    hemisphere(rows, short)?;
    closed_hemisphere(rows)
}
