/// \file
/// A sphere of triangles, sessions on it, and their answers.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/viewer/session.hpp"

namespace ahm::viewer::test {

using nlohmann::json;

struct Sphere {
  ahm::test::Mesh mesh;
  trimesh::TriangleMeshSurface surface;
  io::Geometry geometry;

  explicit Sphere(Index subdivisions = 8)
      : mesh(ahm::test::icosphere(subdivisions)),
        surface(trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces)) {
    geometry.points = mesh.positions;
    geometry.face_begin.push_back(0);
    for (const Triangle& t : mesh.faces) {
      geometry.face_vertices.insert(geometry.face_vertices.end(), t.begin(), t.end());
      geometry.face_begin.push_back(static_cast<Offset>(geometry.face_vertices.size()));
    }
  }
};

inline SessionOptions sphere_options() {
  SessionOptions options;
  options.title = options.input = "sphere.ply";
  return options;
}

/// The JSON text and the arrays of a bundle.
struct Bundle {
  json meta;
  std::string data;

  explicit Bundle(const std::string& bytes) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 4, sizeof length);
    meta = json::parse(bytes.substr(8, length));
    data = bytes.substr(8 + length);
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
