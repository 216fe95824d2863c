/// \file
/// Reads options from a dictionary, whose keys the Python layer has checked. Options that are missing or None keep their defaults.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/heat/heat_options.hpp"
#include "arrays.hpp"

namespace ahm::python {

/// The value of a key; None if the key is missing.
inline py::object value_of(const py::dict& options, const char* key) {
  return options.contains(key) ? py::object(options[key]) : py::object(py::none());
}

/// Reads an option. @return whether it was present and not None
template <class T>
bool read(const py::dict& options, const char* key, T& value) {
  const py::object given = value_of(options, key);
  if (given.is_none()) return false;
  value = given.cast<T>();
  return true;
}

/// Reads an option that is one of several words.
/// @throws InvalidArgument (another word; the message lists the choices)
template <class T>
void read_choice(const py::dict& options, const char* key, T& value,
                 const std::vector<std::pair<std::string, T>>& choices) {
  std::string word, known;
  if (!read(options, key, word)) return;
  for (const auto& [name, choice] : choices) {
    if (word == name) {
      value = choice;
      return;
    }
    known += (known.empty() ? "'" : ", '") + name + "'";
  }
  throw InvalidArgument(std::string(key) + ": '" + word + "' is not one of " + known);
}

HeatOptions heat_options(const py::dict& options);
void read_variant(const py::dict& options, Variant& variant);

}  // namespace ahm::python
