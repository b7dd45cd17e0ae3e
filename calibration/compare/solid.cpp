// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/compare/solid.h"

#include "calibration/network/network_stiffness.h"
#include "calibration/specimen/uniaxial_curve.h"

#include <fmt/format.h>
#include <fstream>
#include <stdexcept>

namespace boba::calibration {

Solid calibrate_solid(const GrainTemplate& box, double alpha, const std::filesystem::path& folder,
                      double largest_strain) {
  Solid solid{.alpha = alpha};
  solid.constants = isotropic_part(relaxed_stiffness(connected_network(box), {alpha}).front().stiffness);
  solid.compression = folder / fmt::format("compression_{:g}.csv", alpha);
  std::ofstream file(solid.compression);
  file << "# compressive strain, compressive nominal stress (k/d), lateral strain\n";
  std::vector<double> strains = {-0.001};
  for (int n = 1; n <= 7; ++n) {
    strains.push_back(-largest_strain * n / 7.0);
  }
  for (const UniaxialPoint& point : uniaxial_curve(box, alpha, strains)) {
    file << fmt::format("{:.8g},{:.8g},{:.8g}\n", 1.0 - point.axial_stretch, -point.stress,
                        point.lateral_stretch - 1.0);
  }
  file.close();
  if (!file) {
    throw std::runtime_error("cannot write " + solid.compression.string());
  }
  return solid;
}

} // namespace boba::calibration
