#include "name_pattern.hpp"

namespace kith::cli {
namespace {

// Its parts between '*', each as early as it can be: whatever follows then has most room.
bool holds(std::string_view alternative, std::string_view name) noexcept {
  while (true) {
    const auto star = alternative.find('*');
    const auto part = alternative.substr(0, star);
    const auto at = name.find(part);
    if (at == std::string_view::npos) return false;
    if (star == std::string_view::npos) return true;
    name.remove_prefix(at + part.size());
    alternative.remove_prefix(star + 1);
  }
}

}  // namespace

bool matches_somewhere(std::string_view pattern, std::string_view name) noexcept {
  while (true) {
    const auto bar = pattern.find('|');
    if (holds(pattern.substr(0, bar), name)) return true;
    if (bar == std::string_view::npos) return false;
    pattern.remove_prefix(bar + 1);
  }
}

}  // namespace kith::cli
