/// \file
/// The exceptions libahm throws. Every message names the argument, the element and its index, the value, and what to
/// do.
///
/// \code
/// try {
///   auto map = solver.solve(ahm::Source::at_vertex(ahm::Vertex{42}));
/// } catch (const ahm::InvalidArgument& e) {
///   std::cerr << e.what() << '\n';
/// }
/// \endcode
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace ahm {

/// Base of all exceptions thrown by libahm.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  /// What went wrong, and what to do about it in terms of this library: what() is "problem; remedy".
  /// @param fault  snake_case, static storage: for programs that name another remedy, their own
  Error(std::string_view fault, const std::string& problem, const std::string& remedy)
      : runtime_error(problem + "; " + remedy), fault_(fault), problem_(problem.size()) {}

  /// Empty where the error has no name of its own.
  std::string_view fault() const noexcept { return fault_; }
  /// what() without the remedy of a named fault.
  std::string_view problem() const noexcept { return fault_.empty() ? what() : std::string_view(what(), problem_); }

 private:
  std::string_view fault_;
  std::size_t problem_ = 0;
};

/// A graph breaks one of its laws (see `validate`).
class InvalidGraph : public Error {
 public:
  using Error::Error;
};

/// Geometry (mesh, cloud, grid) that no graph can be built from.
class InvalidGeometry : public Error {
 public:
  using Error::Error;
};

/// An argument outside its documented range.
class InvalidArgument : public Error {
 public:
  using Error::Error;
};

/// An operator is not positive definite, or its factorization failed its own check.
class NotPositiveDefinite : public Error {
 public:
  using Error::Error;
};

/// Memory or an index range does not suffice for the request.
class ResourceExhausted : public Error {
 public:
  using Error::Error;
};

/// A file cannot be read or written.
class IoError : public Error {
 public:
  using Error::Error;
};

/// The caller's stop token asked to stop.
class Cancelled : public Error {
 public:
  using Error::Error;
};

}  // namespace ahm
