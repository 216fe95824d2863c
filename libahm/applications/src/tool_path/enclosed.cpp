// The part of a mesh inside or outside of a closed curve. Faces are cut where the curve crosses their sides.
#include <algorithm>
#include <map>

#include "ahm/error.hpp"
#include "ahm/util/disjoint_sets.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "tool_path/tool_path.hpp"

namespace ahm {
namespace {

using detail::Half;
using exact::MeshPoint;

/// Where the curve crosses a side nearer to its end, as a share of the side, it runs through the end. This avoids needles.
constexpr double snap = 0.02;

class Cutter {
 public:
  Cutter(const PathDomain& domain, const MeshCurve& curve)
      : mesh_(domain.mesh), on_curve_(mesh_.points.size(), false), crossings_(3 * mesh_.size()) {
    for (std::size_t k = 0; k < curve.points.size(); ++k) {
      const Index face = curve.faces[k], next = curve.faces[(k + 1) % curve.faces.size()];
      cross(in_face(mesh_, curve.points[(k + 1) % curve.points.size()], face), next);
    }
    const Index component = domain.surface.component(mesh_.faces[to_size(curve.faces.front())][0]);
    find_parts([&](Index p) { return domain.surface.component(p) == component; });
  }

  /// @throws InvalidArgument (the curve does not divide its component)
  FaceMesh part(bool outside) const {
    if (areas_.size() < 2)
      throw InvalidArgument("region_not_enclosed", "the curve of the region does not divide the surface",
                            "draw a closed curve around a part of the surface");
    const auto largest = std::ranges::max_element(areas_, {}, [](const auto& part) { return part.second; })->first;
    // 1: on the side that remains, -1: on the other side, 0: on the curve
    std::vector<int> side(mesh_.points.size(), 0);
    for (std::size_t p = 0; p < side.size(); ++p) {
      if (on_curve_[p]) continue;
      const bool inside = areas_.contains(parts_[p]) && parts_[p] != largest;
      side[p] = inside != outside ? 1 : -1;
    }
    return clipped(side);
  }

 private:
  Half own(Half h) const { return mesh_.twin[to_size(h)] >= 0 ? std::min(h, mesh_.twin[to_size(h)]) : h; }

  /// Records that the curve leaves a face at a point of its sides, or stays in it.
  void cross(const MeshPoint& point, Index next) {
    for (std::size_t c = 0; c < 3; ++c)
      if (point.barycentric[c] > 1 - snap) on_curve_[to_size(mesh_.faces[to_size(point.face)][c])] = true;
    if (next == point.face) return;
    Half side = -1;
    double nearest = 2;
    for (std::size_t s = 0; s < 3; ++s) {
      const auto h = static_cast<Half>(3 * to_size(point.face) + s);
      const double away = point.barycentric[(s + 2) % 3];
      if (mesh_.twin[to_size(h)] >= 0 && mesh_.twin[to_size(h)] / 3 == next && away < nearest) side = h, nearest = away;
    }
    if (side < 0) {  // the faces have one vertex in common
      const auto corner = std::ranges::max_element(point.barycentric) - point.barycentric.begin();
      on_curve_[to_size(mesh_.faces[to_size(point.face)][to_size(corner)])] = true;
      return;
    }
    const Half h = own(side);
    const MeshPoint p = in_face(mesh_, point, h / 3);
    const double tail = p.barycentric[to_size(h % 3)], head = p.barycentric[to_size((h % 3 + 1) % 3)];
    crossings_[to_size(h)].push_back(head / (tail + head));
  }

  /// Joins points that the curve does not separate.
  template <class InComponent>
  void find_parts(const InComponent& in_component) {
    detail::DisjointSets parts(mesh_.points.size());
    for (std::size_t h = 0; h < crossings_.size(); ++h) {
      const auto half = static_cast<Half>(h);
      const Index a = mesh_.tail(half), b = mesh_.head(half);
      if (own(half) != half || on_curve_[to_size(a)] || on_curve_[to_size(b)] || crossings_[h].size() % 2 == 1)
        continue;
      parts.join(a, b);
    }
    for (std::size_t p = 0; p < mesh_.points.size(); ++p) parts_.push_back(parts.root(static_cast<Index>(p)));
    for (std::size_t f = 0; f < mesh_.size(); ++f)
      for (const Index p : mesh_.faces[f])
        if (!on_curve_[to_size(p)] && in_component(p))
          areas_[parts_[to_size(p)]] += mesh_.area(static_cast<Index>(f)) / 3;
  }

  /// The part of the mesh on one side.
  FaceMesh clipped(const std::vector<int>& side) const {
    std::vector<Vec3> points = mesh_.points;
    std::vector<Index> vertices = mesh_.vertices;
    std::vector<Triangle> faces;
    std::map<Half, Index> cuts;
    const auto cut = [&](Half h) {
      const auto [entry, is_new] = cuts.try_emplace(own(h), static_cast<Index>(points.size()));
      if (is_new) {
        const double t = std::clamp(crossings_[to_size(own(h))].front(), snap, 1 - snap);
        points.push_back((1 - t) * mesh_.points[to_size(mesh_.tail(own(h)))] +
                         t * mesh_.points[to_size(mesh_.head(own(h)))]);
        vertices.push_back(-1);
      }
      return entry->second;
    };
    for (std::size_t f = 0; f < mesh_.size(); ++f) {
      std::vector<Index> polygon;
      bool any = false;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto h = static_cast<Half>(3 * f + c);
        const int here = side[to_size(mesh_.tail(h))], there = side[to_size(mesh_.head(h))];
        any = any || here > 0;
        if (here >= 0) polygon.push_back(mesh_.tail(h));
        if (here * there < 0) polygon.push_back(cut(h));
      }
      for (std::size_t k = 2; any && k < polygon.size(); ++k) faces.push_back({polygon[0], polygon[k - 1], polygon[k]});
    }
    return glued(std::move(points), std::move(faces), std::move(vertices));
  }

  const FaceMesh& mesh_;
  std::vector<bool> on_curve_;                  ///< points that the curve runs through
  std::vector<std::vector<double>> crossings_;  ///< places on the sides that the curve crosses, from their tails
  std::vector<Index> parts_;                    ///< part of each point
  std::map<Index, double> areas_;               ///< areas of the parts of the component of the curve
};

}  // namespace

FaceMesh enclosed_part(const PathDomain& domain, const MeshCurve& curve, bool outside) {
  return Cutter(domain, curve).part(outside);
}

}  // namespace ahm
