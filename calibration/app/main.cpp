// SPDX-License-Identifier: GPL-3.0-or-later
// boba-calibrate: from the bonds (k, alpha) to the solid (E, nu) and back; particles against the continuum.
#include "calibration/app/commands.h"
#include "calibration/network/petsc_handle.h"

#include <cstdio>
#include <exception>
#include <fmt/format.h>
#include <stdexcept>

int main(int argc, char** argv) {
  using namespace boba::calibration;
  CLI::App app("From the bonds (k, alpha) to the elastic constants (E, nu) and back.", "boba-calibrate");
  app.set_version_flag("--version", "boba-calibrate " BOBA_VERSION);
  app.require_subcommand(1);
  const std::vector<Command> commands = {add_table(app),  add_make_table(app), add_find(app),   add_limit(app),
                                         add_strain(app), add_specimen(app),   add_compare(app)};
  try {
    app.parse(argc, argv);
    const PetscSession petsc;
    for (const Command& command : commands) {
      if (command.app->parsed()) {
        return command.run();
      }
    }
    return 2;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "boba-calibrate: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "boba-calibrate: {}\n", error.what());
    return 1;
  }
}
