/// \file
/// Files compressed with gzip.
#pragma once

#include "read/input.hpp"

namespace ahm::io {

bool is_gzip(const Input& in);

/// Puts what a gzip file holds in its place, all members one after the other.
/// @throws IoError when the data is cut short or damaged, or this build is without zlib
/// @throws ResourceExhausted when it would fill more than a third of the memory that is free
void gunzip(Input& in);

}  // namespace ahm::io
