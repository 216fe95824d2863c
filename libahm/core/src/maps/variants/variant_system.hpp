/// \file
/// The linear system of a variant of the method: its right-hand side, its operator, and how coordinates are read from its solution.
/// AffineHeat, March and local maps use this interface only. To add a variant, add a file in this folder and a line in
/// ahm/heat/variant.hpp.
#pragma once

#include <span>
#include <vector>

#include "ahm/graph/transport.hpp"
#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/log_map.hpp"
#include "maps/frame_field.hpp"

namespace ahm {

/// Component a of vertex i is at i * vertex + a * component.
struct UnknownLayout {
  std::size_t vertex, component;
  std::size_t place(std::size_t i, std::size_t a) const { return i * vertex + a * component; }
};

/// The unknown of one source consists of n vectors of d numbers, in the order of its operator (`layout`).
class VariantSystem {
 public:
  virtual ~VariantSystem() = default;

  /// Adds the right-hand side of a sample of the source to out, d numbers. The sample has heat b, position z (d numbers) and axes U (d x d,
  /// row major).
  virtual void add_sample(double b, std::span<const double> U, std::span<const double> z, double* out) const = 0;
  /// Adds the Dirichlet term of a neighbor of known value to out, d numbers. R is the transport from the neighbor.
  virtual void add_known(double heat, const Transport& R, std::span<const double> value, double* out) const = 0;

  /// The positions of the components in the unknown.
  virtual UnknownLayout layout(std::size_t n, std::size_t d) const = 0;
  /// Writes rho of a vertex (Eq. 9, d numbers in its frame) to the right-hand side of one source.
  virtual void set_right_side(const FrameField& U, Index vertex, std::span<const double> rho, double* right_side,
                              std::size_t n) const = 0;
  /// X <- solution, for all sources.
  virtual void solve(const HeatOperators& operators, std::span<double> X, std::size_t sources,
                     unsigned threads) const = 0;
  /// First part of the sum of factor_j <e_ij, unknown_j> over the edges of vertex i, for its second moment: the part that does not
  /// depend on the frame of i. Adds to `pairs`, d x d numbers.
  /// @param values  the unknowns of the neighbors, degree x d
  virtual void add_pairs(const Star& star, std::span<const double> factors, std::span<const double> values,
                         double* pairs) const = 0;
  /// Second part: computes the sum from `pairs` and the frame of i.
  virtual double sum_of_pairs(const FrameField& U, Index i, std::span<const double> pairs) const = 0;
  /// The unknown of a vertex as a vector in its own frame, d numbers.
  virtual void radial(const FrameField& U, Index vertex, std::span<const double> solution, std::size_t n,
                      double* out) const = 0;
  /// lambda phi of a vertex, d numbers in the source's frame.
  virtual void read(const FrameField& U, Index vertex, std::span<const double> solution, std::size_t n,
                    double* out) const = 0;
};

/// The system of a variant. @throws InvalidArgument (not one of AHM_VARIANTS)
const VariantSystem& system_of(Variant variant);

}  // namespace ahm
