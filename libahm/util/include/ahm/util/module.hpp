/// \file
/// Parts of libahm that are loaded when they are first needed, since what they stand on (PCL, and with it VTK) is large.
#pragma once

#include <dlfcn.h>
#include <unistd.h>

#include <string>

#include "ahm/error.hpp"

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
  // A program that was found through PATH goes by the word it was called with.
  if (folder.find('/') == std::string::npos) {
    char path[4096];
    const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
    folder.assign(path, length > 0 ? static_cast<std::size_t>(length) : 0);
  }
  folder.erase(folder.find_last_of('/') + 1);
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

/// The table of functions that the module `module` offers as `ahm_MODULE`.
/// @param wanted  begins the error's text: who needs it
/// @throws IoError where the module cannot be loaded, ResourceExhausted where it or what it stands on has no room in memory
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
