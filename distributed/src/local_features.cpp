#include "local_features.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "paraboloid.hpp"
#include "row_values.hpp"

namespace ahm::distributed {
namespace {

class Count final : public LocalFeature {
 public:
  void enter(std::span<const Index>) override { count_.clear(); }
  void add(const VertexMap& map) override { count_.push_back(static_cast<Index>(map.neighbors.size())); }
  void put(std::vector<NamedArray>& arrays) const override { arrays.push_back(array("count", count_)); }

 private:
  std::vector<Index> count_;
};

class Area final : public LocalFeature {
 public:
  void enter(std::span<const Index>) override { area_.clear(); }
  void add(const VertexMap& map) override {
    double sum = 0;
    for (double weight : map.weights) sum += weight;
    area_.push_back(sum);
  }
  void put(std::vector<NamedArray>& arrays) const override { arrays.push_back(array("area", area_)); }

 private:
  std::vector<double> area_;
};

/// Of columns of the input, over the vertices at its rows: those inside refined polygons have none.
class Means final : public LocalFeature {
 public:
  Means(const std::vector<std::string>& files, const TiledGraph& graph) : graph_(graph) {
    for (const std::string& file : files) {
      columns_.emplace_back(file);
      if (columns_.back().size() != graph.manifest().points)
        throw InvalidArgument("'" + file + "' has " + std::to_string(columns_.back().size()) +
                              " values, the input of the tiles " + std::to_string(graph.manifest().points) + " rows");
    }
  }
  std::uint64_t identity(std::size_t tile) const override {
    std::vector<double> values;
    for (Index i = graph_.first_vertex(tile); i < graph_.first_vertex(tile + 1); ++i) append(values, i);
    return checksum(std::as_bytes(std::span(values)));
  }
  void enter(std::span<const Index> region) override {
    values_.clear(), means_.clear(), has_row_.clear();
    for (Index vertex : region) has_row_.push_back(append(values_, vertex));
  }
  void add(const VertexMap& map) override {
    const std::size_t width = columns_.size(), first = means_.size();
    means_.resize(first + width, 0.0);
    double all = 0;
    for (std::size_t e = 0; e < map.neighbors.size(); ++e) {
      if (!has_row_[to_size(map.neighbors[e].index)]) continue;
      const double* values = values_.data() + to_size(map.neighbors[e].index) * width;
      for (std::size_t c = 0; c < width; ++c) means_[first + c] += map.weights[e] * values[c];
      all += map.weights[e];
    }
    for (std::size_t c = 0; c < width; ++c) means_[first + c] /= all;
  }
  void put(std::vector<NamedArray>& arrays) const override { arrays.push_back(array("mean", means_)); }

 private:
  /// Of each column the mean of the rows at a vertex. @return whether there are some
  bool append(std::vector<double>& values, Index vertex) const {
    const std::size_t tile = graph_.tile_of(vertex);
    const TiledGraph::TileRows at = graph_.rows(tile);
    const auto i = to_size(vertex - graph_.first_vertex(tile));
    for (const RowValues& column : columns_) {
      double sum = 0;
      for (Index r = at.begin[i]; r < at.begin[i + 1]; ++r) sum += column[to_size(at.rows[to_size(r)])];
      values.push_back(sum / (at.begin[i + 1] - at.begin[i]));
    }
    return at.begin[i] < at.begin[i + 1];
  }

  const TiledGraph& graph_;
  std::vector<RowValues> columns_;
  std::vector<double> values_, means_;  ///< of the region, and what was found
  std::vector<char> has_row_;           ///< of the region
};

class Curvature final : public LocalFeature {
 public:
  Curvature(const TiledGraph& graph, double radius) : graph_(graph), radius_(radius) {}
  void enter(std::span<const Index> region) override {
    region_ = region;
    positions_.clear(), curvatures_.clear(), directions_.clear();
    for (Index vertex : region) positions_.push_back(graph_.frame(vertex)->origin);
  }
  void add(const VertexMap& map) override {
    const Frame frame = *graph_.frame(region_[to_size(map.neighbors.front().index)]);
    Paraboloid fit(radius_);
    for (std::size_t e = 1; e < map.neighbors.size(); ++e)
      fit.add({map.logs[2 * e], map.logs[2 * e + 1]},
              dot(positions_[to_size(map.neighbors[e].index)] - frame.origin, frame.normal),
              map.weights[e] / map.weights[0]);
    const auto [values, direction] = fit.curvature();
    curvatures_.push_back(values);
    directions_.push_back(direction[0] * frame.x + direction[1] * frame.y);
  }
  void put(std::vector<NamedArray>& arrays) const override {
    arrays.push_back(array("curvatures", curvatures_));
    arrays.push_back(array("directions", directions_));
  }

 private:
  const TiledGraph& graph_;
  double radius_;
  std::span<const Index> region_;
  std::vector<Vec3> positions_;  ///< of the region
  std::vector<Vec2> curvatures_;
  std::vector<Vec3> directions_;
};

}  // namespace

LocalFeatures local_features(const std::vector<std::string>& names, const TiledGraph& graph, double radius) {
  constexpr std::string_view mean = "mean:";
  LocalFeatures features;
  std::vector<std::string> files;
  std::set<std::string> known;
  for (const std::string& name : names) {
    if (!known.insert(name).second) throw InvalidArgument("feature '" + name + "' is asked for twice");
    if (name.starts_with(mean))
      files.push_back(name.substr(mean.size()));
    else if (name == "count")
      features.push_back(std::make_unique<Count>());
    else if (name == "area")
      features.push_back(std::make_unique<Area>());
    else if (name == "curvature")
      features.push_back(std::make_unique<Curvature>(graph, radius));
    else
      throw InvalidArgument("feature '" + name + "' is none of count, area, mean:FILE.npy, curvature");
  }
  if (!files.empty()) features.push_back(std::make_unique<Means>(files, graph));
  return features;
}

}  // namespace ahm::distributed
