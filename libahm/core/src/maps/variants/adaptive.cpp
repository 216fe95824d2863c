// Alg. 2 of [SS25] (Eq. 15 to 17): coordinates in the source's frame diffuse as d scalar fields.
//
//     x = A^-1 (rho / U + b z),   phi = x / lambda
#include "ahm/util/scratch.hpp"
#include "ahm/util/small_math.hpp"
#include "maps/variants/variant_system.hpp"

namespace ahm {
namespace {

class Adaptive final : public VariantSystem {
 public:
  void add_sample(double b, std::span<const double>, std::span<const double> z, double* out) const override {
    for (std::size_t a = 0; a < z.size(); ++a) out[a] += b * z[a];
  }
  void add_known(double heat, const Transport&, std::span<const double> value, double* out) const override {
    for (std::size_t a = 0; a < value.size(); ++a) out[a] += heat * value[a];
  }

  UnknownLayout layout(std::size_t n, std::size_t) const override { return {1, n}; }
  void set_right_side(const FrameField& U, Index vertex, std::span<const double> rho, double* right_side,
                      std::size_t n) const override {
    U.to_source(vertex, rho.data(), right_side + vertex, n);
  }
  void solve(const HeatOperators& operators, std::span<double> X, std::size_t sources,
             unsigned threads) const override {
    operators.solve_scalar(X, static_cast<Index>(sources) * operators.dimension(), threads);
  }
  void add_pairs(const Star& star, std::span<const double> factors, std::span<const double> values,
                 double* pairs) const override {
    const auto d = static_cast<std::size_t>(star.dimension);
    for (std::size_t k = 0; k < star.degree(); ++k)
      for (std::size_t c = 0; c < d; ++c)
        for (std::size_t a = 0; a < d; ++a) pairs[c * d + a] += factors[k] * star.logs[k * d + c] * values[k * d + a];
  }
  double sum_of_pairs(const FrameField& U, Index i, std::span<const double> pairs) const override {
    Scratch axes(pairs.size());
    U.axes(i, axes.data());
    return dot(axes.span(), pairs);
  }
  void radial(const FrameField& U, Index vertex, std::span<const double> solution, std::size_t n,
              double* out) const override {
    const std::size_t d = solution.size() / n;
    Scratch x(d), axes(d * d);
    read(U, vertex, solution, n, x.data());
    U.axes(vertex, axes.data());
    for (std::size_t c = 0; c < d; ++c) out[c] = dot(std::span<const double>(axes.data() + c * d, d), x.span());
  }
  void read(const FrameField&, Index vertex, std::span<const double> solution, std::size_t n,
            double* out) const override {
    for (std::size_t a = 0; a * n < solution.size(); ++a) out[a] = solution[a * n + vertex];
  }
};

}  // namespace

const VariantSystem& adaptive_system() {
  static const Adaptive system;
  return system;
}

}  // namespace ahm
