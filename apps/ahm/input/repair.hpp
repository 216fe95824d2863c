/// \file
/// Meshes are mended between the reader and the backend.
#pragma once

#include <optional>

#include "ahm/surface/mesh_repair.hpp"
#include "input/backend.hpp"

namespace ahm::app {

/// Mends what the options ask for: the faces of the input become those that remain.
/// @return none where nothing is asked for. @throws InvalidArgument where the input has no faces to mend
std::optional<RepairedMesh> repair(io::Geometry& input, const InputOptions& options);

/// The source in faces of which those are kept, ascending. @throws InvalidArgument where its face is none: `gone`
SourceSpec in_kept_faces(const SourceSpec& spec, const std::vector<Index>& kept, const char* gone);
/// The source in the faces that remain. @throws InvalidArgument where its face was dropped
SourceSpec in_remaining_faces(const SourceSpec& spec, const RepairedMesh& mesh);

/// `backend.build` of a mended input, with the rows that were given.
/// @param source  in the faces that remain. @throws as it
Built build_repaired(const Backend& backend, const io::Geometry& input, RepairedMesh mesh, const InputOptions& options,
                     const std::optional<SourceSpec>& source, const Progress& progress);

}  // namespace ahm::app
