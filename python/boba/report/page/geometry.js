// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines of grains, unpacked frame by frame into triangles that lie one after the other.
"use strict";
(() => {
  /** Bytes of a deflated text in base64. */
  const unpacked = async (text) => {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Response(stream).arrayBuffer();
  };

  /** Triangles of a frame: `places` 9 numbers each (d), `grain` and `facet` of each, `first` of each grain. */
  const trianglesOf = async (packing, frame) => {
    const [vertices, vertexCounts, triangles, triangleCounts, facets] = await Promise.all([
      unpacked(frame.vertices).then((buffer) => new Int16Array(buffer)),
      unpacked(frame.vertex_counts).then((buffer) => new Uint16Array(buffer)),
      unpacked(frame.triangles).then((buffer) => new Uint16Array(buffer)),
      unpacked(frame.triangle_counts).then((buffer) => new Uint16Array(buffer)),
      frame.facets ? unpacked(frame.facets).then((buffer) => new Uint8Array(buffer)) : null,
    ]);
    const n = triangles.length / 3;
    const result = { n, places: new Float32Array(9 * n), grain: new Uint32Array(n), facet: facets, first: new Uint32Array(triangleCounts.length + 1) };
    let [vertex, triangle] = [0, 0];
    for (let grain = 0; grain < triangleCounts.length; grain += 1) {
      result.first[grain] = triangle;
      for (let k = 0; k < triangleCounts[grain]; k += 1, triangle += 1) {
        result.grain[triangle] = grain;
        for (let corner = 0; corner < 3; corner += 1) {
          const at = 3 * (vertex + triangles[3 * triangle + corner]);
          for (let c = 0; c < 3; c += 1) {
            result.places[9 * triangle + 3 * corner + c] = vertices[at + c] * packing.quantum;
          }
        }
      }
      vertex += vertexCounts[grain];
    }
    result.first[triangleCounts.length] = triangle;
    return result;
  };

  /** Where the plane through `place` across an axis (0, 1, 2) cuts the edges of a grain's triangles: points in turn. */
  const outlineOfSection = (triangles, grain, axis, place) => {
    const { places, first } = triangles;
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    const points = [];
    for (let t = first[grain]; t < first[grain + 1]; t += 1) {
      for (let k = 0; k < 3; k += 1) {
        const [a, b] = [9 * t + 3 * k, 9 * t + 3 * ((k + 1) % 3)];
        const [from, to] = [places[a + axis] - place, places[b + axis] - place];
        if (from < 0 && to >= 0) {
          const share = from / (from - to);
          points.push([0, 1, 2].map((c) => places[a + c] + share * (places[b + c] - places[a + c])));
        }
      }
    }
    const middle = [u, v].map((c) => points.reduce((sum, p) => sum + p[c], 0) / points.length);
    return points.sort((p, q) => Math.atan2(p[v] - middle[1], p[u] - middle[0]) - Math.atan2(q[v] - middle[1], q[u] - middle[0]));
  };

  /** Cross-section of convex grains: flat `faces` (9 numbers a triangle), the grain of each, and `edges` around them. */
  Report.section = (triangles, axis, place, lift) => {
    const [faces, edges, grains] = [[], [], []];
    for (let grain = 0; grain + 1 < triangles.first.length; grain += 1) {
      const points = outlineOfSection(triangles, grain, axis, place);
      // Each grain a little above the one before, so that where two overlap one of them is seen.
      points.forEach((p) => (p[axis] += lift * (1 + grain % 64)));
      for (let k = 0; k < points.length && points.length > 2; k += 1) {
        const next = points[(k + 1) % points.length];
        edges.push(...points[k], ...next);
        if (k > 0 && k + 1 < points.length) {
          faces.push(...points[0], ...points[k], ...next);
          grains.push(grain);
        }
      }
    }
    return { faces: new Float32Array(faces), edges: new Float32Array(edges), grains };
  };

  const kept = new WeakMap();
  /** Triangles of a frame, unpacked once. Places count from the packing's centre. */
  Report.triangles = (packing, k) => {
    const frame = packing.frames[k];
    if (!kept.has(frame)) {
      kept.set(frame, trianglesOf(packing, frame));
    }
    return kept.get(frame);
  };

  /** The twelve edges of a frame's cell as pairs of places, from the packing's centre. */
  Report.cellEdges = (packing, frame) => {
    const corner = (i, j, k) => [0, 1, 2].map((c) =>
      frame.origin[c] - packing.centre[c] + i * frame.box[c] + j * frame.box[3 + c] + k * frame.box[6 + c]);
    const edges = [];
    for (const [a, b] of [[0, 0], [0, 1], [1, 0], [1, 1]]) {
      edges.push(...corner(0, a, b), ...corner(1, a, b), ...corner(a, 0, b), ...corner(a, 1, b), ...corner(a, b, 0), ...corner(a, b, 1));
    }
    return new Float32Array(edges);
  };

  /** Smallest and largest of a quantity over all frames, without the outermost hundredth. */
  Report.rangeOf = (packing, key) => {
    const values = packing.frames.flatMap((frame) => frame.values[key] ?? []).filter((v) => v !== null).sort((a, b) => a - b);
    if (values.length === 0) {
      return [0, 1];
    }
    const at = (share) => values[Math.round(share * (values.length - 1))];
    const [low, high] = [at(0.01), at(0.99)];
    return low < high ? [low, high] : [low - 0.5, high + 0.5];
  };

  /** Colour of each grain at a frame for a quantity, [r, g, b] from 0 to 255. */
  Report.grainColours = (packing, k, quantity) => {
    const frame = packing.frames[k];
    const range = quantity.kind === "number" ? Report.rangeOf(packing, quantity.key) : null;
    return packing.grains.map((_, grain) => {
      if (quantity.kind === "index") {
        return Report.grainColour(grain);
      }
      if (quantity.kind === "class") {
        const value = quantity.key === "species" ? packing.species[grain] : frame.values[quantity.key]?.[grain];
        return value === null || value === undefined ? [150, 156, 164] : Report.classColour(quantity.classes, value);
      }
      const value = frame.values[quantity.key]?.[grain];
      return value === null || value === undefined ? [150, 156, 164] : Report.viridis((value - range[0]) / (range[1] - range[0]));
    });
  };
})();
