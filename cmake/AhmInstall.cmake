# Installs the targets of every component, the package configuration and the Find modules it needs.
include(CMakePackageConfigHelpers)
set(AHM_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/ahm)

get_property(AHM_COMPONENTS GLOBAL PROPERTY AHM_COMPONENTS)
foreach(component IN LISTS AHM_COMPONENTS)
  install(EXPORT ahm-${component}-targets NAMESPACE ahm:: DESTINATION ${AHM_CMAKE_DIR})
endforeach()
configure_package_config_file(cmake/ahm-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/ahm-config.cmake
  INSTALL_DESTINATION ${AHM_CMAKE_DIR})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/ahm-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/ahm-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/ahm-config-version.cmake
  cmake/FindCHOLMOD.cmake cmake/FindFLANN.cmake cmake/FindMinizip.cmake cmake/FindPCLLibraries.cmake
  DESTINATION ${AHM_CMAKE_DIR})
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
