// SPDX-License-Identifier: GPL-3.0-or-later
#include "oscillate.h"

#include <bpm/app/command_line.h>

int main(int argc, char** argv) {
  boba::register_stage<OscillateEntry>();
  return boba::run_command_line(argc, argv);
}
