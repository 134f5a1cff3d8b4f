#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "kith/core/parameter.hpp"

namespace kith {

/// A value of an enumeration and how files name it.
template <typename Enum>
struct WordFor {
  Enum value;
  std::string_view word;
};
template <typename Enum>
WordFor(Enum, const char*) -> WordFor<Enum>;  // clang 14 finds none by itself

/// The words of an enumeration that files name, specialised beside it: a std::array of WordFor.
template <typename Enum>
inline constexpr int kWordsFor = 0;

/// How files name a value.
template <typename Enum>
[[nodiscard]] constexpr std::string_view word_for(Enum value) {
  for (const auto& word : kWordsFor<Enum>) {
    if (word.value == value) return word.word;
  }
  return {};
}

/// The words alone, as Parameter::words has them.
template <typename Enum>
[[nodiscard]] std::span<const std::string_view> words_for() {
  static constexpr auto kWords = [] {
    std::array<std::string_view, kWordsFor<Enum>.size()> words;
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = kWordsFor<Enum>[i].word;
    return words;
  }();
  return kWords;
}

/// As in Parameter.
struct OptionBounds {
  double min = 0.0;
  double max = 1.0;
  bool min_is_open = false;
  bool max_is_open = false;
};

/// A field of an options struct as a declared parameter: a key of a study file is read, bounded, written and explained
/// by this one row.
template <typename Options>
struct OptionKey {
  Parameter parameter;
  ParameterValue (*get)(const Options& options);
  void (*set)(Options& options, const ParameterValue& value);  ///< The value is one that the parameter can have.
  /// Whether the key is written; null: always.
  bool (*is_written)(const Options& options) = nullptr;
};

namespace detail {

template <typename Object, typename First, typename... Rest>
auto& field_of(Object& object, First first, Rest... rest) {
  if constexpr (sizeof...(rest) == 0) {
    return object.*first;
  } else {
    return field_of(object.*first, rest...);
  }
}

template <typename T>
ParameterValue to_parameter_value(const T& field) {
  if constexpr (std::is_enum_v<T>) {
    return std::string{word_for(field)};
  } else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
    return static_cast<std::int64_t>(field);
  } else {
    return field;
  }
}

template <typename T>
void from_parameter_value(T& field, const ParameterValue& value) {
  if constexpr (std::is_enum_v<T>) {
    for (const auto& word : kWordsFor<T>) {
      if (word.word == std::get<std::string>(value)) field = word.value;
    }
  } else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
    field = static_cast<T>(std::get<std::int64_t>(value));
  } else {
    field = std::get<T>(value);
  }
}

}  // namespace detail

/// The row of a field, or of a field of a field: option_key<TeachingOptions, &TeachingOptions::filter,
/// &FilterOptions::particles>("particles", ...). Type, default and words are those of the field.
template <typename Options, auto... kPath>
[[nodiscard]] OptionKey<Options> option_key(std::string_view name, std::string_view description, OptionBounds in = {},
                                            bool (*is_written)(const Options& options) = nullptr) {
  const Options defaults{};
  using Field = std::remove_cvref_t<decltype(detail::field_of(defaults, kPath...))>;
  Parameter parameter{name,          detail::to_parameter_value(detail::field_of(defaults, kPath...)),
                      description,   in.min,
                      in.max,        in.min_is_open,
                      in.max_is_open};
  if constexpr (std::is_enum_v<Field>) parameter.words = words_for<Field>();
  return {parameter,
          [](const Options& options) { return detail::to_parameter_value(detail::field_of(options, kPath...)); },
          [](Options& options, const ParameterValue& value) {
            detail::from_parameter_value(detail::field_of(options, kPath...), value);
          },
          is_written};
}

}  // namespace kith
