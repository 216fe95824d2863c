#include "local_features.hpp"

#include <algorithm>
#include <set>

#include "ahm/error.hpp"
#include "ahm/tiles/tiled_local_maps.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "directions.hpp"
#include "row_values.hpp"

namespace ahm::tiles {
namespace {

class Count final : public LocalFeature {
 public:
  void enter(std::span<const Index>) override { count_.clear(); }
  void add(const VertexMap& map) override { count_.push_back(static_cast<Index>(map.neighbors.size())); }
  void append_to(std::vector<NamedArray>& arrays) const override { arrays.push_back(array("count", count_)); }

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
  void append_to(std::vector<NamedArray>& arrays) const override { arrays.push_back(array("area", area_)); }

 private:
  std::vector<double> area_;
};

/// Means of columns of the input. Vertices without a row, such as those inside refined polygons, are skipped.
class Means final : public LocalFeature {
 public:
  Means(const std::vector<std::string>& files, const TiledGraph& graph) : graph_(graph) {
    for (const std::string& file : files) {
      columns_.emplace_back(file);
      if (columns_.back().size() != graph.manifest().points)
        throw InvalidArgument("'" + file + "' has " + detail::counted(columns_.back().size(), "value") +
                              "; the input of the tiles has " + detail::counted(graph.manifest().points, "row"));
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
  void append_to(std::vector<NamedArray>& arrays) const override { arrays.push_back(array("mean", means_)); }

 private:
  /// Appends the mean over the rows of a vertex for each column. @return whether the vertex has rows
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
  std::vector<double> values_, means_;  ///< values of the region, and means that were computed
  std::vector<char> has_row_;           ///< whether each vertex of the region has a row
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
  void append_to(std::vector<NamedArray>& arrays) const override {
    arrays.push_back(array("curvatures", curvatures_));
    arrays.push_back(array("directions", directions_));
  }

 private:
  const TiledGraph& graph_;
  double radius_;
  std::span<const Index> region_;
  std::vector<Vec3> positions_;  ///< positions of the region, world units
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
    if (!known.insert(name).second) throw InvalidArgument("feature '" + name + "' occurs twice; list it once");
    if (name.starts_with(mean))
      files.push_back(name.substr(mean.size()));
    else if (name == "count")
      features.push_back(std::make_unique<Count>());
    else if (name == "area")
      features.push_back(std::make_unique<Area>());
    else if (name == "curvature")
      features.push_back(std::make_unique<Curvature>(graph, radius));
    else
      throw InvalidArgument("feature '" + name + "' is not one of count, area, mean:FILE.npy, curvature");
  }
  if (!files.empty()) features.push_back(std::make_unique<Means>(files, graph));
  return features;
}

namespace {

/// Numbers of the vertices of a tile, with the names of their CSV columns.
struct Columns {
  std::string header;
  std::vector<std::vector<double>> arrays;  ///< values of all vertices, `widths` numbers per vertex
  std::vector<std::size_t> widths;

  void add(std::vector<double> values, const std::vector<std::string>& names) {
    for (const std::string& name : names) header += "," + name;
    arrays.push_back(std::move(values));
    widths.push_back(names.size());
  }
  std::string line(std::size_t vertex) const {
    std::string text;
    for (std::size_t a = 0; a < arrays.size(); ++a)
      for (std::size_t c = 0; c < widths[a]; ++c) {
        text += ',';
        append_number(text, arrays[a][vertex * widths[a] + c]);
      }
    return text;
  }
};

/// Reads the features of a tile with vertices. @throws IoError (another tile; whole maps; sizes)
Columns columns_of(const std::filesystem::path& path, const TiledGraph& graph, std::size_t tile) {
  const ArrayFile file(path, local_kind);
  const auto identity = file.get<std::uint64_t>("identity");
  const std::vector<std::uint64_t> expected = graph.manifest().identity(tile);
  if (identity.size() < expected.size() || !std::equal(expected.begin(), expected.end(), identity.begin()))
    throw IoError("cannot read '" + path.string() + "': it belongs to other tiles; make it again");
  if (file.has("indptr"))
    throw IoError("cannot read '" + path.string() +
                  "': it contains whole maps; make the local maps with features instead");
  const auto vertices = static_cast<std::size_t>(graph.manifest().tiles[tile].vertices);
  Columns columns;
  const auto numbers = [&](const char* array) {
    const auto values = file.get<double>(array);
    return std::vector<double>(values.begin(), values.end());
  };
  const auto vectors = [&]<class T>(const char* array, const T&) {
    std::vector<double> values;
    for (const T& v : file.get<T>(array)) values.insert(values.end(), v.begin(), v.end());
    return values;
  };
  if (file.has("count")) {
    const auto count = file.get<Index>("count");
    columns.add({count.begin(), count.end()}, {"count"});
  }
  if (file.has("area")) columns.add(numbers("area"), {"area"});
  if (file.has("curvatures")) {
    columns.add(vectors("curvatures", Vec2()), {"curvature_1", "curvature_2"});
    columns.add(vectors("directions", Vec3()), {"direction_x", "direction_y", "direction_z"});
  }
  if (file.has("mean")) {
    std::vector<double> means = numbers("mean");
    std::vector<std::string> names;
    for (std::size_t k = 0; k < means.size() / vertices; ++k) names.push_back("mean_" + std::to_string(k));
    columns.add(std::move(means), names);
  }
  for (std::size_t a = 0; a < columns.arrays.size(); ++a)
    if (columns.arrays[a].size() != columns.widths[a] * vertices)
      throw IoError("cannot read '" + path.string() + "': its arrays do not fit the tile; make it again");
  return columns;
}

}  // namespace

void write_feature_rows(const TiledGraph& graph, const std::filesystem::path& folder,
                        const std::filesystem::path& csv) {
  const auto columns = [&](std::size_t tile) {
    return columns_of(Manifest::file(folder, local_kind, tile), graph, tile);
  };
  std::size_t first = 0;  // first tile with vertices
  while (first + 1 < graph.tiles() && graph.manifest().tiles[first].vertices == 0) ++first;
  const std::string header = columns(first).header;
  io::AtomicFile file(csv);
  file.write("row" + header + "\n");
  RowLines lines(file, graph);
  for (std::size_t t = 0; t < graph.tiles(); ++t) {
    const Columns here = graph.manifest().tiles[t].vertices > 0 ? columns(t) : Columns{header, {}, {}};
    if (here.header != header)
      throw IoError("tile " + std::to_string(t) + " has other features than tile " + std::to_string(first) +
                    "; make all tiles again in a new folder");
    lines.add(
        graph.rows(t), [&](std::size_t i) { return VertexLine{here.line(i)}; },
        std::string(static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')), ','));
  }
  lines.finish();
  file.commit();
}

}  // namespace ahm::tiles
