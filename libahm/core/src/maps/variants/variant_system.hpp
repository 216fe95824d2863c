/// \file
/// What a variant of the method puts into its linear system and reads out of it. All else is common: AffineHeat, March
/// and local maps ask the object, never for its name. A further variant is one file beside these, and its line in
/// ahm/heat/variant.hpp.
#pragma once

#include <span>
#include <vector>

#include "ahm/graph/transport.hpp"
#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/log_map.hpp"
#include "maps/frame_field.hpp"

namespace ahm {

/// Component a of vertex i stands at i * vertex + a * component.
struct UnknownLayout {
  std::size_t vertex, component;
  std::size_t place(std::size_t i, std::size_t a) const { return i * vertex + a * component; }
};

/// The unknown of one source is n vectors of d numbers, laid out as its operator wants them (`layout`).
class VariantSystem {
 public:
  virtual ~VariantSystem() = default;

  /// A sample of the source, heat b at z (d numbers), whose axes are U (d x d, row major): adds to out, d numbers.
  virtual void add_sample(double b, std::span<const double> U, std::span<const double> z, double* out) const = 0;
  /// A vertex of known value (Dirichlet data), seen along R: adds to out, d numbers.
  virtual void add_known(double heat, const Transport& R, std::span<const double> value, double* out) const = 0;

  /// Where the system has the components of the vertices.
  virtual UnknownLayout layout(std::size_t n, std::size_t d) const = 0;
  /// Puts rho of a vertex (Eq. 9, d numbers in its frame) into the right-hand side of one source.
  virtual void put(const FrameField& U, Index vertex, std::span<const double> rho, double* right_side,
                   std::size_t n) const = 0;
  /// X <- solution, for all sources.
  virtual void solve(const HeatOperators& operators, std::span<double> X, std::size_t sources,
                     unsigned threads) const = 0;
  /// The inner products of edges e_ij with the unknowns of their far ends j, which the second moment of i is made of:
  /// adds them, each times its factor, to `pairs` (d x d numbers) as far as they can be told without the frame of i ...
  /// @param values  the unknowns, degree x d
  virtual void add_pairs(const Star& star, std::span<const double> factors, std::span<const double> values,
                         double* pairs) const = 0;
  /// ... and reads the sum with it.
  virtual double paired(const FrameField& U, Index i, std::span<const double> pairs) const = 0;
  /// The unknown of a vertex as a vector in its own frame, d numbers.
  virtual void radial(const FrameField& U, Index vertex, std::span<const double> solution, std::size_t n,
                      double* out) const = 0;
  /// lambda phi of a vertex, d numbers in the source's frame.
  virtual void read(const FrameField& U, Index vertex, std::span<const double> solution, std::size_t n,
                    double* out) const = 0;
};

/// @throws InvalidArgument when it is none of AHM_VARIANTS
const VariantSystem& system_of(Variant variant);

}  // namespace ahm
