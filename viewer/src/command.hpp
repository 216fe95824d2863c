// Requests as command lines that give the same.
#pragma once

#include <string>
#include <vector>

#include "ahm/viewer/session.hpp"

namespace ahm::viewer {

/// The shortest decimals that read back to the same number.
std::string number(double x);

/// ahm NAME INPUT ARGUMENTS SETTINGS INPUT-OPTIONS
std::string command(const SessionOptions& session, const std::string& name, const std::vector<std::string>& arguments,
                    const Settings& settings);

}  // namespace ahm::viewer
