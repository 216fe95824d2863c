#include "ahm/render/textured_picture.hpp"

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/io/image.hpp"
#include "ahm/util/text.hpp"
#include "picture.hpp"

namespace ahm::render {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

Vector3f light_of(const std::array<double, 3>& color) {
  Vector3f light;
  for (int c = 0; c < 3; ++c) light[c] = glsl::from_srgb(static_cast<float>(color[c]));
  return light;
}

/// The drawable of a part. Every corner is a vertex, because texture coordinates belong to corners.
Painted painted(const io::MeshPart& part, const Camera& camera) {
  Drawable d;
  for (std::size_t f = 0; f < part.faces.size(); ++f)
    for (Offset k = part.faces.begin[f] + 1; k + 1 < part.faces.begin[f + 1]; ++k) {
      std::array<Vector3d, 3> x;
      const std::array<Offset, 3> fan{part.faces.begin[f], k, k + 1};
      for (std::size_t c = 0; c < 3; ++c) x[c] = camera.to_scene(part.points[part.faces.vertices[fan[c]]]);
      if (!(x[0] + x[1] + x[2]).allFinite()) continue;
      const Vector3d flat = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
      for (std::size_t c = 0; c < 3; ++c) {
        Vector3d normal = flat;
        if (!part.normals.empty()) normal = as_vector(part.normals[part.faces.vertices[fan[c]]]);
        d.triangles.push_back(static_cast<std::uint32_t>(d.positions.size()));
        d.positions.push_back(x[c].cast<float>());
        d.normals.push_back((normal.allFinite() ? normal : flat).cast<float>());
        d.values.push_back(light_of(part.color));
        if (part.texture)
          d.values.back() = {static_cast<float>(part.texture_coordinates[2 * fan[c]]),
                             static_cast<float>(part.texture_coordinates[2 * fan[c] + 1]), 0};
        d.known.push_back(1);
      }
    }
  return {std::move(d),
          {.kind = part.texture ? Material::Kind::texture : Material::Kind::color,
           .image = part.texture,
           .transparent = part.transparent && part.texture}};
}

Painted painted_points(const TexturedScene& scene, const Camera& camera, unsigned threads) {
  Scene cloud;
  cloud.points = scene.points, cloud.normals = scene.normals;
  PictureOptions plain;
  plain.pattern = Pattern::none;
  const std::vector<Index> shown = shown_points(cloud);
  Drawable d = make_splats(cloud, shown, camera, make_paint(cloud, shown, plain), threads);
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const auto& c = scene.colors[shown[k]];
    d.values[k] = light_of({c[0] / 255.0, c[1] / 255.0, c[2] / 255.0});
    d.known[k] = 1;
    if (!scene.radii.empty()) d.radii[k] = static_cast<float>(scene.radii[shown[k]] / camera.scale);
  }
  d.values_per_length = std::numeric_limits<float>::infinity();  // blend all colors, even if they differ much
  return {std::move(d), {.kind = Material::Kind::color}};
}

/// A scene with all points, to choose the camera. Points of textured parts and colored points count as mapped.
class Gathered {
 public:
  explicit Gathered(const TexturedScene& textured) {
    for (const io::MeshPart& part : textured.parts) {
      const auto first = static_cast<Index>(points_.size());
      add(part.points, part.normals);
      known_.insert(known_.end(), part.points.size(), part.texture ? 0.0 : std::numeric_limits<double>::quiet_NaN());
      if (faces_.empty()) faces_.push_back(0);
      for (std::size_t f = 0; f < part.faces.size(); ++f) {
        for (Offset c = part.faces.begin[f]; c < part.faces.begin[f + 1]; ++c)
          vertices_.push_back(first + part.faces.vertices[c]);
        faces_.push_back(static_cast<Offset>(vertices_.size()));
      }
    }
    add(textured.points, textured.normals);
    known_.insert(known_.end(), textured.points.size(), 0.0);
    scene.points = points_, scene.normals = normals_, scene.u = known_, scene.v = known_;
    if (textured.points.empty()) scene.face_begin = faces_, scene.face_vertices = vertices_;
    scene.source = textured.towards;
  }
  Gathered(const Gathered&) = delete;

  Scene scene;

 private:
  void add(std::span<const Vec3> points, std::span<const Vec3> normals) {
    points_.insert(points_.end(), points.begin(), points.end());
    normals_.insert(normals_.end(), normals.begin(), normals.end());
    normals_.resize(points_.size(), Vec3{});
  }

  std::vector<Vec3> points_, normals_;
  std::vector<double> known_;
  std::vector<Offset> faces_;
  std::vector<Index> vertices_;
};

void check(const TexturedScene& scene, const PictureOptions& options) {
  check_picture(options);
  if (scene.colors.size() != scene.points.size() ||
      (!scene.radii.empty() && scene.radii.size() != scene.points.size()) ||
      (!scene.normals.empty() && scene.normals.size() != scene.points.size()))
    throw InvalidArgument("scene: " + detail::counted(scene.points.size(), "point") + ", " +
                          std::to_string(scene.colors.size()) + " colors, " + std::to_string(scene.radii.size()) +
                          " radii and " + detail::counted(scene.normals.size(), "normal") +
                          "; the numbers must be equal");
}

}  // namespace

void write_textured_png(const std::filesystem::path& path, const TexturedScene& scene, const PictureOptions& options) {
  check(scene, options);
  const Gathered gathered(scene);
  const Camera camera = choose_camera(gathered.scene, shown_points(gathered.scene), options);
  std::vector<Painted> things;
  if (!scene.points.empty()) things.push_back(painted_points(scene, camera, options.threads));
  for (const io::MeshPart& part : scene.parts) things.push_back(painted(part, camera));
  io::write_png(path, develop(render(std::move(things), camera, options), options, scene.parts.empty()));
}

}  // namespace ahm::render
