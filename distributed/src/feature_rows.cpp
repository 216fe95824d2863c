#include <algorithm>
#include <string>
#include <vector>

#include "ahm/distributed/tiled_local_maps.hpp"
#include "ahm/error.hpp"
#include "csv_rows.hpp"
#include "local_features.hpp"

namespace ahm::distributed {
namespace {

/// Numbers of a tile's vertices, with names for them.
struct Columns {
  std::string header;
  std::vector<std::vector<double>> arrays;  ///< of a vertex, as many in each as it has
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

/// @throws IoError where the file is none of features of this tile, which has vertices
Columns columns_of(const std::filesystem::path& path, const TiledGraph& graph, std::size_t tile) {
  const ArrayFile file(path, local_kind);
  const auto identity = file.get<std::uint64_t>("identity");
  const std::vector<std::uint64_t> expected = graph.manifest().identity(tile);
  if (identity.size() < expected.size() || !std::equal(expected.begin(), expected.end(), identity.begin()))
    throw IoError("cannot read '" + path.string() + "': it is not one of these tiles; make it again");
  if (file.has("indptr"))
    throw IoError("cannot read '" + path.string() + "': it holds whole maps; make them with features instead");
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
  std::size_t first = 0;  // that has vertices
  while (first + 1 < graph.tiles() && graph.manifest().tiles[first].vertices == 0) ++first;
  const std::string header = columns(first).header;
  io::AtomicFile file(csv);
  file.write("row" + header + "\n");
  RowLines lines(file, graph);
  for (std::size_t t = 0; t < graph.tiles(); ++t) {
    const Columns here = graph.manifest().tiles[t].vertices > 0 ? columns(t) : Columns{header, {}, {}};
    if (here.header != header)
      throw IoError("tile " + std::to_string(t) + " has other features than tile " + std::to_string(first) +
                    "; make them again, in a new folder");
    lines.add(
        graph.rows(t), [&](std::size_t i) { return VertexLine{here.line(i)}; },
        std::string(static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')), ','));
  }
  lines.finish();
  file.commit();
}

}  // namespace ahm::distributed
