#include "ahm/surface/unfolded_corners.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ahm/util/vec.hpp"

namespace ahm::detail {
namespace {

/// How much more than its sheet a torn face is stretched, and one beside it is stretched or shrunk: log 2, log 1.4.
constexpr double torn = 0.693147, blended = 0.336472;
/// How much the sheet's strain changes from face to face at the most, and how many faces wide a map blends two sheets.
constexpr double drift = 0.05;
constexpr int blend = 3;

Vec2 times(const Vec2& a, const Vec2& b) { return {a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]}; }

class Unfolding {
 public:
  Unfolding(const HalfEdges& edges, const FlatCorners& faces, const LogMap& map)
      : edges_(edges),
        faces_(faces),
        phi_(faces.places.size()),
        state_(face_count(), unseen),
        sheet_(state_.size()),
        at_source_(state_.size()) {
    read(map);
    find_source(map.source());
    judge();
    if (map.method() == Method::heat) widen();
    unfold();
  }

  std::vector<Vec2> result() && {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (Index f = 0; f < face_count(); ++f)
      for (Half h = begin(f); h < begin(f + 1); ++h)
        phi_[h] = state_[f] == known ? faces_.unit * phi_[h] : Vec2{nan, nan};
    return std::move(phi_);
  }

 private:
  enum : std::uint8_t { unseen, masked, waiting, known };

  Index face_count() const {
    return static_cast<Index>(edges_.face_of.empty() ? edges_.tail.size() / 3 : edges_.face_begin.size() - 1);
  }
  Half begin(Index f) const { return static_cast<Half>(edges_.face_of.empty() ? 3 * f : edges_.face_begin[f]); }
  Index face_of(Half h) const { return edges_.face_of.empty() ? h / 3 : edges_.face_of[h]; }

  void read(const LogMap& map) {
    for (Index f = 0; f < face_count(); ++f)
      for (Half h = begin(f); h < begin(f + 1); ++h) {
        const Vertex v(faces_.vertices[h]);
        if (std::isnan(faces_.places[h][0]) || map.status(v) != Status::ok) {
          state_[f] = masked;
          continue;
        }
        const auto phi = map.coordinates(v);
        phi_[h] = {phi[0] / faces_.unit, phi[1] / faces_.unit};
      }
  }

  /// Calls visit(length, mapped length) for the sides and the diagonals over one corner.
  template <class Visit>
  void for_each_pair(Index f, const Visit& visit) const {
    for (Half h = begin(f); h < begin(f + 1); ++h) {
      const Half one = edges_.next(h), two = edges_.next(one);
      visit(norm(faces_.places[one] - faces_.places[h]), norm(phi_[one] - phi_[h]));
      if (edges_.next(two) != h) visit(norm(faces_.places[two] - faces_.places[h]), norm(phi_[two] - phi_[h]));
    }
  }

  /// The largest of log(mapped length / length), and of its absolute value.
  struct Strain {
    double stretch = 0, either = 0, longest = 0;
  };

  Strain strain(Index f) const {
    Strain result;
    for_each_pair(f, [&](double length, double) { result.longest = std::max(result.longest, length); });
    const double half = 0.5 * result.longest;
    for_each_pair(f, [&](double length, double mapped) {
      const double strained = std::log(mapped / std::max(length, half));
      result.stretch = std::max(result.stretch, strained);
      if (length >= half) result.either = std::max(result.either, std::abs(strained));
    });
    result.either = std::max(result.either, result.stretch);
    return result;
  }

  /// Twice that of a face in the map; negative where it is turned over.
  double area(Index f) const {
    const Half first = begin(f);
    double sum = 0;
    for (Half h = first + 1; h + 1 < begin(f + 1); ++h) sum += cross(phi_[h] - phi_[first], phi_[h + 1] - phi_[first]);
    return sum;
  }

  /// Whether a face lies on the sheet, which goes on with its strain.
  bool is_on_sheet(Index f) {
    const Strain own = strain(f);
    if (!(own.stretch <= sheet_[f] + torn)) return false;
    if (faces_.orientable && area(f) < -0.1 * own.longest * own.longest) return false;
    sheet_[f] = std::clamp(own.stretch, sheet_[f] - drift, sheet_[f] + drift);
    return true;
  }

  void find_source(const Source& source) {
    std::vector<bool> is_source(static_cast<std::size_t>(std::ranges::max(faces_.vertices)) + 1);
    for (const Vertex v : source.vertices()) is_source[v.index] = true;
    for (Half h = 0; h < edges_.size(); ++h)
      if (is_source[faces_.vertices[h]]) at_source_[face_of(h)] = true;
  }

  /// All faces, outward from those at the source, and from any other where none leads there. At the source a map is the sheet,
  /// however coarse, unless it turns a face over.
  void judge() {
    std::vector<Index> front;
    const auto visit = [&](Index f, double before) {
      if (state_[f] != unseen) return;
      sheet_[f] = before;
      state_[f] = is_on_sheet(f) || (at_source_[f] && area(f) > 0) ? known : waiting;
      front.push_back(f);
    };
    for (Index f = 0; f < face_count(); ++f)
      if (at_source_[f]) visit(f, 0);
    std::size_t at = 0;
    for (Index f = 0; f < face_count(); ++f) {
      for (; at < front.size(); ++at)
        for (Half h = begin(front[at]); h < begin(front[at] + 1); ++h)
          if (const Half t = edges_.twin[h]; t >= 0) visit(face_of(t), sheet_[front[at]]);
      visit(f, 0);
    }
  }

  /// Torn are also the faces beside torn ones over which a map by heat blends the two sheets.
  void widen() {
    std::vector<Index> front, next;
    for (Index f = 0; f < face_count(); ++f)
      if (state_[f] == waiting) front.push_back(f);
    for (int k = 0; k < blend; ++k, front.swap(next), next.clear())
      for (const Index f : front)
        for (Half h = begin(f); h < begin(f + 1); ++h) {
          const Half t = edges_.twin[h];
          if (t < 0 || state_[face_of(t)] != known || at_source_[face_of(t)]) continue;
          if (strain(face_of(t)).either <= sheet_[face_of(t)] + blended) continue;
          state_[face_of(t)] = waiting;
          next.push_back(face_of(t));
        }
  }

  void unfold() {
    std::vector<Index> front;
    for (Index f = 0; f < face_count(); ++f)
      if (state_[f] == known) front.push_back(f);
    for (std::size_t at = 0; at < front.size(); ++at)
      for (Half h = begin(front[at]); h < begin(front[at] + 1); ++h)
        if (const Half t = edges_.twin[h]; t >= 0 && state_[face_of(t)] == waiting && lay_beside(h, t)) {
          state_[face_of(t)] = known;
          front.push_back(face_of(t));
        }
  }

  /// Lays the face of t out beside that of h, as it is; but corners that its other neighbours have near by, where they have them.
  bool lay_beside(Half h, Half t) {
    const bool same_way = edges_.is_mirrored(h);
    const Half after = edges_.next(t);
    const Vec2 a = phi_[same_way ? h : edges_.next(h)], b = phi_[same_way ? edges_.next(h) : h];
    const Vec2 p = faces_.places[t], q = faces_.places[after];
    if (!(norm(b - a) > 0) || !(norm(q - p) > 0)) return false;
    // The face of h lies to the left of its sides, unless it was laid out turned over itself.
    const bool turned = (area(face_of(h)) > 0) == same_way;
    const Vec2 along = normalized(b - a), side = normalized(q - p), back = {side[0], -side[1]};
    const Half first = begin(face_of(t)), last = begin(face_of(t) + 1);
    for (Half c = first; c < last; ++c) {
      const Vec2 local = times(back, faces_.places[c] - 0.5 * (p + q));
      phi_[c] = 0.5 * (a + b) + times(along, turned ? Vec2{local[0], -local[1]} : local);
    }
    phi_[t] = a, phi_[after] = b;
    double shortest = std::numeric_limits<double>::infinity();
    for_each_pair(face_of(t), [&](double length, double) { shortest = std::min(shortest, length); });
    const double near = 0.2 * shortest;
    for (Half c = first; c < last; ++c) {
      const Half beyond = edges_.twin[c];
      if (c == t || beyond < 0 || state_[face_of(beyond)] != known) continue;
      const Half ends[] = {c, edges_.next(c)}, there[] = {edges_.next(beyond), beyond};
      for (const int e : {0, 1}) {
        const Vec2 had = phi_[there[edges_.is_mirrored(c) ? 1 - e : e]];
        if (ends[e] != t && ends[e] != after && norm(had - phi_[ends[e]]) <= near) phi_[ends[e]] = had;
      }
    }
    return true;
  }

  const HalfEdges& edges_;
  const FlatCorners& faces_;
  std::vector<Vec2> phi_;
  std::vector<std::uint8_t> state_;
  std::vector<double> sheet_;  ///< per face: the strain of the sheet there
  std::vector<bool> at_source_;
};

}  // namespace

std::vector<Vec2> unfolded_corners(const HalfEdges& edges, const FlatCorners& faces, const LogMap& map) {
  return Unfolding(edges, faces, map).result();
}

}  // namespace ahm::detail
