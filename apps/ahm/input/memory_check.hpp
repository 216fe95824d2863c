/// \file
/// What is known not to fit into memory, before it is taken.
#pragma once

#include <string>

#include "cli/journal.hpp"

namespace ahm::app {

/// Control groups end what takes more than they allow without a word.
/// @param what   takes so much, in the words of the message: "the map"
/// @param bytes  at the peak, of the whole process; known to a third
/// @throws ResourceExhausted where that is too much all the same; else, where it may be, a warning goes to the journal
void check_memory(const std::string& what, double bytes, Journal& journal);

}  // namespace ahm::app
