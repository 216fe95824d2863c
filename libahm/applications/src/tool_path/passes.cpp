#include "tool_path/passes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

using detail::Corner;
using detail::Half;
using exact::MeshPoint;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Lengths are in spacings. A front that arrives at a cut locus at height k + f leaves a strip of width 2 f between the two
// passes at height k. For f > max_gap the strip is not covered. For f > 1 there are two more passes, 2 (f - 1) apart, which
// cover twice up to f = 1 + min_gap.
constexpr double max_gap = 0.6, min_gap = 0.25;
/// Largest slope of the distance along a cut locus that is treated as a strip. At a steeper one, the passes of both sides
/// meet at an angle that covers the corner: no point is farther than 1 / (1 + slope).
constexpr double max_slope = 0.45;
/// Passes may not be closer to cut loci than this.
constexpr double least_distance = 0.5;

std::size_t segments(const MeshCurve& curve) { return curve.faces.size(); }
const MeshPoint& after(const MeshCurve& curve, std::size_t k) { return curve.points[(k + 1) % curve.points.size()]; }

/// A point of a side at which two fronts meet.
struct Meeting {
  double t = nan;       ///< place on the side, from its tail; NaN: none
  double distance = 0;  ///< of the point
  double slope = 1;     ///< of the distance along the cut locus: the cosine of half of the angle between the fronts
};

/// Finds where fronts meet, on all sides of a mesh.
class CutLocus {
 public:
  CutLocus(const PathDomain& domain, const Front& front) : mesh_(domain.mesh), surface_(domain.surface), front_(front) {
    for (Index v = 0; v < surface_.vertex_count(); ++v) total_.push_back(surface_.angle_sum(v));
    meetings_.resize(3 * mesh_.size());
    for (std::size_t h = 0; h < meetings_.size(); ++h) {
      const auto half = static_cast<Half>(h);
      if (mesh_.twin[h] >= 0 && mesh_.twin[h] < half) continue;
      meetings_[h] = meeting(half);
    }
  }

  /// The curves of the cut locus through the meetings that `wanted` accepts.
  template <class Wanted>
  std::vector<PassCurve> curves(const Wanted& wanted) const {
    Chains chains;
    for (std::size_t f = 0; f < mesh_.size(); ++f) {
      std::vector<Half> met;
      for (Half h = static_cast<Half>(3 * f); h < static_cast<Half>(3 * f + 3); ++h)
        if (const Meeting& m = at(h); !std::isnan(m.t) && wanted(m)) met.push_back(h);
      if (met.size() < 2) continue;
      std::vector<std::size_t> nodes;
      for (const Half h : met) nodes.push_back(chains.node(own(h), on_side(own(h), at(h).t), at(h).distance));
      if (met.size() == 2) {
        chains.join(nodes[0], nodes[1], static_cast<Index>(f));
        continue;
      }
      double height = 0;
      MeshPoint center{static_cast<Index>(f), {0, 0, 0}};
      for (const Half h : met) {
        const MeshPoint p = in_face(mesh_, on_side(own(h), at(h).t), static_cast<Index>(f));
        for (std::size_t c = 0; c < 3; ++c) center.barycentric[c] += p.barycentric[c] / 3;
        height = std::max(height, at(h).distance);
      }
      const std::size_t middle = chains.node(-1 - static_cast<Half>(f), center, height);
      for (const std::size_t n : nodes) chains.join(n, middle, static_cast<Index>(f));
    }
    return std::move(chains).curves();
  }

 private:
  /// Nodes that are joined inside faces, and the paths through them.
  class Chains {
   public:
    std::size_t node(Half key, const MeshPoint& point, double distance) {
      const auto [entry, is_new] = number_.try_emplace(key, points_.size());
      if (is_new) points_.push_back(point), distances_.push_back(distance), links_.emplace_back();
      return entry->second;
    }
    void join(std::size_t a, std::size_t b, Index face) {
      links_[a].push_back({b, face});
      links_[b].push_back({a, face});
    }
    std::vector<PassCurve> curves() && {
      std::vector<PassCurve> result;
      used_.resize(points_.size());
      for (std::size_t n = 0; n < points_.size(); ++n) used_[n].assign(links_[n].size(), false);
      for (const bool cycles : {false, true})
        for (std::size_t n = 0; n < points_.size(); ++n)
          if (cycles || links_[n].size() != 2)
            for (std::size_t k = 0; k < links_[n].size(); ++k)
              if (!used_[n][k]) result.push_back(walk(n, k));
      return result;
    }

   private:
    struct Link {
      std::size_t to;
      Index face;
    };
    PassCurve walk(std::size_t start, std::size_t k) {
      PassCurve pass;
      pass.origin = PassOrigin::cut_locus;
      pass.curve.points.push_back(points_[start]);
      double sum = distances_[start];
      for (std::size_t at = start;;) {
        const Link link = links_[at][k];
        used_[at][k] = true;
        for (std::size_t j = 0; j < links_[link.to].size(); ++j)
          if (links_[link.to][j].to == at && links_[link.to][j].face == link.face) used_[link.to][j] = true;
        pass.curve.faces.push_back(link.face);
        if (link.to == start) {
          pass.curve.closed = true;
          break;
        }
        pass.curve.points.push_back(points_[link.to]);
        sum += distances_[link.to];
        at = link.to;
        if (links_[at].size() != 2) break;
        k = used_[at][0] ? 1 : 0;
        if (used_[at][k]) break;
      }
      pass.distance = sum / static_cast<double>(pass.curve.points.size());
      return pass;
    }

    std::map<Half, std::size_t> number_;
    std::vector<MeshPoint> points_;
    std::vector<double> distances_;
    std::vector<std::vector<Link>> links_;
    std::vector<std::vector<bool>> used_;
  };

  /// The half-edge that represents a side.
  Half own(Half h) const {
    const Half twin = mesh_.twin[to_size(h)];
    return twin >= 0 ? std::min(h, twin) : h;
  }
  const Meeting& at(Half h) const { return meetings_[to_size(own(h))]; }

  /// The gradient of the distance at an end of a side, in the plane with the x axis from this end to the other one.
  Vec2 gradient(Index vertex, double angle_of_side) const {
    double back = front_.back[to_size(vertex)] - angle_of_side;
    const double total = total_[to_size(vertex)];
    if (!surface_.on_boundary(vertex)) back -= total * std::round(back / total);
    back = std::clamp(back, -std::numbers::pi, std::numbers::pi);
    return {-std::cos(back), -std::sin(back)};
  }

  Meeting meeting(Half h) const {
    const Index a = mesh_.tail(h), b = mesh_.head(h);
    const double from = front_.distance[to_size(a)], to = front_.distance[to_size(b)];
    if (std::isnan(front_.back[to_size(a)]) || std::isnan(front_.back[to_size(b)])) return {};
    const Half next = detail::next(h);
    const Vec2 at_a = gradient(a, surface_.turned(Corner{h, true})),
               seen_from_b = gradient(b, surface_.turned(Corner{next, true}) + surface_.angle(next)),
               at_b = -seen_from_b;
    const double length = surface_.record(h).length, sum = at_a[0] + seen_from_b[0];
    const double slope = std::sqrt(std::max(0.0, (1 + dot(at_a, at_b)) / 2));
    if (!(sum > 0.2)) {
      // The fronts may meet along the side.
      const double middle = (from + at_a[0] * length / 2 + to + seen_from_b[0] * length / 2) / 2,
                   difference = from + at_a[0] * length / 2 - to - seen_from_b[0] * length / 2;
      if (slope < max_slope && std::abs(difference) < 0.1 * length * std::abs(at_a[1] - at_b[1]))
        return {0.5, middle, slope};
      return {};
    }
    const double t = (to - from + seen_from_b[0] * length) / (sum * length);
    if (!(t > -0.1 && t < 1.1)) return {};
    const double inside = std::clamp(t, 0.02, 0.98);
    return {inside, std::max(from + at_a[0] * inside * length, to + seen_from_b[0] * (1 - inside) * length), slope};
  }

  const FaceMesh& mesh_;
  const exact::PolyhedralSurface& surface_;
  const Front& front_;
  std::vector<double> total_;
  std::vector<Meeting> meetings_;
};

/// Whether a strip at height `distance` needs a pass along its middle.
bool needs_middle(double distance, double phase) {
  const double height = distance - phase;
  if (height < 0) return false;  // the front starts half a spacing from the boundary
  const double f = height - std::floor(height);
  return f > max_gap || (f < min_gap && height >= 1);
}

/// The parts of the boundary that need a pass: those parallel to the front.
std::vector<PassCurve> boundary_passes(const PathDomain& domain, const Front& front, double phase, const auto& wanted) {
  const FaceMesh& mesh = domain.mesh;
  std::map<Index, Half> leaving;
  for (std::size_t h = 0; h < 3 * mesh.size(); ++h) {
    if (mesh.twin[h] >= 0) continue;
    const auto half = static_cast<Half>(h);
    const Index a = mesh.tail(half), b = mesh.head(half);
    const double from = front.distance[to_size(a)], to = front.distance[to_size(b)],
                 length = domain.surface.record(half).length;
    if (!std::isfinite(from) || !std::isfinite(to) || std::abs(to - from) > max_slope * length) continue;
    if (wanted((from + to) / 2, phase)) leaving[a] = half;
  }
  std::map<Index, bool> entered;
  for (const auto& [vertex, half] : leaving) entered[mesh.head(half)] = true;
  std::vector<PassCurve> result;
  const auto follow = [&](Index vertex) {
    PassCurve pass;
    pass.origin = PassOrigin::boundary;
    const Index first = vertex;
    double sum = 0;
    for (auto next = leaving.find(vertex); next != leaving.end(); next = leaving.find(vertex)) {
      const Half half = next->second;
      leaving.erase(next);
      if (pass.curve.points.empty()) pass.curve.points.push_back(on_side(half, 0));
      pass.curve.faces.push_back(half / 3);
      vertex = mesh.head(half);
      sum += front.distance[to_size(vertex)];
      if (vertex == first) {
        pass.curve.closed = true;
        break;
      }
      pass.curve.points.push_back(on_side(half, 1));
    }
    pass.distance = sum / static_cast<double>(segments(pass.curve));
    result.push_back(std::move(pass));
  };
  std::vector<Index> starts;
  for (const auto& [vertex, half] : leaving)
    if (!entered.contains(vertex)) starts.push_back(vertex);
  for (const Index vertex : starts) follow(vertex);
  while (!leaving.empty()) follow(leaving.begin()->first);
  return result;
}

void remove_short(const FaceMesh& mesh, std::vector<PassCurve>& passes) {
  std::erase_if(passes, [&](const PassCurve& pass) { return curve_length(mesh, pass.curve) < shortest_pass; });
}

/// Appends sources that represent a curve in an exact map: the middles of equal pieces of at most `step`.
void add_sources(const FaceMesh& mesh, const MeshCurve& curve, double step, std::vector<MeshPoint>& sources) {
  const double length = curve_length(mesh, curve), piece = length / std::ceil(length / step);
  double next = piece / 2, walked = 0;
  for (std::size_t k = 0; k < segments(curve); ++k) {
    const MeshPoint a = in_face(mesh, curve.points[k], curve.faces[k]),
                    b = in_face(mesh, after(curve, k), curve.faces[k]);
    const double ahead = distance(mesh.position(a), mesh.position(b));
    for (; next <= walked + ahead; next += piece)
      sources.push_back(between(a, b, std::min(1.0, (next - walked) / ahead)));
    walked += ahead;
  }
}

std::vector<MeshPoint> sources_of(const FaceMesh& mesh, const std::vector<PassCurve>& passes) {
  std::vector<MeshPoint> result;
  for (const PassCurve& pass : passes) add_sources(mesh, pass.curve, pass_step, result);
  return result;
}

/// The pieces of a curve whose points are kept.
/// @param kept  one per point
std::vector<MeshCurve> pieces(const MeshCurve& curve, const std::vector<bool>& kept) {
  const std::size_t n = curve.points.size();
  if (std::ranges::find(kept, false) == kept.end()) return {curve};
  std::vector<MeshCurve> result;
  // A closed curve is read from a point that is not kept.
  const auto first = static_cast<std::size_t>(std::ranges::find(kept, false) - kept.begin());
  MeshCurve piece;
  const auto end_piece = [&] {
    if (piece.points.size() > 1) {
      piece.faces.resize(piece.points.size() - 1);
      result.push_back(piece);
    }
    piece = {};
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = curve.closed ? (first + i) % n : i;
    if (!kept[k]) {
      end_piece();
      continue;
    }
    piece.points.push_back(curve.points[k]);
    if (k < segments(curve)) piece.faces.push_back(curve.faces[k]);
  }
  end_piece();
  return result;
}

/// Removes the parts of passes that are too close to other curves.
std::vector<PassCurve> trimmed(const PathDomain& domain, std::vector<PassCurve> passes,
                               const std::vector<PassCurve>& others, const Progress& progress) {
  const std::vector<MeshPoint> sources = sources_of(domain.mesh, others);
  if (sources.empty()) return passes;
  exact::ExactOptions options;
  options.radius = least_distance;
  options.progress = progress;
  for (const PassCurve& pass : passes)
    options.targets.insert(options.targets.end(), pass.curve.points.begin(), pass.curve.points.end());
  const exact::ExactMap map = exact::exact_map(domain.surface, sources, options);
  std::vector<PassCurve> result;
  std::size_t target = 0;
  for (const PassCurve& pass : passes) {
    std::vector<bool> kept;
    for (std::size_t k = 0; k < pass.curve.points.size(); ++k, ++target)
      kept.push_back(map.target_status(target) != Status::ok || !(map.target_distance(target) < least_distance));
    for (MeshCurve& piece : pieces(pass.curve, kept)) result.push_back({std::move(piece), pass.origin, pass.distance});
  }
  return result;
}

/// The faces that contain a point.
std::vector<Index> faces_around(const FaceMesh& mesh, const MeshPoint& point) {
  std::vector<Index> result{point.face};
  const auto zeros = std::ranges::count(point.barycentric, 0.0);
  if (zeros == 0) return result;
  for (std::size_t at = 0; at < result.size(); ++at) {
    const MeshPoint here = in_face(mesh, point, result[at]);
    for (std::size_t s = 0; s < 3; ++s) {
      if (here.barycentric[(s + 2) % 3] != 0) continue;  // the point is not on side s
      const Half twin = mesh.twin[3 * to_size(result[at]) + s];
      if (twin >= 0 && std::ranges::find(result, twin / 3) == result.end()) result.push_back(twin / 3);
    }
  }
  return result;
}

/// A face that contains two points; -1: none.
Index common_face(const FaceMesh& mesh, const MeshPoint& a, const MeshPoint& b) {
  const std::vector<Index> of_b = faces_around(mesh, b);
  for (const Index face : faces_around(mesh, a))
    if (std::ranges::find(of_b, face) != of_b.end()) return face;
  return -1;
}

}  // namespace

MeshPoint between(const MeshPoint& a, const MeshPoint& b, double t) {
  MeshPoint p{a.face, {}};
  for (std::size_t c = 0; c < 3; ++c) p.barycentric[c] = (1 - t) * a.barycentric[c] + t * b.barycentric[c];
  return p;
}

std::vector<MeshPoint> samples(const FaceMesh& mesh, const MeshCurve& curve, double step) {
  std::vector<MeshPoint> result;
  for (std::size_t k = 0; k < segments(curve); ++k) {
    const MeshPoint a = in_face(mesh, curve.points[k], curve.faces[k]),
                    b = in_face(mesh, after(curve, k), curve.faces[k]);
    const double length = distance(mesh.position(a), mesh.position(b));
    const auto parts = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(length / step)));
    for (std::size_t j = 0; j < parts; ++j)
      result.push_back(between(a, b, static_cast<double>(j) / static_cast<double>(parts)));
  }
  if (!curve.closed) result.push_back(curve.points.back());
  return result;
}

double curve_length(const FaceMesh& mesh, const MeshCurve& curve) {
  double sum = 0;
  for (std::size_t k = 0; k < segments(curve); ++k)
    sum += distance(mesh.position(curve.points[k]), mesh.position(after(curve, k)));
  return sum;
}

void append_path(const FaceMesh& mesh, const exact::GeodesicPath& path, MeshCurve& curve) {
  for (std::size_t k = 0; k + 1 < path.points.size(); ++k) {
    const Index face = common_face(mesh, path.points[k], path.points[k + 1]);
    if (face < 0) continue;  // the same point
    curve.points.push_back(path.points[k]);
    curve.faces.push_back(face);
  }
}

MeshCurve joined_curve(const PathDomain& domain, std::span<const MeshPoint> points, bool closed) {
  MeshCurve curve;
  curve.closed = closed;
  const std::size_t legs = closed ? points.size() : points.size() - 1;
  for (std::size_t k = 0; k < legs; ++k) {
    const exact::GeodesicPath leg = domain.path(points[k], points[(k + 1) % points.size()]);
    append_path(domain.mesh, leg, curve);
    if (!closed && k + 1 == legs) curve.points.push_back(leg.points.back());
  }
  return curve;
}

std::vector<PassCurve> make_passes(const FineDomain& domain, const std::vector<MeshCurve>& seeds, double phase,
                                   bool spiral, const Progress& progress) {
  std::vector<MeshPoint> sources;
  std::vector<PassCurve> levels;
  for (const MeshCurve& seed : seeds) {
    add_sources(domain.mesh, seed, seed_step, sources);
    if (phase == 0) levels.push_back({seed, PassOrigin::seed, 0});
  }
  const Front from_seed = front(domain, sources, infinity, progress);
  double farthest = 0;
  std::vector<double> values = from_seed.distance;
  for (double& d : values) {
    if (std::isinf(d)) d = nan;  // a component without a seed
    if (!std::isnan(d)) farthest = std::max(farthest, d);
  }
  const double first = phase > 0 ? phase : 1;
  if (spiral) {
    for (PassCurve& pass : spiral_levels(domain.mesh, values, first, farthest)) levels.push_back(std::move(pass));
  } else {
    for (double level = first; level < farthest; level += 1)
      for (MeshCurve& curve : level_curves(domain.mesh, values, level))
        levels.push_back({std::move(curve), PassOrigin::level, level});
  }
  remove_short(domain.mesh, levels);

  std::vector<PassCurve> middles = CutLocus(domain, from_seed).curves([&](const Meeting& m) {
    return m.slope < max_slope && needs_middle(m.distance, phase);
  });
  for (PassCurve& pass : boundary_passes(domain, from_seed, phase, needs_middle)) middles.push_back(std::move(pass));
  remove_short(domain.mesh, middles);
  std::vector<PassCurve> passes = trimmed(domain, std::move(levels), middles, progress);
  passes.insert(passes.end(), std::make_move_iterator(middles.begin()), std::make_move_iterator(middles.end()));
  remove_short(domain.mesh, passes);
  if (passes.empty()) return passes;

  // Gaps that remain: where the distance from all passes is larger than the largest gap.
  const Front from_passes = front(domain, sources_of(domain.mesh, passes), 1.5, progress);
  std::vector<PassCurve> rest = CutLocus(domain, from_passes).curves([&](const Meeting& m) {
    return m.slope < max_slope && m.distance > max_gap;
  });
  for (PassCurve& pass :
       boundary_passes(domain, from_passes, 0, [](double distance, double) { return distance > max_gap; }))
    rest.push_back(std::move(pass));
  remove_short(domain.mesh, rest);
  passes.insert(passes.end(), std::make_move_iterator(rest.begin()), std::make_move_iterator(rest.end()));
  return passes;
}

}  // namespace ahm
