#pragma once

#include <optional>
#include <string>
#include <utility>

namespace kith {

/// A result, or the reason why there is none: "a cell without observations",
/// "no spread within the groups". Statistics never return NaN.
template <typename T>
class Estimable {
 public:
  Estimable(T value) : value_{std::move(value)} {}  // NOLINT(google-explicit-constructor): a value is an answer
  [[nodiscard]] static Estimable impossible(const std::string& reason) {
    Estimable result;
    result.reason_ = reason;
    return result;
  }

  [[nodiscard]] explicit operator bool() const noexcept { return value_.has_value(); }
  [[nodiscard]] bool has_value() const noexcept { return value_.has_value(); }
  /// @pre has_value(). @throws std::bad_optional_access otherwise.
  [[nodiscard]] const T& value() const { return value_.value(); }
  [[nodiscard]] const T& operator*() const { return value_.value(); }
  [[nodiscard]] const T* operator->() const { return &value_.value(); }
  /// Why there is no value; empty if there is one. A clause without capital and full stop.
  [[nodiscard]] const std::string& reason() const noexcept { return reason_; }

 private:
  Estimable() = default;
  std::optional<T> value_;
  std::string reason_;
};

}  // namespace kith
