#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "input/survey.hpp"

namespace ahm::app {
namespace {

std::string line(std::string_view label, const std::string& value) { return fmt::format("  {:<20}{}\n", label, value); }

std::string triple(const Vec3& v) { return fmt::format("{:.6g} {:.6g} {:.6g}", v[0], v[1], v[2]); }

Vec3 extent(const Survey& s) { return {s.high[0] - s.low[0], s.high[1] - s.low[1], s.high[2] - s.low[2]}; }

/// Quotes a path for a shell when it needs quoting.
std::string quoted(const std::string& path) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+=,:@%";
  if (!path.empty() && path.find_first_not_of(plain) == std::string::npos) return path;
  std::string result = "'";
  for (char c : path) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::string normals_text(const Survey& s) {
  if (!s.normals) return "none (they will be estimated)";
  if (s.bad_normals > 0)
    return fmt::format("yes, but {} are zero or not finite (they will be estimated)", s.bad_normals);
  if (!s.connectivity) return "yes";
  return s.connectivity->report.oriented ? "yes, consistently oriented"
                                         : "yes, signs not consistent: only their planes are used";
}

std::string components_text(const Connectivity& c) {
  const auto& sizes = c.component_sizes;
  if (sizes.empty()) return "0";
  double total = 0;
  for (Index size : sizes) total += size;
  return fmt::format("{} at k = {}; the largest holds {} vertices ({:.1f} %)", sizes.size(), c.report.k, sizes[0],
                     100.0 * sizes[0] / total);
}

}  // namespace

std::string suggestion(const Survey& s, const std::string& path) {
  if (!s.connectivity) return {};
  const std::string stem = std::filesystem::path(path).stem().string();
  std::string command = fmt::format("ahm logmap {} --source {}", quoted(path), s.connectivity->central_point);
  if (s.non_finite > 0) command += " --drop-nan";
  // Many small components are stray points as a rule.
  if (s.connectivity->component_sizes.size() > 20) command += " --outliers";
  return command + fmt::format(" -o {} --view {}", quoted(stem + "_map.csv"), quoted(stem + "_map.png"));
}

std::string as_text(const Survey& s, const std::string& path) {
  std::string text = fmt::format("{} ({})\n", path, s.format);
  text += line("points", fmt::format("{}", s.points));
  text += line("faces", fmt::format("{}", s.faces));
  text += line("normals", normals_text(s));
  text += line("colours", s.colors ? "yes" : "none");
  text += line("non-finite points", s.non_finite > 0 ? fmt::format("{}: use --drop-nan", s.non_finite) : "0");
  text += line("exact duplicates", s.duplicates > 0 ? fmt::format("{} (they will be merged)", s.duplicates) : "0");
  if (s.points > s.non_finite) {
    text += line("bounds", fmt::format("{}  to  {}", triple(s.low), triple(s.high)));
    const Vec3 e = extent(s);
    text += line("extent", fmt::format("{}  diagonal {:.6g}", triple(e), std::hypot(e[0], e[1], e[2])));
  }
  if (s.spacing)
    text += line("spacing", fmt::format("smallest {:.4g}, median {:.4g}, largest {:.4g} (at {} points)",
                                        s.spacing->smallest, s.spacing->median, s.spacing->largest, s.spacing->sample));
  if (s.connectivity) text += line("components", components_text(*s.connectivity));
  for (const std::string& w : s.warnings) text += line("note", w);
  if (!s.problem.empty()) text += line("problem", s.problem);
  const std::string command = suggestion(s, path);
  text += command.empty() ? "No map can be made of this file.\n" : "Try:\n  " + command + "\n";
  return text;
}

nlohmann::ordered_json as_json(const Survey& s, const std::string& path) {
  nlohmann::ordered_json j;
  j["program"] = "ahm info";
  j["input"] = path;
  j["format"] = s.format;
  j["points"] = s.points;
  j["faces"] = s.faces;
  j["normals"] = s.normals;
  j["bad_normals"] = s.bad_normals;
  j["colors"] = s.colors;
  j["non_finite"] = s.non_finite;
  j["duplicates"] = s.duplicates;
  if (s.points > s.non_finite) {
    j["bounds"] = {{"low", s.low}, {"high", s.high}};
    j["extent"] = extent(s);
  }
  if (s.spacing)
    j["spacing"] = {{"smallest", s.spacing->smallest},
                    {"median", s.spacing->median},
                    {"largest", s.spacing->largest},
                    {"sample", s.spacing->sample}};
  if (s.connectivity) {
    const auto& c = *s.connectivity;
    j["components"] = c.component_sizes.size();
    j["component_sizes"] =
        std::vector<Index>(c.component_sizes.begin(),
                           c.component_sizes.begin() +
                               std::min<std::ptrdiff_t>(20, static_cast<std::ptrdiff_t>(c.component_sizes.size())));
    j["k"] = c.report.k;
    j["oriented"] = c.report.oriented;
    j["degenerate"] = c.report.degenerate;
    j["rejected_normals"] = c.report.rejected_normals;
    j["central_point"] = c.central_point;
  }
  j["warnings"] = s.warnings;
  j["problem"] = s.problem;
  j["suggestion"] = suggestion(s, path);
  return j;
}

}  // namespace ahm::app
