#include "ahm/grid/grid_graph.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"

namespace ahm::grid {
namespace {

/// Checks everything except the number of vertices, and sets a missing origin to zero.
Grid checked(Grid grid) {
  const std::size_t d = grid.shape.size();
  if (d != 2 && d != 3) throw InvalidGeometry("the grid has " + std::to_string(d) + " axes; it must have 2 or 3");
  if (grid.origin.empty()) grid.origin.assign(d, 0.0);
  if (grid.spacing.size() != d || grid.origin.size() != d)
    throw InvalidGeometry("'spacing' and 'origin' must have one number for each of the " + std::to_string(d) + " axes");
  for (std::size_t a = 0; a < d; ++a) {
    const std::string axis = "axis " + std::to_string(a) + ": ";
    if (grid.shape[a] < 2)
      throw InvalidGeometry(axis + std::to_string(grid.shape[a]) + " is too few vertices; a grid needs at least 2");
    if (!(grid.spacing[a] > 0) || !std::isfinite(grid.spacing[a] * grid.shape[a]) || !std::isfinite(grid.origin[a]))
      throw InvalidGeometry(axis + "spacing " + detail::number(grid.spacing[a]) + " or origin " +
                            detail::number(grid.origin[a]) + " is not finite or not in range");
  }
  return grid;
}

}  // namespace

/// The star shared by all vertices with the same free cells around them.
struct GridGraph::StarPattern {
  std::size_t degree = 0;
  double mass = 0;
  std::array<Index, 6> jumps;      ///< number of a neighbor minus number of the vertex
  std::array<double, 6> weights;   ///< area of the dual face / length of the edge
  std::array<double, 6 * 3> logs;  ///< degree x d
};

GridGraph::GridGraph(Grid grid) : grid_(checked(std::move(grid))), dimension_(static_cast<int>(grid_.shape.size())) {
  Offset size = 1, cells = 1;
  for (Index n : grid_.shape) {
    if (size > std::numeric_limits<Index>::max() / n)
      throw ResourceExhausted("the grid has more vertices than can be numbered (2^31 - 1); make it coarser");
    size *= n;
    cells *= n - 1;
  }
  size_ = static_cast<Index>(size);
  if (!grid_.blocked.empty() && static_cast<Offset>(grid_.blocked.size()) != cells)
    throw InvalidGeometry("'blocked' has " + detail::counted(grid_.blocked.size(), "byte") + ", the grid has " +
                          detail::counted(cells, "cell"));
  length_unit_ = std::ldexp(1.0, std::ilogb(*std::max_element(grid_.spacing.begin(), grid_.spacing.end())));
  if (dimension_ == 2)
    transports_ = {1, 0, 1, 0, 1, 0, 1, 0};
  else
    for (int edge = 0; edge < 6; ++edge) transports_.insert(transports_.end(), {1, 0, 0, 0, 1, 0, 0, 0, 1});
  const std::size_t subsets = std::size_t{1} << (1 << dimension_);
  std::vector<StarPattern> patterns;
  for (std::size_t free_cells = 0; free_cells < subsets; ++free_cells) patterns.push_back(make_pattern(free_cells));

  const std::vector<Offset> count = count_patterns();
  for (std::size_t p = 0; p < subsets; ++p) {
    edge_count_ += count[p] * static_cast<Offset>(patterns[p].degree);
    for (std::size_t k = 0; k < patterns[p].degree * dimension_; ++k)
      mean_edge_length_ += static_cast<double>(count[p]) * std::abs(patterns[p].logs[k]);
  }
  patterns_ = std::make_shared<const std::vector<StarPattern>>(std::move(patterns));
  if (edge_count_ == 0) throw InvalidGeometry("all " + detail::counted(cells, "cell") + " of the grid are blocked");
  mean_edge_length_ /= static_cast<double>(edge_count_);
}

/// Bit c of `free_cells` is the cell on the upper side of axis a if bit a of c is set, and on the lower side otherwise. Each
/// free cell adds its share of the dual faces and of the volume.
GridGraph::StarPattern GridGraph::make_pattern(std::size_t free_cells) const {
  const std::size_t cells = std::size_t{1} << dimension_;
  double share = 1;  // volume of a cell, per corner
  for (double h : grid_.spacing) share *= h / length_unit_ / 2;
  StarPattern pattern;
  // A vertex inside an obstacle has no edges, but a mass must be positive.
  pattern.mass = share * std::max(1, std::popcount(free_cells));
  Index jump = 1;
  for (int a = 0; a < dimension_; jump *= grid_.shape[a++])
    for (std::size_t upper : {0, 1}) {
      int free = 0;
      for (std::size_t c = 0; c < cells; ++c) free += (c >> a & 1) == upper && (free_cells >> c & 1);
      if (free == 0) continue;
      const double h = grid_.spacing[a] / length_unit_;
      const std::size_t e = pattern.degree++;
      pattern.jumps[e] = upper ? jump : -jump;
      pattern.weights[e] = free * (2 * share / h) / h;
      for (int b = 0; b < dimension_; ++b) pattern.logs[e * dimension_ + b] = a == b ? (upper ? h : -h) : 0.0;
    }
  return pattern;
}

std::vector<Offset> GridGraph::count_patterns() const {
  std::vector<Offset> count(std::size_t{1} << (1 << dimension_), 0);
  if (!grid_.blocked.empty()) {
    for (Index i = 0; i < size_; ++i) ++count[pattern_at(i)];
    return count;
  }
  // Without obstacles a pattern depends only on the position along each axis: first, inside or last.
  for (int where = 0; where < (dimension_ == 2 ? 9 : 27); ++where) {
    Steps at{};
    Offset times = 1;
    for (int a = 0, rest = where; a < dimension_; ++a, rest /= 3) {
      at[a] = std::array{0, 1, grid_.shape[a] - 1}[rest % 3];
      if (rest % 3 == 1) times *= grid_.shape[a] - 2;
    }
    if (times > 0) count[pattern_at(vertex(std::span(at).first(grid_.shape.size())).index)] += times;
  }
  return count;
}

GridGraph::Steps GridGraph::steps(Index vertex) const {
  Steps at{};
  for (int a = 0; a < dimension_; vertex /= grid_.shape[a++]) at[a] = vertex % grid_.shape[a];
  return at;
}

bool GridGraph::is_free(const Steps& cell) const {
  Offset number = 0;
  for (int a = dimension_ - 1; a >= 0; --a) {
    if (cell[a] < 0 || cell[a] + 1 >= grid_.shape[a]) return false;
    number = number * (grid_.shape[a] - 1) + cell[a];
  }
  return grid_.blocked.empty() || grid_.blocked[number] == 0;
}

std::size_t GridGraph::pattern_at(Index vertex) const {
  const Steps at = steps(vertex);
  std::size_t free_cells = 0;
  for (int c = 0; c < 1 << dimension_; ++c) {
    Steps cell{};
    for (int a = 0; a < dimension_; ++a) cell[a] = at[a] - 1 + (c >> a & 1);
    free_cells |= std::size_t{is_free(cell)} << c;
  }
  return free_cells;
}

const GridGraph::StarPattern& GridGraph::pattern(Index vertex) const { return (*patterns_)[pattern_at(vertex)]; }

double GridGraph::mass(Index vertex) const { return pattern(vertex).mass; }

Star GridGraph::star(Index vertex) const {
  const StarPattern& p = pattern(vertex);
  thread_local std::array<Index, 6> neighbors;
  for (std::size_t e = 0; e < p.degree; ++e) neighbors[e] = vertex + p.jumps[e];
  const std::size_t d = static_cast<std::size_t>(dimension_);
  return {dimension_, std::span(neighbors).first(p.degree), std::span(p.weights).first(p.degree),
          std::span(p.logs).first(p.degree * d), std::span(transports_).first(p.degree * (d == 2 ? 2 : 9))};
}

std::optional<Frame> GridGraph::frame(Index vertex) const {
  return Frame{position(Vertex(vertex)), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

Vertex GridGraph::vertex(std::span<const Index> steps) const {
  if (steps.size() != grid_.shape.size())
    throw InvalidArgument("'steps' must be " + detail::counted(dimension_, "number"));
  Index number = 0;
  for (int a = dimension_ - 1; a >= 0; --a) {
    if (steps[a] < 0 || steps[a] >= grid_.shape[a])
      throw InvalidArgument("step " + std::to_string(steps[a]) + " along axis " + std::to_string(a) +
                            " is outside [0, " + std::to_string(grid_.shape[a]) + ")");
    number = number * grid_.shape[a] + steps[a];
  }
  return Vertex(number);
}

Vec3 GridGraph::position(Vertex vertex) const {
  const Steps at = steps(vertex.index);
  Vec3 position{};
  for (int a = 0; a < dimension_; ++a) position[a] = grid_.origin[a] + at[a] * grid_.spacing[a];
  return position;
}

Source GridGraph::source_at(std::span<const double> point) const {
  if (point.size() != grid_.shape.size())
    throw InvalidArgument("'point' must be " + detail::counted(dimension_, "number"));
  Steps cell{};
  Vec3 share{};  // position in the cell, 0 to 1 along each axis
  for (int a = 0; a < dimension_; ++a) {
    double steps = (point[a] - grid_.origin[a]) / grid_.spacing[a];
    if (std::abs(steps - std::round(steps)) < 1e-9) steps = std::round(steps);
    if (!(steps >= 0 && steps <= grid_.shape[a] - 1))
      throw InvalidArgument("'point': coordinate " + std::to_string(a) + ", " + detail::number(point[a]) +
                            ", is outside the grid");
    cell[a] = std::min(static_cast<Index>(steps), grid_.shape[a] - 2);
    share[a] = steps - cell[a];
  }
  // A point between cells belongs to a free one.
  for (int lower = 0; lower < 1 << dimension_; ++lower) {
    Steps other = cell;
    Vec3 share_of_other = share;
    bool holds_point = true;
    for (int a = 0; a < dimension_; ++a) {
      if (!(lower >> a & 1)) continue;
      holds_point = holds_point && share[a] == 0;
      --other[a];
      share_of_other[a] = 1;
    }
    if (holds_point && is_free(other)) return source_in_cell(other, share_of_other, point);
  }
  throw InvalidArgument("'point' lies inside an obstacle");
}

/// Weights b_k are multilinear, and z_k = vertex - point; the weighted mean of z_k is 0.
Source GridGraph::source_in_cell(const Steps& cell, const Vec3& share, std::span<const double> point) const {
  const auto d = static_cast<std::size_t>(dimension_);
  const std::array<double, 9> identity2{1, 0, 0, 1}, identity3{1, 0, 0, 0, 1, 0, 0, 0, 1};
  Source source(dimension_);
  for (int c = 0; c < 1 << dimension_; ++c) {
    Steps corner = cell;
    double weight = 1;
    for (int a = 0; a < dimension_; ++a) {
      const bool upper = c >> a & 1;
      corner[a] += upper;
      weight *= upper ? share[a] : 1 - share[a];
    }
    const Vertex k = vertex(std::span(corner).first(d));
    Vec3 offset = position(k);
    for (std::size_t a = 0; a < d; ++a) offset[a] -= point[a];
    source.add(k, weight, std::span(offset).first(d), std::span(d == 2 ? identity2 : identity3).first(d * d));
  }
  return source;
}

}  // namespace ahm::grid
