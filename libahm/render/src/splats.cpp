#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "ahm/pointcloud/neighbor_search.hpp"
#include "ahm/pointcloud/plane_fit.hpp"
#include "ahm/util/parallel.hpp"
#include "drawable.hpp"
#include "splat_gradient.hpp"

namespace ahm::render {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::size_t ring_size = splat_ring;
constexpr std::size_t neighbors_for_normal = 12;

struct Local {
  float radius = 0;
  std::array<std::uint32_t, ring_size> ring{};
};

/// Limits the radii: not much larger than those of the neighbors (at outliers), not too small (at duplicate points), and not far from the
/// median.
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
  if (!(median > 0)) median = 0.05F;  // all points coincide: a visible disc
  median = std::min(median, 0.1F);
  for (float& radius : radii) radius = std::clamp(radius, 0.5F * median, 3 * median);
  return radii;
}

/// Builds the drawable of a cloud.
class Splatter {
 public:
  Splatter(const Scene& scene, const std::vector<Index>& shown, const Camera& camera, const Paint& paint)
      : scene_(scene), shown_(shown), paint_(paint), rings_per_length_(camera.scale / paint.ring_width) {
    points_.reserve(shown.size());
    for (const Index i : shown) {
      const Vector3d x = camera.to_scene(scene.points[i]);
      points_.push_back({x.x(), x.y(), x.z()});
    }
  }

  Drawable make(unsigned threads) {
    const std::size_t n = points_.size();
    out_.positions.resize(n), out_.normals.resize(n), out_.values.resize(n), out_.known.resize(n);
    out_.points = shown_;
    if (paint_.pattern != Pattern::none) out_.gradients.resize(n);
    out_.values_per_length = static_cast<float>(4 * rings_per_length_);
    std::vector<Local> locals(n);
    const auto search = pointcloud::nanoflann_search(points_);
    detail::parallel_chunks(static_cast<Offset>(n), 4096, threads, [&](Offset begin, Offset end) {
      for (Offset k = begin; k < end; ++k) locals[k] = look_around(*search, static_cast<std::size_t>(k));
    });
    out_.radii = limited_radii(locals);
    for (const Local& local : locals) out_.rings.push_back(local.ring);
    if (paint_.pattern == Pattern::none) return std::move(out_);
    const auto value = [&](std::size_t k) { return paint_.uv[shown_[k]]; };
    const auto has_values = [&](std::size_t k) { return paint_.known[shown_[k]] != 0; };
    const auto position = [&](std::size_t k) { return as_vector(points_[k]); };
    const SplatGradient gradient{out_.normals, out_.rings, rings_per_length_, paint_.pattern == Pattern::cells};
    detail::parallel_chunks(static_cast<Offset>(n), 4096, threads, [&](Offset begin, Offset end) {
      for (Offset k = begin; k < end; ++k)
        out_.gradients[k] = gradient(static_cast<std::size_t>(k), position, value, has_values);
    });
    return std::move(out_);
  }

 private:
  /// Sets position, normal and value of point k. @return its neighbors and its radius before limitation
  Local look_around(const pointcloud::NeighborSearch& search, std::size_t k) {
    const auto i = static_cast<std::size_t>(shown_[k]);
    out_.positions[k] = as_vector(points_[k]).cast<float>();
    out_.values[k] = {static_cast<float>(paint_.uv[i].x()), static_cast<float>(paint_.uv[i].y()), paint_.quality[i]};
    out_.known[k] = paint_.known[i];
    const Vector3d given = scene_.normals.empty() ? Vector3d::Zero().eval() : as_vector(scene_.normals[i]).eval();
    const bool estimate = !given.allFinite() || !(given.norm() > 0);

    std::array<Index, neighbors_for_normal> index;
    std::array<double, neighbors_for_normal> squared;
    const std::size_t wanted = estimate ? neighbors_for_normal : ring_size + 1;
    const auto found = static_cast<std::size_t>(
        search.nearest(points_[k], std::span(index).first(wanted), std::span(squared).first(wanted)));
    if (estimate && found <= ring_size) {
      out_.normals[k] = Vector3f::Zero();  // too few neighbors: the disc faces the viewer
    } else if (estimate) {
      const Vec3 normal =
          pointcloud::fit_plane(points_, static_cast<Index>(k), std::span(index).subspan(1, found - 1)).normal;
      out_.normals[k] = as_vector(normal).cast<float>();
    } else {
      out_.normals[k] = given.normalized().cast<float>();
    }
    // The first neighbor is the point itself, or a duplicate.
    const std::size_t used = std::min(found, ring_size + 1);
    Local local;
    local.ring.fill(static_cast<std::uint32_t>(k));
    for (std::size_t r = 1; r < used; ++r) local.ring[r - 1] = static_cast<std::uint32_t>(index[r]);
    if (used > 0) local.radius = static_cast<float>(std::sqrt(squared[used - 1]));
    return local;
  }

  const Scene& scene_;
  const std::vector<Index>& shown_;
  const Paint& paint_;
  double rings_per_length_;  ///< length of the gradient of an isometric map, rings per unit of length
  std::vector<Vec3> points_;
  Drawable out_;
};

}  // namespace

Drawable make_splats(const Scene& scene, const std::vector<Index>& shown, const Camera& camera, const Paint& paint,
                     unsigned threads) {
  return Splatter(scene, shown, camera, paint).make(threads);
}

}  // namespace ahm::render
