#include "ahm/conformance/polygon_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

#include "ahm/conformance/vectors.hpp"
#include "icosahedron.hpp"

namespace ahm::test {
namespace {

/// A corner of a cell: its position, and the line of the side that begins there.
struct CellCorner {
  double x, y;
  Index line;
};

/// The part of a convex cell where a x + b y <= c. The new side has the number `line`.
std::vector<CellCorner> clip(const std::vector<CellCorner>& cell, double a, double b, double c, Index line) {
  std::vector<CellCorner> result;
  for (std::size_t k = 0; k < cell.size(); ++k) {
    const CellCorner &p = cell[k], &q = cell[(k + 1) % cell.size()];
    const double at_p = a * p.x + b * p.y - c, at_q = a * q.x + b * q.y - c;
    if (at_p <= 0) result.push_back(p);
    if ((at_p <= 0) == (at_q <= 0)) continue;
    const double t = at_p / (at_p - at_q);
    result.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), at_p <= 0 ? line : p.line});
  }
  return result;
}

/// Adds cells as faces. A corner is identified by the three lines or sites that meet there.
class CellCorners {
 public:
  explicit CellCorners(Polygons& mesh) : mesh_(mesh) {}

  void add(Index site, const std::vector<CellCorner>& cell, const std::function<Vec3(const CellCorner&)>& position) {
    std::vector<Index> face;
    for (std::size_t k = 0; k < cell.size(); ++k) {
      std::array<Index, 3> key{site, cell[k].line, cell[(k + cell.size() - 1) % cell.size()].line};
      std::sort(key.begin(), key.end());
      const auto [at, is_new] = number_.try_emplace(key, mesh_.vertices());
      if (is_new) mesh_.positions.push_back(position(cell[k]));
      face.push_back(at->second);
    }
    mesh_.add(face);
  }

 private:
  Polygons& mesh_;
  std::map<std::array<Index, 3>, Index> number_;
};

/// Appends the vertices of an (nx + 1) x (ny + 1) grid. The result returns the number of the vertex in column x and row y.
std::function<Index(Index, Index)> grid_vertices(Polygons& mesh, Index nx, Index ny,
                                                 const std::function<Vec2(Index, Index)>& place) {
  for (Index y = 0; y <= ny; ++y)
    for (Index x = 0; x <= nx; ++x) {
      const auto p = place(x, y);
      mesh.positions.push_back({p[0], p[1], 0});
    }
  return [nx](Index x, Index y) { return y * (nx + 1) + x; };
}

}  // namespace

void Polygons::add(const std::vector<Index>& face) {
  corners.insert(corners.end(), face.begin(), face.end());
  begin.push_back(static_cast<Offset>(corners.size()));
}

void Polygons::reverse(Index f) { std::reverse(corners.begin() + begin[f], corners.begin() + begin[f + 1]); }

double Polygons::diameter() const {
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (const auto& p : plane)
    for (int a = 0; a < 2; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  return std::hypot(high[0] - low[0], high[1] - low[1]);
}

void tilt(Polygons& mesh) {
  const Vec3 x = unit({2, 1, -1}), n = unit(cross(x, {0.3, 1, 2})), y = cross(n, x);
  for (Vec3& p : mesh.positions) {
    mesh.plane.push_back({p[0], p[1]});
    p = {0.3 + p[0] * x[0] + p[1] * y[0], -0.7 + p[0] * x[1] + p[1] * y[1], 0.1 + p[0] * x[2] + p[1] * y[2]};
  }
}

Polygons voronoi_square(Index cells, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Vec2> site(cells);
  for (auto& s : site) s = {uniform(random), uniform(random)};
  Polygons mesh;
  CellCorners numbers(mesh);
  for (Index s = 0; s < cells; ++s) {
    std::vector<CellCorner> cell{{0, 0, -1}, {1, 0, -2}, {1, 1, -3}, {0, 1, -4}};
    for (Index o = 0; o < cells; ++o) {
      if (o == s) continue;
      const double a = site[o][0] - site[s][0], b = site[o][1] - site[s][1];
      const double c = 0.5 * (a * (site[o][0] + site[s][0]) + b * (site[o][1] + site[s][1]));
      cell = clip(cell, a, b, c, o);
    }
    numbers.add(s, cell, [](const CellCorner& p) { return Vec3{p.x, p.y, 0}; });
  }
  tilt(mesh);
  return mesh;
}

Polygons l_shapes(Index blocks, double stretch) {
  Polygons mesh;
  const double h = 0.5 / blocks;
  const auto at = grid_vertices(mesh, 2 * blocks, 2 * blocks, [&](Index x, Index y) {
    return std::array{h * stretch * (x + 0.4 * y), h * y};
  });
  for (Index j = 0; j < blocks; ++j)
    for (Index i = 0; i < blocks; ++i) {
      const Index x = 2 * i, y = 2 * j;
      mesh.add({at(x, y), at(x + 1, y), at(x + 2, y), at(x + 2, y + 1), at(x + 1, y + 1), at(x + 1, y + 2),
                at(x, y + 2), at(x, y + 1)});
      mesh.add({at(x + 1, y + 1), at(x + 2, y + 1), at(x + 2, y + 2), at(x + 1, y + 2)});
    }
  tilt(mesh);
  return mesh;
}

Polygons u_shapes(Index blocks) {
  Polygons mesh;
  const double h = 1.0 / (3 * blocks);
  const auto at = grid_vertices(mesh, 3 * blocks, 2 * blocks, [&](Index x, Index y) {
    return std::array{h * x, h * y};
  });
  for (Index j = 0; j < blocks; ++j)
    for (Index i = 0; i < blocks; ++i) {
      const Index x = 3 * i, y = 2 * j;
      mesh.add({at(x, y), at(x + 1, y), at(x + 2, y), at(x + 3, y), at(x + 3, y + 1), at(x + 3, y + 2),
                at(x + 2, y + 2), at(x + 2, y + 1), at(x + 1, y + 1), at(x + 1, y + 2), at(x, y + 2), at(x, y + 1)});
      mesh.add({at(x + 1, y + 1), at(x + 2, y + 1), at(x + 2, y + 2), at(x + 1, y + 2)});
    }
  tilt(mesh);
  return mesh;
}

Polygons brick_wall(Index rows) {
  Polygons mesh;
  const Index columns = 2 * rows;  // half bricks
  const double h = 1.0 / rows;
  const auto at = grid_vertices(mesh, columns, rows, [&](Index x, Index y) { return std::array{h * x, h * y}; });
  for (Index y = 0; y < rows; ++y) {
    Index x = 0;
    while (x < columns) {
      const Index width = (x == 0 && y % 2 == 1) || x + 1 == columns ? 1 : 2;
      std::vector<Index> face;
      for (Index k = 0; k <= width; ++k) face.push_back(at(x + k, y));
      for (Index k = width; k >= 0; --k) face.push_back(at(x + k, y + 1));
      mesh.add(face);
      x += width;
    }
  }
  tilt(mesh);
  return mesh;
}

Polygons quad_grid(Index side, bool triangles, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  Polygons mesh;
  const auto at = grid_vertices(mesh, side, side, [&](Index x, Index y) {
    const bool inner_x = x > 0 && x<side, inner_y = y> 0 && y < side;
    const double dx = inner_x ? jitter(random) : 0, dy = inner_y ? jitter(random) : 0;
    return std::array{(x + dx) / side, (y + dy) / side};
  });
  for (Index y = 0; y < side; ++y)
    for (Index x = 0; x < side; ++x) {
      const Index a = at(x, y), b = at(x + 1, y), c = at(x + 1, y + 1), d = at(x, y + 1);
      if (!triangles) {
        mesh.add({a, b, c, d});
      } else if (jitter(random) > 0) {
        mesh.add({a, b, c});
        mesh.add({a, c, d});
      } else {
        mesh.add({a, b, d});
        mesh.add({b, c, d});
      }
    }
  tilt(mesh);
  return mesh;
}

Polygons cube_sphere(Index side) {
  Polygons mesh;
  std::map<std::array<Index, 3>, Index> number;
  auto vertex = [&](const std::array<Index, 3>& key) {
    const auto [at, is_new] = number.try_emplace(key, mesh.vertices());
    if (is_new) {
      // Equal angles along the edges of the cube give quads of nearly equal size.
      auto place = [&](Index k) { return std::tan((2.0 * k / side - 1) * std::numbers::pi / 4); };
      mesh.positions.push_back(unit({place(key[0]), place(key[1]), place(key[2])}));
    }
    return at->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (Index end : {Index{0}, side})
      for (Index i = 0; i < side; ++i)
        for (Index j = 0; j < side; ++j) {
          auto key = [&](Index a, Index b) {
            std::array<Index, 3> k{};
            k[axis] = end;
            k[(axis + 1) % 3] = a;
            k[(axis + 2) % 3] = b;
            return k;
          };
          std::vector<Index> face{vertex(key(i, j)), vertex(key(i + 1, j)), vertex(key(i + 1, j + 1)),
                                  vertex(key(i, j + 1))};
          if (end == 0) std::reverse(face.begin(), face.end());
          mesh.add(face);
        }
  return mesh;
}

Polygons voronoi_sphere(Index cells, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vec3> site(cells);
  for (Vec3& s : site) s = unit({normal(random), normal(random), normal(random)});
  Polygons mesh;
  CellCorners numbers(mesh);
  const double reach = std::min(2.0, 12 / std::sqrt(cells));
  for (Index s = 0; s < cells; ++s) {
    const Vec3 p = site[s], x = unit(cross(p, std::abs(p[0]) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})), y = cross(p, x);
    // The cell in the tangent plane of the sphere at p.
    std::vector<CellCorner> cell{{-9, -9, -1}, {9, -9, -2}, {9, 9, -3}, {-9, 9, -4}};
    for (Index o = 0; o < cells; ++o) {
      if (o == s || dot(minus(site[o], p), minus(site[o], p)) > reach * reach) continue;
      const Vec3 d = minus(site[o], p);
      cell = clip(cell, dot(d, x), dot(d, y), -dot(d, p), o);
    }
    numbers.add(s, cell, [&](const CellCorner& c) {
      return unit({p[0] + c.x * x[0] + c.y * y[0], p[1] + c.x * x[1] + c.y * y[1], p[2] + c.x * x[2] + c.y * y[2]});
    });
  }
  return mesh;
}

Polygons dual_sphere(Index parts) {
  // The dual of the cut icosahedron has a corner for each small triangle and a face for each vertex.
  const auto ico = icosahedron_corners();
  std::vector<std::array<int, 3>> sides;
  for (int a = 0; a < 12; ++a)
    for (int b = 0; b < 12; ++b)
      for (int c = 0; c < 12; ++c) {
        auto close = [&](int p, int q) { return dot(minus(ico[p], ico[q]), minus(ico[p], ico[q])) < 4.5; };
        if (a >= b || a >= c || b == c || !close(a, b) || !close(b, c) || !close(c, a)) continue;
        if (dot(cross(minus(ico[b], ico[a]), minus(ico[c], ico[a])), ico[a]) > 0) sides.push_back({a, b, c});
      }
  Polygons mesh;
  std::map<std::array<long, 3>, std::vector<Index>> around;  // rounded vertex -> triangles
  auto key = [](const Vec3& p) {
    return std::array{std::lround(p[0] * 1e6), std::lround(p[1] * 1e6), std::lround(p[2] * 1e6)};
  };
  auto add_triangle = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    for (const Vec3& v : {a, b, c}) around[key(v)].push_back(mesh.vertices());
    mesh.positions.push_back(unit({a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]}));
  };
  for (const auto& s : sides) {
    auto at = [&](Index i, Index j) {
      const Index k = parts - i - j;
      Vec3 p{};
      for (int x = 0; x < 3; ++x) p[x] = k * ico[s[0]][x] + i * ico[s[1]][x] + j * ico[s[2]][x];
      return unit(p);
    };
    for (Index i = 0; i < parts; ++i)
      for (Index j = 0; i + j < parts; ++j) {
        add_triangle(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < parts) add_triangle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
  }
  for (auto& [rounded, triangles] : around) {
    const Vec3 n = unit({double(rounded[0]), double(rounded[1]), double(rounded[2])});
    const Vec3 x = unit(cross(n, std::abs(n[0]) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})), y = cross(n, x);
    auto angle = [&](Index t) { return std::atan2(dot(mesh.positions[t], y), dot(mesh.positions[t], x)); };
    std::sort(triangles.begin(), triangles.end(), [&](Index a, Index b) { return angle(a) < angle(b); });
    mesh.add(triangles);
  }
  return mesh;
}

Polygons moebius_quads(Index around, Index across) {
  Polygons mesh;
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j <= across; ++j) {
      const double angle = 2 * std::numbers::pi * i / around, s = 0.4 * (2.0 * j / across - 1);
      const double r = 1 + s * std::cos(angle / 2);
      mesh.positions.push_back({r * std::cos(angle), r * std::sin(angle), s * std::sin(angle / 2)});
    }
  auto at = [&](Index i, Index j) { return i < around ? i * (across + 1) + j : across - j; };
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j < across; ++j) mesh.add({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  return mesh;
}

}  // namespace ahm::test
