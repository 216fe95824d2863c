/// \file
/// Distances around obstacles where edges lie along orthogonal axes, as in grids: |grad T| = 1 [FLZ09].
///
/// T is factored as u T0, T0 being the distance on the straight line, whose gradient is known. Differences are those of u
/// alone, of first order and from where the front comes:
///
///     (T0 / l_k) (u - u_k) + u c_k  along axis k,  the sum of squares being 1
///
/// with l_k the edge to the neighbour at u_k and c_k the cosine between edge and straight line. u = 1 where this is free,
/// exactly; behind obstacles u > 1.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {

/// u of a vertex, at least 1.
/// @param straight  T0 > 0
/// @param upwind    the neighbours from which the front comes, one per axis at most, at least one in all: the `length` of the edge, the
///                  `cosine` between it, towards the vertex, and the straight line, and the `factor` u; in another order afterwards
template <class Upwind>
double eikonal_factor(double straight, std::span<Upwind> upwind) {
  const auto slope = [&](const Upwind& k) { return straight / k.length + k.cosine; };
  const auto offset = [&](const Upwind& k) { return straight / k.length * k.factor; };
  // An axis counts where the front comes along it, which is from this u on.
  const auto begin = [&](const Upwind& k) { return slope(k) > 0 ? offset(k) / slope(k) : INFINITY; };
  std::sort(upwind.begin(), upwind.end(), [&](const Upwind& a, const Upwind& b) { return begin(a) < begin(b); });
  double u = INFINITY, ss = 0, so = 0, oo = -1;
  for (const Upwind& k : upwind) {
    if (!(u > begin(k))) break;
    const double s = slope(k), o = offset(k);
    ss += s * s, so += s * o, oo += o * o;
    u = (so + std::sqrt(std::max(0.0, so * so - ss * oo))) / ss;
  }
  return std::max(1.0, u);
}

/// Whether edges are all at right angles or along each other.
/// @param axis  to be filled, per edge: the first one along the same line
inline bool find_axes(const Star& star, std::vector<std::size_t>& axis) {
  constexpr double same = 1e-9;
  axis.resize(star.degree());
  for (std::size_t e = 0; e < star.degree(); ++e) {
    axis[e] = e;
    for (std::size_t k = 0; k < e; ++k) {
      double product = 0;
      for (int a = 0; a < star.dimension; ++a) product += star.log(e)[a] * star.log(k)[a];
      const double cosine = std::abs(product) / (length(star.log(e)) * length(star.log(k)));
      if (cosine > 1 - same)
        axis[e] = axis[k];
      else if (!(cosine < same))
        return false;
    }
  }
  return star.degree() > 0;
}

}  // namespace ahm
