#include "vertex_frames.hpp"

#include <algorithm>
#include <numbers>

#include "ahm/util/component_lengths.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/unset_vector.hpp"

namespace ahm::trimesh {
namespace {

using std::numbers::pi;

/// The corner of the input mesh whose right side is the reference direction of a vertex.
Corner reference_corner(const TriangleMesh& mesh, const HalfEdges& edges, Index vertex) {
  return edges.rightmost({mesh.corners()[vertex], true});
}

/// The reference direction in the intrinsic triangulation: its corner, and its angle from the right side of that corner.
struct Reference {
  Corner corner;
  double angle = 0;
};

Reference find_reference(const TriangleMesh& mesh, const HalfEdges& input, const IntrinsicTriangulation& triangulation,
                         Index v) {
  const Corner corner = reference_corner(mesh, input, v);
  const Vec2 side = mesh.layout(corner.half / 3)[input.right(corner) % 3];
  const Vec2 out = corner.forward ? side : -side;
  const auto found = triangulation.history().locate(corner.half, out);
  const Corner at{found.corner, corner.forward != found.mirrored};
  const Vec2 right = at.forward ? triangulation.side(at.half) : -triangulation.side(input.right(at));
  const double turned = angle_between(right, found.direction);
  return {at, std::clamp(at.forward ? turned : -turned, 0.0, triangulation.angle(at.half))};
}

/// Assumed error of positions, in rounding errors of a coordinate: three coordinates after a few sums.
constexpr double roundings = 8;
/// Smaller total uncertainties are ignored. They cannot be distinguished from curvature, and cause errors of the same size.
constexpr double min_uncertainty = 1e-10;

/// Angles of the faces of the intrinsic triangulation, per corner.
using CornerAngles = detail::UnsetVector<double>;

/// The corners of the intrinsic triangulation around one vertex, and their angles in its tangent space.
class Fan {
 public:
  /// @param angles  output: the angles at these corners
  Fan(const HalfEdges& edges, const IntrinsicTriangulation& triangulation, Corner start, CornerAngles& angles)
      : edges_(edges), triangulation_(triangulation), start_(edges.rightmost(start)), angles_(angles) {
    closed_ = for_each([&](Corner c) { angles_[c.half] = triangulation_.angle(c.half); });
  }

  /// Calls visit(corner) counter-clockwise.
  /// @return whether the fan is closed
  template <class Visit>
  bool for_each(const Visit& visit) const {
    for (Corner c = start_;;) {
      visit(c);
      c = edges_.turn_left(c);
      if (c.half < 0 || c == start_) return c.half >= 0;
    }
  }

  Corner start() const { return start_; }

  /// The factor of all angles. Appends uncertain corners, which have their own factors instead, to `corrections`.
  double find_scale(double rounding, std::vector<std::pair<Half, double>>& corrections) const {
    if (!closed_) return 1.0;
    double sum = 0, uncertainty = 0;
    for_each([&](Corner c) {
      sum += angles_[c.half];
      uncertainty += uncertain(c, rounding);
    });
    const double lack = 2 * pi - sum;
    if (!(uncertainty > min_uncertainty) || !(std::abs(lack) <= uncertainty)) return 2 * pi / sum;
    for_each([&](Corner c) {
      if (const double share = uncertain(c, rounding) / uncertainty * lack; share != 0)
        corrections.emplace_back(c.half, 1 + share / angles_[c.half]);
    });
    return 1.0;
  }

 private:
  double uncertain(Corner c, double rounding) const {
    if (!(angles_[c.half] > 0)) return 0;
    return roundings * rounding * (1 / triangulation_.length(c.half) + 1 / triangulation_.length(previous(c.half)));
  }

  const HalfEdges& edges_;
  const IntrinsicTriangulation& triangulation_;
  Corner start_;
  CornerAngles& angles_;
  bool closed_ = false;
};

/// Sets the angles of the edges at one vertex.
void set_angles(const HalfEdges& edges, const CornerAngles& angles, const Reference& reference, Index v,
                VertexFrames& frames) {
  const Corner start = frames.start[v];
  auto store = [&](Half side, bool from_tail, double angle, bool forward) {
    const std::size_t edge = edges.directed(side, from_tail);
    frames.angle[edge] = angle;
    if (!frames.sense.empty()) frames.sense[edge] = forward != (edges.is_mirrored(side) && edges.twin[side] < side);
  };
  const bool closed = edges.turn_right(start).half >= 0;
  double angle = closed ? -reference.angle * frames.corner_scale(start.half, v) : 0.0;
  for (Corner c = start;;) {
    store(edges.right(c), c.forward, angle, c.forward);
    angle += frames.corner_scale(c.half, v) * angles[c.half];
    const Corner left = edges.turn_left(c);
    if (left.half < 0) store(edges.left(c), !c.forward, angle, c.forward);
    if (left.half < 0 || left == start) return;
    c = left;
  }
}

/// Normals of faces in space are reliable if rounding of their corners rotates them by at most this angle.
constexpr double certain_normal = 1e-6;

/// The unit vector of an axis projected perpendicular to a unit vector.
Vec3 axis_across(const Vec3& n) {
  const Vec3 axis = std::abs(n[0]) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 across = axis - dot(axis, n) * n;
  return 1 / norm(across) * across;
}

/// The faces around a vertex of the input mesh in space, counter-clockwise. Face k lies between side k and the next one.
struct SpatialFan {
  struct Face {
    Vec3 normal;   ///< cross product of its sides
    double area;   ///< length of `normal`, twice the area of the face
    double angle;  ///< angle of the face at the vertex
  };

  std::vector<Vec3> sides;  ///< from the vertex
  std::vector<Face> faces;
  bool is_closed = false;

  void collect(const TriangleMesh& mesh, const HalfEdges& edges, Index v) {
    sides.clear();
    faces.clear();
    const Vec3& center = mesh.position(Vertex(v));
    const auto side = [&](Corner c, bool is_right) {
      const Index end = is_right == c.forward ? edges.head(c.half) : edges.tail[previous(c.half)];
      return mesh.position(Vertex(end)) - center;
    };
    const Corner start = reference_corner(mesh, edges, v);
    Corner last;
    for (Corner c = start; c.half >= 0 && (sides.empty() || c != start); c = edges.turn_left(c)) {
      sides.push_back(side(c, true));
      last = c;
    }
    is_closed = edges.turn_left(last).half >= 0;
    if (!is_closed) sides.push_back(side(last, false));
    for (std::size_t k = 0; k < sides.size() - (is_closed ? 0 : 1); ++k) {
      const Vec3 normal = cross(sides[k], next(k));
      const double area = norm(normal);
      faces.push_back({normal, area, std::atan2(area, dot(sides[k], next(k)))});
    }
  }

  /// The side after side k.
  const Vec3& next(std::size_t k) const { return sides[k + 1 < sides.size() ? k + 1 : 0]; }
};

/// The mean of the face normals, weighted by angle, over the faces with reliable normals. If there are none, over all faces.
/// Zero if the normals cancel.
Vec3 mean_normal(const SpatialFan& fan, double rounding) {
  Vec3 sum{0, 0, 0}, of_all{0, 0, 0};
  for (std::size_t k = 0; k < fan.faces.size(); ++k) {
    const SpatialFan::Face& face = fan.faces[k];
    if (!(face.area > 0)) continue;
    const Vec3 &a = fan.sides[k], &b = fan.next(k), across = b - a;
    const double longest = std::sqrt(std::max({dot(a, a), dot(b, b), dot(across, across)}));
    const Vec3 weighted = face.angle / face.area * face.normal;
    of_all = of_all + weighted;
    if (rounding * longest <= certain_normal * face.area) sum = sum + weighted;
  }
  return norm(sum) > 1e-12 ? sum : of_all;
}

/// The normal is the mean of the face normals. The x axis brings the projected edges as close as possible to their angles in
/// the tangent space.
/// @param fan  faces around the vertex
Frame frame_in_space(const TriangleMesh& mesh, const SpatialFan& fan, Index v) {
  const Vec3 sum = mean_normal(fan, mesh.rounding(Vertex(v)));
  Vec3 reference{0, 0, 0};
  double angle_sum = 0;
  for (std::size_t k = 0; k < fan.faces.size(); ++k) {
    if (angle_sum == 0) reference = fan.sides[k];
    angle_sum += fan.faces[k].angle;
  }
  // If the normals cancel, or the reference edge is perpendicular to the plane, any axes will do.
  const double length = norm(sum), reach = norm(reference);
  const Vec3 normal = length > 1e-12 ? 1 / length * sum
                      : reach > 0    ? axis_across(1 / reach * reference)
                                     : Vec3{0, 0, 1};
  Vec3 x = reference - dot(reference, normal) * normal;
  x = norm(x) > 1e-12 * reach ? 1 / norm(x) * x : axis_across(normal);
  const Vec3 y = cross(normal, x);

  const double scale = fan.is_closed && angle_sum > 0 ? 2 * pi / angle_sum : 1.0;
  double angle = 0, before = fan.is_closed ? fan.faces.back().angle : 0;
  Vec2 fit{};
  for (std::size_t k = 0; k < fan.sides.size(); ++k) {
    const double after = k < fan.faces.size() ? fan.faces[k].angle : 0;
    const Vec2 p{dot(fan.sides[k], x), dot(fan.sides[k], y)};
    if (const double size = norm(p); size > 0) fit = fit + (before + after) / size * product(p, unit(-scale * angle));
    angle += after;
    before = after;
  }
  fit = norm(fit) > 1e-12 ? normalized(fit) : Vec2{1, 0};
  const Vec3 fitted = fit[0] * x + fit[1] * y;
  return {mesh.original_position(Vertex(v)), fitted, cross(normal, fitted), normal};
}

}  // namespace

bool VertexFrames::forward(const HalfEdges& edges, Half side, bool from_tail) const {
  if (sense.empty()) return true;
  return (sense[edges.directed(side, from_tail)] != 0) != (edges.is_mirrored(side) && edges.twin[side] < side);
}

double VertexFrames::corner_scale(Half corner, Index vertex) const {
  const auto at = std::lower_bound(corrections.begin(), corrections.end(), std::pair{corner, -HUGE_VAL});
  return at != corrections.end() && at->first == corner ? at->second : scale[vertex];
}

VertexFrames find_frames(const TriangleMesh& mesh, const IntrinsicTriangulation& triangulation, unsigned threads) {
  const HalfEdges input = mesh.topology().half_edges(), edges = triangulation.half_edges();
  const auto n = static_cast<std::size_t>(mesh.vertex_count());
  const auto directed = static_cast<std::size_t>(edges.size()) + mesh.report().boundary_edges;
  VertexFrames frames;
  frames.start.resize(n);
  frames.scale.resize(n);
  frames.angle.assign(directed, 0.0);
  if (!edges.mirrored.empty()) frames.sense.assign(directed, 0);
  std::vector<Reference> references(n);
  CornerAngles angles(static_cast<std::size_t>(edges.size()));
  detail::Mutex corrections_mutex;
  detail::for_each_index(n, threads, [&](std::size_t v) {
    references[v] = find_reference(mesh, input, triangulation, static_cast<Index>(v));
    const Fan fan(edges, triangulation, references[v].corner, angles);
    std::vector<std::pair<Half, double>> corrections;
    frames.start[v] = fan.start();
    frames.scale[v] = fan.find_scale(mesh.rounding(Vertex(static_cast<Index>(v))), corrections);
    if (corrections.empty()) return;
    const detail::Lock lock(corrections_mutex);
    frames.corrections.insert(frames.corrections.end(), corrections.begin(), corrections.end());
  });
  std::sort(frames.corrections.begin(), frames.corrections.end());
  detail::for_each_index(
      n, threads, [&](std::size_t v) { set_angles(edges, angles, references[v], static_cast<Index>(v), frames); });
  return frames;
}

std::vector<Frame> frames_in_space(const TriangleMesh& mesh, unsigned threads) {
  std::vector<Frame> frames;
  if (!mesh.has_positions()) return frames;
  frames.resize(mesh.vertex_count());
  const HalfEdges edges = mesh.topology().half_edges();
  detail::parallel_chunks(static_cast<Offset>(frames.size()), 1 << 12, threads, [&](Offset begin, Offset end) {
    SpatialFan fan;
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      fan.collect(mesh, edges, v);
      frames[v] = frame_in_space(mesh, fan, v);
    }
  });
  return frames;
}

namespace {

/// Weights up to this are rounding errors (diagonals of cocircular quadrilaterals) and are set to 0.
constexpr double min_weight = 1e-13;

/// With larger weights the heat at both ends is equal to 1e-4 in any case, and the solver loses the digits that the sum of a
/// row needs.
constexpr double largest_weight = 1e4;

/// Least weight of a sliver on the boundary; keeps vertices connected that have no other faces.
constexpr double min_conductance = 1e-3;

class Rows {
 public:
  Rows(const IntrinsicTriangulation& triangulation, const VertexFrames& frames, bool clamp, unsigned threads)
      : triangulation_(triangulation),
        edges_(triangulation.half_edges()),
        frames_(frames),
        clamp_(clamp),
        half_cotangents_(static_cast<std::size_t>(edges_.size())),
        units_(frames.angle.size()) {
    detail::for_each_index(half_cotangents_.size(), threads, [&](std::size_t h) {
      half_cotangents_[h] = 0.5 * triangulation_.cotangent(static_cast<Half>(h));
    });
    detail::for_each_index(units_.size(), threads, [&](std::size_t e) { units_[e] = unit(frames_.angle[e]); });
    if (clamp) find_slivers();
  }

  /// (cot alpha + cot beta) / 2; on the boundary there is only one angle.
  double cotangents(Half side) const {
    const Half t = edges_.twin[side];
    return t >= 0 ? half_cotangents_[side] + half_cotangents_[t] : half_cotangents_[side];
  }

  /// Contribution of a face to the weight of its side: half the cotangent of the opposite angle, except in slivers.
  double from_face(Half side) const {
    const Half base = base_.empty() ? -1 : base_[static_cast<std::size_t>(side / 3)];
    if (base < 0) return half_cotangents_[side];
    if (side == base) return 0;
    const Half third = detail::next(side) == base ? detail::previous(side) : detail::next(side);
    return std::max(0.25 / half_cotangents_[third], min_conductance);
  }

  /// The weight w_ij; 0 within rounding, so that squares and rectangles have no diagonals in the operators.
  double weight(Half side) const {
    const Half t = edges_.twin[side];
    double w = from_face(side) + (t >= 0 ? from_face(t) : 0);
    if (clamp_) w = std::clamp(w, 0.0, largest_weight);
    return std::abs(w) > min_weight ? w : 0;
  }

  /// Whether a side is an edge of the graph. An edge from a vertex to itself is left out. On a flat surface it contributes
  /// nothing: its two logarithms are opposite, and its holonomy is the identity. Elsewhere it would only damp vectors at a
  /// vertex too coarse to resolve them.
  bool is_edge(Half side) const { return edges_.tail[side] != edges_.head(side); }

  /// Calls visit(side, from_tail, forward) for every edge of the graph that leaves the vertex, counter-clockwise.
  template <class Visit>
  void for_each(std::size_t vertex, const Visit& visit) const {
    const Corner start = frames_.start[vertex];
    for (Corner c = start;;) {
      if (is_edge(edges_.right(c))) visit(edges_.right(c), c.forward, c.forward);
      const Corner left = edges_.turn_left(c);
      if (left.half < 0 && is_edge(edges_.left(c))) visit(edges_.left(c), !c.forward, c.forward);
      if (left.half < 0 || left == start) return;
      c = left;
    }
  }

  void fill(std::size_t i, CsrGraphData& g) const {
    auto at = static_cast<std::size_t>(g.row_begin[i]);
    for_each(i, [&](Half side, bool from_tail, bool forward) {
      g.neighbors[at] = from_tail ? edges_.head(side) : edges_.tail[side];
      g.weights[at] = weight(side);
      const Vec2 u_ij = units_[edges_.directed(side, from_tail)], u_ji = units_[edges_.directed(side, !from_tail)];
      const double length = triangulation_.length(side);
      g.logs[2 * at] = length * u_ij[0];
      g.logs[2 * at + 1] = length * u_ij[1];
      // Transport takes the direction of the edge to itself, u_ji -> -u_ij. Between frames of opposite orientation it is a
      // reflection.
      const bool reflects = forward != frames_.forward(edges_, side, !from_tail);
      const Vec2 R = reflects ? -product(u_ij, u_ji) : -product(u_ij, conj(u_ji));
      if (g.kind == TransportKind::rotation2) {
        g.transports[2 * at] = R[0];
        g.transports[2 * at + 1] = R[1];
      } else {
        const double block[] = {R[0], reflects ? R[1] : -R[1], R[1], reflects ? -R[0] : R[0]};
        std::copy_n(block, 4, g.transports.begin() + static_cast<std::ptrdiff_t>(4 * at));
      }
      ++at;
    });
  }

  /// Computes the mean edge length, and counts edges left out and weights changed.
  void summarize(CsrGraphData& g, MeshDetails& report) const {
    double sum = 0;
    detail::ComponentLengths lengths(g.masses.size());
    for (Half h = 0; h < edges_.size(); ++h) {
      const Half t = edges_.twin[h];
      if (triangulation_.is_dropped(h / 3) || (t >= 0 && t < h)) continue;
      ++report.edges;
      sum += triangulation_.length(h);
      lengths.add(edges_.tail[h], edges_.head(h), triangulation_.length(h));
      report.closed_edges += edges_.tail[h] == edges_.head(h);
      report.clamped_weights += clamp_ && cotangents(h) < -min_weight;
      report.capped_weights += clamp_ && weight(h) >= largest_weight;
    }
    g.mean_edge_length = sum / static_cast<double>(report.edges);
    g.component_edge_lengths = lengths.means();
  }

 private:
  /// Finds the slivers on the boundary that no flip removes: the weight of their outer side is negative. Setting only this
  /// weight to 0 would leave the weights of the other two sides, which it balances. Heat would then run along the boundary as
  /// if it had no length. A sliver therefore conducts only along its outer side, like a strip: the weight of each other side is
  /// half the height of the sliver over the length of that side's part of the outer side. Without its contributions to other
  /// sides, its neighbors may be slivers, too.
  void find_slivers() {
    base_.assign(static_cast<std::size_t>(edges_.size() / 3), -1);
    std::vector<Half> outer;
    for (Half h = 0; h < edges_.size(); ++h)
      if (edges_.twin[h] < 0 && !triangulation_.is_dropped(h / 3)) outer.push_back(h);
    while (!outer.empty()) {
      const Half h = outer.back(), beyond = edges_.twin[h];
      outer.pop_back();
      if (base_[h / 3] >= 0 || !((beyond >= 0 ? from_face(beyond) : 0) + half_cotangents_[h] < 0)) continue;
      base_[h / 3] = h;
      for (const Half side : {detail::next(h), detail::previous(h)})
        if (edges_.twin[side] >= 0) outer.push_back(edges_.twin[side]);
    }
  }

  const IntrinsicTriangulation& triangulation_;
  HalfEdges edges_;
  const VertexFrames& frames_;
  bool clamp_;
  detail::UnsetVector<double> half_cotangents_;  ///< half the cotangents of the angles opposite the sides
  detail::UnsetVector<Vec2> units_;  ///< unit vectors of directed edges in the frames of their start vertices
  std::vector<Half> base_;           ///< per face: outer side of a sliver; -1: not a sliver
};

/// Vertices need a mass even if their faces have no area. A mass below 1e-14 of the square of the longest edge at the vertex
/// becomes 1 % of that square.
void raise_masses(const IntrinsicTriangulation& triangulation, std::vector<double>& masses) {
  const HalfEdges edges = triangulation.half_edges();
  std::vector<double> longest(masses.size(), 0.0);
  for (Half h = 0; h < edges.size(); ++h) {
    if (triangulation.is_dropped(h / 3)) continue;
    const double length = triangulation.length(h);
    for (Index v : {edges.tail[h], edges.head(h)}) longest[v] = std::max(longest[v], length * length);
  }
  const double of_all = std::ranges::max(longest);
  for (std::size_t v = 0; v < masses.size(); ++v)
    if (const double square = longest[v] > 0 ? longest[v] : of_all; !(masses[v] > 1e-14 * square))
      masses[v] = 0.01 * square;
}

}  // namespace

CsrGraphData mesh_edges(const TriangleMesh& mesh, const IntrinsicTriangulation& triangulation,
                        const VertexFrames& frames, bool clamp, unsigned threads, MeshDetails& report) {
  const auto n = static_cast<std::size_t>(mesh.vertex_count());
  const HalfEdges edges = triangulation.half_edges();
  const Rows rows(triangulation, frames, clamp, threads);
  CsrGraphData g;
  g.kind = mesh.report().orientable ? TransportKind::rotation2 : TransportKind::block;
  g.length_unit = mesh.length_unit();
  g.masses.assign(n, 0.0);
  for (Half h = 0; h < edges.size(); h += 3) {
    const double third = std::max(0.0, triangulation.area(h / 3)) / 3.0;
    for (Half s = h; s < h + 3; ++s) g.masses[edges.tail[s]] += third;
  }
  raise_masses(triangulation, g.masses);
  g.row_begin.assign(n + 1, 0);
  detail::for_each_index(n, threads, [&](std::size_t i) {
    Offset degree = 0;
    rows.for_each(i, [&](Half, bool, bool) { ++degree; });
    g.row_begin[i + 1] = degree;
  });
  for (std::size_t i = 0; i < n; ++i) g.row_begin[i + 1] += g.row_begin[i];
  const auto count = static_cast<std::size_t>(g.row_begin[n]);
  g.neighbors.resize(count);
  g.weights.resize(count);
  g.logs.resize(2 * count);
  g.transports.resize((g.kind == TransportKind::block ? 4 : 2) * count);
  detail::for_each_index(n, threads, [&](std::size_t i) { rows.fill(i, g); });
  rows.summarize(g, report);
  return g;
}

}  // namespace ahm::trimesh
