/* Prints the file that provides dgemm to CHOLMOD in this process. */
#define _GNU_SOURCE
#include <cholmod.h>
#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

int main(void) {
  cholmod_common common;
  cholmod_l_start(&common); /* keeps the linker from dropping CHOLMOD and the BLAS */
  cholmod_l_finish(&common);
  char* (*config)(void) = (char* (*)(void))dlsym(RTLD_DEFAULT, "openblas_get_config");
  Dl_info info;
  void* dgemm = dlsym(RTLD_DEFAULT, "dgemm_");
  char path[PATH_MAX];
  if (config)
    printf("%s\n", config());
  else if (dgemm && dladdr(dgemm, &info) && realpath(info.dli_fname, path))
    printf("%s\n", path);
  else
    printf("unknown\n");
  return 0;
}
