/// \file
/// What the two factored operators give besides log maps (the vector heat method [SSC19]), on every backend.
///
/// \code
/// auto frame = ahm::parallel_transport(solver, ahm::Source::at_vertex(ahm::Vertex{3}));  // frame of 3, carried everywhere
/// auto blend = ahm::extend_scalar(solver, std::array{ahm::Vertex{3}, ahm::Vertex{9}}, std::array{0.0, 1.0});
/// \endcode
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ahm/maps/log_map_solver.hpp"

namespace ahm {

/// A value per vertex with a status; `values` is n x `width`, row major, NaN exactly where the status is not ok.
struct VertexField {
  int width = 1;
  std::vector<double> values;
  std::vector<Status> status;
};

/// Extends scalars given at vertices to all others: each takes the value of the nearest one, blended at ties ([SSC19]
/// Sec. 4).
/// @throws InvalidArgument (empty, lengths, index, value not finite)
VertexField extend_scalar(const LogMapSolver& solver, std::span<const Vertex> vertices, std::span<const double> values);

/// The same of values given at points anywhere, each of which takes part with the weights of its source.
/// @throws InvalidArgument (as above; a source that does not fit the graph)
VertexField extend_scalar(const LogMapSolver& solver, std::span<const Source> points, std::span<const double> values);

/// Carries one vector per given vertex along shortest geodesics to all others ([SSC19] Alg. 1): direction by B, length by
/// A.
/// @param vectors  one per vertex, d numbers in its frame
/// @return width d, components in the frame of each vertex
VertexField transport_vectors(const LogMapSolver& solver, std::span<const Vertex> vertices,
                              std::span<const double> vectors);

/// The same of vectors at points anywhere.
/// @param vectors  one per point, d numbers in the axes of its source
/// @throws InvalidArgument (as `extend_scalar`)
VertexField transport_vectors(const LogMapSolver& solver, std::span<const Source> points,
                              std::span<const double> vectors);

/// The source's orthonormal frame carried to every vertex (Eq. 11 and 12). Width d x d, row major: column a is source
/// axis a in the frame of the vertex. `MapOptions::frames` keeps the same frames beside a map that is solved for anyway;
/// this solves for no map, and tells where frames can be trusted.
/// @param threads  0: one per core; none: the solver's
/// @throws InvalidArgument when the source does not fit the graph; as `LogMapSolver::operators`
VertexField parallel_transport(const LogMapSolver& solver, const Source& source, std::optional<unsigned> threads = {});

/// Y / lambda of Alg. 1: half the gradient of the squared distance, i.e. minus the log map of the source seen from each
/// vertex (Lemma 1). Width d, components in the frame of each vertex, world units.
/// @param threads  0: one per core; none: the solver's
/// @throws InvalidArgument when the source does not fit the graph; as `LogMapSolver::operators`
VertexField radial_field(const LogMapSolver& solver, const Source& source, std::optional<unsigned> threads = {});

}  // namespace ahm
