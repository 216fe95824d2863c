/// \file
/// Repair of meshes, after reading and before the backend.
#pragma once

#include <optional>

#include "ahm/surface/mesh_repair.hpp"
#include "input/backend.hpp"

namespace ahm::app {

/// Applies the repairs of the options. The faces of the input become those that remain.
/// @return none if the options contain no repair. @throws InvalidArgument (no faces), InvalidGeometry (no face remains)
std::optional<RepairedMesh> repair(io::Geometry& input, const InputOptions& options);

/// The source with its face renumbered for the kept faces.
/// @param kept  ascending
/// @param gone  message of the error
/// @throws InvalidArgument (the face is not kept)
SourceSpec in_kept_faces(const SourceSpec& spec, const std::vector<Index>& kept, const char* gone);
/// The source with its face renumbered for the faces that remain after the repair. @throws InvalidArgument (the face was dropped)
SourceSpec in_remaining_faces(const SourceSpec& spec, const RepairedMesh& mesh);

/// Builds the surface of a repaired input (`backend.build`); its rows are those of the input.
/// @param source  its face is numbered among those that remain. @throws as `backend.build`
BuiltSurface build_repaired(const Backend& backend, const io::Geometry& input, RepairedMesh mesh,
                            const InputOptions& options, const std::optional<SourceSpec>& source,
                            const Progress& progress);

}  // namespace ahm::app
