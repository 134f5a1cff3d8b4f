#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace kith {

/// Nothing if this is no whole number or no int: get<int>() converts any number, which is undefined for large ones.
[[nodiscard]] inline std::optional<int> int_of(const nlohmann::json& json) {
  const auto fitting = [](auto number) {
    return std::in_range<int>(number) ? std::optional{static_cast<int>(number)} : std::nullopt;
  };
  if (json.is_number_unsigned()) return fitting(json.get<std::uint64_t>());
  if (json.is_number_integer()) return fitting(json.get<std::int64_t>());
  return std::nullopt;
}

}  // namespace kith
