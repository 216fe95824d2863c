/// \file
/// What manual pages and completions read of the option tables that --help prints.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace ahm::app {

std::vector<CLI::App*> subcommands_of(CLI::App& program);

/// -s, --source: as they are written; none of a positional argument.
std::vector<std::string> names_of(const CLI::Option& option);

/// The first line of an option's or subcommand's description.
std::string first_line(const std::string& description);

/// Whether a value follows the option.
bool takes_value(const CLI::Option& option);

}  // namespace ahm::app
