#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <queue>
#include <vector>

#include "ahm/surface/exact/shortened_path.hpp"
#include "check_point.hpp"
#include "shorten.hpp"
#include "unfold.hpp"
#include "walk.hpp"

namespace ahm::exact {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// How a way comes to a vertex.
struct Step {
  double distance = infinity;  ///< so far
  Index from = -1;             ///< vertex; -1: where the way starts
  Half across = -1;            ///< the half-edge that it crosses; -1: none
  double along = 0;            ///< from its tail
};

/// One step per vertex, in pages that are made where one is asked for: near points take little of a large surface.
class Steps {
 public:
  explicit Steps(Index size) : pages_(static_cast<std::size_t>(size) / per_page + 1) {}
  Step& operator[](Index vertex) {
    std::unique_ptr<Page>& page = pages_[static_cast<std::size_t>(vertex) / per_page];
    if (!page) page = std::make_unique<Page>();
    return (*page)[static_cast<std::size_t>(vertex) % per_page];
  }

 private:
  static constexpr std::size_t per_page = 128;
  using Page = std::array<Step, per_page>;
  std::vector<std::unique_ptr<Page>> pages_;
};

/// The shortest way along the edges and straight across them to the vertex beyond, by Dijkstra's algorithm or, with a
/// lower bound, A* [HNR68].
class EdgeSearch {
 public:
  EdgeSearch(const PolyhedralSurface& surface, const std::function<double(Vertex)>& at_least)
      : surface_(surface), at_least_(at_least), step_(surface.vertex_count()) {}

  /// The vertices of the way, and where it crosses edges between them; none where there is none.
  std::vector<MeshPoint> run(const MeshPoint& from, const MeshPoint& to) {
    double after[3];
    for (int s = 0; s < 3; ++s) after[s] = to_corner(to, s);
    for (int s = 0; s < 3; ++s)
      if (const double d = to_corner(from, s); d < infinity) offer(surface_.record(3 * from.face + s).tail, {d});
    double best = infinity;
    Index last = -1;
    while (!queue_.empty() && queue_.top().key < best) {
      const Entry entry = queue_.top();
      queue_.pop();
      if (entry.distance > step_[entry.vertex].distance) continue;
      for (int s = 0; s < 3; ++s)
        if (surface_.record(3 * to.face + s).tail == entry.vertex && entry.distance + after[s] < best) {
          best = entry.distance + after[s];
          last = entry.vertex;
        }
      go_on(entry);
    }
    std::vector<MeshPoint> way;
    for (Index v = last; v >= 0; v = step_[v].from) {
      way.push_back(surface_.vertex_point(Vertex(v)));
      if (step_[v].across >= 0) way.push_back(point_on(surface_, step_[v].across, step_[v].along));
    }
    std::reverse(way.begin(), way.end());
    return way;
  }

 private:
  struct Entry {
    double key, distance;
    Index vertex;
    bool operator<(const Entry& other) const { return key != other.key ? key > other.key : vertex > other.vertex; }
  };

  /// From a point of a face; a point at a corner goes there alone.
  double to_corner(const MeshPoint& point, int s) const {
    if (vertex_of(surface_, point) >= 0) return point.barycentric[s] > 0 ? 0 : infinity;
    MeshPoint corner{point.face, {0, 0, 0}};
    corner.barycentric[s] = 1;
    return distance(surface_.place(point), surface_.place(corner));
  }

  void go_on(const Entry& entry) {
    const Corner first = surface_.first_corner(entry.vertex);
    Corner c = first;
    do {
      const HalfRecord& r = surface_.record(c.half);
      offer(r.head, {entry.distance + r.length, entry.vertex});
      offer(r.apex, {entry.distance + r.left, entry.vertex});
      if (r.beyond_right >= 0) cross_right(entry, r);
      c = surface_.turn_left(c);
    } while (c.half >= 0 && c != first);
  }

  /// To the vertex beyond the side opposite to the tail, where it is seen through that side.
  void cross_right(const Entry& entry, const HalfRecord& r) {
    const HalfRecord& there = surface_.record(r.beyond_right);
    Place from = beyond_right(r, {0, 0});
    if (r.mirrored & 2) from[0] = there.length - from[0];
    const Place to = apex(there);
    const double along = from[0] - (to[0] - from[0]) * from[1] / (to[1] - from[1]);
    if (along > 0 && along < there.length)
      offer(there.apex, {entry.distance + exact::distance(from, to), entry.vertex, r.beyond_right, along});
  }

  void offer(Index vertex, const Step& step) {
    Step& known = step_[vertex];
    if (!(step.distance < known.distance)) return;
    known = step;
    queue_.push({step.distance + (at_least_ ? at_least_(Vertex(vertex)) : 0.0), step.distance, vertex});
  }

  const PolyhedralSurface& surface_;
  const std::function<double(Vertex)>& at_least_;
  Steps step_;
  std::priority_queue<Entry> queue_;
};

}  // namespace

GeodesicPath locally_shortest_path(const PolyhedralSurface& surface, const MeshPoint& from, const MeshPoint& to,
                                   const std::function<double(Vertex)>& at_least) {
  const MeshPoint start = checked(surface, from, "from"), end = checked(surface, to, "to");
  const Index start_vertex = vertex_of(surface, start), end_vertex = vertex_of(surface, end);
  std::vector<MeshPoint> curve{start};
  if (start.face == end.face) {
    curve.push_back(end);
    return shortened_path(surface, curve);
  }
  const auto component = [&](const MeshPoint& p) { return surface.component(surface.record(3 * p.face).tail); };
  if (component(start) != component(end)) {
    GeodesicPath none;
    none.status = Status::disconnected;
    return none;
  }
  for (const MeshPoint& p : EdgeSearch(surface, at_least).run(start, end))
    if (const Index v = vertex_of(surface, p); v < 0 || (v != start_vertex && v != end_vertex)) curve.push_back(p);
  curve.push_back(end);
  Strip strip = strip_along(surface, curve);
  const TautLine line = pass_other_side(surface, strip, shorten(surface, strip));
  return path_along(surface, strip, line);
}

}  // namespace ahm::exact
