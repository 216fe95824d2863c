#include "ahm/applications/isolines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "face_mesh.hpp"

namespace ahm {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The value of every point of the mesh. A point that is not in the input, inside a refined polygon, has the mean of its
/// neighbors in the input.
std::vector<double> point_values(const Surface& surface, const FaceMesh& mesh, std::span<const double> values) {
  std::vector<double> result(mesh.points.size(), nan);
  bool all = true;
  for (std::size_t p = 0; p < result.size(); ++p) {
    const auto row = surface.rows().row(Vertex(mesh.vertices[p]));
    if (row)
      result[p] = values[static_cast<std::size_t>(row->index)];
    else
      all = false;
  }
  if (all) return result;
  std::vector<double> sum(result.size(), 0), count(result.size(), 0);
  for (std::size_t h = 0; h < 3 * mesh.size(); ++h) {
    const auto side = static_cast<detail::Half>(h);
    const auto a = static_cast<std::size_t>(mesh.tail(side)), b = static_cast<std::size_t>(mesh.head(side));
    if (!surface.rows().row(Vertex(mesh.vertices[a])) && surface.rows().row(Vertex(mesh.vertices[b])))
      sum[a] += result[b], count[a] += 1;
  }
  for (std::size_t p = 0; p < result.size(); ++p)
    if (count[p] > 0) result[p] = sum[p] / count[p];
  return result;
}

}  // namespace

std::vector<Isoline> isolines(const Surface& surface, std::span<const double> values, std::span<const double> levels) {
  if (values.size() != static_cast<std::size_t>(surface.rows().row_count()))
    throw InvalidArgument("isolines: found " + detail::counted(values.size(), "value") + " for " +
                          detail::counted(surface.rows().row_count(), "row"));
  for (const double level : levels)
    if (!std::isfinite(level)) throw InvalidArgument("isolines: a level is not finite");
  const FaceMesh mesh = face_mesh(surface);
  const std::vector<double> of_points = point_values(surface, mesh, values);
  std::vector<Isoline> result;
  for (const double level : levels)
    for (const MeshCurve& curve : level_curves(mesh, of_points, level)) {
      Isoline line{level, {}, curve.closed, 0};
      for (const exact::MeshPoint& point : curve.points) {
        const Vec3 position = mesh.position(point);
        if (line.points.empty() || position != line.points.back()) line.points.push_back(position);
      }
      if (line.closed && line.points.size() > 1 && line.points.back() == line.points.front()) line.points.pop_back();
      for (std::size_t k = 1; k < line.points.size(); ++k) line.length += distance(line.points[k - 1], line.points[k]);
      if (line.closed) line.length += distance(line.points.back(), line.points.front());
      result.push_back(std::move(line));
    }
  return result;
}

std::vector<double> level_multiples(std::span<const double> values, double step) {
  if (!(step > 0 && std::isfinite(step)))
    throw InvalidArgument("the step between levels is " + detail::number(step) + "; it must be finite and > 0");
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values)
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  if (low > high) throw InvalidArgument("isolines: no value is finite");
  const double first = std::ceil(low / step), last = std::floor(high / step);
  if (!(last - first < 1e6))
    throw InvalidArgument("a step of " + detail::number(step) + " gives more than a million levels between " +
                          detail::number(low) + " and " + detail::number(high) + "; enlarge it");
  std::vector<double> levels;
  for (double k = first; k <= last; ++k) levels.push_back(k * step);
  return levels;
}

}  // namespace ahm
