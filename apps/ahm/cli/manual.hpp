/// \file
/// Manual pages, from the option tables that --help prints.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace ahm::app {

/// The page of a subcommand, in roff, or that of the program where `subcommand` is empty; null where there is none of this name.
std::optional<std::string> manual(CLI::App& program, std::string_view subcommand, const std::string& version);

}  // namespace ahm::app
