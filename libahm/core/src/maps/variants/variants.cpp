#include <string>

#include "ahm/error.hpp"
#include "maps/variants/variant_system.hpp"

namespace ahm {

#define AHM_DECLARATION(name) const VariantSystem& name##_system();
AHM_VARIANTS(AHM_DECLARATION)
#undef AHM_DECLARATION

namespace {

struct Entry {
  Variant variant;
  std::string_view name;
  const VariantSystem& (*system)();
};

#define AHM_ENTRY(name) Entry{Variant::name, #name, name##_system},
constexpr Entry table[] = {AHM_VARIANTS(AHM_ENTRY)};
#undef AHM_ENTRY

}  // namespace

const VariantSystem& system_of(Variant variant) {
  for (const Entry& entry : table)
    if (entry.variant == variant) return entry.system();
  throw InvalidArgument("variant " + std::to_string(static_cast<int>(variant)) + " is not a value of ahm::Variant");
}

std::string_view to_string(Variant variant) noexcept {
  for (const Entry& entry : table)
    if (entry.variant == variant) return entry.name;
  return "unknown";
}

}  // namespace ahm
