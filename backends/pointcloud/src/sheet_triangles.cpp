#include "sheet_triangles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>

#include "ahm/surface/detail/gluing.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {
namespace {

using std::numbers::pi;

/// Holes with more edges stay open, because they are gaps in the sampling.
constexpr std::size_t max_hole_edges = 12;
/// A triangle flatter than this fraction of its longest side has no reliable angles.
constexpr double min_height = 1e-6;
/// Typical number of triangles at a vertex.
constexpr std::size_t usual_degree = 8;
/// Dropping a fan may open a hole. On real shapes nothing changes after the second round.
constexpr int fill_rounds = 3;

/// The corner of a triangle at a vertex, in the tangent plane of the vertex: counter-clockwise from `right` to `left`.
struct Wedge {
  Index triangle;
  Index right, left;
  double begin, extent;
};

double counter_clockwise(double from, double to) {
  const double turn = to - from;
  return turn < 0 ? turn + 2 * pi : turn;
}

bool overlap(const Wedge& a, const Wedge& b) {
  return counter_clockwise(a.begin, b.begin) < a.extent || counter_clockwise(b.begin, a.begin) < b.extent;
}

/// A set of triangles with wedges that do not overlap at any vertex. No edge then has more than two triangles.
class Sheet {
 public:
  explicit Sheet(std::span<const Frame> frames) : frames_(frames), wedges_(frames.size()) {}

  /// Adds a triangle if it overlaps no other.
  /// @return whether it was added
  bool add(const Triangle& t) {
    if (!has_one_side(t)) return false;
    std::array<Wedge, 3> corners;
    for (int c = 0; c < 3; ++c) {
      const auto wedge = wedge_of(t[c], t[(c + 1) % 3], t[(c + 2) % 3]);
      if (!wedge || std::ranges::any_of(wedges_[t[c]], [&](const Wedge& w) { return overlap(w, *wedge); }))
        return false;
      corners[c] = *wedge;
    }
    for (int c = 0; c < 3; ++c) {
      auto& at = wedges_[t[c]];
      at.reserve(usual_degree);
      at.insert(std::ranges::upper_bound(at, corners[c].begin, {}, &Wedge::begin), corners[c]);
    }
    triangles_.push_back(t);
    dropped_.push_back(0);
    return true;
  }

  /// Triangulates holes with few edges by cutting ears.
  void fill_holes() {
    for (Index v = 0; v < vertex_count(); ++v) {
      std::vector<Index> starts;
      for (std::size_t k = 0; k < wedges_[v].size(); ++k)
        if (wedges_[v][k].left != following(v, k).right) starts.push_back(wedges_[v][k].left);
      for (const Index first : starts)
        if (has_gap_beyond(v, first)) fill(hole(v, first));
    }
  }

  /// Keeps only the widest fan of triangles at each vertex.
  void drop_small_fans() {
    std::vector<Index> queue(wedges_.size());
    std::iota(queue.rbegin(), queue.rend(), 0);
    while (!queue.empty()) {
      const Index v = queue.back();
      queue.pop_back();
      for (const Index triangle : triangles_outside_widest_fan(v)) {
        drop(triangle);
        for (const Index corner : triangles_[triangle])
          if (corner != v) queue.push_back(corner);
      }
    }
  }

  /// Splits the triangle that contains a vertex without triangles.
  /// @param near  vertices with the triangles to search
  void insert(Index v, std::span<const Index> near) {
    std::vector<Index> around;
    for (const Index n : near)
      for (const Wedge& w : wedges_[n])
        if (is_inside(v, triangles_[w.triangle])) around.push_back(w.triangle);
    std::ranges::sort(around);
    around.erase(std::unique(around.begin(), around.end()), around.end());
    for (const Index outer : around) {
      const Triangle t = triangles_[outer];
      drop(outer);
      int added = 0;
      while (added < 3 && add({t[added], t[(added + 1) % 3], v})) ++added;
      if (added == 3) return;
      for (; added > 0; --added) drop(static_cast<Index>(triangles_.size()) - added);
      add(t);
    }
  }

  bool is_covered(Index v) const { return !wedges_[v].empty(); }
  Index vertex_count() const { return static_cast<Index>(wedges_.size()); }

  std::vector<Triangle> triangles() const {
    std::vector<Triangle> result;
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      if (!dropped_[t]) result.push_back(triangles_[t]);
    return result;
  }

 private:
  /// Whether the normals at the corners agree on the upper side of the triangle.
  bool has_one_side(const Triangle& t) const {
    const Vec3 a = frames_[t[1]].origin - frames_[t[0]].origin, b = frames_[t[2]].origin - frames_[t[0]].origin,
               normal = cross(a, b);
    const double longest = std::max({norm(a), norm(b), norm(b - a)});
    if (!(norm(normal) > min_height * longest * longest)) return false;
    const bool up = dot(normal, frames_[t[0]].normal) > 0;
    for (int c = 1; c < 3; ++c) {
      const bool agrees = dot(frames_[t[0]].normal, frames_[t[c]].normal) > 0;
      if ((dot(normal, frames_[t[c]].normal) > 0) != (up == agrees)) return false;
    }
    return true;
  }

  double angle(Index from, Index to) const {
    const Frame& frame = frames_[from];
    const Vec3 offset = frames_[to].origin - frame.origin;
    return std::atan2(dot(frame.y, offset), dot(frame.x, offset));
  }

  std::optional<Wedge> wedge_of(Index v, Index a, Index b) const {
    const double at_a = angle(v, a), at_b = angle(v, b), turn = counter_clockwise(at_a, at_b),
                 back = counter_clockwise(at_b, at_a);
    const auto triangle = static_cast<Index>(triangles_.size());
    const Wedge wedge = turn < pi ? Wedge{triangle, a, b, at_a, turn} : Wedge{triangle, b, a, at_b, back};
    return wedge.extent > min_height && wedge.extent < pi ? std::optional(wedge) : std::nullopt;
  }

  const Wedge& following(Index v, std::size_t k) const { return wedges_[v][(k + 1) % wedges_[v].size()]; }

  bool has_gap_beyond(Index v, Index first) const {
    for (std::size_t k = 0; k < wedges_[v].size(); ++k)
      if (wedges_[v][k].left == first) return following(v, k).right != first;
    return false;
  }

  /// The neighbor at the other end of the gap that begins at a boundary edge; -1: not a boundary edge.
  Index across_gap(Index v, Index neighbor) const {
    const auto& at = wedges_[v];
    for (std::size_t k = 0; k < at.size(); ++k) {
      if (at[k].left == neighbor && following(v, k).right != neighbor) return following(v, k).right;
      if (at[k].right != neighbor) continue;
      const Wedge& before = at[(k + at.size() - 1) % at.size()];
      if (before.left != neighbor) return before.left;
    }
    return -1;
  }

  /// The boundary loop of a hole, from its lowest vertex on. Empty if the loop is too long, touches itself or starts at another
  /// vertex.
  std::vector<Index> hole(Index start, Index first) const {
    std::vector<Index> loop{start};
    const Index last = across_gap(start, first);
    for (Index before = start, at = first;;) {
      if (at <= start || loop.size() == max_hole_edges || std::ranges::find(loop, at) != loop.end()) return {};
      loop.push_back(at);
      const Index next = across_gap(at, before);
      if (next < 0) return {};
      if (next == start) return at == last ? loop : std::vector<Index>();
      before = at;
      at = next;
    }
  }

  void fill(std::vector<Index> loop) {
    while (loop.size() >= 3) {
      const std::size_t m = loop.size();
      std::vector<std::size_t> ears(m);
      std::iota(ears.begin(), ears.end(), 0);
      const auto chord = [&](std::size_t k) {
        return distance(frames_[loop[(k + m - 1) % m]].origin, frames_[loop[(k + 1) % m]].origin);
      };
      std::ranges::stable_sort(ears, {}, chord);
      const auto ear = std::ranges::find_if(ears, [&](std::size_t k) {
        return add({loop[(k + m - 1) % m], loop[k], loop[(k + 1) % m]});
      });
      if (ear == ears.end() || m == 3) return;
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(*ear));
    }
  }

  std::vector<Index> triangles_outside_widest_fan(Index v) const {
    const auto& at = wedges_[v];
    std::size_t start = 0;
    while (start < at.size() && at[(start + at.size() - 1) % at.size()].left == at[start].right) ++start;
    if (start == at.size()) return {};  // a closed fan, or no triangle
    std::vector<Index> fan, widest, others;
    double width = 0, most = 0;
    for (std::size_t k = 0; k < at.size(); ++k) {
      const Wedge& w = at[(start + k) % at.size()];
      fan.push_back(w.triangle);
      width += w.extent;
      if (following(v, (start + k) % at.size()).right == w.left) continue;
      if (width > most) {
        std::swap(fan, widest);
        most = width;
      }
      others.insert(others.end(), fan.begin(), fan.end());
      fan.clear();
      width = 0;
    }
    return others;
  }

  void drop(Index triangle) {
    dropped_[triangle] = 1;
    for (const Index corner : triangles_[triangle])
      std::erase_if(wedges_[corner], [&](const Wedge& w) { return w.triangle == triangle; });
  }

  /// Whether a triangle, projected to the tangent plane of a vertex, contains the vertex. Triangles perpendicular to the plane
  /// do not.
  bool is_inside(Index v, const Triangle& t) const {
    const Vec3& n = frames_[v].normal;
    const Vec3 a = frames_[t[0]].origin - frames_[v].origin, b = frames_[t[1]].origin - frames_[v].origin,
               c = frames_[t[2]].origin - frames_[v].origin;
    const double ab = dot(n, cross(a, b)), bc = dot(n, cross(b, c)), ca = dot(n, cross(c, a));
    return (ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0);
  }

  std::span<const Frame> frames_;
  std::vector<std::vector<Wedge>> wedges_;  ///< per vertex, angles ascending
  std::vector<Triangle> triangles_;
  std::vector<char> dropped_;
};

/// Order in which triangles are added: more votes first. Triangles with three votes hardly ever overlap, so they stay in the
/// order of memory. The others are sorted by size, smaller ones first.
std::vector<Index> by_votes(std::span<const Frame> frames, const LocalTriangles& candidates) {
  struct DisputedTriangle {
    Index triangle;
    int votes;
    double longest;
  };
  std::vector<Index> order;
  std::vector<DisputedTriangle> disputed;
  for (Index t = 0; t < static_cast<Index>(candidates.triangles.size()); ++t) {
    if (candidates.votes[t] == 3) {
      order.push_back(t);
      continue;
    }
    const auto& [a, b, c] = candidates.triangles[t];
    const auto side = [&](Index i, Index j) { return distance(frames[i].origin, frames[j].origin); };
    disputed.push_back({t, candidates.votes[t], std::max({side(a, b), side(b, c), side(c, a)})});
  }
  std::ranges::sort(disputed, [](const DisputedTriangle& a, const DisputedTriangle& b) {
    return std::tuple(-a.votes, a.longest, a.triangle) < std::tuple(-b.votes, b.longest, b.triangle);
  });
  for (const DisputedTriangle& d : disputed) order.push_back(d.triangle);
  return order;
}

/// Inserts vertices that no triangle uses into the triangles that contain them.
void insert_uncovered(const LocalTriangles& candidates, Sheet& sheet) {
  std::vector<std::vector<Index>> near(static_cast<std::size_t>(sheet.vertex_count()));
  for (const Triangle& t : candidates.triangles)
    for (const Index v : t)
      if (!sheet.is_covered(v)) near[v].insert(near[v].end(), t.begin(), t.end());
  for (Index v = 0; v < sheet.vertex_count(); ++v)
    if (!near[v].empty()) sheet.insert(v, near[v]);
}

}  // namespace

std::vector<Triangle> sheet_triangles(std::span<const Frame> frames, const LocalTriangles& candidates) {
  Sheet sheet(frames);
  for (const Index t : by_votes(frames, candidates)) sheet.add(candidates.triangles[t]);
  for (int round = 0; round < fill_rounds; ++round) {
    sheet.fill_holes();
    insert_uncovered(candidates, sheet);
    sheet.drop_small_fans();
  }
  return sheet.triangles();
}

namespace {

using exact::Corner;
using exact::Half;

/// The triangles glued along their edges, oriented counter-clockwise about the normals of their first corners.
detail::GluedMesh glued(std::span<const Frame> frames, std::span<const Triangle> triangles) {
  std::vector<Offset> begin{0};
  std::vector<Index> corners;
  for (const Triangle& t : triangles) {
    const Vec3 a = frames[t[1]].origin - frames[t[0]].origin, b = frames[t[2]].origin - frames[t[0]].origin;
    const bool up = dot(cross(a, b), frames[t[0]].normal) > 0;
    corners.insert(corners.end(), {t[0], up ? t[1] : t[2], up ? t[2] : t[1]});
    begin.push_back(static_cast<Offset>(corners.size()));
  }
  return {static_cast<Index>(frames.size()), {begin, corners}, NonManifold::error};
}

/// The sides of a triangle in its own plane.
exact::FaceSides lay_out(std::span<const Index> tails, std::span<const Frame> frames, Index face) {
  const auto corner = [&](int s) { return frames[tails[3 * face + s]].origin; };
  const Vec3 a = corner(1) - corner(0), b = corner(2) - corner(0);
  const double base = norm(a), along = dot(a, b) / base, height = norm(cross(a, b)) / base;
  return {Vec2{base, 0}, Vec2{along - base, height}, Vec2{-along, -height}};
}

/// The polyhedral surface, with the vertices of the graph. The mesh contains only the vertices that it uses.
exact::PolyhedralSurface surface_of(const detail::GluedMesh& mesh, std::span<const Frame> frames) {
  exact::HalfEdges edges = mesh.half_edges();
  const auto vertices = mesh.input_of_vertex();
  std::vector<Index> tails(edges.tail.begin(), edges.tail.end());
  for (Index& tail : tails) tail = vertices[tail];
  edges.tail = tails;
  std::vector<Half> corners(frames.size(), -1);
  for (Index v = 0; v < mesh.vertex_count(); ++v) corners[vertices[v]] = mesh.corners()[v];
  return {edges, [&](Index f) { return lay_out(tails, frames, f); }, corners, 0};
}

/// Finds the angle of direction 0 in the frame of a vertex: the mean, over its edges, of the difference between their angles in
/// the frame and on the polyhedral surface.
void fit_direction(FlatTriangles& flat, std::span<const Frame> frames, Index v) {
  const Corner start = flat.surface.first_corner(v);
  if (start.half < 0) return;
  const Frame& frame = frames[v];
  const exact::HalfRecord first = flat.surface.record(start.half);
  const auto to = [&](Index w) { return frames[w].origin - frame.origin; };
  const bool is_up = dot(cross(to(first.head), to(first.apex)), frame.normal) > 0;
  flat.mirrored[v] = is_up != start.forward;
  const double scale = flat.surface.angle_scale(v), side = flat.mirrored[v] ? -1 : 1;
  Vec2 sum{};
  double turned = 0;
  const auto add = [&](Index w) {
    const double angle = std::atan2(dot(frame.y, to(w)), dot(frame.x, to(w))) - side * scale * turned;
    sum = sum + Vec2{std::cos(angle), std::sin(angle)};
  };
  for (Corner c = start;;) {
    const exact::HalfRecord r = flat.surface.record(c.half);
    add(c.forward ? r.head : r.apex);
    turned += flat.surface.angle(c.half);
    const Corner left = flat.surface.turn_left(c);
    if (left.half < 0) add(c.forward ? r.apex : r.head);
    if (left.half < 0 || left == start) break;
    c = left;
  }
  flat.angles[v] = std::atan2(sum[1], sum[0]);
}

}  // namespace

FlatTriangles flat_sheet(std::span<const Frame> frames, std::span<const Triangle> triangles, double length_unit) {
  FlatTriangles flat{surface_of(glued(frames, triangles), frames), {}, length_unit, true};
  flat.positions.reserve(frames.size());
  for (const Frame& frame : frames) flat.positions.push_back(length_unit * frame.origin);
  flat.angles.assign(frames.size(), 0);
  flat.mirrored.assign(frames.size(), 0);
  detail::for_each_index(frames.size(), 0, [&](std::size_t v) { fit_direction(flat, frames, static_cast<Index>(v)); });
  return flat;
}

}  // namespace ahm::pointcloud
