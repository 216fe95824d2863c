/// \file
/// What `ahm logmap` does: the maps of one file, one from each source.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "commands/logmap_options.hpp"

namespace ahm::app {

/// Before the work: whether the files of a map can be written, and are none of the inputs.
/// @throws IoError, InvalidArgument
void check_log_map(const LogmapOptions& options, const std::vector<std::string>& inputs);

/// Does a part of the work, and tells where it fails. @param what  for the message
/// @param alone  whether it is all there is to do: then what it throws is thrown
/// @param tells  else in silence
/// @return whether it was done
bool attempt(const std::string& what, bool alone, const std::function<void()>& work, bool tells = true);

/// Reads one file and makes its maps; the graph is built and factored once for all of them, unless the options make it
/// from the source. With several maps a failure, or the first ten of many, is told and the next one is made.
/// @param maps  of one file, alike but for their sources and outputs
/// @param alone  as for `attempt`
/// @return how many failed
/// @throws Cancelled; what reading and opening throw; where it is alone, what solving and writing throw
std::size_t run_log_maps(const std::vector<LogmapOptions>& maps, bool alone);

}  // namespace ahm::app
