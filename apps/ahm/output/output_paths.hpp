/// \file
/// Whether the files a run is to write can be written, asked before the work starts.
#pragma once

#include <string>
#include <vector>

namespace ahm::app {

/// A file to be written, and the option that asked for it.
struct OutputPath {
  std::string option;
  std::string path;  ///< empty or "-": no file
};

/// Checks that each file lies in a writable directory, is no directory, is not the input, and is named once.
/// @throws IoError, InvalidArgument
void check_outputs(const std::string& input, const std::vector<OutputPath>& outputs);

/// @throws InvalidArgument where the name ends in none of these, such as ".csv"
void check_ending(const OutputPath& output, const std::vector<std::string>& endings);

/// True for a device or a pipe, such as /dev/stdout.
bool is_stream(const std::string& path);

/// Extension in lower case, with the dot.
std::string extension_of(const std::string& path);

}  // namespace ahm::app
