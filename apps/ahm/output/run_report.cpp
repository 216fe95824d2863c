#include "output/run_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ahm/io/atomic_file.hpp"
#include "ahm/maps/quality.hpp"
#include "cli/console.hpp"
#include "cli/system_info.hpp"

namespace ahm::app {
namespace {

constexpr std::array all_statuses = {Status::ok, Status::disconnected, Status::beyond_radius, Status::unreached,
                                     Status::removed};

std::size_t count(const MapRows& rows, Status status) {
  return static_cast<std::size_t>(std::count(rows.status.begin(), rows.status.end(), status));
}

double largest_distance(const MapRows& rows) {
  double largest = 0;
  for (double d : rows.distance)
    if (d > largest) largest = d;  // false for NaN
  return largest;
}

/// Mapped rows at a cut locus or in a fold.
std::ptrdiff_t untrusted(const MapRows& rows) {
  return std::count_if(rows.quality.begin(), rows.quality.end(), [](double q) { return q < trusted_quality; });
}

/// Of the numbers that are not NaN.
double median(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  if (values.empty()) return NAN;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double mean_edge_length(const TangentGraph& graph) { return graph.mean_edge_length() * graph.length_unit(); }

nlohmann::ordered_json source_as_json(const Run& run) {
  nlohmann::ordered_json j;
  j["spec"] = to_string(run.options.source);
  j["index"] = run.source.row ? nlohmann::ordered_json(*run.source.row) : nlohmann::ordered_json(nullptr);
  j["position"] = run.source.position;
  if (run.source.frame)
    j["frame"] = {{"u", run.source.frame->x}, {"v", run.source.frame->y}, {"normal", run.source.frame->normal}};
  return j;
}

nlohmann::ordered_json factor_as_json(const FactorStatistics& s) {
  return {{"assemble_seconds", s.assemble_seconds},
          {"analyze_seconds", s.analyze_seconds},
          {"factor_seconds", s.factor_seconds},
          {"nonzeros_A", s.nonzeros_A},
          {"nonzeros_B", s.nonzeros_B},
          {"bytes", s.bytes}};
}

}  // namespace

nlohmann::ordered_json run_as_json(const Run& run) {
  nlohmann::ordered_json j;
  j["program"] = "ahm logmap";
  j["input"] = {{"path", run.options.input},
                {"format", run.input.format},
                {"points", run.input.points.size()},
                {"faces", run.input.face_count()},
                {"normals", !run.input.normals.empty()}};
  j["output"] = run.options.output;
  if (!run.options.view.empty()) j["view"] = run.options.view;
  j["n"] = run.rows.status.size();
  j["backend"] = run.backend;
  j["variant"] = to_string(run.map.variant());
  j["strategy"] = to_string(run.map.strategy());
  j["order"] = run.options.order;
  j["t_coef"] = run.options.t_coef;
  j["mean_edge_length"] = mean_edge_length(run.solver.graph());
  j["largest_distance"] = largest_distance(run.rows);
  for (Status s : all_statuses) j["status"][std::string(to_string(s))] = count(run.rows, s);
  j["untrusted"] = untrusted(run.rows);
  if (!run.rows.error_estimate.empty()) j["median_error_estimate"] = median(run.rows.error_estimate);
  j["source"] = source_as_json(run);
  j[run.backend] = run.model.report();
  if (run.solver.strategy() == Strategy::global) j["factor"] = factor_as_json(run.solver.operators().statistics());
  if (const MarchStatistics& m = run.map.march(); m.bands > 0)
    j["march"] = {{"bands", m.bands}, {"largest_band", m.largest_band}, {"solved_vertices", m.solved}};
  j["warnings"] = run.warnings;
  for (const auto& [stage, seconds] : run.times.seconds()) j["seconds"][stage] = seconds;
  j["seconds_total"] = run.times.total();
  j["peak_rss_bytes"] = peak_rss_bytes();
  j["versions"] = versions();
  return j;
}

std::string run_as_text(const Run& run) {
  std::string counts;
  for (Status s : all_statuses)
    if (const std::size_t c = count(run.rows, s); c > 0 || s == Status::ok)
      counts += fmt::format(", {} {}", c, to_string(s));
  const Vec3& p = run.source.position;
  std::string text = fmt::format("{} vertices{}\n", run.rows.status.size(), counts);
  text += fmt::format("source {} at {:.6g} {:.6g} {:.6g}, largest distance {:.6g}, mean edge length {:.4g}\n",
                      run.source.row ? fmt::format("{}", *run.source.row) : to_string(run.options.source), p[0], p[1],
                      p[2], largest_distance(run.rows), mean_edge_length(run.solver.graph()));
  const auto ok = static_cast<double>(count(run.rows, Status::ok));
  text += fmt::format("quality above {} at {:.2f} % of the mapped vertices", trusted_quality,
                      ok > 0 ? 100 - 100 * static_cast<double>(untrusted(run.rows)) / ok : 0.0);
  if (!run.rows.error_estimate.empty())
    text += fmt::format(", median error about {:.2g}", median(run.rows.error_estimate));
  text += "\n";
  text +=
      fmt::format("{} s, peak memory {}\n", fmt::format("{:.2f}", run.times.total()), bytes_as_text(peak_rss_bytes()));
  text += fmt::format("wrote {}{}\n", run.options.output, run.options.view.empty() ? "" : " and " + run.options.view);
  return text;
}

std::string strategy_as_text(const LogMap& map) {
  const MarchStatistics& m = map.march();
  if (map.strategy() == Strategy::global) return "global";
  return fmt::format("march: {} bands, the largest of {} vertices", m.bands, m.largest_band);
}

void write_json(const std::string& target, const nlohmann::ordered_json& json) {
  if (target.empty()) return;
  const std::string text = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  if (target == "-") return print(text);
  io::AtomicFile file(target);
  file.write(text);
  file.commit();
}

}  // namespace ahm::app
