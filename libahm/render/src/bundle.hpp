// Bundles: a JSON text followed by the arrays that it describes (page.hpp).
#pragma once

#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

namespace ahm::render {

static_assert(std::endian::native == std::endian::little, "bundles are little-endian, and copied from memory");

class Bundle {
 public:
  /// Adds an array. Its elements consist of numbers of one type.
  template <class Number, class Element>
  void add(const char* name, const std::vector<Element>& values) {
    static_assert(sizeof(Element) % sizeof(Number) == 0);
    add(name, type<Number>(), values.data(), values.size() * sizeof(Element), sizeof(Number));
  }
  /// The bundle. @param meta  JSON object
  std::string finish(nlohmann::json meta) &&;

 private:
  template <class Number>
  static constexpr const char* type() {
    if constexpr (std::is_same_v<Number, float>) return "f32";
    if constexpr (std::is_same_v<Number, std::uint8_t>) return "u8";
    if constexpr (std::is_same_v<Number, std::uint16_t>) return "u16";
    if constexpr (std::is_same_v<Number, std::int32_t>) return "i32";
    if constexpr (std::is_same_v<Number, std::uint32_t>) return "u32";
  }
  void add(const char* name, const char* type, const void* data, std::size_t bytes, std::size_t width);

  nlohmann::json arrays_ = nlohmann::json::object();
  std::string data_;
};

}  // namespace ahm::render
