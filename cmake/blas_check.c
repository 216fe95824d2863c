/* Prints the configuration of OpenBLAS, or the file that provides dgemm in this process. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

extern void dgemm_(void);

int main(void) {
  void (*volatile keep)(void) = dgemm_; /* keeps the linker from dropping the BLAS */
  (void)keep;
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
