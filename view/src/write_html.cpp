#include <string>

#include "ahm/error.hpp"
#include "ahm/view/picture.hpp"

#ifdef AHM_VIEW_HAS_HTML

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "ahm/io/atomic_file.hpp"
#include "check.hpp"
#include "drawable.hpp"
#include "resources.hpp"

namespace ahm::view {
namespace {

using Eigen::Vector3d;

static_assert(sizeof(Eigen::Vector2f) == 8 && sizeof(Eigen::Vector3f) == 12);  // arrays of them are arrays of floats

std::string base64(const void* data, std::size_t size) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::string out;
  out.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const auto at = [&](std::size_t k) { return k < size ? static_cast<unsigned>(bytes[k]) : 0U; };
    const unsigned word = at(i) << 16U | at(i + 1) << 8U | at(i + 2);
    out += digits[word >> 18U];
    out += digits[word >> 12U & 63U];
    out += i + 1 < size ? digits[word >> 6U & 63U] : '=';
    out += i + 2 < size ? digits[word & 63U] : '=';
  }
  return out;
}

template <class T>
std::string base64(const std::vector<T>& values) {
  return base64(values.data(), values.size() * sizeof(T));
}

/// Text that stays text wherever it stands in the page.
std::string escape(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string number(double value) {
  std::array<char, 40> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string triple(const Vector3d& x) {
  std::string out = "[";
  for (Eigen::Index k = 0; k < 3; ++k) out.append(k == 0 ? "" : ",").append(number(x[k]));
  return out.append("]");
}

std::string triples(std::span<const Vec3> points, const Camera& camera) {
  std::string out = "[";
  for (std::size_t k = 0; k < points.size(); ++k)
    out.append(k == 0 ? "" : ",").append(triple(camera.to_scene(points[k])));
  return out.append("]");
}

float largest_radius(const Drawable& drawable) {
  return drawable.is_mesh() ? 1 : *std::max_element(drawable.radii.begin(), drawable.radii.end());
}

/// The largest component of a gradient; what lies far beyond an isometry is cut off.
float steepest(const Drawable& drawable) {
  float most = 0;
  for (const auto& gradient : drawable.gradients)
    for (const Eigen::Vector3f& g : gradient) most = std::max(most, g.cwiseAbs().maxCoeff());
  return std::min(most, drawable.values_per_length);
}

/// What the viewer needs besides arrays, as JSON.
std::string describe(const Scene& scene, const Drawable& drawable, const Camera& camera, const Paint& paint,
                     const PictureOptions& options) {
  constexpr const char* patterns[] = {"polar", "grid", "cells", "distance", "none"};
  std::string axes;
  if (scene.source_axes)
    for (std::size_t k = 0; k < 2; ++k)
      axes.append(k == 0 ? "" : ",").append(triple(as_vector((*scene.source_axes)[k]).normalized()));
  std::string pieces = "0";
  for (Index piece : scene.curve_pieces) pieces.append(",").append(std::to_string(piece));
  const bool is_mapped = std::find(drawable.known.begin(), drawable.known.end(), 1.0F) != drawable.known.end();
  return std::string("{\"is_mesh\":") + (drawable.is_mesh() ? "true" : "false") +
         ",\"is_mapped\":" + (is_mapped ? "true" : "false") + ",\"pattern\":\"" +
         patterns[static_cast<std::size_t>(options.pattern)] + "\",\"sectors\":" + std::to_string(options.sectors) +
         ",\"ring_width\":" + number(paint.ring_width) + ",\"rings\":" + number(paint.rings) +
         ",\"steepest\":" + number(steepest(drawable)) + ",\"largest_radius\":" + number(largest_radius(drawable)) +
         ",\"source\":" + triple(camera.to_scene(scene.source)) + ",\"axes\":[" + axes +
         "],\"dots\":" + triples(scene.dots, camera) + ",\"curve\":" + triples(scene.curve, camera) +
         ",\"curve_pieces\":[" + pieces + "]" + ",\"eye\":" + triple(camera.eye()) +
         ",\"target\":" + triple(camera.target) + ",\"up\":" + triple(camera.up) +
         ",\"field_of_view\":" + number(Camera::field_of_view * 180 / std::numbers::pi) +
         ",\"far\":" + number(camera.far_plane) +
         ",\"aspect\":" + number(static_cast<double>(options.width) / options.height) + "}";
}

/// Coordinates with 1e30 for "none": interpolated with anything, it stays beyond any coordinate.
std::vector<Eigen::Vector2f> coordinates(const Drawable& drawable) {
  std::vector<Eigen::Vector2f> uv(drawable.values.size());
  for (std::size_t i = 0; i < uv.size(); ++i)
    uv[i] = drawable.values[i].head<2>() + Eigen::Vector2f::Constant(drawable.known[i] == 0 ? 1e30F : 0);
  return uv;
}

std::uint8_t byte(float x) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0F, 1.0F))); }

/// Normal and radius in four bytes.
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

/// Quality in a byte, 128 at one half.
std::vector<std::uint8_t> trust(const Drawable& drawable) {
  std::vector<std::uint8_t> out;
  for (const Eigen::Vector3f& value : drawable.values) out.push_back(byte(value.z()));
  return out;
}

/// Gradients in six bytes, 127 for zero.
std::vector<std::array<std::uint8_t, 6>> slopes(const Drawable& drawable) {
  std::vector<std::array<std::uint8_t, 6>> out(drawable.is_mesh() ? 0 : drawable.positions.size());
  const float scale = steepest(drawable) > 0 ? 0.5F / steepest(drawable) : 0;
  for (auto& bytes : out) bytes.fill(127);
  for (std::size_t i = 0; i < drawable.gradients.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k) {
      const float component = drawable.gradients[i][k / 3][static_cast<Eigen::Index>(k % 3)];
      out[i][k] = byte(127.0F / 255 + scale * component);
    }
  return out;
}

/// Writes the page with a value in place of every @NAME@. What a value contains is never looked at.
void fill_in(io::AtomicFile& file, std::string_view page,
             const std::vector<std::pair<std::string_view, std::string_view>>& values) {
  while (!page.empty()) {
    std::size_t nearest = std::string_view::npos, length = 0;
    std::string_view value;
    for (const auto& [name, text] : values) {
      const std::size_t at = page.find(name);
      if (at >= nearest) continue;
      nearest = at, length = name.size(), value = text;
    }
    file.write(page.substr(0, nearest));
    if (nearest == std::string_view::npos) break;
    file.write(value);
    page.remove_prefix(nearest + length);
  }
}

}  // namespace

bool can_write_html() noexcept { return true; }

void write_html(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options) {
  check(scene, options);
  const std::vector<Index> shown = shown_points(scene);
  const Camera camera = choose_camera(scene, shown, options);
  const Paint paint = make_paint(scene, shown, options);
  const Drawable drawable = make_drawable(scene, shown, camera, paint, options.threads);

  const std::string title = escape(scene.title.empty() ? "logarithmic map" : scene.title);
  const std::string meta = describe(scene, drawable, camera, paint, options);
  const std::string positions = base64(drawable.positions), uv = base64(coordinates(drawable));
  const std::string disc = base64(discs(drawable)), triangles = base64(drawable.triangles);
  const std::string trusted = base64(trust(drawable)), slope = base64(slopes(drawable));
  io::AtomicFile file(path);
  fill_in(file, resources::page,
          {{"@TITLE@", title},
           {"@META@", meta},
           {"@POSITIONS@", positions},
           {"@COORDINATES@", uv},
           {"@DISCS@", disc},
           {"@TRUST@", trusted},
           {"@SLOPES@", slope},
           {"@TRIANGLES@", triangles},
           {"@PALETTE@", resources::palette},
           {"@THREE@", resources::three},
           {"@ORBIT_CONTROLS@", resources::orbit_controls},
           {"@VIEWER@", resources::viewer}});
  file.commit();
}

}  // namespace ahm::view

#else

namespace ahm::view {

bool can_write_html() noexcept { return false; }

void write_html(const std::filesystem::path& path, const Scene&, const PictureOptions&) {
  throw Error(
      "cannot write " + path.string() +
      ": this build of libahm has no HTML pictures; install three.js (Debian: libjs-three) and configure again");
}

}  // namespace ahm::view

#endif
