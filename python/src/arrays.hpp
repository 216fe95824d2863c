/// \file
/// Conversions between NumPy arrays and the library's vectors, without copies.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::python {

namespace py = pybind11;

// Inputs, which the Python layer has converted to C order and exactly this type. They are never converted here.
using Doubles = py::array_t<double, py::array::c_style>;
using Indices = py::array_t<Index, py::array::c_style>;
using Offsets = py::array_t<Offset, py::array::c_style>;
using Bytes = py::array_t<std::uint8_t, py::array::c_style>;
using Shape = std::vector<py::ssize_t>;

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();  ///< stands for missing values

/// An array that uses the memory at `data`. It keeps `owner` alive, which owns the memory.
py::array array_over(const py::dtype& type, const Shape& shape, const void* data, std::shared_ptr<const void> owner,
                     bool writable);

/// Moves a vector into an array, without a copy. Elements may be arrays of numbers; `shape` counts numbers.
template <class T, class Number = T>
py::array owned(std::vector<T>&& values, const Shape& shape) {
  auto held = std::make_shared<std::vector<T>>(std::move(values));
  const void* data = held->data();
  return array_over(py::dtype::of<Number>(), shape, data, std::move(held), true);
}
template <class T>
py::array owned(std::vector<T>&& values) {
  const auto n = static_cast<py::ssize_t>(values.size());
  return owned<T, T>(std::move(values), {n});
}
inline py::array owned(std::vector<Vec3>&& values) {
  const auto n = static_cast<py::ssize_t>(values.size());
  return owned<Vec3, double>(std::move(values), {n, 3});
}

/// A read-only array over values that `owner` owns.
template <class Number, class T>
py::array viewed(std::span<const T> values, const Shape& shape, std::shared_ptr<const void> owner) {
  return array_over(py::dtype::of<Number>(), shape, values.data(), std::move(owner), false);
}

/// A view of an array of shape (n, 3).
std::span<const Vec3> vectors(const Doubles& array);
std::span<const double> numbers(const Doubles& array);
std::span<const Index> numbers(const Indices& array);
std::span<const Offset> numbers(const Offsets& array);
std::span<const std::uint8_t> numbers(const Bytes& array);
std::vector<Vertex> vertices(const Indices& array);

inline py::ssize_t length(const auto& values) { return static_cast<py::ssize_t>(values.size()); }

}  // namespace ahm::python
