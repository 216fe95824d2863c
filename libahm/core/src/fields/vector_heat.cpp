#include "ahm/fields/vector_heat.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "maps/affine_heat.hpp"

namespace ahm {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A source of unit weights at the given vertices, checked.
Source plain_source(const LogMapSolver& solver, std::span<const Vertex> vertices) {
  Source source = Source::at_vertices(vertices);
  check_source(source, solver.graph());
  return source;
}

unsigned threads_of(const LogMapSolver& solver, std::optional<unsigned> threads) {
  return detail::thread_count(threads.value_or(solver.options().threads));
}

AffineHeat affine_heat(const LogMapSolver& solver, const Source& source, std::optional<unsigned> threads) {
  constexpr Variant variant = Variant::localized;  // Y is the radial field
  return AffineHeat(solver.graph(), solver.operators(), variant,
                    {inflow_of(source, solver.graph(), solver.operators(), variant)}, threads_of(solver, threads));
}

/// Status of every vertex, and NaN where it is not ok. `reached(i)`: whether the value at vertex i can be trusted.
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
  if (values.size() != expected || !all_finite(values))
    throw InvalidArgument(std::string("'") + name + "' must be " + std::to_string(expected) + " finite numbers, not " +
                          std::to_string(values.size()) + " (or one is not finite)");
}

/// sum_k v_k heat from k / sum_k heat from k, and the lower sum.
struct Blend {
  std::vector<double> values, heat;
  double least = 0;  ///< the heat that counts

  bool reached(std::size_t i) const { return heat[i] >= least; }
};

Blend blend_scalars(const LogMapSolver& solver, std::span<const Vertex> vertices, std::span<const double> values) {
  const auto n = static_cast<std::size_t>(solver.graph().size());
  double largest = 0;
  for (double v : values) largest = std::max(largest, std::abs(v));
  const double unit = largest > 0 ? std::ldexp(1.0, -std::ilogb(largest)) : 1.0;
  const double b = source_heat(solver.graph(), solver.operators(), vertices);
  std::vector<double> columns(2 * n, 0.0);
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    columns[vertices[k].index] += b * (values[k] * unit);
    columns[n + static_cast<std::size_t>(vertices[k].index)] += b;
  }
  solver.operators().solve_scalar(columns, 2);
  Blend blend;
  blend.heat.assign(columns.begin() + static_cast<std::ptrdiff_t>(n), columns.end());
  blend.least = least_share * *std::max_element(blend.heat.begin(), blend.heat.end());
  columns.resize(n);
  for (std::size_t i = 0; i < n; ++i) columns[i] = columns[i] / blend.heat[i] / unit;
  blend.values = std::move(columns);
  return blend;
}

}  // namespace

VertexField extend_scalar(const LogMapSolver& solver, std::span<const Vertex> vertices,
                          std::span<const double> values) {
  return detail::with_memory_check("extending scalars", [&] {
    check_values(values, vertices.size(), "values");
    const Source source = plain_source(solver, vertices);
    Blend blend = blend_scalars(solver, vertices, values);
    VertexField field{1, std::move(blend.values), {}};
    finish(field, solver, source, [&](std::size_t i) { return blend.reached(i); });
    return field;
  });
}

VertexField transport_vectors(const LogMapSolver& solver, std::span<const Vertex> vertices,
                              std::span<const double> vectors) {
  return detail::with_memory_check("transporting vectors", [&] {
    const auto n = static_cast<std::size_t>(solver.graph().size()),
               d = static_cast<std::size_t>(solver.graph().dimension());
    check_values(vectors, vertices.size() * d, "vectors");
    const Source source = plain_source(solver, vertices);

    // Lengths by A ([SSC19] Alg. 1, steps II and III) ...
    std::vector<double> lengths;
    for (std::size_t k = 0; k < vertices.size(); ++k) lengths.push_back(length(vectors.subspan(k * d, d)));
    const Blend blend = blend_scalars(solver, vertices, lengths);

    // ... directions by B (step I).
    const double longest = lengths.empty() ? 0.0 : *std::max_element(lengths.begin(), lengths.end());
    const double b = source_heat(solver.graph(), solver.operators(), vertices);
    VertexField field{static_cast<int>(d), std::vector<double>(n * d, 0.0), {}};
    for (std::size_t k = 0; k < vertices.size() && longest > 0; ++k)
      for (std::size_t a = 0; a < d; ++a)
        field.values[static_cast<std::size_t>(vertices[k].index) * d + a] += b * (vectors[k * d + a] / longest);
    solver.operators().solve_vector(field.values, 1);
    std::vector<char> reached(n);
    for (std::size_t i = 0; i < n; ++i) {
      const std::span vector = std::span(field.values).subspan(i * d, d);
      const double norm = length(vector);
      reached[i] = blend.reached(i) && (norm >= blend.least || longest == 0);
      for (double& component : vector) component = norm > 0 ? component / norm * blend.values[i] : 0.0;
    }
    finish(field, solver, source, [&](std::size_t i) { return reached[i] != 0; });
    return field;
  });
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
