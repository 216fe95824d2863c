// A plane patch with its exact map, as a mesh or a cloud.
#pragma once

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "ahm/render/picture.hpp"
#include "support/temporary_folder.hpp"

namespace ahm::render::test {

/// The square [-1, 1]^2 in the plane z = 0 around `center`, source in its middle: u = x, v = y.
struct Patch {
  std::vector<Vec3> points, normals;
  std::vector<Offset> face_begin;
  std::vector<Index> face_vertices;
  std::vector<double> u, v;
  Vec3 center;

  explicit Patch(int n, bool is_mesh, Vec3 at = {0, 0, 0}) : center(at) {
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        u.push_back(2.0 * i / n - 1);
        v.push_back(2.0 * j / n - 1);
        points.push_back({at[0] + u.back(), at[1] + v.back(), at[2]});
        normals.push_back({0, 0, 1});
      }
    if (!is_mesh) return;
    face_begin.push_back(0);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int a = j * (n + 1) + i;
        for (const int k : {a, a + 1, a + n + 2, a + n + 1}) face_vertices.push_back(k);
        face_begin.push_back(static_cast<Offset>(face_vertices.size()));
      }
  }

  Scene scene() const {
    Scene scene;
    scene.points = points;
    scene.normals = normals;
    scene.face_begin = face_begin;
    scene.face_vertices = face_vertices;
    scene.u = u;
    scene.v = v;
    scene.source = center;
    scene.source_axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    scene.title = "patch";
    return scene;
  }

  void forget_map() {
    u.assign(u.size(), std::numeric_limits<double>::quiet_NaN());
    v = u;
  }
};

/// A new folder, removed with all it holds.
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
