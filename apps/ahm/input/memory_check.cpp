#include "input/memory_check.hpp"

#include <fmt/format.h>

#include "ahm/error.hpp"
#include "ahm/maps/cost.hpp"
#include "cli/system_info.hpp"

namespace ahm::app {

void check_memory(const std::string& what, double bytes, Journal& journal) {
  constexpr double at_least = 0.75;
  const double memory = machine_memory();
  if (!(memory > 0 && bytes > memory)) return;
  const std::string told =
      fmt::format("{} takes about {}, this machine lets it take {}", what,
                  bytes_as_text(static_cast<std::int64_t>(bytes)), bytes_as_text(static_cast<std::int64_t>(memory)));
  if (at_least * bytes > memory)
    throw ResourceExhausted(told + "; thin the input, map what is near (ahm logmap --local), or cut it (ahm-tiles)");
  journal.add_warning(told + ": the system may end it");
}

}  // namespace ahm::app
