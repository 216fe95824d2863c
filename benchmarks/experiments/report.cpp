#include "experiments/report.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "ahm/error.hpp"
#include "experiments/run_record.hpp"

namespace ahm::bench {
namespace {

constexpr std::size_t rows_shown = 12;
constexpr int no_matplotlib = 3;  // exit status of plots.py

constexpr const char* style = R"(
body { font: 16px/1.45 sans-serif; max-width: 60em; margin: 2em auto; padding: 0 1em; color: #222; }
h2 { margin: 2em 0 .3em; } figure { margin: .5em 0; } figure svg { max-width: 100%; height: auto; }
table { border-collapse: collapse; font-size: 13px; } td, th { padding: .1em .7em; text-align: right; border-bottom: 1px solid #ddd; }
td:first-child, th:first-child { text-align: left; } nav a { margin-right: .8em; } .small { color: #666; font-size: 13px; })";

std::string escaped(std::string_view text) {
  std::string result;
  for (char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else
      result += c;
  }
  return result;
}

std::string quoted_for_shell(const std::string& text) {
  std::string result = "'";
  for (char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

/// Runs plots.py. Returns an error message, empty if there was no error.
std::string draw(const std::filesystem::path& folder) {
  const std::string command = fmt::format("{} {} {}", quoted_for_shell(AHM_BENCH_PYTHON),
                                          quoted_for_shell(AHM_BENCH_PLOTS), quoted_for_shell(folder.string()));
  const int status = std::system(command.c_str());
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  if (WIFEXITED(status) && WEXITSTATUS(status) == no_matplotlib)
    return fmt::format(
        "no plots: {} has no matplotlib; install Debian's python3-matplotlib, or configure with "
        "-DAHM_BENCH_PYTHON=PATH",
        AHM_BENCH_PYTHON);
  return fmt::format("not all plots were drawn: {} failed", command);
}

std::string whole_file(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// The SVG element without its XML header, which is not allowed inside a page.
std::string inlined_svg(const std::filesystem::path& path) {
  const std::string text = whole_file(path);
  const std::size_t begin = text.find("<svg");
  return begin == std::string::npos ? "" : "<figure>" + text.substr(begin) + "</figure>\n";
}

std::string table_as_html(const Table& table, const std::string& file) {
  std::string html = fmt::format("<details><summary>{} rows (<a href=\"{}\">{}</a>)</summary><table><tr>",
                                 table.rows().size(), file, file);
  for (const std::string& name : table.columns()) html += "<th>" + escaped(name) + "</th>";
  html += "</tr>\n";
  for (std::size_t r = 0; r < std::min(rows_shown, table.rows().size()); ++r) {
    html += "<tr>";
    for (const Cell& cell : table.rows()[r]) html += "<td>" + escaped(cell.text()) + "</td>";
    html += "</tr>\n";
  }
  if (table.rows().size() > rows_shown) html += fmt::format("<tr><td>... the rest is in {}</td></tr>", file);
  return html + "</table></details>\n";
}

std::string section(const RunRecord& record, const Experiment& experiment, const nlohmann::ordered_json& entry) {
  const std::string name(experiment.name), file = name + ".csv";
  return fmt::format("<h2 id=\"{}\">{}: {}</h2>\n<p><b>The paper:</b> {}<br>\n<b>Seen:</b> {}</p>\n", name,
                     escaped(experiment.figure), escaped(experiment.title), escaped(experiment.paper),
                     escaped(entry.at("seen").get<std::string>())) +
         inlined_svg(record.folder() / (name + ".svg")) + table_as_html(Table::read(record.folder() / file), file) +
         fmt::format("<p class=\"small\">ahm-bench run {}{}: {:.1f} s, {:.0f} MB, {} UTC</p>\n", name,
                     entry.at("toy").get<bool>() ? " --toy" : "", entry.at("seconds").get<double>(),
                     entry.at("peak_megabytes").get<double>(), entry.at("finished").get<std::string>());
}

std::string machine_line(const nlohmann::ordered_json& machine) {
  std::string text;
  for (const auto& [key, value] : machine.items())
    append(text, key + " " + (value.is_string() ? value.get<std::string>() : value.dump()));
  return "<p class=\"small\">" + escaped(text) + "</p>\n";
}

}  // namespace

Report write_report(const std::filesystem::path& folder) {
  const RunRecord record(folder);
  if (std::ranges::none_of(experiments(), [&](const Experiment& e) { return record.find(e.name); }))
    throw IoError(folder.string() + ": contains no results; run `ahm-bench run all -o` it first");
  Report report{folder / "index.html", draw(folder)};
  std::string links, sections, machine;
  for (const Experiment& experiment : experiments()) {
    const auto* entry = record.find(experiment.name);
    if (!entry) continue;
    links += fmt::format("<a href=\"#{}\">{}</a>", experiment.name, escaped(experiment.title));
    sections += section(record, experiment, *entry);
    machine = machine_line(entry->at("machine"));
  }
  std::ofstream file(report.page);
  file << "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>The affine heat method, "
          "evaluated</title>"
       << "<style>" << style << "</style></head><body>\n<h1>The affine heat method, evaluated</h1>\n"
       << machine << "<nav>" << links << "</nav>\n"
       << (report.problem.empty() ? "" : "<p><b>" + escaped(report.problem) + "</b></p>\n") << sections
       << "</body></html>\n";
  if (!file.flush()) throw IoError(report.page.string() + ": cannot be written; check that the disk is not full");
  return report;
}

}  // namespace ahm::bench
