/// \file
/// Parts of libahm that are loaded when they are first needed, since what they stand on (PCL, and with it VTK) is large.
#pragma once

#include <dlfcn.h>

#include <string>

namespace ahm {

/// What a module offers under a name, which is looked for beside the program or library that has this code (lib/ahm, as built and as
/// installed), where it was to be installed (`AHM_MODULE_DIR`), and where the system looks for libraries. Loaded once, never
/// unloaded.
/// @param error  why it was not found
/// @return null where it was not found
inline void* module_symbol(const std::string& module, const char* symbol, std::string& error) {
  static const char here = 0;
  Dl_info image{};
  std::string folder;
  if (dladdr(&here, &image) != 0 && image.dli_fname != nullptr) folder = image.dli_fname;
  folder.erase(folder.find_last_of('/') == std::string::npos ? 0 : folder.find_last_of('/') + 1);
  if (folder.empty()) folder = "./";
  const std::string file = "ahm_" + module + ".so";
  // From bin/ahm, lib/libahm_io.so and python/ahm/_core.so.
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

}  // namespace ahm
