/// \file
/// Results of a subcommand for every row of the input, as a table and as a picture.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/io/write.hpp"
#include "ahm/render/picture.hpp"
#include "ahm/surface/surface_triangles.hpp"
#include "input/open.hpp"
#include "output/output_paths.hpp"

namespace ahm::app {

/// Checks before the work that --output, --view and --json can be written.
/// @param endings  allowed extensions of --output; none: those of tables
/// @param more     other output files
/// @throws IoError, InvalidArgument
void check_results(const std::string& input, const OutputOptions& output, const std::vector<std::string>& endings = {},
                   const std::vector<OutputPath>& more = {});

/// Warns if many rows have no coordinates.
void comment_on_statuses(const std::vector<Status>& status, const std::string& input, Journal& journal);

/// Number of mapped rows with a quality below `reliable_quality`. @param quality  quality of each row; NaN: not mapped
std::ptrdiff_t count_low_quality(const std::vector<double>& quality);

/// Up to which distance the map is reliable, and the share of the mapped rows with a quality above `reliable_quality`, as text: "reliable up
/// to distance 2.71 of 3.11 (quality above 0.5 at 91.63 % of the mapped vertices)".
/// @param reliable  `reliable_distance`
std::string quality_as_text(const std::vector<double>& distances, const std::vector<double>& quality,
                            std::optional<double> reliable);
/// Adds low_quality, the number of such rows, and reliable_distance (null: none) to a summary.
void add_quality(nlohmann::ordered_json& summary, const std::vector<double>& quality, std::optional<double> reliable);

/// Warns if more than a fifth of the mapped rows have a quality below `reliable_quality`.
/// @param quality  quality of each row; NaN: not mapped
/// @param advice   what the user can do in this subcommand
void comment_on_quality(const std::vector<double>& quality, std::string_view advice, Journal& journal);

/// The name of an input column in outputs: NAME, or input_NAME if the program writes a column of that name.
std::string input_column(const std::string& name);

/// A table with the points, faces and additional columns of the input, and these normals and colors (empty: none). All arguments must
/// outlive the table.
io::Table table_of(const io::Geometry& input, const std::vector<Vec3>& normals,
                   const std::vector<std::array<std::uint8_t, 3>>& colors);

/// Adds the columns of a map: u, v, distance, angle (not for curves), status, quality, spread, error_estimate (polar maps), bounded (not
/// for exact maps and curves).
void add_map(io::Table& table, const RowLogMap& rows, const std::vector<double>& quality);

/// The points of a cloud in pictures: positions of its vertices, and NaN for points that filters removed, which would hide the others.
/// Empty: the picture shows the whole input, as for meshes, and without filters also with --local or for files with faces.
/// @param options  options with which the input was opened
std::vector<Vec3> drawn_points(const Input& input, const InputOptions& options);

/// Writes the table and the picture of a run.
class Results {
 public:
  /// @param output, input  must outlive the results
  /// @param options        options with which the input was opened
  Results(const OutputOptions& output, const Input& input, const InputOptions& options);
  Results(const Results&) = delete;
  Results& operator=(const Results&) = delete;

  /// A table with the points, normals and faces of the input. The caller adds its columns.
  io::Table table() const;
  /// A scene with the title, points, normals, colors and faces of the input.
  render::Scene scene() const;
  /// A scene of a map from a source. All arguments must outlive the scene.
  render::Scene scene(const RowLogMap& rows, const std::vector<double>& quality, const SurfaceSource& source) const;
  /// Writes --view if it is set. A failure does not prevent the other outputs (`Journal::add_view_failure`).
  void write_view(const render::Scene& scene, Journal& journal, const render::PictureOptions& picture = {});
  /// Writes --output, and --view if it is set.
  void write(const io::Table& table, const render::Scene& scene, Journal& journal,
             const render::PictureOptions& picture = {});

 private:
  const OutputOptions& output_;
  const io::Geometry& input_;
  std::string title_;
  unsigned threads_;
  std::vector<Vec3> normals_;  ///< empty if no output contains normals
  std::vector<Vec3> drawn_;    ///< `drawn_points`
  bool is_cloud_;
  RowFaces triangles_;  ///< triangles between `drawn_`; empty: discs are drawn
};

}  // namespace ahm::app
