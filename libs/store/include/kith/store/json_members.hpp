#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "kith/explain/json.hpp"

// Members of objects that may hold anything.
namespace kith {

// Empty if there is no such text.
[[nodiscard]] inline std::string text_at(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

// 0 if there is no such number.
[[nodiscard]] inline std::size_t count_at(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_number_unsigned() ? found->get<std::size_t>() : 0;
}

}  // namespace kith
