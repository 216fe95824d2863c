// Fig. 21: the radial vector field on increasingly thin triangles, by affine and by vector diffusion.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/fields/vector_heat.hpp"
#include "experiments/comparison.hpp"
#include "methods/heat_fields.hpp"

namespace ahm::bench {
namespace {

using std::numbers::pi;
constexpr int source_count = 4;

/// The exact radial direction at q from p, not normalized; empty where q is too near or at the cut locus.
using Radial = std::optional<Vec3> (*)(const Vec3& p, const Vec3& q);

std::optional<Vec3> on_sphere(const Vec3& p, const Vec3& q) {
  const double c = dot(p, q), d = std::acos(std::clamp(c, -1.0, 1.0));
  if (d < 0.1 || d > 0.8 * pi) return {};
  return Vec3{c * q[0] - p[0], c * q[1] - p[1], c * q[2] - p[2]};
}

std::optional<Vec3> in_plane(const Vec3& p, const Vec3& q) {
  const Vec3 away{q[0] - p[0], q[1] - p[1], q[2] - p[2]};
  return dot(away, away) > 0 ? std::optional(away) : std::nullopt;
}

/// Angles between a field and the exact one.
void add_angles(const Surface& surface, Index source, Radial radial, std::span<const double> field,
                std::vector<double>& angles) {
  for (Index i = 0; i < surface.size(); ++i) {
    const Frame frame = *surface.graph().frame(i);
    const auto away = radial(surface.graph().frame(source)->origin, frame.origin);
    if (!away) continue;
    const double x = dot(*away, frame.x), y = dot(*away, frame.y), u = field[2 * i], v = field[2 * i + 1];
    angles.push_back(std::abs(std::atan2(x * v - y * u, x * u + y * v)));
  }
}

void measure(const char* name, double stretch, const Mesh& mesh, Radial radial, Table& table) {
  for (const bool flips : {true, false}) {
    const Surface surface(name, mesh, {.intrinsic_delaunay = flips});
    const LogMapSolver solver(surface.graph(), {.strategy = Strategy::global});
    std::vector<double> affine, vector;
    for (int s = 0; s < source_count; ++s) {
      const Index source = surface.size() / 11 + s * (surface.size() / source_count);
      add_angles(surface, source, radial, radial_field(solver, Source::at_vertex(Vertex(source))).values, affine);
      std::vector<double> circle(static_cast<std::size_t>(2 * surface.size()), 0.0);
      methods::add_outward_circle(surface.graph(), source, circle);
      solver.operators().solve_vector(circle, 1);
      add_angles(surface, source, radial, circle, vector);
    }
    for (const auto& [method, angles] : {std::pair{"affine", &affine}, {"vector", &vector}}) {
      double mean = 0;
      for (double a : *angles) mean += a / static_cast<double>(angles->size());
      table.add({name, surface.size(), stretch, flips ? "intrinsic Delaunay" : "as given", method, mean,
                 quantile(*angles, 0.95)});
    }
  }
}

Mesh stretched_plane(Index side, double stretch) {
  Mesh mesh = test::flat_square(side);
  for (Vec3& p : mesh.positions) p[0] *= stretch;
  return mesh;
}

}  // namespace

Table radial(const Settings& settings) {
  Table table({"mesh", "vertices", "stretch", "triangulation", "method", "mean angle", "95% angle"});
  const int side = settings.toy ? 24 : 96;
  for (int stretch : {1, 2, 4, 8}) {
    measure("plane", stretch, stretched_plane(side + 1, stretch), in_plane, table);
    measure("sphere, stretched", stretch, stretched_icosphere(side * side, stretch), on_sphere, table);
    measure("sphere, parallels", stretch, parallels_and_meridians(side / stretch, side * stretch), on_sphere, table);
  }
  auto angle = [&](const char* mesh, const char* method) {
    return table.where("mesh", mesh).where("method", method).mean("mean angle");
  };
  table.seen = fmt::format(
      "Mean angle to the exact field in radians, affine / vector diffusion: plane {:.1g} / {:.3f}, stretched "
      "icospheres {:.3f} / {:.3f}, parallels and meridians {:.3f} / {:.3f}.",
      angle("plane", "affine"), angle("plane", "vector"), angle("sphere, stretched", "affine"),
      angle("sphere, stretched", "vector"), angle("sphere, parallels", "affine"), angle("sphere, parallels", "vector"));
  return table;
}

}  // namespace ahm::bench
