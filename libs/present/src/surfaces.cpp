#include "kith/present/surfaces.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace kith {
namespace {

// Given out in this order.
constexpr std::array<std::string_view, 8> kTintNames{"brown", "blue",   "green", "purple",
                                                     "grey",  "orange", "red",   "yellow"};
constexpr std::array<std::string_view, 4> kPatternNames{"dots", "lines", "cross", "waves"};
constexpr std::array<std::pair<std::string_view, std::string_view>, 16> kTintsOfNames{{{"hole", "dark"},
                                                                                       {"pit", "dark"},
                                                                                       {"cliff", "dark"},
                                                                                       {"rubble", "brown"},
                                                                                       {"mud", "brown"},
                                                                                       {"fence", "brown"},
                                                                                       {"path", "yellow"},
                                                                                       {"sand", "yellow"},
                                                                                       {"grass", "green"},
                                                                                       {"bush", "green"},
                                                                                       {"water", "blue"},
                                                                                       {"ice", "blue"},
                                                                                       {"smoke", "grey"},
                                                                                       {"fire", "red"},
                                                                                       {"lava", "red"},
                                                                                       {"heat", "orange"}}};

// The tint that a name asks for; empty: none.
std::string_view tint_named(std::string_view name) {
  const auto own = std::find(kTintNames.begin(), kTintNames.end(), name);
  if (own != kTintNames.end()) return *own;
  const auto named =
      std::find_if(kTintsOfNames.begin(), kTintsOfNames.end(), [&](const auto& one) { return one.first == name; });
  return named == kTintsOfNames.end() ? std::string_view{} : named->second;
}

bool any_has(const std::vector<Surface>& surfaces, std::string_view tint, std::string_view pattern = {}) {
  return std::any_of(surfaces.begin(), surfaces.end(), [&](const Surface& one) {
    return one.tint == tint && (pattern.empty() || one.pattern == pattern);
  });
}

}  // namespace

std::vector<Surface> surfaces_of(const GridMap& map) {
  std::vector<Surface> surfaces;
  for (const auto& entry : map.legend()) {
    const auto& name = entry.content.terrain;
    const bool is_known =
        std::any_of(surfaces.begin(), surfaces.end(), [&](const auto& one) { return one.name == name; });
    if (name.empty() || is_known) continue;
    const auto number = surfaces.size();
    auto tint = tint_named(name);
    if (tint.empty() || any_has(surfaces, tint)) {
      const auto unused = std::find_if(kTintNames.begin(), kTintNames.end(),
                                       [&](std::string_view one) { return !any_has(surfaces, one); });
      tint = unused == kTintNames.end() ? kTintNames[number % kTintNames.size()] : *unused;
    }
    auto pattern = kPatternNames[number % kPatternNames.size()];
    for (std::size_t i = 1; i < kPatternNames.size() && any_has(surfaces, tint, pattern); ++i) {
      pattern = kPatternNames[(number + i) % kPatternNames.size()];
    }
    surfaces.push_back({name, tint, pattern});
  }
  return surfaces;
}

}  // namespace kith
