# Finds SuiteSparse's CHOLMOD, which Debian ships without a CMake or pkg-config file, and its dependencies AMD,
# SuiteSparse_config, LAPACK and BLAS.
# Target: CHOLMOD::CHOLMOD.
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse)
find_library(CHOLMOD_LIBRARY cholmod)
find_library(CHOLMOD_AMD amd)
find_library(CHOLMOD_CONFIG suitesparseconfig)
find_library(CHOLMOD_LAPACK lapack)
find_library(CHOLMOD_BLAS blas)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(CHOLMOD REQUIRED_VARS CHOLMOD_LIBRARY CHOLMOD_AMD CHOLMOD_CONFIG CHOLMOD_LAPACK CHOLMOD_BLAS
  CHOLMOD_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "install SuiteSparse (Debian: libsuitesparse-dev), or configure with -DAHM_WITH_CHOLMOD=OFF -DAHM_BUILD_BENCHMARKS=OFF")
if(CHOLMOD_FOUND AND NOT TARGET CHOLMOD::CHOLMOD)
  add_library(CHOLMOD::CHOLMOD UNKNOWN IMPORTED)
  set_target_properties(CHOLMOD::CHOLMOD PROPERTIES
    IMPORTED_LOCATION "${CHOLMOD_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${CHOLMOD_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${CHOLMOD_AMD};${CHOLMOD_CONFIG};${CHOLMOD_LAPACK};${CHOLMOD_BLAS}")
endif()
mark_as_advanced(CHOLMOD_INCLUDE_DIR CHOLMOD_LIBRARY CHOLMOD_AMD CHOLMOD_CONFIG CHOLMOD_LAPACK CHOLMOD_BLAS)
