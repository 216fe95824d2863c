#include "gluing.hpp"

#include <algorithm>
#include <limits>

#include "ahm/error.hpp"
#include "half_edges.hpp"

namespace ahm::trimesh {
namespace {

std::string name(const Triangle& t) {
  std::string text = "(";
  text.append(std::to_string(t[0])).append(", ").append(std::to_string(t[1])).append(", ").append(std::to_string(t[2]));
  return text.append(")");
}

void check_indices(Index vertices, std::span<const Triangle> faces) {
  if (vertices < 1) throw InvalidGeometry("the mesh has no vertices");
  if (faces.empty()) throw InvalidGeometry("the mesh has no faces");
  if (faces.size() > static_cast<std::size_t>(std::numeric_limits<Half>::max() / 4))
    throw InvalidGeometry("the mesh has " + std::to_string(faces.size()) + " faces; at most 2^29 are supported");
  ItemList outside, repeated;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto [a, b, c] = faces[f];
    if (std::min({a, b, c}) < 0 || std::max({a, b, c}) >= vertices)
      outside.add("face " + std::to_string(f) + " " + name(faces[f]));
    else if (a == b || b == c || c == a)
      repeated.add("face " + std::to_string(f) + " " + name(faces[f]));
  }
  if (outside.count() > 0)
    throw InvalidGeometry(std::to_string(outside.count()) + " faces have a vertex outside [0, " +
                          std::to_string(vertices) + "): " + outside.text());
  if (repeated.count() > 0)
    throw InvalidGeometry(std::to_string(repeated.count()) + " faces use a vertex twice: " + repeated.text() +
                          "; remove them");
}

/// A side of a face, filed under the smaller of its two vertices.
struct Side {
  Index high;
  Half half;
};

class Gluer {
 public:
  Gluer(Index vertices, std::span<const Triangle> faces)
      : faces_(faces), begin_(static_cast<std::size_t>(vertices) + 1, 0) {
    result_.partner.assign(faces.size() * 3, -1);
  }

  /// Finds the sides on each edge.
  void pair_sides(NonManifold non_manifold, TopologyReport& report) {
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
    if (duplicates_.count() > 0)
      throw InvalidGeometry(std::to_string(duplicates_.count()) + " faces are duplicates: " + duplicates_.text() +
                            "; remove them");
    report.non_manifold_edges = static_cast<Index>(crowded_.count());
    if (crowded_.count() > 0 && non_manifold == NonManifold::error)
      throw InvalidGeometry(std::to_string(crowded_.count()) + " edges have more than two faces: " + crowded_.text() +
                            "; repair them, or cut the mesh there with NonManifold::split");
  }

  /// Turns faces over until neighbours agree, component by component.
  void orient() {
    const std::size_t count = faces_.size();
    result_.reversed.assign(count, 2);
    std::vector<Index> component;
    for (std::size_t seed = 0; seed < count; ++seed) {
      if (result_.reversed[seed] != 2) continue;
      result_.reversed[seed] = 0;
      component.assign(1, static_cast<Index>(seed));
      std::size_t turned = 0;
      for (std::size_t at = 0; at < component.size(); ++at) {
        const Index f = component[at];
        turned += result_.reversed[f];
        for (Half h = 3 * f; h < 3 * f + 3; ++h) visit_across(h, component);
      }
      const bool turn_all = 2 * turned > component.size();
      for (Index f : component) {
        result_.reversed[f] ^= static_cast<std::uint8_t>(turn_all);
        result_.reoriented += result_.reversed[f];
      }
    }
  }

  Gluing take() { return std::move(result_); }

 private:
  Index tail(Half h) const { return faces_[h / 3][h % 3]; }
  Index head(Half h) const { return faces_[h / 3][(h + 1) % 3]; }
  Index apex(Half h) const { return faces_[h / 3][(h + 2) % 3]; }

  void fill_buckets() {
    const auto halves = static_cast<Half>(result_.partner.size());
    for (Half h = 0; h < halves; ++h) ++begin_[static_cast<std::size_t>(std::min(tail(h), head(h))) + 1];
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    std::vector<Offset> fill(begin_.begin(), begin_.end() - 1);
    sides_.resize(result_.partner.size());
    for (Half h = 0; h < halves; ++h) sides_[fill[std::min(tail(h), head(h))]++] = {std::max(tail(h), head(h)), h};
  }

  void join(Index low, std::span<Side> group) {
    if (group.size() < 2) return;
    if (group.size() == 2 && apex(group[0].half) != apex(group[1].half)) {
      result_.partner[group[0].half] = group[1].half;
      result_.partner[group[1].half] = group[0].half;
      return;
    }
    // Two faces on one edge with the same third vertex are the same face; they meet at three edges, and are named at
    // the first.
    std::stable_sort(group.begin(), group.end(),
                     [&](const Side& a, const Side& b) { return apex(a.half) < apex(b.half); });
    for (std::size_t s = 1; s < group.size(); ++s) {
      const Half a = group[s - 1].half, b = group[s].half;
      if (apex(a) == apex(b) && apex(a) > group[s].high)
        duplicates_.add("face " + std::to_string(b / 3) + " repeats face " + std::to_string(a / 3));
    }
    if (group.size() > 2)
      crowded_.add("(" + std::to_string(low) + ", " + std::to_string(group[0].high) + ") with " +
                   std::to_string(group.size()) + " faces");
  }

  void visit_across(Half h, std::vector<Index>& component) {
    const Half t = result_.partner[h];
    if (t < 0) return;
    const auto wanted = static_cast<std::uint8_t>(result_.reversed[h / 3] ^ (tail(h) == tail(t)));
    std::uint8_t& other = result_.reversed[t / 3];
    if (other == 2) {
      other = wanted;
      component.push_back(t / 3);
    } else if (other != wanted) {
      result_.orientable = false;
    }
  }

  std::span<const Triangle> faces_;
  std::vector<Offset> begin_;
  std::vector<Side> sides_;
  ItemList duplicates_, crowded_;
  Gluing result_;
};

}  // namespace

Gluing glue(Index vertices, std::span<const Triangle> faces, NonManifold non_manifold, TopologyReport& report) {
  check_indices(vertices, faces);
  Gluer gluer(vertices, faces);
  gluer.pair_sides(non_manifold, report);
  gluer.orient();
  return gluer.take();
}

}  // namespace ahm::trimesh
