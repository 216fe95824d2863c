# Finds PCL's libraries by name. It avoids PCL's own package file, which on Debian takes seconds, requires the C language, and adds
# VTK, Qt and MPI to every link.
#
#   find_package(PCLLibraries REQUIRED COMPONENTS common kdtree filters)
#
# Each component becomes the target PCLLibraries::<component>; PCLLibraries_VERSION is read from pcl/pcl_config.h.
# Without COMPONENTS: all components that libahm uses.
if(NOT PCLLibraries_FIND_COMPONENTS)
  set(PCLLibraries_FIND_COMPONENTS common kdtree search octree filters features io)
endif()
set(_pcl_versions 1.15 1.14 1.13 1.12 1.11 1.10)
list(TRANSFORM _pcl_versions PREPEND pcl- OUTPUT_VARIABLE _pcl_suffixes)
find_path(PCL_INCLUDE_DIR pcl/pcl_config.h PATH_SUFFIXES ${_pcl_suffixes})
find_path(PCL_EIGEN_INCLUDE_DIR Eigen/Core PATH_SUFFIXES eigen3)
find_path(PCL_BOOST_INCLUDE_DIR boost/version.hpp)
find_path(PCL_FLANN_INCLUDE_DIR flann/flann.hpp)
find_library(PCL_LZ4_LIBRARY lz4)
mark_as_advanced(PCL_INCLUDE_DIR PCL_EIGEN_INCLUDE_DIR PCL_BOOST_INCLUDE_DIR PCL_FLANN_INCLUDE_DIR PCL_LZ4_LIBRARY)

if(PCL_INCLUDE_DIR)
  file(STRINGS "${PCL_INCLUDE_DIR}/pcl/pcl_config.h" _pcl_line REGEX "#define PCL_VERSION_PRETTY")
  string(REGEX MATCH "[0-9]+\\.[0-9]+\\.[0-9]+" PCLLibraries_VERSION "${_pcl_line}")
endif()

foreach(_component IN LISTS PCLLibraries_FIND_COMPONENTS)
  find_library(PCL_${_component}_LIBRARY pcl_${_component})
  mark_as_advanced(PCL_${_component}_LIBRARY)
  if(PCL_${_component}_LIBRARY)
    set(PCLLibraries_${_component}_FOUND TRUE)
  endif()
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(PCLLibraries
  REQUIRED_VARS PCL_INCLUDE_DIR PCL_EIGEN_INCLUDE_DIR PCL_BOOST_INCLUDE_DIR PCL_FLANN_INCLUDE_DIR PCL_LZ4_LIBRARY
  VERSION_VAR PCLLibraries_VERSION HANDLE_COMPONENTS
  REASON_FAILURE_MESSAGE "install PCL (Debian: libpcl-dev) or configure with -DAHM_WITH_PCL=OFF")

# Under the address sanitizer, Eigen aligns memory itself; PCL, compiled without the sanitizer, does not. Each must be able to free
# memory of the other. The sanitizer's malloc is aligned sufficiently for both.
set(_pcl_definitions "")
if("${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${CMAKE_BUILD_TYPE}}" MATCHES "-fsanitize=[^ ]*address")
  set(_pcl_definitions EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()

if(PCLLibraries_FOUND)
  foreach(_component IN LISTS PCLLibraries_FIND_COMPONENTS)
    if(NOT TARGET PCLLibraries::${_component})
      add_library(PCLLibraries::${_component} UNKNOWN IMPORTED)
      set_target_properties(PCLLibraries::${_component} PROPERTIES
        IMPORTED_LOCATION "${PCL_${_component}_LIBRARY}"
        INTERFACE_INCLUDE_DIRECTORIES
          "${PCL_INCLUDE_DIR};${PCL_EIGEN_INCLUDE_DIR};${PCL_BOOST_INCLUDE_DIR};${PCL_FLANN_INCLUDE_DIR}"
        # PCL's search includes FLANN's headers, whose inline functions use lz4.
        INTERFACE_LINK_LIBRARIES "${PCL_LZ4_LIBRARY}"
        INTERFACE_COMPILE_DEFINITIONS "${_pcl_definitions}")
    endif()
  endforeach()
endif()
unset(_pcl_versions)
unset(_pcl_suffixes)
unset(_pcl_line)
unset(_pcl_definitions)
