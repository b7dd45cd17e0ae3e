# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a frame: grains each in its own colour, a cross-section, hulls coloured by normal."""
import colorsys

import numpy as np

from .render import Picture, view_axes


def grain_colours(n):
    """One colour a grain: hues by the golden ratio, so that grains with neighbouring numbers differ."""
    colours = [
        colorsys.hsv_to_rgb((0.58 + 0.618034 * k) % 1.0, (0.75, 0.5, 0.62)[k % 3], (0.95, 0.88, 0.75)[k // 3 % 3])
        for k in range(n)
    ]
    return 255 * np.array(colours)


def normal_colours(normals):
    """Directions as colours: x, y, z as red, green, blue from -1 (none) to 1 (full)."""
    return 255 * (0.5 + 0.5 * np.asarray(normals))


def fit(axes, points, margin):
    seen = points @ axes.T
    low, high = seen.min(axis=0) - margin, seen.max(axis=0) + margin
    return axes.T @ (0.5 * (low + high)), (high - low)[:2]


def cell_edges(frame, axis=None, place=0.5):
    """Both ends of the cell's twelve edges, or of the four where a plane at a fraction of one axis cuts it."""
    corners = np.array([[i, j, k] for k in (0.0, 1.0) for j in (0.0, 1.0) for i in (0.0, 1.0)])
    pairs = [(a, b) for a in range(8) for b in range(a + 1, 8) if np.abs(corners[a] - corners[b]).sum() == 1]
    if axis is not None:
        corners[:, axis] = place
        pairs = [(a, b) for a, b in pairs if a >> axis & 1 == 0 and b >> axis & 1 == 0]
    at = frame.origin + corners @ frame.box.T
    return [(at[a], at[b]) for a, b in pairs]


def grains_picture(frame, path, direction=(0.5, 0.35, 1.0), width=900):
    """All nodes as spheres of diameter d, a colour a grain."""
    grains = frame.placed_grains
    points = np.concatenate(grains)
    colours = np.repeat(grain_colours(len(grains)), [len(g) for g in grains], axis=0)
    axes = view_axes(direction)
    centre, span = fit(axes, points, 1.5)
    picture = Picture(axes, centre, span, width)
    picture.spheres(points, colours)
    picture.save(path)


def cross_section_nodes(frame, thickness, axis=2, place=0.5):
    """Nodes, each wrapped into the cell, within a slice normal to an axis of the cell, and their grains."""
    fractional = np.linalg.solve(frame.box, (frame.positions - frame.origin).T).T
    fractional -= np.floor(fractional)
    # Distance of the faces that the slice is parallel to.
    height = 1.0 / np.linalg.norm(np.linalg.inv(frame.box)[axis])
    inside = np.abs(fractional[:, axis] - place) * height < 0.5 * thickness
    grain = np.repeat(np.arange(len(frame.first_node) - 1), np.diff(frame.first_node))[inside]
    return frame.origin + fractional[inside] @ frame.box.T, grain


def cross_section_picture(frame, path, thickness=3.0, width=900):
    """The nodes within a slice through the middle of the cell, seen along z; each node wrapped into the cell."""
    points, grain = cross_section_nodes(frame, thickness)
    n_grains = len(frame.first_node) - 1
    axes = view_axes((0, 0, 1))
    centre, span = fit(axes, points, 1.5)
    picture = Picture(axes, centre, span, width)
    picture.spheres(points, grain_colours(n_grains)[grain])
    picture.save(path)


def hull_of(nodes):
    """Vertices, triangles and outward normals of the convex hull: the surface of the Delaunay tetrahedra (VTK)."""
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(nodes), deep=True))
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    delaunay = vtk.vtkDelaunay3D()
    delaunay.SetInputData(data)
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputConnection(delaunay.GetOutputPort())
    surface.Update()
    mesh = surface.GetOutput()
    vertices = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    triangles = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    outward = np.sign(np.einsum("ij,ij->i", normals, a - vertices.mean(axis=0)))
    return vertices, triangles, normals * outward[:, None]


def hulls_picture(frame, path, grains=(0,), width=None):
    """Hulls of some grains side by side, triangles coloured by their normal."""
    hulls = [hull_of(frame.grains[g] - frame.grain_centres[g]) for g in grains]
    radius = max(np.abs(vertices).max() for vertices, _, _ in hulls)
    span = (2.15 * radius * len(hulls), 2.15 * radius)
    picture = Picture(view_axes((0.3, 0.25, 1.0)), (0, 0, 0), span, width or min(420 * len(hulls), 2100))
    for k, (vertices, triangles, normals) in enumerate(hulls):
        offset = 2.15 * radius * (k - 0.5 * (len(hulls) - 1)) * picture.axes[0]
        picture.triangles(vertices + offset, triangles, normal_colours(normals))
    picture.save(path)
