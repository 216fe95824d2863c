// Secrets of an address.
#pragma once

#include <string>
#include <string_view>

namespace ahm::viewer {

/// 32 hexadecimal digits from the system's random numbers. @throws Error where it has none
std::string random_token();

/// In a time that does not depend on where they differ.
bool same_secret(std::string_view a, std::string_view b) noexcept;

}  // namespace ahm::viewer
