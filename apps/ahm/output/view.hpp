/// \file
/// The input and the session of `ahm view`, independent of the server. The page in a browser without a server uses them, too.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "ahm/viewer/session.hpp"
#include "cli/options.hpp"
#include "input/open.hpp"

namespace ahm::app {

struct ViewOptions {
  InputOptions input;
  std::optional<SourceSpec> source;  ///< source of the first map; none: in the middle of the picture
  SolveOptions solve;
  bool local = false;                                                          ///< the first maps have a radius
  std::function<void(std::string_view stage, double fraction)> progress = {};  ///< of the requests
};

/// An opened input, and the session that answers the requests of the page.
class View {
 public:
  /// @throws as `open_input`; InvalidArgument (invalid source)
  View(const ViewOptions& options, Journal& journal);
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  const viewer::Session& session() const { return *session_; }
  /// Radius of the first maps, where a map of the whole surface would take long. None: no limit.
  const std::optional<double>& first_radius() const { return first_radius_; }

 private:
  viewer::SessionOptions session_options(const ViewOptions& options) const;

  Input input_;
  std::vector<Vec3> normals_;
  std::optional<double> first_radius_;
  std::optional<viewer::Session> session_;
};

}  // namespace ahm::app
