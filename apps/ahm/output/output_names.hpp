/// \file
/// Names of files that are written for each of several inputs.
#pragma once

#include <string>

namespace ahm::app {

/// The name of a file without folder and endings: "scan" of "in/scan.ply.gz", "stdin" of "-".
std::string stem_of(const std::string& path);

/// Whether a name stands for one file per map: it holds {}, or names a folder.
bool is_pattern(const std::string& name);

/// The file of one map.
/// @param name    {} in it becomes the stem; a folder, which is made where its parent is there, holds STEM_map and `ending`
/// @param ending  ".csv"
/// @throws IoError where the folder cannot be made
std::string filled(const std::string& name, const std::string& stem, const std::string& ending);

}  // namespace ahm::app
