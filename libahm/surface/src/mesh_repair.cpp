#include "ahm/surface/mesh_repair.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/surface/detail/gluing.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/util/disjoint_sets.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "ahm/util/weld.hpp"

namespace ahm {
namespace {

std::vector<Index> weld_vertices(std::span<const Vec3> positions, const std::optional<double>& reach) {
  std::vector<Index> result(positions.size());
  std::iota(result.begin(), result.end(), 0);
  if (!reach) return result;
  const detail::MergedPoints welded = *reach > 0 ? detail::weld(positions, *reach) : detail::weld(positions);
  for (std::size_t v = 0; v < result.size(); ++v) result[v] = welded.first[welded.number[v]];
  return result;
}

/// The corners of a face without those at the same vertex as the corner before.
std::vector<Index> remove_repeated_corners(std::span<const Index> face, const std::vector<Index>& joined) {
  std::vector<Index> corners;
  for (Index v : face)
    if (corners.empty() || corners.back() != joined[v]) corners.push_back(joined[v]);
  while (corners.size() > 1 && corners.back() == corners.front()) corners.pop_back();
  return corners;
}

bool is_simple(std::vector<Index> corners) {
  std::sort(corners.begin(), corners.end());
  return corners.size() >= 3 && std::adjacent_find(corners.begin(), corners.end()) == corners.end();
}

void add(std::span<const Index> corners, Index given, RepairedMesh& mesh) {
  mesh.face_vertices.insert(mesh.face_vertices.end(), corners.begin(), corners.end());
  mesh.face_begin.push_back(static_cast<Offset>(mesh.face_vertices.size()));
  mesh.given_face.push_back(given);
}

/// All faces, or only those that are not degenerate, as the options require.
RepairedMesh clean_faces(std::span<const Vec3> positions, const FaceList& faces, const RepairOptions& options) {
  RepairedMesh mesh;
  mesh.joined = weld_vertices(positions, options.weld);
  for (std::size_t v = 0; v < positions.size(); ++v) mesh.counts.welded += mesh.joined[v] != static_cast<Index>(v);
  mesh.face_begin = {0};
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto given = static_cast<Index>(f);
    if (!options.drop_degenerate && !options.weld) {
      add(faces[f], given, mesh);
      continue;
    }
    const std::vector<Index> corners = remove_repeated_corners(faces[f], mesh.joined);
    const bool finite =
        std::ranges::all_of(faces[f], [&](Index v) { return is_finite(positions[v]); }) || !options.drop_degenerate;
    if (!finite || !is_simple(corners)) {
      ++(finite ? mesh.counts.degenerate : mesh.counts.not_finite);
      continue;
    }
    mesh.counts.repeated_corners += corners.size() < faces[f].size();
    add(corners, given, mesh);
  }
  return mesh;
}

void drop_duplicates(std::span<const Vec3> positions, RepairedMesh& mesh) {
  if (mesh.given_face.empty()) return;
  const auto pairs = detail::find_duplicates(static_cast<Index>(positions.size()), mesh.faces());
  std::vector<bool> drop(mesh.given_face.size(), false);
  for (const auto& [later, earlier] : pairs) drop[later] = true;
  RepairedMesh rest;
  rest.face_begin = {0};
  for (std::size_t f = 0; f < drop.size(); ++f) {
    if (drop[f])
      ++mesh.counts.duplicates;
    else
      add(mesh.faces()[f], mesh.given_face[f], rest);
  }
  mesh.face_begin = std::move(rest.face_begin);
  mesh.face_vertices = std::move(rest.face_vertices);
  mesh.given_face = std::move(rest.given_face);
}

/// A part of the mesh: faces connected over edges, stored at its first face.
struct Part {
  double volume = 0;  ///< six times the enclosed volume, in units of the mesh's size; positive for outward orientation
  bool closed = true, orientable = true;
};

class Orientation {
 public:
  Orientation(std::span<const Vec3> positions, const RepairedMesh& mesh)
      : glued_(static_cast<Index>(positions.size()), mesh.faces(), NonManifold::split),
        faces_(mesh.given_face.size()),
        parts_(mesh.given_face.size()) {
    const detail::HalfEdges edges = glued_.half_edges();
    for (detail::Half h = 0; h < edges.size(); ++h)
      if (edges.twin[h] >= 0) faces_.join(glued_.face_of(h), glued_.face_of(edges.twin[h]));
    for (detail::Half h = 0; h < edges.size(); ++h) {
      Part& part = parts_[faces_.root(glued_.face_of(h))];
      if (edges.twin[h] < 0) part.closed = false;
      if (edges.is_mirrored(h)) part.orientable = false;
    }
    add_volumes(positions, mesh);
  }

  bool turns(Index face) {
    const Part& part = parts_[faces_.root(face)];
    return part.orientable && static_cast<bool>(glued_.reversed()[face]) != (part.closed && part.volume < 0);
  }

 private:
  /// Computes each part's volume about its own first corner, so that parts far from the origin keep their digits.
  void add_volumes(std::span<const Vec3> positions, const RepairedMesh& mesh) {
    double size = 0;
    for (Index v : mesh.face_vertices) size = std::max(size, largest(positions[v]));
    const double scale = size > 0 ? 1 / power_of_two_below(size) : 1;
    for (std::size_t f = 0; f < parts_.size(); ++f) {
      const Index root = faces_.root(static_cast<Index>(f));
      const Vec3 origin = scale * positions[mesh.faces()[root][0]];
      const auto corner = [&](std::size_t c) { return scale * positions[mesh.faces()[f][c]] - origin; };
      double volume = 0;
      for (std::size_t c = 2; c < mesh.faces()[f].size(); ++c)
        volume += dot(corner(0), cross(corner(c - 1), corner(c)));
      parts_[root].volume += glued_.reversed()[f] ? -volume : volume;
    }
  }

  detail::GluedMesh glued_;
  detail::DisjointSets faces_;
  std::vector<Part> parts_;  ///< per face: valid at the root of each part
};

/// Reverses faces. The first corner of a face stays first.
void orient(std::span<const Vec3> positions, RepairedMesh& mesh) {
  if (mesh.given_face.empty()) return;
  Orientation orientation(positions, mesh);
  for (std::size_t f = 0; f < mesh.given_face.size(); ++f) {
    if (!orientation.turns(static_cast<Index>(f))) continue;
    std::reverse(mesh.face_vertices.begin() + mesh.face_begin[f] + 1,
                 mesh.face_vertices.begin() + mesh.face_begin[f + 1]);
    ++mesh.counts.reversed;
  }
}

}  // namespace

std::optional<Index> RepairedMesh::remaining(Index given) const {
  const auto place = std::lower_bound(given_face.begin(), given_face.end(), given);
  if (place == given_face.end() || *place != given) return std::nullopt;
  return static_cast<Index>(place - given_face.begin());
}

RepairedMesh repair_mesh(std::span<const Vec3> positions, const FaceList& faces, const RepairOptions& options) {
  if (options.weld && !(*options.weld >= 0 && std::isfinite(*options.weld)))
    throw InvalidArgument("weld is " + std::to_string(*options.weld) + "; it must be finite and >= 0");
  if (const auto faults = detail::find_faults(static_cast<Index>(positions.size()), faces); !faults.outside.empty())
    throw InvalidGeometry("face " + std::to_string(faults.outside.front()) + " has a vertex outside [0, " +
                          std::to_string(positions.size()) + ")");
  RepairedMesh mesh = clean_faces(positions, faces, options);
  if (options.drop_duplicates) drop_duplicates(positions, mesh);
  if (options.orient) orient(positions, mesh);
  return mesh;
}

namespace {

RowMap rows_of(const Surface& built, const RepairedMesh& mesh) {
  std::vector<RowVertex> pairs;
  for (std::size_t r = 0; r < mesh.joined.size(); ++r)
    for (Vertex vertex : built.rows().vertices(Row(mesh.joined[r])))
      pairs.push_back({Row(static_cast<Index>(r)), vertex});
  return RowMap(static_cast<Index>(mesh.joined.size()), built.rows().vertex_count(), pairs);
}

/// Number of vertices whose representative is in no face.
double unreferenced(const RepairedMesh& mesh) {
  std::vector<bool> used(mesh.joined.size(), false);
  for (Index v : mesh.face_vertices) used[v] = true;
  double count = 0;
  for (Index v : mesh.joined) count += !used[v];
  return count;
}

}  // namespace

RepairedSurface::RepairedSurface(std::unique_ptr<const Surface> built, std::vector<Vec3> positions, RepairedMesh mesh)
    : built_(std::move(built)), positions_(std::move(positions)), mesh_(std::move(mesh)) {
  const auto rows = static_cast<std::size_t>(built_->rows().row_count());
  if (rows != mesh_.joined.size() || rows != positions_.size())
    throw InvalidArgument("the surface has " + detail::counted(rows, "row") + ", the repaired mesh " +
                          detail::counted(mesh_.joined.size(), "vertex") + " and " + std::to_string(positions_.size()) +
                          " positions; these numbers must agree");
  rows_ = rows_of(*built_, mesh_);
}

FlatTriangles RepairedSurface::flat_triangles() const { return built_->flat_triangles(); }

FlatTriangles RepairedSurface::flat_approximation() const { return built_->flat_approximation(); }

Report RepairedSurface::report() const {
  Report report = built_->report();
  const RepairCounts& c = mesh_.counts;
  report.push_back({"repair.welded", c.welded});
  report.push_back({"repair.repeated_corners", c.repeated_corners});
  report.push_back({"repair.degenerate", c.degenerate});
  report.push_back({"repair.not_finite", c.not_finite});
  report.push_back({"repair.duplicates", c.duplicates});
  report.push_back({"repair.reversed", c.reversed});
  return report;
}

std::vector<Warning> RepairedSurface::warnings() const {
  std::vector<Warning> result;
  const auto warn = [&](std::string_view id, double count) {
    if (count > 0) result.push_back({id, {count}, {}});
  };
  const RepairCounts& c = mesh_.counts;
  warn("welded", c.welded);
  warn("repeated_corners", c.repeated_corners);
  warn("degenerate_dropped", c.degenerate);
  warn("not_finite_dropped", c.not_finite);
  warn("duplicates_dropped", c.duplicates);
  warn("faces_reversed", c.reversed);
  for (Warning& warning : built_->warnings())
    warning.id == "unreferenced" ? warn(warning.id, unreferenced(mesh_)) : result.push_back(std::move(warning));
  return result;
}

SurfaceSource RepairedSurface::source_in_face(const FacePoint& point, const std::optional<Vec3>& u_axis) const {
  return built_->source(point, u_axis);
}

SurfaceSource RepairedSurface::source_on_edge(const EdgePoint& point, const std::optional<Vec3>& u_axis) const {
  return built_->source(joined(point), u_axis);
}

Sample RepairedSurface::sample_in_face(const LogMap& map, const FacePoint& point) const {
  return built_->at(map, point);
}

exact::MeshPoint RepairedSurface::flat_point_in_face(const FacePoint& point) const { return built_->flat_point(point); }

FacePoint RepairedSurface::face_point(const EdgePoint& point) const { return Surface::face_point(joined(point)); }

EdgePoint RepairedSurface::joined(const EdgePoint& point) const {
  EdgePoint result = point;
  result.from = Row(mesh_.joined[point.from.index]);
  result.to = Row(mesh_.joined[point.to.index]);
  return result;
}

}  // namespace ahm
