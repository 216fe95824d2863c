/// \file
/// What backends ask of the command line and the input: the cheap checks, before any work.
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

/// There are faces, the source fits them, no option for clouds was given.
/// @throws InvalidArgument
void check_mesh_input(const std::string& backend, const io::Geometry& input, const InputOptions& options,
                      const std::optional<SourceSpec>& source);

/// The source is a point, no option for meshes was given.
/// @throws InvalidArgument
void check_cloud_input(const io::Geometry& input, const InputOptions& options, const std::optional<SourceSpec>& source);

/// Control groups end what takes more than they allow without a word.
/// @param what   takes so much, in the words of the message: "the map"
/// @param bytes  at the peak, of the whole process; known to a third
/// @throws ResourceExhausted where that is too much all the same; else, where it may be, a warning goes to the journal
void check_memory(const std::string& what, double bytes, Journal& journal);

/// The input and what a backend made of it.
struct Input {
  io::Geometry geometry;
  const Backend* backend;
  Built built;
  std::optional<RepairedMesh> repaired = {};  ///< the faces of `geometry` are those that remained
  /// With --local of a mesh: the faces of `geometry` that the surface has. None: all.
  std::optional<Surroundings> near = {};
  std::size_t given_faces = 0;       ///< of the file, before the repair
  std::optional<double> voxel = {};  ///< edge length of the cubes of which one point each was kept

  const Surface& surface() const { return *built.surface; }
  const TangentGraph& graph() const { return surface().graph(); }
  std::size_t rows() const { return geometry.points.size(); }
  /// The vertex of a row; of a point that --voxel replaced, that of the nearest one kept, if it is no farther than their
  /// cube is wide. None: what else was left out.
  std::optional<Vertex> vertex_standing_for(Row row) const;
  /// Unit normals per row, NaN where there is none: the surface's, and with --local the mean over the faces that it lacks.
  std::vector<Vec3> normals(unsigned threads = 0) const;
  /// World units.
  double mean_edge_length() const { return graph().mean_edge_length() * graph().length_unit(); }
};

/// What is in the file, or comes on standard input. @throws what the reader throws
io::Geometry read_input(const InputOptions& options);
/// Likewise; warnings go to the journal. @throws InvalidGeometry where there are no points
io::Geometry read_input(const InputOptions& options, Journal& journal);

/// Chooses the backend and builds the graph; warnings go to the journal.
/// @param source  as below
/// @throws what the backend throws
Input open_input(io::Geometry geometry, const InputOptions& options, Journal& journal,
                 const std::optional<SourceSpec>& source = {});

/// Reads the input, chooses the backend and builds the graph; warnings go to the journal.
/// @param source  --source, where the surface is opened for one: it is checked before the graph is built
/// @throws InvalidGeometry where there are no points; what the reader and the backend throw
Input open_input(const InputOptions& options, Journal& journal, const std::optional<SourceSpec>& source = {});

/// The options of a command that names these points.
InputOptions naming(InputOptions options, const std::vector<SourceSpec>& points);

/// The same around the source, as a map of this radius needs it, where that is asked for.
/// @throws InvalidArgument where there is no radius; as above
Input open_around(const InputOptions& options, std::optional<double> radius, Journal& journal,
                  const SourceSpec& source);
/// The options that do so. @throws InvalidArgument
InputOptions around_source(const InputOptions& options, std::optional<double> radius);

/// The point of a surface that the user means: a row, the row nearest to a position, a point in a face.
/// @throws InvalidArgument (a surface without positions)
SurfacePoint point_of(const Input& input, const SourceSpec& spec);

/// A source where the user wants it: at a row, at the row nearest to a position, in a face.
/// @param option  that asked for it, for messages
/// @throws InvalidArgument
SurfaceSource place(const Input& input, const SourceSpec& spec, const std::optional<Vec3>& u_axis = {},
                    const std::string& option = "--source");

/// Checks that the input has such a vertex or face, and the position, as it was written; faces are those of the file.
/// @throws InvalidArgument
Vec3 position_of(const Input& input, const SourceSpec& spec, const std::string& option);

/// The source of --source and --u-axis.
/// @throws InvalidArgument, also where the surface bends alike in all directions, or its directions are noise
SurfaceSource resolve(const SourceOptions& options, const Input& input, unsigned threads);

/// The vertex of the graph at a row of the input or nearest to a position.
/// @throws InvalidArgument, also for a point in a face
Vertex vertex_at(const Input& input, const SourceSpec& spec, const std::string& option);
std::vector<Vertex> vertices_at(const Input& input, const std::vector<SourceSpec>& specs, const std::string& option);

/// Warns of positions that lie far off the surface, in other units, or numbers of rows with commas between them; and of points in
/// faces that lie outside of these, as means of the corners of concave ones may.
/// @param option  that they were given with
void comment_on_positions(const Input& input, std::span<const SourceSpec> specs, const std::string& option,
                          Journal& journal);

}  // namespace ahm::app
