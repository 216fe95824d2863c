#include "ahm/conformance/triangle_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace ahm::test {
namespace {

using std::numbers::pi;

/// A point (u, v) of a plane in general position.
Vec3 tilted(double u, double v) {
  const Vec3 x{2.0 / 3, -1.0 / 3, 2.0 / 3}, y{2.0 / 3, 2.0 / 3, -1.0 / 3};
  return {u * x[0] + v * y[0] + 3, u * x[1] + v * y[1], u * x[2] + v * y[2] - 1};
}

void tilt(Mesh& mesh) {
  mesh.positions.clear();
  for (const auto& p : mesh.plane) mesh.positions.push_back(tilted(p[0], p[1]));
}

/// Adds the quad a b c d as two triangles, cut along its diagonal ac or bd.
void add_quad(Mesh& mesh, Index a, Index b, Index c, Index d, bool cut_ac) {
  if (cut_ac) {
    mesh.faces.push_back({a, b, c});
    mesh.faces.push_back({a, c, d});
  } else {
    mesh.faces.push_back({a, b, d});
    mesh.faces.push_back({b, c, d});
  }
}

/// A jittered grid of side x side points in the unit square with random diagonals. Border points stay on the border. With
/// jitter up to 0.25 spacings every quad is convex.
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
      add_quad(mesh, a, b, c, d, random() % 2 != 0);
    }
  return mesh;
}

/// Embeds the plane as z = 0.
void lift(Mesh& mesh) {
  for (const auto& p : mesh.plane) mesh.positions.push_back({p[0], p[1], 0.0});
}

/// Keeps the marked faces and the vertices that they use.
void keep_faces(Mesh& mesh, const std::vector<bool>& keep) {
  std::vector<Triangle> faces;
  for (std::size_t f = 0; f < keep.size(); ++f)
    if (keep[f]) faces.push_back(mesh.faces[f]);
  std::vector<Index> number(mesh.plane.size(), -1);
  std::vector<Vec2> plane;
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

Vec2 Mesh::plane_point(Index face, const Vec3& barycentric) const {
  Vec2 p{0, 0};
  for (int s = 0; s < 3; ++s)
    for (int a = 0; a < 2; ++a) p[a] += barycentric[s] * plane[faces[face][s]][a];
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
    Vec2 p{0, 0};
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

Mesh joined(Mesh mesh, const Mesh& other, const Vec3& shift) {
  const Index offset = mesh.vertices();
  for (const Vec3& p : other.positions) mesh.positions.push_back({p[0] + shift[0], p[1] + shift[1], p[2] + shift[2]});
  for (const Triangle& f : other.faces) mesh.faces.push_back({f[0] + offset, f[1] + offset, f[2] + offset});
  mesh.plane.clear();
  return mesh;
}

Mesh torus(Index n) {
  const auto around = static_cast<Index>(std::sqrt(2.5 * n)), across = n / around;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-0.25, 0.25);
  Mesh mesh;
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j < across; ++j) {
      const double u = 2 * pi * (i + jitter(random)) / around, v = 2 * pi * (j + jitter(random)) / across,
                   r = 1 + 0.4 * std::cos(v);
      mesh.positions.push_back({r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)});
    }
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j < across; ++j) {
      auto at = [&](Index x, Index y) { return x % around * across + y % across; };
      const Index a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      add_quad(mesh, a, b, c, d, random() % 2 != 0);
    }
  return mesh;
}

Mesh dented_square(Index n) {
  Mesh mesh = flat_square(n, 0);
  for (std::size_t k = 0; k < mesh.plane.size(); ++k) {
    const auto i = static_cast<Index>(k) % n, j = static_cast<Index>(k) / n;
    mesh.plane[k] = {static_cast<double>(i), j == 0 && i % 2 == 1 ? 1e-3 : j};
    mesh.positions[k] = {mesh.plane[k][0], mesh.plane[k][1], 0};
  }
  mesh.faces.clear();
  for (Index j = 0; j + 1 < n; ++j)
    for (Index i = 0; i + 1 < n; ++i) {
      const Index k = j * n + i;
      mesh.faces.push_back({k, k + 1, k + n});
      mesh.faces.push_back({k + 1, k + n + 1, k + n});
    }
  for (Index i = 0; i + 2 < n; i += 2) mesh.faces.push_back({i, i + 2, i + 1});
  return mesh;
}

Mesh flat_square(Index side, double jitter, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-jitter, jitter);
  Mesh mesh;
  auto inside = [&](Index i) { return i > 0 && i + 1 < side; };
  for (Index j = 0; j < side; ++j)
    for (Index i = 0; i < side; ++i) {
      const double a = uniform(random), b = uniform(random);
      mesh.plane.push_back(
          {(i + (inside(i) ? a : 0)) / (side - 1), (j + (inside(j) && j != side / 2 ? b : 0)) / (side - 1)});
    }
  for (Index j = 0; j + 1 < side; ++j)
    for (Index i = 0; i + 1 < side; ++i) {
      const Index a = j * side + i, b = a + 1, c = b + side, d = a + side;
      add_quad(mesh, a, b, c, d, random() % 2 != 0);
    }
  lift(mesh);
  return mesh;
}

Mesh hexagon(Index rings) {
  Mesh mesh;
  const Index width = 2 * rings + 1;
  std::vector<Index> number(static_cast<std::size_t>(width) * static_cast<std::size_t>(width), -1);
  auto at = [&](Index i, Index j) -> Index& { return number[(j + rings) * width + i + rings]; };
  auto exists = [&](Index i, Index j) { return std::max({std::abs(i), std::abs(j), std::abs(i + j)}) <= rings; };
  auto add = [&](Index i, Index j) {
    at(i, j) = static_cast<Index>(mesh.plane.size());
    mesh.plane.push_back({i + 0.5 * j, std::sqrt(0.75) * j});
  };
  add(0, 0);
  for (Index j = -rings; j <= rings; ++j)
    for (Index i = -rings; i <= rings; ++i)
      if (exists(i, j) && at(i, j) < 0) add(i, j);
  for (Index j = -rings; j < rings; ++j)
    for (Index i = -rings; i < rings; ++i) {
      if (exists(i + 1, j) && exists(i, j + 1)) {
        if (exists(i, j)) mesh.faces.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (exists(i + 1, j + 1)) mesh.faces.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  lift(mesh);
  return mesh;
}

Index nearest(const Mesh& mesh, const Vec2& point) {
  Index best = 0;
  auto distance = [&](Index i) { return std::hypot(mesh.plane[i][0] - point[0], mesh.plane[i][1] - point[1]); };
  for (Index i = 1; i < mesh.vertices(); ++i)
    if (distance(i) < distance(best)) best = i;
  return best;
}

double plane_error(const std::vector<Vec2>& plane, std::span<const double> u, std::span<const double> v,
                   const Vec2& origin, const Vec2& axis) {
  double worst = 0;
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const double x = plane[i][0] - origin[0], y = plane[i][1] - origin[1];
    const double off = std::hypot(u[i] - (axis[0] * x + axis[1] * y), v[i] - (axis[0] * y - axis[1] * x));
    if (!std::isfinite(off)) return INFINITY;
    worst = std::max(worst, off);
  }
  return worst;
}

}  // namespace ahm::test
