# SPDX-License-Identifier: GPL-3.0-or-later
# Headers, libraries and the package file of find_package(boba).
include(CMakePackageConfigHelpers)

set(header_folders base bpm)
if(BOBA_BUILD_CONTINUUM OR BOBA_BUILD_CALIBRATION)
  list(APPEND header_folders continuum)
endif()
if(BOBA_BUILD_CALIBRATION)
  list(APPEND header_folders calibration)
endif()
foreach(folder ${header_folders})
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${folder} DESTINATION ${BOBA_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
endforeach()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/boba)
install(EXPORT boba_targets NAMESPACE boba:: DESTINATION ${package_folder})
configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/bobaConfig.cmake.in ${CMAKE_BINARY_DIR}/cmake/bobaConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/cmake/bobaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/cmake/bobaConfig.cmake ${CMAKE_BINARY_DIR}/cmake/bobaConfigVersion.cmake
  DESTINATION ${package_folder})
