#include "atlas/atlas_maker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "ahm/applications/cells.hpp"
#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

constexpr Index nobody = -1;

void check(const TangentGraph& graph, const FaceList& faces) {
  if (graph.dimension() != 2)
    throw InvalidArgument("the graph has dimension " + std::to_string(graph.dimension()) +
                          "; an atlas is of a surface, dimension 2");
  if (faces.begin.empty() || faces.begin.front() != 0 || faces.begin.back() != std::ssize(faces.vertices) ||
      !std::is_sorted(faces.begin.begin(), faces.begin.end()))
    throw InvalidArgument("'faces.begin' must rise from 0 to the number of corners, " +
                          std::to_string(faces.vertices.size()));
  for (std::size_t c = 0; c < faces.vertices.size(); ++c)
    if (faces.vertices[c] < 0 || faces.vertices[c] >= graph.size())
      throw InvalidArgument("corner " + std::to_string(c) + " names vertex " + std::to_string(faces.vertices[c]) +
                            ", outside [0, " + std::to_string(graph.size()) + ")");
}

/// Sum of the distances of a face's corners from a source; NaN where one is unknown.
double sum_of_distances(const Regions& regions, Index source, std::span<const Index> face) {
  double sum = 0;
  for (Index v : face) {
    const auto [x, y] = regions.coordinates(source, v);
    sum += std::hypot(x, y);
  }
  return sum;
}

/// The cell C_i of the paper: the source with the least sum of distances.
std::vector<Index> nearest_of_faces(const FaceList& faces, std::span<const Index> label, const Regions& regions) {
  std::vector<Index> result(faces.size(), nobody);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    double least = std::numeric_limits<double>::infinity();
    Index before = nobody;
    const auto face = faces[f];
    if (const Index only = face.empty() ? nobody : label[face.front()];
        only != nobody && regions.is_known(only) &&
        std::ranges::all_of(face, [&](Index v) { return label[v] == only; })) {
      result[f] = only;
      continue;
    }
    for (Index v : face) {
      const Index source = label[v];
      if (source == nobody || source == before) continue;
      const double sum = sum_of_distances(regions, before = source, face);
      if (sum < least || (sum == least && source < result[f])) least = sum, result[f] = source;
    }
  }
  return result;
}

/// Connected pieces of faces of equal sources.
class Pieces {
 public:
  Pieces(const FaceNeighbors& neighbors, std::span<const Index> source) : of_face(source.size(), nobody) {
    std::vector<Index> stack;
    for (std::size_t seed = 0; seed < source.size(); ++seed) {
      if (source[seed] == nobody || of_face[seed] != nobody) continue;
      const auto piece = static_cast<Index>(faces.size());
      faces.emplace_back();
      of_face[seed] = piece;
      stack.assign(1, static_cast<Index>(seed));
      while (!stack.empty()) {
        const Index f = stack.back();
        stack.pop_back();
        faces.back().push_back(f);
        for (Index g : neighbors.of(f))
          if (source[g] == source[seed] && of_face[g] == nobody) of_face[g] = piece, stack.push_back(g);
      }
    }
  }

  /// The piece of each source with the most faces; `nobody` where it has none.
  std::vector<Index> largest(std::span<const Index> source, std::size_t sources) const {
    std::vector<Index> result(sources, nobody);
    for (std::size_t p = 0; p < faces.size(); ++p) {
      Index& best = result[source[faces[p].front()]];
      if (best == nobody || faces[best].size() < faces[p].size()) best = static_cast<Index>(p);
    }
    return result;
  }

  std::vector<Index> of_face;
  std::vector<std::vector<Index>> faces;
};

/// The source of the neighbouring main piece with which `island` shares most sides and which knows it; else `nobody`.
Index best_neighbor(const std::vector<Index>& island, const FaceNeighbors& neighbors, const FaceList& faces,
                    std::span<const Index> source, const std::vector<std::uint8_t>& in_main, const Regions& regions) {
  std::vector<Index> candidates;  // one per shared side
  for (Index f : island)
    for (Index g : neighbors.of(f))
      if (in_main[g] && source[g] != source[f]) candidates.push_back(source[g]);
  std::sort(candidates.begin(), candidates.end());
  Index best = nobody;
  std::ptrdiff_t most = 0;
  for (auto first = candidates.begin(); first != candidates.end();) {
    const auto last = std::upper_bound(first, candidates.end(), *first);
    const bool known = std::all_of(island.begin(), island.end(),
                                   [&](Index f) { return std::isfinite(sum_of_distances(regions, *first, faces[f])); });
    if (known && last - first > most) most = last - first, best = *first;
    first = last;
  }
  return best;
}

/// Gives what is cut off from its cell to a neighbouring chart, as long as that is possible.
/// @return the pieces then
Pieces attach_islands(const FaceNeighbors& neighbors, const FaceList& faces, const Regions& regions,
                      std::size_t sources, std::vector<Index>& source) {
  while (true) {
    bool changed = false;
    Pieces pieces(neighbors, source);
    const std::vector<Index> main = pieces.largest(source, sources);
    std::vector<std::uint8_t> in_main(source.size(), 0);
    for (std::size_t f = 0; f < source.size(); ++f)
      in_main[f] = source[f] != nobody && main[source[f]] == pieces.of_face[f];
    for (const auto& piece : pieces.faces) {
      if (in_main[piece.front()]) continue;
      const Index better = best_neighbor(piece, neighbors, faces, source, in_main, regions);
      if (better == nobody) continue;
      for (Index f : piece) source[f] = better;
      changed = true;
    }
    if (!changed) return pieces;
  }
}

/// Whether the map turns most faces of a chart over; their areas would cancel where it closes around a handle.
bool is_mirrored(const Atlas& atlas, const FaceList& faces, const Chart& chart) {
  std::ptrdiff_t balance = 0;
  for (Index f : chart.faces) {
    const Offset first = faces.begin[f], last = faces.begin[f + 1];
    const auto side = [&](Offset c) { return atlas.corner(c) - atlas.corner(first); };
    double area = 0, size = 0;
    for (Offset c = first + 1; c < last; ++c) size = std::max(size, largest(side(c)));
    const double scale = 1 / power_of_two_below(size);
    for (Offset c = first + 1; c + 1 < last; ++c) area += cross(scale * side(c), scale * side(c + 1));
    balance += (area > 0) - (area < 0);
  }
  return balance < 0;
}

/// The charts of the pieces, in the order of their sources.
std::vector<Chart> charts_of(Pieces pieces, std::span<const Index> source) {
  std::vector<Chart> charts;
  for (std::vector<Index>& piece : pieces.faces) {
    std::sort(piece.begin(), piece.end());
    charts.push_back({source[piece.front()], std::move(piece)});
  }
  std::stable_sort(charts.begin(), charts.end(), [](const Chart& a, const Chart& b) {
    return a.source != b.source ? a.source < b.source : a.faces.size() > b.faces.size();
  });
  return charts;
}

/// Puts the corners of a chart where its source has them.
void put_corners(const FaceList& faces, const Regions& regions, const Chart& chart, Atlas& atlas) {
  for (Index f : chart.faces)
    for (Offset c = faces.begin[f]; c < faces.begin[f + 1]; ++c) {
      const auto q = regions.coordinates(chart.source, faces.vertices[c]);
      std::copy(q.begin(), q.end(), atlas.coordinates.begin() + 2 * c);
    }
  if (!is_mirrored(atlas, faces, chart)) return;
  for (Index f : chart.faces)
    for (Offset c = faces.begin[f]; c < faces.begin[f + 1]; ++c) {
      double& v = atlas.coordinates[2 * c + 1];
      v = -v;
    }
}

}  // namespace

AtlasMaker::AtlasMaker(const MapMaker& maps, const FaceList& faces)
    : maps_(maps), faces_(faces), neighbors_((check(maps.graph(), faces), FaceNeighbors(faces))) {
  if (maps.method() == Method::heat) front_.emplace(maps.graph(), UnfoldingFront::stars(maps.graph()));
  atlas_.chart_of_face.assign(faces.size(), nobody);
  atlas_.coordinates.assign(2 * faces.vertices.size(), std::numeric_limits<double>::quiet_NaN());
}

VoronoiCells AtlasMaker::cells(std::span<const Vertex> sources) {
  return front_ ? voronoi_cells(*front_, sources) : maps_.cells(sources);
}

/// From every source as far as to all corners of the faces that touch its cell.
std::vector<double> AtlasMaker::reach(const VoronoiCells& cells, std::size_t sources) const {
  std::vector<double> farthest(sources, 0);
  for (std::size_t v = 0; v < cells.labels.size(); ++v)
    if (const Index s = cells.labels[v]; s != nobody) farthest[s] = std::max(farthest[s], cells.distances[v]);
  const double across = maps_.longest_way(faces_);
  for (double& d : farthest) d = 1.001 * (d + across);
  return farthest;
}

void AtlasMaker::make(std::span<const Vertex> sources) {
  const VoronoiCells cells = this->cells(sources);
  const std::vector<Index>& label = cells.labels;
  const std::vector<double> reach = this->reach(cells, sources.size());
  Regions regions(faces_, label, sources.size());
  const std::vector<Index> missing = regions.adopt(regions_);
  std::vector<Vertex> starts;
  std::vector<double> far;
  std::vector<std::span<const Vertex>> wanted;
  for (Index s : missing) starts.push_back(sources[s]), far.push_back(reach[s]), wanted.push_back(regions.of(s));
  regions.keep(missing, maps_.coordinates(starts, wanted, far));
  regions_ = std::move(regions);
  std::vector<Index> source = nearest_of_faces(faces_, label, regions_);
  Pieces pieces = attach_islands(neighbors_, faces_, regions_, sources.size(), source);
  update(charts_of(std::move(pieces), source), missing);
  atlas_.sources.assign(sources.begin(), sources.end());
}

/// Puts these charts into the place of those before; what was so already stays.
/// @param remade  sources whose maps are other than before, ascending
void AtlasMaker::update(std::vector<Chart> charts, std::span<const Index> remade) {
  const std::vector<Index> before = std::exchange(atlas_.chart_of_face, std::vector<Index>(faces_.size(), nobody));
  is_new_.assign(charts.size(), 1);
  for (std::size_t k = 0; k < charts.size(); ++k) {
    const Chart& chart = charts[k];
    for (Index f : chart.faces) atlas_.chart_of_face[f] = static_cast<Index>(k);
    const Index same = before[chart.faces.front()];
    if (same != nobody && atlas_.charts[same].source == chart.source && atlas_.charts[same].faces == chart.faces &&
        !std::ranges::binary_search(remade, chart.source))
      is_new_[k] = 0;
    else
      put_corners(faces_, regions_, chart, atlas_);
  }
  for (std::size_t f = 0; f < faces_.size(); ++f)
    if (atlas_.chart_of_face[f] == nobody && before[f] != nobody)
      std::fill(atlas_.coordinates.begin() + 2 * faces_.begin[f], atlas_.coordinates.begin() + 2 * faces_.begin[f + 1],
                std::numeric_limits<double>::quiet_NaN());
  atlas_.charts = std::move(charts);
}

}  // namespace ahm
