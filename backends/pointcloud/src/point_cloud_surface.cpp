#include "ahm/pointcloud/point_cloud_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/surface/detail/gluing.hpp"
#include "ahm/surface/directions.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/stopwatch.hpp"
#include "ahm/util/text.hpp"
#include "clean_points.hpp"
#include "local_delaunay.hpp"
#include "noise.hpp"
#include "orientation.hpp"
#include "sheet_triangles.hpp"
#include "tangent_edges.hpp"
#include "tangent_planes.hpp"
#include "tufted_cover.hpp"

namespace ahm::pointcloud {
namespace {

/// A cloud is not a surface if more than this fraction of its points has neighborhoods as thick as wide.
constexpr double thick_share = 0.15;
/// Above this fraction of the mean edge length, the noise of offsets makes the median vector of polar maps less accurate than
/// that of heat maps (docs/concepts/accuracy.md). Offsets have sqrt(2) times the noise of the points.
constexpr double noise_for_heat = 0.5;
/// Local triangulations agree in at least 0.87 of their triangles on surfaces, and in 0.48 to 0.77 on foliage, scanned
/// buildings and sheets one spacing apart.
constexpr double min_agreement = 0.8;
/// Coordinate steps above `coarse_step` times the mean edge length hide the surface. Steps above `grid_step` times it also
/// occur on regular grids.
constexpr double coarse_step = 0.1, grid_step = 0.4;

void check_arguments(std::span<const Vec3> points, const CloudOptions& options) {
  if (points.size() < 3)
    throw InvalidGeometry("the cloud has " + detail::counted(points.size(), "point") + "; at least 3 are needed");
  if (options.k && *options.k < 3)
    throw InvalidArgument("k is " + std::to_string(*options.k) + "; it must be at least 3 (default 30)");
  if (!(options.max_edge_ratio >= 1))
    throw InvalidArgument("max_edge_ratio is " + detail::number(options.max_edge_ratio) +
                          "; it must be at least 1 (default 3)");
  if (options.smooth && !(*options.smooth >= 0 && std::isfinite(*options.smooth)))
    throw InvalidArgument("smooth is " + detail::number(*options.smooth) +
                          "; give a radius in world units, 0 for none, or leave it unset for an automatic choice");
}

/// The points to build from, and their rows in the input.
class KeptPoints {
 public:
  KeptPoints(std::span<const Vec3> points, std::span<const Vec3> normals, const std::optional<std::vector<Row>>& rows)
      : points_(points), normals_(normals) {
    if (!normals.empty() && normals.size() != points.size())
      throw InvalidArgument("'normals' has " + detail::counted(normals.size(), "entry") + " for " +
                            detail::counted(points.size(), "point") + "; give none or one per point");
    if (!rows) return;
    rows_ = *rows;
    check_rows(static_cast<Index>(points.size()));
    for (const Row row : rows_) {
      own_points_.push_back(points[row.index]);
      if (!normals.empty()) own_normals_.push_back(normals[row.index]);
    }
    points_ = own_points_;
    normals_ = own_normals_;
    all_ = false;
  }

  std::span<const Vec3> points() const { return points_; }
  std::span<const Vec3> normals() const { return normals_; }
  Row row(std::size_t point) const { return all_ ? Row(static_cast<Index>(point)) : rows_[point]; }

 private:
  void check_rows(Index n) const {
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (rows_[i].index < 0 || rows_[i].index >= n || (i > 0 && rows_[i] <= rows_[i - 1]))
        throw InvalidArgument("options.rows: entry " + std::to_string(i) + " is " + std::to_string(rows_[i].index) +
                              "; give row numbers in [0, " + std::to_string(n) + "), ascending");
  }

  std::span<const Vec3> points_, normals_;
  std::span<const Row> rows_;
  std::vector<Vec3> own_points_, own_normals_;
  bool all_ = true;
};

/// "12, 15, 17 and 240 more"
std::string first_ten(const std::vector<Row>& rows) {
  detail::ItemList list;
  for (const Row row : rows) list.add(std::to_string(row.index));
  return list.text();
}

/// Marks the parts in which neighbors with opposed normals are not joined.
std::vector<char> cut_between_sheets(std::span<const Vec3> given, const CleanPoints& cloud, const TangentPlanes& planes,
                                     const Neighborhoods& neighborhoods, const CloudParts& parts,
                                     const CloudOptions& options) {
  const auto all = [&](char cut) { return std::vector<char>(static_cast<std::size_t>(parts.count), cut); };
  if (given.empty() || options.normal_signs == NormalSigns::unoriented) return all(0);
  if (options.normal_signs == NormalSigns::oriented) return all(1);
  return have_thin_walls(cloud, planes, neighborhoods, parts);
}

PerPart per_part(const CloudParts& parts, const std::vector<char>& marks) {
  return {parts.of_point, std::vector<double>(marks.begin(), marks.end())};
}

/// Number of points in parts of more than `default_neighbors` points that have no interior point.
Index points_on_lines(const CloudParts& parts, const std::vector<char>& inner) {
  std::vector<Index> sizes(static_cast<std::size_t>(parts.count), 0);
  std::vector<char> has_inner(sizes.size(), 0);
  for (std::size_t i = 0; i < inner.size(); ++i) {
    ++sizes[parts.of_point[i]];
    has_inner[parts.of_point[i]] |= inner[i];
  }
  Index points = 0;
  for (std::size_t part = 0; part < sizes.size(); ++part)
    if (!has_inner[part] && sizes[part] > default_neighbors) points += sizes[part];
  return points;
}

/// Makes the signs of the normals consistent. Parts that are cut keep their input signs.
/// @return marks of the parts with correct input signs everywhere
std::vector<char> orient(const CleanPoints& cloud, const WeightedEdges& edges, std::span<const Vec3> given,
                         const CloudParts& parts, const std::vector<char>& cut, const CloudOptions& options,
                         TangentPlanes& planes, CloudDetails& report) {
  const bool signs_given = !given.empty() && options.normal_signs == NormalSigns::automatic;
  const std::vector<Index> flipped = orient_normals(cloud, edges, signs_given, parts, cut, options.threads, planes);
  std::vector<char> consistent_signs = cut;
  report.flipped_normals = 0;
  for (std::size_t part = 0; part < flipped.size() && signs_given; ++part) {
    report.flipped_normals += flipped[part];
    if (flipped[part] == 0) consistent_signs[part] = 1;
  }
  report.oriented = std::find(consistent_signs.begin(), consistent_signs.end(), 0) == consistent_signs.end();
  return consistent_signs;
}

/// The nearest neighbor that has a mass, if it or the point was smoothed; -1: none.
Index smoothed_neighbor(const CleanPoints& cloud, Index point, const WeightedEdges& edges,
                        const NeighborSearch& search) {
  if (cloud.smoothed.empty()) return -1;
  std::vector<Index> near(std::min<std::size_t>(default_neighbors, cloud.points.size()));
  std::vector<double> squared(near.size());
  search.nearest(cloud.points[point], near, squared);
  const auto found = std::find_if(near.begin(), near.end(), [&](Index j) { return edges.masses[j] > 0; });
  return found != near.end() && (cloud.smoothed[point] || cloud.smoothed[*found]) ? *found : -1;
}

/// Numbers the points that have a mass, and lists the rows of the other points. A smoothed point without a mass shares the
/// vertex of its neighbor.
std::vector<Index> number_vertices(const CleanPoints& cloud, const WeightedEdges& edges, const NeighborSearch& search,
                                   const KeptPoints& kept, CloudDetails& report) {
  std::vector<Index> vertex_of_clean(cloud.points.size(), -1);
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (edges.masses[i] > 0) vertex_of_clean[i] = report.vertices++;
  std::vector<Row> removed;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (edges.masses[i] > 0) continue;
    if (const Index near = smoothed_neighbor(cloud, static_cast<Index>(i), edges, search); near >= 0)
      vertex_of_clean[i] = vertex_of_clean[near];
    if (vertex_of_clean[i] < 0) removed.push_back(kept.row(static_cast<std::size_t>(cloud.input[i])));
  }
  report.degenerate = static_cast<Index>(removed.size());
  std::sort(removed.begin(), removed.end());
  if (report.vertices == 0)
    throw InvalidGeometry(
        "no point of the cloud has a tangent plane with a triangle in it: the points lie on a line, or are too "
        "far apart from each other (points " +
        first_ten(removed) + ")");
  removed.resize(std::min<std::size_t>(removed.size(), 10));
  report.first_degenerate = std::move(removed);
  return vertex_of_clean;
}

void fill_vertex_data(CsrGraphData& g, const CleanPoints& cloud, const TangentPlanes& planes,
                      const WeightedEdges& edges, const std::vector<Index>& vertex_of_clean, Index vertices,
                      unsigned threads) {
  g.length_unit = cloud.unit;
  g.masses.resize(static_cast<std::size_t>(vertices));
  g.frames.resize(g.masses.size());
  detail::for_each_index(cloud.points.size(), threads, [&](std::size_t i) {
    if (!(edges.masses[i] > 0)) return;
    const PlaneAxes axes(planes.normals[i]);
    g.masses[vertex_of_clean[i]] = edges.masses[i];
    g.frames[vertex_of_clean[i]] = {cloud.unit * cloud.points[i], axes.x, axes.y, planes.normals[i]};
  });
}

/// The rounding step of single precision at the largest coordinates, if all coordinates are single-precision numbers and some
/// of the largest are odd multiples of the step; otherwise 0. Second: the axis of the largest coordinates.
std::pair<double, int> single_precision_step(std::span<const Vec3> points) {
  float farthest = 0;
  int axis = 0;
  for (const Vec3& p : points)
    for (int a = 0; a < 3; ++a) {
      if (!std::isfinite(p[a])) continue;
      const auto single = static_cast<float>(p[a]);
      if (static_cast<double>(single) != p[a]) return {};
      if (std::abs(single) > farthest) farthest = std::abs(single), axis = a;
    }
  const double step = static_cast<double>(std::nextafter(farthest, std::numeric_limits<float>::infinity())) - farthest;
  const auto is_rounded = [&](double x) { return std::abs(x) > farthest / 2 && std::fmod(std::abs(x) / step, 2) == 1; };
  const bool is_any = std::ranges::any_of(points, [&](const Vec3& p) { return std::ranges::any_of(p, is_rounded); });
  return {is_any ? step : 0, axis};
}

/// Fraction of the triangles found in the local triangulations of all three corners; 1 if there are no triangles.
double agreement(const LocalTriangles& local) {
  const auto shared = std::ranges::count(local.votes, 3);
  return local.votes.empty() ? 1 : static_cast<double>(shared) / static_cast<double>(local.votes.size());
}

/// Replaces clean points by vertices as corners of triangles. All corners have masses.
void number_corners(std::vector<Triangle>& triangles, const std::vector<Index>& vertex_of_clean) {
  for (Triangle& t : triangles)
    for (Index& corner : t) corner = vertex_of_clean[corner];
}

}  // namespace

/// The triangles of `flat_approximation`; their corners are vertices.
struct PointCloudSurface::Sheet {
  std::once_flag once;
  LocalTriangles candidates;  ///< empty after the choice
  std::vector<Triangle> triangles;
};

PointCloudSurface::~PointCloudSurface() = default;
PointCloudSurface::PointCloudSurface(PointCloudSurface&&) noexcept = default;
PointCloudSurface& PointCloudSurface::operator=(PointCloudSurface&&) noexcept = default;

PointCloudSurface::PointCloudSurface(CsrGraph graph, CloudDetails details, RowMap rows, std::span<const Vec3> points,
                                     std::optional<std::vector<Row>> kept, LocalTriangles triangles)
    : graph_(std::make_unique<const CsrGraph>(std::move(graph))),
      details_(std::move(details)),
      rows_(std::move(rows)),
      positions_(points.begin(), points.end()),
      kept_(std::move(kept)),
      sheet_(std::make_unique<Sheet>()) {
  sheet_->candidates = std::move(triangles);
}

PointCloudSurface PointCloudSurface::build(std::span<const Vec3> input, std::span<const Vec3> input_normals,
                                           const CloudOptions& options) try {
  const KeptPoints kept(input, input_normals, options.rows);
  const std::span<const Vec3> points = kept.points();
  std::span<const Vec3> normals = kept.normals();
  check_arguments(points, options);
  CloudDetails details;
  details.points = static_cast<Index>(input.size());
  details.normals_given = !normals.empty();
  detail::Stopwatch stopwatch;
  CleanPoints cloud = clean_points(
      points, [&](std::size_t i) { return kept.row(i).index; }, options, details);
  auto search = options.search ? options.search(cloud.points) : nullptr;
  if (!search) throw InvalidArgument("options.search returned no neighbor search; use nanoflann_search, the default");
  options.progress.step("neighbors", 0.0);
  details.k_asked = options.k.value_or(default_neighbors);
  auto [neighborhoods, planes, parts, noise, typical_noise, merged] =
      find_noisy_planes(cloud, normals, search, options);
  details.k = neighborhoods.k;
  details.near_duplicates = merged;
  details.smoothed = static_cast<Index>(std::count(cloud.smoothed.begin(), cloud.smoothed.end(), 1));
  details.noise = typical_noise.deviation * cloud.unit;
  details.layer_gap = typical_noise.layer_gap * cloud.unit;
  std::tie(details.coordinate_step, details.coarse_axis) = single_precision_step(input);
  if (!normals.empty()) details.estimated = planes.estimated;
  details.contradicted = planes.contradicted;
  details.thick = planes.thick;
  if (planes.estimated == static_cast<Index>(cloud.points.size())) normals = {};
  const std::vector<char> cut = cut_between_sheets(normals, cloud, planes, neighborhoods, *parts, options);
  details.seconds_normals = stopwatch.lap();

  std::vector<char> inner;
  LocalTriangles local;
  std::vector<Triangle>& triangles = local.triangles;
  triangles = local_delaunay(cloud, neighborhoods, planes, per_part(*parts, cut), noise, options, details, &inner,
                             &local.votes);
  details.lines = points_on_lines(*parts, inner);
  details.seconds_delaunay = stopwatch.lap();
  neighborhoods = {};

  const WeightedEdges edges = triangles.empty()
                                  ? WeightedEdges{{}, {}, {}, std::vector<double>(cloud.points.size(), 0.0)}
                                  : tufted_laplacian(cloud, planes, triangles, *parts, options.threads, details);
  details.mollification *= cloud.unit;
  options.progress.step("laplacian", 1.0);
  details.seconds_laplacian = stopwatch.lap();

  const std::vector<Index> vertex_of_clean = number_vertices(cloud, edges, *search, kept, details);
  const std::vector<char> consistent_signs = orient(cloud, edges, normals, *parts, cut, options, planes, details);
  CsrGraphData data = tangent_edges(cloud, planes, edges, vertex_of_clean, details.vertices,
                                    per_part(*parts, consistent_signs), noise, options.threads, details);
  fill_vertex_data(data, cloud, planes, edges, vertex_of_clean, details.vertices, options.threads);
  details.agreement = agreement(local);
  number_corners(triangles, vertex_of_clean);
  std::optional<CsrGraph> graph;
  std::optional<RowMap> rows;
  const auto find_components = [&] {
    graph.emplace(std::move(data));
    details.components = connected_components(*graph).count;
  };
  const auto pair_rows = [&] {
    std::vector<RowVertex> pairs;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (const Index clean = cloud.clean_of_input[i]; clean >= 0 && vertex_of_clean[clean] >= 0)
        pairs.push_back({kept.row(i), Vertex(vertex_of_clean[clean])});
    rows.emplace(details.points, details.vertices, pairs);
  };
  detail::run_both(options.threads, find_components, pair_rows);
  options.progress.step("graph", 1.0);
  details.seconds_graph = stopwatch.lap();
  return PointCloudSurface(*std::move(graph), std::move(details), *std::move(rows), input, options.rows,
                           std::move(local));
} catch (const std::bad_alloc&) {
  throw ResourceExhausted("out of memory while building the graph of a cloud of " +
                          detail::counted(input.size(), "point"));
}

Method PointCloudSurface::suggested_method() const {
  const bool is_noisy = details_.noise > noise_for_heat * graph_->mean_edge_length() * graph_->length_unit();
  return is_noisy || details_.agreement < min_agreement ? Method::heat : Method::polar;
}

FlatTriangles PointCloudSurface::flat_approximation() const {
  std::vector<Frame> frames;
  frames.reserve(static_cast<std::size_t>(graph_->size()));
  for (Index v = 0; v < graph_->size(); ++v) {
    frames.push_back(*graph_->frame(v));
    frames.back().origin = (1 / graph_->length_unit()) * frames.back().origin;
  }
  std::call_once(sheet_->once, [&] {
    sheet_->triangles = sheet_triangles(frames, sheet_->candidates);
    sheet_->candidates = {};
  });
  return flat_sheet(frames, sheet_->triangles, graph_->length_unit());
}

Surface::Reason PointCloudSurface::missing_vertex_reason(Row row) const {
  if (kept_ && !std::binary_search(kept_->begin(), kept_->end(), row))
    return {"row_left_out", "was left out", "it is not among CloudOptions::rows"};
  return {"row_removed", "was removed: it is not finite, or has no tangent plane or no neighbors",
          "choose another one"};
}

double PointCloudSurface::normal_error_degrees() const {
  const bool as_given = details_.normals_given && details_.estimated == 0 && details_.contradicted == 0;
  return as_given ? normal_error : estimated_normal_error;
}

Report PointCloudSurface::report() const {
  const CloudDetails& d = details_;
  return {{"points", d.points},
          {"vertices", d.vertices},
          {"non_finite", d.non_finite},
          {"duplicates", d.duplicates},
          {"near_duplicates", d.near_duplicates},
          {"smoothed", d.smoothed},
          {"degenerate", d.degenerate},
          {"k", d.k},
          {"components", d.components},
          {"triangles", d.triangles},
          {"flips", d.flips},
          {"rejected_long", d.rejected_long},
          {"rejected_normals", d.rejected_normals},
          {"rejected_steep", d.rejected_steep},
          {"reflections", d.reflections},
          {"normals_given", d.normals_given},
          {"contradicted", d.contradicted},
          {"thick", d.thick},
          {"lines", d.lines},
          {"oriented", d.oriented},
          {"noise", d.noise},
          {"layer_gap", d.layer_gap},
          {"mollification", d.mollification},
          {"seconds.normals", d.seconds_normals},
          {"seconds.delaunay", d.seconds_delaunay},
          {"seconds.laplacian", d.seconds_laplacian},
          {"seconds.graph", d.seconds_graph}};
}

std::vector<Warning> PointCloudSurface::warnings() const {
  const CloudDetails& d = details_;
  std::vector<Warning> result;
  const auto warn = [&](std::string_view id, auto count, const std::vector<Row>& rows = {}) {
    if (count > 0) result.push_back({id, {static_cast<double>(count)}, rows});
  };
  warn("normals_estimated", d.estimated);
  if (d.flips_stopped) result.push_back({"cover_not_delaunay", {}, {}});
  warn("normals_contradicted", d.contradicted);
  if (d.thick > thick_share * d.vertices)
    result.push_back({"no_surface", {static_cast<double>(d.thick), static_cast<double>(d.vertices)}, {}});
  warn("lines", d.lines);
  warn("degenerate", d.degenerate, d.first_degenerate);
  warn("normals_flipped", d.flipped_normals);
  if (d.k < d.k_asked)
    result.push_back(
        {"k_reduced", {static_cast<double>(d.k_asked), static_cast<double>(d.k), static_cast<double>(d.k + 1)}, {}});
  if (d.layer_gap > 0 && d.rejected_normals == 0) result.push_back({"layers", {d.layer_gap}, {}});
  if (d.smoothed > 0) result.push_back({"smoothed", {static_cast<double>(d.smoothed), d.noise}, {}});
  warn("non_finite", d.non_finite);
  warn("duplicates", d.duplicates);
  warn("near_duplicates", d.near_duplicates);
  const double mean_edge = graph_->mean_edge_length() * graph_->length_unit();
  // Regular grids may have such steps, too, but no points at or near the same place.
  if (d.coordinate_step > coarse_step * mean_edge &&
      (d.coordinate_step < grid_step * mean_edge || d.duplicates + d.near_duplicates > 0))
    result.push_back({"coarse_coordinates", {d.coordinate_step, mean_edge}, {}, std::string(1, "xyz"[d.coarse_axis])});
  warn("thin_walls", d.rejected_normals);
  warn("reflections", d.reflections);
  if (d.components > 1) warn("cloud_components", d.components);
  return result;
}

}  // namespace ahm::pointcloud
