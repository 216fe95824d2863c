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
  std::string_view name() const noexcept override { return "adaptive"; }

  void add_sample(double b, std::span<const double>, std::span<const double> z, double* out) const override {
    for (std::size_t a = 0; a < z.size(); ++a) out[a] += b * z[a];
  }
  void add_known(double heat, const Transport&, std::span<const double> value, double* out) const override {
    for (std::size_t a = 0; a < value.size(); ++a) out[a] += heat * value[a];
  }

  std::size_t place(std::size_t i, std::size_t a, std::size_t n, std::size_t) const override { return a * n + i; }
  void put(const FrameField& U, Index vertex, std::span<const double> rho, double* right_side,
           std::size_t n) const override {
    U.to_source(vertex, rho.data(), right_side + vertex, n);
  }
  void solve(const HeatOperators& operators, std::span<double> X, std::size_t sources) const override {
    operators.solve_scalar(X, static_cast<Index>(sources) * operators.dimension());
  }
  void add_pair(double factor, std::span<const double> e, const Transport&, std::span<const double> value,
                double* pairs) const override {
    for (std::size_t c = 0; c < e.size(); ++c)
      for (std::size_t a = 0; a < e.size(); ++a) pairs[c * e.size() + a] += factor * e[c] * value[a];
  }
  double paired(const FrameField& U, Index i, std::span<const double> pairs) const override {
    Scratch axes(pairs.size());
    U.axes(i, axes.data());
    return dot(axes.span(), pairs);
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
