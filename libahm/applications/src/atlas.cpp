#include "ahm/applications/atlas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ahm/applications/cells.hpp"
#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {

/// Neighbors of each face: faces that share a side, once per shared side. On a side of many faces, consecutive ones are
/// neighbors.
class FaceNeighbors {
 public:
  explicit FaceNeighbors(const FaceList& faces) : begin_(faces.size() + 1, 0) {
    struct Side {
      Index low, high, face;
    };
    std::vector<Side> sides;
    sides.reserve(faces.vertices.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto face = faces[f];
      for (std::size_t c = 0; c < face.size(); ++c) {
        const auto [low, high] = std::minmax(face[c], face[(c + 1) % face.size()]);
        sides.push_back({low, high, static_cast<Index>(f)});
      }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
      if (a.low != b.low) return a.low < b.low;
      return a.high != b.high ? a.high < b.high : a.face < b.face;
    });
    const auto for_pairs = [&](const auto& visit) {
      for (std::size_t k = 1; k < sides.size(); ++k)
        if (sides[k].low == sides[k - 1].low && sides[k].high == sides[k - 1].high &&
            sides[k].face != sides[k - 1].face)
          visit(sides[k - 1].face, sides[k].face), visit(sides[k].face, sides[k - 1].face);
    };
    for_pairs([&](Index f, Index) { ++begin_[static_cast<std::size_t>(f) + 1]; });
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    neighbors_.resize(static_cast<std::size_t>(begin_.back()));
    std::vector<Offset> end(begin_.begin(), begin_.end() - 1);
    for_pairs([&](Index f, Index g) { neighbors_[end[f]++] = g; });
  }

  std::span<const Index> of(Index face) const {
    const auto f = static_cast<std::size_t>(face);
    return {neighbors_.data() + begin_[f], static_cast<std::size_t>(begin_[f + 1] - begin_[f])};
  }

 private:
  std::vector<Offset> begin_;
  std::vector<Index> neighbors_;
};

/// For every source: the vertices of all faces that touch its cell, and their coordinates from that source.
class Regions {
 public:
  Regions() = default;
  Regions(const FaceList& faces, std::span<const Index> label, std::size_t sources) : begin_(sources + 1, 0) {
    // Sources are first collected per vertex, so that the vertices of each source come in ascending order.
    std::vector<Offset> first(label.size() + 1, 0);
    for_entries(faces, label, [&](Index, Index vertex) { ++first[at(vertex) + 1]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Index> of_vertex(at(first.back()));
    std::vector<Offset> end(first.begin(), first.end() - 1);
    for_entries(faces, label, [&](Index source, Index vertex) { of_vertex[end[vertex]++] = source; });
    for (std::size_t v = 0; v < label.size(); ++v) {
      const auto from = of_vertex.begin() + first[v];
      std::sort(from, of_vertex.begin() + end[v]);
      end[v] = std::unique(from, of_vertex.begin() + end[v]) - of_vertex.begin();
      for (Offset k = first[v]; k < end[v]; ++k) ++begin_[at(of_vertex[k]) + 1];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    vertices_.resize(at(begin_.back()));
    std::vector<Offset> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t v = 0; v < label.size(); ++v)
      for (Offset k = first[v]; k < end[v]; ++k) vertices_[next[of_vertex[k]]++] = Vertex(v);
    coordinates_.resize(2 * vertices_.size(), std::numeric_limits<double>::quiet_NaN());
    is_complete_.assign(sources, 0);
  }

  /// Copies coordinates from `before`, whose sources are the first ones here.
  /// @return the sources without coordinates for some vertex
  std::vector<Index> reuse(const Regions& before) {
    std::vector<Index> missing;
    for (std::size_t s = 0; s + 1 < begin_.size(); ++s) {
      bool complete = s + 1 < before.begin_.size();
      for (Offset k = begin_[s]; k < begin_[s + 1] && complete; ++k) {
        const Offset there = before.find(s, vertices_[k]);
        complete = there >= 0;
        for (std::size_t c = 0; c < 2 && complete; ++c)
          coordinates_[2 * at(k) + c] = before.coordinates_[2 * at(there) + c];
      }
      if (complete)
        is_complete_[s] = has_all_coordinates(static_cast<Index>(s));
      else
        missing.push_back(static_cast<Index>(s));
    }
    return missing;
  }

  /// The vertices in the region of a source.
  std::span<const Vertex> of(Index source) const {
    return std::span(vertices_).subspan(at(begin_[source]), at(begin_[source + 1] - begin_[source]));
  }
  /// @param coordinates  coordinates of the vertices of these sources, source by source
  void keep(std::span<const Index> sources, std::span<const double> coordinates) {
    auto next = coordinates.begin();
    for (Index source : sources) {
      const auto end = next + 2 * std::ssize(of(source));
      std::copy(next, end, coordinates_.begin() + 2 * begin_[source]);
      is_complete_[source] = has_all_coordinates(source);
      next = end;
    }
  }

  /// Whether all vertices in the region of a source have coordinates.
  bool is_complete(Index source) const { return is_complete_[source] != 0; }
  /// (u, v) of a vertex from a source; NaN where unknown.
  std::array<double, 2> coordinates(Index source, Index vertex) const {
    const Offset k = find(at(source), Vertex(vertex));
    if (k < 0) return {std::nan(""), std::nan("")};
    return {coordinates_[2 * at(k)], coordinates_[2 * at(k) + 1]};
  }

 private:
  /// Index of the vertex in `vertices_`; -1 where the region does not contain it.
  Offset find(std::size_t source, Vertex vertex) const {
    const auto first = vertices_.begin() + begin_[source], last = vertices_.begin() + begin_[source + 1];
    const auto found = std::lower_bound(first, last, vertex);
    return found == last || *found != vertex ? -1 : found - vertices_.begin();
  }

  bool has_all_coordinates(Index source) const {
    return all_finite(
        std::span(coordinates_).subspan(2 * at(begin_[source]), 2 * at(begin_[source + 1] - begin_[source])));
  }
  static std::size_t at(Offset i) { return static_cast<std::size_t>(i); }

  template <class Visit>
  static void for_entries(const FaceList& faces, std::span<const Index> label, const Visit& visit) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto face = faces[f];
      for (std::size_t c = 0; c < face.size(); ++c) {
        const Index source = label[face[c]];  // -1: no source
        const bool seen = std::any_of(face.begin(), face.begin() + static_cast<std::ptrdiff_t>(c),
                                      [&](Index v) { return label[v] == source; });
        if (source < 0 || seen) continue;
        for (Index v : face) visit(source, v);
      }
    }
  }

  std::vector<Offset> begin_{0};
  std::vector<Vertex> vertices_;
  std::vector<double> coordinates_;
  std::vector<std::uint8_t> is_complete_;  ///< for every source: all of its coordinates are finite
};

class AtlasMaker {
 public:
  /// @throws as `make_atlas`
  AtlasMaker(const AnySolver& maps, const FaceList& faces);

  /// @param sources  begin with those of the previous call. Their cells can only shrink, so their maps are reused
  void make(std::span<const Vertex> sources);
  const Atlas& atlas() const { return atlas_; }
  Atlas take() { return std::move(atlas_); }
  /// Whether the last call changed this chart: its source, its faces or its map.
  bool is_new(std::size_t chart) const { return is_new_[chart] != 0; }

 private:
  VoronoiCells cells(std::span<const Vertex> sources);
  void update(std::vector<Chart> charts, std::span<const Index> remade);
  std::vector<double> reach(const VoronoiCells& cells, std::size_t sources) const;

  AnySolver maps_;
  FaceList faces_;
  FaceNeighbors neighbors_;
  Regions regions_;
  std::optional<Wavefront> front_;  ///< front from all sources so far; heat method only
  Atlas atlas_;
  std::vector<std::uint8_t> is_new_;  ///< for every chart: changed by the last call
};

namespace {

constexpr Index no_source = -1;

void check(const TangentGraph& graph, const FaceList& faces) {
  if (graph.dimension() != 2)
    throw InvalidArgument("the graph has dimension " + std::to_string(graph.dimension()) +
                          "; an atlas requires a surface, dimension 2");
  if (faces.begin.empty() || faces.begin.front() != 0 || faces.begin.back() != std::ssize(faces.vertices) ||
      !std::is_sorted(faces.begin.begin(), faces.begin.end()))
    throw InvalidArgument("'faces.begin' must ascend from 0 to the number of corners, " +
                          std::to_string(faces.vertices.size()));
  for (std::size_t c = 0; c < faces.vertices.size(); ++c)
    if (faces.vertices[c] < 0 || faces.vertices[c] >= graph.size())
      throw InvalidArgument("corner " + std::to_string(c) + " refers to vertex " + std::to_string(faces.vertices[c]) +
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

/// The cell C_i of the paper for every face: the source with the smallest sum of distances to its corners.
std::vector<Index> nearest_of_faces(const FaceList& faces, std::span<const Index> label, const Regions& regions) {
  std::vector<Index> result(faces.size(), no_source);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    double least = std::numeric_limits<double>::infinity();
    Index before = no_source;
    const auto face = faces[f];
    if (const Index only = face.empty() ? no_source : label[face.front()];
        only != no_source && regions.is_complete(only) &&
        std::ranges::all_of(face, [&](Index v) { return label[v] == only; })) {
      result[f] = only;
      continue;
    }
    for (Index v : face) {
      const Index source = label[v];
      if (source == no_source || source == before) continue;
      const double sum = sum_of_distances(regions, before = source, face);
      if (sum < least || (sum == least && source < result[f])) least = sum, result[f] = source;
    }
  }
  return result;
}

/// Connected pieces of faces with the same source.
class Pieces {
 public:
  Pieces(const FaceNeighbors& neighbors, std::span<const Index> source) : of_face(source.size(), no_source) {
    std::vector<Index> stack;
    for (std::size_t seed = 0; seed < source.size(); ++seed) {
      if (source[seed] == no_source || of_face[seed] != no_source) continue;
      const auto piece = static_cast<Index>(faces.size());
      faces.emplace_back();
      of_face[seed] = piece;
      stack.assign(1, static_cast<Index>(seed));
      while (!stack.empty()) {
        const Index f = stack.back();
        stack.pop_back();
        faces.back().push_back(f);
        for (Index g : neighbors.of(f))
          if (source[g] == source[seed] && of_face[g] == no_source) of_face[g] = piece, stack.push_back(g);
      }
    }
  }

  /// The piece with the most faces of each source; `no_source` for a source without faces.
  std::vector<Index> largest(std::span<const Index> source, std::size_t sources) const {
    std::vector<Index> result(sources, no_source);
    for (std::size_t p = 0; p < faces.size(); ++p) {
      Index& best = result[source[faces[p].front()]];
      if (best == no_source || faces[best].size() < faces[p].size()) best = static_cast<Index>(p);
    }
    return result;
  }

  std::vector<Index> of_face;
  std::vector<std::vector<Index>> faces;
};

/// The neighboring source whose main piece shares most sides with `island` and whose map covers it; `no_source` if there is
/// none.
Index best_neighbor(const std::vector<Index>& island, const FaceNeighbors& neighbors, const FaceList& faces,
                    std::span<const Index> source, const std::vector<std::uint8_t>& in_main, const Regions& regions) {
  std::vector<Index> candidates;  // one per shared side
  for (Index f : island)
    for (Index g : neighbors.of(f))
      if (in_main[g] && source[g] != source[f]) candidates.push_back(source[g]);
  std::sort(candidates.begin(), candidates.end());
  Index best = no_source;
  std::ptrdiff_t most = 0;
  for (auto first = candidates.begin(); first != candidates.end();) {
    const auto last = std::upper_bound(first, candidates.end(), *first);
    const bool covers_island = std::all_of(island.begin(), island.end(), [&](Index f) {
      return std::isfinite(sum_of_distances(regions, *first, faces[f]));
    });
    if (covers_island && last - first > most) most = last - first, best = *first;
    first = last;
  }
  return best;
}

/// Attaches pieces that are cut off from their cell to neighboring charts, until no more can be attached.
/// @return the resulting pieces
Pieces attach_islands(const FaceNeighbors& neighbors, const FaceList& faces, const Regions& regions,
                      std::size_t sources, std::vector<Index>& source) {
  while (true) {
    bool changed = false;
    Pieces pieces(neighbors, source);
    const std::vector<Index> main = pieces.largest(source, sources);
    std::vector<std::uint8_t> in_main(source.size(), 0);
    for (std::size_t f = 0; f < source.size(); ++f)
      in_main[f] = source[f] != no_source && main[source[f]] == pieces.of_face[f];
    for (const auto& piece : pieces.faces) {
      if (in_main[piece.front()]) continue;
      const Index better = best_neighbor(piece, neighbors, faces, source, in_main, regions);
      if (better == no_source) continue;
      for (Index f : piece) source[f] = better;
      changed = true;
    }
    if (!changed) return pieces;
  }
}

/// Whether the map flips most faces of a chart. Faces are counted, because areas cancel where the chart closes around a
/// handle.
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

/// The pieces as charts, sorted by source.
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

/// Copies the coordinates of a chart's corners from its source.
void copy_corners(const FaceList& faces, const Regions& regions, const Chart& chart, Atlas& atlas) {
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

AtlasMaker::AtlasMaker(const AnySolver& maps, const FaceList& faces)
    : maps_(maps), faces_(faces), neighbors_((check(maps.graph(), faces), FaceNeighbors(faces))) {
  if (maps.method() == Method::heat) front_.emplace(maps.graph(), Wavefront::one_rings(maps.graph()));
  atlas_.chart_of_face.assign(faces.size(), no_source);
  atlas_.coordinates.assign(2 * faces.vertices.size(), std::numeric_limits<double>::quiet_NaN());
}

VoronoiCells AtlasMaker::cells(std::span<const Vertex> sources) {
  return front_ ? voronoi_cells(*front_, sources) : maps_.cells(sources);
}

/// Radius from each source that covers all corners of the faces that touch its cell.
std::vector<double> AtlasMaker::reach(const VoronoiCells& cells, std::size_t sources) const {
  std::vector<double> farthest(sources, 0);
  for (std::size_t v = 0; v < cells.labels.size(); ++v)
    if (const Index s = cells.labels[v]; s != no_source) farthest[s] = std::max(farthest[s], cells.distances[v]);
  const double across = maps_.longest_corner_distance(faces_);
  for (double& d : farthest) d = 1.001 * (d + across);
  return farthest;
}

void AtlasMaker::make(std::span<const Vertex> sources) {
  const VoronoiCells cells = this->cells(sources);
  const std::vector<Index>& label = cells.labels;
  const std::vector<double> reach = this->reach(cells, sources.size());
  Regions regions(faces_, label, sources.size());
  const std::vector<Index> missing = regions.reuse(regions_);
  std::vector<Vertex> starts;
  std::vector<double> far;
  std::vector<std::span<const Vertex>> missing_regions;
  for (Index s : missing)
    starts.push_back(sources[s]), far.push_back(reach[s]), missing_regions.push_back(regions.of(s));
  regions.keep(missing, maps_.coordinates(starts, missing_regions, far));
  regions_ = std::move(regions);
  std::vector<Index> source = nearest_of_faces(faces_, label, regions_);
  Pieces pieces = attach_islands(neighbors_, faces_, regions_, sources.size(), source);
  update(charts_of(std::move(pieces), source), missing);
  atlas_.sources.assign(sources.begin(), sources.end());
}

/// Replaces the charts. The coordinates of unchanged charts are kept.
/// @param remade  sources whose maps have changed, ascending
void AtlasMaker::update(std::vector<Chart> charts, std::span<const Index> remade) {
  const std::vector<Index> before = std::exchange(atlas_.chart_of_face, std::vector<Index>(faces_.size(), no_source));
  is_new_.assign(charts.size(), 1);
  for (std::size_t k = 0; k < charts.size(); ++k) {
    const Chart& chart = charts[k];
    for (Index f : chart.faces) atlas_.chart_of_face[f] = static_cast<Index>(k);
    const Index same = before[chart.faces.front()];
    if (same != no_source && atlas_.charts[same].source == chart.source && atlas_.charts[same].faces == chart.faces &&
        !std::ranges::binary_search(remade, chart.source))
      is_new_[k] = 0;
    else
      copy_corners(faces_, regions_, chart, atlas_);
  }
  for (std::size_t f = 0; f < faces_.size(); ++f)
    if (atlas_.chart_of_face[f] == no_source && before[f] != no_source)
      std::fill(atlas_.coordinates.begin() + 2 * faces_.begin[f], atlas_.coordinates.begin() + 2 * faces_.begin[f + 1],
                std::numeric_limits<double>::quiet_NaN());
  atlas_.charts = std::move(charts);
}

namespace {

/// Corners of the convex hull, counter-clockwise (Andrew's monotone chains).
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2> hull;
  for (int chain = 0; chain < 2; ++chain) {
    const std::size_t start = hull.size();
    for (const Vec2& p : points) {
      const auto turns_right = [&](const Vec2& o) { return !(cross(hull.back() - o, p - o) > 0); };
      while (hull.size() >= start + 2 && turns_right(hull[hull.size() - 2])) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();  // the next chain begins with it
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

ChartBox box_along(const std::vector<Vec2>& hull, double c, double s) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  ChartBox box{{c, s}, {infinity, infinity}, {-infinity, -infinity}};
  for (const Vec2& p : hull) {
    const Vec2 q{c * p[0] + s * p[1], c * p[1] - s * p[0]};
    for (std::size_t k : {0, 1}) box.low[k] = std::min(box.low[k], q[k]), box.high[k] = std::max(box.high[k], q[k]);
  }
  return box;
}

/// The box of smallest area: one of its sides lies along a side of the convex hull [FS75].
ChartBox smallest_box(const std::vector<Vec2>& hull) {
  ChartBox best = box_along(hull, 1, 0);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const Vec2 &a = hull[k], &b = hull[(k + 1) % hull.size()];
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    if (!(length > 0)) continue;
    const ChartBox box = box_along(hull, (b[0] - a[0]) / length, (b[1] - a[1]) / length);
    const double area = (box.high[0] - box.low[0]) * (box.high[1] - box.low[1]);
    if (area < least) least = area, best = box;
  }
  if (best.high[0] - best.low[0] < best.high[1] - best.low[1])
    best = box_along(hull, -best.turn[1], best.turn[0]);  // turned by another quarter
  return best;
}

}  // namespace

std::vector<ChartBox> chart_boxes(const Atlas& atlas, const FaceList& faces) {
  return detail::with_memory_check("bounding charts", [&] {
    if (faces.size() != atlas.chart_of_face.size() || 2 * faces.vertices.size() != atlas.coordinates.size())
      throw InvalidArgument("there are " + detail::counted(faces.size(), "face") + " with " +
                            detail::counted(faces.vertices.size(), "corner") + ", but the atlas has " +
                            detail::counted(atlas.chart_of_face.size(), "face") + " with " +
                            std::to_string(atlas.coordinates.size() / 2));
    std::vector<ChartBox> boxes;
    for (const Chart& chart : atlas.charts) {
      std::vector<Vec2> points;
      for (Index f : chart.faces)
        for (Offset c = faces.begin[f]; c < faces.begin[f + 1]; ++c) points.push_back(atlas.corner(c));
      double size = 0;
      for (const Vec2& p : points) size = std::max(size, largest(p));
      const double unit = power_of_two_below(size);
      for (Vec2& p : points) p = 1 / unit * p;
      ChartBox box = smallest_box(convex_hull(std::move(points)));
      box.low = unit * box.low, box.high = unit * box.high;
      boxes.push_back(box);
    }
    return boxes;
  });
}

namespace {

void check(const Atlas& atlas, const FaceList& faces) {
  if (atlas.chart_of_face.size() != faces.size() || atlas.coordinates.size() != 2 * faces.vertices.size())
    throw InvalidArgument("the atlas has " + detail::counted(atlas.chart_of_face.size(), "face") + " and " +
                          detail::counted(atlas.coordinates.size() / 2, "corner") + ", but 'faces' has " +
                          detail::counted(faces.size(), "face") + " and " +
                          detail::counted(faces.vertices.size(), "corner"));
}

/// Faces cut into fans of triangles, and the distortion of these triangles in the atlas.
struct FaceFans {
  std::vector<std::array<Offset, 3>> corners;
  std::vector<TriangleDistortion> triangles;

  FaceFans(const Atlas& atlas, const FaceList& faces, std::span<const Vec3> positions, std::span<const Index> numbers) {
    std::vector<std::array<Index, 3>> vertices;
    std::vector<double> coordinates;
    for (Index f : numbers)
      for (Offset c = faces.begin[f] + 1; c + 1 < faces.begin[f + 1]; ++c) {
        corners.push_back({faces.begin[f], c, c + 1});
        auto& triangle = vertices.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
          triangle[k] = faces.vertices[corners.back()[k]];
          for (double x : atlas.corner(corners.back()[k])) coordinates.push_back(x);
        }
      }
    triangles = corner_distortion(positions, vertices, coordinates);
  }
};

/// The vertex that becomes another source in a chart; -1 where the chart is good or no vertex is left.
Index vertex_to_add(const Atlas& atlas, const FaceList& faces, std::span<const Vec3> positions, const Chart& chart,
                    const std::vector<bool>& is_source, const RefineOptions& options) {
  const FaceFans fans(atlas, faces, positions, chart.faces);
  const std::vector<double> areas = relative_areas(fans.triangles);
  double area = 0, bad_area = 0, farthest = -1;
  Index vertex = -1;
  for (std::size_t t = 0; t < fans.triangles.size(); ++t) {
    const TriangleDistortion& triangle = fans.triangles[t];
    area += areas[t];
    if (!triangle.flipped && !(triangle.value() > options.max_distortion)) continue;
    bad_area += areas[t];
    for (Offset c : fans.corners[t]) {
      const auto [u, v] = atlas.corner(c);
      const Index candidate = faces.vertices[c];
      if (std::hypot(u, v) > farthest && !is_source[candidate]) farthest = std::hypot(u, v), vertex = candidate;
    }
  }
  return bad_area > options.share * area ? vertex : -1;
}

/// The sources, and one vertex of each component of faces without a source.
std::vector<Vertex> one_per_component(const TangentGraph& graph, std::span<const Vertex> sources, const FaceList& faces,
                                      std::size_t most) {
  std::vector<Vertex> result(sources.begin(), sources.end());
  const Components components = connected_components(graph);
  std::vector<bool> has_source(components.count, false);
  const auto component = [&](Index vertex) { return components.of_vertex[vertex]; };
  for (const auto [vertex] : sources)
    if (vertex >= 0 && vertex < graph.size()) has_source[component(vertex)] = true;
  for (Index vertex : faces.vertices) {
    if (result.size() >= most || has_source[component(vertex)]) continue;
    has_source[component(vertex)] = true;
    result.push_back(Vertex(vertex));
  }
  return result;
}

}  // namespace

AtlasDistortion distortion(const Atlas& atlas, const FaceList& faces, std::span<const Vec3> positions) {
  check(atlas, faces);
  return detail::with_memory_check("measuring distortion", [&] {
    AtlasDistortion result;
    std::vector<TriangleDistortion> all;
    const auto add = [&](std::span<const Index> numbers) {
      const FaceFans fans(atlas, faces, positions, numbers);
      all.insert(all.end(), fans.triangles.begin(), fans.triangles.end());
      return summary(fans.triangles);
    };
    for (const Chart& chart : atlas.charts) result.charts.push_back(add(chart.faces));
    std::vector<Index> uncharted;
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (atlas.chart_of_face[f] < 0) uncharted.push_back(static_cast<Index>(f));
    add(uncharted);
    result.all = summary(all);
    return result;
  });
}

Atlas make_atlas(const AnySolver& maps, std::span<const Vertex> sources, const FaceList& faces) {
  return detail::with_memory_check("making an atlas", [&] {
    AtlasMaker maker(maps, faces);
    maker.make(sources);
    return maker.take();
  });
}

Atlas make_atlas(const AnySolver& maps, std::span<const Vertex> sources, const FaceList& faces,
                 std::span<const Vec3> positions, const RefineOptions& refine) {
  if (!(refine.max_distortion > 1))
    throw InvalidArgument("max_distortion is " + detail::number(refine.max_distortion) + "; it must be > 1");
  if (!(refine.share >= 0 && refine.share < 1))
    throw InvalidArgument("share is " + detail::number(refine.share) + "; it must be in [0, 1)");
  if (positions.size() != static_cast<std::size_t>(maps.graph().size()))
    throw InvalidArgument("'positions' has " + detail::counted(positions.size(), "entry") + ", not " +
                          std::to_string(maps.graph().size()));
  return detail::with_memory_check("making an atlas", [&] {
    AtlasMaker maker(maps, faces);
    maker.make(one_per_component(maps.graph(), sources, faces, refine.max_sources));
    const Atlas& atlas = maker.atlas();
    std::vector<bool> is_source(positions.size(), false);
    for (Vertex vertex : atlas.sources) is_source[vertex.index] = true;
    std::vector<bool> needs_no_source(faces.size(),
                                      false);  // indexed by the first face of a chart: it needs no other source
    while (true) {
      std::vector<Vertex> more = atlas.sources;
      for (std::size_t k = 0; k < atlas.charts.size(); ++k) {
        if (more.size() >= refine.max_sources) break;
        const Chart& chart = atlas.charts[k];
        if (!maker.is_new(k) && needs_no_source[chart.faces.front()]) continue;
        const Index vertex = vertex_to_add(atlas, faces, positions, chart, is_source, refine);
        needs_no_source[chart.faces.front()] = vertex < 0;
        if (vertex < 0 || is_source[vertex]) continue;  // two charts may choose the same corner
        is_source[vertex] = true;
        more.push_back(Vertex(vertex));
      }
      if (more.size() == atlas.sources.size()) return maker.take();
      maker.make(more);
    }
  });
}

}  // namespace ahm
