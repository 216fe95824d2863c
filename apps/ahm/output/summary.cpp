#include "output/summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"
#include "cli/console.hpp"
#include "cli/system_info.hpp"

namespace ahm::app {

nlohmann::ordered_json summary(const std::string& program, const std::string& path, const OutputOptions& output,
                               const Input& input) {
  nlohmann::ordered_json j = {{"program", program},
                              {"input",
                               {{"path", path},
                                {"format", input.geometry.format},
                                {"points", input.geometry.points.size()},
                                {"faces", input.given_faces}}}};
  if (!output.output.empty()) j["output"] = output.output == standard_output ? "-" : output.output;
  if (!output.view.empty()) j["view"] = output.view;
  j["backend"] = input.backend->name;
  return j;
}

namespace {

/// @param text  text for users, before times and names of files
void print_summary(const std::string& text, const OutputOptions& output, const Journal& journal) {
  std::vector<std::string> wrote;
  if (!output.output.empty() && !io::is_stream(output.output)) wrote.push_back(output.output);
  if (!output.view.empty() && !journal.view_failure()) wrote.push_back(output.view);
  const std::string all =
      fmt::format("{}{:.2f} s, peak memory {}\n{}", text, journal.times().total(), bytes_as_text(peak_rss_bytes()),
                  wrote.empty() ? "" : fmt::format("wrote {}\n", fmt::join(wrote, " and ")));
  output.json == "-" || io::is_stream(output.output) ? print_to_stderr(all) : print(all);
}

}  // namespace

void deliver(nlohmann::ordered_json summary, const std::string& text, const OutputOptions& output, Journal& journal,
             const nlohmann::ordered_json& extra) {
  journal.finish();
  journal.clear_display();
  summary["warnings"] = journal.warnings();
  for (const auto& [stage, seconds] : journal.times().seconds()) summary["seconds"][stage] = seconds;
  summary["seconds_total"] = journal.times().total();
  summary["peak_rss_bytes"] = peak_rss_bytes();
  summary.update(extra);
  const std::optional<std::string>& failure = journal.view_failure();
  if (failure) {
    summary.erase("view");
    summary["failed"]["view"] = *failure;
  }
  const auto write_summary = [&] { write_json(output.json, summary, output.json_lines); };
  const bool is_json_on_stdout = output.json == "-";
  if (!is_json_on_stdout) write_summary();
  io::FileSet::commit();  // the files exist before their names are printed, even if printing fails
  if (is_json_on_stdout) write_summary();
  if (output.verbosity != Verbosity::quiet) print_summary(text, output, journal);
  if (failure) throw IoError(*failure);
}

void deliver(nlohmann::ordered_json summary, const std::string& text, const OutputOptions& output, Journal& journal) {
  deliver(std::move(summary), text, output, journal, nlohmann::ordered_json::object());
}

void write_json(const std::string& target, const nlohmann::ordered_json& json, bool in_one_line) {
  if (target.empty()) return;
  const std::string text =
      json.dump(in_one_line ? -1 : 2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  if (target == "-") return print(text);
  io::AtomicFile file(target);
  file.write(text);
  file.commit();
}

}  // namespace ahm::app
