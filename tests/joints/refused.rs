//! Scenes with joints that are errors.

use basemat::bem::SpringGround;
use basemat::coupled::Joint;
use basemat::interface::{Bonded, Coulomb};
use basemat::structure::{BaseNode, RigidBlock, RigidBody, StructureGroup};
use basemat::{Error, Result, Simulation};

fn line(points: &[[f64; 2]]) -> Vec<BaseNode> {
    let node = |&[x, z]: &[f64; 2]| BaseNode {
        x,
        z,
        horizontal: [(0, 1.0), (2, -z)].into(),
        vertical: [(1, 1.0), (2, x)].into(),
        ..BaseNode::default()
    };
    points.iter().map(node).collect()
}

#[test]
fn lines_that_are_not_opposite_each_other() {
    let upper = || line(&[[-1.0, 2.0], [1.0, 2.0]]);
    let is_error = |points: &[[f64; 2]]| {
        matches!(Joint::between(upper(), line(points), 4), Err(Error::Input { .. }))
    };
    assert!(Joint::between(upper(), line(&[[-1.0, 2.0], [1.0, 2.0]]), 4).is_ok());
    assert!(is_error(&[[1.0, 2.0], [-1.0, 2.0]]), "the other sense");
    assert!(is_error(&[[1.0, 2.0], [3.0, 2.0]]), "beside");
    assert!(is_error(&[[-1.0, 2.0], [1.0, 2.5]]), "not parallel");
    assert!(is_error(&[[-1.0, 2.0], [f64::NAN, 2.0]]), "not finite");
    assert!(matches!(Joint::between(upper(), line(&[[0.0, 2.0]]), 4), Err(Error::Size { .. })));
    assert!(matches!(Joint::between(upper(), upper(), 0), Err(Error::Size { .. })));
    let joint = Joint::between(upper(), upper(), 4).unwrap();
    assert!(joint.with_gap(-0.1).is_err());
}

/// A block whose middle is beyond the edge of the block under it falls; the block under it stands.
#[test]
fn a_block_that_falls_is_named_by_its_joint() -> Result<()> {
    let lower = RigidBlock::new(4.0, 2.0, 2000.0)?;
    let upper = RigidBlock::new(2.0, 1.0, 2000.0)?;
    let top = lower.contact_nodes(&[[-2.0, 2.0], [2.0, 2.0]])?;
    let scene = |shift: f64| -> Result<Simulation> {
        let bottom = upper.contact_nodes(&[[-1.0, 0.0], [1.0, 0.0]])?;
        let group = StructureGroup::new()
            .with(lower.clone(), 0.0)?
            .with_above(upper.clone(), [0.0, 2.0])?
            .with_above(upper.clone(), [shift, 2.0])?;
        let joint = |member: usize| -> Result<Joint> {
            let upper_side = group.contact_nodes(member, bottom.clone())?;
            Joint::between(upper_side, group.contact_nodes(0, top.clone())?, 4)
        };
        let builder = Simulation::builder(0.01)
            .ground(SpringGround::under(&group, 4, 1e9, 1e9)?)
            .interface(Coulomb::new(0.5)?)
            .joint(joint(1)?.with_law(Coulomb::new(0.5)?))
            .joint(joint(2)?.with_law(Coulomb::new(0.5)?));
        builder.structure(group).build()
    };
    assert!(scene(1.5).is_ok());
    let error = scene(2.3).unwrap_err();
    println!("{error}");
    // The far end of the joint opens.
    assert!(matches!(error, Error::Preload { joint_element: Some([1, 0]), .. }), "{error}");
    assert!(error.to_string().contains("element 0 of joint 1 moves most"));
    Ok(())
}

#[test]
fn scenes_without_support_or_in_plan() -> Result<()> {
    let lower = RigidBlock::new(4.0, 2.0, 2000.0)?;
    let upper = RigidBlock::new(2.0, 1.0, 2000.0)?;
    let top = lower.contact_nodes(&[[-1.0, 2.0], [1.0, 2.0]])?;
    let upper_top = upper.contact_nodes(&[[-1.0, 1.0], [1.0, 1.0]])?;
    let bottom = upper.contact_nodes(&[[-1.0, 0.0], [1.0, 0.0]])?;
    let group = || {
        StructureGroup::new()
            .with(lower.clone(), 0.0)?
            .with_above(upper.clone(), [0.0, 2.0])?
            .with_above(upper.clone(), [0.0, 3.0])
    };
    let scene = |joints: Vec<Joint>| -> Result<Simulation> {
        let group = group()?;
        let mut builder = Simulation::builder(0.01)
            .ground(SpringGround::under(&group, 4, 1e9, 1e9)?)
            .structure(group)
            .interface(Bonded);
        for joint in joints {
            builder = builder.joint(joint);
        }
        builder.build()
    };
    let nodes =
        |member: usize, nodes: &Vec<BaseNode>| group()?.contact_nodes(member, nodes.clone());
    let first = || Joint::between(nodes(1, &bottom)?, nodes(0, &top)?, 2);
    // The third block has no connection.
    assert!(scene(vec![first()?]).is_err());
    // The third block stands on itself.
    let self_joint = Joint::between(nodes(2, &bottom)?, nodes(2, &bottom)?, 2)?;
    assert!(matches!(
        scene(vec![first()?, self_joint]),
        Err(Error::Scene { quantity: "joints", .. })
    ));
    // A side with nodes of two blocks.
    let mixed_side = vec![nodes(1, &bottom)?[0].clone(), nodes(2, &bottom)?[1].clone()];
    let mixed_side = mixed_side.into_iter().map(|node| BaseNode { z: 2.0, ..node }).collect();
    let mixed_side = Joint::between(mixed_side, nodes(0, &top)?, 2)?;
    let second = Joint::between(nodes(2, &bottom)?, nodes(1, &upper_top)?, 2)?;
    assert!(matches!(
        scene(vec![first()?, second, mixed_side]),
        Err(Error::Scene { quantity: "joint", .. })
    ));
    // A degree of freedom that does not exist.
    let missing_dofs = vec![BaseNode::free(-1.0, 90, 91), BaseNode::free(1.0, 92, 93)];
    assert!(scene(vec![Joint::between(missing_dofs.clone(), missing_dofs, 2)?]).is_err());
    // A list of laws that is empty or has the wrong length.
    assert!(scene(vec![first()?.with_laws(Vec::new())]).is_err());
    // A gap that a bonded joint would close.
    let second = || Joint::between(nodes(2, &bottom)?, nodes(1, &upper_top)?, 2);
    let bonded_gap = second()?.with_gap(0.01)?;
    let expected = "gap of a joint";
    assert!(
        matches!(scene(vec![first()?, bonded_gap]), Err(Error::Input { quantity, .. }) if quantity == expected)
    );

    let body = RigidBody::cuboid([4.0, 4.0, 2.0], 2000.0)?;
    let joint =
        Joint::between(line(&[[-1.0, 2.0], [1.0, 2.0]]), line(&[[-1.0, 2.0], [1.0, 2.0]]), 2)?;
    let in_plan = Simulation::builder(0.01)
        .ground(SpringGround::under(&body, 4, 1e9, 1e9)?)
        .structure(body)
        .interface(Coulomb::new(0.5)?)
        .joint(joint)
        .build();
    assert!(matches!(in_plan, Err(Error::Scene { quantity: "joint", .. })));
    Ok(())
}
