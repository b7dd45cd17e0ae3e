# SPDX-License-Identifier: GPL-3.0-or-later
"""Outlines of grains: convex hulls of their nodes, simplified to few vertices and grown to the nodes' surface."""
from __future__ import annotations

import dataclasses

import numpy as np
from scipy.spatial import ConvexHull, QhullError

NODE_RADIUS = 0.5  # d, where the scene has no material.contact_diameter


@dataclasses.dataclass(frozen=True)
class Outline:
    """vertices: shape (v, 3), d; triangles: shape (t, 3), outward; volume (d^3), area (d^2) of the nodes' hull.

    normals: shape (t, 3), outward, of the triangles before they grew.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    volume: float
    area: float
    normals: np.ndarray

    @property
    def asphericity(self) -> float:
        """A^(3/2) / (6 sqrt(pi) V), 1 for a ball (docs/notation.md); nan for a hull without volume."""
        return float(self.area**1.5 / (6 * np.pi**0.5 * self.volume)) if self.volume > 0 else float("nan")


def fibonacci_directions(n: int) -> np.ndarray:
    """n unit vectors spread evenly over the sphere, shape (n, 3)."""
    k = np.arange(n) + 0.5
    z = 1 - 2 * k / n
    angle = np.pi * (1 + 5**0.5) * k
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


def outward_triangles(points: np.ndarray, hull: ConvexHull) -> np.ndarray:
    """Triangles of a hull with their corners in the order that makes normals point outwards."""
    triangles = hull.simplices.copy()
    a, b, c = (points[triangles[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0
    triangles[inward] = triangles[inward][:, ::-1]
    return triangles


def grown(vertices: np.ndarray, triangles: np.ndarray, by: float) -> np.ndarray:
    """Vertices moved out so that the faces of a convex body move out by `by`, d.

    Each vertex moves along the mean n of its faces' unit normals n_f, by / mean(n . n_f); corners of more than 60
    degrees are cut, so that a spike stays a spike of length 2 `by` at most.
    """
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = normals / np.where(length > 0, length, 1)
    sums, counts = np.zeros_like(vertices), np.zeros(len(vertices))
    for k in range(3):
        np.add.at(sums, triangles[:, k], normals)
        np.add.at(counts, triangles[:, k], 1)
    size = np.linalg.norm(sums, axis=1)
    direction = sums / np.where(size > 0, size, 1)[:, None]
    return vertices + direction * (by / np.maximum(size / np.maximum(counts, 1), 0.5))[:, None]


def ball(centre: np.ndarray, radius: float, n: int = 32) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and outward triangles of a ball."""
    directions = fibonacci_directions(n)
    return centre + radius * directions, outward_triangles(directions, ConvexHull(directions))


def outline_of(nodes: np.ndarray, most_vertices: int, radius: float = NODE_RADIUS) -> Outline:
    """Outline of a grain with nodes of shape (n, 3): its convex hull, of at most `most_vertices` vertices, grown by
    the nodes' radius, d.

    Larger hulls keep the nodes that lie farthest out in so many directions. Nodes that lie in a plane, and single
    ones, become a ball. Volume and area are those of the whole hull through the nodes' centres (docs/notation.md); of a
    single node those of a ball of diameter d.
    """
    if len(nodes) > 3:
        try:
            hull = ConvexHull(nodes)
        except QhullError:
            hull = None
        if hull is not None:
            volume, area = float(hull.volume), float(hull.area)
            corners = nodes[hull.vertices]
            if len(corners) > most_vertices:
                middle = corners.mean(axis=0)
                farthest = np.argmax((corners - middle) @ fibonacci_directions(most_vertices).T, axis=0)
                corners = corners[np.unique(farthest)]
            small = ConvexHull(corners)
            triangles = outward_triangles(corners, small)
            return Outline(grown(corners, triangles, radius), triangles, volume, area, small.equations[:, :3])
    middle = nodes.mean(axis=0)
    reach = float(np.linalg.norm(nodes - middle, axis=1).max())
    vertices, triangles = ball(middle, reach + radius, min(most_vertices, 48))
    normals = np.zeros((len(triangles), 3))
    if len(nodes) == 1:
        return Outline(vertices, triangles, np.pi / 6, np.pi, normals)
    return Outline(vertices, triangles, float("nan"), float("nan"), normals)
