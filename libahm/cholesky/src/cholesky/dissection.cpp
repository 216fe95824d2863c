#include "cholesky/dissection.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

#include "ahm/util/parallel.hpp"
#include "cholesky/bisection.hpp"
#include "cholesky/minimum_degree.hpp"
#include "cholesky/patches.hpp"
#include "cholesky/vertex_cut.hpp"

namespace ahm {
namespace {

constexpr std::int32_t patch_size = 100;       ///< vertices
constexpr std::int64_t smallest_region = 200;  ///< vertices; smaller regions are not divided
constexpr int band_layers = 4;                 ///< on each side of the border

/// A part of the graph: patches, and how many edges join them. Its vertices are those of its patches without the separators.
struct Region {
  WeightedGraph graph;  ///< of the patches, by their numbers of vertices
  Numbers patches;
  std::int64_t size = 0;  ///< vertices
};

class Dissection {
 public:
  Dissection(const Adjacency& graph, unsigned threads)
      : order(static_cast<std::size_t>(graph.size())),
        graph_(graph),
        in_separator_(order.size(), 0),
        place_(order.size(), -1) {
    Patches patches = patches_of(graph, patch_size);
    const auto count = static_cast<std::size_t>(patches.count);
    members_.resize(count);
    for (std::int32_t v = 0; v < graph.size(); ++v) members_[patches.of_vertex[v]].push_back(v);
    patch_of_ = std::move(patches.of_vertex);
    side_of_patch_.resize(count);
    place_of_patch_.assign(count, -1);
    Numbers all(count);
    std::iota(all.begin(), all.end(), 0);
    divide(region_of(all), 0, threads);
  }

  Numbers order;

 private:
  /// Orders a region from place `first` on.
  void divide(const Region& region, std::int64_t first, unsigned threads) {
    if (region.size <= smallest_region || region.graph.size() < 2) return order_vertices(region, first);
    const std::vector<std::uint8_t> sides = bisect(region.graph);
    const Numbers cut = separator(region, sides);
    std::array<Numbers, 2> patches;
    for (std::int32_t k = 0; k < region.graph.size(); ++k) patches[sides[k]].push_back(region.patches[k]);
    const std::array parts{region_of(patches[0]), region_of(patches[1])};
    std::ranges::copy(cut, order.begin() + first + parts[0].size + parts[1].size);
    detail::run_both(
        threads, [&] { divide(parts[0], first, (threads + 1) / 2); },
        [&] { divide(parts[1], first + parts[0].size, (threads + 1) / 2); });
  }

  Region region_of(const Numbers& patches) {
    Region region;
    for (const std::int32_t p : patches) {
      std::erase_if(members_[p], [&](std::int32_t v) { return in_separator_[v] != 0 || patch_of_[v] != p; });
      if (members_[p].empty()) continue;
      place_of_patch_[p] = static_cast<std::int32_t>(region.patches.size());
      region.patches.push_back(p);
    }
    Numbers edge(region.patches.size(), -1);  // to each patch, if it is in the current row
    Adjacency& rows = region.graph.graph;
    for (const std::int32_t p : region.patches) {
      for (const std::int32_t v : members_[p])
        for (const std::int32_t w : graph_.of(v)) {
          if (in_separator_[w] != 0 || patch_of_[w] == p) continue;
          const std::int32_t other = place_of_patch_[patch_of_[w]];
          if (edge[other] < rows.begin.back()) {
            edge[other] = static_cast<std::int32_t>(rows.neighbors.size());
            rows.neighbors.push_back(other);
            region.graph.edge_weights.push_back(0);
          }
          ++region.graph.edge_weights[edge[other]];
        }
      rows.end_row();
      region.graph.weights.push_back(static_cast<std::int32_t>(members_[p].size()));
      region.size += region.graph.weights.back();
    }
    return region;
  }

  void order_vertices(const Region& region, std::int64_t first) {
    Numbers vertices;
    for (const std::int32_t p : region.patches) vertices.insert(vertices.end(), members_[p].begin(), members_[p].end());
    std::ranges::sort(vertices);
    std::ranges::copy(region.size <= smallest_region ? minimum_degree(graph_, vertices) : ordered_alone(vertices),
                      order.begin() + first);
  }

  /// Vertices of a region that cannot be divided, because of a vertex with very many neighbors.
  Numbers ordered_alone(const Numbers& vertices) {
    for (std::size_t k = 0; k < vertices.size(); ++k) place_[vertices[k]] = static_cast<std::int32_t>(k);
    Numbers result;
    for (const std::int32_t k : approximate_minimum_degree(among(vertices))) result.push_back(vertices[k]);
    return result;
  }

  /// The subgraph of vertices that have a place.
  Adjacency among(const Numbers& vertices) const {
    Adjacency result;
    for (const std::int32_t v : vertices) {
      for (const std::int32_t w : graph_.of(v))
        if (place_[w] >= 0) result.neighbors.push_back(place_[w]);
      result.end_row();
    }
    return result;
  }

  /// The band around the border between the two sides of a region.
  struct Band {
    Numbers vertices;
    std::vector<std::uint8_t> sides;
  };

  /// A smallest separator in the band. The patches of both sides exchange vertices, so that it separates them.
  Numbers separator(const Region& region, const std::vector<std::uint8_t>& sides) {
    std::array<std::int64_t, 2> weight{};
    for (std::int32_t k = 0; k < region.graph.size(); ++k) {
      side_of_patch_[region.patches[k]] = sides[k];
      weight[sides[k]] += region.graph.weights[k];
    }
    Band band = border(region, sides);
    widen(band, weight);
    const Adjacency graph = among(band.vertices);
    const std::uint8_t heavy = weight[0] >= weight[1] ? 0 : 1;  // the cut is near the first end: it balances the sides
    const std::vector<Part> parts = smallest_vertex_cut(graph, ends(band, heavy));

    Numbers cut, moved;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const std::int32_t v = band.vertices[k];
      place_[v] = -1;
      if (parts[k] == Part::cut) {
        cut.push_back(v);
        in_separator_[v] = 1;
      } else if ((parts[k] == Part::first) != (band.sides[k] == heavy)) {
        moved.push_back(static_cast<std::int32_t>(k));
      }
    }
    join_patches(graph, band, std::move(moved));
    return cut;
  }

  /// All vertices with a neighbor on the other side.
  Band border(const Region& region, const std::vector<std::uint8_t>& sides) {
    Band band;
    for (std::int32_t k = 0; k < region.graph.size(); ++k) {
      const auto is_other = [&](std::int32_t j) { return sides[j] != sides[k]; };
      if (std::ranges::none_of(region.graph.graph.of(k), is_other)) continue;
      for (const std::int32_t v : members_[region.patches[k]])
        if (std::ranges::any_of(graph_.of(v), [&](std::int32_t w) {
              return in_separator_[w] == 0 && side_of_patch_[patch_of_[w]] != sides[k];
            }))
          add(band, v, sides[k]);
    }
    return band;
  }
  void add(Band& band, std::int32_t vertex, std::uint8_t side) {
    place_[vertex] = static_cast<std::int32_t>(band.vertices.size());
    band.vertices.push_back(vertex);
    band.sides.push_back(side);
  }

  /// Adds layers. Both sides keep enough vertices outside the band.
  void widen(Band& band, const std::array<std::int64_t, 2>& weight) {
    const double least = smallest_side * static_cast<double>(weight[0] + weight[1]);
    std::array<double, 2> room{static_cast<double>(weight[0]) - least, static_cast<double>(weight[1]) - least};
    for (const std::uint8_t side : band.sides) --room[side];
    std::size_t k = 0;
    for (int layer = 0; layer < band_layers; ++layer)
      for (const std::size_t end = band.vertices.size(); k < end; ++k) {
        const std::uint8_t side = band.sides[k];
        for (const std::int32_t w : graph_.of(band.vertices[k]))
          if (room[side] > 0 && place_[w] < 0 && in_separator_[w] == 0) add(band, w, side), --room[side];
      }
  }

  /// The ends of a band: vertices with neighbors of their own side outside it. If a side has none, the last vertex of the band.
  std::vector<End> ends(const Band& band, std::uint8_t first) const {
    std::vector<End> result(band.vertices.size(), End::none);
    std::array<std::size_t, 2> last{};
    std::array<bool, 2> found{};
    const auto end_of = [&](std::uint8_t side) { return side == first ? End::first : End::second; };
    for (std::size_t k = 0; k < result.size(); ++k) {
      const std::uint8_t side = band.sides[k];
      last[side] = k;
      if (std::ranges::none_of(graph_.of(band.vertices[k]),
                               [&](std::int32_t w) { return in_separator_[w] == 0 && place_[w] < 0; }))
        continue;
      result[k] = end_of(side);
      found[side] = true;
    }
    for (const std::uint8_t side : {std::uint8_t{0}, std::uint8_t{1}})
      if (!found[side] && !result.empty()) result[last[side]] = end_of(side);
    return result;
  }

  /// Gives vertices that changed sides to a patch of a neighbor on their new side. Those without such a neighbor are separated from both
  /// sides and keep their patch.
  /// @param graph  of the band
  void join_patches(const Adjacency& graph, const Band& band, Numbers moved) {
    std::vector<bool> waits(band.vertices.size(), false);
    for (const std::int32_t k : moved) waits[k] = true;
    for (std::size_t before = moved.size() + 1; moved.size() < before;) {
      before = moved.size();
      std::erase_if(moved, [&](std::int32_t k) {
        for (const std::int32_t j : graph.of(k)) {
          const std::int32_t v = band.vertices[k], w = band.vertices[j];
          if (in_separator_[w] != 0 || waits[j]) continue;
          patch_of_[v] = patch_of_[w];
          members_[patch_of_[w]].push_back(v);
          waits[k] = false;
          return true;
        }
        return false;
      });
    }
  }

  const Adjacency& graph_;
  Numbers patch_of_;                        ///< of each vertex
  std::vector<std::uint8_t> in_separator_;  ///< of each vertex; written by two threads, so not bits
  Numbers place_;                           ///< of each vertex, in the current band; -1: not in it
  std::vector<Numbers> members_;            ///< vertices of each patch
  std::vector<std::uint8_t> side_of_patch_;
  Numbers place_of_patch_;  ///< in its region
};

}  // namespace

Numbers nested_dissection(const Adjacency& graph, unsigned threads) {
  return Dissection(graph, detail::thread_count(threads)).order;  // 0 would stay 0 when it is halved
}

}  // namespace ahm
