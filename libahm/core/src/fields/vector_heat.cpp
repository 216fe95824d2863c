#include "ahm/fields/vector_heat.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "maps/affine_heat.hpp"

namespace ahm {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The points with prescribed values, joined into one source.
struct PrescribedPoints {
  Source all;
  double heat;  ///< right-hand side for a weight of 1

  PrescribedPoints(const LogMapSolver& solver, Source joined) : all(std::move(joined)) {
    check_source(all, solver.graph());
    heat = source_heat(solver.graph(), solver.operators(), all.vertices());
  }
  /// Calls visit(vertex, point, b, axes) for every sample. `axes` may be empty.
  template <class Visit>
  void for_samples(const Visit& visit) const {
    const std::size_t d = static_cast<std::size_t>(all.dimension().value_or(0)), n = all.vertices().size();
    for (std::size_t k = 0; k < n; ++k)
      visit(static_cast<std::size_t>(all.vertices()[k].index), static_cast<std::size_t>(all.place(k).point),
            heat * all.weights()[k], all.axes().subspan(k * d * d, d * d));
  }
};

unsigned threads_of(const LogMapSolver& solver, std::optional<unsigned> threads) {
  return detail::thread_count(threads.value_or(solver.options().threads));
}

AffineHeat affine_heat(const LogMapSolver& solver, const Source& source, std::optional<unsigned> threads) {
  constexpr Variant variant = Variant::localized;  // its unknown Y is the radial field times lambda
  return AffineHeat(solver.graph(), solver.operators(), variant,
                    {right_hand_side_of(source, solver.graph(), solver.operators(), variant)},
                    threads_of(solver, threads));
}

/// Sets the status of every vertex, and NaN where it is not ok.
/// @param reached  reached(i): whether the value at vertex i is reliable
template <class Reached>
void finish(VertexField& field, const LogMapSolver& solver, const Source& source, const Reached& reached) {
  const auto width = static_cast<std::size_t>(field.width);
  const SourceComponents components(source, solver.operators().components());
  const auto n = static_cast<std::size_t>(solver.graph().size());
  field.status.assign(n, Status::ok);
  for (std::size_t i = 0; i < n; ++i) {
    const std::span value = std::span(field.values).subspan(i * width, width);
    if (!components.hold(static_cast<Index>(i)))
      field.status[i] = Status::disconnected;
    else if (!reached(i) || !all_finite(value))
      field.status[i] = Status::unreached;
    if (field.status[i] != Status::ok) std::fill(value.begin(), value.end(), nan);
  }
}

void check_values(std::span<const double> values, std::size_t expected, const char* name) {
  const std::string start = std::string("'") + name + "'";
  if (values.size() != expected)
    throw InvalidArgument(start + " has " + detail::counted(values.size(), "number") + ", not " +
                          std::to_string(expected));
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!std::isfinite(values[k]))
      throw InvalidArgument(start + "[" + std::to_string(k) + "] is " + detail::number(values[k]) +
                            "; it must be finite");
}

/// Weighted mean at each vertex: sum_k v_k h_k / sum_k h_k, with the heat h_k from sample k.
struct Blend {
  std::vector<double> values, heat;  ///< weighted means; sum_k h_k
  double least = 0;                  ///< smallest heat of a reliable value

  bool reached(std::size_t i) const { return heat[i] >= least; }
};

Blend blend_scalars(const LogMapSolver& solver, const PrescribedPoints& points_with_values,
                    std::span<const double> values) {
  const auto n = static_cast<std::size_t>(solver.graph().size());
  double largest = 0;
  for (double v : values) largest = std::max(largest, std::abs(v));
  const double unit = largest > 0 ? std::ldexp(1.0, -std::ilogb(largest)) : 1.0;
  std::vector<double> columns(2 * n, 0.0);
  points_with_values.for_samples([&](std::size_t vertex, std::size_t point, double b, auto) {
    columns[vertex] += b * (values[point] * unit);
    columns[n + vertex] += b;
  });
  solver.operators().solve_scalar(columns, 2, solver.options().threads);
  Blend blend;
  blend.heat.assign(columns.begin() + static_cast<std::ptrdiff_t>(n), columns.end());
  blend.least = min_heat_share * *std::max_element(blend.heat.begin(), blend.heat.end());
  columns.resize(n);
  for (std::size_t i = 0; i < n; ++i) columns[i] = columns[i] / blend.heat[i] / unit;
  blend.values = std::move(columns);
  return blend;
}

VertexField extend(const LogMapSolver& solver, Source points, std::size_t count, std::span<const double> values) {
  return detail::with_memory_check("extending scalars", [&] {
    check_values(values, count, "values");
    const PrescribedPoints points_with_values(solver, std::move(points));
    Blend blend = blend_scalars(solver, points_with_values, values);
    VertexField field{1, std::move(blend.values), {}};
    finish(field, solver, points_with_values.all, [&](std::size_t i) { return blend.reached(i); });
    return field;
  });
}

VertexField transport(const LogMapSolver& solver, Source points, std::size_t count, std::span<const double> vectors) {
  return detail::with_memory_check("transporting vectors", [&] {
    const auto n = static_cast<std::size_t>(solver.graph().size()),
               d = static_cast<std::size_t>(solver.graph().dimension());
    check_values(vectors, count * d, "vectors");
    const PrescribedPoints points_with_values(solver, std::move(points));

    // Solve with A for the lengths ([SSC19] Alg. 1, steps II and III).
    std::vector<double> lengths;
    for (std::size_t k = 0; k < count; ++k) lengths.push_back(length(vectors.subspan(k * d, d)));
    const Blend blend = blend_scalars(solver, points_with_values, lengths);

    // Solve with B for the directions (step I).
    const double longest = lengths.empty() ? 0.0 : *std::max_element(lengths.begin(), lengths.end());
    VertexField field{static_cast<int>(d), std::vector<double>(n * d, 0.0), {}};
    points_with_values.for_samples([&](std::size_t vertex, std::size_t point, double b, std::span<const double> U) {
      if (!(longest > 0)) return;
      const std::span vector_of_point = vectors.subspan(point * d, d);
      for (std::size_t c = 0; c < d; ++c) {
        double component_in_frame = U.empty() ? vector_of_point[c] / longest : 0;
        for (std::size_t a = 0; a < d && !U.empty(); ++a)
          component_in_frame += U[c * d + a] * (vector_of_point[a] / longest);
        field.values[vertex * d + c] += b * component_in_frame;
      }
    });
    solver.operators().solve_vector(field.values, 1, solver.options().threads);
    std::vector<char> reached(n);
    for (std::size_t i = 0; i < n; ++i) {
      const std::span vector = std::span(field.values).subspan(i * d, d);
      const double norm = length(vector);
      reached[i] = blend.reached(i) && (norm >= blend.least || longest == 0);
      for (double& component : vector) component = norm > 0 ? component / norm * blend.values[i] : 0.0;
    }
    finish(field, solver, points_with_values.all, [&](std::size_t i) { return reached[i] != 0; });
    return field;
  });
}

}  // namespace

VertexField extend_scalar(const LogMapSolver& solver, std::span<const Vertex> vertices,
                          std::span<const double> values) {
  return extend(solver, Source::at_vertices(vertices), vertices.size(), values);
}

VertexField extend_scalar(const LogMapSolver& solver, std::span<const Source> points, std::span<const double> values) {
  return extend(solver, Source::joined(points), points.size(), values);
}

VertexField transport_vectors(const LogMapSolver& solver, std::span<const Vertex> vertices,
                              std::span<const double> vectors) {
  return transport(solver, Source::at_vertices(vertices), vertices.size(), vectors);
}

VertexField transport_vectors(const LogMapSolver& solver, std::span<const Source> points,
                              std::span<const double> vectors) {
  return transport(solver, Source::joined(points), points.size(), vectors);
}

VertexField parallel_transport(const LogMapSolver& solver, const Source& source, std::optional<unsigned> threads) {
  return detail::with_memory_check("transporting a frame", [&] {
    check_source(source, solver.graph());
    const auto n = solver.graph().size();
    const auto width = static_cast<std::size_t>(solver.graph().dimension()) * solver.graph().dimension();
    AffineHeat heat = affine_heat(solver, source, threads);
    heat.diffuse();
    VertexField field{static_cast<int>(width), std::vector<double>(static_cast<std::size_t>(n) * width), {}};
    const FrameField U = heat.frames(0);
    detail::for_each_index(static_cast<std::size_t>(n), threads_of(solver, threads),
                           [&](std::size_t i) { U.axes(static_cast<Index>(i), field.values.data() + i * width); });
    finish(field, solver, source, [&](std::size_t i) { return heat.reached(0, static_cast<Index>(i)); });
    return field;
  });
}

VertexField radial_field(const LogMapSolver& solver, const Source& source, std::optional<unsigned> threads) {
  return detail::with_memory_check("computing the radial field", [&] {
    check_source(source, solver.graph());
    const auto d = static_cast<std::size_t>(solver.graph().dimension());
    AffineHeat heat = affine_heat(solver, source, threads);
    heat.diffuse_heat();
    heat.solve();
    VertexField field{static_cast<int>(d), {heat.unknown(0).begin(), heat.unknown(0).end()}, {}};
    const auto lambda = heat.lambda(0);
    for (std::size_t i = 0; i < lambda.size(); ++i)
      for (std::size_t a = 0; a < d; ++a)
        field.values[i * d + a] = field.values[i * d + a] / lambda[i] * solution_unit(solver.graph());
    finish(field, solver, source, [&](std::size_t i) { return lambda[i] >= heat.least_heat(0); });
    return field;
  });
}

}  // namespace ahm
