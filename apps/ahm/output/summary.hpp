/// \file
/// The last step of every subcommand that maps: what it tells about a run, to people and to programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cli/journal.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// The head of a summary for programs: program, input, output (if there is one), backend.
nlohmann::ordered_json summary(const std::string& program, const std::string& path, const OutputOptions& output,
                               const Input& input);

/// Ends a summary with warnings, times and memory, and delivers it: JSON to --json, text to people, on standard error
/// where standard output is taken.
/// @param text     what people read before times and names of files
/// @param further  of the JSON, at its end
void deliver(nlohmann::ordered_json summary, const std::string& text, const OutputOptions& output, Journal& journal,
             const nlohmann::ordered_json& further);
void deliver(nlohmann::ordered_json summary, const std::string& text, const OutputOptions& output, Journal& journal);

/// Writes JSON to standard output ("-"), to a file, or not at all (""). Names that are not UTF-8 are made so.
/// @throws IoError, BrokenPipe
void write_json(const std::string& target, const nlohmann::ordered_json& json, bool in_one_line = false);

}  // namespace ahm::app
