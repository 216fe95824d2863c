// A solid with a curved boundary, as a graph of dimension 3 whose weights are not negative: the cells of a grid, cut by the boundary.
//
// The mass of a cell is the volume of its part inside the solid. The weight of an edge is the area of the wall between its two
// cells inside the solid, divided by the distance of their centers. No heat flows through the boundary.
//
// Tetrahedra: cotangent weights may be negative, also in Delaunay meshes. Use the Voronoi cells of the vertices instead: the weight of
// an edge is the area of the wall between two cells inside the solid, divided by the edge length. Or set negative weights to 0, if
// edges of positive weight still connect all vertices. In flat space the map is exact for any positive weights. Only what depends
// on the weights, like extend_scalar, becomes less accurate.
#include <ahm/ahm.hpp>
#include <cmath>
#include <cstdio>

using ahm::Vec3;
using Solid = bool (*)(const Vec3&);  // whether a point is inside

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double norm(const Vec3& a) { return std::hypot(a[0], a[1], a[2]); }

/// The part of a box inside the solid, from 6 samples along each side. A wall is a box with a side of length 0.
double part_inside(Solid is_inside, const Vec3& center, const Vec3& sides) {
  int count = 0;
  for (int s = 0; s < 216; ++s) {
    const double x = (s % 6 - 2.5) / 6, y = (s / 6 % 6 - 2.5) / 6, z = (s / 36 - 2.5) / 6;
    count += is_inside({center[0] + x * sides[0], center[1] + y * sides[1], center[2] + z * sides[2]});
  }
  return count / 216.0;
}

/// The cells of width 1/n of a solid within the unit ball. Stores the centers of the cells, which may be outside the solid.
ahm::CsrGraph make_cells(Solid is_inside, int n, std::vector<Vec3>& centers) {
  const int side = 2 * n + 2, jump[] = {1, side, side * side};  // the outermost cells are outside the ball
  const double h = 1.0 / n;
  std::vector<int> cells, number(side * side * side, -1);
  ahm::CsrGraphData data{.dimension = 3, .kind = ahm::TransportKind::block, .row_begin = {0}};
  for (int c = 0; c < side * side * side; ++c) {
    const Vec3 center{(c % side - n - 0.5) * h, (c / side % side - n - 0.5) * h, (c / side / side - n - 0.5) * h};
    const double part = part_inside(is_inside, center, {h, h, h});
    if (part == 0) continue;
    number[c] = static_cast<int>(cells.size());
    cells.push_back(c);
    centers.push_back(center);
    data.masses.push_back(part * h * h * h);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (int edge = 0; edge < 6; ++edge) {
      const int axis = edge / 2, sign = edge % 2 == 0 ? 1 : -1;
      Vec3 wall = centers[i], sides{h, h, h}, log{};
      wall[axis] += sign * h / 2;
      sides[axis] = 0;
      log[axis] = sign * h;
      const double part = part_inside(is_inside, wall, sides);
      const int neighbor = number[cells[i] + sign * jump[axis]];
      if (neighbor < 0 || part == 0) continue;
      data.neighbors.push_back(neighbor);
      data.weights.push_back(part * h * h / h);
      data.logs.insert(data.logs.end(), log.begin(), log.end());
      data.transports.insert(data.transports.end(), {1, 0, 0, 0, 1, 0, 0, 0, 1});  // all frames are the coordinate axes
    }
    data.row_begin.push_back(static_cast<ahm::Offset>(data.neighbors.size()));
  }
  return ahm::CsrGraph(std::move(data));
}

/// The source at a point: the nearest center, and its position relative to the point.
ahm::Source source_at(const Vec3& point, const std::vector<Vec3>& centers) {
  const auto nearest = std::ranges::min_element(centers, {}, [&](const Vec3& c) { return norm(minus(c, point)); });
  const ahm::Vertex vertex(static_cast<ahm::Index>(nearest - centers.begin()));
  return ahm::Source(3).add(vertex, 1, minus(*nearest, point));
}

/// Relative error of the first eigenvalue of the Laplacian of the unit ball. It depends on all weights and masses.
double eigenvalue_error(const ahm::CsrGraph& graph, const std::vector<Vec3>& centers) {
  const double k = 2.0815759778;  // the eigenvalue is k^2
  const auto eigenfunction = [&](ahm::Index i) {
    const double r = k * norm(centers[i]);
    return centers[i][0] * (std::sin(r) / r - std::cos(r)) / (r * r);
  };
  double energy = 0, squares = 0;
  for (ahm::Index i = 0; i < graph.size(); ++i) {
    const ahm::Star star = graph.star(i);
    squares += graph.mass(i) * std::pow(eigenfunction(i), 2);
    for (std::size_t e = 0; e < star.degree(); ++e)
      energy += star.weights[e] / 2 * std::pow(eigenfunction(i) - eigenfunction(star.neighbors[e]), 2);
  }
  return std::abs(energy / squares / (k * k) - 1);
}

int main() {
  const Vec3 point{-0.71, 0.05, 0.02};
  double eigenvalue[2];
  bool is_exact = true;
  for (const int level : {0, 1}) {
    std::vector<Vec3> centers;
    const ahm::CsrGraph ball = make_cells([](const Vec3& p) { return norm(p) < 1; }, 6 << level, centers);
    ahm::validate(ball);  // throws on the first violated law, with its name
    const ahm::LogMap map = ahm::LogMapSolver(ball, {.expected_maps = 1}).solve(source_at(point, centers));

    // A ball is convex: geodesics are straight lines, and the map is the position relative to the source. Around holes the map would
    // be the same. ahm::Wavefront then computes the distance around them, because all edges are parallel to the axes.
    double distance = 0, direction = 0;
    for (ahm::Index i = 0; i < ball.size(); ++i) {
      const Vec3 exact = minus(centers[i], point);
      const double* phi = &map.coordinates()[3 * i];
      distance = std::max(distance, std::abs(map.distances()[i] - norm(exact)));
      direction = std::max(direction, norm(minus({phi[0], phi[1], phi[2]}, exact)) / norm(exact));
    }
    is_exact = is_exact && distance < 1e-12 && direction < 1e-12;
    eigenvalue[level] = eigenvalue_error(ball, centers);
    std::printf("%d cells: distance wrong by up to %.0e, direction by %.0e; error of the first eigenvalue %.2f %%\n",
                ball.size(), distance, direction, 100 * eigenvalue[level]);
  }
  return is_exact && eigenvalue[1] < eigenvalue[0] / 3 ? 0 : 1;
}
