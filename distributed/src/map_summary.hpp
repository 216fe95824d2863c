/// \file
/// map.json: that a map is finished, and what it is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace ahm::distributed {

/// What map.json of a folder says; no object where there is none.
nlohmann::json read_finished(const std::filesystem::path& folder);
/// Whether the folder has something finished, of this identity.
bool is_finished(const std::filesystem::path& folder, std::uint64_t identity);
/// Written last of all. @throws IoError
void write_finished(const std::filesystem::path& folder, const nlohmann::json& summary);

}  // namespace ahm::distributed
