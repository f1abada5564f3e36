"""Writes the meshes of tests/gmsh_files.rs with Gmsh 4.15 (pip install gmsh)."""

import gmsh


def write(order, size, path):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add("block")
    geo = gmsh.model.geo
    corners = [(-3, 0), (3, 0), (3, 2), (-3, 2), (3, 5), (-3, 5)]
    p = [geo.addPoint(x, y, 0, size) for x, y in corners]
    ends = [(0, 1), (1, 2), (2, 3), (3, 0), (2, 4), (4, 5), (5, 3)]
    base, right, seam, left, upper_right, roof, upper_left = (
        geo.addLine(p[a], p[b]) for a, b in ends
    )
    lower = geo.addPlaneSurface([geo.addCurveLoop([base, right, seam, left])])
    upper = geo.addPlaneSurface([geo.addCurveLoop([-seam, upper_right, roof, upper_left])])
    geo.synchronize()
    gmsh.model.addPhysicalGroup(1, [base], 1, "base")
    gmsh.model.addPhysicalGroup(1, [roof], 4, "roof")
    gmsh.model.addPhysicalGroup(2, [lower], 2, "lower")
    gmsh.model.addPhysicalGroup(2, [upper], 3, "upper")
    for option, value in [
        ("Algorithm", 8),
        ("RecombineAll", 1),
        ("SubdivisionAlgorithm", 1),
        ("SecondOrderIncomplete", 1),
        ("MshFileVersion", 4.1),
    ]:
        gmsh.option.setNumber("Mesh." + option, value)
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(order)
    gmsh.write(path)
    gmsh.finalize()


write(1, 0.9, "block_linear.msh")
write(2, 1.4, "block_second_order.msh")
