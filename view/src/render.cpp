#include "render.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "gl.hpp"
#include "resources.hpp"

namespace ahm::view {
namespace {

using Matrix4 = Eigen::Matrix4f;

Matrix4 view_matrix(const Camera& camera) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.block<1, 3>(0, 0) = camera.right.transpose();
  m.block<1, 3>(1, 0) = camera.up.transpose();
  m.block<1, 3>(2, 0) = camera.back.transpose();
  m.block<3, 1>(0, 3) = -m.block<3, 3>(0, 0) * camera.eye();
  return m.cast<float>();
}

Matrix4 projection_matrix(const Camera& camera, double aspect) {
  const double f = 1 / std::tan(Camera::field_of_view / 2), n = camera.near_plane, r = camera.far_plane;
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = f / aspect;
  m(1, 1) = f;
  m(2, 2) = -(r + n) / (r - n);
  m(2, 3) = -2 * r * n / (r - n);
  m(3, 2) = -1;
  return m.cast<float>();
}

/// `palette.glsl` after the #version line.
std::string with_palette(std::string_view shader) {
  const std::size_t line = shader.find('\n') + 1;
  return std::string(shader.substr(0, line)) + std::string(resources::palette) + std::string(shader.substr(line));
}

/// Side length of the square of rendered pixels behind one pixel of the picture; 1 if the picture is large by itself.
int supersampling(const PictureOptions& options) {
  return 2 * std::max(options.width, options.height) <= 8192 && options.width * options.height <= 8'000'000 ? 2 : 1;
}

void upload(GlVertices& vertices, const Drawable& drawable) {
  const std::size_t n = drawable.positions.size();
  if (n == 0) return;
  vertices.attribute(0, 3, drawable.positions.front().data(), n);
  vertices.attribute(1, 3, drawable.normals.front().data(), n);
  vertices.attribute(2, 2, drawable.uv.front().data(), n);
  vertices.attribute(3, 1, drawable.known.data(), n);
  if (drawable.is_mesh())
    vertices.triangles(drawable.triangles);
  else
    vertices.attribute(4, 1, drawable.radii.data(), n);
}

struct Lens {
  Matrix4 view, projection;
  float pixels_per_unit;  // at depth 1
  int height;             // in pixels
};

void set_lens(const GlFunctions& gl, const GlProgram& program, const Lens& lens) {
  program.use();
  gl.glUniformMatrix4fv(program.uniform("view"), 1, GL_FALSE, lens.view.data());
  gl.glUniformMatrix4fv(program.uniform("projection"), 1, GL_FALSE, lens.projection.data());
  gl.glUniform1f(program.uniform("pixels_per_unit"), lens.pixels_per_unit);
}

void draw_mesh(const GlContext& context, const GlTarget& target, const Drawable& drawable, const Lens& lens) {
  const GlFunctions& gl = context.gl();
  const GlProgram program(context, resources::mesh_vertex, resources::mesh_fragment);
  set_lens(gl, program, lens);
  target.bind({true, true, true});
  gl.glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(drawable.triangles.size()), GL_UNSIGNED_INT, nullptr);
}

void draw_splats(const GlContext& context, const GlTarget& target, const Drawable& drawable, const Lens& lens) {
  const GlFunctions& gl = context.gl();
  gl.glEnable(GL_PROGRAM_POINT_SIZE);
  const auto points = static_cast<GLsizei>(drawable.positions.size());
  const auto draw = [&](const GlProgram& program, float reach, bool skip_hidden) {
    set_lens(gl, program, lens);
    gl.glUniform1f(program.uniform("reach"), reach);
    gl.glUniform1i(program.uniform("skip_hidden"), skip_hidden ? 1 : 0);
    gl.glDrawArrays(GL_POINTS, 0, points);
  };
  target.bind({true, false, false});
  draw(GlProgram(context, resources::splat_vertex, resources::splat_fragment), 1, false);

  const GlTarget sums(context, target, {1, 2});
  sums.bind({true, true});
  target.bind_texture(0, 0);
  gl.glDisable(GL_DEPTH_TEST);
  gl.glEnable(GL_BLEND);
  gl.glBlendFunc(GL_ONE, GL_ONE);
  draw(GlProgram(context, resources::splat_vertex, resources::blend_fragment), 1.5F,
       true);  // wider, for a smoother mean
  gl.glDisable(GL_BLEND);
}

/// Median radius of the discs in scene units, the typical distance between points; 0 for a mesh.
double typical_spacing(const Drawable& drawable) {
  if (drawable.is_mesh()) return 0;
  std::vector<float> radii = drawable.radii;
  std::nth_element(radii.begin(), radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2), radii.end());
  return radii[radii.size() / 2];
}

/// Distance between points; zero for a mesh.
struct Spacing {
  double in_scene, in_rings;
};

/// Fills the bound target from the layers.
void paint(const GlContext& context, const GlTarget& layers, const Lens& lens, const Spacing& spacing,
           const PictureOptions& options, const Legend& legend) {
  const GlFunctions& gl = context.gl();
  const int factor = supersampling(options);
  gl.glDisable(GL_DEPTH_TEST);
  const GlProgram shade(context, resources::shade_vertex, with_palette(resources::shade_fragment));
  shade.use();
  for (GLuint unit = 0; unit < 3; ++unit) {
    layers.bind_texture(unit, unit);
    constexpr std::array names = {"winners", "map_sums", "normal_sums"};
    gl.glUniform1i(shade.uniform(names[unit]), static_cast<GLint>(unit));
  }
  gl.glUniform1i(shade.uniform("pattern"), static_cast<GLint>(options.pattern));
  gl.glUniform1f(shade.uniform("sectors"), static_cast<float>(options.sectors));
  gl.glUniform1f(shade.uniform("spacing"), static_cast<float>(spacing.in_rings));
  gl.glUniform1f(shade.uniform("gap"), static_cast<float>(4 * spacing.in_scene));
  gl.glUniform1f(shade.uniform("pixels_per_unit"), lens.pixels_per_unit);
  gl.glUniform1f(shade.uniform("detail"), std::max(1.0F, static_cast<float>(lens.height) / 800.0F));
  gl.glUniform3f(shade.uniform("legend"), static_cast<float>(factor * legend.x),
                 static_cast<float>(lens.height - factor * legend.y), static_cast<float>(factor * legend.radius));
  gl.glUniform1f(shade.uniform("legend_rings"), static_cast<float>(legend.rings));
  gl.glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// Of what has been drawn into the bound target.
std::vector<float> read_depths(const GlFunctions& gl, const Camera& camera, int width, int height) {
  std::vector<float> depths(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  gl.glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
  const auto n = static_cast<float>(camera.near_plane), f = static_cast<float>(camera.far_plane);
  for (float& depth : depths)  // the inverse of the projection
    depth = depth < 1 ? n * f / (f - depth * (f - n)) : std::numeric_limits<float>::infinity();
  return depths;
}

/// Mean of factor x factor pixels, as light adds up (not as sRGB numbers do); rows are turned over, OpenGL's go
/// upwards.
Image reduce(const std::vector<std::uint8_t>& rgba, int width, int height, int factor) {
  std::array<float, 256> light;
  for (std::size_t k = 0; k < light.size(); ++k) {
    const double s = static_cast<double>(k) / 255;
    light[k] = static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
  }
  Image image(width, height);
  const auto stride = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(factor);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      image.pixel(x, y)[3] = 255;
      for (std::size_t channel = 0; channel < 3; ++channel) {
        float sum = 0;
        for (int j = 0; j < factor; ++j)
          for (int i = 0; i < factor; ++i)
            sum += light[rgba[static_cast<std::size_t>((height - 1 - y) * factor + j) * stride +
                              4 * static_cast<std::size_t>(x * factor + i) + channel]];
        // The nearest of the 256 tones by light; the table grows, so a binary search finds it without powers.
        const float mean = sum / static_cast<float>(factor * factor);
        auto above = std::lower_bound(light.begin(), light.end(), mean);
        if (above == light.end()) --above;
        if (above != light.begin() && mean - above[-1] < above[0] - mean) --above;
        image.pixel(x, y)[channel] = static_cast<std::uint8_t>(above - light.begin());
      }
    }
  return image;
}

}  // namespace

bool Rendering::shows(const Camera& camera, const Eigen::Vector3d& position, double tolerance) const {
  const double depth = -camera.to_view(position).z();
  if (depth < camera.near_plane) return false;
  const Eigen::Vector3d pixel = camera.to_pixels(position, image.width, image.height);
  const int x = static_cast<int>(std::floor(pixel.x() * factor)), y = static_cast<int>(std::floor(pixel.y() * factor));
  const int width = factor * image.width, height = factor * image.height;
  if (x < 0 || y < 0 || x >= width || y >= height) return false;
  return depth < tolerance + static_cast<double>(
                                 depths[static_cast<std::size_t>(height - 1 - y) * static_cast<std::size_t>(width) +
                                        static_cast<std::size_t>(x)]);
}

Rendering render(const Drawable& drawable, const Camera& camera, double ring_width, const PictureOptions& options,
                 const Legend& legend) {
  const int factor = supersampling(options), width = factor * options.width, height = factor * options.height;
  const Lens lens{view_matrix(camera), projection_matrix(camera, static_cast<double>(width) / height),
                  static_cast<float>(0.5 * height / std::tan(Camera::field_of_view / 2)), height};
  const GlContext context;
  const GlFunctions& gl = context.gl();
  const GlTarget layers(context, width, height, {GL_RGBA32F, GL_RGBA32F, GL_RGBA32F}, true);
  layers.bind({true, true, true});
  gl.glClearColor(0, 0, 0, 0);
  gl.glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl.glEnable(GL_DEPTH_TEST);
  gl.glDepthFunc(GL_LEQUAL);
  GlVertices vertices(context);
  upload(vertices, drawable);
  drawable.is_mesh() ? draw_mesh(context, layers, drawable, lens) : draw_splats(context, layers, drawable, lens);
  layers.bind({true, true, true});
  std::vector<float> depths = read_depths(gl, camera, width, height);
  context.check("drawing the scene");

  const GlTarget picture(context, width, height, {GL_RGBA8}, false);
  picture.bind({true});
  const double spacing = typical_spacing(drawable);
  paint(context, layers, lens, {spacing, spacing * camera.scale / ring_width}, options, legend);
  std::vector<std::uint8_t> rgba(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  gl.glReadBuffer(GL_COLOR_ATTACHMENT0);
  gl.glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  context.check("painting the picture");
  return {reduce(rgba, options.width, options.height, factor), factor, std::move(depths)};
}

}  // namespace ahm::view
