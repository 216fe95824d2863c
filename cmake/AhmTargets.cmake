# GCC 12 takes `"text" + std::to_string(n)` for overlapping or endless copies, hence the last two.
set(AHM_WARNINGS $<$<CXX_COMPILER_ID:GNU,Clang>:-Wall -Wextra -Wpedantic>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-stringop-overflow -Wno-array-bounds>)

# For precompiled headers. Configured with CMAKE_DISABLE_PRECOMPILE_HEADERS, every source must include what it needs itself.
set(AHM_STANDARD_HEADERS <algorithm> <array> <cmath> <functional> <limits> <memory> <mutex> <numeric> <optional> <span>
  <stop_token> <string> <thread> <utility> <variant> <vector>)

# Where programs and libraries find their modules, for the sources that include ahm/util/module.hpp.
file(RELATIVE_PATH AHM_LIBDIR_IN_PREFIX "${CMAKE_INSTALL_PREFIX}" "${CMAKE_INSTALL_FULL_LIBDIR}")
set(AHM_MODULE_DEFINITIONS AHM_MODULE_LIBDIR="${AHM_LIBDIR_IN_PREFIX}" AHM_MODULE_DIR="${CMAKE_INSTALL_FULL_LIBDIR}/ahm")

# ahm_module(<name> SOURCES <file...> LINK <target...>): ahm_<name>.so, which is loaded when it is first needed (ahm/util/module.hpp).
function(ahm_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  set(target ahm_module_${name})
  add_library(${target} MODULE ${ARG_SOURCES})
  target_compile_features(${target} PRIVATE cxx_std_20)
  target_compile_options(${target} PRIVATE ${AHM_WARNINGS})
  target_link_libraries(${target} PRIVATE ahm_util ${ARG_LINK})
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME ahm_${name} INSTALL_RPATH "$ORIGIN/.."
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/${AHM_LIBDIR_IN_PREFIX}/ahm)
  if(AHM_INSTALL)
    install(TARGETS ${target} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/ahm COMPONENT pcl)
  endif()
endfunction()

# ahm_library(<component> SOURCES <file...>): the static or shared library ahm_<component>, alias ahm::<component>, with
# its public headers in include/ and private ones beside its sources in src/.
function(ahm_library component)
  cmake_parse_arguments(ARG "" "" "SOURCES" ${ARGN})
  set(target ahm_${component})
  add_library(${target} ${ARG_SOURCES})
  add_library(ahm::${component} ALIAS ${target})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE ${AHM_WARNINGS})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:ahm_util>)
  target_precompile_headers(${target} REUSE_FROM ahm_base)
  # Until 1.0 the interface may change with every minor version. DEFINE_SYMBOL: compiled alike, static or shared.
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${component} POSITION_INDEPENDENT_CODE ON DEFINE_SYMBOL ""
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  if(AHM_INSTALL)
    set(package library)
    if(component STREQUAL "pcl")
      set(package pcl)
    endif()
    install(TARGETS ${target} EXPORT ahm-${component}-targets
      ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
      LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${package} NAMELINK_COMPONENT dev)
    install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
    set_property(GLOBAL APPEND PROPERTY AHM_COMPONENTS ${component})
  endif()
endfunction()
