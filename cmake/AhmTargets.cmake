# GCC 12 takes `"text" + std::to_string(n)` for overlapping or endless copies, hence the last two.
set(AHM_WARNINGS $<$<CXX_COMPILER_ID:GNU,Clang>:-Wall -Wextra -Wpedantic>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-stringop-overflow -Wno-array-bounds>)

# For precompiled headers. Configured with CMAKE_DISABLE_PRECOMPILE_HEADERS, every source must include what it needs itself.
set(AHM_STANDARD_HEADERS <algorithm> <array> <cmath> <functional> <limits> <memory> <mutex> <numeric> <optional> <span>
  <stop_token> <string> <thread> <utility> <variant> <vector>)

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
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${component} POSITION_INDEPENDENT_CODE ON)
  if(AHM_INSTALL)
    install(TARGETS ${target} EXPORT ahm-${component}-targets
      ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
    set_property(GLOBAL APPEND PROPERTY AHM_COMPONENTS ${component})
  endif()
endfunction()
