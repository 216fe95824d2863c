// The solver accepts any discretization: here points on a helix, a graph of dimension 1 without a backend.
#include <ahm/graph/csr_graph.hpp>
#include <ahm/graph/validate.hpp>
#include <ahm/maps/log_map_solver.hpp>
#include <cmath>
#include <cstdio>

int main() {
  const int n = 200;
  const double step = 0.1;  // arclength between neighbors

  ahm::CsrGraphData helix;
  helix.dimension = 1;
  helix.kind = ahm::TransportKind::block;  // 1 x 1 blocks
  helix.row_begin = {0};
  for (int i = 0; i < n; ++i) {
    for (int j : {i - 1, i + 1}) {
      if (j < 0 || j >= n) continue;
      helix.neighbors.push_back(j);
      helix.weights.push_back(1.0 / step);
      helix.logs.push_back((j - i) * step);  // position of j on the tangent line of i
      helix.transports.push_back(1.0);       // all tangents point in the same direction along the curve
    }
    helix.row_begin.push_back(static_cast<ahm::Offset>(helix.neighbors.size()));
    helix.masses.push_back(step);
  }

  const ahm::CsrGraph graph(std::move(helix));
  ahm::validate(graph);  // throws on the first violated law, with its name
  const ahm::LogMap map = ahm::LogMapSolver(graph).solve(ahm::Source::at_vertex(ahm::Vertex{50}));
  std::printf("the ends lie at %.3f and %.3f\n", map.coordinates(ahm::Vertex{0})[0],
              map.coordinates(ahm::Vertex(n - 1))[0]);
  return std::abs(map.coordinates(ahm::Vertex{0})[0] + 5.0) < 1e-9 ? 0 : 1;
}
