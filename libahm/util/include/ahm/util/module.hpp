/// \file
/// Modules: parts of libahm that are loaded on first use, because they depend on large libraries (PCL, which loads VTK).
#pragma once

#include <dlfcn.h>
#include <errno.h>
#include <unistd.h>

#include <string>

#include "ahm/error.hpp"

namespace ahm {

/// Finds a symbol of a module. Searches the folder lib/ahm relative to this program or library (in the build tree and installed),
/// then the install folder `AHM_MODULE_DIR`, then the library path of the system. Modules are never unloaded.
/// @param error  out: why the symbol was not found
/// @return null if the symbol was not found
inline void* module_symbol(const std::string& module, const char* symbol, std::string& error) {
  static const char here = 0;
  Dl_info image{};
  std::string folder;
  if (dladdr(&here, &image) != 0 && image.dli_fname != nullptr) folder = image.dli_fname;
  // For a program dladdr returns its name on the command line: without a folder if the shell found it through PATH, and possibly
  // relative to an earlier working directory.
  if (folder.find('/') == std::string::npos || folder == program_invocation_name) {
    char path[4096];
    const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
    folder.assign(path, length > 0 ? static_cast<std::size_t>(length) : 0);
  }
  folder.erase(folder.find_last_of('/') + 1);
  const std::string file = "ahm_" + module + ".so";
  // The first three folders are relative to bin/ahm, lib/libahm_io.so and python/ahm/_core.so.
  for (const std::string& place :
       {folder + "../" AHM_MODULE_LIBDIR "/ahm/", folder + "ahm/", folder + "../../" AHM_MODULE_LIBDIR "/ahm/",
        std::string(AHM_MODULE_DIR "/"), std::string()}) {
    void* library = dlopen((place + file).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (void* found = library == nullptr ? nullptr : dlsym(library, symbol)) return found;
    const char* text = dlerror();
    if (text != nullptr &&
        (error.empty() || std::string(text).find("cannot open shared object file") == std::string::npos))
      error = text;
  }
  return nullptr;
}

/// The function table that the module exports as `ahm_MODULE`. Loads the module on the first call.
/// @param wanted  beginning of the error message: what needs the module
/// @throws IoError (the module cannot be loaded), ResourceExhausted (no memory for the module or its dependencies)
template <class Functions>
const Functions& module_functions(const std::string& module, const std::string& wanted) {
  static std::string error;
  static const auto* found = static_cast<const Functions*>(module_symbol(module, ("ahm_" + module).c_str(), error));
  for (const char* no_room : {"failed to map segment", "cannot allocate memory"})
    if (found == nullptr && error.find(no_room) != std::string::npos)
      throw ResourceExhausted("not enough memory to load the module for PCL: " + error);
  if (found == nullptr) throw IoError(wanted + " module for PCL, which cannot be loaded: " + error);
  return *found;
}

}  // namespace ahm
