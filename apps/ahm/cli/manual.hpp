/// \file
/// What manual pages and completions read of the option tables that --help prints.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ahm::app {

std::vector<CLI::App*> subcommands_of(CLI::App& program);

/// -s, --source: as they are written; none of a positional argument.
std::vector<std::string> names_of(const CLI::Option& option);

/// The first line of an option's or subcommand's description.
std::string first_line(const std::string& description);

/// Whether a value follows the option.
bool takes_value(const CLI::Option& option);

/// The words that an option takes; empty: any text. CLI11 has no place for them that --help does not print.
const std::vector<std::string>& choices_of(const CLI::Option& option);
void set_choices(const CLI::Option& option, const std::vector<std::string>& words);

/// @param shell  bash, zsh or fish; null for any other
std::optional<std::string> completion(CLI::App& program, std::string_view shell);

/// The page of a subcommand, in roff, or that of the program where `subcommand` is empty; null where there is none of this name.
std::optional<std::string> manual(CLI::App& program, std::string_view subcommand, const std::string& version);

}  // namespace ahm::app
