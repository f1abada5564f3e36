"""Reads all .vtu files below a folder with VTK's own reader, and what .pvd collections list.

Fails if a grid is refused or empty, or if a collection (which plain VTK has no reader for) is not
one of data sets whose files exist and were read, at times that do not fall and, for each part,
increase.
"""

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
print(f"{len(grids)} grids and {len(collections)} collections read, {errors} refused")
sys.exit(0 if grids and collections and not errors else 1)
