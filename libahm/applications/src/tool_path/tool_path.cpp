#include "tool_path/tool_path.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "ahm/error.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/surface/surface_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

using detail::Half;
using exact::MeshPoint;

constexpr double no_height = std::numeric_limits<double>::quiet_NaN();

/// Points of a curve that are farther than this from the surface are rejected, in spacings.
constexpr double largest_curve_distance = 0.5;
/// A straight line ends where it comes nearer to itself, in spacings.
constexpr double least_return = 0.5;

void check_positive(const std::string& name, double value) {
  if (!(value > 0 && std::isfinite(value)))
    throw InvalidArgument(name + " is " + detail::number(value) + "; it must be finite and > 0");
}

void check(const ToolPathOptions& o) {
  check_positive("spacing", o.spacing);
  for (const auto& [name, value] : {std::pair{"step", o.step},
                                    {"chord_error", o.chord_error},
                                    {"tool_radius", o.tool_radius},
                                    {"clearance", o.clearance},
                                    {"max_link", o.max_link},
                                    {"offset", o.offset}})
    if (value != 0) check_positive(name, value);
  for (const auto& [name, angle] : {std::pair{"lead", o.lead}, {"tilt", o.tilt}})
    if (!(std::abs(angle) < std::numbers::pi / 2))
      throw InvalidArgument(std::string(name) + " is " + detail::number(angle) + "; it must lie within (-pi/2, pi/2)");
}

/// Rejects faces that exact maps reject, before the refinement changes their numbers.
void check_faces(const FaceMesh& mesh, double spacing) {
  for (std::size_t f = 0; f < mesh.size(); ++f) {
    const auto corner = [&](std::size_t c) { return mesh.points[to_size(mesh.faces[f][c])]; };
    const Vec3 ab = corner(1) - corner(0), ac = corner(2) - corner(0), bc = corner(2) - corner(1);
    const double longest = std::max({norm(ab), norm(ac), norm(bc)});
    if (!std::isfinite(longest)) continue;  // the refinement rejects the spacing
    if (longest > 0 && norm(cross((1 / longest) * ab, (1 / longest) * ac)) > exact::PolyhedralSurface::min_height)
      continue;
    const Vec3 at = spacing * mesh.position({static_cast<Index>(f), {1.0 / 3, 1.0 / 3, 1.0 / 3}});
    throw InvalidGeometry("the face around " + detail::number(at[0]) + ", " + detail::number(at[1]) + ", " +
                          detail::number(at[2]) +
                          " has no area: its corners lie on a line; remove it or move its corners");
  }
}

/// The longest diagonal of the bounding box.
double extent(const FaceMesh& mesh) {
  Vec3 low = mesh.points.front(), high = low;
  for (const Vec3& p : mesh.points)
    for (std::size_t axis = 0; axis < 3; ++axis)
      low[axis] = std::min(low[axis], p[axis]), high[axis] = std::max(high[axis], p[axis]);
  return distance(low, high);
}

/// The nearest point of a surface.
/// @param name   of the point, for messages
/// @param fault  name of the error, a literal
SurfacePoint point_near(const Surface& surface, const Vec3& position, double spacing, const std::string& name,
                        std::string_view fault) {
  const ClosestPoint closest = surface.closest_point(position);
  if (closest.distance > largest_curve_distance * spacing)
    throw InvalidArgument(
        fault, name + " is " + detail::number(closest.distance) + " from the surface, more than half of the spacing",
        "use a point on the surface");
  return closest.point;
}

SurfacePoint surface_point(const Surface& surface, const CurvePoint& point, double spacing, const std::string& name,
                           std::string_view fault) {
  if (const auto* position = std::get_if<Vec3>(&point)) return point_near(surface, *position, spacing, name, fault);
  return std::get<SurfacePoint>(point);
}

/// The center of a disc, in spacings. Checks the disc.
Vec3 center_of(const Surface& surface, const ToolPathRegion::Disc& disc, double spacing) {
  check_positive("the radius of the region", disc.radius);
  return (1 / spacing) * surface.position(surface_point(surface, disc.center, spacing, "the center of the region",
                                                        "region_off_surface"));
}

/// Keeps the faces within a distance in space of the center of a disc. They contain all that its radius reaches.
void keep_near(const Surface& surface, const ToolPathRegion::Disc& disc, double spacing, const FaceMesh& mesh,
               std::vector<bool>& kept) {
  const Vec3 center = center_of(surface, disc, spacing);
  for (std::size_t f = 0; f < mesh.size(); ++f) {
    const auto corner = [&](std::size_t c) { return mesh.points[to_size(mesh.faces[f][c])]; };
    const auto nearest = nearest_in_triangle(center, corner(0), corner(1), corner(2));
    kept[f] = distance(mesh.position({static_cast<Index>(f), nearest}), center) <= disc.radius / spacing;
  }
}

/// Keeps the faces within a distance along the surface of a point.
void keep_disc(const Surface& surface, const ToolPathRegion::Disc& disc, double spacing, const FaceMesh& mesh,
               std::vector<bool>& kept) {
  const PathDomain domain(mesh);
  const auto center = FaceLocator(domain.mesh).nearest(center_of(surface, disc, spacing));
  std::fill(kept.begin(), kept.end(), false);
  if (!center) return;
  exact::ExactOptions options;
  options.radius = disc.radius / spacing;
  const exact::ExactMap map = exact::exact_map(domain.surface, *center, options);
  for (std::size_t f = 0; f < mesh.size(); ++f)
    kept[f] = std::ranges::all_of(mesh.faces[f], [&](Index p) { return map.status(Vertex(p)) == Status::ok; });
}

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

/// The longest boundary loop of each component.
std::vector<MeshCurve> longest_loops(const PathDomain& domain) {
  const FaceMesh& mesh = domain.mesh;
  std::map<Index, Half> leaving;
  for (std::size_t h = 0; h < mesh.twin.size(); ++h)
    if (mesh.twin[h] < 0) leaving[mesh.tail(static_cast<Half>(h))] = static_cast<Half>(h);
  std::map<Index, std::pair<double, MeshCurve>> longest;
  while (!leaving.empty()) {
    MeshCurve loop;
    loop.closed = true;
    Index vertex = leaving.begin()->first;
    const Index component = domain.surface.component(vertex);
    for (auto next = leaving.find(vertex); next != leaving.end(); next = leaving.find(vertex)) {
      const Half half = next->second;
      MeshPoint p{half / 3, {0, 0, 0}};
      p.barycentric[to_size(half % 3)] = 1;
      loop.points.push_back(p);
      loop.faces.push_back(half / 3);
      vertex = mesh.head(half);
      leaving.erase(next);
    }
    const double length = curve_length(mesh, loop);
    if (auto& best = longest[component]; length > best.first) best = {length, std::move(loop)};
  }
  std::vector<MeshCurve> result;
  for (auto& [component, loop] : longest) result.push_back(std::move(loop.second));
  return result;
}

/// A curve in space, moved to the mesh.
/// @param name  of the curve, for messages: "seed"
/// @param fault  name of the error, a literal
MeshCurve on_mesh(const PathDomain& domain, std::span<const Vec3> points, bool closed, double spacing,
                  const std::string& name, std::string_view fault) {
  const FaceLocator locator(domain.mesh);
  std::vector<MeshPoint> found;
  for (const Vec3& p : points)
    if (const auto point = locator.nearest((1 / spacing) * p)) found.push_back(*point);
  if (found.size() < 2)
    throw InvalidArgument(fault, "the " + name + " curve does not lie in the part that is covered",
                          "choose a curve there");
  const Index component = domain.surface.component(found.front());
  if (!std::ranges::all_of(found, [&](const MeshPoint& p) { return domain.surface.component(p) == component; }))
    throw InvalidArgument("curve_disconnected", "the surface does not connect the points of the " + name + " curve",
                          "use points of one component");
  return joined_curve(domain, found, closed && found.size() == points.size());
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

/// The points of a curve, joined on the surface.
/// @param name   of the curve, for messages: "seed"
/// @param fault  name of the error, a literal
SurfaceCurve drawn_curve(const Surface& surface, std::span<const Vec3> positions, bool closed, double spacing,
                         const std::string& name, std::string_view fault) {
  std::vector<CurvePoint> points;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    point_near(surface, positions[k], spacing, "point " + std::to_string(k) + " of the " + name + " curve", fault);
    points.emplace_back(positions[k]);
  }
  return draw_curve(surface, points, {.closed = closed});
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
    std::vector<MeshCurve> result = longest_loops(domain);
    if (result.empty())
      throw InvalidArgument("seed_off_surface", "the region has no boundary to start from", "use another seed");
    return result;
  }
  std::vector<MeshCurve> operator()(const CurveSeed& curve) const {
    const SurfaceCurve drawn = drawn_curve(surface, curve.points, curve.closed, spacing, "seed", "seed_off_surface");
    return {on_mesh(domain, drawn.points, curve.closed, spacing, "seed", "seed_off_surface")};
  }
  std::vector<MeshCurve> operator()(const LineSeed& line) const {
    const double length = extent(domain.mesh) * spacing;
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
    const FaceLocator locator(domain.mesh);
    const auto component = [&](std::size_t k) {
      const auto point = locator.nearest((1 / spacing) * points[k]);
      return point ? domain.surface.component(*point) : -1;
    };
    const Index own = component(at);
    if (own < 0) return {};
    std::size_t low = at, end = at + 1;
    while (low > 0 && component(low - 1) == own) --low;
    while (end < points.size() && component(end) == own) ++end;
    return points.subspan(low, end - low);
  }
};

Index count_uncovered(const PathDomain& domain, const std::vector<MeshCurve>& seeds) {
  std::map<Index, bool> covered;
  for (const Triangle& face : domain.mesh.faces) covered[domain.surface.component(face[0])];
  for (const MeshCurve& seed : seeds)
    covered[domain.surface.component(domain.mesh.faces[to_size(seed.faces.front())][0])] = true;
  return static_cast<Index>(std::ranges::count_if(covered, [](const auto& c) { return !c.second; }));
}

}  // namespace

FaceMesh region_mesh(const Surface& surface, const ToolPathRegion& region, double spacing) {
  FaceMesh mesh = face_mesh(surface);
  for (Vec3& p : mesh.points) p = (1 / spacing) * p;
  const auto keep = [](FaceMesh& of, const std::vector<bool>& kept, const std::string& condition,
                       const std::string& remedy) {
    if (std::ranges::find(kept, true) == kept.end())
      throw InvalidArgument("region_empty", "no triangle lies in the region: none " + condition, remedy);
    if (std::ranges::find(kept, false) != kept.end()) of = part_of(of, kept);
  };
  if (!region.rows.empty()) {
    if (region.rows.size() != to_size(surface.rows().row_count()))
      throw InvalidArgument("the region has " + detail::counted(region.rows.size(), "row") + ", the surface " +
                            std::to_string(surface.rows().row_count()));
    std::vector<bool> inside(mesh.points.size(), true), kept(mesh.size());
    const auto row = [&](Index p) { return surface.rows().row(Vertex(mesh.vertices[to_size(p)])); };
    for (std::size_t p = 0; p < inside.size(); ++p)
      if (const auto r = row(static_cast<Index>(p))) inside[p] = region.rows[to_size(r->index)];
    // A point without a row, inside of a polygon, is in the region if all corners of the polygon are.
    for (const Triangle& face : mesh.faces)
      if (std::ranges::any_of(face, [&](Index p) { return row(p) && !inside[to_size(p)]; }))
        for (const Index p : face) inside[to_size(p)] = inside[to_size(p)] && row(p);
    for (std::size_t f = 0; f < kept.size(); ++f)
      kept[f] = std::ranges::all_of(mesh.faces[f], [&](Index p) { return inside[to_size(p)]; });
    keep(mesh, kept, "has all corners in the rows", "add rows");
  }
  if (region.facing) {
    const double length = norm(region.facing->direction);
    if (!(length > 0 && std::isfinite(length)))
      throw InvalidArgument("the direction of the region is zero or not finite");
    if (!(region.facing->angle >= 0 && region.facing->angle <= std::numbers::pi))
      throw InvalidArgument("the angle of the region is " +
                            detail::number(region.facing->angle * 180 / std::numbers::pi) +
                            " degrees; it must lie in [0, 180]");
    std::vector<bool> kept(mesh.size());
    for (std::size_t f = 0; f < kept.size(); ++f) {
      const Vec3 normal = mesh.area_normal(static_cast<Index>(f));
      const Vec3& direction = region.facing->direction;
      kept[f] = std::atan2(norm(cross(normal, direction)), dot(normal, direction)) <= region.facing->angle + 1e-9;
    }
    keep(mesh, kept,
         "has a normal within " + detail::number(region.facing->angle * 180 / std::numbers::pi) +
             " degrees of the direction",
         "enlarge the angle; where normals point into the part, reverse the direction");
  }
  const auto check_extent = [&] {
    const double across = extent(mesh);
    if (!std::isfinite(across))
      throw ResourceExhausted("the spacing, " + detail::number(spacing) +
                              ", is too small for double precision; enlarge it");
    if (across >= 1) return;
    throw InvalidArgument("spacing_too_large",
                          "the spacing, " + detail::number(spacing) + ", is larger than the region, " +
                              detail::number(spacing * across) + " across",
                          "choose a smaller spacing");
  };
  check_extent();
  check_faces(mesh, spacing);
  if (region.disc && region.enclosures.empty()) {  // the part around the center is all that a small disc needs
    std::vector<bool> kept(mesh.size());
    keep_near(surface, *region.disc, spacing, mesh, kept);
    keep(mesh, kept, "lies within the radius around the center", "enlarge the radius");
  }
  check_refinement(mesh, longest_side);
  const bool is_cut = !region.enclosures.empty() || region.disc;  // along the sides of short faces
  mesh = refined(mesh, is_cut ? longest_side : longest_window_side).mesh;
  for (const ToolPathRegion::Enclosure& enclosure : region.enclosures) {
    if (enclosure.points.size() < 3)
      throw InvalidArgument("region_not_enclosed",
                            "the curve of the region has " + detail::counted(enclosure.points.size(), "point"),
                            "a closed curve needs at least three");
    const PathDomain domain(std::move(mesh));
    const SurfaceCurve drawn = drawn_curve(surface, enclosure.points, true, spacing, "region", "region_off_surface");
    const MeshCurve curve = on_mesh(domain, drawn.points, true, spacing, "region", "region_off_surface");
    if (!curve.closed)
      throw InvalidArgument("region_off_surface", "the region curve leaves the part that the other conditions select",
                            "draw the curve there");
    mesh = enclosed_part(domain, curve, enclosure.outside);
    check_extent();
  }
  if (region.disc) {
    std::vector<bool> kept(mesh.size());
    keep_disc(surface, *region.disc, spacing, mesh, kept);
    keep(mesh, kept, "lies within the radius around the center", "enlarge the radius");
    check_extent();
  }
  return mesh;
}

ToolPath tool_path(const Surface& surface, const ToolPathOptions& options) {
  check(options);
  const PathDomain region(region_mesh(surface, options.region, options.spacing));
  const FineDomain domain(region);
  const std::vector<MeshCurve> seeds = std::visit(SeedFinder{surface, domain, options.spacing}, options.seed);
  if (const double across = options.spacing * extent(domain.mesh); options.tool_radius > across)
    throw InvalidArgument("tool_radius is " + detail::number(options.tool_radius) + "; the region is only " +
                          detail::number(across) + " across");
  const double phase = std::holds_alternative<BoundarySeed>(options.seed) ? 0.5 : 0;
  ToolPath path;
  path.spacing = options.spacing;
  path.uncovered_components = count_uncovered(domain, seeds);
  add_poses(surface, domain, make_passes(domain, seeds, phase, options.spiral, options.progress), options, path);
  return path;
}

}  // namespace ahm
