#include "commands/logmap_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ahm/util/quantile.hpp"
#include "cli/system_info.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

constexpr std::array all_statuses = {Status::ok, Status::disconnected, Status::beyond_radius, Status::unreached,
                                     Status::removed};

std::size_t count(const RowLogMap& rows, Status status) {
  return static_cast<std::size_t>(std::count(rows.status.begin(), rows.status.end(), status));
}

double largest_distance(const RowLogMap& rows) {
  double largest = 0;
  for (double d : rows.distance)
    if (d > largest) largest = d;  // false for NaN
  return largest;
}

/// Of the numbers that are not NaN.
double median(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  return values.empty() ? NAN : detail::median(values);
}

nlohmann::ordered_json source_as_json(const LogmapRun& run) {
  nlohmann::ordered_json j;
  j["spec"] = to_string(run.spec);
  j["index"] = run.source.row ? nlohmann::ordered_json(run.source.row->index) : nlohmann::ordered_json(nullptr);
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

nlohmann::ordered_json as_json(const LogmapRun& run, const OutputOptions& output) {
  nlohmann::ordered_json j = summary("ahm logmap", run.path, output, run.input);
  j["input"]["normals"] = !run.input.geometry.normals.empty();
  j["n"] = run.rows.status.size();
  j["method"] = to_string(run.map.method());
  if (run.options.tolerance > 0) j["tolerance"] = run.options.tolerance;
  if (run.map.method() == Method::heat) {
    j["variant"] = to_string(run.map.variant());
    j["strategy"] = to_string(run.map.strategy());
    j["t_coef"] = run.options.t_coef;
  }
  j["mean_edge_length"] = run.input.mean_edge_length();
  j["largest_distance"] = largest_distance(run.rows);
  for (Status s : all_statuses) j["status"][std::string(to_string(s))] = count(run.rows, s);
  j["untrusted"] = untrusted(run.quality);
  if (!run.rows.bounded.empty()) j["bounded"] = std::ranges::count(run.rows.bounded, 1);
  if (!run.rows.error_estimate.empty()) j["median_error_estimate"] = median(run.rows.error_estimate);
  j["source"] = source_as_json(run);
  j[std::string(run.input.backend->name)] = app::as_json(run.input.built.report);
  if (run.solver && run.solver->strategy() == Strategy::global)
    j["factor"] = factor_as_json(run.solver->operators().statistics());
  if (const MarchStatistics& m = run.map.march(); m.bands > 0)
    j["march"] = {{"bands", m.bands}, {"largest_band", m.largest_band}, {"solved_vertices", m.solved}};
  return j;
}

std::string as_text(const LogmapRun& run) {
  std::string text = run.is_named ? fmt::format("{}, source {}: ", run.path, to_string(run.spec)) : "";
  text += fmt::format("{} {}", run.rows.status.size(), run.rows.status.size() == 1 ? "vertex" : "vertices");
  for (Status s : all_statuses)
    if (const std::size_t c = count(run.rows, s); c > 0 || s == Status::ok)
      text += fmt::format(", {} {}", c, to_string(s));
  const Vec3& p = run.source.position;
  text += fmt::format("\nsource {} at {:.6g} {:.6g} {:.6g}, largest distance {:.6g}, mean edge length {:.4g}\n",
                      run.source.row ? fmt::format("{}", run.source.row->index) : to_string(run.spec), p[0], p[1], p[2],
                      largest_distance(run.rows), run.input.mean_edge_length());
  text += quality_as_text(run.quality);
  if (!run.rows.error_estimate.empty())
    text += fmt::format(", median error of (u, v) about {:.2g}", median(run.rows.error_estimate));
  if (const auto bounded = std::ranges::count(run.rows.bounded, 1); bounded > 0)
    text += fmt::format(", {} only a bound (the straight line)",
                        bounded == 1 ? "1 distance is" : fmt::format("{} distances are", bounded));
  return text + "\n";
}

}  // namespace

void report(const LogmapRun& run, const OutputOptions& output, Journal& journal) {
  deliver(as_json(run, output), as_text(run), output, journal, {{"versions", versions()}});
}

}  // namespace ahm::app
