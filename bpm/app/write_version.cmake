# SPDX-License-Identifier: GPL-3.0-or-later
# Writes version.cpp with the hash of the checked-out sources; runs at every build, rewrites the file only on a change.
execute_process(COMMAND git describe --always --dirty --abbrev=12 --exclude=*
  WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE BOBA_GIT_HASH OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT BOBA_GIT_HASH)
  set(BOBA_GIT_HASH unknown)
endif()
configure_file(${SOURCE_DIR}/bpm/app/version.cpp.in ${OUTPUT} @ONLY)
