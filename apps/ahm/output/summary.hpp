/// \file
/// The summary of a run, for users and for programs: the last step of every subcommand.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cli/journal.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// The head of a summary for programs: program, input, output and view (if set), backend.
nlohmann::ordered_json summary(const std::string& program, const std::string& path, const OutputOptions& output,
                               const Input& input);

/// Completes a summary with warnings, times and memory, and writes it: as JSON to --json, and as text to standard output, or to
/// standard error if standard output has other contents. `extra` has entries for the end of the JSON.
/// @param text  text for users, before times and names of files
void deliver(nlohmann::ordered_json summary, const std::string& text, const OutputOptions& output, Journal& journal,
             const nlohmann::ordered_json& extra);
void deliver(nlohmann::ordered_json summary, const std::string& text, const OutputOptions& output, Journal& journal);

/// Writes JSON to standard output ("-"), to a file, or not at all (""). Replaces bytes that are not UTF-8.
/// @throws IoError, BrokenPipe
void write_json(const std::string& target, const nlohmann::ordered_json& json, bool in_one_line = false);

}  // namespace ahm::app
