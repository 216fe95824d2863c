#include "tufted_cover.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "ahm/surface/detail/half_edges.hpp"
#include "ahm/util/buckets.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/unset_vector.hpp"
#include "ahm/util/vec.hpp"
#include "cloud_parts.hpp"

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

/// A closed manifold of 2 |triangles| faces in flat half-edge arrays. Triangle t has two copies: face 2t with corners (a, b,
/// c), and face 2t + 1 with corners (a, c, b).
class TuftedCover {
 public:
  TuftedCover(const CleanPoints& cloud, const TangentPlanes& planes, const std::vector<Triangle>& triangles,
              unsigned threads)
      : n_(static_cast<Index>(cloud.points.size())), threads_(threads) {
    const std::size_t halves = triangles.size() * 6;
    tail_.resize(halves);
    twin_.resize(halves);
    length_.resize(halves);
    detail::for_each_index(triangles.size(), threads_, [&](std::size_t t) {
      const auto [a, b, c] = triangles[t];
      std::copy_n(std::array{a, b, c, a, c, b}.begin(), 6, tail_.begin() + 6 * static_cast<std::ptrdiff_t>(t));
      for (std::size_t h = 6 * t; h < 6 * t + 6; ++h)
        length_[h] = norm(cloud.points[tail_[next(static_cast<Half>(h))]] - cloud.points[tail_[h]]);
    });
    glue(cloud, planes, triangles);
  }

  /// For each part, the least length that keeps every face away from degeneracy when added to every edge ([SC20] Sec. 4.5).
  std::vector<double> min_mollification(const CloudParts& parts) const {
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
    detail::for_each_index(length_.size(), threads_, [&](std::size_t h) { length_[h] += epsilon.at(tail_[h]); });
  }

  /// Marks the faces at points that lack triangles as tainted. A flip taints both of its faces if one of them is tainted.
  void taint(const std::vector<char>& complete) {
    tainted_.assign(tail_.size() / 3, 0);
    for (std::size_t h = 0; h < tail_.size(); ++h)
      if (!complete[tail_[h]]) tainted_[h / 3] = 1;
  }
  /// Removes the marks of points with a tainted face.
  std::vector<char> untainted(std::vector<char> complete) const {
    for (std::size_t h = 0; h < tail_.size(); ++h)
      if (tainted_[h / 3]) complete[tail_[h]] = 0;
    return complete;
  }

  /// Flips edges until all are Delaunay [BS07].
  /// @return the number of flips
  Offset flip_to_delaunay() {
    Offset flips = 0;
    detail::flip_to_delaunay(
        not_delaunay(), 4 * tail_.size() + 1024, [&](Half h) { return twin_[h]; },
        [&](Half h) { return is_delaunay(h); }, [&](Half h) { flip(h), ++flips; });
    return flips;
  }

  bool is_delaunay() const { return not_delaunay().empty(); }

  WeightedEdges weighted_edges() const;

 private:
  double cotangent(Half h) const { return opposite_cotangent(length_[h], length_[next(h)], length_[previous(h)]); }

  bool is_delaunay(Half h) const {
    const Half t = twin_[h];
    // Two sides of one face: the face is folded onto itself, and its edge is Delaunay because it cannot be flipped.
    return h / 3 == t / 3 || (is_acute(h) && is_acute(t)) || cotangent(h) + cotangent(t) >= -1e-10;
  }
  /// Whether the opposite angle is at most a right angle: the sign of its cotangent.
  bool is_acute(Half h) const {
    const double a = length_[h], b = length_[next(h)], c = length_[previous(h)];
    return b * b + c * c - a * a >= 0;
  }

  /// One half of each edge that is not Delaunay, ascending.
  std::vector<Half> not_delaunay() const {
    const auto halves = static_cast<Offset>(tail_.size());
    std::vector<std::vector<Half>> parts(static_cast<std::size_t>((halves + halves_per_task - 1) / halves_per_task));
    detail::parallel_chunks(halves, halves_per_task, threads_, [&](Offset begin, Offset end) {
      for (Half h = begin; h < end; ++h)
        if (h < twin_[h] && !is_delaunay(h)) parts[begin / halves_per_task].push_back(h);
    });
    std::vector<Half> result;
    for (const auto& part : parts) result.insert(result.end(), part.begin(), part.end());
    return result;
  }

  void flip(Half h);

  /// A side of a triangle, directed from its smaller to its larger end.
  struct Side {
    Index head;
    bool left, left_of_head;  ///< whether the triangle is to its left, by the normals at either end
    bool near_head;           ///< whether the apex is nearer to the head
    float reach;              ///< sum of the squared distances of the apex to both ends, relative to the squared length
    Half forward, backward;   ///< half-edges along the side in one copy, and against it in the other one
  };
  void glue(const CleanPoints& cloud, const TangentPlanes& planes, const std::vector<Triangle>& triangles);
  void glue_around(std::span<const Side> edge, std::vector<Side>& left, std::vector<Side>& right);

  static constexpr Offset halves_per_task = 1 << 16;

  Index n_;
  unsigned threads_;
  detail::UnsetVector<Index> tail_;
  detail::UnsetVector<Half> twin_;
  detail::UnsetVector<double> length_;
  std::vector<char> tainted_;  ///< per face; empty: no face is tainted
};

/// Replaces the faces (i, j, k) and (j, i, m) on both sides of the edge (i, j) by (m, k, i) and (k, m, j).
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

/// Puts the faces around every edge in a cyclic order, and glues the front of each to the back of the next. Faces to the left
/// and to the right of the edge alternate, because local triangulations overlap and consecutive faces should continue each
/// other.
void TuftedCover::glue(const CleanPoints& cloud, const TangentPlanes& planes, const std::vector<Triangle>& triangles) {
  // For the sides 3 t, 3 t + 1, 3 t + 2 of triangle t: corners, and half-edges in both copies relative to 6 t.
  struct Corners {
    int from, to, apex, forward, backward;
  };
  constexpr Corners corners[] = {{0, 1, 2, 0, 5}, {1, 2, 0, 1, 4}, {0, 2, 1, 3, 2}};
  const detail::Buckets by_smaller_end =
      detail::buckets_of(static_cast<Offset>(triangles.size() * 3), n_, threads_,
                         [&](Offset side) { return triangles[side / 3][corners[side % 3].from]; });

  const auto side_of = [&](Offset number) -> Side {
    const Triangle& t = triangles[number / 3];
    const Corners& of = corners[number % 3];
    const Vec3 &p = cloud.points[t[of.from]], edge = cloud.points[t[of.to]] - p, across = cloud.points[t[of.apex]] - p;
    const Half first = 6 * (number / 3);
    const Vec3 opposite = across - edge;
    const Vec3 normal = cross(edge, across);
    const double unit = dot(edge, edge), tail = dot(across, across) / unit, head = dot(opposite, opposite) / unit;
    const auto reach = static_cast<float>(tail + head);  // NaN if the squared length of the side underflows
    return {t[of.to],
            dot(normal, planes.normals[t[of.from]]) > 0,
            dot(normal, planes.normals[t[of.to]]) > 0,
            static_cast<float>(head) < static_cast<float>(tail),
            std::isnan(reach) ? 0 : reach,
            first + of.forward,
            first + of.backward};
  };
  detail::parallel_chunks(n_, points_per_task, threads_, [&](Offset from, Offset to) {
    std::vector<Side> sides, left, right;
    for (Offset i = from; i < to; ++i) {
      sides.clear();
      for (const Offset side : by_smaller_end.of(static_cast<Index>(i))) sides.push_back(side_of(side));
      // Sorts the sides of one edge by the shape of their triangles, which scaling, translation and rotation do not change. In
      // single precision the order of triangles decides between equal ones, as on lattices, and rounding does not.
      std::sort(sides.begin(), sides.end(), [](const Side& p, const Side& q) {
        if (p.head != q.head) return p.head < q.head;
        return p.reach != q.reach ? p.reach < q.reach : p.forward < q.forward;
      });
      for (auto group = sides.begin(); group != sides.end();) {
        const auto end = std::find_if(group, sides.end(), [&](const Side& s) { return s.head != group->head; });
        glue_around(std::span(group, end), left, right);
        group = end;
      }
    }
  });
}

/// @param left, right  work space
void TuftedCover::glue_around(std::span<const Side> edge, std::vector<Side>& left, std::vector<Side>& right) {
  left.clear();
  right.clear();
  // Left and right are relative to the first side, so that the signs of the normals do not matter. They are seen from the end
  // nearer to its apex, so that the numbers of the points do not matter.
  const bool from_head = edge.front().near_head;
  const auto is_left = [&](const Side& side) { return from_head ? side.left_of_head : side.left; };
  for (const Side& side : edge) (is_left(side) == is_left(edge.front()) ? left : right).push_back(side);
  const Side* last = nullptr;
  const auto glue_halves = [&](Half front, Half back) { twin_[front] = back, twin_[back] = front; };
  const auto follow = [&](const Side& side) {
    if (last && from_head) glue_halves(last->backward, side.forward);
    if (last && !from_head) glue_halves(last->forward, side.backward);
    last = &side;
  };
  for (std::size_t k = 0; k < std::max(left.size(), right.size()); ++k) {
    if (k < left.size()) follow(left[k]);
    if (k < right.size()) follow(right[k]);
  }
  follow(left.front());
}

WeightedEdges TuftedCover::weighted_edges() const {
  WeightedEdges result;
  detail::Buckets by_smaller_end;
  const auto bucket = [&] {
    by_smaller_end = detail::buckets_of(static_cast<Offset>(tail_.size()), n_, threads_,
                                        [&](Half h) { return std::min(tail_[h], tail_[next(h)]); });
  };
  const auto weigh_points = [&] {
    result.masses.assign(static_cast<std::size_t>(n_), 0.0);
    for (std::size_t h = 0; h < tail_.size(); h += 3) {
      const double third = triangle_area(length_[h], length_[h + 1], length_[h + 2]) / 6.0;
      for (int s = 0; s < 3; ++s) result.masses[tail_[h + s]] += third;
    }
  };
  detail::run_both(threads_, bucket, weigh_points);

  std::vector<WeightedEdges> parts(static_cast<std::size_t>((n_ + points_per_task - 1) / points_per_task));
  detail::parallel_chunks(n_, points_per_task, threads_, [&](Offset from, Offset to) {
    struct Entry {
      Index head;
      Half half;
      double weight;
    };
    std::vector<Entry> entries;
    WeightedEdges& part = parts[from / points_per_task];
    for (Offset i = from; i < to; ++i) {
      entries.clear();
      for (const Half h : by_smaller_end.of(static_cast<Index>(i))) {
        const Index high = std::max(tail_[h], tail_[next(h)]);
        // Half the cotangent, and half of that for each of the two copies. Loops are dropped.
        if (high != i) entries.push_back({high, h, 0.25 * cotangent(h)});
      }
      std::sort(entries.begin(), entries.end(),
                [](const Entry& a, const Entry& b) { return a.head != b.head ? a.head < b.head : a.half < b.half; });
      for (auto entry = entries.begin(); entry != entries.end();) {
        const Index head = entry->head;
        double weight = 0;
        for (; entry != entries.end() && entry->head == head; ++entry) weight += entry->weight;
        // The weights of diagonals of cocircular quadrilaterals are zero up to rounding; these are no edges. Points with areas
        // that underflow next to larger parts are no vertices.
        if (weight <= 1e-10 || !(result.masses[i] > 0) || !(result.masses[head] > 0)) continue;
        part.tails.push_back(static_cast<Index>(i));
        part.heads.push_back(head);
        part.weights.push_back(weight);
      }
    }
  });
  const auto join = [&](auto WeightedEdges::*array) {
    std::size_t size = 0;
    for (const WeightedEdges& part : parts) size += (part.*array).size();
    (result.*array).reserve(size);
    for (const WeightedEdges& part : parts)
      (result.*array).insert((result.*array).end(), (part.*array).begin(), (part.*array).end());
  };
  join(&WeightedEdges::tails);
  join(&WeightedEdges::heads);
  join(&WeightedEdges::weights);
  return result;
}

}  // namespace

double mollification_of(double a, double b, double c, double mean_length) {
  const double margin = 1e-5 * mean_length, sum = a + b + c;
  return std::max({margin - (sum - 2.0 * a), margin - (sum - 2.0 * b), margin - (sum - 2.0 * c)});
}

WeightedEdges tufted_laplacian(const CleanPoints& cloud, const TangentPlanes& planes,
                               const std::vector<Triangle>& triangles, const CloudParts& parts, unsigned threads,
                               CloudDetails& report) {
  TuftedCover cover(cloud, planes, triangles, threads);
  std::vector<double> epsilon = cover.min_mollification(parts);
  report.mollification = *std::max_element(epsilon.begin(), epsilon.end());
  cover.mollify(PerPart(parts.of_point, std::move(epsilon)));
  report.flips = cover.flip_to_delaunay();
  report.flips_stopped = !cover.is_delaunay();
  return cover.weighted_edges();
}

WeightedEdges tufted_laplacian(const CleanPoints& cloud, const TangentPlanes& planes,
                               const std::vector<Triangle>& triangles, CoverPart& part, CloudDetails& report) {
  TuftedCover cover(cloud, planes, triangles, 1);
  cover.mollify(part.mollification);
  cover.taint(part.complete);
  report.flips = cover.flip_to_delaunay();
  report.flips_stopped = !cover.is_delaunay();
  part.certain = cover.untainted(part.complete);
  return cover.weighted_edges();
}

}  // namespace ahm::pointcloud
