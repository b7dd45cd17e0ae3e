// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bpm/measure/outside_measure.h>

/// How far each grain's centre is from the nearest other one, images included: nearest.csv.
class Nearest : public boba::OutsideMeasure {
public:
  std::vector<boba::MeasureTable> tables() const override;
  void add(const boba::Snapshot& frame, const boba::Topology& topology,
           const boba::WriteMeasureRow& write) const override;
};
