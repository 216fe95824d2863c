/// \file
/// Opens an input: reads it, checks the options, builds the surface, and resolves sources.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "ahm/io/geometry.hpp"
#include "cli/journal.hpp"
#include "cli/options.hpp"
#include "input/backend.hpp"
#include "input/surroundings.hpp"

namespace ahm::app {

/// Checks that the input has faces, that the source fits them, and that there are no options for clouds.
/// @throws InvalidArgument
void check_mesh_input(const std::string& backend, const io::Geometry& input, const InputOptions& options,
                      const std::optional<SourceSpec>& source);

/// Checks that the source is a point, and that there are no options for meshes.
/// @throws InvalidArgument
void check_cloud_input(const io::Geometry& input, const InputOptions& options, const std::optional<SourceSpec>& source);

/// Compares an estimate with the available memory, because control groups kill processes that exceed it without any message. Adds a
/// warning if the memory may not suffice.
/// @param what   name of the work, for the message: "the map"
/// @param bytes  estimated peak of the whole process, accurate to a third
/// @throws ResourceExhausted (even the lower end of the estimate exceeds the memory)
void check_memory(const std::string& what, double bytes, Journal& journal);

/// The input and the surface that a backend built from it.
struct Input {
  io::Geometry geometry;
  const Backend* backend;
  BuiltSurface built;
  std::optional<RepairedMesh> repaired = {};  ///< with a repair; the faces of `geometry` are then those that remain
  /// For meshes with --local: the faces of `geometry` that the surface has. None: all faces.
  std::optional<Surroundings> near = {};
  std::size_t given_faces = 0;       ///< number of faces in the file, before the repair
  std::optional<double> voxel = {};  ///< edge length of the cubes of --voxel

  const Surface& surface() const { return *built.surface; }
  const TangentGraph& graph() const { return surface().graph(); }
  std::size_t rows() const { return geometry.points.size(); }
  /// The vertex of a row. For a point that --voxel replaced, the vertex of the nearest kept point, if it is at most the diagonal of a
  /// cube away. None for other rows without a vertex.
  std::optional<Vertex> vertex_standing_for(Row row) const;
  /// Unit normal of each row, NaN where there is none. With --local, rows outside of the surface get the mean over their faces.
  std::vector<Vec3> normals(unsigned threads = 0) const;
  /// Mean edge length, world units.
  double mean_edge_length() const { return graph().mean_edge_length() * graph().length_unit(); }
};

/// Reads the file or standard input. @throws what the reader throws
io::Geometry read_input(const InputOptions& options);
/// Reads the file or standard input; adds warnings to the journal. @throws InvalidGeometry (no points); what the reader throws
io::Geometry read_input(const InputOptions& options, Journal& journal);

/// Chooses the backend and builds the graph; adds warnings to the journal.
/// @param source  --source of commands with a single source: checked before the graph is built
/// @throws what the backend throws
Input open_input(io::Geometry geometry, const InputOptions& options, Journal& journal,
                 const std::optional<SourceSpec>& source = {});

/// Reads the input, chooses the backend and builds the graph; adds warnings to the journal.
/// @param source  --source of commands with a single source: checked before the graph is built
/// @throws InvalidGeometry (no points); what the reader and the backend throw
Input open_input(const InputOptions& options, Journal& journal, const std::optional<SourceSpec>& source = {});

/// The values of a column of the input, or of x, y or z, one per row.
/// @param option  name of the option, for messages
/// @throws InvalidArgument (no such column)
std::vector<double> column_of(const io::Geometry& geometry, const std::string& name, const std::string& option);

/// The options, with these points added to those named in the command.
InputOptions with_named_points(InputOptions options, const std::vector<SourceSpec>& points);

/// Opens the input; with --local only the surroundings of the source that a map of this radius requires.
/// @throws InvalidArgument (--local without radius); as `open_input`
Input open_around(const InputOptions& options, std::optional<double> radius, Journal& journal,
                  const SourceSpec& source);
/// The options for `open_input`, with the radius of --local if that is set. @throws InvalidArgument (--local without radius)
InputOptions around_source(const InputOptions& options, std::optional<double> radius);

/// The point of the surface for a SPEC: a row, the row nearest to a position, or a point in a face.
/// @throws InvalidArgument (a surface without positions)
SurfacePoint point_of(const Input& input, const SourceSpec& spec);

/// The source for a SPEC: at a row, at the row nearest to a position, or in a face.
/// @param option  name of the option, for messages
/// @throws InvalidArgument
SurfaceSource place(const Input& input, const SourceSpec& spec, const std::optional<Vec3>& u_axis = {},
                    const std::string& option = "--source");

/// The position of a SPEC in space, before projection to the surface. Checks that the input has the vertex or face; faces are
/// numbered as in the file.
/// @throws InvalidArgument
Vec3 position_of(const Input& input, const SourceSpec& spec, const std::string& option);

/// The source for --source and --u-axis.
/// @throws InvalidArgument; with `curvature` also if the surface bends equally in all directions, or its directions are noise
SurfaceSource resolve(const SourceOptions& options, const Input& input, unsigned threads);

/// The vertex of the graph at a row, or nearest to a position.
/// @throws InvalidArgument, also for a point in a face
Vertex vertex_at(const Input& input, const SourceSpec& spec, const std::string& option);
std::vector<Vertex> vertices_at(const Input& input, const std::vector<SourceSpec>& specs, const std::string& option);

/// Warns of positions far off the surface: they are in another unit, or are row numbers separated by commas. Also warns of points in
/// faces that lie outside of the face, as the mean of the corners of a concave face may.
/// @param option  name of the option, for messages
void comment_on_positions(const Input& input, std::span<const SourceSpec> specs, const std::string& option,
                          Journal& journal);

}  // namespace ahm::app
