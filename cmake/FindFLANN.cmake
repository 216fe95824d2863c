# Finds FLANN by header and library. Its .pc file would add HDF5 and MPI, which the neighbor search does not use.
# Target: FLANN::FLANN.
find_path(FLANN_INCLUDE_DIR flann/flann.hpp)
find_library(FLANN_LIBRARY flann_cpp)
find_library(FLANN_LZ4_LIBRARY lz4)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(FLANN REQUIRED_VARS FLANN_LIBRARY FLANN_INCLUDE_DIR FLANN_LZ4_LIBRARY
  REASON_FAILURE_MESSAGE "install FLANN and lz4 (Debian: libflann-dev liblz4-dev), or configure with -DAHM_WITH_FLANN=OFF")
if(FLANN_FOUND AND NOT TARGET FLANN::FLANN)
  add_library(FLANN::FLANN UNKNOWN IMPORTED)
  set_target_properties(FLANN::FLANN PROPERTIES IMPORTED_LOCATION "${FLANN_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${FLANN_INCLUDE_DIR}" INTERFACE_LINK_LIBRARIES "${FLANN_LZ4_LIBRARY}")
endif()
mark_as_advanced(FLANN_INCLUDE_DIR FLANN_LIBRARY FLANN_LZ4_LIBRARY)
