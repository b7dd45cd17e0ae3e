// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/stage_registry.h"

#include "bpm/stages/compress.h"
#include "bpm/stages/deform_entry.h"
#include "bpm/stages/hold.h"
#include "bpm/stages/named_loadings.h"
#include "bpm/stages/press.h"
#include "bpm/stages/quasistatic.h"
#include "bpm/stages/relax.h"
#include "bpm/stages/shear.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

template <ReadableStage Entry> StageKind kind_of() {
  return {Entry::section(), [](const SceneTable& table) { return std::make_shared<const Entry>(table); }};
}

/// The stages that Boba has of itself: one line each.
std::vector<StageKind>& registered_stages() {
  static std::vector<StageKind> kinds = {
      kind_of<CompressEntry>(),  kind_of<HoldEntry>(),      kind_of<ShearEntry>(),   kind_of<PressEntry>(),
      kind_of<DeformEntry>(),    kind_of<UniaxialEntry>(),  kind_of<BiaxialEntry>(), kind_of<TriaxialEntry>(),
      kind_of<OedometerEntry>(), kind_of<PureShearEntry>(), kind_of<RelaxEntry>(),   kind_of<QuasistaticEntry>(),
  };
  return kinds;
}

} // namespace

void register_stage(StageKind kind) {
  if (find_stage_kind(kind.section.kind) != nullptr) {
    throw std::logic_error(fmt::format("there is a stage \"{}\" already", kind.section.kind));
  }
  registered_stages().push_back(std::move(kind));
}

const std::vector<StageKind>& stage_kinds() {
  return registered_stages();
}

const StageKind* find_stage_kind(const std::string& name) {
  const auto at =
      std::ranges::find_if(registered_stages(), [&](const StageKind& kind) { return kind.section.kind == name; });
  return at == registered_stages().end() ? nullptr : &*at;
}

} // namespace boba
