# GCC 12 reports `"text" + std::to_string(n)` falsely as an overlapping or oversized copy; the -Wno options suppress this.
set(AHM_WARNINGS $<$<CXX_COMPILER_ID:GNU,Clang>:-Wall -Wextra -Wpedantic>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-stringop-overflow -Wno-array-bounds>)

# Precompiled headers. Sources must also compile without them (CMAKE_DISABLE_PRECOMPILE_HEADERS), so each includes what it uses.
set(AHM_STANDARD_HEADERS <algorithm> <array> <cmath> <functional> <limits> <memory> <mutex> <numeric> <optional> <span>
  <stop_token> <string> <thread> <utility> <variant> <vector>)

set(AHM_EXPORTED_SYMBOLS ${CMAKE_CURRENT_LIST_DIR}/exported_symbols.map)
if(BUILD_SHARED_LIBS)
  include(CheckLinkerFlag)
  check_linker_flag(CXX "LINKER:--version-script=${AHM_EXPORTED_SYMBOLS}" AHM_LINKER_KNOWS_VERSION_SCRIPTS)
endif()

# A distribution's PCL is compiled for the baseline processor. It cannot use memory that Eigen aligns for AVX. Sources that pass such
# memory to PCL are therefore compiled without AVX, even if the build uses -march=native.
set(AHM_PCL_ALIGNMENT "")
if(AHM_WITH_PCL AND CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|i[3-6]86)$")
  include(CheckCXXCompilerFlag)
  check_cxx_compiler_flag(-mno-avx AHM_COMPILER_HAS_MNO_AVX)
  if(AHM_COMPILER_HAS_MNO_AVX)
    set(AHM_PCL_ALIGNMENT -mno-avx)
  endif()
endif()

# Directories in which programs and libraries look for modules, for sources that include ahm/util/module.hpp.
file(RELATIVE_PATH AHM_LIBDIR_IN_PREFIX "${CMAKE_INSTALL_PREFIX}" "${CMAKE_INSTALL_FULL_LIBDIR}")
set(AHM_MODULE_DEFINITIONS AHM_MODULE_LIBDIR="${AHM_LIBDIR_IN_PREFIX}" AHM_MODULE_DIR="${CMAKE_INSTALL_FULL_LIBDIR}/ahm")

# ahm_module(<name> SOURCES <file...> LINK <target...>): adds the module ahm_<name>.so, which is loaded on first use
# (ahm/util/module.hpp).
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

# ahm_compile_together(<target> [ALONE <file...>]): with AHM_UNITY_BUILD, compiles six sources as one, which halves the processor
# time. ALONE: sources that are compiled separately: they define the same names in an unnamed namespace, or need other options.
function(ahm_compile_together target)
  cmake_parse_arguments(ARG "" "" "ALONE" ${ARGN})
  if(AHM_UNITY_BUILD)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)
    set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    # GCC treats an included source as a header, and warns about its unnamed namespaces.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# ahm_library(<component> SOURCES <file...> [ALONE <file...>]): adds the static or shared library ahm_<component>, with the alias
# ahm::<component>. Public headers are in include/, private headers in src/. ALONE: as in ahm_compile_together.
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
  # Until 1.0 the ABI may change with every minor version. DEFINE_SYMBOL "": static and shared builds compile sources equally.
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${component} POSITION_INDEPENDENT_CODE ON DEFINE_SYMBOL ""
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  if(BUILD_SHARED_LIBS AND AHM_LINKER_KNOWS_VERSION_SCRIPTS AND NOT component STREQUAL "conformance")  # it also exports symbols of GoogleTest
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

# ahm_install_headers(<component>): installs the interface library ahm_<component> as ahm::<component>, and its directory include/.
function(ahm_install_headers component)
  set_target_properties(ahm_${component} PROPERTIES EXPORT_NAME ${component})
  if(AHM_INSTALL)
    install(TARGETS ahm_${component} EXPORT ahm-${component}-targets)
    install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
    set_property(GLOBAL APPEND PROPERTY AHM_COMPONENTS ${component})
  endif()
endfunction()
