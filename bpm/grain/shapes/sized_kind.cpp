// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/sized_kind.h"

#include <fmt/format.h>

namespace boba {

namespace {

std::vector<BoundedLength> lengths(const TemplateSpec& spec, double lowest) {
  std::vector<BoundedLength> result;
  for (int a = 0; a < 3; ++a) {
    result.push_back({fmt::format("size[{}]", a), spec.size[a], lowest});
  }
  return result;
}

} // namespace

std::vector<BoundedLength> SizedKind::given(const TemplateSpec& spec) const {
  return lengths(spec, spec.n_nodes ? least_proportion : least_width);
}

std::vector<BoundedLength> SizedKind::widths(const TemplateSpec& spec) const {
  return lengths(spec, least_width);
}

std::string SizedKind::text(const TemplateSpec& spec) const {
  const double unit = spec.n_nodes ? spec.size.x() : 1.0;
  return fmt::format(" size={},{},{}", spec.size.x() / unit, spec.size.y() / unit, spec.size.z() / unit);
}

std::vector<BoundedLength> RadiusAndHeightKind::given(const TemplateSpec& spec) const {
  return {{"radius", spec.radius, spec.n_nodes ? least_proportion : 1.5},
          {"height", spec.height, spec.n_nodes ? least_proportion : least_width}};
}

std::string RadiusAndHeightKind::text(const TemplateSpec& spec) const {
  const double unit = spec.n_nodes ? spec.radius : 1.0;
  return fmt::format(" radius={} height={}", spec.radius / unit, spec.height / unit);
}

} // namespace boba
