"""Writes one mesh in the four forms of Gmsh's format with Gmsh 4.15 (pip install gmsh): tests/io/gmsh_formats.rs."""

import gmsh

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.model.add("formats")
geo = gmsh.model.geo
# A block 2 m × 1 m of four bricks, two walls on its sides, of which one has quadrilaterals and one triangles, a column.
p = [geo.addPoint(x, y, 0, 1.0) for x, y in [(0, 0), (2, 0), (2, 1), (0, 1)]]
c = [geo.addLine(p[k], p[(k + 1) % 4]) for k in range(4)]
for curve, nodes in zip(c, [3, 3, 3, 3]):
    geo.mesh.setTransfiniteCurve(curve, nodes)
top = geo.addPlaneSurface([geo.addCurveLoop(c)])
geo.mesh.setTransfiniteSurface(top)
geo.mesh.setRecombine(2, top)
block = geo.extrude([(2, top)], 0, 0, -0.7, [1], [1], recombine=True)
up = [geo.addPoint(x, y, 1.3) for x, y in [(0, 0), (2, 0), (2, 1), (0, 1)]]
post = [geo.addLine(p[k], up[k]) for k in range(4)]
walls = []
for start, end, curve in [(0, 1, c[0]), (3, 0, c[3])]:
    roof = geo.addLine(up[start], up[end])
    for line in [roof, post[start], post[end]]:
        geo.mesh.setTransfiniteCurve(line, 3)
    wall = geo.addPlaneSurface([geo.addCurveLoop([curve, post[end], -roof, -post[start]])])
    geo.mesh.setTransfiniteSurface(wall)
    walls.append(wall)
geo.mesh.setRecombine(2, walls[0])
head, column = up[2], post[2]
geo.mesh.setTransfiniteCurve(column, 3)
geo.synchronize()
model = gmsh.model
model.addPhysicalGroup(3, [block[1][1]], 1, "block")
model.addPhysicalGroup(2, [block[0][1]], 2, "base")
model.addPhysicalGroup(2, walls, 3, "walls")
# The first wall is in a second group, and the column's group has no name.
model.addPhysicalGroup(2, walls[:1], 8, "front wall")
model.addPhysicalGroup(1, [column], 4)
model.addPhysicalGroup(0, [head], 7, "head")
model.mesh.generate(3)
# A section that readers do not need.
view = gmsh.view.add("heights")
tags, points, _ = model.mesh.getNodes()
gmsh.view.addModelData(view, 0, "formats", "NodeData", tags, [[z] for z in points[2::3]])
for version, binary, name in [(4.1, 0, "text41"), (4.1, 1, "binary41"), (2.2, 0, "text22"), (2.2, 1, "binary22")]:
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.write(f"formats_{name}.msh")
    if binary:
        gmsh.option.setNumber("PostProcessing.SaveMesh", 0)
        gmsh.view.write(view, f"formats_{name}.msh", append=True)
gmsh.finalize()
