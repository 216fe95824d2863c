#include "input/method_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/util/quantile.hpp"
#include "ahm/util/vec.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

double quantile(std::vector<double>& values, double q) {
  return detail::value_at(values, static_cast<std::size_t>(q * static_cast<double>(values.size() - 1)));
}

/// Between the faces of every edge inside.
std::vector<double> bends(const FlatTriangles& flat) {
  const auto corner = [&](Index v) { return (1 / flat.length_unit) * flat.positions[v]; };
  const auto normal = [&](exact::Half h) {
    const exact::HalfRecord& r = flat.surface.record(h);
    return cross(corner(r.head) - corner(r.tail), corner(r.apex) - corner(r.tail));
  };
  std::vector<double> angles;
  for (exact::Half h = 0; h < 3 * flat.surface.face_count(); ++h) {
    const exact::HalfRecord& r = flat.surface.record(h);
    if (r.beyond_left < h) continue;  // each edge once
    Vec3 a = normal(h), b = normal(r.beyond_left);
    if ((r.mirrored & 1) != 0) b = -b;
    angles.push_back(std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi);
  }
  return angles;
}

}  // namespace

MethodAdvice method_advice(const Surface& surface) {
  MethodAdvice advice;
  advice.method = surface.suggested_method();
  if (surface.faces().size() == 0) {
    advice.problem = "there are no faces";
    return advice;
  }
  try {
    const FlatTriangles flat = surface.flat_triangles();
    advice.exact_possible = true;
    std::vector<double> angles = bends(flat);
    if (!angles.empty()) {
      advice.median_bend = quantile(angles, 0.5);
      advice.sharp_bend = quantile(angles, 0.95);
    }
    advice.exact_first = flat.surface.vertex_count() <= exact_vertices && advice.sharp_bend > fine_bend;
  } catch (const Error& e) {
    advice.problem = worded(e);
  }
  return advice;
}

std::string as_text(const MethodAdvice& advice) {
  if (!advice.exact_possible)
    return fmt::format("{}; exact is not possible: {}", to_string(advice.method), advice.problem);
  const auto degrees = [](double angle) {
    const std::string number = angle < 10 ? fmt::format("{:.2g}", angle) : fmt::format("{:.0f}", angle);
    return number + (number == "1" ? " degree" : " degrees");
  };
  const std::string bend = fmt::format("half of the edges bend by at most {}, 5 % by at least {}",
                                       degrees(advice.median_bend), degrees(advice.sharp_bend));
  if (advice.exact_first)
    return fmt::format("--method exact for a few maps, {} for many ({})", to_string(advice.method), bend);
  return fmt::format(
      "{}; --method exact, on large meshes with --radius or --tolerance, where it has to follow every face ({})",
      to_string(advice.method), bend);
}

}  // namespace ahm::app
