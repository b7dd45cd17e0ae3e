// SPDX-License-Identifier: GPL-3.0-or-later
// boba-continuum cylinder | sphere: one compressed body by finite elements.
#include "continuum/app/commands.h"
#include "continuum/contact/condensed_contact.h"

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <stdexcept>

int main(int argc, char** argv) {
  using namespace boba::continuum;
  CLI::App app("Linear elastic reference: one compressed cylinder, or one sphere between plates.", "boba-continuum");
  app.set_version_flag("--version", "boba-continuum " BOBA_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  const auto commands = add_commands(app);
  try {
    app.parse(argc, argv);
    return commands->run(std::cerr);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::invalid_argument& error) {
    std::cerr << "boba-continuum: " << error.what() << "\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "boba-continuum: " << error.what() << "\n";
    return 1;
  }
}
