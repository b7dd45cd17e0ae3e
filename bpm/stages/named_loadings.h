// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/stages/deform_entry.h"

namespace boba {

/// The loadings of soil and powder mechanics, each a `deform` with few keys: one axis is strained, and the kinds differ
/// in what the other two do.

/// A [[stage]] with `type = "uniaxial"`: the other two normal stresses are zero.
class UniaxialEntry : public LoadingEntry {
public:
  static SceneSection section();
  explicit UniaxialEntry(const SceneTable& table);
};

/// `type = "triaxial"`: the other two normal stresses are held at the confining pressure.
class TriaxialEntry : public LoadingEntry {
public:
  static SceneSection section();
  explicit TriaxialEntry(const SceneTable& table);
};

/// `type = "biaxial"`: one of the others is fixed (plane strain), the last held at the confining pressure.
class BiaxialEntry : public LoadingEntry {
public:
  static SceneSection section();
  explicit BiaxialEntry(const SceneTable& table);
};

/// `type = "oedometer"`: the others are fixed.
class OedometerEntry : public LoadingEntry {
public:
  static SceneSection section();
  explicit OedometerEntry(const SceneTable& table);
};

/// `type = "pure_shear"`: another axis keeps the volume, the last is fixed.
class PureShearEntry : public LoadingEntry {
public:
  static SceneSection section();
  explicit PureShearEntry(const SceneTable& table);
};

} // namespace boba
