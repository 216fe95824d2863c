#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "tool_path/tool_path.hpp"

namespace ahm {
namespace {

using exact::MeshPoint;

/// Distance within which a point counts as covered, and below which a pass covers twice, in spacings.
constexpr double covered_within = 0.6, double_within = 0.5;
/// Points of passes that are farther than this from the region do not cover it, in spacings.
constexpr double off_region = 0.5;
/// Gaps are measured up to this distance, in spacings.
constexpr double farthest = 4;

/// Points that are spread over a face in proportion to its area: an additive sequence of low discrepancy.
class AreaSamples {
 public:
  explicit AreaSamples(double per_area) : per_area_(per_area) {}

  template <class Visit>
  void in_face(Index face, double area, const Visit& visit) {
    due_ += area * per_area_;
    for (; due_ >= 1; due_ -= 1) {
      u_ = std::fmod(u_ + 0.7548776662466927, 1), v_ = std::fmod(v_ + 0.5698402909980532, 1);
      const double u = u_ + v_ > 1 ? 1 - u_ : u_, v = u_ + v_ > 1 ? 1 - v_ : v_;
      visit(MeshPoint{face, {1 - u - v, u, v}});
    }
  }

 private:
  double per_area_, due_ = 0.5, u_ = 0, v_ = 0;
};

/// A point of a pass.
struct PassPoint {
  Vec3 position;  ///< in spacings
  Vec3 normal;    ///< of the nearest face, of any length; zero where there is none
  Index component;
  Index pass;
  double arclength, pass_length;
  bool closed;
};

/// Points at most `step` apart on all passes.
std::vector<PassPoint> points_of_passes(const ToolPath& path, double step) {
  std::vector<PassPoint> result;
  for (std::size_t p = 0; p < path.passes.size(); ++p) {
    const ToolPass& pass = path.passes[p];
    const std::size_t first = result.size();
    double walked = 0;
    for (std::size_t k = pass.begin; k + 1 < pass.end; ++k) {
      const ToolPose &a = path.poses[k], &b = path.poses[k + 1];
      const double length = distance(a.contact, b.contact) / path.spacing;
      const auto parts = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(length / step)));
      for (std::size_t j = 0; j < parts; ++j) {
        const double t = (static_cast<double>(j) + 0.5) / static_cast<double>(parts);
        result.push_back({(1 / path.spacing) * ((1 - t) * a.contact + t * b.contact),
                          {},
                          -1,
                          static_cast<Index>(p),
                          walked + t * length,
                          0,
                          pass.closed});
      }
      walked += length;
    }
    for (std::size_t k = first; k < result.size(); ++k) result[k].pass_length = walked;
  }
  return result;
}

/// Whether two points belong to different parts of the passes, on the same side of a wall and in the same component.
bool are_two_passes(const PassPoint& a, const PassPoint& b) {
  if (a.component != b.component || dot(a.normal, b.normal) <= 0) return false;
  if (a.pass != b.pass) return true;
  double along = std::abs(a.arclength - b.arclength);
  if (a.closed) along = std::min(along, a.pass_length - along);
  return along > 2;
}

double double_share(const std::vector<PassPoint>& points) {
  const auto cell = [](const Vec3& p, std::size_t axis) {
    return static_cast<std::int64_t>(std::floor(p[axis] / double_within));
  };
  const auto key = [](std::int64_t x, std::int64_t y, std::int64_t z) {
    constexpr std::uint64_t mask = (std::uint64_t{1} << 21) - 1;
    return (static_cast<std::uint64_t>(x) & mask) << 42 | (static_cast<std::uint64_t>(y) & mask) << 21 |
           (static_cast<std::uint64_t>(z) & mask);
  };
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3& p = points[k].position;
    cells[key(cell(p, 0), cell(p, 1), cell(p, 2))].push_back(k);
  }
  const auto is_double = [&](const PassPoint& point) {
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z) {
          const Vec3& p = point.position;
          const auto found = cells.find(key(cell(p, 0) + x, cell(p, 1) + y, cell(p, 2) + z));
          if (found == cells.end()) continue;
          for (const std::size_t k : found->second)
            if (distance(points[k].position, p) < double_within && are_two_passes(points[k], point)) return true;
        }
    return false;
  };
  // The points of a piece are equally far apart, those of different pieces nearly so.
  const auto count = std::ranges::count_if(points, is_double);
  return points.empty() ? 0 : static_cast<double>(count) / static_cast<double>(points.size());
}

/// The coverage of all rows. Of several vertices of a row, the one that is covered best counts.
/// @param of_points  coverage of the points of the mesh of the region
std::vector<RowCoverage> coverage_of_rows(const Surface& surface, const FaceMesh& whole, const FaceMesh& region_mesh,
                                          const std::vector<RowCoverage>& of_points) {
  std::vector<RowCoverage> of_vertices(to_size(surface.graph().size()), RowCoverage::no_triangle);
  const auto assign = [&](const FaceMesh& mesh, const auto& coverage) {
    for (std::size_t p = 0; p < mesh.points.size(); ++p) {
      if (mesh.vertices[p] < 0) continue;
      RowCoverage& best = of_vertices[to_size(mesh.vertices[p])];
      best = std::min(best, coverage(p));
    }
  };
  assign(whole, [](std::size_t) { return RowCoverage::outside_region; });
  assign(region_mesh, [&](std::size_t p) { return of_points[p]; });
  std::vector<RowCoverage> result;
  for (Index r = 0; r < surface.rows().row_count(); ++r) {
    RowCoverage best = RowCoverage::removed;
    for (const Vertex v : surface.rows().vertices(Row(r))) best = std::min(best, of_vertices[to_size(v.index)]);
    result.push_back(best);
  }
  return result;
}

}  // namespace

ToolPathMeasures tool_path_measures(const Surface& surface, const ToolPath& path, const ToolPathRegion& region,
                                    double samples) {
  constexpr double step = 0.1;
  const FaceMesh whole = whole_mesh(surface, path.spacing);
  const PathDomain domain(region_mesh(surface, whole, region, path.spacing));
  ToolPathMeasures result;
  for (std::size_t f = 0; f < domain.mesh.size(); ++f) result.area += domain.mesh.area(static_cast<Index>(f));
  AreaSamples spread(samples);
  exact::ExactOptions options;
  options.radius = farthest;
  for (std::size_t f = 0; f < domain.mesh.size(); ++f)
    spread.in_face(static_cast<Index>(f), domain.mesh.area(static_cast<Index>(f)),
                   [&](const MeshPoint& point) { options.targets.push_back(point); });
  const MeshTree tree(domain.mesh);
  std::vector<PassPoint> points = points_of_passes(path, step);
  std::vector<MeshPoint> sources;
  for (PassPoint& point : points)
    if (const MeshTree::Hit hit = tree.nearest(point.position); hit.distance < off_region) {
      sources.push_back(hit.point);
      point.normal = domain.mesh.area_normal(hit.point.face);
      point.component = domain.surface.component(domain.mesh.faces[to_size(hit.point.face)][0]);
    }
  result.area *= path.spacing * path.spacing;
  std::vector<RowCoverage> of_points(domain.mesh.points.size(), RowCoverage::no_pass);
  if (sources.empty()) {
    result.largest_gap = farthest;
    result.rows = coverage_of_rows(surface, whole, domain.mesh, of_points);
    return result;
  }
  std::vector<bool> has_pass(domain.mesh.points.size(), false);  // by number of the component
  for (const PassPoint& point : points)
    if (point.component >= 0) has_pass[to_size(point.component)] = true;
  const exact::ExactMap map = exact::exact_map(domain.surface, sources, options);
  std::size_t covered = 0;
  const auto add = [&](Status status, double distance) {
    const double away = status == Status::ok ? distance : farthest;
    result.largest_gap = std::max(result.largest_gap, away);
    return away <= covered_within;
  };
  for (std::size_t k = 0; k < map.targets(); ++k) covered += add(map.target_status(k), map.target_distance(k));
  for (Index v = 0; v < map.size(); ++v) {
    const bool is_covered = add(map.status(Vertex(v)), map.distance(Vertex(v)));
    if (has_pass[to_size(domain.surface.component(v))])
      of_points[to_size(v)] = is_covered ? RowCoverage::covered : RowCoverage::gap;
  }
  result.covered = map.targets() > 0 ? static_cast<double>(covered) / static_cast<double>(map.targets()) : 0;
  result.double_covered = double_share(points);
  result.rows = coverage_of_rows(surface, whole, domain.mesh, of_points);
  return result;
}

}  // namespace ahm
