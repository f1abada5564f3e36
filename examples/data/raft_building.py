"""Writes the mesh of the example raft_from_gmsh with Gmsh 4.15 (pip install gmsh)."""

import gmsh

HEIGHTS = [0.0, 4.0, 7.5, 11.0, 14.5]  # raft and four floors, m
RAFT = (-1.5, -1.5, 15.0, 12.0)  # x, y, length, width
FLOOR = (0.0, 0.0, 12.0, 9.0)
CORE = (0.0, 3.0, 3.0, 3.0)  # lift and stairs, without slabs; open to the left
COLUMNS = [(x, y) for x in (0.0, 6.0, 12.0) for y in (0.0, 9.0)] + [(6.0, 3.0), (6.0, 6.0), (12.0, 4.5)]

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.model.add("raft_building")
occ, model = gmsh.model.occ, gmsh.model


def rectangle(x, y, length, width, z):
    return occ.addRectangle(x, y, z, length, width)


parts = {"raft": [(2, rectangle(*RAFT, 0.0))], "floors": [], "core": [], "columns": []}
for below, above in zip(HEIGHTS, HEIGHTS[1:]):
    cut, _ = occ.cut([(2, rectangle(*FLOOR, above))], [(2, rectangle(*CORE, above))])
    parts["floors"] += cut
    x, y, length, width = CORE
    for foot, along in [((x, y), (length, 0)), ((x + length, y), (0, width)), ((x, y + width), (length, 0))]:
        line = occ.addLine(
            occ.addPoint(*foot, below), occ.addPoint(foot[0] + along[0], foot[1] + along[1], below)
        )
        parts["core"] += [e for e in occ.extrude([(1, line)], 0, 0, above - below) if e[0] == 2]
    for x, y in COLUMNS:
        parts["columns"].append((1, occ.addLine(occ.addPoint(x, y, below), occ.addPoint(x, y, above))))
# Common nodes where parts meet.
whole = [entity for own in parts.values() for entity in own]
_, pieces = occ.fragment(whole, [])
occ.synchronize()
found = dict(zip(whole, pieces))
for tag, (name, own) in enumerate(parts.items(), 1):
    group = sorted({piece for entity in own for piece in found[entity]})
    model.addPhysicalGroup(group[0][0], [piece[1] for piece in group], tag, name)
corner = model.getEntitiesInBoundingBox(11.9, 8.9, 14.4, 12.1, 9.1, 14.6, 0)
model.addPhysicalGroup(0, [corner[0][1]], 9, "roof corner")
for option, value in [
    ("MeshSizeMin", 1.5),
    ("MeshSizeMax", 1.5),
    ("Algorithm", 8),
    ("RecombineAll", 1),
    ("RecombinationAlgorithm", 0),
    ("MshFileVersion", 4.1),
]:
    gmsh.option.setNumber("Mesh." + option, value)
model.mesh.generate(2)
gmsh.write("raft_building.msh")
gmsh.finalize()
