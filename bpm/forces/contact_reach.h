// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba {

/// Distances below which two unbonded nodes touch, d.
struct ContactRanges {
  double between = 1.0; ///< of different grains, or of a grain and an image of itself
  double inside = 1.0;  ///< of the same grain; at most `between`
};

/// The distances that a contact list works with, d.
class ContactReach {
public:
  ContactReach(const ContactRanges& ranges, double skin)
      : diameter_(ranges.between), inner_diameter_(ranges.inside), skin_(skin), skin_between_(between_share * skin) {}

  double diameter() const { return diameter_; }
  double inner_diameter() const { return inner_diameter_; }
  /// Nodes closer than this when a pair is searched are candidates: of different grains, and of the same one.
  double between() const { return diameter_ + skin_between_; }
  double inside() const { return inner_diameter_ + skin_; }
  /// Distances inside a grain count as larger by this, and are then compared with those between grains.
  double later_inside() const { return diameter_ - inner_diameter_; }
  /// Left for motion between two looks at the grains.
  double reserve() const { return reserve_share * skin_; }
  /// Square of the distance beyond which a node that deviates gets a new place, d^2.
  double far2() const { return far_share * skin_ * far_share * skin_; }

  /// How far a node with a new place may be outside its grain's bounds before all are noted again.
  double bounds_margin = 0.5;
  /// Margin of the list of neighbouring grains.
  double neighbour_margin = 1.0;
  /// Most that a frame may shorten before all is noted again.
  static constexpr double largest_shortening = 0.05;

private:
  /// Shares of the skin, and skin between grains over the skin inside a grain, where nodes are denser and move less.
  static constexpr double reserve_share = 0.3, far_share = 0.3, between_share = 1.6;

  double diameter_, inner_diameter_, skin_, skin_between_;
};

} // namespace boba
