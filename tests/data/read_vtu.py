"""Reads all .vtu files below a folder with VTK's own reader, and what .pvd collections list.

Fails if a grid is refused or empty, if a solid that yields has a state that cannot be, or if a collection (which plain
VTK has no reader for) is not one of data sets whose files exist and were read, at times that do not fall and, for each
part, increase; and if no solid yields in any grid.
"""

import math
import pathlib
import sys
import xml.etree.ElementTree

from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def grid_faults(file):
    """What is wrong with a grid."""
    faults = []
    reader = vtkXMLUnstructuredGridReader()
    reader.AddObserver(vtkCommand.ErrorEvent, lambda *_: faults.append("refused"))
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    if grid.GetNumberOfPoints() == 0 or grid.GetNumberOfCells() == 0:
        faults.append("empty")
    return faults + solid_faults(grid)


yielding = []
"""Largest plastic strains of the grids with solids that yield."""


def solid_faults(grid):
    """What is wrong with the cell data of solids that yield; without such data nothing is."""
    data = {}
    for index in range(grid.GetCellData().GetNumberOfArrays()):
        array = grid.GetCellData().GetArray(index)
        data[array.GetName()] = [array.GetValue(cell) for cell in range(array.GetNumberOfTuples())]
    if "plastic_strain" not in data:
        return []
    faults = []
    for name in ("plastic_strain", "mobilised_strength", "mean_stress"):
        values = data.get(name, [])
        if len(values) != grid.GetNumberOfCells() or not all(map(math.isfinite, values)):
            faults.append(f"{name} is not one finite number for each cell")
    if min(data["plastic_strain"]) < 0.0:
        faults.append("plastic strain below zero")
    if not all(0.0 <= strength <= 1.0 + 1e-9 for strength in data["mobilised_strength"]):
        faults.append("mobilised strength outside of 0 to 1")
    yielding.append(max(data["plastic_strain"]))
    return faults


def collection_faults(file, read):
    """What is wrong with a collection of grids of which `read` were read."""
    root = xml.etree.ElementTree.parse(file).getroot()
    sets = root.findall("Collection/DataSet")
    if root.tag != "VTKFile" or root.get("type") != "Collection" or not sets:
        return ["no collection"]
    faults, last, listed = [], {}, set()
    for entry in sets:
        grid = file.parent / entry.get("file")
        time, part = float(entry.get("timestep")), entry.get("part")
        if grid not in read:
            faults.append(f"{grid.name} is not there")
        if grid in listed:
            faults.append(f"{grid.name} is listed twice")
        if time < max(last.values(), default=time) or time <= last.get(part, float("-inf")):
            faults.append(f"{grid.name}: time {time} after {last}")
        last[part] = time
        listed.add(grid)
    return faults


folder = pathlib.Path(sys.argv[1])
grids, collections = sorted(folder.rglob("*.vtu")), sorted(folder.rglob("*.pvd"))
wrong = {file: grid_faults(file) for file in grids}
wrong |= {file: collection_faults(file, set(grids)) for file in collections}
for file, faults in wrong.items():
    for fault in faults:
        print(f"{file}: {fault}")
errors = sum(1 for faults in wrong.values() if faults)
print(f"{len(grids)} grids and {len(collections)} collections read, {errors} refused, {len(yielding)} of solids that yield")
if max(yielding, default=0.0) == 0.0:
    print("no solid yields in any grid")
    errors += 1
sys.exit(0 if grids and collections and not errors else 1)
