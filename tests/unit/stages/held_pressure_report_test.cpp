// SPDX-License-Identifier: GPL-3.0-or-later
// What a stage says about the pressure that it was to hold, against sums done by hand.
#include "bpm/stages/held_pressure_report.h"

#include <gtest/gtest.h>

namespace boba {
namespace {

TEST(HeldPressureReport, CountsTheSecondHalfAlone) {
  HeldPressureReport report;
  report.add(9.0, 0.1, 0.2); // not counted
  for (const double pressure : {0.101, 0.099, 0.104, 0.096}) {
    report.add(pressure, 0.1, 0.75);
  }
  EXPECT_FALSE(report.is_missed());
  EXPECT_NE(report.text().find("P 0.1 +- 0.0029 k/d"), std::string::npos) << report.text(); // sqrt((1 + 16) / 2) 1e-3
  EXPECT_NE(report.text().find("100 % of its steps"), std::string::npos) << report.text();
  EXPECT_EQ(report.text().find("warning"), std::string::npos);
}

TEST(HeldPressureReport, WarnsOfATargetThatWasMissed) {
  HeldPressureReport report;
  for (const double pressure : {0.13, 0.12, 0.104, 0.14}) {
    report.add(pressure, 0.1, 1.0);
  }
  EXPECT_TRUE(report.is_missed());
  EXPECT_EQ(report.text().rfind("warning", 0), 0u) << report.text();
  EXPECT_NE(report.text().find("25 % of its steps"), std::string::npos) << report.text();
  HeldPressureReport again;
  SavedState state;
  Archive to = Archive::saving_to(state);
  report.archive(to);
  Archive from = Archive::reading_from(state);
  again.archive(from);
  EXPECT_EQ(again.text(), report.text());
}

TEST(HeldPressureReport, MeasuresATargetOfZeroByItsScale) {
  HeldPressureReport report("stress xx", "sigma_xx");
  for (const double stress : {0.002, -0.004}) {
    report.add(stress, 0.0, 0.1, 1.0);
  }
  EXPECT_FALSE(report.is_missed()); // -0.001 is 1 % of 0.1
  EXPECT_NE(report.text().find("stress xx held: sigma_xx -0.001 +- 0.003 k/d"), std::string::npos) << report.text();
  for (int k = 0; k < 4; ++k) {
    report.add(0.02, 0.0, 0.1, 1.0);
  }
  EXPECT_TRUE(report.is_missed());
}

TEST(HeldPressureReport, SaysNothingWithoutSteps) {
  EXPECT_EQ(HeldPressureReport().text(), "");
}

} // namespace
} // namespace boba
