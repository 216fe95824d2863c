# Finds LAPACK and the BLAS by the names that the system's alternatives provide. Target: LapackBlas::LapackBlas.
find_library(LAPACKBLAS_LAPACK lapack)
find_library(LAPACKBLAS_BLAS blas)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LapackBlas REQUIRED_VARS LAPACKBLAS_LAPACK LAPACKBLAS_BLAS
  REASON_FAILURE_MESSAGE "install a BLAS (Debian: libopenblas0-pthread, libopenblas-pthread-dev), or configure with -DAHM_WITH_BLAS=OFF")
if(LapackBlas_FOUND AND NOT TARGET LapackBlas::LapackBlas)
  add_library(LapackBlas::LapackBlas UNKNOWN IMPORTED)
  set_target_properties(LapackBlas::LapackBlas PROPERTIES
    IMPORTED_LOCATION "${LAPACKBLAS_LAPACK}" INTERFACE_LINK_LIBRARIES "${LAPACKBLAS_BLAS}")
endif()
mark_as_advanced(LAPACKBLAS_LAPACK LAPACKBLAS_BLAS)
