# Prints at configure time which BLAS is in use. The reference BLAS is several times slower than an optimized one.
if(NOT DEFINED AHM_BLAS_FOUND)
  try_run(AHM_BLAS_RUN AHM_BLAS_COMPILED "${CMAKE_BINARY_DIR}/blas_check" "${CMAKE_CURRENT_LIST_DIR}/blas_check.c"
    LINK_LIBRARIES ${LAPACKBLAS_LAPACK} ${LAPACKBLAS_BLAS} ${CMAKE_DL_LIBS}
    RUN_OUTPUT_VARIABLE AHM_BLAS_OUTPUT)
  string(STRIP "${AHM_BLAS_OUTPUT}" AHM_BLAS_OUTPUT)
  set(AHM_BLAS_FOUND "${AHM_BLAS_OUTPUT}" CACHE INTERNAL "BLAS in use")
endif()
if(AHM_BLAS_FOUND MATCHES "OpenBLAS|openblas|mkl|blis|atlas")
  message(STATUS "BLAS in use: ${AHM_BLAS_FOUND}")
else()
  message(WARNING "The BLAS is not optimized (${AHM_BLAS_FOUND}): factorizations of large surfaces will be several times slower. "
    "Install an optimized one (Debian: libopenblas0-pthread), or configure with -DAHM_WITH_BLAS=OFF.")
endif()
