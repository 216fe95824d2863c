#include "input/survey.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/pointcloud/neighbor_search.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

bool is_finite(const Vec3& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); }

double distance(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

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

std::optional<Spacing> find_spacing(const std::vector<Vec3>& places) {
  if (places.size() < 2) return std::nullopt;
  const auto search = pointcloud::nanoflann_search(places);
  constexpr std::size_t sample = 20000;
  const std::size_t step = std::max<std::size_t>(1, places.size() / sample);
  std::vector<double> distances;
  std::array<Index, 2> index{};
  std::array<double, 2> squared{};
  for (std::size_t i = 0; i < places.size(); i += step) {
    search->nearest(places[i], index, squared);
    distances.push_back(distance(places[i], places[index[at(index[0]) == i ? 1 : 0]]));
  }
  std::sort(distances.begin(), distances.end());
  return Spacing{distances.front(), distances[distances.size() / 2], distances.back(), distances.size()};
}

/// The row in `component` nearest to the mean of its positions.
Index central_row(const pointcloud::PointCloudSurface& cloud, const std::vector<Index>& component_of, Index component) {
  const auto row = [&](std::size_t v) { return cloud.rows().row(Vertex(static_cast<Index>(v)))->index; };
  Vec3 mean{};
  double count = 0;
  for (std::size_t v = 0; v < component_of.size(); ++v) {
    if (component_of[v] != component) continue;
    count += 1;
    for (std::size_t a = 0; a < 3; ++a) mean[a] += (cloud.positions()[row(v)][a] - mean[a]) / count;
  }
  Index best = 0;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < component_of.size(); ++v) {
    if (component_of[v] != component || !(distance(cloud.positions()[row(v)], mean) < smallest)) continue;
    smallest = distance(cloud.positions()[row(v)], mean);
    best = row(v);
  }
  return best;
}

Connectivity find_connectivity(const io::Geometry& input, const std::vector<Index>& finite, const InputOptions& options,
                               const Progress& progress) {
  pointcloud::CloudOptions cloud_options;
  cloud_options.k = options.k;
  cloud_options.rows = finite;
  cloud_options.threads = options.threads;
  cloud_options.progress = progress;
  const auto built = pointcloud::PointCloudSurface::build(input.points, input.normals, cloud_options);
  const std::vector<Index> component = connected_components(built.graph()).of_vertex;
  Connectivity result;
  result.report = built.details();
  for (const Warning& warning : built.warnings()) result.warnings.push_back(worded(warning));
  result.component_sizes.resize(component.empty() ? 0 : at(*std::max_element(component.begin(), component.end())) + 1);
  for (Index c : component) ++result.component_sizes[c];
  const auto largest = std::max_element(result.component_sizes.begin(), result.component_sizes.end());
  result.central_point = central_row(built, component, static_cast<Index>(largest - result.component_sizes.begin()));
  std::sort(result.component_sizes.begin(), result.component_sizes.end(), std::greater<>());
  return result;
}

}  // namespace

Survey survey(const io::Geometry& input, const InputOptions& options, const Progress& progress) {
  Survey s;
  s.points = input.points.size();
  s.faces = input.face_count();
  s.normals = !input.normals.empty();
  s.colors = !input.colors.empty();
  s.format = input.format;
  s.warnings = input.warnings;
  for (const Vec3& n : input.normals)
    if (!is_finite(n) || n == Vec3{0, 0, 0}) ++s.bad_normals;
  std::vector<Index> finite;
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < input.points.size(); ++i)
    if (is_finite(input.points[i])) finite.push_back(static_cast<Index>(i)), points.push_back(input.points[i]);
  s.non_finite = s.points - points.size();
  find_bounds(points, s);
  {
    const std::vector<Vec3> places = distinct_places(points);
    s.duplicates = points.size() - places.size();
    progress.step("spacing", 0);
    s.spacing = find_spacing(places);
  }
  try {
    s.connectivity = find_connectivity(input, finite, options, progress);
    const auto& warnings = s.connectivity->warnings;
    s.warnings.insert(s.warnings.end(), warnings.begin(), warnings.end());
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& e) {
    s.problem = e.what();
  }
  return s;
}

}  // namespace ahm::app
