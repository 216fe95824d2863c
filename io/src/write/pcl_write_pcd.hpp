/// \file
/// PCD files through PCL, whose headers stay out of this one.
#pragma once

#include "write/writers.hpp"

namespace ahm::io {

void write_pcd(AtomicFile& file, const Table& table);

}  // namespace ahm::io
