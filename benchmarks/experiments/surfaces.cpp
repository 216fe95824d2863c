#include "experiments/surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>

#include "ahm/error.hpp"
#include "ahm/io/read.hpp"

namespace ahm::bench {
namespace {

using std::numbers::pi;

Vec3 on_sphere(double polar, double turn) {
  return {std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)};
}

/// "name.obj" and "name.obj.gz" are "name" with the type ".obj".
struct MeshFile {
  std::filesystem::path path;
  std::string name, type;
};

MeshFile mesh_file(const std::filesystem::path& path) {
  const std::filesystem::path unpacked = path.extension() == ".gz" ? path.stem() : path.filename();
  return {path, unpacked.stem().string(), unpacked.extension().string()};
}

/// Files of these types in `settings.meshes` and its subfolders, sorted by size.
std::vector<MeshFile> files_of_types(const Settings& settings, const std::vector<std::string>& types) {
  std::vector<std::pair<std::uintmax_t, std::filesystem::path>> files;
  if (!settings.meshes.empty())
    for (const auto& entry : std::filesystem::recursive_directory_iterator(settings.meshes))
      if (std::ranges::find(types, mesh_file(entry.path()).type) != types.end())
        files.emplace_back(entry.file_size(), entry.path());
  std::sort(files.begin(), files.end());
  std::vector<MeshFile> found;
  for (const auto& [size, path] : files) found.push_back(mesh_file(path));
  return found;
}

bool only_triangles(const io::Geometry& file) {
  for (std::size_t f = 0; f < file.face_count(); ++f)
    if (file.face(f).size() != 3) return false;
  return true;
}

}  // namespace

void run_or_leave_out(const std::string& name, const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& e) {
    fmt::print(stderr, "left out: {}: {}\n", name, e.what());
  }
}

UserSurfaces user_surfaces(const Settings& settings, Index largest) {
  UserSurfaces found;
  const auto add = [&](const MeshFile& input) {
    const io::Geometry file = io::read(input.path);
    if (file.face_count() == 0) throw InvalidGeometry("has no faces");
    if (static_cast<Index>(file.points.size()) > largest) return;
    if (only_triangles(file)) {
      NamedMesh& mesh = found.triangles.emplace_back(NamedMesh{{file.points, {}, {}}, input.name});
      for (std::size_t f = 0; f < file.face_count(); ++f)
        mesh.faces.push_back({file.face(f)[0], file.face(f)[1], file.face(f)[2]});
    } else {
      NamedPolygons& mesh = found.polygons.emplace_back();
      mesh.positions = file.points;
      mesh.name = input.name;
      for (std::size_t f = 0; f < file.face_count(); ++f) mesh.add({file.face(f).begin(), file.face(f).end()});
    }
  };
  for (const MeshFile& file : files_of_types(settings, {".ply", ".off", ".obj", ".stl"}))
    run_or_leave_out(file.path.string(), [&] { add(file); });
  return found;
}

std::vector<NamedCloud> user_clouds(const Settings& settings, Index largest) {
  std::vector<NamedCloud> found;
  for (const MeshFile& input : files_of_types(settings, {".xyz"}))
    run_or_leave_out(input.path.string(), [&] {
      std::vector<Vec3> points = io::read(input.path).points;
      if (static_cast<Index>(points.size()) <= largest) found.push_back({std::move(points), input.name});
    });
  return found;
}

std::vector<NamedMesh> user_meshes(const Settings& settings, Index largest) {
  UserSurfaces found = user_surfaces(settings, largest);
  for (const NamedPolygons& mesh : found.polygons)
    fmt::print(stderr, "left out: {}: is not a triangle mesh\n", mesh.name);
  return std::move(found.triangles);
}

Mesh parallels_and_meridians(int parallels, int meridians, double last) {
  Mesh mesh;
  mesh.positions.push_back(on_sphere(0, 0));
  const bool closed = last >= pi;
  const int rings = closed ? parallels - 1 : parallels;
  for (int r = 1; r <= rings; ++r)
    for (int m = 0; m < meridians; ++m)
      mesh.positions.push_back(on_sphere(last * r / parallels, 2 * pi * m / meridians));
  auto at = [&](int r, int m) { return 1 + (r - 1) * meridians + m % meridians; };
  for (int m = 0; m < meridians; ++m) {
    mesh.faces.push_back({0, at(1, m), at(1, m + 1)});
    for (int r = 1; r < rings; ++r) {
      mesh.faces.push_back({at(r, m), at(r + 1, m), at(r + 1, m + 1)});
      mesh.faces.push_back({at(r, m), at(r + 1, m + 1), at(r, m + 1)});
    }
  }
  if (!closed) return mesh;
  mesh.positions.push_back(on_sphere(pi, 0));
  for (int m = 0; m < meridians; ++m)
    mesh.faces.push_back({static_cast<Index>(mesh.positions.size() - 1), at(rings, m + 1), at(rings, m)});
  return mesh;
}

Mesh with_needles(Index n) {
  Mesh mesh = split_icosphere(n);
  std::vector<Triangle> faces;
  for (const auto& [a, b, c] : mesh.faces) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = 0.5 * mesh.positions[a][axis] + 0.49 * mesh.positions[b][axis] + 0.01 * mesh.positions[c][axis];
    const auto middle = static_cast<Index>(mesh.positions.size());
    mesh.positions.push_back(unit(p));
    faces.insert(faces.end(), {{a, b, middle}, {b, c, middle}, {c, a, middle}});
  }
  mesh.faces = faces;
  return mesh;
}

Mesh sliver_sphere(Index n) {
  Mesh mesh = split_icosphere(642);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0.05, 1.0);
  while (static_cast<Index>(mesh.positions.size()) < n) {
    const auto f = static_cast<std::size_t>(random() % mesh.faces.size());
    const auto [a, b, c] = mesh.faces[f];
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = x * mesh.positions[a][axis] + y * mesh.positions[b][axis] + z * mesh.positions[c][axis];
    const auto middle = static_cast<Index>(mesh.positions.size());
    mesh.positions.push_back(unit(p));
    mesh.faces[f] = {a, b, middle};
    mesh.faces.insert(mesh.faces.end(), {{b, c, middle}, {c, a, middle}});
  }
  return mesh;
}

Mesh jittered_icosphere(Index n, double amount) {
  Mesh mesh = split_icosphere(n);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double edge = std::sqrt(4 * pi / (std::sqrt(3.0) / 2 * static_cast<double>(mesh.positions.size())));
  for (Vec3& p : mesh.positions) {
    for (double& x : p) x += amount * edge * uniform(random);
    p = unit(p);
  }
  return mesh;
}

Mesh stretched_icosphere(Index n, double factor) {
  Mesh mesh = split_icosphere(n);
  for (Vec3& p : mesh.positions) p = unit({p[0], p[1], factor * p[2]});
  return mesh;
}

Mesh ellipsoid(Index n) {
  Mesh mesh = split_icosphere(n);
  for (Vec3& p : mesh.positions) p[2] *= 2;
  return mesh;
}

Mesh bumpy_sphere(Index n) {
  Mesh mesh = split_icosphere(n);
  for (Vec3& p : mesh.positions) {
    const double r = 1 + 0.1 * std::sin(5 * p[0]) * std::sin(5 * p[1] + 1) * std::sin(5 * p[2] + 2);
    for (double& x : p) x *= r;
  }
  return mesh;
}

Mesh cone(double angle, int rings) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-0.15, 0.15);
  const double narrow = angle / (2 * std::numbers::pi), steep = std::sqrt(1 - narrow * narrow);
  Mesh mesh{{{0, 0, 0}}, {}};
  std::vector<int> first{0}, count{1};
  for (int k = 1; k <= rings; ++k) {
    first.push_back(static_cast<int>(mesh.positions.size()));
    count.push_back(std::max(3, static_cast<int>(std::lround(angle * k))));
    for (int i = 0; i < count[k]; ++i) {
      const double turn = (i + 0.5 * (k % 2) + jitter(random)) / count[k] * 2 * std::numbers::pi;
      const double r = (k + (k < rings ? jitter(random) : 0)) / rings;
      mesh.positions.push_back({r * narrow * std::cos(turn), r * narrow * std::sin(turn), -r * steep});
    }
  }
  for (int i = 0; i < count[1]; ++i) mesh.faces.push_back({0, 1 + i, 1 + (i + 1) % count[1]});
  for (int k = 1; k < rings; ++k) {
    const auto turn = [&](int ring, int i) { return (i + 0.5 * (ring % 2)) / count[ring]; };
    for (int i = 0, j = 0; i < count[k] || j < count[k + 1];) {
      const bool inner = j == count[k + 1] || (i < count[k] && turn(k, i + 1) < turn(k + 1, j + 1));
      const int a = first[k] + i % count[k], b = first[k + 1] + j % count[k + 1];
      inner ? ++i : ++j;
      mesh.faces.push_back({a, b, inner ? first[k] + i % count[k] : first[k + 1] + j % count[k + 1]});
    }
  }
  return mesh;
}

Mesh closed_cone(double angle, int rings) {
  Mesh mesh = cone(angle, rings);
  const Mesh upper = mesh;
  const double rim = upper.positions.back()[2];
  std::vector<Index> mirrored;  // for each vertex of the upper cone its mirror image; the vertices of the rim are
                                // shared
  for (Index i = 0; i < static_cast<Index>(upper.positions.size()); ++i) {
    const Vec3& p = upper.positions[i];
    mirrored.push_back(p[2] == rim ? i : static_cast<Index>(mesh.positions.size()));
    if (mirrored.back() != i) mesh.positions.push_back({p[0], p[1], 2 * rim - p[2]});
  }
  for (const auto& [a, b, c] : upper.faces) mesh.faces.push_back({mirrored[a], mirrored[c], mirrored[b]});
  return mesh;
}

Mesh tube(int around, double radius) {
  Mesh mesh;
  const int rings = 1 + static_cast<int>(std::lround(around / (pi * radius)));
  for (int r = 0; r < rings; ++r)
    for (int m = 0; m < around; ++m)
      mesh.positions.push_back(
          {2.0 * r / (rings - 1), radius * std::cos(2 * pi * m / around), radius * std::sin(2 * pi * m / around)});
  for (int r = 0; r + 1 < rings; ++r)
    for (int m = 0; m < around; ++m) {
      const Index a = r * around + m, b = r * around + (m + 1) % around;
      mesh.faces.push_back({a, a + around, b});
      mesh.faces.push_back({b, a + around, b + around});
    }
  return mesh;
}

}  // namespace ahm::bench
