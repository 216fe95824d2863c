#include "ahm/pointcloud/point_cloud_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/util/stopwatch.hpp"
#include "ahm/util/text.hpp"
#include "clean_points.hpp"
#include "local_delaunay.hpp"
#include "orientation.hpp"
#include "tangent_edges.hpp"
#include "tangent_planes.hpp"
#include "tufted_cover.hpp"
#include "vec3.hpp"

namespace ahm::pointcloud {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

void check_arguments(std::span<const Vec3> points, std::span<const Vec3> normals, const CloudOptions& options) {
  if (points.size() < 3)
    throw InvalidGeometry("the cloud has " + std::to_string(points.size()) + " points; at least 3 are needed");
  if (!normals.empty() && normals.size() != points.size())
    throw InvalidArgument("'normals' has " + std::to_string(normals.size()) + " entries for " +
                          std::to_string(points.size()) + " points; give none or one per point");
  if (options.k < 3)
    throw InvalidArgument("k is " + std::to_string(options.k) + "; it must be at least 3 (default 30)");
  if (!(options.max_edge_ratio >= 1))
    throw InvalidArgument("max_edge_ratio is " + detail::number(options.max_edge_ratio) +
                          "; it must be at least 1 (default 3)");
}

/// "12, 15, 17 and 240 more"
std::string first_ten(const std::vector<Index>& indices) {
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(indices.size(), 10); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(indices[i]);
  return indices.size() > 10 ? text + " and " + std::to_string(indices.size() - 10) + " more" : text;
}

/// Whether neighbours whose normals are opposed are kept apart.
bool cut_between_sheets(std::span<const Vec3> given, const CleanPoints& cloud, const TangentPlanes& planes,
                        const Neighborhoods& neighborhoods, const CloudOptions& options) {
  if (given.empty() || options.normal_signs == NormalSigns::unoriented) return false;
  return options.normal_signs == NormalSigns::oriented || have_thin_walls(cloud, planes, neighborhoods);
}

/// Makes the signs of the normals consistent, unless the given ones are to be kept.
void orient(const CleanPoints& cloud, const WeightedEdges& edges, std::span<const Vec3> given, bool cut,
            const CloudOptions& options, TangentPlanes& planes, CloudReport& report) {
  report.oriented = cut;
  if (cut) return;
  const bool signs_given = !given.empty() && options.normal_signs == NormalSigns::automatic;
  report.turned = orient_normals(cloud, edges, signs_given, planes);
  report.oriented = signs_given && report.turned == 0;
  if (!signs_given) report.turned = 0;
  if (report.turned > 0)
    report.warnings.push_back(std::to_string(report.turned) +
                              " given normals point to the other side than the majority around them and were turned");
}

/// Numbers the points that have a mass; lists the input points that have none.
std::vector<Index> number_vertices(const CleanPoints& cloud, const WeightedEdges& edges,
                                   std::vector<Index>& point_of_vertex, CloudReport& report) {
  std::vector<Index> vertex_of_clean(cloud.points.size(), -1), removed;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (edges.masses[i] > 0) {
      vertex_of_clean[i] = static_cast<Index>(point_of_vertex.size());
      point_of_vertex.push_back(cloud.input[i]);
    } else {
      removed.push_back(cloud.input[i]);
    }
  }
  report.vertices = static_cast<Index>(point_of_vertex.size());
  report.degenerate = static_cast<Index>(removed.size());
  std::sort(removed.begin(), removed.end());
  if (report.vertices == 0)
    throw InvalidGeometry(
        "no point of the cloud has a tangent plane with a triangle in it: the points lie on a line, or are too "
        "far apart from each other (points " +
        first_ten(removed) + ")");
  if (!removed.empty())
    report.warnings.push_back(
        std::to_string(removed.size()) +
        " points have collinear or isolated neighbourhoods and were removed: " + first_ten(removed));
  return vertex_of_clean;
}

void fill_vertex_data(CsrGraphData& g, std::span<const Vec3> input, const CleanPoints& cloud,
                      const TangentPlanes& planes, const WeightedEdges& edges,
                      const std::vector<Index>& vertex_of_clean) {
  g.length_unit = cloud.unit;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (vertex_of_clean[i] < 0) continue;
    const PlaneAxes axes(planes.normals[i]);
    g.masses.push_back(edges.masses[i]);
    g.frames.push_back({input[cloud.input[i]], axes.x, axes.y, planes.normals[i]});
  }
}

void add_warnings(CloudReport& report, Index k_asked) {
  auto warn = [&](auto count, const char* text) {
    if (count > 0) report.warnings.push_back(std::to_string(count) + text);
  };
  if (report.k < k_asked)
    report.warnings.push_back("k = " + std::to_string(k_asked) + " was reduced to " + std::to_string(report.k) +
                              ": the cloud has only " + std::to_string(report.k + 1) + " distinct points");
  warn(report.non_finite, " points with NaN or infinite coordinates were removed");
  warn(report.duplicates, " duplicate points were merged");
  warn(report.rejected_normals, " pairs of neighbours were not joined because their normals disagree (thin walls)");
  warn(report.reflections, " edges join oppositely oriented normals and are treated as reflections");
  if (report.components > 1)
    report.warnings.push_back("the cloud falls into " + std::to_string(report.components) +
                              " components; a map covers those that hold its source");
}

}  // namespace

PointCloudGraph::PointCloudGraph(CsrGraph graph, CloudReport report, std::vector<Index> vertex_of_point,
                                 std::vector<Index> point_of_vertex)
    : graph_(std::make_unique<const CsrGraph>(std::move(graph))),
      report_(std::move(report)),
      vertex_of_point_(std::move(vertex_of_point)),
      point_of_vertex_(std::move(point_of_vertex)) {}

PointCloudGraph PointCloudGraph::build(std::span<const Vec3> points, std::span<const Vec3> normals,
                                       const CloudOptions& options) try {
  check_arguments(points, normals, options);
  CloudReport report;
  detail::Stopwatch stopwatch;
  CleanPoints cloud = clean_points(points, options, report);
  const auto search = options.search ? options.search(cloud.points) : nullptr;
  if (!search) throw InvalidArgument("options.search made no neighbour search; default: nanoflann_search");
  options.progress.step("neighbours", 0.0);
  Neighborhoods neighborhoods = find_neighborhoods(cloud, *search, options);
  report.k = neighborhoods.k;
  TangentPlanes planes = find_tangent_planes(cloud, normals, *search, neighborhoods, options);
  if (!normals.empty() && planes.estimated > 0)
    report.warnings.push_back(std::to_string(planes.estimated) +
                              " given normals are zero or not finite and were estimated");
  if (planes.estimated == static_cast<Index>(cloud.points.size())) normals = {};
  const bool cut = cut_between_sheets(normals, cloud, planes, neighborhoods, options);
  report.seconds_normals = stopwatch.lap();

  std::vector<Triangle> triangles = local_delaunay(cloud, neighborhoods, planes, cut, options, report);
  report.seconds_delaunay = stopwatch.lap();
  neighborhoods = {};

  const WeightedEdges edges = triangles.empty()
                                  ? WeightedEdges{{}, {}, {}, std::vector<double>(cloud.points.size(), 0.0)}
                                  : tufted_laplacian(cloud, planes, triangles, report);
  triangles = {};
  report.mollification *= cloud.unit;
  options.progress.step("laplacian", 1.0);
  report.seconds_laplacian = stopwatch.lap();

  std::vector<Index> point_of_vertex;
  const std::vector<Index> vertex_of_clean = number_vertices(cloud, edges, point_of_vertex, report);
  orient(cloud, edges, normals, cut, options, planes, report);
  CsrGraphData data = tangent_edges(cloud, planes, edges, vertex_of_clean, report.vertices, report.oriented,
                                    options.edge_length, options.threads, report);
  fill_vertex_data(data, points, cloud, planes, edges, vertex_of_clean);
  CsrGraph graph(std::move(data));
  report.components = connected_components(graph).count;
  add_warnings(report, options.k);

  std::vector<Index> vertex_of_point(points.size(), -1);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (cloud.clean_of_input[i] >= 0) vertex_of_point[i] = vertex_of_clean[cloud.clean_of_input[i]];
  options.progress.step("graph", 1.0);
  report.seconds_graph = stopwatch.lap();
  return PointCloudGraph(std::move(graph), std::move(report), std::move(vertex_of_point), std::move(point_of_vertex));
} catch (const std::bad_alloc&) {
  throw ResourceExhausted("out of memory while building the graph of a cloud of " + std::to_string(points.size()) +
                          " points");
}

Source PointCloudGraph::source_at_point(Index point) const {
  if (point < 0 || static_cast<std::size_t>(point) >= vertex_of_point_.size())
    throw InvalidArgument("source point " + std::to_string(point) + " is outside [0, " +
                          std::to_string(vertex_of_point_.size()) + ")");
  const Index vertex = vertex_of_point_[point];
  if (vertex < 0)
    throw InvalidArgument("source point " + std::to_string(point) +
                          " was removed (not finite, or without a tangent plane); choose another");
  return Source::at_vertex(Vertex(vertex));
}

Source PointCloudGraph::source_at_point(Index point, const Vec3& u_direction) const {
  const Vertex vertex = source_at_point(point).vertices()[0];
  const Frame frame = *graph_->frame(vertex.index);
  const double direction[] = {dot(frame.x, u_direction), dot(frame.y, u_direction)};
  if (!(std::hypot(direction[0], direction[1]) > 1e-9 * norm(u_direction)))
    throw InvalidArgument("the u direction is zero or perpendicular to the tangent plane at point " +
                          std::to_string(point));
  return Source::at_vertex(vertex, direction);
}

Index PointCloudGraph::nearest_point(const Vec3& position) const {
  if (!std::isfinite(position[0]) || !std::isfinite(position[1]) || !std::isfinite(position[2]))
    throw InvalidArgument("the source position is not finite");
  Index best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (Index vertex = 0; vertex < graph_->size(); ++vertex) {
    const Vec3 offset = graph_->data().frames[vertex].origin - position;
    const double distance = std::hypot(offset[0], offset[1], offset[2]);
    if (distance < least) {
      least = distance;
      best = vertex;
    }
  }
  return point_of_vertex_[best];
}

PointMap PointCloudGraph::on_points(const LogMap& map) const {
  if (map.size() != graph_->size() || map.dimension() != 2)
    throw InvalidArgument("on_points: the map has " + std::to_string(map.size()) +
                          " vertices, this cloud's graph has " + std::to_string(graph_->size()) +
                          ": it belongs to another graph");
  const std::size_t n = vertex_of_point_.size();
  PointMap result{std::vector<double>(n, nan), std::vector<double>(n, nan), std::vector<double>(n, nan),
                  std::vector<double>(n, nan), std::vector<Status>(n, Status::removed)};
  for (std::size_t i = 0; i < n; ++i) {
    const Index vertex = vertex_of_point_[i];
    if (vertex < 0) continue;
    result.status[i] = map.status(Vertex(vertex));
    if (result.status[i] != Status::ok) continue;
    const auto phi = map.coordinates(Vertex(vertex));
    result.u[i] = phi[0];
    result.v[i] = phi[1];
    result.distance[i] = std::hypot(phi[0], phi[1]);
    result.angle[i] = std::atan2(phi[1], phi[0]);
  }
  return result;
}

std::vector<Vec3> PointCloudGraph::normals_on_points() const {
  std::vector<Vec3> normals(vertex_of_point_.size(), Vec3{nan, nan, nan});
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (vertex_of_point_[i] >= 0) normals[i] = graph_->data().frames[vertex_of_point_[i]].normal;
  return normals;
}

}  // namespace ahm::pointcloud
