#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kith {

/// How a non-negative number varies between people: half-normal with this scale, or the same value for everybody.
/// Exactly one of the two is set.
struct Spread {
  std::optional<double> half_normal;  ///< sigma; the mean is sigma * sqrt(2 / pi).
  std::optional<double> value;
  friend bool operator==(const Spread&, const Spread&) = default;
};

using ParameterValue = std::variant<double, std::int64_t, bool, std::string, Spread>;

/// A parameter of a learner model, a strategy or another row of a registry. It is declared once; study files,
/// manifests, reports, help and docs take its name, type, default and range from here.
struct Parameter {
  std::string_view name;           ///< Key in a study file; "ability.mean" is the key `mean` of the table `ability`.
  ParameterValue default_value{};  ///< Its alternative is the type of the parameter.
  std::string_view description;    ///< One sentence without a full stop.
  double min = 0.0;                ///< Of numbers, and of both numbers of a Spread.
  double max = 1.0;                ///< The same.
  bool min_is_open = false;        ///< Whether `min` itself is out of range.
  bool max_is_open = false;        ///< Whether `max` itself is out of range.
  bool is_required = false;        ///< Whether a study file has to set it.
  std::span<const std::string_view> words{};  ///< Of a string: what it may be.
  std::string_view source{};  ///< Key in docs/references.bib of where the default comes from; may be empty.
};

/// "a number", "a whole number", "true or false", "one of: ...", or "{ half_normal = ... } or { value = ... }".
[[nodiscard]] std::string type_of(const Parameter& parameter);
/// "[0, 1]", "(0.5, 1]"; empty if it has no range. Infinite ends are written as "inf".
[[nodiscard]] std::string range_of(const Parameter& parameter);
/// Whether the parameter can have this value: of its type, in its range, one of its words.
[[nodiscard]] bool is_possible(const Parameter& parameter, const ParameterValue& value);
/// "0.05", "true", "fast", "{ half_normal = 0.05 }": as in a study file, but without quotes.
[[nodiscard]] std::string to_string(const ParameterValue& value);

/// A value for each of some declared parameters.
class ParameterValues {
 public:
  ParameterValues() = default;
  /// The defaults. `declared` has to stay, as built-in declarations do; names are compared by what they say.
  explicit ParameterValues(std::span<const Parameter> declared);

  /// @throws kith::Error (kInvalidInput) with the name and the range if the value is out of range or of the wrong type;
  /// std::invalid_argument if no such parameter is declared. Whole numbers are numbers, too.
  void set(std::string_view name, ParameterValue value);

  /// @throws std::invalid_argument if there is no parameter of this name and type.
  [[nodiscard]] double real(std::string_view name) const;
  [[nodiscard]] std::int64_t count(std::string_view name) const;
  [[nodiscard]] bool boolean(std::string_view name) const;
  [[nodiscard]] const std::string& word(std::string_view name) const;
  [[nodiscard]] const Spread& spread(std::string_view name) const;

  [[nodiscard]] std::span<const Parameter> declared() const noexcept { return declared_; }
  /// In the order of the declarations.
  [[nodiscard]] const std::vector<ParameterValue>& values() const noexcept { return values_; }
  /// The same values, whoever declared them.
  friend bool operator==(const ParameterValues& a, const ParameterValues& b) { return a.values_ == b.values_; }

 private:
  template <typename T>
  [[nodiscard]] const T& get(std::string_view name) const;

  std::span<const Parameter> declared_;
  std::vector<ParameterValue> values_;
};

}  // namespace kith
