// The part of a surface that a tool path covers.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "tool_path/curves.hpp"
#include "tool_path/tool_path.hpp"

namespace ahm {
namespace {

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

/// The center of a disc, in spacings. Checks the disc.
Vec3 center_of(const Surface& surface, const ToolPathRegion::Disc& disc, double spacing) {
  check_positive("the radius of the region", disc.radius);
  return (1 / spacing) * surface.position(surface_point(surface, disc.center, spacing, "the center of the region",
                                                        "region_off_surface"));
}

/// Keeps the faces whose bounding boxes come within the radius of a disc, in space. They contain all that its radius reaches.
void keep_near(const Surface& surface, const ToolPathRegion::Disc& disc, double spacing, const FaceMesh& mesh,
               std::vector<bool>& kept) {
  const Vec3 center = center_of(surface, disc, spacing);
  for (std::size_t f = 0; f < mesh.size(); ++f) {
    const auto corner = [&](std::size_t c) { return mesh.points[to_size(mesh.faces[f][c])]; };
    BoundingBox box{corner(0), corner(0)};
    box.include(corner(1)), box.include(corner(2));
    kept[f] = box.distance_to(center) <= disc.radius / spacing;
  }
}

/// Keeps the faces within a distance along the surface of a point.
void keep_disc(const Surface& surface, const ToolPathRegion::Disc& disc, double spacing, const FaceMesh& mesh,
               std::vector<bool>& kept) {
  const PathDomain domain(mesh);
  const MeshTree::Hit center = MeshTree(domain.mesh).nearest(center_of(surface, disc, spacing));
  std::fill(kept.begin(), kept.end(), false);
  if (center.distance > largest_curve_distance) return;
  exact::ExactOptions options;
  options.radius = disc.radius / spacing;
  const exact::ExactMap map = exact::exact_map(domain.surface, center.point, options);
  for (std::size_t f = 0; f < mesh.size(); ++f)
    kept[f] = std::ranges::all_of(mesh.faces[f], [&](Index p) { return map.status(Vertex(p)) == Status::ok; });
}

}  // namespace

FaceMesh whole_mesh(const Surface& surface, double spacing) {
  FaceMesh mesh = face_mesh(surface);
  for (Vec3& p : mesh.points) p = (1 / spacing) * p;
  return mesh;
}

FaceMesh region_mesh(const Surface& surface, FaceMesh mesh, const ToolPathRegion& region, double spacing) {
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
    const double across = bounding_box(mesh.points).diagonal();
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

}  // namespace ahm
