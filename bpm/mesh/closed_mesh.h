// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/shapes/closed_surface.h"

#include <array>
#include <filesystem>
#include <memory>
#include <vector>

namespace boba {

/// Points and the triangles between them.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
};

/// Most triangles of a mesh, and the longest file that is read (bytes).
constexpr std::size_t most_triangles = 200'000;
constexpr std::uintmax_t longest_mesh_file = 100'000'000;

/// A mesh from a file in STL, OFF, PLY or OBJ, told by the name's ending. Points that coincide become one; faces of
/// more than three corners are cut into triangles.
/// \throws std::invalid_argument in one sentence: no such format, not readable, too long, coordinates that are not
/// finite.
TriangleMesh read_triangle_mesh(const std::filesystem::path& path);

/// The solid inside a mesh, moved to its centre of volume.
/// \throws std::invalid_argument, with the place, when the mesh is not closed (an edge has not two triangles), not
/// oriented (two triangles go round an edge in the same sense), inside out, cuts itself or encloses nothing.
std::shared_ptr<const ClosedSurface> closed_surface(TriangleMesh mesh);

} // namespace boba
