#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

#include "ahm/conformance/graph_changes.hpp"
#include "ahm/conformance/graph_laws.hpp"
#include "ahm/conformance/reference_operator.hpp"
#include "ahm/fields/vector_heat.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/maps/log_map_solver.hpp"

namespace ahm::test {
namespace {

double largest(std::span<const double> values) {
  double m = 0;
  for (double v : values) m = std::max(m, std::abs(v));
  return m;
}

LogMap map_of(const TangentGraph& graph, const Source& source, Variant variant = Variant::adaptive) {
  return LogMapSolver(graph).solve(source, {.variant = variant});
}

/// The product of a row-major matrix, or of its transpose, with a vector of d numbers.
std::vector<double> times(std::span<const double> matrix, std::span<const double> vector, bool transposed) {
  const std::size_t d = vector.size();
  std::vector<double> result(d, 0.0);
  for (std::size_t a = 0; a < d; ++a)
    for (std::size_t b = 0; b < d; ++b) result[a] += (transposed ? matrix[b * d + a] : matrix[a * d + b]) * vector[b];
  return result;
}

/// R_ji of an edge as a d x d matrix.
std::vector<double> transport_block(const TangentGraph& graph, const Star& star, std::size_t edge) {
  const auto d = static_cast<std::size_t>(graph.dimension());
  if (graph.transport_kind() == TransportKind::block) {
    const auto R = star.transports.subspan(edge * d * d, d * d);
    return {R.begin(), R.end()};
  }
  const double c = star.transports[2 * edge], s = star.transports[2 * edge + 1];
  return {c, -s, s, c};
}

/// A point near vertex p, described by p and its neighbors with unequal weights. Their axes are the frame of p, transported
/// along the edges.
struct NearbyPoint {
  Source source;
  std::vector<double> offset;  ///< offset of the point from p, in the frame of p, world units
};

NearbyPoint nearby_point(const TangentGraph& graph, Index p) {
  const auto d = static_cast<std::size_t>(graph.dimension());
  const Star star = graph.star(p);
  NearbyPoint point{Source(graph.dimension()), std::vector<double>(d, 0.0)};
  const double total = 1.0 + static_cast<double>(star.degree() * (star.degree() + 1)) / 2;
  for (std::size_t e = 0; e < star.degree(); ++e)
    for (std::size_t a = 0; a < d; ++a) point.offset[a] += (e + 1) / total * star.log(e)[a] * graph.length_unit();
  std::vector<double> z(d), identity(d * d, 0.0), axes(d * d);
  for (std::size_t a = 0; a < d; ++a) z[a] = -point.offset[a], identity[a * d + a] = 1;
  point.source.add(Vertex(p), 1 / total, z, identity);
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const std::vector<double> R = transport_block(graph, star, e);
    for (std::size_t a = 0; a < d; ++a) {
      z[a] = star.log(e)[a] * graph.length_unit() - point.offset[a];
      for (std::size_t b = 0; b < d; ++b) axes[a * d + b] = R[b * d + a];  // U_k = R_pk, the inverse of R_kp
    }
    point.source.add(Vertex(star.neighbors[e]), (e + 1) / total, z, axes);
  }
  return point;
}

}  // namespace

namespace contract {

void keeps_every_law_of_a_tangent_graph(const TangentGraph& graph) { EXPECT_NO_THROW(validate(graph)); }

void counts_its_edges(const TangentGraph& graph) {
  Offset edges = 0;
  for (Index i = 0; i < graph.size(); ++i) edges += static_cast<Offset>(graph.star(i).degree());
  EXPECT_EQ(edges, graph.edge_count());
}

void has_non_negative_weights(const TangentGraph& graph) {
  for (Index i = 0; i < graph.size(); ++i)
    for (double w : graph.star(i).weights) EXPECT_GE(w, 0.0) << "vertex " << i;
}

void closes_every_loop_where_it_is_flat(const TangentGraph& graph) {
  // On a flat graph the log map satisfies every edge, phi_j - phi_i = e_ij in the source's frame, so the residual of Alg. 2
  // is zero for any weights.
  LogMapSolver solver(graph);
  const Index source = graph.size() / 2;
  for (Variant variant : all_variants) {
    const LogMap map = solver.solve(Source::at_vertex(Vertex(source)), {.variant = variant});
    double diameter = 0;
    for (Index i = 0; i < graph.size(); ++i) diameter = std::max(diameter, map.distance(Vertex(i)));
    for (Index i = 0; i < graph.size(); ++i) {
      const Star star = graph.star(i);
      for (std::size_t e = 0; e < star.degree(); ++e) {
        double difference = 0, log = 0;
        for (int a = 0; a < graph.dimension(); ++a) {
          const double step = map.coordinates(Vertex(star.neighbors[e]))[a] - map.coordinates(Vertex(i))[a];
          difference += step * step;
          log += star.log(e)[a] * star.log(e)[a];
        }
        EXPECT_NEAR(std::sqrt(difference), std::sqrt(log) * graph.length_unit(), 1e-11 * diameter) << "vertex " << i;
      }
    }
  }
}

void carries_one_frame_where_it_is_flat(const TangentGraph& graph) {
  // U_i = R_ji U_j on every edge, and phi_j - phi_i = e_ij in the source's frame: direction as well as length.
  const auto d = static_cast<std::size_t>(graph.dimension());
  const LogMapSolver solver(graph);
  const Source source = Source::at_vertex(Vertex(graph.size() / 3));
  const VertexField U = parallel_transport(solver, source);
  const LogMap map = solver.solve(source);
  const double size = largest(map.coordinates());
  auto frame = [&](Index i) { return std::span(U.values).subspan(static_cast<std::size_t>(i) * d * d, d * d); };
  for (Index i = 0; i < graph.size(); ++i) {
    const Star star = graph.star(i);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const Index j = star.neighbors[e];
      const std::vector<double> R = transport_block(graph, star, e), log = times(frame(i), star.log(e), true);
      for (std::size_t a = 0; a < d; ++a) {
        ASSERT_NEAR(map.coordinates(Vertex(j))[a] - map.coordinates(Vertex(i))[a], log[a] * graph.length_unit(),
                    1e-11 * size);
        std::vector<double> axis(d);
        for (std::size_t c = 0; c < d; ++c) axis[c] = frame(j)[c * d + a];
        const std::vector<double> carried = times(R, axis, false);
        for (std::size_t c = 0; c < d; ++c) ASSERT_NEAR(frame(i)[c * d + a], carried[c], 1e-11);
      }
    }
  }
}

void starts_between_vertices_exactly_where_it_is_flat(const TangentGraph& graph) {
  const LogMapSolver solver(graph);
  const Index p = graph.size() / 3;
  const NearbyPoint point = nearby_point(graph, p);
  for (Variant variant : all_variants) {
    const LogMap from_vertex = solver.solve(Source::at_vertex(Vertex(p)), {.variant = variant}),
                 map = solver.solve(point.source, {.variant = variant});
    for (Index i = 0; i < graph.size(); ++i)
      for (int a = 0; a < graph.dimension(); ++a)
        ASSERT_NEAR(map.coordinates(Vertex(i))[a], from_vertex.coordinates(Vertex(i))[a] - point.offset[a],
                    1e-11 * largest(from_vertex.coordinates()));
  }
}

void agrees_with_the_papers_full_operator(const TangentGraph& graph) {
  LogMapSolver solver(graph);
  for (Variant variant : all_variants) {
    const LogMap map = solver.solve(Source::at_vertex(Vertex{3}), {.variant = variant});
    const std::vector<double> reference = reference_log_map(graph, 3, variant);
    double largest = 0;
    for (double x : reference) largest = std::max(largest, std::abs(x));
    // At the source the vector is 0. The paper has the mean of the heat that returns there.
    const auto d = static_cast<std::size_t>(graph.dimension());
    for (std::size_t k = 0; k < reference.size(); ++k)
      EXPECT_NEAR(map.coordinates()[k], k / d == 3 ? 0 : reference[k], 1e-11 * largest);
  }
}

void does_not_depend_on_the_frames(const TangentGraph& original) {
  const CsrGraphData data = stored(original);
  const auto d = static_cast<std::size_t>(data.dimension);
  const TurnedGraph turned = with_frames_turned(data);
  const CsrGraph graph(data), other(turned.data);
  const Index p = graph.size() / 3;
  const auto Q_p = std::span(turned.turns).subspan(static_cast<std::size_t>(p) * d * d, d * d);
  for (Variant variant : all_variants) {
    const LogMap map = map_of(graph, Source::at_vertex(Vertex(p)), variant),
                 same = map_of(other, Source::at_vertex(Vertex(p)), variant);
    for (Index i = 0; i < graph.size(); ++i) {
      const std::vector<double> expected = times(Q_p, map.coordinates(Vertex(i)), false);
      for (std::size_t a = 0; a < d; ++a)
        ASSERT_NEAR(same.coordinates(Vertex(i))[a], expected[a], 1e-11 * largest(map.coordinates()));
    }
  }
}

void does_not_depend_on_the_numbering(const TangentGraph& original) {
  const CsrGraphData data = stored(original);
  std::vector<Index> order(data.masses.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  const CsrGraph graph(data), other(relabeled(data, order));
  for (Variant variant : all_variants) {
    const LogMap map = map_of(graph, Source::at_vertex(Vertex{3}), variant),
                 same = map_of(other, Source::at_vertex(Vertex(order[3])), variant);
    for (Index i = 0; i < graph.size(); ++i)
      for (int a = 0; a < graph.dimension(); ++a)
        ASSERT_NEAR(same.coordinates(Vertex(order[i]))[a], map.coordinates(Vertex(i))[a],
                    1e-11 * largest(map.coordinates()));
  }
}

void scales_with_its_lengths(const TangentGraph& graph) {
  const CsrGraphData data = stored(graph);
  const LogMap map = map_of(CsrGraph(data), Source::at_vertex(Vertex{3}));
  for (double factor : {0x1p-40, 0x1p50, 1e-12, 1e12}) {
    int exponent;
    const double gate = std::frexp(factor, &exponent) == 0.5 ? 0.0 : 1e-12;  // powers of two: the same bits
    const LogMap other = map_of(CsrGraph(scaled(data, factor)), Source::at_vertex(Vertex{3}));
    for (std::size_t k = 0; k < map.coordinates().size(); ++k)
      ASSERT_NEAR(other.coordinates()[k], map.coordinates()[k] * factor, gate * factor * largest(map.coordinates()));
  }
}

void masks_what_is_not_connected(const TangentGraph& graph) {
  const CsrGraph two(doubled(stored(graph)));
  const LogMap map = map_of(two, Source::at_vertex(Vertex{3})), single = map_of(graph, Source::at_vertex(Vertex{3}));
  EXPECT_EQ(map.count(Status::disconnected), graph.size());
  for (Index i = 0; i < graph.size(); ++i) {
    ASSERT_EQ(map.status(Vertex(i)), Status::ok);
    ASSERT_EQ(map.status(Vertex(i + graph.size())), Status::disconnected);
    for (int a = 0; a < graph.dimension(); ++a) {
      ASSERT_NEAR(map.coordinates(Vertex(i))[a], single.coordinates(Vertex(i))[a],
                  1e-11 * largest(single.coordinates()));
      ASSERT_TRUE(std::isnan(map.coordinates(Vertex(i + graph.size()))[a]));
    }
  }
}

void solves_batches_on_any_number_of_threads(const TangentGraph& graph) {
  const LogMapSolver solver(graph);
  std::vector<Source> sources;
  for (Index p = 0; p < 35; ++p) sources.push_back(Source::at_vertex(Vertex(p)));
  for (Variant variant : all_variants) {
    const auto one = solver.solve(sources, {.variant = variant, .threads = 1}),
               many = solver.solve(sources, {.variant = variant, .threads = 4});
    for (std::size_t s = 0; s < sources.size(); ++s) {
      const LogMap alone = solver.solve(sources[s], {.variant = variant});
      const auto batch = one[s].coordinates(), single = alone.coordinates();
      for (std::size_t k = 0; k < batch.size(); ++k) {
        const double other = many[s].coordinates()[k];
        ASSERT_TRUE(batch[k] == other || (std::isnan(batch[k]) && std::isnan(other)));
        ASSERT_EQ(std::isnan(batch[k]), std::isnan(single[k]));
        if (std::isnan(batch[k])) continue;
        ASSERT_NEAR(batch[k], single[k], 1e-12 * largest(batch));
      }
    }
  }
}

void shows_its_stars_to_many_threads_at_once(const TangentGraph& graph) {
  const CsrGraphData expected = stored(graph);
  std::atomic<int> equal{0};
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&] {
        for (int pass = 0; pass < 20; ++pass) {
          const CsrGraphData seen = stored(graph);
          equal += seen.neighbors == expected.neighbors && seen.weights == expected.weights &&
                   seen.logs == expected.logs && seen.transports == expected.transports &&
                   seen.masses == expected.masses;
        }
      });
  }
  EXPECT_EQ(equal, 4 * 20);
}

}  // namespace contract
}  // namespace ahm::test
