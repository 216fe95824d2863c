/// \file
/// Coverage paths as files.
#pragma once

#include <string>

#include "ahm/applications/coverage.hpp"

namespace ahm::app {

/// A row per point, with an edge between consecutive points of a piece, as text.
/// @param format  extension; empty: as the name says. @throws IoError
void write_coverage(const std::string& file, const std::string& format, const CoveragePath& path);

}  // namespace ahm::app
