/// \file
/// The version of libahm, as macros and as a type. CMake reads it from this file.
#pragma once

#define AHM_VERSION_MAJOR 0
#define AHM_VERSION_MINOR 1
#define AHM_VERSION_PATCH 0

namespace ahm {

/// The version of the headers. Until 1.0 the interface may change with every minor version.
struct Version {
  int major = AHM_VERSION_MAJOR, minor = AHM_VERSION_MINOR, patch = AHM_VERSION_PATCH;
};

}  // namespace ahm
