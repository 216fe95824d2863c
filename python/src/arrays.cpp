#include "arrays.hpp"

namespace ahm::python {
namespace {

template <class T, class Array>
std::span<const T> span_of(const Array& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

}  // namespace

py::array array_over(const py::dtype& type, const Shape& shape, const void* data, std::shared_ptr<const void> owner,
                     bool writable) {
  auto* held = new std::shared_ptr<const void>(std::move(owner));
  const py::capsule base(held, [](void* p) { delete static_cast<std::shared_ptr<const void>*>(p); });
  py::array result(type, shape, data, base);
  if (!writable) result.attr("flags").attr("writeable") = false;
  return result;
}

std::span<const Vec3> vectors(const Doubles& array) {
  if (array.ndim() != 2 || array.shape(1) != 3) throw py::value_error("expected an array of shape (n, 3)");
  return {reinterpret_cast<const Vec3*>(array.data()), static_cast<std::size_t>(array.shape(0))};
}

std::span<const double> numbers(const Doubles& array) { return span_of<double>(array); }
std::span<const Index> numbers(const Indices& array) { return span_of<Index>(array); }
std::span<const Offset> numbers(const Offsets& array) { return span_of<Offset>(array); }
std::span<const std::uint8_t> numbers(const Bytes& array) { return span_of<std::uint8_t>(array); }

std::vector<Vertex> vertices(const Indices& array) {
  std::vector<Vertex> result;
  for (Index i : numbers(array)) result.emplace_back(i);
  return result;
}

}  // namespace ahm::python
