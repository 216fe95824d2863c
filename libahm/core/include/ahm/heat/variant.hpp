/// \file
/// The list of variants of the method. Variant NAME is implemented in libahm/core/src/maps/variants/NAME.cpp, by NAME_system().
#pragma once

#define AHM_VARIANTS(NAME)               \
  NAME(adaptive)  /* Alg. 2 of [SS25] */ \
  NAME(localized) /* Alg. 1 of [SS25] */

namespace ahm {

#define AHM_ENUMERATOR(name) name,
enum class Variant { AHM_VARIANTS(AHM_ENUMERATOR) };
#undef AHM_ENUMERATOR

#define AHM_VALUE(name) Variant::name,
inline constexpr Variant all_variants[] = {AHM_VARIANTS(AHM_VALUE)};
#undef AHM_VALUE

}  // namespace ahm
