/// \file
/// What a subcommand found at every row of the input, as a table and as a picture.
#pragma once

#include <string>
#include <vector>

#include "ahm/io/write.hpp"
#include "ahm/view/picture.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// Before the work: whether --output, --view and --json can be written.
/// @param endings  that --output may have; none: those of tables
/// @throws IoError, InvalidArgument
void check_results(const std::string& input, const OutputOptions& output, const std::vector<std::string>& endings = {});

/// Warns where many rows have no number.
void comment_on_statuses(const std::vector<Status>& status, const std::string& input, Journal& journal);

/// The files of a run: all of them or, after a failure, none.
class Results {
 public:
  /// @param output, input  must outlive the results
  Results(const OutputOptions& output, const Input& input, const std::string& path);
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
  const OutputOptions& output_;
  const io::Geometry& input_;
  std::string title_;
  std::vector<Vec3> normals_;
  std::vector<std::string> written_;
};

}  // namespace ahm::app
