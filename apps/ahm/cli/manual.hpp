/// \file
/// Manual pages and shell completions, generated from the option tables that --help prints.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ahm::app {

std::vector<CLI::App*> subcommands_of(CLI::App& program);

/// The names of an option with their hyphens, such as -s, --source; empty for a positional argument.
std::vector<std::string> names_of(const CLI::Option& option);

/// The first line of an option's or subcommand's description.
std::string first_line(const std::string& description);

/// Whether a value follows the option.
bool takes_value(const CLI::Option& option);

/// The words that an option accepts; empty: any text. They are stored here because CLI11 would print them in --help.
const std::vector<std::string>& choices_of(const CLI::Option& option);
void set_choices(const CLI::Option& option, const std::vector<std::string>& words);

/// The completion script for a shell.
/// @param shell  bash, zsh or fish; null for any other
std::optional<std::string> completion(CLI::App& program, std::string_view shell);

/// The manual page of a subcommand in roff, or of the program if `subcommand` is empty; null for an unknown subcommand.
std::optional<std::string> manual(CLI::App& program, std::string_view subcommand, const std::string& version);

}  // namespace ahm::app
