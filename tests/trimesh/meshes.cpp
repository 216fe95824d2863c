#include "meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

namespace ahm::test {
namespace {

using std::numbers::pi;

/// A plane in general position.
Vec3 tilted(double u, double v) {
  const Vec3 x{2.0 / 3, -1.0 / 3, 2.0 / 3}, y{2.0 / 3, 2.0 / 3, -1.0 / 3};
  return {u * x[0] + v * y[0] + 3, u * x[1] + v * y[1], u * x[2] + v * y[2] - 1};
}

void tilt(Mesh& mesh) {
  mesh.positions.clear();
  for (const auto& p : mesh.plane) mesh.positions.push_back(tilted(p[0], p[1]));
}

/// A jittered grid of side x side points in the unit square, random diagonals. Border points stay on the border. Up to
/// 0.25 spacings of jitter every quad is convex.
Mesh jittered_grid(Index side, unsigned seed, double jitter_u = 0.24, double jitter_v = 0.24) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Mesh mesh;
  for (Index i = 0; i < side; ++i)
    for (Index j = 0; j < side; ++j) {
      const double a = i > 0 && i + 1 < side ? jitter_u * uniform(random) : 0,
                   b = j > 0 && j + 1 < side ? jitter_v * uniform(random) : 0;
      mesh.plane.push_back({(i + a) / (side - 1), (j + b) / (side - 1)});
    }
  for (Index i = 0; i + 1 < side; ++i)
    for (Index j = 0; j + 1 < side; ++j) {
      const Index a = i * side + j, b = a + side, c = b + 1, d = a + 1;
      if (random() % 2) {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({a, c, d});
      } else {
        mesh.faces.push_back({a, b, d});
        mesh.faces.push_back({b, c, d});
      }
    }
  return mesh;
}

/// Drops faces, and the vertices that no face uses then.
void keep_faces(Mesh& mesh, const std::vector<bool>& keep) {
  std::vector<Triangle> faces;
  for (std::size_t f = 0; f < keep.size(); ++f)
    if (keep[f]) faces.push_back(mesh.faces[f]);
  std::vector<Index> number(mesh.plane.size(), -1);
  std::vector<std::array<double, 2>> plane;
  for (Triangle& t : faces)
    for (Index& v : t) {
      if (number[v] < 0) {
        number[v] = static_cast<Index>(plane.size());
        plane.push_back(mesh.plane[v]);
      }
      v = number[v];
    }
  mesh.faces = faces;
  mesh.plane = plane;
}

}  // namespace

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

std::array<double, 2> Mesh::plane_point(const FacePoint& point) const {
  std::array<double, 2> p{0, 0};
  for (int s = 0; s < 3; ++s)
    for (int a = 0; a < 2; ++a) p[a] += point.barycentric[s] * plane[faces[point.face][s]][a];
  return p;
}

double Mesh::diameter() const {
  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
  for (const auto& p : plane)
    for (int a = 0; a < 2; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  return std::hypot(high[0] - low[0], high[1] - low[1]);
}

Mesh sliver_square(Index n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.1, 1.0);
  Mesh mesh;
  mesh.plane = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  while (static_cast<Index>(mesh.plane.size()) < n) {
    const std::size_t f = random() % mesh.faces.size();
    const Triangle t = mesh.faces[f];
    double b[3] = {uniform(random), uniform(random), uniform(random)};
    if (random() % 8 == 0) b[random() % 3] *= 1e-3;  // close to an edge: a cap
    const double sum = b[0] + b[1] + b[2];
    std::array<double, 2> p{0, 0};
    for (int s = 0; s < 3; ++s)
      for (int a = 0; a < 2; ++a) p[a] += b[s] / sum * mesh.plane[t[s]][a];
    const auto [x, y, z] = std::array{mesh.plane[t[0]], mesh.plane[t[1]], mesh.plane[t[2]]};
    const double area = (y[0] - x[0]) * (z[1] - x[1]) - (y[1] - x[1]) * (z[0] - x[0]);
    if (area < 1e-7) continue;
    const auto v = static_cast<Index>(mesh.plane.size());
    mesh.plane.push_back(p);
    mesh.faces[f] = {t[0], t[1], v};
    mesh.faces.push_back({t[1], t[2], v});
    mesh.faces.push_back({t[2], t[0], v});
  }
  tilt(mesh);
  return mesh;
}

Mesh holed_square(Index side, unsigned seed, double aspect) {
  Mesh mesh = jittered_grid(side, seed);
  std::vector<bool> keep;
  for (const Triangle& t : mesh.faces) {
    double u = 0, v = 0;
    for (Index k : t) u += mesh.plane[k][0] / 3, v += mesh.plane[k][1] / 3;
    keep.push_back(std::hypot(u - 0.3, v - 0.3) > 0.12 && std::hypot(u - 0.7, v - 0.65) > 0.15);
  }
  keep_faces(mesh, keep);
  for (auto& p : mesh.plane) p[1] *= aspect;
  tilt(mesh);
  return mesh;
}

Mesh maze(Index cells, unsigned seed) {
  std::mt19937_64 random(seed);
  const Index size = 2 * cells + 1;
  std::vector<bool> open(static_cast<std::size_t>(size * size), false);
  std::vector<std::array<Index, 2>> path{{1, 1}};
  open[size + 1] = true;
  while (!path.empty()) {
    const auto [x, y] = path.back();
    std::vector<std::array<Index, 2>> steps;
    for (const auto& [dx, dy] : {std::array<Index, 2>{2, 0}, {-2, 0}, {0, 2}, {0, -2}}) {
      const Index a = x + dx, b = y + dy;
      if (a > 0 && b > 0 && a < size && b < size && !open[a * size + b]) steps.push_back({dx, dy});
    }
    if (steps.empty()) {
      path.pop_back();
      continue;
    }
    const auto [dx, dy] = steps[random() % steps.size()];
    open[(x + dx / 2) * size + y + dy / 2] = open[(x + dx) * size + y + dy] = true;
    path.push_back({x + dx, y + dy});
  }
  const Index side = 2 * size + 1;
  Mesh mesh = jittered_grid(side, seed);
  std::vector<bool> keep;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto quad = static_cast<Index>(f / 2), i = quad / (side - 1), j = quad % (side - 1);
    keep.push_back(open[i / 2 * size + j / 2]);
  }
  keep_faces(mesh, keep);
  tilt(mesh);
  return mesh;
}

Mesh folded_strip(Index side, unsigned seed) {
  Mesh mesh = jittered_grid(side, seed, 0.0, 0.24);
  for (const auto& p : mesh.plane) {
    // Every column of quads slopes up or down by 45 degrees.
    const double column = p[0] * (side - 1), below = std::floor(column + 1e-9), rest = column - below;
    const double height = static_cast<Index>(below) % 2 == 0 ? rest : 1 - rest, scale = std::sqrt(0.5) / (side - 1);
    mesh.positions.push_back({column * scale, p[1], height * scale});
  }
  return mesh;
}

Mesh rolled_square(Index side, double radius, unsigned seed) {
  Mesh mesh = jittered_grid(side, seed);
  for (const auto& p : mesh.plane)
    mesh.positions.push_back({p[0], -radius * std::sin(p[1] / radius), radius * std::cos(p[1] / radius)});
  return mesh;
}

Mesh cone_patch(Index side, double angle, unsigned seed) {
  Mesh mesh = jittered_grid(side, seed);
  const double sine = angle / (2 * pi), cosine = std::sqrt(1 - sine * sine);
  for (auto& p : mesh.plane) {
    const double r = 0.5 + p[0], turn = p[1];  // angle in the plane
    mesh.positions.push_back({r * sine * std::cos(turn / sine), r * sine * std::sin(turn / sine), -r * cosine});
    p = {r * std::cos(turn), r * std::sin(turn)};
  }
  return mesh;
}

Mesh icosphere(Index parts) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const Vec3 corner[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                           {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  const Triangle face[20] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  Mesh mesh;
  std::map<std::array<long, 3>, Index> known;
  auto vertex = [&](const Triangle& t, Index i, Index j) {
    Vec3 p;
    for (int a = 0; a < 3; ++a)
      p[a] = (corner[t[0]][a] * (parts - i - j) + corner[t[1]][a] * i + corner[t[2]][a] * j) / parts;
    const double r = std::sqrt(dot(p, p));
    for (double& x : p) x /= r;
    const std::array<long, 3> key{std::lround(p[0] * 1e9), std::lround(p[1] * 1e9), std::lround(p[2] * 1e9)};
    const auto [at, added] = known.try_emplace(key, mesh.vertices());
    if (added) mesh.positions.push_back(p);
    return at->second;
  };
  for (const Triangle& t : face)
    for (Index i = 0; i < parts; ++i)
      for (Index j = 0; i + j < parts; ++j) {
        mesh.faces.push_back({vertex(t, i, j), vertex(t, i + 1, j), vertex(t, i, j + 1)});
        if (i + j + 1 < parts)
          mesh.faces.push_back({vertex(t, i + 1, j), vertex(t, i + 1, j + 1), vertex(t, i, j + 1)});
      }
  return mesh;
}

Mesh moebius_mesh(Index around, Index across) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> jitter(-0.45, 0.45);
  Mesh mesh;
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j <= across; ++j) {
      const double turn = 2 * pi * (i + jitter(random)) / around, s = 0.4 * (2.0 * j / across - 1),
                   r = 1 + s * std::cos(turn / 2);
      mesh.positions.push_back({r * std::cos(turn), r * std::sin(turn), s * std::sin(turn / 2)});
    }
  auto vertex = [&](Index i, Index j) { return i < around ? i * (across + 1) + j : across - j; };
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j < across; ++j) {
      mesh.faces.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.faces.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  return mesh;
}

PaperBand paper_band(Index around, Index across, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> jitter(-0.24, 0.24);
  PaperBand band{around, across, {}, {}, {}, {}};
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j <= across; ++j) {
      const double b = j > 0 && j < across ? jitter(random) : 0;
      band.plane.push_back({(i + jitter(random)) / around, 0.2 * (j + b) / across});
    }
  auto vertex = [&](Index i, Index j) { return i < around ? i * (across + 1) + j : across - j; };
  auto position = [&](Index i, Index j) {
    const auto& p = band.plane[vertex(i, j)];
    return i < around ? p : std::array{p[0] + 1, 0.2 - p[1]};
  };
  auto add = [&](std::array<std::array<Index, 2>, 3> corners) {
    // Faces come in both orientations.
    if (random() % 2) std::swap(corners[1], corners[2]);
    band.faces.emplace_back();
    band.lengths.emplace_back();
    for (int s = 0; s < 3; ++s) {
      band.faces.back()[s] = vertex(corners[s][0], corners[s][1]);
      band.corners.push_back(position(corners[s][0], corners[s][1]));
    }
    for (int s = 0; s < 3; ++s) {
      const auto &p = band.corners[band.corners.size() - 3 + s],
                 &q = band.corners[band.corners.size() - 3 + (s + 1) % 3];
      band.lengths.back()[s] = std::hypot(p[0] - q[0], p[1] - q[1]);
    }
  };
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j < across; ++j) {
      if (random() % 2) {
        add({{{i, j}, {i + 1, j}, {i + 1, j + 1}}});
        add({{{i, j}, {i + 1, j + 1}, {i, j + 1}}});
      } else {
        add({{{i, j}, {i + 1, j}, {i, j + 1}}});
        add({{{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}});
      }
    }
  return band;
}

double PaperBand::distance(const std::array<double, 2>& p, const std::array<double, 2>& q) const {
  double least = std::hypot(p[0] - q[0], p[1] - q[1]);
  for (double turn : {-1.0, 1.0}) least = std::min(least, std::hypot(p[0] - q[0] + turn, p[1] - (0.2 - q[1])));
  return least;
}

std::array<double, 2> sphere_log(const Vec3& p, const Vec3& x, const Vec3& y, const Vec3& q) {
  const double u = dot(x, q), v = dot(y, q), sine = std::hypot(u, v), angle = std::atan2(sine, dot(p, q));
  return sine > 0 ? std::array{angle / sine * u, angle / sine * v} : std::array{0.0, 0.0};
}

SolvedMesh::SolvedMesh(const Mesh& mesh, const trimesh::MeshOptions& options)
    : surface(trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, options)), solver(surface.graph()) {}

RowLogMap SolvedMesh::map(const Source& source, Variant variant) const {
  return surface.on_rows(solver.solve(source, {.variant = variant}));
}

double plane_error(const Mesh& mesh, const RowLogMap& map, const std::array<double, 2>& origin,
                   const std::array<double, 2>& u) {
  double worst = 0;
  Index masked = 0;
  for (std::size_t i = 0; i < mesh.plane.size(); ++i) {
    if (map.status[i] != Status::ok) {
      ++masked;
      continue;
    }
    const double x = mesh.plane[i][0] - origin[0], y = mesh.plane[i][1] - origin[1];
    worst = std::max(worst, std::hypot(map.u[i] - (u[0] * x + u[1] * y), map.v[i] - (u[0] * y - u[1] * x)));
  }
  EXPECT_EQ(masked, 0);
  return worst;
}

}  // namespace ahm::test
