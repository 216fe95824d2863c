/// \file
/// What a subcommand found at every row of the input, as a table and as a picture.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/io/write.hpp"
#include "ahm/render/picture.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// Before the work: whether --output, --view and --json can be written.
/// @param endings  that --output may have; none: those of tables
/// @throws IoError, InvalidArgument
void check_results(const std::string& input, const OutputOptions& output, const std::vector<std::string>& endings = {});

/// Warns where many rows have no number.
void comment_on_statuses(const std::vector<Status>& status, const std::string& input, Journal& journal);

/// How many mapped rows have a quality below `trusted_quality`. @param quality  by row; NaN does not count
std::ptrdiff_t untrusted(const std::vector<double>& quality);

/// The share of the mapped rows that are not: "quality above 0.5 at 97.20 % of the mapped vertices".
std::string quality_as_text(const std::vector<double>& quality);

/// Warns where more than a fifth of the mapped rows lie below `trusted_quality`.
/// @param quality  by row; NaN does not count
/// @param advice   what to do about it in this subcommand
void comment_on_quality(const std::vector<double>& quality, std::string_view advice, Journal& journal);

/// What a column of the input is called in outputs: as it was, or input_NAME beside a column of our own.
std::string input_column(const std::string& name);

/// The points, faces and further columns of the input, with these normals and colors (empty: none). All has to outlive
/// the table.
io::Table table_of(const io::Geometry& input, const std::vector<Vec3>& normals,
                   const std::vector<std::array<std::uint8_t, 3>>& colors);

/// The columns of a map: u, v, distance, angle (not from a curve), status, quality, spread, error_estimate (of polar maps).
void add_map(io::Table& table, const RowLogMap& rows, const std::vector<double>& quality);

/// What a picture shows of a cloud: the points that its graph has, NaN in place of the others, which lie denser and would
/// hide them. Empty: all of the input is shown, as it is where there are faces; with --local what lies around the map, too.
/// @param options  that the input was opened with
std::vector<Vec3> drawn_points(const Input& input, const InputOptions& options);

/// The files of a run.
class Results {
 public:
  /// @param output, input  must outlive the results. @param options  that the input was opened with
  Results(const OutputOptions& output, const Input& input, const InputOptions& options);
  Results(const Results&) = delete;
  Results& operator=(const Results&) = delete;

  /// With the points, normals and faces of the input, the rest to be filled in.
  io::Table table() const;
  /// Likewise, with a title.
  render::Scene scene() const;
  /// A map from a source. What is given must outlive the scene.
  render::Scene scene(const RowLogMap& rows, const std::vector<double>& quality, const SurfaceSource& source) const;
  /// Writes --view where it was asked for.
  void write_view(const render::Scene& scene, Journal& journal, const render::PictureOptions& picture = {});
  /// Likewise, and --output.
  void write(const io::Table& table, const render::Scene& scene, Journal& journal,
             const render::PictureOptions& picture = {});

 private:
  const OutputOptions& output_;
  const io::Geometry& input_;
  std::string title_;
  unsigned threads_;
  std::vector<Vec3> normals_;           ///< empty where nothing shows them
  std::vector<Vec3> drawn_;             ///< `drawn_points`
  std::vector<Offset> triangle_begin_;  ///< of the triangles between these; empty: discs are drawn
  std::vector<Index> triangle_rows_;
};

}  // namespace ahm::app
