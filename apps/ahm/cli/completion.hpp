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

/// The first line of an option's or subcommand's description.
std::string first_line(const std::string& description);

/// Whether a value follows the option.
bool takes_value(const CLI::Option& option);

}  // namespace ahm::app
