#include "room_body.hpp"

#include <algorithm>

#include "kith/live/world_json.hpp"

namespace kith {
namespace {

constexpr std::size_t kMostKeys = 2000;
constexpr std::int64_t kMostMs = 86'400'000;

const Json* member_of(const Json& body, std::string_view key) {
  if (!body.is_object()) return nullptr;
  const auto found = body.find(std::string{key});
  return found == body.end() ? nullptr : &*found;
}

}  // namespace

std::optional<std::int64_t> integer_in(const Json& body, std::string_view key, std::int64_t min, std::int64_t max) {
  const auto* value = member_of(body, key);
  if (value == nullptr || !value->is_number_integer()) return std::nullopt;
  if (value->is_number_unsigned() && value->get<std::uint64_t>() > static_cast<std::uint64_t>(INT64_MAX))
    return std::nullopt;
  const auto number = value->get<std::int64_t>();
  if (number < min || number > max) return std::nullopt;
  return number;
}

bool is_clean_text(const std::string& text, std::size_t max) {
  if (text.size() > max) return false;
  const bool has_control = std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7F;
  });
  // What nlohmann/json parsed is valid UTF-8 already.
  return !has_control;
}

std::optional<std::string> text_in(const Json& body, std::string_view key, std::size_t max) {
  const auto* value = member_of(body, key);
  if (value == nullptr || !value->is_string()) return std::nullopt;
  const auto& text = value->get_ref<const std::string&>();
  if (!is_clean_text(text, max)) return std::nullopt;
  return text;
}

std::optional<std::vector<std::size_t>> actions_in(const Json& body) {
  const auto* list = member_of(body, "actions");
  if (list == nullptr || !list->is_array()) return std::nullopt;
  std::vector<std::size_t> actions;
  for (const auto& element : *list) {
    if (!element.is_number_integer() || element.get<std::int64_t>() < 0 || element.get<std::int64_t>() > 1000)
      return std::nullopt;
    actions.push_back(element.get<std::size_t>());
  }
  return actions;
}

std::optional<bool> flag_in(const Json& body, std::string_view key) {
  const auto* value = member_of(body, key);
  if (value == nullptr) return false;
  return value->is_boolean() ? std::optional{value->get<bool>()} : std::nullopt;
}

std::optional<Json> keys_in(const Json& body) {
  const auto* list = member_of(body, "keys");
  if (list == nullptr) return Json::array();
  if (!list->is_array() || list->size() > kMostKeys) return std::nullopt;
  for (const auto& press : *list) {
    if (!press.is_array() || press.size() != 2) return std::nullopt;
    const auto& what = press[0];
    const auto& ms = press[1];
    const bool is_action =
        what.is_number_integer() && what.get<std::int64_t>() >= 0 && what.get<std::int64_t>() <= 1000;
    if (!is_action && what != "undo" && what != "reset") return std::nullopt;
    if (!ms.is_number_integer() || ms.get<std::int64_t>() < 0 || ms.get<std::int64_t>() > kMostMs) return std::nullopt;
  }
  return *list;
}

}  // namespace kith
