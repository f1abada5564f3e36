"""Writes the mesh of tests/io/gmsh_space.rs with Gmsh 4.15 (pip install gmsh)."""

import gmsh

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.model.add("space")
geo = gmsh.model.geo
# A block 4 m × 3 m of bricks, extruded downwards from z = 0 in two layers.
p = [geo.addPoint(x, y, 0, 1.2) for x, y in [(0, 0), (4, 0), (4, 3), (0, 3)]]
c = [geo.addLine(p[k], p[(k + 1) % 4]) for k in range(4)]
top = geo.addPlaneSurface([geo.addCurveLoop(c)])
geo.mesh.setRecombine(2, top)
block = geo.extrude([(2, top)], 0, 0, -0.8, [2], [1], recombine=True)
# A wall 3 m high over its side x = 0, of quadrilaterals, with triangles in a square inside.
corners = [geo.addPoint(0, y, 3, 0.8) for y in (3, 0)]
outline = [c[3], geo.addLine(p[0], corners[1]), geo.addLine(corners[1], corners[0]), geo.addLine(corners[0], p[3])]
q = [geo.addPoint(0, y, z, 0.5) for y, z in [(0.8, 0.9), (2.1, 0.9), (2.1, 2.2), (0.8, 2.2)]]
inside = [geo.addLine(q[k], q[(k + 1) % 4]) for k in range(4)]
loop = geo.addCurveLoop(inside)
wall = geo.addPlaneSurface([geo.addCurveLoop(outline), loop])
geo.mesh.setRecombine(2, wall)
panel = geo.addPlaneSurface([loop])
# A column of three elements at the corner (4, 0), and a beam from the wall to its top.
head = geo.addPoint(4, 0, 3)
column = geo.addLine(p[1], head)
beam = geo.addLine(corners[1], head)
geo.mesh.setTransfiniteCurve(column, 4)
geo.mesh.setTransfiniteCurve(beam, 3)
geo.synchronize()
model = gmsh.model
model.addPhysicalGroup(3, [block[1][1]], 1, "block")
model.addPhysicalGroup(2, [block[0][1]], 2, "base")
model.addPhysicalGroup(2, [wall, panel], 3, "wall")
model.addPhysicalGroup(1, [column], 4, "column")
model.addPhysicalGroup(1, [beam], 5, "beam")
model.addPhysicalGroup(1, [c[0]], 6, "edge")
model.addPhysicalGroup(0, [head], 7, "head")
for option, value in [("Algorithm", 8), ("RecombinationAlgorithm", 3), ("MshFileVersion", 4.1)]:
    gmsh.option.setNumber("Mesh." + option, value)
model.mesh.generate(3)
gmsh.write("space.msh")
gmsh.finalize()
