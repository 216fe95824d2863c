/// \file
/// Names of files that are written for each of several inputs.
#pragma once

#include <string>
#include <vector>

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

/// A file to be written, and the option that asked for it.
struct OutputPath {
  std::string option;
  std::string path;  ///< empty or "-": no file
};

/// Checks that each file lies in a writable directory, is no directory, is no input, and is named once.
/// @param keep_existing  nor is there yet
/// @throws IoError, InvalidArgument
void check_outputs(const std::vector<std::string>& inputs, const std::vector<OutputPath>& outputs, bool keep_existing);

/// @param format  in place of the ending of the name; empty: none. A stream without either is .csv
/// @throws InvalidArgument where it is none of these, such as ".csv"
void check_ending(const OutputPath& output, const std::vector<std::string>& endings, const std::string& format = {});

}  // namespace ahm::app
