/// \file
/// The files of builds without the files of an operating system (AHM_WITH_FILES=OFF). Other builds do not define these functions.
///
/// \code
/// ahm::io::memory_files()["scan.ply"] = bytes;
/// ahm::io::Geometry scan = ahm::io::read("scan.ply");
/// \endcode
#pragma once

#include <map>
#include <string>

namespace ahm::io {

/// The bytes of each file, by its path. Not safe to change while another thread uses it.
std::map<std::string, std::string>& memory_files();

}  // namespace ahm::io
