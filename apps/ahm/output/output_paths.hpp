/// \file
/// Names of output files: patterns for several maps, and checks before the work.
#pragma once

#include <string>
#include <vector>

namespace ahm::app {

/// The name of a file without folder and extensions: "scan" for "in/scan.ply.gz", "stdin" for "-".
std::string stem_of(const std::string& path);

/// Whether a name stands for one file per map: it contains {}, or is a folder.
bool is_pattern(const std::string& name);

/// The file name of one map.
/// @param name    pattern in which {} is replaced by the stem, or a folder for the file STEM_map + `ending`. A missing folder is created
///                if its parent exists
/// @param ending  ".csv"
/// @throws IoError (the folder cannot be created)
std::string output_name(const std::string& name, const std::string& stem, const std::string& ending);

/// An output file and its option.
struct OutputPath {
  std::string option;
  std::string path;  ///< empty or "-": no file
};

/// Checks that each file is in a writable directory, is not a directory or an input, and occurs once.
/// @param keep_existing  existing files are errors, too
/// @throws IoError, InvalidArgument
void check_outputs(const std::vector<std::string>& inputs, const std::vector<OutputPath>& outputs, bool keep_existing);

/// Checks the extension of an output file.
/// @param endings  allowed extensions, such as ".csv"
/// @param format   used instead of the extension of the name; empty: not set. A stream without either is .csv
/// @throws InvalidArgument (the extension is not allowed)
void check_ending(const OutputPath& output, const std::vector<std::string>& endings, const std::string& format = {});

}  // namespace ahm::app
