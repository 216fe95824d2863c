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

/// Checks that each file lies in a writable directory, is no directory, is no input, and is named once.
/// @param keep_existing  nor is there yet
/// @throws IoError, InvalidArgument
void check_outputs(const std::vector<std::string>& inputs, const std::vector<OutputPath>& outputs, bool keep_existing);

/// @param format  in place of the ending of the name; empty: none. A stream without either is .csv
/// @throws InvalidArgument where it is none of these, such as ".csv"
void check_ending(const OutputPath& output, const std::vector<std::string>& endings, const std::string& format = {});

}  // namespace ahm::app
