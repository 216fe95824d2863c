#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "ahm/error.hpp"
#include "ahm/polymesh/polygon_mesh_graph.hpp"
#include "ahm/trimesh/triangle_mesh_graph.hpp"
#include "backend.hpp"
#include "frames.hpp"
#include "mesh_input.hpp"

namespace ahm::app {
namespace {

using polymesh::PolygonMesh;
using polymesh::PolygonMeshGraph;
using polymesh::PolygonOptions;
using trimesh::TriangleMeshGraph;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Where a position near a triangle lies in it: barycentric coordinates of its projection to the plane.
std::array<double, 3> barycentric(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = minus(b, a), v = minus(c, a), w = minus(p, a);
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v);
  const double area = uu * vv - uv * uv;
  const double s = (vv * wu - uv * wv) / area, t = (uu * wv - uv * wu) / area;
  return {1 - s - t, s, t};
}

PolygonOptions polygon_options(const LogmapOptions& options, const Progress& progress) {
  PolygonOptions result;
  result.non_manifold = options.non_manifold == "split" ? NonManifold::split : NonManifold::error;
  result.threads = options.threads;
  result.progress = progress;
  return result;
}

/// Polygons as they are, or refined by their virtual vertices and given to the triangle backend. Vertices of the mesh are
/// the first vertices of either graph.
class PolymeshModel final : public Model {
 public:
  PolymeshModel(const io::Geometry& input, const LogmapOptions& options, const Progress& progress)
      : points_(input.points), polygons_(build(input, options, progress)) {
    if (options.discretization == "polygons") return;
    refinement_ = polygons_.mesh().refined();
    if (!refinement_.folded.empty()) {
      if (options.discretization == "refined")
        throw InvalidGeometry(
            fmt::format("{} faces hide a side from their virtual vertex, the first is face {}; use "
                        "--discretization polygons",
                        refinement_.folded.size(), refinement_.folded.front()));
      warnings_.push_back(fmt::format("{} faces hide a side from their virtual vertex, so the polygons are not refined",
                                      refinement_.folded.size()));
      return;
    }
    trimesh::MeshOptions mesh_options;
    mesh_options.intrinsic_delaunay = options.flips;
    mesh_options.threads = options.threads;
    mesh_options.progress = progress;
    triangles_.emplace(TriangleMeshGraph::build(refinement_.positions, refinement_.triangles, mesh_options));
  }

  const TangentGraph& graph() const override { return triangles_ ? triangles_->graph() : polygons_.graph(); }

  ResolvedSource source(const SourceSpec& spec, const std::optional<Vec3>& u_axis) const override try {
    if (const auto* face = std::get_if<SourceFace>(&spec)) return source_in_face(*face, u_axis);
    const auto* position = std::get_if<SourcePosition>(&spec);
    const Index row = position ? nearest_row(points_, polygons_.mesh().vertex_of_input(), position->position)
                               : std::get<SourceVertex>(spec).index;
    const Index vertex = polygons_.vertex(row);
    const Frame frame = *graph().frame(vertex);
    ResolvedSource result{Source::at_vertex(vertex), row, points_[at(row)], u_axis ? turned(frame, *u_axis) : frame};
    if (u_axis)
      result.source =
          triangles_ ? triangles_->source_at_vertex(vertex, *u_axis) : polygons_.source_at_vertex(row, *u_axis);
    return result;
  } catch (const InvalidArgument& e) {
    throw InvalidArgument(fmt::format("--source {}: {}", to_string(spec), e.what()));
  }

  std::vector<RowVertex> row_vertices() const override {
    const auto rows = polygons_.mesh().input_of_vertex();
    std::vector<RowVertex> result;
    for (std::size_t v = 0; v < rows.size(); ++v) result.push_back({rows[v], static_cast<Index>(v)});
    return result;
  }

  std::vector<Vec3> normals() const override {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<Vec3> result(points_.size(), Vec3{nan, nan, nan});
    const auto vertices = polygons_.mesh().vertex_of_input();
    for (std::size_t i = 0; i < result.size(); ++i)
      if (vertices[i] >= 0) result[i] = polygons_.graph().frame(vertices[i])->normal;
    return result;
  }

  nlohmann::ordered_json report() const override;
  std::vector<std::string> warnings() const override {
    std::vector<std::string> result = polygons_.report().warnings;
    result.insert(result.end(), warnings_.begin(), warnings_.end());
    return result;
  }

 private:
  static PolygonMeshGraph build(const io::Geometry& input, const LogmapOptions& options, const Progress& progress) {
    check_mesh_input("polymesh", input, options);
    try {
      return PolygonMeshGraph::build(input.points, input.face_begin, input.face_vertices,
                                     polygon_options(options, progress));
    } catch (const InvalidGeometry& e) {
      throw InvalidGeometry(in_terms_of_the_program(e.what()));
    }
  }

  ResolvedSource source_in_face(const SourceFace& spec, const std::optional<Vec3>& u_axis) const {
    const Frame frame = polygons_.frame_at_face(spec.face, spec.weights);
    ResolvedSource result{Source(2), std::nullopt, frame.origin, u_axis ? turned(frame, *u_axis) : frame};
    const Vec3 u = u_axis ? *u_axis : frame.x;
    result.source = triangles_ ? triangles_->source_at(locate(spec.face, frame.origin), u)
                               : polygons_.source_at_face(spec.face, spec.weights, u);
    return result;
  }

  /// The triangle of a face's refinement that a point of the face lies in, or next to.
  trimesh::SurfacePoint locate(Index face, const Vec3& position) const {
    trimesh::SurfacePoint best;
    double most = -std::numeric_limits<double>::infinity();
    for (Offset t = refinement_.face_begin[at(face)]; t < refinement_.face_begin[at(face) + 1]; ++t) {
      const auto& [a, b, c] = refinement_.triangles[static_cast<std::size_t>(t)];
      const auto weights = barycentric(position, refinement_.positions[at(a)], refinement_.positions[at(b)],
                                       refinement_.positions[at(c)]);
      const double least = std::min({weights[0], weights[1], weights[2]});
      if (!(least > most)) continue;
      most = least;
      best = {static_cast<Index>(t), weights};
    }
    double sum = 0;
    for (double& w : best.barycentric) sum += w = std::max(w, 0.0);
    for (double& w : best.barycentric) w /= sum;
    return best;
  }

  const std::vector<Vec3>& points_;
  PolygonMeshGraph polygons_;
  polymesh::Refinement refinement_;
  std::optional<TriangleMeshGraph> triangles_;
  std::vector<std::string> warnings_;
};

nlohmann::ordered_json PolymeshModel::report() const {
  const polymesh::PolygonReport& r = polygons_.report();
  nlohmann::ordered_json j;
  j["discretization"] = triangles_ ? "refined" : "polygons";
  j["vertices"] = r.vertices;
  j["faces"] = r.topology.faces;
  j["triangles"] = r.triangles;
  j["largest_face"] = r.largest_face;
  j["nonplanar_faces"] = r.nonplanar_faces;
  j["degenerate_faces"] = r.degenerate_faces;
  j["negative_weights"] = triangles_ ? 0 : r.negative_weights;
  j["components"] = r.topology.components;
  j["boundary_loops"] = r.topology.boundary_loops;
  j["orientable"] = r.topology.orientable;
  j["reoriented"] = r.topology.reoriented;
  j["unreferenced"] = r.topology.unreferenced;
  j["non_manifold_edges"] = r.topology.non_manifold_edges;
  j["non_manifold_vertices"] = r.topology.non_manifold_vertices;
  j["seconds"] = {{"checks", r.seconds_checks}, {"graph", r.seconds_graph}};
  if (triangles_) {
    j["virtual_vertices"] = triangles_->report().vertices - r.vertices;
    j["flips"] = triangles_->report().flips;
    j["mollification"] = triangles_->report().mollification;
    j["seconds"]["triangles"] = triangles_->report().seconds_checks + triangles_->report().seconds_delaunay +
                                triangles_->report().seconds_graph;
  }
  return j;
}

}  // namespace

std::unique_ptr<Model> build_polymesh(const io::Geometry& input, const LogmapOptions& options,
                                      const Progress& progress) {
  return std::make_unique<PolymeshModel>(input, options, progress);
}

}  // namespace ahm::app
