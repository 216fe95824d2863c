# Installs the targets of every component, the package configuration and the Find modules it needs.
include(CMakePackageConfigHelpers)
set(AHM_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/ahm)

# AHM_NEEDS: what each component stands on, as its target links it.
get_property(AHM_COMPONENTS GLOBAL PROPERTY AHM_COMPONENTS)
foreach(component IN LISTS AHM_COMPONENTS)
  install(EXPORT ahm-${component}-targets NAMESPACE ahm:: DESTINATION ${AHM_CMAKE_DIR})
  get_target_property(links ahm_${component} INTERFACE_LINK_LIBRARIES)
  string(REGEX MATCHALL "ahm::[a-z_]+" needs "${links}")
  string(REPLACE "ahm::" "" needs "${needs}")
  string(APPEND AHM_NEEDS "set(_ahm_needs_${component} ${needs})\n")
endforeach()
configure_package_config_file(cmake/ahm-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/ahm-config.cmake
  INSTALL_DESTINATION ${AHM_CMAKE_DIR})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/ahm-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/ahm-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/ahm-config-version.cmake
  cmake/FindCHOLMOD.cmake cmake/FindFLANN.cmake cmake/FindMinizip.cmake cmake/FindPCLLibraries.cmake
  DESTINATION ${AHM_CMAKE_DIR})
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
