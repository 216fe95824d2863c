/// \file
/// What `ahm info` tells of a survey.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "input/survey.hpp"

namespace ahm::app {

/// The command line to run on this file, or empty when nothing can be run.
std::string suggestion(const Survey& survey, const std::string& path);

std::string as_text(const Survey& survey, const std::string& path);
nlohmann::ordered_json as_json(const Survey& survey, const std::string& path);

}  // namespace ahm::app
