#include <string>

#include "ahm/error.hpp"
#include "maps/variants/variant_system.hpp"

namespace ahm {
namespace {

struct Entry {
  Variant variant;
  const VariantSystem& (*system)();
};

constexpr Entry table[] = {
    {Variant::adaptive, adaptive_system},
    {Variant::localized, localized_system},
};

}  // namespace

const VariantSystem& system_of(Variant variant) {
  for (const Entry& entry : table)
    if (entry.variant == variant) return entry.system();
  throw InvalidArgument("variant " + std::to_string(static_cast<int>(variant)) + " is none of ahm::Variant");
}

std::string_view to_string(Variant variant) noexcept {
  for (const Entry& entry : table)
    if (entry.variant == variant) return entry.system().name();
  return "unknown";
}

}  // namespace ahm
