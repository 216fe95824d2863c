#include "output/survey_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ahm/render/picture.hpp"
#include "ahm/util/shell.hpp"
#include "input/survey.hpp"
#include "output/output_paths.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

std::string line(std::string_view label, const std::string& value) { return fmt::format("  {:<20}{}\n", label, value); }

std::string triple(const Vec3& v) { return fmt::format("{:.6g} {:.6g} {:.6g}", v[0], v[1], v[2]); }

Vec3 extent(const Survey& s) { return {s.high[0] - s.low[0], s.high[1] - s.low[1], s.high[2] - s.low[2]}; }

/// The figure of a report with this id; a zero value if there is none.
template <class Value>
Value figure(const SurfaceSurvey& surface, std::string_view id) {
  for (const Figure& entry : surface.report)
    if (entry.id == id) return std::get<Value>(entry.value);
  return {};
}

std::string normals_text(const Survey& s) {
  if (s.mesh && !s.as_cloud) {
    constexpr std::string_view unneeded = "(not used: the faces define the normals)";
    if (!s.normals) return fmt::format("none {}", unneeded);
    const std::size_t against = s.mesh->normals_against;
    return against == 0
               ? fmt::format("yes {}", unneeded)
               : fmt::format("yes, pointing to the back of their faces: {} of {} {}", against, s.points, unneeded);
  }
  if (!s.normals) return "none (they will be estimated)";
  if (s.bad_normals > 0) return fmt::format("yes, zero or not finite: {} (they will be estimated)", s.bad_normals);
  if (!s.surface) return "yes";
  return figure<bool>(*s.surface, "oriented") ? "yes, consistently oriented"
                                              : "yes, with inconsistent signs: only their planes are used";
}

std::string parts_text(const Survey& s) {
  const auto& sizes = s.surface->part_sizes;
  double total = 0;
  for (Index size : sizes) total += size;
  const std::string at = s.as_cloud ? fmt::format(" at k = {}", figure<std::int64_t>(*s.surface, "k")) : "";
  if (sizes.size() == 1) return fmt::format("1{}, with {}", at, counted(sizes[0], "vertex"));
  return fmt::format("{}{}; the largest has {} ({:.1f} % of the vertices of all components)", sizes.size(), at,
                     counted(sizes[0], "vertex"), 100.0 * sizes[0] / total);
}

std::string range_text(const LengthRange& range, const char* what) {
  return fmt::format("smallest {:.4g}, median {:.4g}, largest {:.4g} ({} {})", range.smallest, range.median,
                     range.largest, what, range.count);
}

/// The counts that are not zero as text: "3 with a repeated vertex, 2 duplicate"; otherwise "none".
std::string counts_text(std::initializer_list<std::pair<std::int64_t, std::string>> counts) {
  std::string text;
  for (const auto& [count, what] : counts)
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  return text.empty() ? "none" : text;
}

std::string faces_text(const MeshSurvey& mesh) {
  std::string text;
  std::size_t shown = 0, others = 0;
  for (const auto& [corners, count] : mesh.faces_by_corners) {
    if (shown == 8) {
      others += count;
      continue;
    }
    const auto number = static_cast<std::int64_t>(count);
    text += shown++ == 0 ? "" : ", ";
    text += corners == 3   ? counted(number, "triangle")
            : corners == 4 ? counted(number, "quadrilateral")
                           : fmt::format("{} with {} corners", count, corners);
  }
  return others > 0 ? text + fmt::format(", {} with more corners", others) : text;
}

std::string wrong_faces_text(const MeshInspection& found) {
  return counts_text({{std::ssize(found.outside), "with a vertex that does not exist"},
                      {std::ssize(found.small), "with fewer than three corners"},
                      {std::ssize(found.repeating), "with a repeated vertex"},
                      {std::ssize(found.duplicates), "duplicate"}});
}

std::string boundary_text(const TopologyReport& t) {
  return t.boundary_loops == 0 ? "none (closed surface)"
                               : counted(t.boundary_edges, "edge") + " in " + counted(t.boundary_loops, "loop");
}

std::string genus_text(const TopologyReport& t) {
  const std::string euler = fmt::format("Euler characteristic {}", t.euler_characteristic);
  return t.genus() ? fmt::format("{} ({}{})", *t.genus(), t.components > 1 ? "total of all parts, " : "", euler)
                   : "none (" + euler + ")";
}

std::string orientation_text(const TopologyReport& t) {
  if (!t.orientable) return "not orientable: maps use reflections";
  return t.reoriented > 0 ? counted(t.reoriented, "face", "are") + " reversed to agree with the others" : "consistent";
}

std::string non_manifold_text(const TopologyReport& t) {
  if (t.non_manifold_edges == 0 && t.non_manifold_vertices == 0) return "none";
  const std::string edges =
      t.non_manifold_edges > 0 ? counted(t.non_manifold_edges, "edge") + " with more than two faces, " : "";
  return fmt::format("{}{} with several fans of faces; --non-manifold split cuts the mesh there and adds {}", edges,
                     counted(t.non_manifold_vertices, "vertex"), counted(t.added_vertices, "vertex"));
}

std::string repair_text(const RepairSurvey& repair, const TopologyReport& t) {
  const RepairCounts& c = repair.counts;
  if (!c.any() && t.non_manifold_edges == 0 && t.non_manifold_vertices == 0) return "nothing to do";
  const auto faces = [](Index count, const char* before, const char* after) {
    return fmt::format("{}{} {}", before, noun_after(count, "face"), after);
  };
  const std::string done =
      counts_text({{c.welded, noun_after(c.welded, "vertex") + " joined"},
                   {c.repeated_corners, faces(c.repeated_corners, "", "cleared of repeated corners")},
                   {c.degenerate, faces(c.degenerate, "degenerate ", "dropped")},
                   {c.not_finite, faces(c.not_finite, "", "with non-finite vertices dropped")},
                   {c.duplicates, faces(c.duplicates, "duplicate ", "dropped")},
                   {c.reversed, faces(c.reversed, "", "reversed")}});
  return fmt::format("--repair: {}; result: {}", c.any() ? done : "mesh cut where it is nonmanifold",
                     counted(repair.parts, "part"));
}

std::string mesh_text(const Survey& s) {
  const MeshSurvey& mesh = *s.mesh;
  const TopologyReport& t = mesh.inspection.topology;
  std::string text;
  if (mesh.edges) text += line("edge lengths", range_text(*mesh.edges, "edges:"));
  text += line("wrong faces", wrong_faces_text(mesh.inspection));
  text += line("faces without area", fmt::format("{}", mesh.without_area));
  text += line("unused vertices", fmt::format("{}", t.unreferenced));
  text += line("nonmanifold", non_manifold_text(t));
  text += line("repair", repair_text(*s.repair, t));
  if (t.faces == 0) return text;
  text += line("boundary", boundary_text(t));
  text += line("genus", genus_text(t));
  return text + line("orientation", orientation_text(t));
}

}  // namespace

std::string suggestion(const Survey& s, const std::string& path) {
  if (!s.surface) return {};
  std::string stem = stem_of(path);
  if (stem.starts_with('-')) stem.insert(0, "./");
  std::string command = fmt::format("ahm logmap {} --source {}{} -o {}", detail::shell_word(path),
                                    s.surface->central_row, s.surface->options, detail::shell_word(stem + "_map.csv"));
  if (render::can_write_png()) command += fmt::format(" --view {}", detail::shell_word(stem + "_map.png"));
  return command;
}

std::string as_text(const Survey& s, const std::string& path) {
  std::string text = fmt::format("{} ({})\n", path, s.format);
  text += line("points", fmt::format("{}", s.points));
  text += line("faces", s.mesh ? fmt::format("{}: {}", s.faces, faces_text(*s.mesh)) : "0");
  text += line("normals", normals_text(s));
  text += line("colors", s.colors ? "yes" : "none");
  if (!s.columns.empty()) text += line("other columns", fmt::format("{}", fmt::join(s.columns, ", ")));
  if (s.acquisition && s.acquisition->height != 1)
    text += line("picture", fmt::format("{} x {}", s.acquisition->width, s.acquisition->height));
  text += line("non-finite points",
               s.non_finite == 0 ? "0" : fmt::format("{}{}", s.non_finite, s.as_cloud ? ": use --drop-nan" : ""));
  text += line("exact duplicates",
               s.duplicates == 0
                   ? "0"
                   : fmt::format("{} ({})", s.duplicates,
                                 s.as_cloud ? "they will be merged" : "faces are not joined there; see --weld"));
  if (s.points > s.non_finite) {
    text += line("bounds", fmt::format("{}  to  {}", triple(s.low), triple(s.high)));
    const Vec3 e = extent(s);
    text += line("extent", fmt::format("{}  diagonal {:.6g}", triple(e), std::hypot(e[0], e[1], e[2])));
    const UnitGuess guess = guess_unit(s.format, s.low, s.high);
    text +=
        line("unit", guess.unit.empty() ? "not stated in the file" : fmt::format("{}? ({})", guess.unit, guess.reason));
  }
  if (s.spacing)
    text += line("spacing", fmt::format("smallest {:.4g}, median {:.4g}, largest {:.4g} (at {})", s.spacing->smallest,
                                        s.spacing->median, s.spacing->largest, counted(s.spacing->count, "point")));
  if (s.mesh) text += mesh_text(s);
  if (s.surface) text += line("components", parts_text(s));
  if (s.surface) text += line("method", as_text(s.surface->method));
  for (const std::string& w : s.warnings) text += line("note", w);
  if (!s.problem.empty()) text += line("problem", s.problem);
  const std::string command = suggestion(s, path);
  if (s.mesh && s.as_cloud && !command.empty()) text += "No map can be made from the faces, but from the points. ";
  text += command.empty() ? "No map can be made from this file.\n" : "Try:\n  " + command + "\n";
  return text;
}

namespace {

nlohmann::ordered_json as_json(const LengthRange& range, const char* count) {
  return {{"smallest", range.smallest}, {"median", range.median}, {"largest", range.largest}, {count, range.count}};
}

nlohmann::ordered_json as_json(const MeshSurvey& mesh) {
  const MeshInspection& found = mesh.inspection;
  const TopologyReport& t = found.topology;
  nlohmann::ordered_json j;
  const auto with = [&](std::size_t corners) {
    const auto found = mesh.faces_by_corners.find(corners);
    return found == mesh.faces_by_corners.end() ? 0 : found->second;
  };
  std::size_t faces = 0;
  for (const auto& [corners, count] : mesh.faces_by_corners) faces += count;
  j["triangles"] = with(3);
  j["quadrilaterals"] = with(4);
  j["other_faces"] = faces - with(3) - with(4);
  for (const auto& [corners, count] : mesh.faces_by_corners) j["faces_by_corners"][std::to_string(corners)] = count;
  j["normals_against_faces"] = mesh.normals_against;
  if (mesh.edges) j["edge_lengths"] = as_json(*mesh.edges, "edges");
  j["wrong_faces"] = {{"outside", found.outside.size()},
                      {"small", found.small.size()},
                      {"repeating", found.repeating.size()},
                      {"duplicates", found.duplicates.size()}};
  j["parts"] = t.components;
  j["degenerate_faces"] = mesh.without_area;
  j["edges"] = t.edges;
  j["boundary_edges"] = t.boundary_edges;
  j["boundary_loops"] = t.boundary_loops;
  j["euler_characteristic"] = t.euler_characteristic;
  j["genus"] = t.genus() ? nlohmann::ordered_json(*t.genus()) : nlohmann::ordered_json();
  j["orientable"] = t.orientable;
  j["reoriented"] = t.reoriented;
  j["unreferenced"] = t.unreferenced;
  j["non_manifold_edges"] = t.non_manifold_edges;
  j["non_manifold_vertices"] = t.non_manifold_vertices;
  j["added_vertices"] = t.added_vertices;
  return j;
}

void add_surface(const Survey& s, nlohmann::ordered_json& j) {
  const SurfaceSurvey& surface = *s.surface;
  const auto& sizes = surface.part_sizes;
  j["components"] = sizes.size();
  j["component_sizes"] = std::vector<Index>(
      sizes.begin(), sizes.begin() + std::min<std::ptrdiff_t>(20, static_cast<std::ptrdiff_t>(sizes.size())));
  if (s.as_cloud) {
    j["k"] = figure<std::int64_t>(surface, "k");
    j["oriented"] = figure<bool>(surface, "oriented");
    j["degenerate"] = figure<std::int64_t>(surface, "degenerate");
    j["rejected_normals"] = figure<std::int64_t>(surface, "rejected_normals");
  }
  j["central_point"] = surface.central_row;
  const MethodAdvice& method = surface.method;
  j["method"] = {{"advice", to_string(method.exact_first ? Method::exact : method.method)},
                 {"exact_possible", method.exact_possible}};
  if (method.exact_possible) {
    j["method"]["median_bend_degrees"] = method.median_bend;
    j["method"]["sharp_bend_degrees"] = method.sharp_bend;
  }
}

}  // namespace

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
  j["columns"] = s.columns;
  if (s.acquisition) {
    const io::Acquisition& seen = *s.acquisition;
    j["acquisition"] = {
        {"width", seen.width}, {"height", seen.height}, {"position", seen.position}, {"orientation", seen.orientation}};
  }
  j["non_finite"] = s.non_finite;
  j["duplicates"] = s.duplicates;
  if (s.points > s.non_finite) {
    j["bounds"] = {{"low", s.low}, {"high", s.high}};
    j["extent"] = extent(s);
    const UnitGuess guess = guess_unit(s.format, s.low, s.high);
    j["unit_guess"] = guess.unit.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(guess.unit);
  }
  if (s.spacing) j["spacing"] = as_json(*s.spacing, "sample");
  if (s.mesh) j["mesh"] = as_json(*s.mesh);
  if (s.repair) {
    const RepairCounts& c = s.repair->counts;
    j["repair"] = {{"welded", c.welded},         {"repeated_corners", c.repeated_corners},
                   {"degenerate", c.degenerate}, {"not_finite", c.not_finite},
                   {"duplicates", c.duplicates}, {"reversed", c.reversed},
                   {"parts", s.repair->parts}};
  }
  if (s.surface) add_surface(s, j);
  j["warnings"] = s.warnings;
  j["problem"] = s.problem;
  j["suggestion"] = suggestion(s, path);
  return j;
}

}  // namespace ahm::app
