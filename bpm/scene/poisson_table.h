// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace boba {

/// A smooth curve through points that rises or falls monotonically where they do, cubic between them.
/// Source: F. N. Fritsch and R. E. Carlson, SIAM J. Numer. Anal. 17 (1980) 238; slopes by the weighted harmonic mean of
/// F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300.
class MonotoneCurve {
public:
  MonotoneCurve() = default;
  /// x strictly increasing, y strictly monotone, at least two points; `name` for messages.
  /// \throws std::invalid_argument otherwise.
  MonotoneCurve(std::vector<double> x, std::vector<double> y, const std::string& name);

  double lowest() const { return x_.front(); }
  double highest() const { return x_.back(); }
  /// y at x. \throws std::out_of_range outside [lowest, highest].
  double operator()(double x) const;
  /// The x at which the curve has the value y. \throws std::out_of_range when it has not.
  double inverse(double y) const;

private:
  std::vector<double> x_, y_, slope_;
};

/// Elastic constants of the bonded network against its many-body coefficient, read from calibration/table.toml.
///
/// alpha in k d, E in k/d for k = 1; for other k, E scales with k and depends on alpha / k.
/// Source: docs/formats.md, "Poisson table".
class PoissonTable {
public:
  /// \throws InputError when the file is missing, is not such a table, or is not monotone.
  explicit PoissonTable(const std::filesystem::path& file);
  /// The installed table: poisson_table.toml in data_folder().
  static PoissonTable installed();

  /// \throws InputError with the allowed interval when it lies outside the table.
  double alpha_of_poisson(double poisson, double k) const;
  double poisson(double alpha, double k) const;
  double young(double alpha, double k) const;
  /// E / (2 - 2 nu^2), k/d; empty outside the table.
  std::optional<double> effective_modulus(double alpha, double k) const;

  std::array<double, 2> alpha_range() const { return {poisson_.lowest(), poisson_.highest()}; }
  /// alpha (for stiffness k) at and below which the undeformed network collapses; empty when the table does not say.
  std::optional<double> stability_limit(double k) const;
  const std::string& source() const { return source_; } ///< where the numbers come from, one line

private:
  double checked(double alpha, double k) const;

  std::filesystem::path file_;
  std::string source_;
  std::optional<double> stability_limit_; ///< for k = 1
  MonotoneCurve young_, poisson_;
};

} // namespace boba
