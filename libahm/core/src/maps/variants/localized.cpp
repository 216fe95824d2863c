// Alg. 1 of [SS25] (Eq. 9, 10 and 12): displacements diffuse as one vector field, each in the frame of its vertex.
//
//     Y = B^-1 (rho + b U z),   phi = (Y / lambda) / U
#include <algorithm>

#include "ahm/util/scratch.hpp"
#include "ahm/util/small_math.hpp"
#include "maps/variants/variant_system.hpp"

namespace ahm {
namespace {

class Localized final : public VariantSystem {
 public:
  void add_sample(double b, std::span<const double> U, std::span<const double> z, double* out) const override {
    const std::size_t d = z.size();
    for (std::size_t c = 0; c < d; ++c) {
      double sum = 0;
      for (std::size_t a = 0; a < d; ++a) sum += b * U[c * d + a] * z[a];
      out[c] += sum;
    }
  }
  void add_known(double heat, const Transport& R, std::span<const double> value, double* out) const override {
    R.add_to(heat, value.data(), out);
  }

  UnknownLayout layout(std::size_t, std::size_t d) const override { return {d, 1}; }
  void set_right_side(const FrameField&, Index vertex, std::span<const double> rho, double* right_side,
                      std::size_t) const override {
    std::copy(rho.begin(), rho.end(), right_side + static_cast<std::size_t>(vertex) * rho.size());
  }
  void solve(const HeatOperators& operators, std::span<double> X, std::size_t sources,
             unsigned threads) const override {
    operators.solve_vector(X, static_cast<Index>(sources), threads);
  }
  void add_pairs(const Star& star, std::span<const double> factors, std::span<const double> values,
                 double* pairs) const override {
    const auto d = static_cast<std::size_t>(star.dimension);
    Scratch seen(d);
    for (std::size_t k = 0; k < star.degree(); ++k) {
      star.transport(k).apply(values.data() + k * d, seen.data());
      pairs[0] += factors[k] * dot(star.log(k), seen.span());
    }
  }
  double sum_of_pairs(const FrameField&, Index, std::span<const double> pairs) const override { return pairs[0]; }
  void radial(const FrameField&, Index vertex, std::span<const double> solution, std::size_t n,
              double* out) const override {
    const std::size_t d = solution.size() / n;
    std::copy_n(solution.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(vertex) * d), d, out);
  }
  void read(const FrameField& U, Index vertex, std::span<const double> solution, std::size_t n,
            double* out) const override {
    U.to_source(vertex, solution.data() + static_cast<std::size_t>(vertex) * (solution.size() / n), out);
  }
};

}  // namespace

const VariantSystem& localized_system() {
  static const Localized system;
  return system;
}

}  // namespace ahm
