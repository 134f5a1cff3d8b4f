#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "kith/live/message.hpp"

namespace kith {

template <typename T>
concept HasMembers = requires {
  T::kMembers;
};
template <typename T>
inline constexpr bool kIsOptional = false;
template <typename T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

// --- reading: a value of a member; false if it is of another type ----------------------------------------------------

template <typename T>
bool read(const Json& json, T& value) {
  if constexpr (std::is_same_v<T, std::string>) {
    if (!json.is_string()) return false;
  } else if constexpr (std::is_same_v<T, bool>) {
    if (!json.is_boolean()) return false;
  } else if constexpr (std::is_integral_v<T>) {
    const bool is_too_large = json.is_number_unsigned() && json.get<std::uint64_t>() > INT64_MAX;
    if (!json.is_number_integer() || is_too_large) return false;
    if (std::is_unsigned_v<T> && json.get<std::int64_t>() < 0) return false;
  }
  value = json.get<T>();
  return true;
}
template <typename T>
bool read(const Json& json, std::optional<T>& value) {
  value.reset();
  return json.is_null() || read(json, value.emplace());
}
template <typename T>
bool read(const Json& json, std::vector<T>& values) {
  if (!json.is_array()) return false;
  for (const auto& element : json) {
    T value{};
    if (!read(element, value)) return false;
    values.push_back(std::move(value));
  }
  return true;
}

// --- limits ----------------------------------------------------------------------------------------------------------

inline bool is_within(bool, const Limits&) { return true; }
inline bool is_within(const Json& value, const Limits& limits) { return limits.fits == nullptr || limits.fits(value); }
inline bool is_within(std::int64_t value, const Limits& limits) {
  return value >= limits.least && value <= limits.most;
}
inline bool is_within(std::size_t value, const Limits& limits) {
  return is_within(static_cast<std::int64_t>(value), limits);
}
// Without control characters but line breaks and tabs. What nlohmann/json parsed is valid UTF-8 already.
inline bool is_within(const std::string& text, const Limits& limits) {
  if (text.size() < limits.shortest || text.size() > limits.longest) return false;
  return std::none_of(text.begin(), text.end(), [&](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\t' && (c != '\n' || limits.is_one_line)) || byte == 0x7F;
  });
}
template <typename T>
bool is_within(const std::optional<T>& value, const Limits& limits) {
  return !value || is_within(*value, limits);
}
template <typename T>
bool is_within(const std::vector<T>& values, const Limits& limits) {
  return std::all_of(values.begin(), values.end(), [&](const T& value) { return is_within(value, limits); });
}

/// A value of anybody, if it is of this type and within the limits.
template <typename T>
[[nodiscard]] std::optional<T> read_within(const Json& json, const Limits& limits) {
  T value{};
  return read(json, value) && is_within(value, limits) ? std::optional{std::move(value)} : std::nullopt;
}

// --- writing ---------------------------------------------------------------------------------------------------------

template <typename T>
bool is_unset(const T& value) {
  if constexpr (std::equality_comparable<T>) {
    return value == T{};
  } else {
    return false;
  }
}
template <typename T>
bool is_unset(const std::optional<T>& value) {
  return !value;
}
template <typename T>
bool is_unset(const std::vector<T>& values) {
  return values.empty();
}
template <typename T>
[[nodiscard]] Json written(const T& value) {
  return value;
}
template <HasMembers T>
[[nodiscard]] Json written(const T& object);
template <typename T>
[[nodiscard]] Json written(const std::optional<T>& value) {
  return value ? written(*value) : Json{};
}
template <typename T>
[[nodiscard]] Json written(const std::vector<T>& values) {
  Json list = Json::array();
  for (const T& value : values) list.push_back(written(value));
  return list;
}
template <HasMembers T>
Json written(const T& object) {
  Json json = Json::object();
  for_each_member(object, [&](const auto& member, const auto& value) {
    if (!member.is_stored() || (member.may_miss && is_unset(value))) return;
    auto one = written(value);
    if (!member.name.empty()) {
      json[std::string{member.name}] = std::move(one);
    } else if (!one.is_null()) {
      json.update(one);
    }
  });
  return json;
}
}  // namespace kith
