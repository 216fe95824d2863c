// Gluing of faces, numbering of vertices, and contraction of edges without length.
#include "ahm/surface/detail/gluing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/disjoint_sets.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::detail {
namespace {

std::string name(Index f, std::span<const Index> face) {
  std::string text = "face " + std::to_string(f) + " (";
  for (std::size_t s = 0; s < face.size() && s < 10; ++s)
    text.append(s > 0 ? ", " : "").append(std::to_string(face[s]));
  return text.append(face.size() > 10 ? ", ...)" : ")");
}

bool repeats_a_vertex(std::span<const Index> face, std::vector<Index>& sorted) {
  if (face.size() == 3) return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
  sorted.assign(face.begin(), face.end());
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

/// Throws if there are faces with a fault. @param what  the fault, as the predicate of "3 faces"
void refuse(std::string_view fault, const std::vector<Index>& wrong, const FaceList& faces, std::string_view verb,
            const std::string& what, const std::string& advice) {
  if (wrong.empty()) return;
  ItemList list;
  for (Index f : wrong) list.add(name(f, faces[f]));
  throw InvalidGeometry(fault, detail::counted(wrong.size(), "face", verb) + " " + what + ": " + list.text(), advice);
}

/// A side of a face, in the bucket of the smaller of its two vertices.
struct Side {
  Index high;
  Half half;
};

class Gluer {
 public:
  Gluer(Index vertices, const FaceList& faces) : faces_(faces), begin_(static_cast<std::size_t>(vertices) + 1, 0) {
    result_.partner.assign(faces.vertices.size(), -1);
    face_of_.resize(faces.vertices.size());
    for (Index f = 0; f < static_cast<Index>(faces.size()); ++f)
      std::fill(face_of_.begin() + faces.begin[f], face_of_.begin() + faces.begin[f + 1], f);
  }

  /// Finds the sides on each edge.
  void pair_sides() {
    fill_buckets();
    for (std::size_t v = 0; v + 1 < begin_.size(); ++v) {
      const auto first = sides_.begin() + begin_[v], last = sides_.begin() + begin_[v + 1];
      std::sort(first, last,
                [](const Side& a, const Side& b) { return a.high != b.high ? a.high < b.high : a.half < b.half; });
      for (auto group = first; group != last;) {
        auto end = group;
        while (end != last && end->high == group->high) ++end;
        join(static_cast<Index>(v), {group, end});
        group = end;
      }
    }
    sides_ = {};
    std::sort(duplicates_.begin(), duplicates_.end());  // each pair was found at every one of its edges
    duplicates_.erase(std::unique(duplicates_.begin(), duplicates_.end()), duplicates_.end());
    result_.non_manifold_edges = static_cast<Index>(nonmanifold_edges_.count());
  }

  void refuse_duplicates() const {
    if (duplicates_.empty()) return;
    ItemList list;
    for (const auto& [later, earlier] : duplicates_)
      list.add("face " + std::to_string(later) + " repeats face " + std::to_string(earlier));
    throw InvalidGeometry("duplicate_faces",
                          detail::counted(list.count(), "face", "have") + " a duplicate: " + list.text(),
                          "remove such faces");
  }

  void refuse_nonmanifold_edges() const {
    if (nonmanifold_edges_.count() > 0)
      throw InvalidGeometry("non_manifold_edges",
                            detail::counted(nonmanifold_edges_.count(), "edge", "have") +
                                " more than two faces: " + nonmanifold_edges_.text(),
                            "repair the mesh, or cut it there with NonManifold::split");
  }

  /// Reverses faces until neighbors agree, one component at a time.
  void orient(std::span<const std::uint8_t> counts_as_reversed) {
    const auto count = faces_.size();
    result_.reversed.assign(count, 2);
    std::vector<Index> component;
    for (std::size_t seed = 0; seed < count; ++seed) {
      if (result_.reversed[seed] != 2) continue;
      result_.reversed[seed] = 0;
      component.assign(1, static_cast<Index>(seed));
      std::size_t turned = 0;
      for (std::size_t at = 0; at < component.size(); ++at) {
        const Index f = component[at];
        turned += result_.reversed[f] != (counts_as_reversed.empty() ? 0 : counts_as_reversed[f]);
        for (Offset h = faces_.begin[f]; h < faces_.begin[f + 1]; ++h) visit_across(static_cast<Half>(h), component);
      }
      const bool turn_all = 2 * turned > component.size();
      for (Index f : component) {
        result_.reversed[f] ^= static_cast<std::uint8_t>(turn_all);
        result_.reoriented += result_.reversed[f];
      }
    }
  }

  Gluing take() { return std::move(result_); }
  const std::vector<std::pair<Index, Index>>& duplicates() const { return duplicates_; }

 private:
  Half next(Half h) const {
    const Index f = face_of_[h];
    return h + 1 == faces_.begin[f + 1] ? static_cast<Half>(faces_.begin[f]) : h + 1;
  }
  Half previous(Half h) const {
    const Index f = face_of_[h];
    return static_cast<Half>(h == faces_.begin[f] ? faces_.begin[f + 1] - 1 : h - 1);
  }
  Index tail(Half h) const { return faces_.vertices[h]; }
  Index head(Half h) const { return faces_.vertices[next(h)]; }
  /// The vertex that follows the side, traversed from its smaller vertex to the larger one.
  Index beyond(Half h) const { return tail(h) < head(h) ? head(next(h)) : tail(previous(h)); }

  void fill_buckets() {
    const auto halves = static_cast<Half>(result_.partner.size());
    for (Half h = 0; h < halves; ++h) ++begin_[static_cast<std::size_t>(std::min(tail(h), head(h))) + 1];
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    std::vector<Offset> fill(begin_.begin(), begin_.end() - 1);
    sides_.resize(result_.partner.size());
    for (Half h = 0; h < halves; ++h) sides_[fill[std::min(tail(h), head(h))]++] = {std::max(tail(h), head(h)), h};
  }

  /// Whether the faces of two sides of one edge are the same cycle of vertices, in either direction.
  bool same_face(Half a, Half b) const {
    if (beyond(a) != beyond(b) || faces_[face_of_[a]].size() != faces_[face_of_[b]].size()) return false;
    const bool alike = tail(a) == tail(b);
    Half p = a, q = alike ? b : next(b);
    for (std::size_t s = 0; s < faces_[face_of_[a]].size(); ++s) {
      if (tail(p) != tail(q)) return false;
      p = next(p);
      q = alike ? next(q) : previous(q);
    }
    return true;
  }

  void join(Index low, std::span<Side> group) {
    if (group.size() < 2) return;
    if (group.size() == 2 && !same_face(group[0].half, group[1].half)) {
      result_.partner[group[0].half] = group[1].half;
      result_.partner[group[1].half] = group[0].half;
      return;
    }
    std::stable_sort(group.begin(), group.end(),
                     [&](const Side& a, const Side& b) { return beyond(a.half) < beyond(b.half); });
    for (std::size_t s = 1; s < group.size(); ++s)
      if (same_face(group[s - 1].half, group[s].half))
        duplicates_.push_back({face_of_[group[s].half], face_of_[group[s - 1].half]});
    if (group.size() > 2)
      nonmanifold_edges_.add("(" + std::to_string(low) + ", " + std::to_string(group[0].high) + ") with " +
                             detail::counted(group.size(), "face"));
  }

  void visit_across(Half h, std::vector<Index>& component) {
    const Half t = result_.partner[h];
    if (t < 0) return;
    const auto wanted = static_cast<std::uint8_t>(result_.reversed[face_of_[h]] ^ (tail(h) == tail(t)));
    std::uint8_t& other = result_.reversed[face_of_[t]];
    if (other == 2) {
      other = wanted;
      component.push_back(face_of_[t]);
    } else if (other != wanted) {
      result_.orientable = false;
    }
  }

  const FaceList& faces_;
  std::vector<Index> face_of_;
  std::vector<Offset> begin_;
  std::vector<Side> sides_;
  std::vector<std::pair<Index, Index>> duplicates_;
  ItemList nonmanifold_edges_;
  Gluing result_;
};

/// Scales by the power of two that brings the largest coordinate into [1, 2); returns its exponent.
int normalize_scale(std::vector<Vec3>& points) {
  double most = 0;
  for (const Vec3& p : points) most = std::max(most, largest(p));
  const int exponent = most > 0 ? std::ilogb(most) : 0;
  for (Vec3& p : points)
    for (double& x : p) x = std::scalbn(x, -exponent);
  return exponent;
}

/// Moves the middle of the bounding box of each part to the origin.
void center(std::vector<Vec3>& points, std::span<const Index> part) {
  std::vector<Vec3> low(points), high(points);
  for (std::size_t v = 0; v < points.size(); ++v)
    for (int axis = 0; axis < 3; ++axis) {
      low[part[v]][axis] = std::min(low[part[v]][axis], points[v][axis]);
      high[part[v]][axis] = std::max(high[part[v]][axis], points[v][axis]);
    }
  for (std::size_t v = 0; v < points.size(); ++v)
    for (int axis = 0; axis < 3; ++axis) points[v][axis] -= 0.5 * (low[part[v]][axis] + high[part[v]][axis]);
}

}  // namespace

FaceFaults find_faults(Index vertices, const FaceList& faces) {
  if (vertices < 1) throw InvalidGeometry("the mesh has no vertices");
  if (faces.begin.size() < 2) throw InvalidGeometry("the mesh has no faces");
  if (faces.begin.front() != 0 || faces.begin.back() != static_cast<Offset>(faces.vertices.size()) ||
      !std::is_sorted(faces.begin.begin(), faces.begin.end()))
    throw InvalidGeometry("'face_begin' must rise from 0 to the number of corners, " +
                          std::to_string(faces.vertices.size()));
  if (faces.vertices.size() > static_cast<std::size_t>(std::numeric_limits<Half>::max() - 1))
    throw InvalidGeometry("the mesh has " + detail::counted(faces.vertices.size(), "corner") +
                          "; at most 2^31 - 2 are supported");
  FaceFaults faults;
  std::vector<Index> sorted;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto face = faces[f];
    const auto number = static_cast<Index>(f);
    if (std::any_of(face.begin(), face.end(), [&](Index v) { return v < 0 || v >= vertices; }))
      faults.outside.push_back(number);
    else if (face.size() < 3)
      faults.small.push_back(number);
    else if (repeats_a_vertex(face, sorted))
      faults.repeating.push_back(number);
  }
  return faults;
}

std::vector<std::pair<Index, Index>> find_duplicates(Index vertices, const FaceList& faces) {
  Gluer gluer(vertices, faces);
  gluer.pair_sides();
  return gluer.duplicates();
}

Gluing glue(Index vertices, const FaceList& faces, NonManifold non_manifold,
            std::span<const std::uint8_t> counts_as_reversed) {
  if (!counts_as_reversed.empty() && counts_as_reversed.size() != faces.size())
    throw InvalidArgument("'counts_as_reversed' has " + detail::counted(counts_as_reversed.size(), "entry") + " for " +
                          detail::counted(faces.size(), "face"));
  const FaceFaults faults = find_faults(vertices, faces);
  refuse("vertices_outside", faults.outside, faces, "have", "a vertex outside [0, " + std::to_string(vertices) + ")",
         "number vertices from 0");
  refuse("small_faces", faults.small, faces, "have", "fewer than 3 corners", "remove such faces");
  refuse("repeated_vertices", faults.repeating, faces, "use", "a vertex twice", "remove such faces");
  Gluer gluer(vertices, faces);
  gluer.pair_sides();
  gluer.refuse_duplicates();
  if (non_manifold == NonManifold::error) gluer.refuse_nonmanifold_edges();
  gluer.orient(counts_as_reversed);
  return gluer.take();
}

void check_positions(std::span<const Vec3> points, std::span<const Index> corners) {
  if (points.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max() / 2))
    throw InvalidGeometry("the mesh has " + detail::counted(points.size(), "vertex") + "; at most 2^30 are supported");
  const auto count = static_cast<Index>(points.size());
  Index worst = count;  // the lowest of these vertices
  for (const Index v : corners)
    if (v >= 0 && v < worst && !is_finite(points[v])) worst = v;
  if (worst == count) return;
  const Vec3& point = points[worst];
  throw InvalidGeometry("not_finite",
                        "vertex " + std::to_string(worst) + " is (" + number(point[0]) + ", " + number(point[1]) +
                            ", " + number(point[2]) + ")",
                        "coordinates must be finite");
}

NormalizedPositions normalize_positions(std::vector<Vec3> points, std::span<const Index> part) {
  const int exponent = normalize_scale(points);
  std::vector<double> most(points.size(), 0.0);
  for (std::size_t v = 0; v < points.size(); ++v) most[part[v]] = std::max(most[part[v]], largest(points[v]));
  center(points, part);
  const int exponent_about_middles = normalize_scale(points);
  std::vector<double> rounding(points.size());
  for (std::size_t v = 0; v < points.size(); ++v)
    rounding[v] = std::scalbn(std::numeric_limits<double>::epsilon() * most[part[v]], -exponent_about_middles);
  return {std::move(points), std::move(rounding), std::scalbn(1.0, exponent + exponent_about_middles)};
}

namespace {

/// Fans of faces around the input vertices.
struct Fans {
  std::vector<Index> of_half;  ///< fan of each half-edge, around its tail
  std::vector<Half> corner;    ///< lowest half-edge of each fan
  std::vector<Index> first;    ///< first fan of each input vertex; -1: none
  std::vector<Index> later;    ///< all other fans
  ItemList pinched;            ///< vertices with several fans, each once
};

Fans find_fans(const HalfEdges& edges, Index vertices, std::span<const std::uint8_t> dropped) {
  Fans fans;
  fans.of_half.assign(edges.tail.size(), -1);
  fans.first.assign(vertices, -1);
  std::vector<bool> listed(vertices);
  for (Half h = 0; h < edges.size(); ++h) {
    if (fans.of_half[h] >= 0 || (!dropped.empty() && dropped[h / 3])) continue;
    const auto number = static_cast<Index>(fans.corner.size());
    fans.corner.push_back(h);
    if (Index& first = fans.first[edges.tail[h]]; first < 0) {
      first = number;
    } else {
      if (!listed[edges.tail[h]]) fans.pinched.add(std::to_string(edges.tail[h]));
      listed[edges.tail[h]] = true;
      fans.later.push_back(number);
    }
    for (Corner c = edges.rightmost({h, true}); c.half >= 0 && fans.of_half[c.half] < 0; c = edges.turn_left(c))
      fans.of_half[c.half] = number;
  }
  return fans;
}

bool are_triangles(const FaceList& faces) {
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (faces[f].size() != 3) return false;
  return true;
}

}  // namespace

GluedMesh::GluedMesh(Index vertices, const FaceList& faces, NonManifold non_manifold,
                     std::span<const std::uint8_t> counts_as_reversed) {
  report_.vertices = vertices;
  report_.faces = static_cast<Index>(faces.size());
  build_half_edges(faces, non_manifold, counts_as_reversed);
  number_vertices(non_manifold);
  find_parts();
}

/// Builds the half-edges of the oriented faces; tails are still input vertices. Reversing a face of m corners, whose first
/// corner stays first, moves side s to side m - 1 - s.
void GluedMesh::build_half_edges(const FaceList& faces, NonManifold non_manifold,
                                 std::span<const std::uint8_t> counts_as_reversed) {
  Gluing gluing = glue(report_.vertices, faces, non_manifold, counts_as_reversed);
  report_.non_manifold_edges = gluing.non_manifold_edges;
  report_.reoriented = gluing.reoriented;
  report_.orientable = gluing.orientable;
  reversed_ = std::move(gluing.reversed);
  face_begin_.assign(faces.begin.begin(), faces.begin.end());
  if (!are_triangles(faces)) {
    face_of_.resize(faces.vertices.size());
    for (Index f = 0; f < face_count(); ++f)
      std::fill(face_of_.begin() + face_begin_[f], face_of_.begin() + face_begin_[f + 1], f);
  }
  auto stored = [&](Half h) {
    const Index f = face_of(h);
    return reversed_[f] ? static_cast<Half>(face_begin_[f] + face_begin_[f + 1] - 1 - h) : h;
  };
  const auto halves = static_cast<Half>(faces.vertices.size());
  tail_.resize(faces.vertices.size());
  twin_.resize(faces.vertices.size());
  for (Half h = 0; h < halves; ++h) {
    const Index f = face_of(h);
    const auto first = static_cast<Index>(face_begin_[f]);
    tail_[first + stored_corner(f, h - first)] = faces.vertices[h];
    const Half t = gluing.partner[h];
    twin_[stored(h)] = t >= 0 ? stored(t) : -1 - report_.boundary_edges++;
  }
  if (report_.orientable) return;
  mirrored_.resize(faces.vertices.size());
  for (Half h = 0; h < halves; ++h) mirrored_[h] = twin_[h] >= 0 && tail_[h] == tail_[twin_[h]];
}

/// Makes every fan of faces around an input vertex a vertex. First fans are numbered in the order of the input, then the
/// others.
void GluedMesh::number_vertices(NonManifold non_manifold) {
  Fans fans = find_fans(half_edges(), report_.vertices, dropped_);
  report_.non_manifold_vertices = static_cast<Index>(fans.pinched.count());
  report_.added_vertices = static_cast<Index>(fans.later.size());
  if (fans.pinched.count() > 0 && non_manifold == NonManifold::error)
    throw InvalidGeometry("non_manifold_vertices",
                          detail::counted(fans.pinched.count(), "vertex", "join") +
                              " several fans of faces (bow ties): " + fans.pinched.text(),
                          "repair the mesh, or split it there with NonManifold::split");
  std::vector<Index> vertex_of_fan(fans.corner.size(), -1);
  auto number = [&](Index fan, Index input) {
    vertex_of_fan[fan] = vertex_count();
    input_of_vertex_.push_back(input);
    corner_.push_back(fans.corner[fan]);
  };
  vertex_of_input_ = std::move(fans.first);
  for (Index v = 0; v < report_.vertices; ++v) {
    if (Index& first = vertex_of_input_[v]; first >= 0) {
      number(first, v);
      first = vertex_count() - 1;
    } else {
      ++report_.unreferenced;
    }
  }
  for (Index fan : fans.later) number(fan, tail_[fans.corner[fan]]);
  for (std::size_t h = 0; h < tail_.size(); ++h)
    if (fans.of_half[h] >= 0) tail_[h] = vertex_of_fan[fans.of_half[h]];
}

void GluedMesh::find_parts() {
  const HalfEdges edges = half_edges();
  DisjointSets parts(input_of_vertex_.size()), loops(input_of_vertex_.size());
  std::vector<std::uint8_t> on_boundary(input_of_vertex_.size(), 0);
  Index faces = 0;
  Offset sides = 0;
  for (Index f = 0; f < face_count(); ++f)
    if (!is_dropped(f)) ++faces, sides += face_begin_[f + 1] - face_begin_[f];
  for (Half h = 0; h < edges.size(); ++h) {
    if (is_dropped(face_of(h))) continue;
    const Index a = tail_[h], b = edges.head(h);
    parts.join(a, b);
    if (twin_[h] >= 0) continue;
    on_boundary[a] = on_boundary[b] = 1;
    loops.join(a, b);
  }
  part_.resize(input_of_vertex_.size());
  for (Index v = 0; v < vertex_count(); ++v) {
    part_[v] = parts.root(v);
    report_.components += part_[v] == v;
    report_.boundary_loops += on_boundary[v] && loops.root(v) == v;
  }
  report_.edges = (sides + report_.boundary_edges) / 2;
  report_.euler_characteristic = vertex_count() - report_.edges + faces;
}

std::vector<Index> GluedMesh::given_corners() const {
  if (!given_corners_.empty()) return given_corners_;
  std::vector<Index> result(tail_.size());
  for (Index f = 0; f < face_count(); ++f)
    for (Offset begin = face_begin_[f], c = 0; begin + c < face_begin_[f + 1]; ++c)
      result[begin + c] = input_of_vertex_[tail_[begin + stored_corner(f, static_cast<Index>(c))]];
  return result;
}

namespace {

/// Removes faces from half-edge arrays of triangles.
class FaceDropper {
 public:
  FaceDropper(std::vector<Half>& twin, std::vector<std::uint8_t>& mirrored, std::size_t faces)
      : twin_(twin), mirrored_(mirrored), dropped(faces, 0), stand_in(faces, {-1, -1, -1}) {}

  /// Drops the face of a side that has become a point, and glues the faces across its two other sides.
  void collapse(Half side) {
    const Half right = next(side), left = previous(side), beyond_right = twin_[right], beyond_left = twin_[left];
    drop(side / 3);
    if (beyond_right == left) return;  // the face is glued to itself: nothing is beyond
    const bool mirrored_right = is_mirrored(right), mirrors = mirrored_right != is_mirrored(left);
    glue(beyond_right, beyond_left, mirrors);
    glue(beyond_left, beyond_right, mirrors);
    // Both ends of the side coincide with one end of the side beyond, the third corner with the other end.
    std::array<Half, 3>& corners = stand_in[side / 3];
    if (beyond_right >= 0) {
      const Half tail = beyond_right, head = next(beyond_right);
      corners[side % 3] = corners[right % 3] = mirrored_right ? tail : head;
      corners[left % 3] = mirrored_right ? head : tail;
    } else if (beyond_left >= 0) {
      const Half tail = beyond_left, head = next(beyond_left);
      corners[side % 3] = corners[right % 3] = is_mirrored(left) ? head : tail;
      corners[left % 3] = is_mirrored(left) ? tail : head;
    }
    order_.push_back(side / 3);
  }

  void drop(Index face) { dropped[face] = 1; }

  /// Replaces corners in faces that were dropped later by corners in remaining faces.
  void resolve() {
    for (auto face = order_.rbegin(); face != order_.rend(); ++face)
      for (Half& corner : stand_in[*face])
        if (corner >= 0 && dropped[corner / 3]) corner = stand_in[corner / 3][corner % 3];
  }

 private:
  bool is_mirrored(Half h) const { return !mirrored_.empty() && mirrored_[h]; }
  void glue(Half side, Half other, bool mirrors) {
    if (side < 0) return;
    twin_[side] = std::max(other, -1);
    if (!mirrored_.empty()) mirrored_[side] = other >= 0 && mirrors;
  }

  std::vector<Half>& twin_;
  std::vector<std::uint8_t>& mirrored_;
  std::vector<Index> order_;

 public:
  std::vector<std::uint8_t> dropped;
  std::vector<std::array<Half, 3>> stand_in;
};

/// Where two sides of a face are contracted, contracts the third one, too.
void close_faces(std::vector<std::uint8_t>& contracted, std::span<const Half> twin) {
  std::vector<Index> faces(contracted.size() / 3);
  std::iota(faces.begin(), faces.end(), 0);
  while (!faces.empty()) {
    const Half h = 3 * faces.back();
    faces.pop_back();
    if (contracted[h] + contracted[h + 1] + contracted[h + 2] != 2) continue;
    for (Half side = h; side < h + 3; ++side) {
      if (contracted[side]) continue;
      contracted[side] = 1;
      if (twin[side] < 0) continue;
      contracted[twin[side]] = 1;
      faces.push_back(twin[side] / 3);
    }
  }
}

/// Whether some face has no contracted side.
bool has_remaining_face(std::span<const std::uint8_t> contracted) {
  for (std::size_t h = 0; h < contracted.size(); h += 3)
    if (!contracted[h] && !contracted[h + 1] && !contracted[h + 2]) return true;
  return false;
}

}  // namespace

void GluedMesh::contract(std::vector<std::uint8_t> contracted) {
  close_faces(contracted, twin_);
  if (std::find(contracted.begin(), contracted.end(), 1) == contracted.end() || !has_remaining_face(contracted)) return;
  given_corners_ = given_corners();

  DisjointSets places(vertex_of_input_.size());
  for (Half h = 0; h < static_cast<Half>(tail_.size()); ++h)
    if (contracted[h]) places.join(input_of_vertex_[tail_[h]], input_of_vertex_[tail_[next(h)]]);
  for (Index v = 0; v < report_.vertices; ++v)
    if (places.root(v) != v) merged_.emplace_back(v, places.root(v));
  for (Index& v : tail_) v = places.root(input_of_vertex_[v]);

  FaceDropper dropper(twin_, mirrored_, reversed_.size());
  for (Half h = 0; h < static_cast<Half>(tail_.size()); h += 3) {
    if (contracted[h] && contracted[h + 1] && contracted[h + 2]) {
      dropper.drop(h / 3);
      continue;
    }
    for (Half side = h; side < h + 3; ++side)
      if (contracted[side]) dropper.collapse(side);
  }
  dropper.resolve();
  dropped_ = std::move(dropper.dropped);
  stand_in_ = std::move(dropper.stand_in);
  renumber_contracted();
}

/// Renumbers the vertices and boundary edges, and recomputes the report.
void GluedMesh::renumber_contracted() {
  const TopologyReport before = report_;
  report_.boundary_edges = report_.components = report_.boundary_loops = 0;
  for (Half h = 0; h < static_cast<Half>(tail_.size()); ++h) {
    if (is_dropped(h / 3)) {
      twin_[h] = -1;
      if (!mirrored_.empty()) mirrored_[h] = 0;
    } else if (twin_[h] < 0) {
      twin_[h] = -1 - report_.boundary_edges++;
    }
  }
  input_of_vertex_.clear();
  corner_.clear();
  number_vertices(NonManifold::split);
  report_.unreferenced = before.unreferenced;
  for (const auto& [v, onto] : merged_) vertex_of_input_[v] = vertex_of_input_[onto];

  place_dropped_corners();
  find_parts();
}

/// Assigns vertices to the corners of dropped faces, and replacement corners to faces that became points.
void GluedMesh::place_dropped_corners() {
  std::vector<Index> dropped, vertex(vertex_of_input_);
  for (Index f = 0; f < face_count(); ++f)
    if (is_dropped(f)) dropped.push_back(f);
  // Corners that are only in faces without area have no vertex: use that of the next corner, or any.
  for (bool changed = true; changed;) {
    changed = false;
    for (Index f : dropped)
      for (Half h = 3 * f; h < 3 * f + 3; ++h)
        if (vertex[tail_[h]] < 0 && vertex[tail_[next(h)]] >= 0)
          vertex[tail_[h]] = vertex[tail_[next(h)]], changed = true;
  }
  for (Index f : dropped) {
    const auto corner = tail_.begin() + 3 * f;
    const bool is_point = corner[0] == corner[1] && corner[1] == corner[2] && vertex_of_input_[corner[0]] >= 0;
    for (Half h = 3 * f; h < 3 * f + 3; ++h) tail_[h] = std::max(vertex[tail_[h]], 0);
    if (is_point) stand_in_[f].fill(corner_[tail_[3 * f]]);
  }
}

std::vector<RowVertex> GluedMesh::rows() const {
  std::vector<RowVertex> pairs;
  for (Index v = 0; v < vertex_count(); ++v) pairs.push_back({Row(input_of_vertex_[v]), Vertex(v)});
  if (merged_.empty()) return pairs;
  std::vector<std::vector<Index>> vertices(vertex_of_input_.size());
  for (Index v = 0; v < vertex_count(); ++v) vertices[input_of_vertex_[v]].push_back(v);
  for (const auto& [row, onto] : merged_)
    for (Index v : vertices[onto]) pairs.push_back({Row(row), Vertex(v)});
  return pairs;
}

}  // namespace ahm::detail
