# Installs the library so that find_package(libslam) gives libslam::libslam, and the shipped configurations.
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/libslam)

install(TARGETS libslam EXPORT libslam_targets COMPONENT development
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY libslam/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/libslam COMPONENT development
  FILES_MATCHING PATTERN "*.hpp")
install(EXPORT libslam_targets NAMESPACE libslam:: DESTINATION ${package_folder} COMPONENT development)

configure_package_config_file(cmake/libslam-config.cmake.in libslam-config.cmake
  INSTALL_DESTINATION ${package_folder}
  NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor release may change the interface.
write_basic_package_version_file(libslam-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/libslam-config.cmake
  ${PROJECT_BINARY_DIR}/libslam-config-version.cmake
  DESTINATION ${package_folder} COMPONENT development)

install(DIRECTORY config datasets DESTINATION ${CMAKE_INSTALL_DATADIR}/libslam)
install(FILES package.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/libslam)
