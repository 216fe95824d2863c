#include "maps/edge_paths.hpp"

#include <limits>

#include "ahm/util/shortest_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "maps/reached_rows.hpp"

namespace ahm {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

/// What is known of the vertices near the front.
class PathsAhead {
 public:
  explicit PathsAhead(Index vertices) : numbers_(vertices), rows_(1) {}

  /// Of a vertex that is passed, which no way betters, any number less than all.
  double& operator[](Index vertex) {
    if (numbers_.find(vertex) == ReachedNumbers::forgotten) return passed_ = -1;
    return row(vertex).length;
  }
  void settle(Index vertex, const Star& star) {
    Row& own = row(vertex);
    own.settled = true;
    own.waiting += static_cast<std::ptrdiff_t>(star.degree());
    for (const Index j : star.neighbors)
      if (numbers_.find(j) != ReachedNumbers::forgotten) --row(j).waiting, forget_if_passed(j);
    forget_if_passed(vertex);
  }

 private:
  struct Row {
    double length = none;
    std::ptrdiff_t waiting =
        0;  ///< edges to neighbours that are not settled; before it is, less those to such that are
    bool settled = false;
  };
  Row& row(Index vertex) {
    const bool is_new = numbers_.find(vertex) < 0;
    const Index number = numbers_.number(vertex);
    rows_.grow_to(numbers_.count());
    if (is_new) *rows_[number] = {};
    return *rows_[number];
  }
  void forget_if_passed(Index vertex) {
    if (const Row& own = row(vertex); own.settled && own.waiting == 0) numbers_.forget(vertex);
  }

  ReachedNumbers numbers_;
  GrowingRows<Row> rows_;
  double passed_ = -1;
};

}  // namespace

void edge_paths(const TangentGraph& graph, const Source& source, double longest, const Progress& progress,
                const std::function<void(Index vertex, double length)>& settle) {
  const double unit = graph.length_unit();
  PathsAhead ahead(graph.size());
  ShortestPaths<double, PathsAhead> paths(ahead, none);
  for (std::size_t k = 0; k < source.vertices().size(); ++k)
    if (source.weights()[k] > 0) paths.offer(source.vertices()[k].index, source.place(k).distance / unit);
  std::int64_t settled = 0;
  paths.run([&](Index vertex, double distance) {
    if (distance * unit > longest) return;
    if (settled++ % 65536 == 0) progress.step("paths", static_cast<double>(settled) / graph.size());
    const Star star = graph.star(vertex);
    for (std::size_t e = 0; e < star.degree(); ++e) paths.offer(star.neighbors[e], distance + length(star.log(e)));
    ahead.settle(vertex, star);
    settle(vertex, distance * unit);
  });
}

}  // namespace ahm
