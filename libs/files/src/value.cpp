#include "kith/files/value.hpp"

#include <algorithm>
#include <cmath>

namespace kith {

TomlTable::TomlTable() = default;
TomlTable::TomlTable(const TomlTable&) = default;
TomlTable::TomlTable(TomlTable&&) noexcept = default;
TomlTable& TomlTable::operator=(const TomlTable&) = default;
TomlTable& TomlTable::operator=(TomlTable&&) noexcept = default;
TomlTable::~TomlTable() = default;

bool TomlTable::empty() const noexcept { return entries_.empty(); }

const TomlEntry* TomlTable::find_entry(std::string_view key) const noexcept {
  const auto it = std::find_if(entries_.begin(), entries_.end(), [&](const TomlEntry& e) { return e.key == key; });
  return it == entries_.end() ? nullptr : &*it;
}

const TomlValue* TomlTable::find(std::string_view key) const noexcept {
  const TomlEntry* entry = find_entry(key);
  return entry == nullptr ? nullptr : &entry->value;
}

TomlValue* TomlTable::find(std::string_view key) noexcept {
  const auto it = std::find_if(entries_.begin(), entries_.end(), [&](const TomlEntry& e) { return e.key == key; });
  return it == entries_.end() ? nullptr : &it->value;
}

void TomlTable::set(TomlEntry entry) {
  const auto it =
      std::find_if(entries_.begin(), entries_.end(), [&](const TomlEntry& e) { return e.key == entry.key; });
  if (it == entries_.end()) {
    entries_.push_back(std::move(entry));
  } else {
    *it = std::move(entry);
  }
}

void TomlTable::append(TomlEntry entry) { entries_.push_back(std::move(entry)); }

bool operator==(const TomlTable& a, const TomlTable& b) {
  if (a.entries().size() != b.entries().size()) return false;
  return std::all_of(a.entries().begin(), a.entries().end(), [&](const TomlEntry& entry) {
    const TomlValue* other = b.find(entry.key);
    return other != nullptr && entry.value == *other;
  });
}

bool operator==(const TomlValue& a, const TomlValue& b) {
  if (a.real() != nullptr && b.real() != nullptr) {
    return *a.real() == *b.real() || (std::isnan(*a.real()) && std::isnan(*b.real()));
  }
  return a.content_ == b.content_;
}

std::string_view TomlValue::kind_name() const noexcept {
  static constexpr std::string_view kNames[] = {"a boolean", "an integer", "a real number", "a string",
                                                "a date",    "an array",   "a table"};
  return kNames[content_.index()];
}

}  // namespace kith
