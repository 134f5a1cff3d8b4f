#include "kith/explain/surfaces.hpp"

#include <algorithm>

#include "drawing.hpp"

namespace kith {
namespace {

// The tint that a terrain's name asks for; empty: none.
std::string_view tint_named(std::string_view name) {
  for (const auto& tint : detail::tints()) {
    const bool is_own = tint.name == name && !tint.only_named;
    if (is_own || std::ranges::find(tint.terrains, name) != tint.terrains.end()) return tint.name;
  }
  return {};
}

bool any_has(const std::vector<Surface>& surfaces, std::string_view tint, std::string_view pattern = {}) {
  return std::any_of(surfaces.begin(), surfaces.end(), [&](const Surface& one) {
    return one.tint == tint && (pattern.empty() || one.pattern == pattern);
  });
}

}  // namespace

std::vector<Surface> surfaces_of(const GridMap& map) {
  std::vector<std::string_view> given, patterns;  // in this order
  for (const auto& tint : detail::tints()) {
    if (!tint.only_named) given.push_back(tint.name);
  }
  for (const auto& texture : detail::textures()) patterns.push_back(texture.name);
  std::vector<Surface> surfaces;
  for (const auto& entry : map.legend()) {
    const auto& name = entry.content.terrain;
    const bool is_known =
        std::any_of(surfaces.begin(), surfaces.end(), [&](const auto& one) { return one.name == name; });
    if (name.empty() || is_known) continue;
    const auto number = surfaces.size();
    auto tint = tint_named(name);
    if (tint.empty() || any_has(surfaces, tint)) {
      const auto unused = std::ranges::find_if(given, [&](std::string_view one) { return !any_has(surfaces, one); });
      tint = unused == given.end() ? given[number % given.size()] : *unused;
    }
    auto pattern = patterns[number % patterns.size()];
    for (std::size_t i = 1; i < patterns.size() && any_has(surfaces, tint, pattern); ++i) {
      pattern = patterns[(number + i) % patterns.size()];
    }
    surfaces.push_back({name, tint, pattern});
  }
  return surfaces;
}

}  // namespace kith
