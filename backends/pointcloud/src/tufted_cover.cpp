#include "tufted_cover.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ahm/surface/half_edges.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {
namespace {

using Half = std::int64_t;  ///< half-edge 3 f + s: side s of cover face f

using detail::next;
using detail::previous;

/// 16 times the squared area of a triangle with these side lengths, by Kahan's stable formula.
double sixteen_squared_areas(double a, double b, double c) {
  if (a < b) std::swap(a, b);
  if (b < c) std::swap(b, c);
  if (a < b) std::swap(a, b);
  return std::max(0.0, (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)));
}

double triangle_area(double a, double b, double c) { return 0.25 * std::sqrt(sixteen_squared_areas(a, b, c)); }

/// The cotangent of the angle opposite side a of a triangle with side lengths a, b, c.
double opposite_cotangent(double a, double b, double c) {
  return (b * b + c * c - a * a) / std::sqrt(std::max(sixteen_squared_areas(a, b, c), 1e-300));
}

/// A closed manifold of 2 |triangles| faces in flat half-edge arrays. Triangle t has the copies 2t, corners (a, b, c),
/// and 2t + 1, corners (a, c, b).
class TuftedCover {
 public:
  TuftedCover(const CleanPoints& cloud, const TangentPlanes& planes, const std::vector<Triangle>& triangles)
      : n_(static_cast<Index>(cloud.points.size())) {
    const std::size_t halves = triangles.size() * 6;
    tail_.resize(halves);
    twin_.resize(halves);
    length_.resize(halves);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto [a, b, c] = triangles[t];
      std::copy_n(std::array{a, b, c, a, c, b}.begin(), 6, tail_.begin() + 6 * static_cast<std::ptrdiff_t>(t));
    }
    for (std::size_t h = 0; h < halves; ++h)
      length_[h] = norm(cloud.points[tail_[next(static_cast<Half>(h))]] - cloud.points[tail_[h]]);
    glue(cloud, planes, triangles);
  }

  /// The least length to be added to every edge of a part that keeps each face away from degeneracy ([SC20] Sec. 4.5).
  std::vector<double> least_mollification(const CloudParts& parts) const {
    std::vector<double> sum(static_cast<std::size_t>(parts.count), 0.0), epsilon = sum;
    std::vector<Offset> sides(sum.size(), 0);
    for (std::size_t h = 0; h < length_.size(); ++h) {
      const Index part = parts.of_point[tail_[h]];
      sum[part] += length_[h];
      ++sides[part];
    }
    for (std::size_t f = 0; f < length_.size(); f += 6) {  // both copies have the same lengths
      const Index part = parts.of_point[tail_[f]];
      const double mean = sum[part] / static_cast<double>(sides[part]);
      epsilon[part] = std::max(epsilon[part], mollification_of(length_[f], length_[f + 1], length_[f + 2], mean));
    }
    return epsilon;
  }
  void mollify(const PerPart& epsilon) {
    for (std::size_t h = 0; h < length_.size(); ++h) length_[h] += epsilon.at(tail_[h]);
  }

  /// Faces at points that lack triangles are tainted, and so are those that a flip joins with them.
  void taint(const std::vector<char>& complete) {
    tainted_.assign(tail_.size() / 3, 0);
    for (std::size_t h = 0; h < tail_.size(); ++h)
      if (!complete[tail_[h]]) tainted_[h / 3] = 1;
  }
  /// Points without a tainted face.
  std::vector<char> untainted(std::vector<char> complete) const {
    for (std::size_t h = 0; h < tail_.size(); ++h)
      if (tainted_[h / 3]) complete[tail_[h]] = 0;
    return complete;
  }

  /// Flips edges until all are Delaunay [BS07]. Returns the number of flips.
  Offset flip_to_delaunay() {
    std::vector<Half> stack;
    for (Half h = 0; h < static_cast<Half>(tail_.size()); ++h)
      if (h < twin_[h] && !is_delaunay(h)) stack.push_back(h);
    Offset flips = 0;
    detail::flip_to_delaunay(
        std::move(stack), 4 * tail_.size() + 1024, [&](Half h) { return twin_[h]; },
        [&](Half h) { return is_delaunay(h); }, [&](Half h) { flip(h), ++flips; });
    return flips;
  }

  bool is_delaunay() const {
    for (Half h = 0; h < static_cast<Half>(tail_.size()); ++h)
      if (h < twin_[h] && !is_delaunay(h)) return false;
    return true;
  }

  WeightedEdges weighted_edges() const;

 private:
  double cotangent(Half h) const { return opposite_cotangent(length_[h], length_[next(h)], length_[previous(h)]); }

  bool is_delaunay(Half h) const {
    const Half t = twin_[h];
    // Two sides of one face: folded onto itself, it cannot be flipped and is Delaunay.
    return h / 3 == t / 3 || cotangent(h) + cotangent(t) >= -1e-10;
  }

  void flip(Half h);
  void glue(const CleanPoints& cloud, const TangentPlanes& planes, const std::vector<Triangle>& triangles);

  Index n_;
  std::vector<Index> tail_;
  std::vector<Half> twin_;
  std::vector<double> length_;
  std::vector<char> tainted_;  ///< of each face; empty: none
};

/// Replaces the faces (i, j, k) and (j, i, m) on both sides of edge (i, j) by (m, k, i) and (k, m, j).
void TuftedCover::flip(Half h) {
  const Half t = twin_[h];
  if (!tainted_.empty() && tainted_[h / 3] != tainted_[t / 3]) tainted_[h / 3] = tainted_[t / 3] = 1;
  const Half jk = next(h), ki = previous(h), im = next(t), mj = previous(t);
  const Index k = tail_[ki], m = tail_[mj];
  const double l = length_[h], l_jk = length_[jk], l_ki = length_[ki], l_im = length_[im], l_mj = length_[mj];
  // Unfold both faces: i at the origin, j on the x axis, k above, m below.
  const double k_x = (l * l + l_ki * l_ki - l_jk * l_jk) / (2 * l), k_y = 2 * triangle_area(l, l_jk, l_ki) / l;
  const double m_x = (l * l + l_im * l_im - l_mj * l_mj) / (2 * l), m_y = 2 * triangle_area(l, l_im, l_mj) / l;
  const double diagonal = std::hypot(k_x - m_x, k_y + m_y);
  const Index i = tail_[h], j = tail_[t];
  std::vector<std::uint8_t> nowhere;
  detail::relink<Half>({ki, im, mj, jk}, {jk, ki, im, mj}, twin_, nowhere);

  auto set = [this](Half half, Index tail, double length) {
    tail_[half] = tail;
    length_[half] = length;
  };
  // Face of h becomes (m, k, i), face of t becomes (k, m, j).
  set(h, m, diagonal);
  set(jk, k, l_ki);
  set(ki, i, l_im);
  set(t, k, diagonal);
  set(im, m, l_mj);
  set(mj, j, l_jk);
}

/// Around every edge the faces are put in a cyclic order, and the front of each is glued to the back of the next. Sides
/// left and right of the edge alternate, since local triangulations overlap and consecutive faces should continue each
/// other.
void TuftedCover::glue(const CleanPoints& cloud, const TangentPlanes& planes, const std::vector<Triangle>& triangles) {
  struct Side {
    Index head;
    bool left;
    Half forward, backward;
  };
  // Bucket the sides by their smaller end.
  std::vector<Offset> begin(static_cast<std::size_t>(n_) + 1, 0);
  for (const Triangle& t : triangles) {
    begin[t[0] + 1] += 2;
    ++begin[t[1] + 1];
  }
  for (Index i = 0; i < n_; ++i) begin[i + 1] += begin[i];
  std::vector<Side> sides(triangles.size() * 3);
  std::vector<Offset> fill(begin.begin(), begin.end() - 1);
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const auto [a, b, c] = triangles[f];
    const Half front = static_cast<Half>(6 * f), back = front + 3;
    auto add = [&](Index from, Index to, Index apex, Half forward, Half backward) {
      const Vec3 &p = cloud.points[from], edge = cloud.points[to] - p, across = cloud.points[apex] - p;
      const bool left = dot(cross(edge, across), planes.normals[from]) > 0;
      sides[fill[from]++] = {to, left, forward, backward};
    };
    add(a, b, c, front, back + 2);
    add(b, c, a, front + 1, back + 1);
    add(a, c, b, back, front + 2);
  }
  std::vector<Side> ring, right;
  for (Index i = 0; i < n_; ++i) {
    const auto first = sides.begin() + begin[i], last = sides.begin() + begin[i + 1];
    std::stable_sort(first, last, [](const Side& p, const Side& q) { return p.head < q.head; });
    for (auto group = first; group != last;) {
      const auto end = std::find_if(group, last, [&](const Side& s) { return s.head != group->head; });
      // Relative to the first side, so that the signs of the normals do not matter.
      const auto middle =
          std::stable_partition(group, end, [left = group->left](const Side& s) { return s.left == left; });
      ring.clear();
      for (auto l = group, r = middle; l != middle || r != end;) {
        if (l != middle) ring.push_back(*l++);
        if (r != end) ring.push_back(*r++);
      }
      for (std::size_t s = 0; s < ring.size(); ++s) {
        const Half forward = ring[s].forward, backward = ring[(s + 1) % ring.size()].backward;
        twin_[forward] = backward;
        twin_[backward] = forward;
      }
      group = end;
    }
  }
}

WeightedEdges TuftedCover::weighted_edges() const {
  WeightedEdges result;
  result.masses.assign(static_cast<std::size_t>(n_), 0.0);
  std::vector<Offset> begin(static_cast<std::size_t>(n_) + 1, 0);
  for (std::size_t h = 0; h < tail_.size(); ++h) ++begin[std::min(tail_[h], tail_[next(static_cast<Half>(h))]) + 1];
  for (Index i = 0; i < n_; ++i) begin[i + 1] += begin[i];
  struct Entry {
    Index head;
    double weight;
  };
  std::vector<Entry> entries(tail_.size());
  std::vector<Offset> fill(begin.begin(), begin.end() - 1);
  for (Half h = 0; h < static_cast<Half>(tail_.size()); ++h) {
    const auto [low, high] = std::minmax(tail_[h], tail_[next(h)]);
    // Half the cotangent, and half of that for each of the two layers.
    entries[fill[low]++] = {high, low == high ? 0.0 : 0.25 * cotangent(h)};
    if (h % 3 == 0) {
      const double third = triangle_area(length_[h], length_[h + 1], length_[h + 2]) / 6.0;
      for (int s = 0; s < 3; ++s) result.masses[tail_[h + s]] += third;
    }
  }
  for (Index i = 0; i < n_; ++i) {
    const auto first = entries.begin() + begin[i], last = entries.begin() + begin[i + 1];
    std::stable_sort(first, last, [](const Entry& a, const Entry& b) { return a.head < b.head; });
    for (auto entry = first; entry != last;) {
      const Index head = entry->head;
      double weight = 0;
      for (; entry != last && entry->head == head; ++entry) weight += entry->weight;
      // Diagonals of cocircular quadrilaterals weigh nothing but rounding; they are no edges.
      if (head == i || weight <= 1e-10) continue;
      result.tails.push_back(i);
      result.heads.push_back(head);
      result.weights.push_back(weight);
    }
  }
  return result;
}

}  // namespace

double mollification_of(double a, double b, double c, double mean_length) {
  const double margin = 1e-5 * mean_length, sum = a + b + c;
  return std::max({margin - (sum - 2.0 * a), margin - (sum - 2.0 * b), margin - (sum - 2.0 * c)});
}

WeightedEdges tufted_laplacian(const CleanPoints& cloud, const TangentPlanes& planes,
                               const std::vector<Triangle>& triangles, const CloudParts& parts, CloudDetails& report) {
  TuftedCover cover(cloud, planes, triangles);
  std::vector<double> epsilon = cover.least_mollification(parts);
  report.mollification = *std::max_element(epsilon.begin(), epsilon.end());
  cover.mollify(PerPart(parts.of_point, std::move(epsilon)));
  report.flips = cover.flip_to_delaunay();
  report.flips_stopped = !cover.is_delaunay();
  return cover.weighted_edges();
}

WeightedEdges tufted_laplacian(const CleanPoints& cloud, const TangentPlanes& planes,
                               const std::vector<Triangle>& triangles, CoverPart& part, CloudDetails& report) {
  TuftedCover cover(cloud, planes, triangles);
  cover.mollify(part.mollification);
  cover.taint(part.complete);
  report.flips = cover.flip_to_delaunay();
  report.flips_stopped = !cover.is_delaunay();
  part.certain = cover.untainted(part.complete);
  return cover.weighted_edges();
}

}  // namespace ahm::pointcloud
