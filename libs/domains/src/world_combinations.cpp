#include "kith/domains/layers.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace kith::detail {

std::optional<char> unused_glyph(const FamilyMap& family_map, std::string_view preferred) {
  static constexpr std::string_view kOthers = "abcdefghijklmnpqrstuwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+=%&$~?!:;|";
  const auto is_used = [&](char c) {
    return std::ranges::any_of(family_map.symbols, [c](const Symbol& symbol) { return symbol.glyph == c; });
  };
  for (const std::string_view list : {preferred, kOthers}) {
    const auto at = std::find_if_not(list.begin(), list.end(), is_used);
    if (at != list.end()) return *at;
  }
  return std::nullopt;
}

namespace {

// What one cell may hold: what is always there, and what is there in some MDPs.
struct Mixture {
  std::vector<const SymbolContent*> always;
  std::vector<const SymbolContent*> sometimes;
  friend auto operator<=>(const Mixture&, const Mixture&) = default;
};

Mixture mixture_on(const FamilyMap& family_map, std::size_t cell) {
  Mixture mixture;
  for (const MapThing& thing : family_map.things_on(cell)) {
    const SymbolContent& content = family_map.symbols[thing.symbol].content;
    if (!content.is_floor()) (thing.group < 0 ? mixture.always : mixture.sometimes).push_back(&content);
  }
  for (const Raster& raster : family_map.rasters) {
    if (raster.symbol < 0) continue;
    // The values of a raster are consecutive grids.
    const auto r = static_cast<std::size_t>(&raster - family_map.rasters.data());
    const auto begin = family_map.raster_grid_of.begin() + static_cast<std::ptrdiff_t>(r * family_map.num_mdps());
    const auto [first, last] = std::minmax_element(begin, begin + static_cast<std::ptrdiff_t>(family_map.num_mdps()));
    std::size_t number = 0;
    for (std::size_t grid = *first; grid <= *last; ++grid) {
      if (family_map.raster_grids[grid][cell] > 0) ++number;
    }
    const SymbolContent& content = family_map.symbols[static_cast<std::size_t>(raster.symbol)].content;
    const bool is_everywhere = number == *last - *first + 1;
    if (number > 0) (is_everywhere ? mixture.always : mixture.sometimes).push_back(&content);
  }
  return mixture;
}

}  // namespace

void name_combinations(FamilyMap& family_map) {
  constexpr std::size_t kMostTogether = 6;
  const bool draws_rasters = std::ranges::any_of(family_map.rasters, [](const Raster& one) { return one.symbol >= 0; });
  if (family_map.painted.empty() && !draws_rasters) return;
  std::set<Mixture> mixtures;
  for (std::size_t cell = 0; cell < family_map.num_cells(); ++cell) {
    const Mixture mixture = mixture_on(family_map, cell);
    if (mixture.always.size() + mixture.sometimes.size() > 1) mixtures.insert(mixture);
  }

  // Found by content, in the order of the cells' symbols, not by address.
  std::vector<SymbolContent> found;
  const auto add = [&](SymbolContent content) {
    const auto is_it = [&](const Symbol& symbol) { return symbol.content == content; };
    if (content.is_floor() || std::ranges::any_of(family_map.symbols, is_it)) return;
    if (std::ranges::find(found, content) == found.end()) found.push_back(std::move(content));
  };

  for (const Mixture& mixture : mixtures) {
    const std::size_t n = std::min(mixture.sometimes.size(), kMostTogether);
    for (std::size_t subset = 0; subset < (std::size_t{1} << n); ++subset) {
      std::vector<const SymbolContent*> contents = mixture.always;
      for (std::size_t i = 0; i < n; ++i) {
        if ((subset >> i & 1U) != 0) contents.push_back(mixture.sometimes[i]);
      }
      SymbolContent content = together(contents);
      add(content);
      content.start = content.carried = false;
      content.item.clear();
      add(content);
      content.station.clear();
      add(content);
    }
  }

  for (SymbolContent& content : found) {
    const auto glyph = unused_glyph(family_map, "");
    if (!glyph) return;
    Symbol symbol;
    symbol.glyph = *glyph;
    symbol.content = std::move(content);
    symbol.place = family_map.map_place;
    family_map.symbols.push_back(std::move(symbol));
  }
}

}  // namespace kith::detail
