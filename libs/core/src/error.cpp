#include "kith/core/error.hpp"

#include <algorithm>

namespace kith {
namespace {

ErrorKind kind_of(const std::vector<Diagnostic>& diagnostics) {
  const bool all_infeasible = std::all_of(diagnostics.begin(), diagnostics.end(), [](const Diagnostic& d) {
    return d.severity == Severity::kWarning || d.infeasible;
  });
  return has_errors(diagnostics) && all_infeasible ? ErrorKind::kInfeasible : ErrorKind::kInvalidInput;
}

std::string text_of(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics) text += to_text(d);
  if (!text.empty()) text.pop_back();  // the last line break: a message ends without one
  return text;
}

}  // namespace

Error::Error(ErrorKind kind, const std::string& message, const Advice& advice)
    : Error{kind, message,
            std::vector<Diagnostic>{{.message = message, .hint = advice.hint, .remedy = advice.remedy}}} {}

Error::Error(std::vector<Diagnostic> diagnostics)
    : std::runtime_error{text_of(diagnostics)}, kind_{kind_of(diagnostics)}, diagnostics_{std::move(diagnostics)} {}

Remedy Error::remedy() const noexcept {
  for (const auto& diagnostic : diagnostics_) {
    if (diagnostic.remedy != Remedy::kNone) return diagnostic.remedy;
  }
  return Remedy::kNone;
}

}  // namespace kith
