// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/table.h"
#include "tests/support/temporary_folder.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace boba {
namespace {

using test::content_of;
using test::TemporaryFolder;

const std::vector<std::string> columns = {"step", "time_tau", "P_k_per_d"};

TEST(Table, WritesNumbersThatReadBackExactly) {
  const TemporaryFolder folder;
  const auto path = folder / "table.csv";
  TableWriter table(path, columns);
  const std::vector<double> values = {0.1 + 0.2, 1e-300 / 3.0};
  table.write(7, values);
  const std::vector<std::optional<double>> partly = {2.0, std::nullopt};
  table.write(8, partly);
  // Rows are there before the table is closed.
  const std::string text = content_of(path);
  EXPECT_EQ(text.substr(0, text.find('\n')), "step,time_tau,P_k_per_d");
  double first = 0.0, second = 0.0;
  long long step = 0;
  ASSERT_EQ(std::sscanf(text.c_str() + text.find('\n') + 1, "%lld,%lf,%lf", &step, &first, &second), 3);
  EXPECT_EQ(step, 7);
  EXPECT_EQ(first, values[0]);
  EXPECT_EQ(second, values[1]);
  EXPECT_EQ(text.substr(text.find("\n8,") + 1), "8,2,\n");
}

TEST(Table, GoesOnAfterACheckpoint) {
  const TemporaryFolder folder;
  const auto path = folder / "table.csv";
  const auto row = [](std::int64_t step) { return std::vector<double>{0.1 * static_cast<double>(step), 0.5}; };
  {
    TableWriter table(path, columns);
    for (const int step : {0, 10, 20, 30}) {
      table.write(step, row(step));
    }
  }
  const std::string whole = content_of(path);
  for (const int checkpoint : {20, 25, 0, -1, 30}) {
    TableWriter table = TableWriter::go_on(path, columns, checkpoint);
    for (const int step : {0, 10, 20, 30}) {
      if (step > checkpoint) {
        table.write(step, row(step));
      }
    }
    table.close();
    EXPECT_EQ(content_of(path), whole) << checkpoint;
  }
}

TEST(Table, DropsATornRow) {
  const TemporaryFolder folder;
  const auto path = folder / "table.csv";
  {
    TableWriter table(path, columns);
    table.write(10, std::vector<double>{1.0, 2.0});
  }
  const std::string one = content_of(path);
  const std::string header = one.substr(0, one.find('\n') + 1);
  const std::string two = one + "20,2.25,3.5\n";
  for (std::size_t length = 0; length < two.size(); ++length) {
    folder.file("table.csv", two.substr(0, length));
    TableWriter::go_on(path, columns, 100).close();
    EXPECT_EQ(content_of(path), length < one.size() ? header : one) << length;
  }
}

TEST(Table, RefusesWrongUse) {
  const TemporaryFolder folder;
  const auto path = folder / "table.csv";
  TableWriter table(path, columns);
  EXPECT_THROW(table.write(1, std::vector<double>{1.0}), std::invalid_argument);
  EXPECT_THROW(TableWriter(path, columns), std::runtime_error);
  EXPECT_THROW(TableWriter(folder / "b.csv", {"a,b"}), std::invalid_argument);
  EXPECT_THROW(TableWriter(folder / "b.csv", {}), std::invalid_argument);
  EXPECT_THROW(TableWriter::go_on(path, {"step", "other"}, 3), std::runtime_error);
  EXPECT_THROW(TableWriter("/dev/full", columns, FileMode::overwrite), std::runtime_error);
}

} // namespace
} // namespace boba
