/// \file
/// Writes coverage paths to files.
#pragma once

#include <string>

#include "ahm/applications/coverage.hpp"

namespace ahm::app {

/// Writes one row per point, and an edge between consecutive points of a piece. PLY files are text.
/// @param format  extension; empty: that of the file name. @throws IoError
void write_coverage(const std::string& file, const std::string& format, const CoveragePath& path);

}  // namespace ahm::app
