#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kith/core/diagnostic.hpp"

namespace kith {

/// Why an operation on the outside world, or on a file that a person wrote, could not be done.
enum class ErrorKind {
  kUsage,         ///< What was asked for contradicts itself or what is there.
  kInvalidInput,  ///< A file is not what it should be.
  kInfeasible,    ///< All is well-formed, but it cannot be done.
  kIo,            ///< The system refused: files, memory, other programs.
  kPartial,       ///< Only a part could be done.
  kMismatch,      ///< Data are damaged, or not those that they should be.
  kBusy,          ///< Another process is at it.
};

/// Thrown when the outside world or an input fails us. Broken preconditions
/// throw std::invalid_argument; our own bugs std::logic_error.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : Error{kind, message, std::vector<Diagnostic>{}} {}
  /// With one diagnostic, without a place, that carries the advice.
  Error(ErrorKind kind, const std::string& message, const Advice& advice);
  Error(ErrorKind kind, const std::string& message, std::vector<Diagnostic> diagnostics)
      : std::runtime_error{message}, kind_{kind}, diagnostics_{std::move(diagnostics)} {}

  /// Invalid or, if every error is, infeasible input, described by its
  /// diagnostics; what() is their text, without the last line break.
  explicit Error(std::vector<Diagnostic> diagnostics);

  [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }
  [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const noexcept { return diagnostics_; }
  /// The remedy of the first diagnostic that has one.
  [[nodiscard]] Remedy remedy() const noexcept;

 private:
  ErrorKind kind_;
  std::vector<Diagnostic> diagnostics_;
};

}  // namespace kith
