// SPDX-License-Identifier: GPL-3.0-or-later
// The long sweeps behind docs/stability.md. Usage: bench_stability SWEEP [--output FOLDER]; see bench/stability/run.
#include "bench/stability/cases.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <functional>

int main(int argc, char** argv) {
  CLI::App app("Stability sweeps: tables of docs/stability.md");
  app.require_subcommand(1);
  boba::bench::Folder folder = "out/stability";
  struct Sweep {
    const char* name;
    const char* what;
    void (*run)(const boba::bench::Folder&);
  };
  using namespace boba::bench;
  for (const Sweep& sweep :
       {Sweep{"time_step", "largest stable step: linearised operator and experiment", time_step},
        Sweep{"contacts", "the same for packings under pressure", contacts},
        Sweep{"spectrum", "growth of an undamped grain, from the spectrum", spectrum},
        Sweep{"energy", "energy ledgers of bulk over closed loops of strain; undamped grains left alone", energy},
        Sweep{"cycles", "the same ledger for sheared packings, and for larger and larger bulk", cycles},
        Sweep{"conservation", "momenta of a free grain over 1e6 steps", conservation},
        Sweep{"rounding", "error growth against a more precise twin", rounding},
        Sweep{"rest", "1e7 steps of a packing at rest", rest},
        Sweep{"rest_mixed", "the same in mixed precision", rest_mixed},
        Sweep{"long_shear", "1e6 steps of shear in double and mixed precision", long_shear},
        Sweep{"barostat", "gain scan, step response, deviation under shear", barostat}}) {
    CLI::App* command = app.add_subcommand(sweep.name, sweep.what);
    command->add_option("--output", folder, "folder for the tables")->capture_default_str();
    command->callback([&folder, run = sweep.run] { run(folder); });
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_stability: {}\n", error.what());
    return 1;
  }
  return 0;
}
