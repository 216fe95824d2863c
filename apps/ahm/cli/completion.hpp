/// \file
/// Completion scripts for shells, from the option tables that --help prints.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace ahm::app {

/// @param shell  bash, zsh or fish; null for any other
std::optional<std::string> completion(CLI::App& program, std::string_view shell);

}  // namespace ahm::app
