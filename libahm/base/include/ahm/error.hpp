/// \file
/// The exceptions that libahm throws. Every message names the argument or the element and its index, the value, and what to do.
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
  /// what() returns "problem; remedy". The remedy names functions and options of this library.
  /// @param fault  identifies the error, snake_case, static storage. A program uses it to replace the remedy by its own
  Error(std::string_view fault, const std::string& problem, const std::string& remedy)
      : runtime_error(problem + "; " + remedy), fault_(fault), problem_(problem.size()) {}

  /// Identifier of the error; empty for errors without one.
  std::string_view fault() const noexcept { return fault_; }
  /// what() without the remedy. Errors without a fault return all of what().
  std::string_view problem() const noexcept { return fault_.empty() ? what() : std::string_view(what(), problem_); }

 private:
  std::string_view fault_;
  std::size_t problem_ = 0;
};

/// A graph violates one of the requirements that `validate` checks.
class InvalidGraph : public Error {
 public:
  using Error::Error;
};

/// No graph can be built from the geometry (mesh, point cloud, grid).
class InvalidGeometry : public Error {
 public:
  using Error::Error;
};

/// An argument is outside its documented range.
class InvalidArgument : public Error {
 public:
  using Error::Error;
};

/// An operator is not positive definite, or its factorization is too inaccurate.
class NotPositiveDefinite : public Error {
 public:
  using Error::Error;
};

/// There is not enough memory, or an index type is too small.
class ResourceExhausted : public Error {
 public:
  using Error::Error;
};

/// A file cannot be read or written.
class IoError : public Error {
 public:
  using Error::Error;
};

/// The caller canceled through its stop token.
class Cancelled : public Error {
 public:
  using Error::Error;
};

}  // namespace ahm
