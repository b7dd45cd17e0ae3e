# SPDX-License-Identifier: GPL-3.0-or-later
# One way to declare a library, a program and a test, so that every folder's file is a list of sources.

add_library(boba_warnings INTERFACE)
target_compile_options(boba_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  -Wno-missing-field-initializers) # members left out of a designated initialiser have defaults

# Sources of a folder are compiled a few at a time as one: most of a file's time is Eigen's and the standard library's headers
# (docs/decisions/compile-time.md). Names in anonymous namespaces must therefore differ within a folder.
option(BOBA_UNITY_BUILD "Compile the sources of a library in groups" ON)
set(BOBA_UNITY_BATCH 8 CACHE STRING "Sources of such a group")

# boba_add_library(NAME [SOURCES ...] [LIBRARIES ...]): target boba_NAME with the alias boba::NAME.
# Without sources it is a header-only (interface) library. Where BOBA_EXPORT is set (bpm/CMakeLists.txt) the library is
# installed and find_package(boba) gives it under the same name.
function(boba_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  set(include_folders $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}> $<INSTALL_INTERFACE:${BOBA_INSTALL_INCLUDEDIR}>)
  if(ARG_SOURCES)
    add_library(boba_${name} STATIC ${ARG_SOURCES})
    target_include_directories(boba_${name} PUBLIC "${include_folders}")
    target_link_libraries(boba_${name} PUBLIC ${ARG_LIBRARIES} PRIVATE $<BUILD_INTERFACE:boba_warnings>)
    set_target_properties(boba_${name} PROPERTIES UNITY_BUILD ${BOBA_UNITY_BUILD}
      UNITY_BUILD_BATCH_SIZE ${BOBA_UNITY_BATCH})
  else()
    add_library(boba_${name} INTERFACE)
    target_include_directories(boba_${name} INTERFACE "${include_folders}")
    target_link_libraries(boba_${name} INTERFACE ${ARG_LIBRARIES})
  endif()
  add_library(boba::${name} ALIAS boba_${name})
  set_target_properties(boba_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(boba_${name} INTERFACE cxx_std_20)
  if(BOBA_EXPORT)
    install(TARGETS boba_${name} EXPORT boba_targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/boba)
  endif()
endfunction()

set(BOBA_TIMEOUT_FACTOR 1 CACHE STRING "what tests may take longer in this build: sanitizers slow them down")

# boba_add_test(NAME LABEL label SOURCES ... LIBRARIES ...): one GoogleTest program; each of its cases is a
# ctest of its own. ${CMAKE_SOURCE_DIR}/tests/data is reachable as BOBA_TEST_DATA.
function(boba_add_test name)
  cmake_parse_arguments(ARG "" "LABEL;TIMEOUT" "SOURCES;LIBRARIES" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  math(EXPR ARG_TIMEOUT "${ARG_TIMEOUT} * ${BOBA_TIMEOUT_FACTOR}")
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} GTest::gtest_main boba_warnings)
  target_compile_definitions(${name} PRIVATE BOBA_TEST_DATA="${CMAKE_SOURCE_DIR}/tests/data")
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST TEST_PREFIX "${name}."
    PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT ${ARG_TIMEOUT} ENVIRONMENT "OMP_WAIT_POLICY=passive")
endfunction()
