// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/insertion.h"

#include "bpm/grain/near_pairs.h"
#include "bpm/grain/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace boba {

namespace {

/// Share of space that the bounding spheres may take: random arrangements jam at about 0.64, and come to rest slowly
/// just below.
constexpr double densest = 0.60;
constexpr int most_sweeps = 10000;
constexpr double largest_edge = 1e7; ///< d; double positions still resolve 2e-9 d there
constexpr double inflation = 1e-3;   ///< the spheres that are pushed apart are a little larger than the real ones

double sphere_volume(double radius) {
  return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

/// Overlaps of spheres in a periodic cube, found with a cell grid (or all images in a cube of few cells).
///
/// The grid serves for several sweeps: it gives the pairs within a skin, which last until a sphere has moved by half of
/// that. Overlaps are added in the order in which the grid of the present positions would give them.
class SphereOverlaps {
public:
  SphereOverlaps(const std::vector<double>& radii, double edge) : radii_(radii), edge_(edge) {
    const double largest = *std::max_element(radii.begin(), radii.end()) * (1.0 + inflation);
    cells_ = static_cast<int>(std::min(edge / (2.0 * largest), most_cells));
    if (cells_ >= 3) {
      skin_ = std::clamp(edge / 3.0 - 2.0 * largest, 0.0, skin_share * largest);
      search_cells_ = std::max(3, static_cast<int>(std::min(edge / (2.0 * largest + skin_), most_cells)));
    }
  }

  /// Half the sum of each sphere's overlaps along the lines of centres; returns the largest relative overlap.
  /// \param moved most that a sphere has moved since the last call
  double push(const std::vector<Vector3>& x, double moved, std::vector<Vector3>& move) {
    std::fill(move.begin(), move.end(), Vector3::Zero());
    worst_ = 0.0;
    if (search_cells_ < 3) {
      push_all_images(x, move);
      return worst_;
    }
    moved_ += moved;
    if (first_pair_.empty() || 2.0 * moved_ > skin_) {
      list_pairs(x);
      moved_ = 0.0;
    }
    push_pairs(x, move);
    return worst_;
  }

private:
  static constexpr double most_cells = 128.0; ///< along an edge
  static constexpr double skin_share = 0.2;   ///< of the largest radius

  void push_pair(std::size_t i, std::size_t j, const Vector3& difference, std::vector<Vector3>& move) {
    const double reach = (radii_[i] + radii_[j]) * (1.0 + inflation);
    const double r2 = difference.squaredNorm();
    if (r2 < reach * reach && r2 > 0.0) {
      const double r = std::sqrt(r2);
      const Vector3 half = 0.5 * (reach - r) / r * difference;
      move[i] += half;
      move[j] -= half;
      worst_ = std::max(worst_, (reach - r) / reach);
    }
  }

  void push_all_images(const std::vector<Vector3>& x, std::vector<Vector3>& move) {
    const std::array<Vector3, 27> shifts = image_shifts(Vector3::Constant(edge_));
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (std::size_t j = i + 1; j < x.size(); ++j) {
        for (const Vector3& shift : shifts) {
          push_pair(i, j, x[i] - x[j] + shift, move);
        }
      }
    }
  }

  using Cell = std::array<std::int16_t, 3>;
  Cell cell_of(const Vector3& x, int n_cells) const {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
      cell[axis] = static_cast<std::int16_t>(std::min(static_cast<int>(x[axis] / edge_ * n_cells), n_cells - 1));
    }
    return cell;
  }

  /// Lists, for every sphere, the later ones that are within the skin or may come there.
  void list_pairs(const std::vector<Vector3>& x) {
    const int n = search_cells_;
    std::vector<int> first(static_cast<std::size_t>(n) * n * n, -1), next(x.size(), -1);
    const auto place = [&](int a, int b, int c) { return (static_cast<std::size_t>(c) * n + b) * n + a; };
    for (std::size_t i = x.size(); i-- > 0;) {
      const Cell cell = cell_of(x[i], n);
      int& head = first[place(cell[0], cell[1], cell[2])];
      next[i] = head;
      head = static_cast<int>(i);
    }
    first_pair_.assign(1, 0);
    later_.clear();
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Cell cell = cell_of(x[i], n);
      for (int neighbour = 0; neighbour < 27; ++neighbour) {
        const int offset[3] = {neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1};
        int beside[3];
        Vector3 shift = Vector3::Zero();
        for (int axis = 0; axis < 3; ++axis) {
          const int c = cell[axis] + offset[axis];
          shift[axis] = c < 0 ? edge_ : c >= n ? -edge_ : 0.0;
          beside[axis] = c < 0 ? c + n : c >= n ? c - n : c;
        }
        for (int j = first[place(beside[0], beside[1], beside[2])]; j >= 0; j = next[j]) {
          const double reach = (radii_[i] + radii_[j]) * (1.0 + inflation) + skin_;
          if (static_cast<std::size_t>(j) > i && (x[i] - x[j] + shift).squaredNorm() < reach * reach) {
            later_.push_back(j);
          }
        }
      }
      first_pair_.push_back(later_.size());
    }
  }

  /// The overlaps of the listed pairs, in the order of the cells around each sphere.
  void push_pairs(const std::vector<Vector3>& x, std::vector<Vector3>& move) {
    struct Overlap {
      int order, other;
      Vector3 difference;
    };
    cell_.resize(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      cell_[i] = cell_of(x[i], cells_);
    }
    std::vector<Overlap> overlaps;
    for (std::size_t i = 0; i < x.size(); ++i) {
      overlaps.clear();
      for (std::size_t k = first_pair_[i]; k < first_pair_[i + 1]; ++k) {
        const int j = later_[k];
        int order = 0;
        Vector3 shift = Vector3::Zero();
        for (int axis = 2; axis >= 0; --axis) {
          int offset = cell_[j][axis] - cell_[i][axis];
          if (offset > 1) { // the other is behind the lower face
            offset -= cells_;
            shift[axis] = edge_;
          } else if (offset < -1) {
            offset += cells_;
            shift[axis] = -edge_;
          }
          order = 3 * order + offset + 1;
        }
        const Vector3 difference = x[i] - x[j] + shift;
        const double reach = (radii_[i] + radii_[j]) * (1.0 + inflation);
        if (difference.squaredNorm() < reach * reach) {
          overlaps.push_back({order, j, difference});
        }
      }
      std::sort(overlaps.begin(), overlaps.end(), [](const Overlap& a, const Overlap& b) {
        return a.order != b.order ? a.order < b.order : a.other < b.other;
      });
      for (const Overlap& overlap : overlaps) {
        push_pair(i, overlap.other, overlap.difference, move);
      }
    }
  }

  const std::vector<double>& radii_;
  double edge_;
  double skin_ = 0.0, moved_ = 0.0; ///< moved since the pairs were listed
  int cells_ = 0, search_cells_ = 0;
  double worst_ = 0.0;
  std::vector<std::size_t> first_pair_; ///< per sphere, and one more
  std::vector<int> later_;              ///< of each pair the later sphere
  std::vector<Cell> cell_;
};

void wrap(Vector3& x, double edge) {
  for (int axis = 0; axis < 3; ++axis) {
    x[axis] -= edge * std::floor(x[axis] / edge);
    if (x[axis] >= edge) { // a tiny negative coordinate rounds up to the edge
      x[axis] = 0.0;
    }
  }
}

double reference_volume_of(const Insertion& insertion) {
  double volume = 0.0;
  for (const Grain& grain : insertion.grains) {
    volume += insertion.templates[grain.template_index]->reference_volume;
  }
  return volume;
}

void check_density(const Insertion& insertion, const std::vector<double>& radii, double edge) {
  double spheres = 0.0;
  for (const double radius : radii) {
    spheres += sphere_volume(radius);
  }
  const double share = spheres / (edge * edge * edge);
  if (share > densest) {
    throw std::invalid_argument(fmt::format("insert: at packing_fraction = {:g} the grains' bounding spheres (radius "
                                            "to the outermost node plus d/2) would fill "
                                            "{:.3f} of the cell; random placement reaches {:.2f}. Allowed for these "
                                            "grains: at most {:.3f}; compress afterwards",
                                            insertion.packing_fraction, share, densest,
                                            insertion.packing_fraction * densest / share));
  }
}

} // namespace

double bounding_radius(const GrainTemplate& grain, double diameter) {
  double largest = 0.0;
  for (const Vector3& x : grain.position) {
    largest = std::max(largest, x.norm());
  }
  return largest + 0.5 * diameter;
}

std::vector<Vector3> place_spheres(const std::vector<double>& radii, double edge, Random& random) {
  std::vector<Vector3> x(radii.size());
  for (Vector3& centre : x) {
    for (int axis = 0; axis < 3; ++axis) {
      centre[axis] = edge * random.uniform();
    }
  }
  if (radii.empty()) {
    return x;
  }
  // Each sphere moves by a share of its overlaps and keeps part of its last move; the share keeps a sphere with the
  // twelve neighbours it can have from overshooting.
  constexpr double share = 0.25, memory = 0.8;
  SphereOverlaps overlaps(radii, edge);
  std::vector<Vector3> push(radii.size()), last(radii.size(), Vector3::Zero());
  double worst = 1.0, moved = 0.0;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    worst = overlaps.push(x, moved, push);
    if (worst < 0.5 * inflation) {
      return x;
    }
    moved = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      last[i] = memory * last[i] + share * push[i];
      moved = std::max(moved, last[i].norm());
      x[i] += last[i];
      wrap(x[i], edge);
    }
  }
  throw std::runtime_error(fmt::format("insert: {} grains still overlap by {:.2g} of their size after {} sweeps; "
                                       "use a smaller packing_fraction",
                                       radii.size(), worst, most_sweeps));
}

Eigen::Quaterniond random_rotation(Random& random) {
  const double u = random.uniform();
  const double a = 2.0 * std::numbers::pi * random.uniform();
  const double b = 2.0 * std::numbers::pi * random.uniform();
  const double small = std::sqrt(1.0 - u), large = std::sqrt(u);
  return {large * std::cos(b), small * std::sin(a), small * std::cos(a), large * std::sin(b)};
}

double insertion_edge(const Insertion& insertion) {
  if (insertion.grains.empty() || !(insertion.packing_fraction > 0.0)) {
    throw std::invalid_argument(fmt::format("insert: {} grains at packing_fraction = {}; both must be positive",
                                            insertion.grains.size(), insertion.packing_fraction));
  }
  const double edge = std::cbrt(reference_volume_of(insertion) / insertion.packing_fraction);
  if (!(edge < largest_edge)) {
    throw std::invalid_argument(
        fmt::format("insert: packing_fraction = {:g} makes a cell of edge {:g} d; allowed: below {:g} d",
                    insertion.packing_fraction, edge, largest_edge));
  }
  return edge;
}

Packing insert_at_random(const Insertion& insertion) {
  const double edge = insertion_edge(insertion);
  std::vector<double> radii;
  for (const Grain& grain : insertion.grains) {
    radii.push_back(bounding_radius(*insertion.templates[grain.template_index], insertion.diameter));
  }
  check_density(insertion, radii, edge);
  Random random(insertion.seed);
  const std::vector<Vector3> centres = place_spheres(radii, edge, random);
  std::vector<Placement> placements;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const Eigen::Quaterniond rotation = insertion.rotate ? random_rotation(random) : Eigen::Quaterniond::Identity();
    placements.push_back({insertion.grains[i], centres[i], rotation});
  }
  return make_packing(Box(Vector3::Zero(), Vector3::Constant(edge)), insertion.templates, placements);
}

} // namespace boba
