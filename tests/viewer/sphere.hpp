/// \file
/// A sphere of triangles and a session on it, for the tests of the viewer.
#pragma once

#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/viewer/session.hpp"

namespace ahm::viewer::test {

using nlohmann::json;

struct Sphere {
  io::Geometry geometry;
  trimesh::TriangleMeshSurface surface;

  explicit Sphere(Index parts = 8) : geometry(make(parts)), surface(build(geometry)) {}

  static io::Geometry make(Index parts) {
    const auto mesh = ahm::test::icosphere(parts);
    io::Geometry geometry;
    geometry.points = mesh.positions;
    geometry.face_begin.push_back(0);
    for (const Triangle& t : mesh.faces) {
      geometry.face_vertices.insert(geometry.face_vertices.end(), t.begin(), t.end());
      geometry.face_begin.push_back(static_cast<Offset>(geometry.face_vertices.size()));
    }
    return geometry;
  }

  static trimesh::TriangleMeshSurface build(const io::Geometry& geometry) {
    std::vector<Triangle> faces;
    for (std::size_t f = 0; f < geometry.face_count(); ++f)
      faces.push_back({geometry.face(f)[0], geometry.face(f)[1], geometry.face(f)[2]});
    return trimesh::TriangleMeshSurface::build(geometry.points, faces);
  }
};

inline SessionOptions sphere_options() {
  SessionOptions options;
  options.title = options.input = "sphere.ply";
  return options;
}

/// A bundle taken apart, without the page's script.
struct Unpacked {
  json meta;
  std::string data;

  explicit Unpacked(const std::string& bundle) {
    std::uint32_t length = 0;
    std::memcpy(&length, bundle.data() + 4, sizeof length);
    meta = json::parse(bundle.substr(8, length));
    data = bundle.substr(8 + length);
  }

  template <class T>
  std::vector<T> array(const std::string& name) const {
    const json& entry = meta.at("arrays").at(name);
    std::vector<T> out(entry.at("count").get<std::size_t>());
    std::memcpy(out.data(), data.data() + entry.at("at").get<std::size_t>(), out.size() * sizeof(T));
    return out;
  }
};

}  // namespace ahm::viewer::test
