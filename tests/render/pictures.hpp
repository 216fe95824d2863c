/// \file
/// Scenes with exact maps, and pixels of their pictures.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/render/picture.hpp"
#include "support/temporary_folder.hpp"

namespace ahm::render::test {

/// The square [-1, 1]^2 in the plane z = 0 around `center`, with n x n faces or none. Source: the center; u = x, v = y.
struct Patch {
  std::vector<Vec3> points, normals;
  std::vector<Offset> face_begin;
  std::vector<Index> face_vertices;
  std::vector<double> u, v;
  Vec3 center;

  Patch(int n, bool is_mesh, Vec3 at = {0, 0, 0}) : center(at) {
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        u.push_back(2.0 * i / n - 1);
        v.push_back(2.0 * j / n - 1);
        points.push_back({at[0] + u.back(), at[1] + v.back(), at[2]});
        normals.push_back({0, 0, 1});
      }
    for (int j = 0; is_mesh && j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int a = j * (n + 1) + i;
        add_face({a, a + 1, a + n + 2, a + n + 1});
      }
  }
  void add_face(const std::vector<Index>& corners) {
    if (face_begin.empty()) face_begin.push_back(0);
    face_vertices.insert(face_vertices.end(), corners.begin(), corners.end());
    face_begin.push_back(static_cast<Offset>(face_vertices.size()));
  }
  void remove_map() { u.assign(u.size(), NAN), v = u; }

  Scene scene() const {
    Scene scene;
    scene.points = points, scene.normals = normals;
    scene.face_begin = face_begin, scene.face_vertices = face_vertices;
    scene.u = u, scene.v = v;
    scene.source = center;
    scene.source_axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    scene.title = "patch";
    return scene;
  }
};

using Rgb = std::array<int, 3>;

inline bool is_white(const Rgb& c) { return c == Rgb{255, 255, 255}; }
inline bool is_drawn(const Rgb& c) { return !is_white(c); }
inline bool is_red(const Rgb& c) { return c[0] > 200 && c[1] < 50 && c[2] < 60; }  // as all marks
inline int saturation(const Rgb& c) { return std::max({c[0], c[1], c[2]}) - std::min({c[0], c[1], c[2]}); }
inline bool is_colored(const Rgb& c) { return saturation(c) > 30; }
inline int brightness(const Rgb& c) { return c[0] + c[1] + c[2]; }
inline int difference(const Rgb& a, const Rgb& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

/// A view from +z in 400 x 300 pixels.
inline PictureOptions from_above() {
  PictureOptions options;
  options.width = 400, options.height = 300;
  options.view_direction = {{0, 0, 1}};
  return options;
}

class Pixels {
 public:
  explicit Pixels(Image image) : width(image.width), height(image.height), image_(std::move(image)) {}
  explicit Pixels(const Scene& scene, const PictureOptions& options = from_above())
      : Pixels(draw_picture(scene, options)) {}

  const int width, height;
  Rgb operator()(int x, int y) const {
    const std::uint8_t* p = image_.pixel(x, y);
    return {p[0], p[1], p[2]};
  }
  /// The place (x, y) of a patch in a view `from_above`. The patch fills the height, except for a margin.
  Rgb at(double x, double y) const {
    const double scale = 0.5 * 300 / 1.08;
    return (*this)(static_cast<int>(200 + scale * x), static_cast<int>(150 - scale * y));
  }
  template <class Predicate>
  int count(const Predicate& predicate) const {
    int result = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) result += predicate((*this)(x, y)) ? 1 : 0;
    return result;
  }
  const Image& image() const { return image_; }

 private:
  Image image_;
};

class Folder : public ahm::test::TemporaryFolder {
 public:
  std::filesystem::path operator/(const std::string& name) const { return directory() / name; }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(directory()), {}));
  }
};

inline std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace ahm::render::test
