// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/command_line.h"

int main(int argc, char** argv) {
  return boba::run_command_line(argc, argv);
}
