#include "input/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "ahm/error.hpp"
#include "cli/source_list.hpp"
#include "input/nearest_face.hpp"

namespace ahm::app {
namespace {

constexpr double most_points = 1e6;

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double distance(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// A point of the curve: how the backend finds it, and where it is.
struct Sample {
  SourceSpec spec;
  Vec3 position;
};

/// The nearest points of the surface.
class Projection {
 public:
  explicit Projection(const Input& input) : model_(*input.surface) {
    if (input.backend->has_faces) faces_ = std::make_unique<NearestFace>(input.geometry);
  }

  Sample operator()(const Vec3& p) const {
    if (faces_) {
      NearestFace::Hit hit = faces_->nearest(p);
      return {std::move(hit.point), hit.position};
    }
    const ResolvedSource vertex = resolve(model_, SourcePosition{p}, std::nullopt, "--curve");
    if (!vertex.frame) throw InvalidArgument("--curve: the graph has no frames in space");
    const Vec3& normal = vertex.frame->normal;
    const double height = dot(minus(p, vertex.position), normal);
    return {SourcePosition{p}, minus(p, {height * normal[0], height * normal[1], height * normal[2]})};
  }

 private:
  const Model& model_;
  std::unique_ptr<NearestFace> faces_;
};

/// The given points as corners, and points on the straight lines between them; the largest distance of these from the
/// surface.
std::vector<Sample> sample(const Input& input, const std::vector<SourceSpec>& given, bool closed, double step,
                           double& gap) {
  std::vector<Vec3> corners;
  corners.reserve(given.size() + 1);
  for (const SourceSpec& spec : given) corners.push_back(position_in(input.geometry, spec, "--curve"));
  if (closed) corners.push_back(corners.front());
  double length = 0;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) length += distance(corners[k], corners[k + 1]);
  if (!(length / step < most_points))
    throw InvalidArgument(
        fmt::format("--curve: is {:.4g} long, more than {:.0f} times half the mean edge length of {:.4g}; is it in the "
                    "units of the "
                    "input?",
                    length, most_points, 2 * step));

  const Projection project(input);
  std::vector<Sample> samples;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (k + 1 == corners.size() && closed) break;
    const bool on_surface = !std::holds_alternative<SourcePosition>(given[k]);
    samples.push_back(on_surface ? Sample{given[k], corners[k]} : project(corners[k]));
    gap = std::max(gap, distance(samples.back().position, corners[k]));
    if (k + 1 == corners.size()) break;
    const int pieces = static_cast<int>(std::ceil(distance(corners[k], corners[k + 1]) / step));
    for (int p = 1; p < pieces; ++p) {
      Vec3 between;
      for (std::size_t a = 0; a < 3; ++a)
        between[a] = corners[k][a] + static_cast<double>(p) / pieces * (corners[k + 1][a] - corners[k][a]);
      samples.push_back(project(between));
      gap = std::max(gap, distance(samples.back().position, between));
    }
  }
  return samples;
}

/// Leaves out points that coincide with the one before.
void thin(std::vector<Sample>& samples, bool closed, double least) {
  const auto close = [&](const Sample& a, const Sample& b) { return distance(a.position, b.position) < least; };
  samples.erase(std::unique(samples.begin(), samples.end(), close), samples.end());
  while (closed && samples.size() > 1 && close(samples.front(), samples.back())) samples.pop_back();
  const std::size_t needed = closed ? 3 : 2;
  if (samples.size() < needed)
    throw InvalidArgument(fmt::format("--curve: has {} different points on the surface; give at least {}{}",
                                      samples.size(), needed, closed ? " for a closed curve" : ""));
}

/// Direction that halves the angle between arriving at point k and leaving it.
Vec3 tangent(const std::vector<Sample>& samples, std::size_t k, bool closed) {
  const std::size_t n = samples.size();
  Vec3 sum{};
  const auto add = [&](std::size_t from, std::size_t to) {
    const double length = distance(samples[from].position, samples[to].position);
    for (std::size_t a = 0; a < 3; ++a) sum[a] += (samples[to].position[a] - samples[from].position[a]) / length;
  };
  if (k > 0 || closed) add((k + n - 1) % n, k);
  if (k + 1 < n || closed) add(k, (k + 1) % n);
  if (!(dot(sum, sum) > 1e-6)) {
    const Vec3& p = samples[k].position;
    throw InvalidArgument(fmt::format("--curve: turns back at {:.6g} {:.6g} {:.6g}; split it there", p[0], p[1], p[2]));
  }
  return sum;
}

/// The source of a point with its u axis along the curve, v left of it as seen from `up`; the vertex of a cloud carries
/// the point, not itself.
Source carried(const ResolvedSource& point, const Vec3& position, bool is_cloud, double side) {
  const auto& [source, row, place, frame] = point;
  if (!is_cloud && side > 0) return source;
  Source result(2);
  for (std::size_t k = 0; k < source.vertices().size(); ++k) {
    std::vector<double> offset(2, 0.0), axes(source.axes().begin() + static_cast<std::ptrdiff_t>(4 * k),
                                             source.axes().begin() + static_cast<std::ptrdiff_t>(4 * k + 4));
    if (!source.offsets().empty()) offset = {source.offsets()[2 * k], source.offsets()[2 * k + 1]};
    if (is_cloud) offset = {dot(minus(place, position), frame->x), dot(minus(place, position), frame->y)};
    if (side < 0) offset[1] = -offset[1], axes[1] = -axes[1], axes[3] = -axes[3];
    result.add(source.vertices()[k], source.weights()[k], offset, axes);
  }
  return result;
}

}  // namespace

Curve draw_curve(const Input& input, const std::vector<SourceSpec>& given, const StrokeOptions& options) {
  const TangentGraph& graph = input.graph();
  const double edge = graph.mean_edge_length() * graph.length_unit();
  Curve curve;
  std::vector<Sample> samples = sample(input, given, options.closed, edge / 2, curve.gap);
  thin(samples, options.closed, 1e-6 * edge);

  const bool is_cloud = !input.backend->has_faces, may_mirror = graph.transport_kind() == TransportKind::block;
  const std::size_t n = samples.size();
  std::vector<Source> sources;
  std::vector<double> lengths;
  Vec3 normal{};
  double side = 1;
  // Frames that look to different sides of the surface have different left sides.
  const auto turn_over = [&](const std::optional<Frame>& frame) {
    if (may_mirror && frame && dot(frame->normal, normal) < 0) side = -side;
    if (frame) normal = frame->normal;
  };
  for (std::size_t k = 0; k < n; ++k) {
    const ResolvedSource point =
        resolve(*input.surface, samples[k].spec, tangent(samples, k, options.closed), "--curve");
    if (k == 0) curve.first = point.frame;
    turn_over(point.frame);
    sources.push_back(carried(point, samples[k].position, is_cloud, side));
    curve.points.push_back(samples[k].position);
    if (k + 1 < n || options.closed) lengths.push_back(distance(samples[k].position, samples[(k + 1) % n].position));
  }
  if (options.closed) turn_over(curve.first);
  if (side < 0 && options.closed)
    throw InvalidArgument("--curve: runs along a one-sided band, so it has no left; leave it open");
  for (double length : lengths) curve.length += length, curve.jump = std::max(curve.jump, length);
  curve.source = stroke_source(sources, lengths, options);
  return curve;
}

}  // namespace ahm::app
