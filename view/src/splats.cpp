#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>
#include <span>
#include <thread>

#include "drawable.hpp"

namespace ahm::view {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// What nanoflann wants to know about an array of points.
struct PointsAdaptor {
  const std::vector<Vector3d>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<Eigen::Index>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointsAdaptor>, PointsAdaptor, 3,
                                                 std::size_t>;

constexpr std::size_t ring_size = 6;  // neighbours a disc reaches, so that discs overlap
constexpr std::size_t neighbours_for_normal = 12;

struct Local {
  float radius = 0;
  Vector3f normal = Vector3f::Zero();  // zero, where unknown: drawn facing the viewer
  std::array<std::uint32_t, ring_size> ring{};
};

/// The direction in which these points are thinnest.
Vector3f thinnest_direction(const std::vector<Vector3d>& points, std::span<const std::size_t> index) {
  if (index.size() < 3) return Vector3f::Zero();
  Vector3d mean = Vector3d::Zero();
  for (const std::size_t k : index) mean += points[k] / static_cast<double>(index.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const std::size_t k : index) covariance += (points[k] - mean) * (points[k] - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  return solver.eigenvectors().col(0).cast<float>();
}

/// Nearest neighbours of point i, the distance to the farthest of them, and a normal unless one is given.
Local look_around(const Tree& tree, const std::vector<Vector3d>& points, std::size_t i, const Vector3d& given) {
  const bool estimate = !given.allFinite() || !(given.norm() > 0);
  std::array<std::size_t, neighbours_for_normal> index;
  std::array<double, neighbours_for_normal> squared;
  const std::size_t wanted = estimate ? neighbours_for_normal : ring_size + 1;
  const std::size_t found = tree.knnSearch(points[i].data(), wanted, index.data(), squared.data());
  Local local;
  local.ring.fill(static_cast<std::uint32_t>(i));
  const std::size_t used = std::min(found, ring_size + 1);  // the first one found is the point itself, or its double
  for (std::size_t k = 1; k < used; ++k) local.ring[k - 1] = static_cast<std::uint32_t>(index[k]);
  if (used > 0) local.radius = static_cast<float>(std::sqrt(squared[used - 1]));
  local.normal =
      estimate ? thinnest_direction(points, {index.data(), found}) : Vector3f(given.normalized().cast<float>());
  return local;
}

/// Runs body(begin, end) over the parts of 0..n on all processors; parts write only their own entries.
template <class Body>
void in_parallel(std::size_t n, const Body& body) {
  const std::size_t parts = n < 10'000 ? 1 : std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, 16);
  std::vector<std::jthread> threads;
  for (std::size_t part = 1; part < parts; ++part)
    threads.emplace_back([&, part] { body(n * part / parts, n * (part + 1) / parts); });
  body(0, n / parts);
}

/// Radii within bounds: no blob for a floater (its neighbours lie closer to each other than to it), no pinhole for a
/// doubled point, nothing far from the median.
std::vector<float> limited_radii(const std::vector<Local>& locals) {
  std::vector<float> radii;
  for (const Local& local : locals) {
    std::array<float, ring_size> around;
    for (std::size_t k = 0; k < ring_size; ++k) around[k] = locals[local.ring[k]].radius;
    std::nth_element(around.begin(), around.begin() + ring_size / 2, around.end());
    radii.push_back(std::min(local.radius, 1.3F * around[ring_size / 2]));
  }
  std::vector<float> sorted = radii;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  float median = sorted[sorted.size() / 2];
  if (!(median > 0)) median = *std::max_element(radii.begin(), radii.end());
  if (!(median > 0)) median = 0.05F;  // a single place: a disc one can see
  median = std::min(median, 0.1F);
  for (float& radius : radii) radius = std::clamp(radius, 0.5F * median, 3 * median);
  return radii;
}

}  // namespace

Drawable make_splats(const Scene& scene, const std::vector<Index>& shown, const Camera& camera, const Paint& paint) {
  std::vector<Vector3d> points;
  points.reserve(shown.size());
  for (const Index i : shown) points.push_back(camera.to_scene(scene.points[i]));

  const std::size_t n = points.size();
  Drawable out;
  out.positions.resize(n), out.normals.resize(n);
  out.uv.resize(n), out.known.resize(n);
  std::vector<Local> locals(n);
  const PointsAdaptor adaptor{points};
  const Tree tree(3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  in_parallel(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<std::size_t>(shown[k]);
      const Vector3d given = scene.normals.empty() ? Vector3d::Zero() : Vector3d(as_vector(scene.normals[i]));
      locals[k] = look_around(tree, points, k, given);
      out.positions[k] = points[k].cast<float>();
      out.normals[k] = locals[k].normal;
      out.uv[k] = paint.uv[i].cast<float>();
      out.known[k] = paint.known[i];
    }
  });
  out.radii = limited_radii(locals);
  return out;
}

}  // namespace ahm::view
