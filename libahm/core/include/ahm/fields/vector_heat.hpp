/// \file
/// Other quantities from the two factored operators (the vector heat method [SSC19]), on every backend.
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

/// A value and a status per vertex. `values` is n x `width`, row major; NaN exactly where the status is not ok.
struct VertexField {
  int width = 1;
  std::vector<double> values;
  std::vector<Status> status;
};

/// Extends scalars from some vertices to all others. Each vertex gets the value of the nearest one, blended at ties ([SSC19] Sec. 4).
/// @throws InvalidArgument (empty, lengths, index, value not finite)
VertexField extend_scalar(const LogMapSolver& solver, std::span<const Vertex> vertices, std::span<const double> values);

/// Extends scalars from points anywhere on the surface. Each point contributes with the weights of its source.
/// @throws InvalidArgument (empty, lengths, index, value not finite; a source that does not fit the graph)
VertexField extend_scalar(const LogMapSolver& solver, std::span<const Source> points, std::span<const double> values);

/// Parallel transports vectors from some vertices along shortest geodesic paths to all others ([SSC19] Alg. 1). Solves with B for
/// their directions and with A for their lengths.
/// @param vectors  one per vertex, d numbers in its frame
/// @return width d, components in the frame of each vertex
VertexField transport_vectors(const LogMapSolver& solver, std::span<const Vertex> vertices,
                              std::span<const double> vectors);

/// Parallel transports vectors from points anywhere on the surface.
/// @param vectors  one per point, d numbers in the axes of its source
/// @throws InvalidArgument (as `extend_scalar`)
VertexField transport_vectors(const LogMapSolver& solver, std::span<const Source> points,
                              std::span<const double> vectors);

/// Parallel transports the source's orthonormal frame to every vertex (Eq. 11 and 12). Width d x d, row major: column a is source
/// axis a in the frame of the vertex. `MapOptions::frames` returns the same frames along with a map. This function computes no map,
/// and its status is ok only where the frames are reliable.
/// @param threads  0: one per core; nullopt: the solver's option
/// @throws InvalidArgument when the source does not fit the graph; as `LogMapSolver::operators`
VertexField parallel_transport(const LogMapSolver& solver, const Source& source, std::optional<unsigned> threads = {});

/// Half the gradient of the squared distance, Y / lambda of Alg. 1. This is minus the logarithm of the source at each vertex
/// (Lemma 1). Width d, components in the frame of each vertex, world units.
/// @param threads  0: one per core; nullopt: the solver's option
/// @throws InvalidArgument when the source does not fit the graph; as `LogMapSolver::operators`
VertexField radial_field(const LogMapSolver& solver, const Source& source, std::optional<unsigned> threads = {});

}  // namespace ahm
