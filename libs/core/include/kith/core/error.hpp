#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kith/core/diagnostic.hpp"

namespace kith {

/// Why an operation on the outside world, or on a file that a person wrote,
/// could not be done. The values are the exit codes of the command line.
enum class ErrorKind : int {
  kUsage = 2,
  kInvalidInput = 3,
  kInfeasible = 4,
  kIo = 5,
  kPartial = 6,
  kMismatch = 7,
  kBusy = 8,
};

/// Thrown when the outside world or an input fails us. Broken preconditions
/// throw std::invalid_argument; our own bugs std::logic_error.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : Error{kind, message, {}} {}
  Error(ErrorKind kind, const std::string& message, std::vector<Diagnostic> diagnostics)
      : std::runtime_error{message}, kind_{kind}, diagnostics_{std::move(diagnostics)} {}

  /// Invalid or, if every error is, infeasible input, described by its
  /// diagnostics; what() is their text, without the last line break.
  explicit Error(std::vector<Diagnostic> diagnostics);

  [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }
  [[nodiscard]] int exit_code() const noexcept { return static_cast<int>(kind_); }
  [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const noexcept { return diagnostics_; }

 private:
  ErrorKind kind_;
  std::vector<Diagnostic> diagnostics_;
};

}  // namespace kith
