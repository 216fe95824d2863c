/// \file
/// Numbers as people type them, with a point whatever the locale, parsed strictly: the whole text, finite, in range.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "ahm/types.hpp"

namespace ahm::app {

/// A finite number.
/// @throws std::invalid_argument saying what is wrong with the text
double parse_number(std::string_view text);

/// A finite number > 0.
/// @throws std::invalid_argument
double parse_positive(std::string_view text);

/// A finite number of degrees, as radians.
/// @throws std::invalid_argument
double parse_degrees(std::string_view text);

/// A whole number in [low, high].
/// @throws std::invalid_argument
std::int64_t parse_integer(std::string_view text, std::int64_t low,
                           std::int64_t high = std::numeric_limits<Index>::max());

/// Finite numbers separated by commas, one at the least.
/// @throws std::invalid_argument
std::vector<double> parse_numbers(std::string_view text);

/// Three finite numbers separated by commas.
/// @throws std::invalid_argument
Vec3 parse_triple(std::string_view text);

/// Three finite numbers separated by commas, not all zero.
/// @throws std::invalid_argument
Vec3 parse_direction(std::string_view text);

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

/// For options that take a file alone.
/// @param what  stands in it
/// @throws std::invalid_argument where there is none of this name
void require_file(const std::string& path, const std::string& what);

/// Calls `parse` with every line of a file but empty ones and those that begin with #.
/// @param name  of the file, for messages
/// @param what  is listed, likewise: "entries"
/// @throws InvalidArgument naming the line where `parse` throws std::invalid_argument; where there is none; IoError
void for_each_line(const std::string& path, const std::string& name, const std::string& what,
                   const std::function<void(const std::string&)>& parse);

/// The files that `for_each_line` has read: no output may take their place.
const std::vector<std::string>& lists_read();

/// Sources as in `parse_source`: separated by blanks, or in the file of this name, one per line, where a position may
/// also stand as three numbers between blanks. In files empty lines and those that begin with # do not count.
/// @throws std::invalid_argument (a list), InvalidArgument naming file and line, IoError
std::vector<SourceSpec> parse_sources(const std::string& text);

/// Numbers, separated by blanks or in a file, one per line. @throws as `parse_sources`
std::vector<double> parse_weights(const std::string& text);

/// Points of the (u, v) plane: u,v separated by blanks, or one per line of a file, where they may also be written as two
/// numbers between blanks. @throws as `parse_sources`
std::vector<std::array<double, 2>> parse_plane_points(const std::string& text);

/// Checks that the input has such a vertex or face, and the position of the source, as it was written.
/// @param option  for messages, "--source"
/// @throws InvalidArgument
Vec3 position_in(const io::Geometry& input, const SourceSpec& spec, const std::string& option);

}  // namespace ahm::app
