"""Reads all .vtu files below a folder with VTK's own reader; fails if one is refused or empty."""

import pathlib
import sys

from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

errors = []
files = sorted(pathlib.Path(sys.argv[1]).rglob("*.vtu"))
for file in files:
    reader = vtkXMLUnstructuredGridReader()
    reader.AddObserver(vtkCommand.ErrorEvent, lambda *_, file=file: errors.append(file))
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    if grid.GetNumberOfPoints() == 0 or grid.GetNumberOfCells() == 0:
        errors.append(file)
print(f"{len(files)} grids read, {len(errors)} refused")
sys.exit(0 if files and not errors else 1)
