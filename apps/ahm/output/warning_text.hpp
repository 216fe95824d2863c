/// \file
/// The warnings of the libraries as sentences, for the programs and the Python package.
#pragma once

#include <string>

#include "ahm/report.hpp"

namespace ahm::app {

/// The text of a warning.
std::string worded(const Warning& warning);

}  // namespace ahm::app
