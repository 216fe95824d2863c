/// \file
/// The report of `ahm info`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "input/survey.hpp"

namespace ahm::app {

/// The suggested command line for this file; empty if no map can be made.
std::string suggestion(const Survey& survey, const std::string& path);

std::string as_text(const Survey& survey, const std::string& path);
nlohmann::ordered_json as_json(const Survey& survey, const std::string& path);

}  // namespace ahm::app
