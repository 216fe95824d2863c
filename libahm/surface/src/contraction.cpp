// Contracting edges without length: the half-edges of `GluedMesh` afterwards.
#include <algorithm>
#include <numeric>

#include "ahm/surface/glued_mesh.hpp"
#include "ahm/util/disjoint_sets.hpp"

namespace ahm::detail {
namespace {

/// Takes faces out of half-edge arrays of triangles.
class FaceDropper {
 public:
  FaceDropper(std::vector<Half>& twin, std::vector<std::uint8_t>& mirrored, std::size_t faces)
      : twin_(twin), mirrored_(mirrored), dropped(faces, 0), stand_in(faces, {-1, -1, -1}) {}

  /// Drops the face of a side that is a point now: glues what lies beyond its two other sides.
  void collapse(Half side) {
    const Half right = next(side), left = previous(side), beyond_right = twin_[right], beyond_left = twin_[left];
    take_out(side / 3);
    if (beyond_right == left) return;  // folded onto itself: nothing is beyond
    const bool mirrored_right = is_mirrored(right), mirrors = mirrored_right != is_mirrored(left);
    glue(beyond_right, beyond_left, mirrors);
    glue(beyond_left, beyond_right, mirrors);
    // Both ends of the side lie at one end of what is beyond, the third corner at the other.
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

  void take_out(Index face) { dropped[face] = 1; }

  /// Leads corners in faces that were dropped later on to faces that were kept.
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

/// A face with two sides that are contracted has a third one.
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

/// Whether a face is without a contracted side.
bool leaves_a_face(std::span<const std::uint8_t> contracted) {
  for (std::size_t h = 0; h < contracted.size(); h += 3)
    if (!contracted[h] && !contracted[h + 1] && !contracted[h + 2]) return true;
  return false;
}

}  // namespace

void GluedMesh::contract(std::vector<std::uint8_t> contracted) {
  close_faces(contracted, twin_);
  if (std::find(contracted.begin(), contracted.end(), 1) == contracted.end() || !leaves_a_face(contracted)) return;
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
      dropper.take_out(h / 3);
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

/// Numbers vertices and boundary edges again and counts them.
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

/// Gives the corners of dropped faces vertices, and faces that became points a stand-in.
void GluedMesh::place_dropped_corners() {
  std::vector<Index> dropped, vertex(vertex_of_input_);
  for (Index f = 0; f < face_count(); ++f)
    if (is_dropped(f)) dropped.push_back(f);
  // Corners in faces without area alone have no vertex: that of the next corner has to do, or any.
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
