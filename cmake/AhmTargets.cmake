# GCC 12 takes `"text" + std::to_string(n)` for overlapping or endless copies, hence the last two.
set(AHM_WARNINGS $<$<CXX_COMPILER_ID:GNU,Clang>:-Wall -Wextra -Wpedantic>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-stringop-overflow -Wno-array-bounds>)

# For precompiled headers. Configured with CMAKE_DISABLE_PRECOMPILE_HEADERS, every source must include what it needs itself.
set(AHM_STANDARD_HEADERS <algorithm> <array> <cmath> <functional> <limits> <memory> <mutex> <numeric> <optional> <span>
  <stop_token> <string> <thread> <utility> <variant> <vector>)

set(AHM_EXPORTED_SYMBOLS ${CMAKE_CURRENT_LIST_DIR}/exported_symbols.map)
if(BUILD_SHARED_LIBS)
  include(CheckLinkerFlag)
  check_linker_flag(CXX "LINKER:--version-script=${AHM_EXPORTED_SYMBOLS}" AHM_LINKER_KNOWS_VERSION_SCRIPTS)
endif()

# A distribution's PCL is built for the baseline processor. Memory that Eigen aligns for AVX cannot be handed to it, so sources that
# do stay at the baseline even when the rest of the build is tuned (-march=native).
set(AHM_PCL_ALIGNMENT "")
if(AHM_WITH_PCL AND CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|i[3-6]86)$")
  include(CheckCXXCompilerFlag)
  check_cxx_compiler_flag(-mno-avx AHM_COMPILER_HAS_MNO_AVX)
  if(AHM_COMPILER_HAS_MNO_AVX)
    set(AHM_PCL_ALIGNMENT -mno-avx)
  endif()
endif()

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

# ahm_compile_together(<target> [ALONE <file...>]): with AHM_UNITY_BUILD, compiles six sources at a time, in half of the processor time.
# ALONE: sources that define the same names as others in an unnamed namespace, or need options of their own.
function(ahm_compile_together target)
  cmake_parse_arguments(ARG "" "" "ALONE" ${ARGN})
  if(AHM_UNITY_BUILD)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)
    set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    # GCC takes a source that is included for a header, and warns of its unnamed namespaces.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# ahm_library(<component> SOURCES <file...> [ALONE <file...>]): the static or shared library ahm_<component>, alias
# ahm::<component>, with its public headers in include/ and private ones beside its sources in src/; ALONE as above.
function(ahm_library component)
  cmake_parse_arguments(ARG "" "" "SOURCES;ALONE" ${ARGN})
  set(target ahm_${component})
  add_library(${target} ${ARG_SOURCES})
  add_library(ahm::${component} ALIAS ${target})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE ${AHM_WARNINGS})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:ahm_util>)
  target_precompile_headers(${target} REUSE_FROM ahm_precompiled)
  ahm_compile_together(${target} ALONE ${ARG_ALONE})
  # Until 1.0 the interface may change with every minor version. DEFINE_SYMBOL: compiled alike, static or shared.
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${component} POSITION_INDEPENDENT_CODE ON DEFINE_SYMBOL ""
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  if(BUILD_SHARED_LIBS AND AHM_LINKER_KNOWS_VERSION_SCRIPTS AND NOT component STREQUAL "conformance")  # that is GoogleTest's, too
    target_link_options(${target} PRIVATE "LINKER:--version-script=${AHM_EXPORTED_SYMBOLS}")
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${AHM_EXPORTED_SYMBOLS})
  endif()
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

# ahm_install_headers(<component>): installs the interface library ahm_<component> and its include/ as ahm::<component>.
function(ahm_install_headers component)
  set_target_properties(ahm_${component} PROPERTIES EXPORT_NAME ${component})
  if(AHM_INSTALL)
    install(TARGETS ahm_${component} EXPORT ahm-${component}-targets)
    install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
    set_property(GLOBAL APPEND PROPERTY AHM_COMPONENTS ${component})
  endif()
endfunction()
