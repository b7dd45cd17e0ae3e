# SPDX-License-Identifier: GPL-3.0-or-later
"""A small renderer: shaded spheres and flat triangles with a depth buffer, orthographic, numpy only.

It needs no display, and a million spheres take seconds: for each pixel offset within a sphere's disc all spheres are
written at once, in the order of their depth, so that the nearest one stays.
"""
import numpy as np


def view_axes(direction, up=(0.0, 1.0, 0.0)):
    """Rows: right, up and towards the eye, for an eye in `direction`."""
    towards = np.asarray(direction, dtype=float) / np.linalg.norm(direction)
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(towards, right), towards])


class Picture:
    """Pixels of colour and depth; lengths are scaled so that `span` (width, height) around `centre` fits."""

    def __init__(self, axes, centre, span, width=900, oversampling=2):
        self.axes = axes
        self.centre = np.asarray(centre, dtype=float)
        self.oversampling = oversampling
        self.scale = oversampling * width / span[0]
        self.nx = oversampling * width
        self.ny = int(np.ceil(span[1] * self.scale / oversampling)) * oversampling
        self.colour = np.full((self.ny * self.nx, 3), 255.0, dtype=np.float32)
        self.depth = np.full(self.ny * self.nx, -np.inf, dtype=np.float32)
        light = np.array([-0.35, 0.55, 0.76])
        self.light = light / np.linalg.norm(light)

    def _project(self, points):
        seen = (np.asarray(points) - self.centre) @ self.axes.T
        return (
            seen[:, 0] * self.scale + 0.5 * self.nx,
            0.5 * self.ny - seen[:, 1] * self.scale,
            seen[:, 2] * self.scale,
        )

    def _shade(self, normal):
        return 0.35 + 0.65 * np.clip(normal @ self.light, 0.0, 1.0)

    def spheres(self, points, colours, radius=0.5):
        x, y, z = self._project(points)
        order = np.argsort(z, kind="stable")
        x, y, z = x[order], y[order], z[order].astype(np.float32)
        colours = np.asarray(colours, dtype=np.float32)[order]
        column, row = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
        r = radius * self.scale
        reach = int(np.ceil(r))
        buffer = np.empty_like(self.depth)
        for dy in range(-reach, reach + 1):
            for dx in range(-reach, reach + 1):
                rest = r * r - dx * dx - dy * dy
                if rest < 0:
                    continue
                height = np.sqrt(rest)
                i, j = column + dx, row + dy
                inside = np.flatnonzero((i >= 0) & (i < self.nx) & (j >= 0) & (j < self.ny))
                pixel = j[inside] * self.nx + i[inside]
                # Later writes win, and the spheres come in the order of their depth.
                buffer[pixel] = inside
                winners = np.unique(pixel)
                sphere = buffer[winners].astype(np.int64)
                depth = z[sphere] + np.float32(height)
                nearer = depth > self.depth[winners]
                winners, sphere = winners[nearer], sphere[nearer]
                self.depth[winners] = depth[nearer]
                shade = self._shade(np.array([dx, -dy, height]) / r)
                self.colour[winners] = shade * colours[sphere]

    def triangles(self, points, triangles, colours, edge=0.45):
        """Flat triangles; a thin darker line along the edges (`edge` times the colour)."""
        x, y, z = self._project(points)
        for (a, b, c), colour in zip(triangles, np.asarray(colours, dtype=float)):
            area = (x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a])
            if abs(area) < 1e-9:
                continue
            left, right = int(min(x[a], x[b], x[c])), int(max(x[a], x[b], x[c])) + 1
            top, bottom = int(min(y[a], y[b], y[c])), int(max(y[a], y[b], y[c])) + 1
            left, top, right, bottom = max(left, 0), max(top, 0), min(right, self.nx - 1), min(bottom, self.ny - 1)
            if left > right or top > bottom:
                continue
            i, j = np.meshgrid(np.arange(left, right + 1) + 0.5, np.arange(top, bottom + 1) + 0.5)
            wb = ((i - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (j - y[a])) / area
            wc = ((x[b] - x[a]) * (j - y[a]) - (i - x[a]) * (y[b] - y[a])) / area
            wa = 1.0 - wb - wc
            depth = wa * z[a] + wb * z[b] + wc * z[c]
            pixel = j.astype(np.int64) * self.nx + i.astype(np.int64)
            inside = (wa >= 0) & (wb >= 0) & (wc >= 0) & (depth > self.depth[pixel])
            normal = np.cross([x[b] - x[a], y[a] - y[b], z[b] - z[a]], [x[c] - x[a], y[a] - y[c], z[c] - z[a]])
            normal /= np.linalg.norm(normal)
            if normal[2] < 0:
                normal = -normal
            sides = [np.hypot(x[p] - x[q], y[p] - y[q]) for p, q in ((b, c), (c, a), (a, b))]
            to_edge = np.min([w * abs(area) / max(s, 1e-9) for w, s in zip((wa, wb, wc), sides)], axis=0)
            line = np.where(to_edge < 0.6 * self.oversampling, edge, 1.0)
            self.depth[pixel[inside]] = depth[inside]
            self.colour[pixel[inside]] = (self._shade(normal) * line[inside])[:, None] * colour

    def segment(self, a, b, colour=(60, 60, 60), width=1.5):
        """A line, hidden by what is nearer."""
        n = int(2 * np.linalg.norm(np.asarray(b) - a) * self.scale) + 2
        points = np.asarray(a) + np.linspace(0, 1, n)[:, None] * (np.asarray(b) - a)
        self.spheres(points, np.tile(colour, (n, 1)), radius=0.5 * width * self.oversampling / self.scale)

    def pixels(self):
        """Colours from 0 to 255, shape (rows, columns, 3)."""
        k = self.oversampling
        means = self.colour.reshape(self.ny // k, k, self.nx // k, k, 3).mean(axis=(1, 3))
        return np.clip(means, 0, 255).astype(np.uint8)

    def save(self, path):
        from matplotlib import image

        image.imsave(path, self.pixels())
