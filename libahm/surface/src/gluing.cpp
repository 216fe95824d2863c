#include "ahm/surface/gluing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ahm/error.hpp"
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

/// Refuses faces with a fault. @param what  "3 faces" have or do
void refuse(std::string_view fault, const std::vector<Index>& wrong, const FaceList& faces, const std::string& what,
            const std::string& advice) {
  if (wrong.empty()) return;
  ItemList list;
  for (Index f : wrong) list.add(name(f, faces[f]));
  throw InvalidGeometry(fault, std::to_string(wrong.size()) + " faces " + what + ": " + list.text(), advice);
}

/// A side of a face, filed under the smaller of its two vertices.
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
    std::sort(duplicates_.begin(), duplicates_.end());  // they meet at every one of their edges
    duplicates_.erase(std::unique(duplicates_.begin(), duplicates_.end()), duplicates_.end());
    result_.non_manifold_edges = static_cast<Index>(crowded_.count());
  }

  void refuse_duplicates() const {
    if (duplicates_.empty()) return;
    ItemList list;
    for (const auto& [later, earlier] : duplicates_)
      list.add("face " + std::to_string(later) + " repeats face " + std::to_string(earlier));
    throw InvalidGeometry("duplicate_faces", std::to_string(list.count()) + " faces are duplicates: " + list.text(),
                          "remove them");
  }

  void refuse_crowded_edges() const {
    if (crowded_.count() > 0)
      throw InvalidGeometry("non_manifold_edges",
                            std::to_string(crowded_.count()) + " edges have more than two faces: " + crowded_.text(),
                            "repair them, or cut the mesh there with NonManifold::split");
  }

  /// Turns faces over until neighbours agree, component by component.
  void orient(std::span<const std::uint8_t> counts_as_turned) {
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
        turned += result_.reversed[f] != (counts_as_turned.empty() ? 0 : counts_as_turned[f]);
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
  /// The vertex that follows when the side is walked from its smaller vertex to the larger one.
  Index beyond(Half h) const { return tail(h) < head(h) ? head(next(h)) : tail(previous(h)); }

  void fill_buckets() {
    const auto halves = static_cast<Half>(result_.partner.size());
    for (Half h = 0; h < halves; ++h) ++begin_[static_cast<std::size_t>(std::min(tail(h), head(h))) + 1];
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    std::vector<Offset> fill(begin_.begin(), begin_.end() - 1);
    sides_.resize(result_.partner.size());
    for (Half h = 0; h < halves; ++h) sides_[fill[std::min(tail(h), head(h))]++] = {std::max(tail(h), head(h)), h};
  }

  /// Whether the faces of two sides of one edge are the same cycle of vertices, in either sense.
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
      crowded_.add("(" + std::to_string(low) + ", " + std::to_string(group[0].high) + ") with " +
                   std::to_string(group.size()) + " faces");
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
  ItemList crowded_;
  Gluing result_;
};

/// Multiplies by the power of two that brings the largest coordinate into [1, 2); returns its exponent.
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
    throw InvalidGeometry("the mesh has " + std::to_string(faces.vertices.size()) +
                          " corners; at most 2^31 - 2 are supported");
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

Gluing glue(Index vertices, const FaceList& faces, NonManifold non_manifold, std::span<const std::uint8_t> turned) {
  if (!turned.empty() && turned.size() != faces.size())
    throw InvalidArgument("'turned' has " + std::to_string(turned.size()) + " entries for " +
                          std::to_string(faces.size()) + " faces");
  const FaceFaults faults = find_faults(vertices, faces);
  refuse("vertices_outside", faults.outside, faces, "have a vertex outside [0, " + std::to_string(vertices) + ")",
         "number vertices from 0");
  refuse("small_faces", faults.small, faces, "have fewer than 3 corners", "remove them");
  refuse("repeated_vertices", faults.repeating, faces, "use a vertex twice", "remove them");
  Gluer gluer(vertices, faces);
  gluer.pair_sides();
  gluer.refuse_duplicates();
  if (non_manifold == NonManifold::error) gluer.refuse_crowded_edges();
  gluer.orient(turned);
  return gluer.take();
}

void check_positions(std::span<const Vec3> points) {
  if (points.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max() / 2))
    throw InvalidGeometry("the mesh has " + std::to_string(points.size()) + " vertices; at most 2^30 are supported");
  for (std::size_t v = 0; v < points.size(); ++v)
    for (double x : points[v])
      if (!std::isfinite(x))
        throw InvalidGeometry("not_finite",
                              "vertex " + std::to_string(v) + " is (" + number(points[v][0]) + ", " +
                                  number(points[v][1]) + ", " + number(points[v][2]) + ")",
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

}  // namespace ahm::detail
