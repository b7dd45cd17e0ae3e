// SPDX-License-Identifier: GPL-3.0-or-later
#include "nearest.h"
#include "oscillate.h"
#include "stiffening.h"

#include <bpm/app/command_line.h>
#include <bpm/forces/outside_contact_law.h>

int main(int argc, char** argv) {
  boba::register_stage<OscillateEntry>();
  boba::add_contact_law<StiffeningContact>(
      "stiffening", {{"stiffening", "k/d", 0.0, 100.0, false, 5.0, "second-order part of the contact repulsion"}},
      [](const boba::Material& m) {
        return StiffeningContact{m.k, m.contact_parameters[0], m.gamma, m.diameter};
      });
  boba::add_measure({"nearest", [] { return std::make_unique<const Nearest>(); }});
  return boba::run_command_line(argc, argv);
}
