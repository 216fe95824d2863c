/// \file
/// Small steps that several methods share.
#pragma once

#include <Eigen/Dense>
#include <limits>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/heat/heat_operators.hpp"

namespace ahm::methods {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Heat at a source, and the smallest heat of a vertex that counts as reached; both are far from the limits of double
/// precision.
constexpr double source_heat = 0x1p900;
constexpr double least_heat = 0x1p-60;

/// @throws InvalidArgument (a source that is not a vertex)
void check_source(Index source, Index size);

/// R_ji x: a vector x at the neighbor j across edge `edge` of the star of i, in frame i.
void carry_here(const TangentGraph& graph, const Star& star, std::size_t edge, const double* there, double* here);
/// R_ji^-1 x: a vector x at i, in the frame of that neighbor.
void carry_there(const TangentGraph& graph, const Star& star, std::size_t edge, const double* here, double* there);

/// Length |e_ij| of an edge.
double log_length(const Star& star, std::size_t edge);

/// Heat from the vertex `source`: A^-1 delta.
std::vector<double> scalar_heat(const HeatOperators& heat, Index source);

/// The unit normals of a small circle (sphere) around the source, as a right-hand side for B: at every neighbor j the
/// direction e_pj / |e_pj| transported to j, with the measure w_pj |e_pj| of the dual face between them.
void add_outward_circle(const TangentGraph& graph, Index source, std::span<double> field);

/// Normalizes every vector; zero where its length is below `least_heat`.
void normalize(std::span<double> field, int dimension);

/// The gradient of a function over the star of a vertex: a least-squares fit to the slopes along its edges. It is exact for
/// linear functions on any flat star that spans R^d. Otherwise it is the smallest such gradient.
class StarGradient {
 public:
  explicit StarGradient(int dimension);

  /// The gradient of a function with these increments along the edges; an increment that is not finite is ignored.
  const Eigen::VectorXd& fit(const Star& star, std::span<const double> increments);
  /// Column e is the gradient per increment along edge e.
  Eigen::MatrixXd coefficients(const Star& star);

 private:
  template <class Use>
  void factor(const Star& star, const Use& use);

  Eigen::MatrixXd normal_;
  Eigen::VectorXd slopes_, gradient_;
  Eigen::LDLT<Eigen::MatrixXd> factors_;
};

/// Distances f - f[source] in world units, NaN where `reached` is false.
template <class Reached>
std::vector<double> distances_from(std::vector<double> f, Index source, double length_unit, const Reached& reached) {
  const double zero = f[source];
  for (std::size_t i = 0; i < f.size(); ++i) f[i] = reached(i) ? (f[i] - zero) * length_unit : nan;
  return f;
}

}  // namespace ahm::methods
