/// \file
/// Lists of sources and of numbers, written after an option or in a file.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "cli/source_spec.hpp"

namespace ahm::app {

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
