#include "input/survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/pointcloud/neighbor_search.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/util/quantile.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "input/backend.hpp"
#include "input/repair.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

std::vector<double> edge_lengths(const io::Geometry& input) {
  std::vector<std::pair<Index, Index>> edges;
  for (std::size_t f = 0; f < input.face_count(); ++f) {
    const auto face = input.face(f);
    for (std::size_t c = 0; c < face.size(); ++c) {
      const auto [low, high] = std::minmax(face[c], face[(c + 1) % face.size()]);
      if (low != high) edges.emplace_back(low, high);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<double> lengths;
  for (const auto& [a, b] : edges)
    if (const double length = distance(input.points[a], input.points[b]); std::isfinite(length))
      lengths.push_back(length);
  return lengths;
}

/// Normal of a face, on the side from which its corners run counterclockwise. Its length is twice the area divided by unit^2.
Vec3 face_normal(const io::Geometry& input, std::span<const Index> face, double unit) {
  Vec3 sum{};
  for (std::size_t c = 2; c < face.size(); ++c) {
    const Vec3& first = input.points[face[0]];
    sum = sum + cross(1 / unit * (input.points[face[c - 1]] - first), 1 / unit * (input.points[face[c]] - first));
  }
  return sum;
}

std::size_t normals_against_faces(const io::Geometry& input) {
  if (input.normals.empty()) return 0;
  double unit = 0;
  for (const Vec3& p : input.points)
    if (is_finite(p)) unit = std::max(unit, largest(p));
  if (unit == 0) return 0;
  std::vector<Vec3> around(input.points.size(), Vec3{});
  for (std::size_t f = 0; f < input.face_count(); ++f) {
    const Vec3 normal = face_normal(input, input.face(f), unit);
    if (!is_finite(normal)) continue;
    for (const Index corner : input.face(f)) around[corner] = around[corner] + normal;
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < around.size(); ++i) count += dot(around[i], input.normals[i]) < 0 ? 1 : 0;
  return count;
}

std::size_t faces_without_area(const io::Geometry& input) {
  double unit = 0;
  for (const Vec3& p : input.points)
    if (is_finite(p)) unit = std::max(unit, largest(p));
  std::size_t count = 0;
  for (std::size_t f = 0; unit > 0 && f < input.face_count(); ++f) {
    const auto face = input.face(f);
    double area = 0, longest = 0;
    for (std::size_t c = 1; c < face.size(); ++c) {
      const Vec3& first = input.points[face[0]];
      const Vec3 side = 1 / unit * (input.points[face[c]] - first);
      longest = std::max({longest, norm(side), norm(1 / unit * (input.points[face[c]] - input.points[face[c - 1]]))});
      if (c > 1) area += norm(cross(1 / unit * (input.points[face[c - 1]] - first), side));
    }
    count += area <= std::max(1e-10 * longest, 0x1p-51) * longest ? 1 : 0;
  }
  return count;
}

}  // namespace

std::optional<LengthRange> range_of(std::vector<double> lengths) {
  if (lengths.empty()) return std::nullopt;
  std::sort(lengths.begin(), lengths.end());
  return LengthRange{lengths.front(), lengths[lengths.size() / 2], lengths.back(), lengths.size()};
}

MeshSurvey survey_mesh(const io::Geometry& input) {
  MeshSurvey result;
  for (std::size_t f = 0; f < input.face_count(); ++f) ++result.faces_by_corners[input.face(f).size()];
  result.normals_against = normals_against_faces(input);
  result.without_area = faces_without_area(input);
  result.inspection = inspect_mesh(static_cast<Index>(input.points.size()), input.faces());
  result.edges = range_of(edge_lengths(input));
  return result;
}

UnitGuess guess_unit(std::string_view format, const Vec3& low, const Vec3& high) {
  const double diagonal = distance(low, high);
  const double east = low[0] / 2 + high[0] / 2, north = low[1] / 2 + high[1] / 2;
  if (format.starts_with("glTF")) return {"meters", "the unit of glTF"};
  if (std::hypot(east, north) > 1e5 && std::hypot(east, north) > 20 * diagonal && diagonal > 1)
    return {"meters", "the coordinates look like those of a map projection"};
  if (format.starts_with("LAS")) return {"meters", "usual for surveys"};
  if (format.starts_with("PCD") && diagonal > 0.02 && diagonal < 1e4) return {"meters", "usual for PCD files"};
  if (format.starts_with("STL") && diagonal > 1 && diagonal < 1e4)
    return {"millimeters", "usual for STL files of parts"};
  return {};
}

namespace {

double quantile(std::vector<double>& values, double q) {
  return detail::value_at(values, static_cast<std::size_t>(q * static_cast<double>(values.size() - 1)));
}

/// Angle between the normals of the two triangles at each interior edge, degrees.
std::vector<double> bend_angles(const FlatTriangles& flat) {
  const auto corner = [&](Index v) { return (1 / flat.length_unit) * flat.positions[v]; };
  const auto normal = [&](exact::Half h) {
    const exact::HalfRecord& r = flat.surface.record(h);
    return cross(corner(r.head) - corner(r.tail), corner(r.apex) - corner(r.tail));
  };
  std::vector<double> angles;
  for (exact::Half h = 0; h < 3 * flat.surface.face_count(); ++h) {
    const exact::HalfRecord& r = flat.surface.record(h);
    if (r.beyond_left < h) continue;  // each edge once
    Vec3 a = normal(h), b = normal(r.beyond_left);
    if ((r.mirrored & 1) != 0) b = -b;
    angles.push_back(std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi);
  }
  return angles;
}

}  // namespace

MethodAdvice method_advice(const Surface& surface) {
  MethodAdvice advice;
  advice.method = surface.suggested_method();
  if (surface.faces().size() == 0) {
    advice.problem = "there are no faces";
    return advice;
  }
  try {
    const FlatTriangles flat = surface.flat_triangles();
    advice.exact_possible = true;
    std::vector<double> angles = bend_angles(flat);
    if (!angles.empty()) {
      advice.median_bend = quantile(angles, 0.5);
      advice.sharp_bend = quantile(angles, 0.95);
    }
    advice.exact_first = flat.surface.vertex_count() <= exact_vertices && advice.sharp_bend > fine_bend;
  } catch (const Error& e) {
    advice.problem = worded(e);
  }
  return advice;
}

std::string as_text(const MethodAdvice& advice) {
  if (!advice.exact_possible)
    return fmt::format("{}; exact maps are not possible: {}", to_string(advice.method), advice.problem);
  const auto degrees = [](double angle) {
    const std::string number = angle < 10 ? fmt::format("{:.2g}", angle) : fmt::format("{:.0f}", angle);
    return number + (number == "1" ? " degree" : " degrees");
  };
  const std::string bend = fmt::format("angle between neighboring faces: median {}, 95th percentile {}",
                                       degrees(advice.median_bend), degrees(advice.sharp_bend));
  if (advice.exact_first)
    return fmt::format("--method exact for a few maps, {} for many ({})", to_string(advice.method), bend);
  return fmt::format("{}; to follow every face use --method exact, on large meshes with --radius ({})",
                     to_string(advice.method), bend);
}

namespace {

void add_warnings(const std::vector<Warning>& warnings, Survey& s) {
  for (const Warning& warning : warnings) s.warnings.push_back(worded(warning));
}

void find_bounds(const std::vector<Vec3>& points, Survey& s) {
  if (points.empty()) return;
  s.low = s.high = points[0];
  for (const Vec3& p : points)
    for (std::size_t a = 0; a < 3; ++a) {
      s.low[a] = std::min(s.low[a], p[a]);
      s.high[a] = std::max(s.high[a], p[a]);
    }
}

std::vector<Vec3> distinct_places(std::vector<Vec3> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

std::optional<LengthRange> find_spacing(std::vector<Vec3> places) {
  if (places.size() < 2) return std::nullopt;
  double size = 0;
  for (const Vec3& p : places) size = std::max(size, largest(p));
  const double unit = power_of_two_below(size);  // scaled, because the search squares lengths
  for (Vec3& p : places) p = 1 / unit * p;
  const auto search = pointcloud::nanoflann_search(places);
  constexpr std::size_t sample = 20000;
  const std::size_t step = std::max<std::size_t>(1, places.size() / sample);
  std::vector<double> distances;
  std::array<Index, 2> index{};
  std::array<double, 2> squared{};
  for (std::size_t i = 0; i < places.size(); i += step) {
    search->nearest(places[i], index, squared);
    const Index other = index[static_cast<std::size_t>(index[0]) == i ? 1 : 0];
    distances.push_back(unit * distance(places[i], places[other]));
  }
  return range_of(std::move(distances));
}

std::vector<Index> rows_of(const Surface& surface, const std::vector<Index>& component_of, Index component) {
  std::vector<Index> rows;
  for (std::size_t v = 0; v < component_of.size(); ++v) {
    const auto row = surface.rows().row(Vertex(static_cast<Index>(v)));
    if (row && component_of[v] == component) rows.push_back(row->index);
  }
  return rows;
}

/// A visible row near the middle of these rows. The view runs along the shortest side of their bounding box. A raster holds the
/// foremost row of each cell; its cells are so large that rows behind do not show through. The result is the foremost row nearest to
/// the mean in the image plane. (The row nearest to the mean in space may be a noisy point inside a solid.)
Index central_row(std::span<const Vec3> positions, const std::vector<Index>& rows) {
  Vec3 low = positions[rows[0]], high = low, mean{};
  double count = 0;
  for (Index row : rows) {
    count += 1;
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], positions[row][a]);
      high[a] = std::max(high[a], positions[row][a]);
      mean[a] += (positions[row][a] - mean[a]) / count;
    }
  }
  const Vec3 sides = high - low;
  const auto thin = static_cast<std::size_t>(std::min_element(sides.begin(), sides.end()) - sides.begin());
  const std::size_t x = (thin + 1) % 3, y = (thin + 2) % 3;
  const double cells = std::clamp(std::floor(std::sqrt(static_cast<double>(rows.size()) / 8)), 1.0, 64.0);
  std::vector<Index> front(static_cast<std::size_t>(cells * cells), -1);
  const auto cell = [&](double p, std::size_t a) {
    return sides[a] > 0 ? std::min(cells - 1, std::floor((p - low[a]) / sides[a] * cells)) : 0;
  };
  for (Index row : rows) {
    const Vec3& p = positions[row];
    Index& first = front[static_cast<std::size_t>(cell(p[x], x) * cells + cell(p[y], y))];
    if (first < 0 || p[thin] > positions[first][thin]) first = row;
  }
  std::erase(front, -1);
  const auto away = [&](Index row) { return std::hypot(positions[row][x] - mean[x], positions[row][y] - mean[y]); };
  return *std::ranges::min_element(front, {}, away);
}

SurfaceSurvey survey_surface(const BuiltSurface& built) {
  const std::vector<Index> component = connected_components(built.surface->graph()).of_vertex;
  SurfaceSurvey result;
  result.report = built.report;
  auto& sizes = result.part_sizes;
  sizes.resize(static_cast<std::size_t>(*std::max_element(component.begin(), component.end())) + 1);
  for (std::size_t v = 0; v < component.size(); ++v)
    if (built.surface->rows().row(Vertex(static_cast<Index>(v)))) ++sizes[component[v]];
  const auto largest = static_cast<Index>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  result.central_row = central_row(built.surface->positions(), rows_of(*built.surface, component, largest));
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  return result;
}

/// Whether the source remains a vertex after the outliers are removed.
bool can_remove_outliers(const Backend& backend, const io::Geometry& input, InputOptions options, Index source,
                         const Progress& progress) {
  options.outliers = true;
  try {
    backend.build(input, options, SourceVertex{source}, progress).surface->vertex(Row(source));
    return true;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error&) {
    return false;
  }
}

std::optional<RepairSurvey> survey_repair(const io::Geometry& input) {
  const RepairedMesh mesh = repair_mesh(input.points, input.faces(), RepairOptions::all());
  return RepairSurvey{mesh.counts,
                      inspect_mesh(static_cast<Index>(input.points.size()), mesh.faces()).topology.components};
}

/// Options for one attempt to build a surface from the input.
struct Attempt {
  InputOptions options;
  std::string flags;  ///< the options as text, each after a blank
  bool as_cloud = false;
};

Attempt as_mesh(const Survey& s, const InputOptions& options, bool repaired) {
  Attempt attempt{options, "", false};
  if (repaired) {
    attempt.options.repair = RepairOptions::all();
    attempt.options.non_manifold = "split";
    attempt.flags = " --repair";
  } else if (!s.mesh->is_manifold()) {
    attempt.options.non_manifold = "split";
    attempt.flags = " --non-manifold split";
  }
  return attempt;
}

Attempt as_cloud(const Survey& s, const InputOptions& options) {
  Attempt attempt{options, "", true};
  if (options.k) attempt.flags += fmt::format(" --k {}", *options.k);
  attempt.options.drop_nan = s.non_finite > 0;
  if (attempt.options.drop_nan) attempt.flags += " --drop-nan";
  return attempt;
}

/// The attempts in their order: the mesh unchanged, the repaired mesh, the points only. The repaired mesh comes first if the repair
/// joins parts.
std::vector<Attempt> attempts(const Survey& s, const InputOptions& options) {
  if (!s.mesh) return {as_cloud(s, options)};
  const bool joins = s.repair->parts > 0 && s.repair->parts < s.mesh->inspection.topology.components;
  return {as_mesh(s, options, joins), as_mesh(s, options, !joins), as_cloud(s, options)};
}

/// Builds the surface with the options of the suggested command.
void try_surface(io::Geometry input, const Attempt& attempt, const Progress& progress, Survey& s) {
  if (attempt.as_cloud) input.face_begin.clear(), input.face_vertices.clear();
  std::optional<RepairedMesh> mesh = repair(input, attempt.options);
  const Backend& backend = choose_backend(input, InputOptions{});
  std::string flags = attempt.flags;
  if (attempt.as_cloud && s.mesh) flags.insert(0, fmt::format(" --backend {}", backend.name));
  const BuiltSurface built = mesh ? build_repaired(backend, input, *mesh, attempt.options, {}, progress)
                                  : backend.build(input, attempt.options, {}, progress);
  s.surface = survey_surface(built);
  // Many small components are usually stray points.
  if (attempt.as_cloud && s.surface->part_sizes.size() > 20 &&
      can_remove_outliers(backend, input, attempt.options, s.surface->central_row, progress))
    flags += " --outliers";
  s.surface->method = method_advice(*built.surface);
  if (s.surface->method.exact_first) flags += " --method exact";
  s.surface->options = flags;
  add_warnings(built.surface->warnings(), s);
}

void find_surface(const io::Geometry& input, const InputOptions& options, const Progress& progress, Survey& s) {
  for (const Attempt& attempt : attempts(s, options)) {
    s.as_cloud = attempt.as_cloud;
    try {
      return try_surface(input, attempt, progress, s);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& e) {
      if (s.problem.empty()) s.problem = worded(e);
    }
  }
}

}  // namespace

Survey survey(const io::Geometry& input, const InputOptions& options, const Progress& progress) {
  Survey s;
  s.points = input.points.size();
  s.faces = input.face_count();
  s.normals = !input.normals.empty();
  s.colors = !input.colors.empty();
  s.format = input.format;
  for (const io::Property& property : input.properties) s.columns.push_back(property.name);
  s.acquisition = input.acquisition;
  add_warnings(input.warnings, s);
  for (const Vec3& n : input.normals)
    if (!is_finite(n) || n == Vec3{0, 0, 0}) ++s.bad_normals;
  std::vector<Vec3> points;
  for (const Vec3& p : input.points)
    if (is_finite(p)) points.push_back(p);
  s.non_finite = s.points - points.size();
  find_bounds(points, s);
  if (s.faces > 0) s.mesh = survey_mesh(input), s.repair = survey_repair(input);
  {
    std::vector<Vec3> places = distinct_places(points);
    s.duplicates = points.size() - places.size();
    progress.step("spacing", 0);
    if (!s.mesh) s.spacing = find_spacing(std::move(places));
  }
  find_surface(input, options, progress, s);
  return s;
}

}  // namespace ahm::app
