#include "ahm/render/page.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "ahm/util/parallel.hpp"
#include "bundle.hpp"
#include "drawable.hpp"
#include "picture.hpp"
#include "splat_gradient.hpp"

namespace ahm::render {
namespace {

using Eigen::Vector3d;
using nlohmann::json;
static_assert(sizeof(Eigen::Vector2f) == 8 && sizeof(Eigen::Vector3f) == 12);  // stored as arrays of floats

std::uint8_t byte(float x) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0F, 1.0F))); }

float largest_radius(const Drawable& drawable) {
  return drawable.is_mesh() ? 1 : *std::max_element(drawable.radii.begin(), drawable.radii.end());
}

/// The normal and radius of each vertex or disc, in four bytes.
std::vector<std::array<std::uint8_t, 4>> discs(const Drawable& drawable) {
  const float largest = largest_radius(drawable);
  std::vector<std::array<std::uint8_t, 4>> out(drawable.normals.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Eigen::Vector3f n = 0.5F * drawable.normals[i] + Eigen::Vector3f::Constant(0.5F);
    out[i] = {byte(n.x()), byte(n.y()), byte(n.z()),
              drawable.is_mesh() ? std::uint8_t{0} : byte(drawable.radii[i] / largest)};
  }
  return out;
}

json triple(const Vector3d& x) { return {x.x(), x.y(), x.z()}; }

/// A permutation in which consecutive points are usually far apart, so that the first points are a thinned cloud. The step is about n
/// divided by the golden ratio.
std::vector<Index> scattered(std::vector<Index> points) {
  const auto n = static_cast<std::uint64_t>(points.size());
  auto step = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(static_cast<double>(n) * 0.6180339887498949));
  while (std::gcd(step, n) != 1) ++step;
  std::vector<Index> out(points.size());
  for (std::uint64_t k = 0; k < n; ++k) out[k] = points[k * step % n];
  return out;
}

Drawable drawable_of(const Scene& scene, const std::vector<Index>& shown, const Camera& camera, unsigned threads) {
  PictureOptions plain;
  plain.pattern = Pattern::none;
  const Paint paint = make_paint(scene, shown, plain);
  return make_drawable(scene, scene.face_vertices.empty() ? scattered(shown) : shown, camera, paint, threads);
}

}  // namespace

struct PageSurface::Impl {
  std::vector<Index> shown;
  Camera camera;
  Drawable drawable;
  unsigned threads;
  std::string bundle;

  Impl(const Scene& scene, const PictureOptions& options)
      : shown(shown_points(scene)),
        camera(choose_camera(scene, shown, options)),
        drawable(drawable_of(scene, shown, camera, options.threads)),
        threads(options.threads),
        bundle(make_bundle(scene, options)) {}

  Vector3d to_page(const Vec3& x) const { return camera.to_scene(x); }

  std::string make_bundle(const Scene& scene, const PictureOptions& options) const {
    Bundle out;
    out.add<float>("positions", drawable.positions);
    out.add<std::uint8_t>("discs", discs(drawable));
    out.add<std::int32_t>("points", drawable.points);
    out.add<std::uint32_t>("triangles", drawable.triangles);
    if (std::any_of(drawable.origins.begin(), drawable.origins.end(), [](const auto& o) { return o.sides != 3; })) {
      std::vector<std::array<std::uint16_t, 4>> corners;
      for (const TriangleOrigin& o : drawable.origins)
        corners.push_back({o.corners[0], o.corners[1], o.corners[2], o.sides});
      out.add<std::uint16_t>("corners", corners);
    }
    std::vector<std::int32_t> faces;
    for (const TriangleOrigin& o : drawable.origins) faces.push_back(o.face);
    out.add<std::int32_t>("faces", faces);
    if (!scene.colors.empty()) {
      std::vector<std::array<std::uint8_t, 4>> colors;
      for (const Index point : drawable.points) {
        const auto& c = scene.colors[static_cast<std::size_t>(point)];
        colors.push_back({c[0], c[1], c[2], 255});
      }
      out.add<std::uint8_t>("colors", colors);
    }
    return std::move(out).finish({{"title", scene.title},
                                  {"is_mesh", drawable.is_mesh()},
                                  {"is_cloud", scene.is_cloud || !drawable.is_mesh()},
                                  {"rows", scene.points.size()},
                                  {"center", triple(camera.center)},
                                  {"scale", camera.scale},
                                  {"largest_radius", largest_radius(drawable)},
                                  {"spacing", typical_spacing(drawable)},
                                  {"eye", triple(camera.eye())},
                                  {"target", triple(camera.target)},
                                  {"up", triple(camera.up)},
                                  {"field_of_view", Camera::field_of_view * 180 / std::numbers::pi},
                                  {"far", camera.far_plane},
                                  {"aspect", static_cast<double>(options.width) / options.height}});
  }

  /// Converts lengths to units of the scale.
  std::vector<float> lengths(std::span<const double> values) const {
    std::vector<float> out;
    out.reserve(values.size());
    for (double x : values) out.push_back(static_cast<float>(x / camera.scale));
    return out;
  }

  /// The values of each row: (u, v), or (color, distance) for cells.
  std::vector<Eigen::Vector2f> painted(const Scene& scene, const Paint& paint) const {
    std::vector<Eigen::Vector2f> out(scene.points.size(), Eigen::Vector2f::Constant(NAN));
    const bool is_cells = paint.pattern == Pattern::cells;
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (is_cells && paint.known[i] != 0)
        out[i] = {static_cast<float>(paint.uv[i].x()), static_cast<float>(scene.distance[i] / camera.scale)};
      if (!is_cells && !scene.u.empty())
        out[i] = {static_cast<float>(scene.u[i] / camera.scale), static_cast<float>(scene.v[i] / camera.scale)};
    }
    return out;
  }

  /// The gradients of both values of each disc, in six bytes; 127 means zero.
  /// @param steepest  set to the largest component, at most 4: the scale of the bytes
  std::vector<std::array<std::uint8_t, 6>> slopes(const std::vector<Eigen::Vector2f>& painted, bool is_cells,
                                                  float& steepest) const {
    const std::size_t n = drawable.points.size();
    std::vector<std::array<Eigen::Vector3f, 2>> gradients(n);
    const auto row = [&](std::size_t k) { return static_cast<std::size_t>(drawable.points[k]); };
    const auto value = [&](std::size_t k) { return painted[row(k)].cast<double>().eval(); };
    const auto has_values = [&](std::size_t k) { return painted[row(k)].allFinite(); };
    const auto position = [&](std::size_t k) { return drawable.positions[k].cast<double>().eval(); };
    const SplatGradient gradient{drawable.normals, drawable.rings, 1, is_cells};
    detail::parallel_chunks(static_cast<Offset>(n), 4096, threads, [&](Offset begin, Offset end) {
      for (Offset k = begin; k < end; ++k)
        gradients[k] = gradient(static_cast<std::size_t>(k), position, value, has_values);
    });
    steepest = 0;
    for (const auto& g : gradients)
      steepest = std::max({steepest, g[0].cwiseAbs().maxCoeff(), g[1].cwiseAbs().maxCoeff()});
    steepest = std::min(steepest, 4.0F);  // 1 for an isometry
    const float scale = steepest > 0 ? 0.5F / steepest : 0;
    std::vector<std::array<std::uint8_t, 6>> out(n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < 6; ++k)
        out[i][k] = byte(127.0F / 255 + scale * gradients[i][k / 3][static_cast<Eigen::Index>(k % 3)]);
    return out;
  }

  json marks(const Scene& scene) const {
    json dots = json::array(), curve = json::array(), axes = json::array(), pieces = {0};
    for (const Vec3& x : scene.dots) dots.push_back(triple(to_page(x)));
    for (const Vec3& x : scene.curve) curve.push_back(triple(to_page(x)));
    for (const Index piece : scene.curve_pieces) pieces.push_back(piece);
    if (scene.source_axes)
      for (std::size_t k = 0; k < 2; ++k) axes.push_back(triple(as_vector((*scene.source_axes)[k]).normalized()));
    return {{"dots", dots}, {"curve", curve}, {"pieces", pieces}, {"axes", axes}};
  }
};

PageSurface::PageSurface(const Scene& scene, const PictureOptions& options) {
  check(scene, options);
  impl_ = std::make_unique<const Impl>(scene, options);
}

PageSurface::~PageSurface() = default;

const std::string& PageSurface::bundle() const noexcept { return impl_->bundle; }

double PageSurface::scale() const noexcept { return impl_->camera.scale; }

Vec3 PageSurface::to_page(const Vec3& position) const {
  const Vector3d x = impl_->to_page(position);
  return {x.x(), x.y(), x.z()};
}

std::string PageSurface::map_bundle(const Scene& scene, const PictureOptions& options, const std::string& more) const {
  check(scene, options);
  constexpr const char* patterns[] = {"polar", "grid", "cells", "distance", "none"};
  const Impl& surface = *impl_;
  const Paint paint = make_paint(scene, surface.shown, options);
  const std::vector<Eigen::Vector2f> painted = surface.painted(scene, paint);
  const std::span<const double> distance = scene.details.distance.empty() ? scene.distance : scene.details.distance;
  Bundle out;
  float steepest = 0;
  const bool has_values = options.pattern != Pattern::none && (!scene.u.empty() || !scene.labels.empty());
  if (has_values) out.add<float>("uv", painted);
  if (!distance.empty()) out.add<float>("distance", surface.lengths(distance));
  if (!scene.details.spread.empty()) out.add<float>("spread", surface.lengths(scene.details.spread));
  if (!scene.quality.empty()) out.add<float>("quality", std::vector<float>(scene.quality.begin(), scene.quality.end()));
  if (!scene.bounded.empty()) {
    std::vector<std::uint8_t> bounded;
    for (const double is_bound : scene.bounded) bounded.push_back(is_bound == 1 ? 1 : 0);  // NaN: not mapped
    out.add<std::uint8_t>("bounded", bounded);
  }
  if (!scene.details.status.empty()) {
    std::vector<std::uint8_t> status;
    for (const Status s : scene.details.status) status.push_back(static_cast<std::uint8_t>(s));
    out.add<std::uint8_t>("status", status);
  }
  if (!surface.drawable.is_mesh() && has_values)
    out.add<std::uint8_t>("slopes", surface.slopes(painted, options.pattern == Pattern::cells, steepest));
  json meta = surface.marks(scene);
  meta.update({{"pattern", patterns[static_cast<std::size_t>(options.pattern)]},
               {"sectors", options.sectors},
               {"ring_width", paint.ring_width / surface.camera.scale},
               {"steepest", steepest},
               {"source", triple(surface.to_page(scene.source))},
               {"spec", scene.details.source},
               {"position", triple(as_vector(scene.source))}});
  meta.update(json::parse(more));
  return std::move(out).finish(std::move(meta));
}

}  // namespace ahm::render
