#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "ahm/error.hpp"
#include "ahm/surface/directions.hpp"
#include "ahm/trimesh/triangle_mesh_graph.hpp"
#include "input/backend.hpp"
#include "input/mesh_input.hpp"

namespace ahm::app {
namespace {

using trimesh::MeshOptions;
using trimesh::SurfacePoint;
using trimesh::TriangleMeshGraph;

std::vector<Triangle> triangles(const io::Geometry& input) {
  std::vector<Triangle> result;
  result.reserve(input.face_count());
  for (std::size_t f = 0; f < input.face_count(); ++f) {
    const auto face = input.face(f);
    if (face.size() != 3)
      throw InvalidGeometry(
          fmt::format("face {} has {} corners; --backend trimesh takes triangles only", f, face.size()));
    result.push_back({face[0], face[1], face[2]});
  }
  return result;
}

MeshOptions mesh_options(const InputOptions& options, const Progress& progress) {
  MeshOptions result;
  result.intrinsic_delaunay = options.flips;
  result.non_manifold = options.non_manifold == "split" ? trimesh::NonManifold::split : trimesh::NonManifold::error;
  result.threads = options.threads;
  result.progress = progress;
  return result;
}

class TrimeshModel final : public Model {
 public:
  TrimeshModel(const io::Geometry& input, const InputOptions& options, const std::optional<SourceSpec>& source,
               const Progress& progress)
      : points_(input.points), mesh_(build(input, options, source, progress)) {}

  const TangentGraph& graph() const override { return mesh_.graph(); }

  ResolvedSource source(const SourceSpec& spec, const std::optional<Vec3>& u_axis) const override try {
    if (const auto* face = std::get_if<SourceFace>(&spec)) {
      const SurfacePoint point{face->face, {face->weights[0], face->weights[1], face->weights[2]}};
      const std::optional<Frame> frame = mesh_.frame_at(point);
      return {u_axis ? mesh_.source_at(point, *u_axis) : mesh_.source_at(point), std::nullopt, frame->origin,
              u_axis ? turned(*frame, *u_axis) : *frame};
    }
    const auto* position = std::get_if<SourcePosition>(&spec);
    const Index row = position ? nearest_row(points_, mesh_.mesh().vertex_of_input(), position->position)
                               : std::get<SourceVertex>(spec).index;
    const Frame frame = *mesh_.graph().frame(mesh_.vertex(row).index);
    return {u_axis ? mesh_.source_at_vertex(row, *u_axis) : mesh_.source_at_vertex(row), row, points_[row],
            u_axis ? turned(frame, *u_axis) : frame};
  } catch (const InvalidArgument& e) {
    throw InvalidArgument(fmt::format("--source {}: {}", to_string(spec), e.what()));
  }

  std::vector<RowVertex> row_vertices() const override {
    const auto rows = mesh_.mesh().input_of_vertex();
    std::vector<RowVertex> result;
    for (std::size_t v = 0; v < rows.size(); ++v) result.push_back({rows[v], static_cast<Index>(v)});
    return result;
  }

  std::vector<Index> corner_vertices() const override {
    const auto tails = mesh_.mesh().tails();
    return {tails.begin(), tails.end()};
  }

  std::vector<Vec3> normals() const override {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<Vec3> result(points_.size(), Vec3{nan, nan, nan});
    const auto vertices = mesh_.mesh().vertex_of_input();
    for (std::size_t i = 0; i < result.size(); ++i)
      if (vertices[i] >= 0) result[i] = mesh_.graph().frame(vertices[i])->normal;
    return result;
  }

  nlohmann::ordered_json report() const override;
  std::vector<std::string> warnings() const override { return mesh_.report().warnings; }

 private:
  static TriangleMeshGraph build(const io::Geometry& input, const InputOptions& options,
                                 const std::optional<SourceSpec>& source, const Progress& progress) {
    check_mesh_input("trimesh", input, options, source);
    try {
      return TriangleMeshGraph::build(input.points, triangles(input), mesh_options(options, progress));
    } catch (const InvalidGeometry& e) {
      throw InvalidGeometry(in_terms_of_the_program(e.what()));
    }
  }

  const std::vector<Vec3>& points_;
  TriangleMeshGraph mesh_;
};

nlohmann::ordered_json TrimeshModel::report() const {
  const trimesh::MeshReport& r = mesh_.report();
  nlohmann::ordered_json j;
  j["vertices"] = r.vertices;
  j["faces"] = r.topology.faces;
  j["edges"] = r.edges;
  j["flips"] = r.flips;
  j["mollification"] = r.mollification;
  j["degenerate_faces"] = r.degenerate_faces;
  j["components"] = r.topology.components;
  j["boundary_loops"] = r.topology.boundary_loops;
  j["orientable"] = r.topology.orientable;
  j["reoriented"] = r.topology.reoriented;
  j["unreferenced"] = r.topology.unreferenced;
  j["non_manifold_edges"] = r.topology.non_manifold_edges;
  j["non_manifold_vertices"] = r.topology.non_manifold_vertices;
  j["seconds"] = {{"checks", r.seconds_checks}, {"delaunay", r.seconds_delaunay}, {"graph", r.seconds_graph}};
  return j;
}

}  // namespace

std::unique_ptr<Model> build_trimesh(const io::Geometry& input, const InputOptions& options,
                                     const std::optional<SourceSpec>& source, const Progress& progress) {
  return std::make_unique<TrimeshModel>(input, options, source, progress);
}

}  // namespace ahm::app
