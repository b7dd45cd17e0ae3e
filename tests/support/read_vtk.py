# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a .pvd of small_packing.h and its .vtp files with VTK and compares them with the formulas given there.

Usage: read_vtk.py FILE.pvd STEP [STEP ...]
"""
import os
import sys
import xml.etree.ElementTree as tree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

pvd, steps = sys.argv[1], [int(step) for step in sys.argv[2:]]
frames = tree.parse(pvd).getroot().findall("./Collection/DataSet")
assert len(frames) == len(steps)
i = np.arange(5)
for step, frame in zip(steps, frames):
    assert np.isclose(float(frame.get("timestep")), 0.1 * step)
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(os.path.join(os.path.dirname(pvd), frame.get("file")))
    reader.Update()
    data = reader.GetOutput()
    assert data.GetNumberOfPoints() == 5 and data.GetNumberOfVerts() == 5
    assert [data.GetCell(k).GetPointId(0) for k in range(5)] == list(i)
    array = {
        data.GetPointData().GetArrayName(k): vtk_to_numpy(data.GetPointData().GetArray(k))
        for k in range(data.GetPointData().GetNumberOfArrays())
    }
    assert list(array["grain"]) == [4, 4, 4, 9, 9] and list(array["species"]) == [1, 1, 1, 0, 0]
    assert list(array["id"]) == [11, 7, 3, 8, 2]
    assert np.array_equal(array["velocity"], np.stack([i, np.full(5, 0.1 * step), -i], axis=1))
    assert np.array_equal(array["force"], np.stack([0.25 * i, np.full(5, step), np.ones(5)], axis=1))
    assert np.isclose(data.GetFieldData().GetArray("TimeValue").GetValue(0), 0.1 * step)
    x = vtk_to_numpy(data.GetPoints().GetData())
    cell = np.array([[10 + 0.1 * step, 0, 0], [2.5, 9, 0], [-1.5, 0.75, 8]])
    wanted = np.stack([1.7 * i + 0.01 * step, 3.0 * i - 20.0, 0.5 - 2.0 * i], axis=1)
    for nodes in (slice(0, 3), slice(3, 5)):
        s = (x[nodes].mean(axis=0) - [0.5, -2, 1]) @ np.linalg.inv(cell)
        assert (s >= 0).all() and (s < 1).all(), "a grain's centre is outside the cell"
        shift = (wanted[nodes] - x[nodes]) @ np.linalg.inv(cell)
        assert np.allclose(shift, np.round(shift), atol=1e-12) and np.allclose(shift, shift[0]), "a grain is torn"
