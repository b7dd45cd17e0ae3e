// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/bulk_density.h"

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boba {

class ClosedSurface;

/// What a grain template is made from: shape, size, surface and seed. Lengths in d, densities in nodes per d^3.
///
/// The size is nominal: a shape of volume V holds about `density * V` nodes for either surface.
/// With `n_nodes` the shape is scaled as a whole to hold exactly that number; `radius`, `height`, `size`, `vertices`
/// then give only its proportions (nothing for a sphere). What each shape takes: bpm/grain/shapes.
struct TemplateSpec {
  enum class Shape {
    sphere,         ///< `radius`
    cylinder,       ///< `radius` and `height`, axis along z
    box,            ///< `size`
    periodic_box,   ///< `size`; no surface, bonds across the faces
    ellipsoid,      ///< `size`, the three diameters
    superellipsoid, ///< `size`, `exponent`, `exponent_z`
    capsule,        ///< `radius` and `height`, with both half spheres; axis along z
    polyhedron,     ///< `polyhedron` and `radius`, or `vertices`; `rounding`
    mesh,           ///< `mesh` and `scale`
  };
  enum class Surface {
    cut,  ///< the nodes of a bulk arrangement that lie inside the shape
    wall, ///< relaxed inside a soft wall: outer layers follow the wall
  };

  Shape shape = Shape::sphere;
  Surface surface = Surface::cut;
  double radius = 10.0;
  double height = 40.0;
  Eigen::Vector3d size = Eigen::Vector3d::Constant(20.0);
  double exponent = 4.0;                               ///< across x and y; 1 to 50
  std::optional<double> exponent_z = std::nullopt;     ///< towards z; absent: the same
  std::string polyhedron = "cube";                     ///< a name; not looked at where there are vertices
  std::vector<Eigen::Vector3d> vertices = {};          ///< of a convex polyhedron
  double rounding = 0.0;                               ///< radius of its edges over that of the sphere inside, 0 to 0.9
  std::shared_ptr<const ClosedSurface> mesh = nullptr; ///< in units of `scale`
  double scale = 1.0;                                  ///< d
  std::optional<int> n_nodes = std::nullopt;
  std::uint64_t seed = 1;
  double bond_cutoff = 1.5;           ///< pairs closer than this in the undeformed grain are bonded
  double density = bulk_node_density; ///< of the bulk arrangement
};

/// True for a sphere of one node: a rigid sphere of diameter d, without bonds.
bool is_single_node(const TemplateSpec& spec);

/// Volume of the shape as given, without scaling to a number of nodes, d^3.
double nominal_volume(const TemplateSpec& spec);

/// Throws std::invalid_argument (member, value, what is allowed) when the specification makes no sense.
void validate(const TemplateSpec& spec);

/// One line that names everything the template depends on and nothing else: equal texts mean equal templates.
std::string canonical_text(const TemplateSpec& spec);

/// 64-bit FNV-1a hash of the canonical text. Two texts may share a hash: whoever uses it compares the texts too.
/// Source: IETF draft-eastlake-fnv, offset basis and prime for 64 bits.
std::uint64_t template_hash(const std::string& canonical_text);

/// "sphere", "cylinder", ...: the names of bpm/grain/shapes.
std::string to_string(TemplateSpec::Shape shape);
/// "cut", "wall".
std::string to_string(TemplateSpec::Surface surface);
/// Inverse of to_string. Throws std::invalid_argument for another word.
TemplateSpec::Shape shape_from_string(const std::string& word);
TemplateSpec::Surface surface_from_string(const std::string& word);

} // namespace boba
