// Geodesic Voronoi cells and farthest points.
#include "ahm/applications/cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ahm/error.hpp"
#include "ahm/testing/curved_graphs.hpp"
#include "ahm/testing/flat_graphs.hpp"
#include "ahm/testing/graph_changes.hpp"

namespace ahm::test {
namespace {

/// Heat from each source alone: n x k.
std::vector<std::vector<double>> separate_heats(const LogMapSolver& solver, const std::vector<Vertex>& sources) {
  std::vector<std::vector<double>> heats;
  for (const auto [source] : sources) {
    std::vector<double> heat(static_cast<std::size_t>(solver.graph().size()), 0.0);
    heat[source] = 1;
    solver.operators().solve_scalar(heat, 1);
    heats.push_back(heat);
  }
  return heats;
}

TEST(Cells, AreThoseOfSeparateHeatsWhereverOneHasTheMajority) {
  const CsrGraph graph(sphere_graph(3000));
  const LogMapSolver solver(graph);
  const std::vector<Vertex> sources = farthest_points(solver, Vertex{0}, 23);
  const auto label = nearest_source(solver, sources);
  const auto heats = separate_heats(solver, sources);
  Index doubtful = 0, differ = 0;
  for (std::size_t i = 0; i < label.size(); ++i) {
    double all = 0;
    std::size_t best = 0;
    for (std::size_t k = 0; k < heats.size(); ++k) {
      all += heats[k][i];
      if (heats[k][i] > heats[best][i]) best = k;
    }
    differ += label[i] != static_cast<Index>(best);
    if (heats[best][i] < 0.5001 * all)
      ++doubtful;
    else
      EXPECT_EQ(label[i], static_cast<Index>(best)) << "vertex " << i;
  }
  RecordProperty("doubtful", doubtful), RecordProperty("differ", differ);
  // k cells on a sphere meet in 2 (k - 2) points. Near one of them, with heats exp(-distance / sqrt(tau)), no source has
  // the majority on an area of 6 / (1.5 sqrt(3)) tau; random weights make tau uneven, hence the factor 2.
  const double h = graph.mean_edge_length(), pi = std::numbers::pi;
  const double area = 2.0 * static_cast<double>(sources.size() - 2) * 6 / (1.5 * std::sqrt(3.0)) * h * h;
  EXPECT_LT(doubtful, 2 * area * graph.size() / (4 * pi));
}

TEST(Cells, HaveTheirDistancesUpToTheBorder) {
  const FlatGraph flat = planar_triangulation(30);
  const CsrGraph graph(flat.data);
  const LogMapSolver solver(graph);
  for (const Index count : {1, 2, 5, 40}) {
    const std::vector<Vertex> sources = farthest_points(solver, Vertex{17}, count);
    const auto labels = nearest_source(solver, sources);
    const VertexField away = distance_in_cells(solver, sources, labels);
    const std::vector<LogMap> separate = solver.solve([&] {
      std::vector<Source> all;
      for (Vertex vertex : sources) all.push_back(Source::at_vertex(vertex));
      return all;
    }());
    for (Index i = 0; i < graph.size(); ++i) {
      const auto own = static_cast<std::size_t>(labels[i]);
      // Few cells all touch or nearly so, and each is solved for alone: exact. Of many, sources of a group are a cell of
      // several edges farther away than the own one, and add a little of their heat.
      const double exact = separate[own].distance(Vertex(i));
      EXPECT_NEAR(away.values[i], exact, count <= 5 ? 1e-11 : graph.mean_edge_length() / 4);
      EXPECT_EQ(away.status[i], Status::ok);
    }
  }
}

TEST(Cells, DistancesNeedLabelsThatFit) {
  const CsrGraph graph(planar_triangulation(8).data);
  const LogMapSolver solver(graph);
  const std::vector sources{Vertex{3}, Vertex{40}};
  std::vector<Index> labels = nearest_source(solver, sources);
  EXPECT_THROW(distance_in_cells(solver, std::span(sources).first(0), labels), InvalidArgument);
  EXPECT_THROW(distance_in_cells(solver, sources, std::span(labels).first(5)), InvalidArgument);
  labels[0] = 2;
  EXPECT_THROW(distance_in_cells(solver, sources, labels), InvalidArgument);
  labels[0] = -1;
  const VertexField away = distance_in_cells(solver, sources, labels);
  EXPECT_EQ(away.status[0], Status::disconnected);
  EXPECT_TRUE(std::isnan(away.values[0]));
}

TEST(Cells, ContainTheirSourcesAndAreConnected) {
  const CsrGraph graph(planar_triangulation(30).data);
  const LogMapSolver solver(graph);
  const std::vector<Vertex> sources = farthest_points(solver, Vertex{17}, 12);
  const auto label = nearest_source(solver, sources);
  for (std::size_t k = 0; k < sources.size(); ++k) {
    std::vector<Index> stack{sources[k].index};
    std::vector<bool> seen(label.size(), false);
    seen[sources[k].index] = true;
    std::ptrdiff_t size = 0;
    while (!stack.empty()) {
      const Index i = stack.back();
      stack.pop_back(), ++size;
      for (Index j : graph.star(i).neighbors)
        if (!seen[j] && label[j] == static_cast<Index>(k)) seen[j] = true, stack.push_back(j);
    }
    EXPECT_EQ(label[sources[k].index], static_cast<Index>(k));
    EXPECT_EQ(size, std::count(label.begin(), label.end(), static_cast<Index>(k)));
  }
}

TEST(Cells, LeaveComponentsWithoutASourceUnlabelled) {
  const FlatGraph flat = planar_triangulation(8);
  const CsrGraph graph(doubled(flat.data));
  const auto label = nearest_source(LogMapSolver(graph), std::array{Vertex{3}});
  for (Index i = 0; i < graph.size(); ++i) EXPECT_EQ(label[i], i < flat.size() ? 0 : -1);
}

TEST(Cells, OfALineOfAnyLengthMeetHalfWay) {
  const Index n = 6001;  // farther than heat reaches
  const CsrGraph graph(line_graph(n).data);
  const auto label = nearest_source(LogMapSolver(graph), std::array{Vertex{0}, Vertex(n - 1)});
  for (Index i = 0; i < n; ++i)
    if (i != n / 2) EXPECT_EQ(label[i], i < n / 2 ? 0 : 1);
}

TEST(FarthestPoints, AreSpreadAsAGreedyCoverOfThePlane) {
  const FlatGraph flat = planar_triangulation(24);
  const CsrGraph graph(flat.data);
  const LogMapSolver solver(graph);
  const auto points = farthest_points(solver, Vertex{5}, 20);
  const auto between = [&](Index a, Index b) { return std::hypot(flat.exact(a, b)[0], flat.exact(a, b)[1]); };
  std::vector<double> away(static_cast<std::size_t>(flat.size()), 1e300);
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    for (Index i = 0; i < flat.size(); ++i) away[i] = std::min(away[i], between(points[k].index, i));
    EXPECT_NEAR(away[points[k + 1].index], *std::max_element(away.begin(), away.end()), 1e-10);
  }
}

TEST(FarthestPoints, VisitEveryComponentFirst) {
  const FlatGraph flat = planar_triangulation(6);
  const CsrGraph graph(doubled(flat.data));
  EXPECT_GE(farthest_points(LogMapSolver(graph), Vertex{0}, 2)[1], Vertex{flat.size()});
}

TEST(Cells, RefuseBadArguments) {
  const CsrGraph graph(planar_triangulation(5).data);
  const LogMapSolver solver(graph);
  EXPECT_THROW(nearest_source(solver, {}), InvalidArgument);
  EXPECT_THROW(nearest_source(solver, std::array{Vertex{1}, Vertex{1}}), InvalidArgument);
  EXPECT_THROW(nearest_source(solver, std::array{Vertex{25}}), InvalidArgument);
  EXPECT_THROW(farthest_points(solver, Vertex{-1}, 2), InvalidArgument);
  EXPECT_THROW(farthest_points(solver, Vertex{0}, 26), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
