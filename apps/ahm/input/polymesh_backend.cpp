#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "ahm/error.hpp"
#include "ahm/polymesh/polygon_mesh_graph.hpp"
#include "ahm/surface/directions.hpp"
#include "ahm/trimesh/triangle_mesh_graph.hpp"
#include "input/backend.hpp"
#include "input/mesh_input.hpp"

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

PolygonOptions polygon_options(const InputOptions& options, const Progress& progress) {
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
  PolymeshModel(const io::Geometry& input, const InputOptions& options, const std::optional<SourceSpec>& source,
                const Progress& progress)
      : input_(input), mesh_(check(input, options, source)) {
    if (options.discretization != "polygons") refinement_ = mesh_.refined();
    if (options.discretization == "polygons" || (options.discretization == "auto" && !refinement_.folded.empty())) {
      polygons_.emplace(PolygonMeshGraph::build(mesh_, polygon_options(options, progress)));
      warnings_ = polygons_->report().warnings;
      if (!refinement_.folded.empty()) warnings_.push_back(twisted() + ", so the polygons are not refined");
      return;
    }
    if (!refinement_.folded.empty()) throw InvalidGeometry(twisted() + "; use --discretization polygons");
    trimesh::MeshOptions mesh_options;
    mesh_options.intrinsic_delaunay = options.flips;
    mesh_options.threads = options.threads;
    mesh_options.progress = progress;
    triangles_.emplace(TriangleMeshGraph::build(refinement_.positions, refinement_.triangles, mesh_options));
    warnings_ = polymesh::topology_warnings(mesh_.report());
    for (const std::string& warning : triangles_->report().warnings)
      if (warning.find("components") == std::string::npos && warning.find("orientable") == std::string::npos)
        warnings_.push_back(warning);
  }

  const TangentGraph& graph() const override { return triangles_ ? triangles_->graph() : polygons_->graph(); }

  ResolvedSource source(const SourceSpec& spec, const std::optional<Vec3>& u_axis) const override try {
    if (const auto* face = std::get_if<SourceFace>(&spec)) return source_in_face(*face, u_axis);
    const auto* position = std::get_if<SourcePosition>(&spec);
    const Index row = position ? nearest_row(input_.points, mesh_.vertex_of_input(), position->position)
                               : std::get<SourceVertex>(spec).index;
    const Index vertex = mesh_.vertex_of_input()[row];
    if (vertex < 0) throw InvalidArgument(fmt::format("vertex {} is used by no face; choose another", row));
    const Frame frame = *graph().frame(vertex);
    ResolvedSource result{Source::at_vertex(Vertex(vertex)), row, input_.points[row],
                          u_axis ? turned(frame, *u_axis) : frame};
    if (u_axis)
      result.source =
          triangles_ ? triangles_->source_at_vertex(vertex, *u_axis) : polygons_->source_at_vertex(row, *u_axis);
    return result;
  } catch (const InvalidArgument& e) {
    throw InvalidArgument(fmt::format("--source {}: {}", to_string(spec), e.what()));
  }

  std::vector<RowVertex> row_vertices() const override {
    const auto rows = mesh_.input_of_vertex();
    std::vector<RowVertex> result;
    for (std::size_t v = 0; v < rows.size(); ++v) result.push_back({rows[v], static_cast<Index>(v)});
    return result;
  }

  std::vector<Index> corner_vertices() const override { return {mesh_.corners().begin(), mesh_.corners().end()}; }

  std::vector<Vec3> normals() const override {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<Vec3> result(input_.points.size(), Vec3{nan, nan, nan});
    const auto vertices = mesh_.vertex_of_input();
    for (std::size_t i = 0; i < result.size(); ++i)
      if (vertices[i] >= 0) result[i] = graph().frame(vertices[i])->normal;
    return result;
  }

  nlohmann::ordered_json report() const override;
  std::vector<std::string> warnings() const override { return warnings_; }

 private:
  static PolygonMesh check(const io::Geometry& input, const InputOptions& options,
                           const std::optional<SourceSpec>& source) {
    check_mesh_input("polymesh", input, options, source);
    try {
      return PolygonMesh::from_faces(input.points, input.face_begin, input.face_vertices,
                                     polygon_options(options, {}).non_manifold);
    } catch (const InvalidGeometry& e) {
      throw InvalidGeometry(in_terms_of_the_program(e.what()));
    }
  }

  std::string twisted() const {
    return fmt::format("{} faces are twisted, the first is face {}", refinement_.folded.size(),
                       refinement_.folded.front());
  }

  ResolvedSource source_in_face(const SourceFace& spec, const std::optional<Vec3>& u_axis) const {
    if (polygons_) {
      const Frame frame = polygons_->frame_at_face(spec.face, spec.weights);
      return {polygons_->source_at_face(spec.face, spec.weights, u_axis ? *u_axis : frame.x), std::nullopt,
              frame.origin, u_axis ? turned(frame, *u_axis) : frame};
    }
    const auto corners = input_.face(at(spec.face));
    Vec3 position{0, 0, 0};
    for (std::size_t c = 0; c < corners.size(); ++c)
      for (int a = 0; a < 3; ++a) position[a] += spec.weights[c] * input_.points[corners[c]][a];
    const trimesh::SurfacePoint point = locate(spec.face, position);
    const Vec3 u = u_axis ? *u_axis : minus(input_.points[corners[1]], input_.points[corners[0]]);
    const std::optional<Frame> frame = triangles_->frame_at(point);
    ResolvedSource result{triangles_->source_at(point, u), std::nullopt, position, frame};
    if (frame) result.frame = turned(*frame, u);
    return result;
  }

  /// The triangle of a face's refinement that a point of the face lies in, or next to.
  trimesh::SurfacePoint locate(Index face, const Vec3& position) const {
    trimesh::SurfacePoint best;
    double most = -std::numeric_limits<double>::infinity();
    for (Offset t = refinement_.face_begin[face]; t < refinement_.face_begin[at(face) + 1]; ++t) {
      const auto& [a, b, c] = refinement_.triangles[t];
      const auto weights =
          barycentric(position, refinement_.positions[a], refinement_.positions[b], refinement_.positions[c]);
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

  const io::Geometry& input_;
  PolygonMesh mesh_;
  polymesh::Refinement refinement_;
  std::optional<PolygonMeshGraph> polygons_;
  std::optional<TriangleMeshGraph> triangles_;  ///< either this or the one above
  std::vector<std::string> warnings_;
};

nlohmann::ordered_json PolymeshModel::report() const {
  const TopologyReport& t = mesh_.report();
  nlohmann::ordered_json j;
  j["discretization"] = triangles_ ? "refined" : "polygons";
  j["vertices"] = mesh_.vertex_count();
  j["faces"] = t.faces;
  Offset largest = 0;
  for (Index f = 0; f < mesh_.face_count(); ++f)
    largest = std::max(largest, mesh_.face_begin()[at(f) + 1] - mesh_.face_begin()[f]);
  j["largest_face"] = largest;
  j["components"] = t.components;
  j["boundary_loops"] = t.boundary_loops;
  j["orientable"] = t.orientable;
  j["reoriented"] = t.reoriented;
  j["unreferenced"] = t.unreferenced;
  j["non_manifold_edges"] = t.non_manifold_edges;
  j["non_manifold_vertices"] = t.non_manifold_vertices;
  if (triangles_) {
    const trimesh::MeshReport& r = triangles_->report();
    j["virtual_vertices"] = r.vertices - mesh_.vertex_count();
    j["flips"] = r.flips;
    j["mollification"] = r.mollification;
    j["seconds"] = {{"checks", r.seconds_checks}, {"delaunay", r.seconds_delaunay}, {"graph", r.seconds_graph}};
  } else {
    const polymesh::PolygonReport& r = polygons_->report();
    j["nonplanar_faces"] = r.nonplanar_faces;
    j["degenerate_faces"] = r.degenerate_faces;
    j["negative_weights"] = r.negative_weights;
    j["seconds"] = {{"graph", r.seconds_graph}};
  }
  return j;
}

}  // namespace

std::unique_ptr<Model> build_polymesh(const io::Geometry& input, const InputOptions& options,
                                      const std::optional<SourceSpec>& source, const Progress& progress) {
  return std::make_unique<PolymeshModel>(input, options, source, progress);
}

}  // namespace ahm::app
