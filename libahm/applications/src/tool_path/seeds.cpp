// The curves from which the passes of a tool path start.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "ahm/error.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/surface/surface_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "tool_path/curves.hpp"
#include "tool_path/tool_path.hpp"

namespace ahm {
namespace {

using detail::Half;
using exact::MeshPoint;

constexpr double no_height = std::numeric_limits<double>::quiet_NaN();

/// A straight line ends where it comes nearer to itself, in spacings.
constexpr double least_return = 0.5;

/// A component of the mesh: the faces whose points have this component number.
struct Component {
  Index number;
  Vec3 center{};
  Vec3 normal{};  ///< of the plane of the automatic seed
};

/// Centers and principal directions of all components, by area.
std::vector<Component> components(const PathDomain& domain) {
  struct Moments {
    double area = 0;
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  };
  const FaceMesh& mesh = domain.mesh;
  std::map<Index, Moments> all;
  for (std::size_t f = 0; f < mesh.size(); ++f) {
    Moments& m = all[domain.surface.component(mesh.faces[f][0])];
    const Vec3 c = mesh.position({static_cast<Index>(f), {1.0 / 3, 1.0 / 3, 1.0 / 3}});
    const Eigen::Vector3d center(c[0], c[1], c[2]);
    const double area = mesh.area(static_cast<Index>(f));
    m.area += area;
    m.first += area * center;
    m.second += area * center * center.transpose();
  }
  std::vector<Component> result;
  for (const auto& [number, m] : all) {
    const Eigen::Vector3d center = m.first / m.area;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(m.second / m.area - center * center.transpose());
    const Eigen::Vector3d middle = axes.eigenvectors().col(1);
    result.push_back({number, {center[0], center[1], center[2]}, {middle[0], middle[1], middle[2]}});
  }
  return result;
}

/// The section of a mesh with a plane. @param component  number of a component; -1: all
std::vector<MeshCurve> section(const PathDomain& domain, const Vec3& point, const Vec3& normal, Index component = -1) {
  std::vector<double> heights;
  for (std::size_t p = 0; p < domain.mesh.points.size(); ++p)
    heights.push_back(component < 0 || domain.surface.component(static_cast<Index>(p)) == component
                          ? dot(domain.mesh.points[p] - point, normal)
                          : no_height);
  return level_curves(domain.mesh, heights, 0);
}

/// The longest curve of each component.
std::vector<MeshCurve> longest_of_components(const PathDomain& domain, std::span<const MeshCurve> curves) {
  std::map<Index, std::pair<double, const MeshCurve*>> longest;
  for (const MeshCurve& curve : curves) {
    const double length = curve_length(domain.mesh, curve);
    if (auto& best = longest[domain.surface.component(curve.points.front())]; length > best.first)
      best = {length, &curve};
  }
  std::vector<MeshCurve> result;
  for (const auto& [component, curve] : longest) result.push_back(*curve.second);
  return result;
}

/// A corner of a face.
MeshPoint corner_of(const FaceMesh& mesh, Index face, Index point) {
  MeshPoint result{face, {0, 0, 0}};
  for (std::size_t c = 0; c < 3; ++c)
    if (mesh.faces[to_size(face)][c] == point) result.barycentric[c] = 1;
  return result;
}

/// Joins sides to curves. Curves end at points where one side or more than two sides meet. @param sides  each once
std::vector<MeshCurve> chains(const FaceMesh& mesh, const std::vector<Half>& sides) {
  std::map<Index, std::vector<std::size_t>> around;  // sides at each point
  for (std::size_t k = 0; k < sides.size(); ++k)
    for (const Index end : {mesh.tail(sides[k]), mesh.head(sides[k])}) around[end].push_back(k);
  std::vector<bool> used(sides.size(), false);
  const auto walk = [&](Index start, std::size_t side) {
    MeshCurve curve;
    for (Index at = start;;) {
      used[side] = true;
      const Half half = sides[side];
      curve.points.push_back(corner_of(mesh, half / 3, at));
      curve.faces.push_back(half / 3);
      at = mesh.tail(half) == at ? mesh.head(half) : mesh.tail(half);
      const std::vector<std::size_t>& next = around[at];
      curve.closed = at == start;
      if (curve.closed) return curve;
      if (next.size() != 2) {
        curve.points.push_back(corner_of(mesh, half / 3, at));
        return curve;
      }
      side = next[0] == side ? next[1] : next[0];
    }
  };
  std::vector<MeshCurve> result;
  for (const auto& [point, meeting] : around)
    for (const std::size_t side : meeting)
      if (meeting.size() != 2 && !used[side]) result.push_back(walk(point, side));
  for (std::size_t side = 0; side < sides.size(); ++side)  // without ends: closed
    if (!used[side]) result.push_back(walk(mesh.tail(sides[side]), side));
  return result;
}

/// The boundary loops of a mesh. At every point of a boundary, two of its sides meet.
std::vector<MeshCurve> boundary_loops(const FaceMesh& mesh) {
  std::vector<Half> sides;
  for (std::size_t h = 0; h < mesh.twin.size(); ++h)
    if (mesh.twin[h] < 0) sides.push_back(static_cast<Half>(h));
  return chains(mesh, sides);
}

/// The curves of sides at which the normal turns by an angle or more.
std::vector<MeshCurve> feature_edges(const FaceMesh& mesh, double angle) {
  std::vector<Half> sides;
  for (std::size_t h = 0; h < mesh.twin.size(); ++h) {
    const Half half = static_cast<Half>(h), twin = mesh.twin[h];
    if (twin < half) continue;  // on the boundary, or the other side of one before
    const double sign = mesh.mirrored[h] ? -1 : 1;
    const Vec3 a = mesh.area_normal(half / 3), b = sign * mesh.area_normal(twin / 3);
    if (std::atan2(norm(cross(a, b)), dot(a, b)) >= angle - 1e-9) sides.push_back(half);
  }
  return chains(mesh, sides);
}

/// The part of a line around a point that does not come near itself. Both ends grow until they do.
MeshCurve without_returns(const FaceMesh& mesh, const MeshCurve& line, const Vec3& around) {
  struct Place {
    Vec3 position, normal;
    double along;
  };
  std::vector<Place> places;
  std::size_t low = 0;
  for (std::size_t k = 0; k < line.points.size(); ++k) {
    const Vec3 position = mesh.position(line.points[k]);
    const double step = k > 0 ? distance(position, places.back().position) : 0;
    places.push_back({position, mesh.area_normal(line.points[k].face), k > 0 ? places.back().along + step : 0});
    if (distance(position, around) < distance(places[low].position, around)) low = k;
  }
  std::size_t high = low;
  const double start = places[low].along;
  const auto returns = [&](const Place& place) {
    for (std::size_t k = low; k <= high; ++k)
      if (std::abs(places[k].along - place.along) > 4 * least_return &&
          distance(places[k].position, place.position) < least_return && dot(places[k].normal, place.normal) > 0)
        return true;
    return false;
  };
  for (bool grows_down = true, grows_up = true; grows_down || grows_up;) {
    grows_down = grows_down && low > 0, grows_up = grows_up && high + 1 < places.size();
    if (grows_down && (!grows_up || start - places[low - 1].along <= places[high + 1].along - start)) {
      grows_down = !returns(places[low - 1]);
      if (grows_down) --low;
    } else if (grows_up) {
      grows_up = !returns(places[high + 1]);
      if (grows_up) ++high;
    }
  }
  const auto at = [](std::size_t k) { return static_cast<std::ptrdiff_t>(k); };
  return {{line.points.begin() + at(low), line.points.begin() + at(high) + 1},
          {line.faces.begin() + at(low), line.faces.begin() + at(high)}};
}

struct SeedFinder {
  const Surface& surface;
  const PathDomain& domain;
  double spacing;

  std::vector<MeshCurve> operator()(const AutomaticSeed&) const {
    std::vector<MeshCurve> result;
    for (const Component& component : components(domain)) {
      const std::vector<MeshCurve> of_one = section(domain, component.center, component.normal, component.number);
      result.insert(result.end(), of_one.begin(), of_one.end());
    }
    return result;
  }
  std::vector<MeshCurve> operator()(const PlaneSeed& plane) const {
    const double length = norm(plane.normal);
    if (!(length > 0 && std::isfinite(length)) || !is_finite(plane.point))
      throw InvalidArgument("the plane of the seed has no finite point or no normal");
    std::vector<MeshCurve> result = section(domain, (1 / spacing) * plane.point, (1 / length) * plane.normal);
    if (result.empty())
      throw InvalidArgument("seed_off_surface", "the plane of the seed does not cross the region", "move the plane");
    return result;
  }
  std::vector<MeshCurve> operator()(const BoundarySeed&) const {
    std::vector<MeshCurve> result = longest_of_components(domain, boundary_loops(domain.mesh));
    if (result.empty())
      throw InvalidArgument("seed_off_surface", "the region has no boundary to start from", "use another seed");
    return result;
  }
  std::vector<MeshCurve> operator()(const FeatureSeed& feature) const {
    constexpr double degree = std::numbers::pi / 180;
    if (!(feature.angle > 0 && feature.angle <= std::numbers::pi))
      throw InvalidArgument("the angle of the feature edges is " + detail::number(feature.angle / degree) +
                            " degrees; it must lie in (0, 180]");
    const std::vector<MeshCurve> edges = feature_edges(domain.mesh, feature.angle);
    if (edges.empty())
      throw InvalidArgument("seed_off_surface",
                            "normals of the region turn nowhere by " + detail::number(feature.angle / degree) +
                                " degrees or more from triangle to triangle",
                            "use a smaller angle or another seed");
    if (!feature.near) return longest_of_components(domain, edges);
    const SurfacePoint point =
        surface_point(surface, *feature.near, spacing, "the point near the feature edge", "seed_off_surface");
    const Vec3 position = (1 / spacing) * surface.position(point);
    const auto distance_of = [&](const MeshCurve& edge) {
      double least = std::numeric_limits<double>::infinity();
      for (const MeshPoint& p : edge.points) least = std::min(least, distance(domain.mesh.position(p), position));
      return least;
    };
    return {*std::ranges::min_element(edges, {}, distance_of)};
  }
  std::vector<MeshCurve> operator()(const CurveSeed& curve) const {
    const SurfaceCurve drawn = drawn_curve(surface, curve.points, curve.closed, spacing, "seed", "seed_off_surface");
    return {on_mesh(domain, drawn.points, curve.closed, spacing, "seed", "seed_off_surface")};
  }
  std::vector<MeshCurve> operator()(const LineSeed& line) const {
    const double length = bounding_box(domain.mesh.points).diagonal() * spacing;
    const SurfacePoint start =
        surface_point(surface, line.point, spacing, "the point of the seed line", "seed_off_surface");
    std::optional<ExactGeodesics> geodesics;
    if (surface.faces().size() > 0) geodesics.emplace(surface);
    std::vector<Vec3> points;
    std::size_t at = 0;  // the start
    for (const double side : {-1.0, 1.0}) {
      std::vector<Vec3> half;
      try {
        if (geodesics)
          for (const MeshPoint& p : geodesics->trace(start, side * line.direction, length).points)
            half.push_back(geodesics->position(p));
        else
          half = trace_line(surface, start, side * line.direction, length).points;
      } catch (const InvalidArgument& e) {  // on the boundary, one side leaves the surface
        if (e.fault() == "axis_along_normal")
          throw InvalidArgument("seed_along_normal", "the direction of the seed line is perpendicular to the surface",
                                "use a direction along the surface");
        if (side > 0 && points.empty())
          throw InvalidArgument("seed_off_surface", std::string("the seed line has no length: ") + e.what(),
                                "use a direction along the surface");
        continue;
      }
      if (side < 0) std::reverse(half.begin(), half.end());
      points.insert(points.end(), half.begin() + (side > 0 && !points.empty() ? 1 : 0), half.end());
      if (side < 0) at = points.size() - 1;
    }
    const MeshCurve curve = on_mesh(domain, part_around(points, at), false, spacing, "seed", "seed_off_surface");
    return {without_returns(domain.mesh, curve, (1 / spacing) * surface.position(start))};
  }

 private:
  /// The points of a line around one of them that lie in its component of the region, up to the first gap.
  std::span<const Vec3> part_around(std::span<const Vec3> points, std::size_t at) const {
    const MeshTree tree(domain.mesh);
    const auto component = [&](std::size_t k) {
      const MeshTree::Hit hit = tree.nearest((1 / spacing) * points[k]);
      return hit.distance < largest_curve_distance ? domain.surface.component(hit.point) : -1;
    };
    const Index own = component(at);
    if (own < 0) return {};
    std::size_t low = at, end = at + 1;
    while (low > 0 && component(low - 1) == own) --low;
    while (end < points.size() && component(end) == own) ++end;
    return points.subspan(low, end - low);
  }
};

}  // namespace

std::vector<MeshCurve> seed_curves(const Surface& surface, const PathDomain& domain, const ToolPathOptions& options) {
  return std::visit(SeedFinder{surface, domain, options.spacing}, options.seed);
}

}  // namespace ahm
