#include "input/survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/pointcloud/neighbor_search.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "input/backend.hpp"
#include "input/repair.hpp"
#include "output/wording.hpp"

namespace ahm::app {
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
  const double unit = power_of_two_below(size);  // the search squares lengths
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

/// Of these rows one in the middle of what is seen along the thinnest side of their box: of those that stand in front, one in each
/// cell of a raster so coarse that what is behind does not show through, the nearest to the mean in the picture's plane. (On a
/// solid the point nearest to the mean lies where nobody sees it, among noisy points within the others.)
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

SurfaceSurvey survey_surface(const Built& built) {
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

/// Whether the source can be mapped from without the outliers.
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

/// One way to make a surface of the input.
struct Attempt {
  InputOptions options;
  std::string flags;  ///< that say so, each after a blank
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

/// Repairs where parts of the mesh only touch; as it is; repaired; the points alone.
std::vector<Attempt> attempts(const Survey& s, const InputOptions& options) {
  if (!s.mesh) return {as_cloud(s, options)};
  const bool joins = s.repair->parts > 0 && s.repair->parts < s.mesh->inspection.topology.components;
  return {as_mesh(s, options, joins), as_mesh(s, options, !joins), as_cloud(s, options)};
}

/// Builds the surface as the command that is suggested will.
void try_surface(io::Geometry input, const Attempt& attempt, const Progress& progress, Survey& s) {
  if (attempt.as_cloud) input.face_begin.clear(), input.face_vertices.clear();
  std::optional<RepairedMesh> mesh = repair(input, attempt.options);
  const Backend& backend = choose_backend(input, InputOptions{});
  std::string flags = attempt.flags;
  if (attempt.as_cloud && s.mesh) flags.insert(0, fmt::format(" --backend {}", backend.name));
  const Built built = mesh ? build_repaired(backend, input, *mesh, attempt.options, {}, progress)
                           : backend.build(input, attempt.options, {}, progress);
  s.surface = survey_surface(built);
  // Many small components are stray points as a rule.
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
