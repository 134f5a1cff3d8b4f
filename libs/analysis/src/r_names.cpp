#include "r_names.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

namespace kith {
namespace {

constexpr std::array<std::string_view, 19> kReserved{
    "if",    "else", "repeat", "while", "function", "for",         "in",       "next",        "break",        "TRUE",
    "FALSE", "NULL", "Inf",    "NaN",   "NA",       "NA_integer_", "NA_real_", "NA_complex_", "NA_character_"};

bool is_letter(char c) noexcept { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool is_inner(char c) noexcept { return is_letter(c) || (c >= '0' && c <= '9') || c == '.' || c == '_'; }

bool is_plain(std::string_view name) {
  return !name.empty() && is_letter(name.front()) && std::all_of(name.begin(), name.end(), is_inner) &&
         std::find(kReserved.begin(), kReserved.end(), name) == kReserved.end();
}

std::string plain(const std::string& column) {
  std::string name = column;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !is_inner(c); }, '.');
  if (name.empty() || !is_letter(name.front())) name.insert(0, "x.");
  return is_plain(name) ? name : name + ".";
}

}  // namespace

RNames::RNames(const std::vector<std::string>& columns) {
  std::set<std::string> taken;
  for (const auto& column : columns) {
    if (is_plain(column)) taken.insert(column);
  }
  for (const auto& column : columns) {
    if (names_.count(column) != 0) continue;
    if (is_plain(column)) {
      names_.emplace(column, column);
      continue;
    }
    auto name = plain(column);
    for (std::size_t n = 2; !taken.insert(name).second; ++n) name = plain(column) + "." + std::to_string(n);
    names_.emplace(column, name);
    renamed_.push_back(column);
  }
}

}  // namespace kith
