/// \file
/// What the user wrote after --source.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::app {

/// `123`: an input vertex.
struct SourceVertex {
  Index index;
};

/// `x,y,z`: the vertex nearest to a position.
struct SourcePosition {
  Vec3 position;
};

/// `face:F:b0,b1,b2...`: a point inside a face.
struct SourceFace {
  Index face;
  std::vector<double> weights;  ///< one per corner, >= 0, with sum 1
};

using SourceSpec = std::variant<SourceVertex, SourcePosition, SourceFace>;

/// Reads one of the three forms.
/// @throws std::invalid_argument saying what is wrong with the text
SourceSpec parse_source(std::string_view text);

/// The spec as text again.
std::string to_string(const SourceSpec& spec);

}  // namespace ahm::app
