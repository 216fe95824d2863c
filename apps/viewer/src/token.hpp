// The secret token in the server's address.
#pragma once

#include <string>
#include <string_view>

namespace ahm::viewer {

/// 32 random hexadecimal digits from the system. @throws Error if the system returns no random numbers
std::string random_token();

/// Compares two strings, in a time that does not depend on the position of the first difference.
bool same_secret(std::string_view a, std::string_view b) noexcept;

}  // namespace ahm::viewer
