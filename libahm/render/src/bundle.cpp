#include "bundle.hpp"

#include <cstring>

namespace ahm::render {
namespace {

std::size_t up_to_four(std::size_t n) { return (n + 3) / 4 * 4; }

}  // namespace

void Bundle::add(const char* name, const char* type, const void* data, std::size_t bytes, std::size_t width) {
  arrays_[name] = {{"type", type}, {"at", data_.size()}, {"count", bytes / width}};
  const std::size_t begin = data_.size();
  data_.resize(up_to_four(begin + bytes));
  if (bytes > 0) std::memcpy(data_.data() + begin, data, bytes);
}

std::string Bundle::finish(nlohmann::json meta) && {
  meta["arrays"] = std::move(arrays_);
  std::string text = meta.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  text.resize(up_to_four(text.size()), ' ');
  const auto length = static_cast<std::uint32_t>(text.size());
  std::string out = "AHM1";
  out.append(reinterpret_cast<const char*>(&length), sizeof length);
  return out.append(text).append(data_);
}

}  // namespace ahm::render
