#include "surroundings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_set>

#include "ahm/error.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::tiles {
namespace {

constexpr std::size_t per_box = 256;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Memory of the build per point of the surroundings, bytes, measured.
constexpr double bytes_per_point = 1500;

/// Grid cells that contain points of a tile, and their neighbors.
class NearCells {
 public:
  NearCells(std::span<const Vec3> points, double width)
      : width_(width), origin_(points.empty() ? Vec3{0, 0, 0} : points.front()) {
    Cell last{};
    bool first = true;
    for (const Vec3& p : points) {
      const Cell cell = cell_of(p);
      if (!first && cell == last) continue;
      first = false, last = cell;
      if (!own_.insert(key(cell)).second) continue;
      for (std::int64_t x = -1; x <= 1; ++x)
        for (std::int64_t y = -1; y <= 1; ++y)
          for (std::int64_t z = -1; z <= 1; ++z) near_.insert(key({cell[0] + x, cell[1] + y, cell[2] + z}));
    }
  }
  bool has(const Vec3& p) const { return near_.contains(key(cell_of(p))); }
  bool touches(const Box& box) const {
    const Cell low = cell_of(box.low), high = cell_of(box.high);
    double cells = 1;
    for (int a = 0; a < 3; ++a) cells *= static_cast<double>(high[a] - low[a] + 1);
    if (cells > 1000) return true;  // a jump of the curve makes the box large, so its points are tested instead
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t z = low[2]; z <= high[2]; ++z)
          if (near_.contains(key({x, y, z}))) return true;
    return false;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Vec3& p) const {
    constexpr double most = 1 << 20;  // cells beyond are merged: more points are tested, none is missed
    Cell cell;
    for (int a = 0; a < 3; ++a)
      cell[a] = static_cast<std::int64_t>(std::clamp(std::floor((p[a] - origin_[a]) / width_), -most + 2, most - 2));
    return cell;
  }
  static std::uint64_t key(const Cell& cell) {
    std::uint64_t result = 0;
    for (std::int64_t c : cell) result = result << 21 | static_cast<std::uint64_t>(c + (1 << 20));
    return result;
  }

  double width_;
  Vec3 origin_;
  std::unordered_set<std::uint64_t> own_, near_;
};

/// A length reduced slightly to allow for rounding.
double less(double length) { return length * (1 - 1e-9); }

/// Appends the points of another tile that may be near.
void collect(const ArrayFile& file, Index first, const pointcloud::Placement& placement, const NearCells& near,
             Surroundings& out) {
  const auto boxes = file.get<Box>("boxes");
  std::span<const Vec3> points;
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    if (!near.touches(boxes[b])) continue;
    if (points.empty()) points = file.get<Vec3>("points");
    for (std::size_t i = b * per_box; i < std::min(points.size(), (b + 1) * per_box); ++i) {
      const Vec3 placed = placement.place(points[i]);
      if (!near.has(placed)) continue;
      out.cloud.points.push_back(placed);
      out.numbers.push_back(first + static_cast<Index>(i));
    }
  }
}

void check_memory(const TileFolder& folder, std::size_t tile, std::size_t points) {
  const double wanted = static_cast<double>(points) * bytes_per_point;
  if (wanted > static_cast<double>(folder.options().memory))
    throw ResourceExhausted("tile " + std::to_string(tile) + " and its surroundings have " +
                            detail::counted(points, "point") + ", which require about " + detail::gigabytes(wanted) +
                            "; raise the memory limit, plan smaller tiles, or remove stray points first");
}

}  // namespace

std::vector<Box> boxes_of(std::span<const Vec3> placed) {
  std::vector<Box> boxes;
  for (std::size_t begin = 0; begin < placed.size(); begin += per_box) {
    Box box{placed[begin], placed[begin]};
    for (const Vec3& p : placed.subspan(begin, std::min(per_box, placed.size() - begin)))
      for (int a = 0; a < 3; ++a) {
        box.low[a] = std::min(box.low[a], p[a]);
        box.high[a] = std::max(box.high[a], p[a]);
      }
    boxes.push_back(box);
  }
  return boxes;
}

Surroundings gather(const TileFolder& folder, std::size_t tile, double width) {
  const pointcloud::Placement placement = folder.placement();
  const std::vector<Index> first = folder.manifest().first_points();
  const ArrayFile own_file = folder.open(kind::points, tile);
  std::vector<Vec3> own;
  for (const Vec3& p : own_file.get<Vec3>("points")) own.push_back(placement.place(p));
  check_memory(folder, tile, own.size());
  const auto search = pointcloud::nanoflann_search(own);
  const NearCells near(own, width);

  Surroundings candidates, result;
  std::size_t own_at = 0;
  for (std::size_t t = 0; t < folder.tiles(); ++t) {
    if (t == tile) {
      own_at = candidates.numbers.size();
      continue;
    }
    collect(folder.open(kind::points, t), first[t], placement, near, candidates);
    check_memory(folder, tile,
                 own.size() + candidates.numbers.size() / 9);  // candidates fill 27 cells, and only some of them remain
  }
  std::vector<double> distance(candidates.numbers.size());
  detail::for_each_index(distance.size(), folder.options().threads, [&](std::size_t i) {
    Index index;
    double squared;
    search->nearest(candidates.cloud.points[i], std::span(&index, 1), std::span(&squared, 1));
    distance[i] = std::sqrt(squared);
  });
  result.cloud.unit = placement.unit();
  const auto take_own = [&] {
    result.begin = static_cast<Index>(result.numbers.size());
    for (std::size_t i = 0; i < own.size(); ++i) result.numbers.push_back(first[tile] + static_cast<Index>(i));
    result.cloud.points.insert(result.cloud.points.end(), own.begin(), own.end());
    result.covered.insert(result.covered.end(), own.size(), less(width));
    result.end = static_cast<Index>(result.numbers.size());
  };
  for (std::size_t i = 0; i <= distance.size(); ++i) {
    if (i == own_at) take_own();
    if (i == distance.size() || !(distance[i] <= width)) continue;
    result.numbers.push_back(candidates.numbers[i]);
    result.cloud.points.push_back(candidates.cloud.points[i]);
    result.covered.push_back(less(width - distance[i]));
  }
  result.whole = static_cast<Index>(result.numbers.size()) == first.back();
  if (result.whole) result.covered.assign(result.numbers.size(), infinity);
  check_memory(folder, tile, result.numbers.size());
  return result;
}

WatchedSearch::WatchedSearch(const Surroundings& around)
    : around_(around),
      search_(pointcloud::nanoflann_search(around.cloud.points)),
      uncertain_(around.numbers.size(), 0),
      found_(around.numbers.size()) {}

Index WatchedSearch::nearest(const Vec3& query, std::span<Index> indices, std::span<double> squared) const {
  const Index found = search_->nearest(query, indices, squared);
  const Index self = indices[0];  // because the points are distinct
  if (found < static_cast<Index>(indices.size()) || !(std::sqrt(squared[found - 1]) < around_.covered[self]))
    uncertain_[self] = !around_.whole;
  if (found_[self].empty()) found_[self].assign(indices.begin(), indices.begin() + found);
  return found;
}

/// The marks extended to all points that have a marked neighbor.
std::vector<char> WatchedSearch::spread(const std::vector<char>& marks,
                                        const pointcloud::Neighborhoods& neighborhoods) const {
  std::vector<char> result = marks;
  const auto marked = [&](Index j) { return marks[j] != 0; };
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const auto neighbors = neighborhoods.of(static_cast<Index>(i));
    result[i] = marks[i] || std::any_of(found_[i].begin(), found_[i].end(), marked) ||
                std::any_of(neighbors.begin(), neighbors.end(), marked);
  }
  return result;
}

std::vector<char> WatchedSearch::complete(const pointcloud::Neighborhoods& neighborhoods, double max_edge_ratio) const {
  const std::size_t n = uncertain_.size();
  std::vector<char> planes = uncertain_;  // points whose plane and radius may differ from those in the whole cloud
  for (int round = 0; round < pointcloud::reach_rounds; ++round) planes = spread(planes, neighborhoods);
  const std::vector<char> stars = spread(planes, neighborhoods);  // points whose own triangles may differ
  std::vector<Vec3> doubtful;
  for (std::size_t i = 0; i < n; ++i)
    if (stars[i]) doubtful.push_back(around_.cloud.points[i]);
  const auto search = doubtful.empty() ? nullptr : pointcloud::nanoflann_search(doubtful);
  std::vector<char> result(n);
  detail::for_each_index(n, 0, [&](std::size_t i) {
    if (stars[i]) return;
    // The point is not joined to points farther away than this.
    const double reach = max_edge_ratio * neighborhoods.radius[i] * (1 + 1e-9);
    if (!(reach < around_.covered[i])) return;
    if (search) {
      Index index;
      double squared;
      search->nearest(around_.cloud.points[i], std::span(&index, 1), std::span(&squared, 1));
      if (std::sqrt(squared) <= reach) return;
    }
    result[i] = 1;
  });
  return result;
}

}  // namespace ahm::tiles
