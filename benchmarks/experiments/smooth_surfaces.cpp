// Convergence of polar, exact and heat maps to the exponential maps of smooth surfaces.
#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/exact/exact_map.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/util/vec.hpp"
#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

using Complex = std::complex<double>;

/// The zero set of a function of space.
struct SmoothSurface {
  const char* name;
  double radius;  ///< radius of the meshed part, below two thirds of the injectivity radius
  Vec3 source;
  Vec3 (*gradient)(const Vec3&);
  double (*second)(const Vec3& at, const Vec3& along);  ///< second derivative of the function along a vector
};

constexpr double tube = 0.5;  // radius of the tube of the torus; its center line has radius 1

constexpr SmoothSurface surfaces[] = {
    {"sphere", 1.5, {0, 0, 1}, [](const Vec3& p) { return p; }, [](const Vec3&, const Vec3& v) { return dot(v, v); }},
    {"torus",
     1,
     {1 + 0.6 * tube, 0, 0.8 * tube},
     [](const Vec3& p) {
       const double from_axis = std::hypot(p[0], p[1]), share = 1 - 1 / from_axis;
       return Vec3{share * p[0], share * p[1], p[2]};
     },
     [](const Vec3& p, const Vec3& v) {
       const double from_axis = std::hypot(p[0], p[1]), outward = (p[0] * v[0] + p[1] * v[1]) / from_axis;
       const double around = v[0] * v[0] + v[1] * v[1] - outward * outward;
       return outward * outward + (1 - 1 / from_axis) * around + v[2] * v[2];
     }},
    {"ellipsoid",  // half axes 1, 1, 2
     1,
     {0.6, 0.48, 1.28},
     [](const Vec3& p) {
       return Vec3{p[0], p[1], p[2] / 4};
     },
     [](const Vec3&, const Vec3& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2] / 4; }},
    {"saddle",  // z = (x^2 - y^2) / 2
     1.5,
     {0.4, 0.2, 0.06},
     [](const Vec3& p) {
       return Vec3{p[0], -p[1], -1};
     },
     [](const Vec3&, const Vec3& v) { return v[0] * v[0] - v[1] * v[1]; }}};

/// The end of the geodesic that leaves the source with this velocity, after unit time; fourth-order Runge-Kutta.
Vec3 exponential(const SmoothSurface& surface, const Vec3& velocity) {
  constexpr int steps = 100;
  constexpr double h = 1.0 / steps;
  const auto acceleration = [&](const Vec3& p, const Vec3& v) {
    const Vec3 normal = surface.gradient(p);
    return (-surface.second(p, v) / dot(normal, normal)) * normal;
  };
  Vec3 p = surface.source, v = velocity;
  for (int step = 0; step < steps; ++step) {
    const Vec3 a1 = acceleration(p, v), v2 = v + h / 2 * a1;
    const Vec3 a2 = acceleration(p + h / 2 * v, v2), v3 = v + h / 2 * a2;
    const Vec3 a3 = acceleration(p + h / 2 * v2, v3), v4 = v + h * a3;
    const Vec3 a4 = acceleration(p + h * v3, v4);
    p = p + h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return p;
}

/// A mesh with its exact log map. Vertex 0 is the source.
struct MappedMesh : Mesh {
  std::vector<Complex> log;
};

/// A hexagon of triangles in the tangent plane, with jittered vertices, mapped to the surface by its exponential map.
MappedMesh mapped_hexagon(const SmoothSurface& surface, int rings) {
  constexpr double jitter = 0.25;  // of an edge
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  const double edge = surface.radius / rings;
  const Vec3 normal = unit(surface.gradient(surface.source));
  const Vec3 x = unit(cross(normal, Vec3{0.36, 0.48, 0.8})), y = cross(normal, x);
  MappedMesh mesh;
  std::vector<Index> number(static_cast<std::size_t>((2 * rings + 1) * (2 * rings + 1)), -1);
  const auto at = [&](int i, int j) -> Index& {
    return number[static_cast<std::size_t>((i + rings) * (2 * rings + 1) + j + rings)];
  };
  const auto add = [&](int i, int j) {
    const bool is_source = i == 0 && j == 0;
    const Complex off =
        is_source ? 0 : std::polar(jitter * std::sqrt(share(random)), 2 * std::numbers::pi * share(random));
    mesh.log.push_back(edge * (Complex(i + 0.5 * j, std::sqrt(0.75) * j) + off));
    at(i, j) = static_cast<Index>(mesh.positions.size());
    mesh.positions.push_back(exponential(surface, mesh.log.back().real() * x + mesh.log.back().imag() * y));
  };
  add(0, 0);
  for (int i = -rings; i <= rings; ++i)
    for (int j = std::max(-rings, -rings - i); j <= std::min(rings, rings - i); ++j)
      if (i != 0 || j != 0) add(i, j);
  const auto is_inside = [&](int i, int j) { return std::max({std::abs(i), std::abs(j), std::abs(i + j)}) <= rings; };
  for (int i = -rings; i <= rings; ++i)
    for (int j = -rings; j <= rings; ++j) {
      if (is_inside(i, j) && is_inside(i + 1, j) && is_inside(i, j + 1))
        mesh.faces.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (is_inside(i + 1, j) && is_inside(i, j + 1) && is_inside(i + 1, j + 1))
        mesh.faces.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

struct NamedMap {
  const char* name;
  std::vector<Vec2> (*compute)(const Surface&);
};

std::vector<Vec2> vectors(const LogMap& map) {
  std::vector<Vec2> result;
  for (Index i = 0; i < map.size(); ++i)
    result.push_back({map.coordinates(Vertex(i))[0], map.coordinates(Vertex(i))[1]});
  return result;
}

constexpr NamedMap maps[] = {
    {"polar", [](const Surface& s) { return vectors(PolarMapSolver(s.mesh()).log_map(Vertex(0))); }},
    {"polar without windows",
     [](const Surface& s) { return vectors(PolarMapSolver(s.mesh(), {.windows = 0}).log_map(Vertex(0))); }},
    {"exact",
     [](const Surface& s) {
       const exact::PolyhedralSurface polyhedral = s.polyhedron();
       const exact::ExactMap map = exact::exact_map(polyhedral, polyhedral.vertex_point(Vertex(0)));
       std::vector<Vec2> result;
       for (Index i = 0; i < map.size(); ++i) result.push_back(s.graph().length_unit() * map.coordinates(Vertex(i)));
       return result;
     }},
    {"heat", [](const Surface& s) { return vectors(LogMapSolver(s.graph()).solve(Source::at_vertex(Vertex(0)))); }}};

void measure(const SmoothSurface& smooth, std::span<const int> rings, Table& table) {
  constexpr double nearest = 0.1;  // vertices nearer than this share of the radius are left out
  std::vector<MappedMesh> meshes;
  std::vector<Surface> discrete;
  for (const int count : rings) {
    meshes.push_back(mapped_hexagon(smooth, count));
    discrete.emplace_back(smooth.name, meshes.back());
  }
  for (const NamedMap& method : maps) {
    std::vector<double> h, middle, high, distance;
    for (std::size_t k = 0; k < meshes.size(); ++k) {
      const std::vector<Vec2> found = method.compute(discrete[k]);
      std::vector<Complex> ours, exact;
      std::vector<double> off;
      for (std::size_t i = 0; i < found.size(); ++i) {
        const double away = std::abs(meshes[k].log[i]);
        if (away < nearest * smooth.radius) continue;
        ours.emplace_back(found[i][0], found[i][1]);
        exact.push_back(meshes[k].log[i]);
        off.push_back(std::abs(std::abs(ours.back()) - away) / away);
      }
      const std::vector<double> errors = relative_errors(ours, exact);
      h.push_back(smooth.radius / rings[k]);
      middle.push_back(quantile(errors, 0.5)), high.push_back(quantile(errors, 0.95));
      distance.push_back(quantile(off, 0.95));
    }
    for (std::size_t k = 0; k < h.size(); ++k)
      table.add({smooth.name, discrete[k].size(), method.name, h[k], middle[k], high[k], distance[k],
                 fitted_order(h, middle), fitted_order(h, high), fitted_order(h, distance)});
  }
}

}  // namespace

Table smooth_surfaces(const Settings& settings) {
  Table table({"surface", "vertices", "method", "h", "vector 50%", "vector 95%", "|vector| 95%", "order 50%",
               "order 95%", "order |vector|"});
  const std::vector<int> rings = settings.toy ? std::vector{9, 18} : std::vector{18, 36, 73, 146};
  for (const SmoothSurface& surface : surfaces) measure(surface, rings, table);
  std::string orders;
  for (const NamedMap& method : maps) {
    const Table rows = table.where("method", method.name);
    append(orders,
           fmt::format("{} {:.2f} / {:.2f}", method.name, rows.smallest("order 50%"), rows.smallest("order 95%")));
  }
  table.seen = "Lowest orders of the vectors over the surfaces, median / 95th percentile: " + orders + ".";
  return table;
}

}  // namespace ahm::bench
