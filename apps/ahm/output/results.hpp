/// \file
/// What a subcommand found at every row of the input, as a table and as a picture.
#pragma once

#include <string>
#include <vector>

#include "ahm/io/write.hpp"
#include "ahm/view/picture.hpp"
#include "input/surface.hpp"
#include "output/map_rows.hpp"

namespace ahm::app {

/// Before the work: whether --output, --view and --json can be written. @throws IoError, InvalidArgument
void check_results(const RunOptions& options);

/// Warns where many rows have no number.
void comment_on_statuses(const std::vector<Status>& status, const std::string& input, Journal& journal);

/// The files of a run: all of them or, after a failure, none.
class Results {
 public:
  /// @param options, surface  must outlive the results
  Results(const RunOptions& options, const Surface& surface);
  ~Results();
  Results(const Results&) = delete;
  Results& operator=(const Results&) = delete;

  /// With the points, normals and faces of the input, the rest to be filled in.
  io::Table table() const;
  /// Likewise, with a title.
  view::Scene scene() const;
  /// Writes --view where it was asked for.
  void write_view(const view::Scene& scene, Journal& journal, const view::PictureOptions& picture = {});
  /// Likewise, and --output.
  void write(const io::Table& table, const view::Scene& scene, Journal& journal,
             const view::PictureOptions& picture = {});
  /// The run has succeeded.
  void keep() { written_.clear(); }

 private:
  const RunOptions& options_;
  const io::Geometry& input_;
  std::vector<Vec3> normals_;
  std::vector<std::string> written_;
};

}  // namespace ahm::app
