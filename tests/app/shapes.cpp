#include "shapes.hpp"

#include <cmath>
#include <random>
#include <sstream>

#include "ahm/conformance/clouds.hpp"

namespace ahm::test {
namespace {

std::ostringstream precise() {
  std::ostringstream text;
  text.precision(17);
  return text;
}

}  // namespace

std::string xyz(const Points& points, const Points& normals) {
  std::ostringstream text = precise();
  for (std::size_t i = 0; i < points.size(); ++i) {
    text << points[i][0] << ' ' << points[i][1] << ' ' << points[i][2];
    if (!normals.empty()) text << ' ' << normals[i][0] << ' ' << normals[i][1] << ' ' << normals[i][2];
    text << '\n';
  }
  return text.str();
}

std::string obj(const Points& positions, const Faces& faces, int first) {
  std::ostringstream text = precise();
  for (const Vec3& p : positions) text << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  for (const auto& face : faces) {
    text << 'f';
    for (const int v : face) text << ' ' << v + first;
    text << '\n';
  }
  return text.str();
}

std::string obj(const Mesh& mesh, int first) {
  Faces faces;
  for (const auto& [a, b, c] : mesh.faces) faces.push_back({a, b, c});
  return obj(mesh.positions, faces, first);
}

std::string obj(const Polygons& mesh) {
  Faces faces;
  for (Index f = 0; f < mesh.faces(); ++f) faces.push_back(mesh.face(f));
  return obj(mesh.positions, faces);
}

Points plane(int m) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> jitter(-0.3 / m, 0.3 / m);
  Points points;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j)
      points.push_back({(i + 0.5) / m + jitter(generator), (j + 0.5) / m + jitter(generator), 0});
  std::swap(points[0], points[m / 2 * m + m / 2]);
  return points;
}

Points sphere(int n) {
  Points points = even_sphere(n).points;
  points[0] = {0, 0, 1};
  return points;
}

Points lattice(int m, double spacing, double wave) {
  Points points;
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i) points.push_back({(i + wave * std::sin(7.0 * j * i)) * spacing, j * spacing, 0});
  return points;
}

Faces cells(int m, bool triangles) {
  Faces faces;
  for (int j = 0; j + 1 < m; ++j)
    for (int i = 0; i + 1 < m; ++i) {
      const int a = j * m + i, b = a + 1, c = b + m, d = a + m;
      if (triangles)
        faces.insert(faces.end(), {{a, b, c}, {a, c, d}});
      else
        faces.push_back({a, b, c, d});
    }
  return faces;
}

std::string sheet(int m) {
  Points points;
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i) points.push_back({(i + 0.3 * std::sin(5.0 * j)) / (m - 1), 0.1 * j / (m - 1), 0});
  return obj(points, cells(m, true));
}

std::string torn_sheet(int m) {
  const Points positions = lattice(m, 1.0 / (m - 1));
  Points points;
  Faces faces;
  for (const auto& face : cells(m, true)) {
    const int first = static_cast<int>(points.size());
    for (const int v : face) points.push_back(positions[v]);
    faces.push_back({first, first + 1, first + 2});
  }
  return obj(points, faces);
}

Points moved(Points points, const Vec3& by, double scale) {
  for (Vec3& p : points)
    for (std::size_t a = 0; a < 3; ++a) p[a] = scale * p[a] + by[a];
  return points;
}

Points joined(Points a, const Points& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::string book(int m) {
  Points points;
  for (int y = 0; y < m; ++y) points.push_back({0, 0, 0.1 * y});
  Faces faces;
  for (int page = 0; page < 3; ++page) {
    const double angle = 0.4 + 0.9 * page;
    for (int x = 1; x < m; ++x)
      for (int y = 0; y < m; ++y) points.push_back({0.1 * x * std::cos(angle), 0.1 * x * std::sin(angle), 0.1 * y});
    for (std::vector<int> face : cells(m, true)) {
      for (int& v : face)
        if (v >= m) v += page * m * (m - 1);
      faces.push_back(face);
    }
  }
  return obj(points, faces);
}

std::string ply(const std::vector<std::string>& properties, std::size_t vertices, const std::string& vertex_lines,
                std::size_t faces, const std::string& face_lines) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) + "\n";
  for (const std::string& property : properties) text += "property " + property + "\n";
  if (faces > 0) text += "element face " + std::to_string(faces) + "\nproperty list uchar int vertex_indices\n";
  return text + "end_header\n" + vertex_lines + face_lines;
}

}  // namespace ahm::test
