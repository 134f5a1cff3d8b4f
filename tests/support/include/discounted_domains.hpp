#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <regex>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kith/core/distributions.hpp"
#include "kith/domains/domain_file.hpp"

namespace kith::testing {

/// From hardly any to so many that most robots never arrive.
inline constexpr std::array kDiscounts{0.99, 0.9, 0.7, 0.3};

/// Domains for which all discounts together take half a minute; the night tests them.
inline constexpr std::array<std::string_view, 3> kLargeDomains{"navigation", "rescue-floor", "warehouse"};

/// The discounts with which a built-in domain is tested in the normal run: a single one if it is large.
inline std::span<const double> everyday_discounts(std::string_view name) {
  const std::span<const double> all{kDiscounts};
  return std::ranges::find(kLargeDomains, name) != kLargeDomains.end() ? all.subspan(2, 1) : all;
}

/// The text of a domain file with another discount.
inline std::string with_discount(const std::string& text, double discount) {
  static const std::regex kLine{"(^|\n)discount *=[^\n]*"};
  return std::regex_replace(text, kLine, "$1discount = " + std::to_string(discount));
}

/// The names of all built-in domains, for tests with parameters.
inline std::vector<std::string> built_in_names() {
  std::vector<std::string> names;
  for (const auto& built_in : built_in_domains()) names.emplace_back(built_in.name);
  return names;
}
/// Those that are not large.
inline std::vector<std::string> small_domain_names() {
  auto names = built_in_names();
  std::erase_if(names, [](const auto& name) { return std::ranges::find(kLargeDomains, name) != kLargeDomains.end(); });
  return names;
}
/// A name as tests may have it.
inline std::string test_name(std::string name) {
  std::erase(name, '-');
  return name;
}

/// A built-in domain with another discount.
inline Domain discounted_domain(const std::string& name, double discount) {
  const auto built_in = std::ranges::find(built_in_domains(), name, &BuiltInDomain::name);
  const auto text = with_discount(std::string{built_in->text}, discount);
  auto reading = parse_domain(text, name, {}, {.folder = {}, .known = built_in->files});
  if (!reading.domain) throw std::logic_error{to_text(reading.diagnostics.front())};
  return *std::move(reading.domain);
}

/// A room of 3 x 3 to 5 x 4 cells with rubble, mud, a charger and a parcel or a goal, and whatever weights.
/// @return nothing where such a draw is no valid domain.
inline std::optional<Domain> random_discounted_domain(double discount, RandomStream& random) {
  const auto width = 3 + uniform_index(3, random);
  const auto height = 3 + uniform_index(2, random);
  std::vector<std::string> rows(height, std::string(width, '.'));
  const auto place = [&](char symbol) { rows[uniform_index(height, random)][uniform_index(width, random)] = symbol; };
  for (std::size_t i = 0; i < width; ++i) place('r');
  for (std::size_t i = 0; i < width / 2; ++i) place('m');
  place('B');
  rows[0][0] = 'S';
  rows[height - 1][width - 1] = 'G';
  std::string map;
  for (const auto& row : rows) map += (map.empty() ? "[\"" : ", \"") + row + "\"";
  const bool has_parcel = uniform_index(2, random) == 0;
  const auto weight = [&](int low, int high) {
    return std::to_string(low + static_cast<int>(uniform_index(static_cast<std::size_t>(high - low + 1), random)));
  };
  const std::string text =
      "schema = \"kith.domain/1\"\nid = \"room\"\n[mdp]\ndiscount = " + std::to_string(discount) +
      "\n[map]\nrows = " + map +
      "]\n[map.legend]\n\".\" = \"floor\"\n\"r\" = { terrain = \"rubble\", optional = "
      "\"rubble\" }\n\"m\" = { terrain = \"mud\" }\n\"B\" = { station = \"charger\" }\n" +
      (has_parcel ? "\"S\" = { start = true, item = \"parcel\" }\n\"G\" = { destination = \"parcel\" }\n"
                  : "\"S\" = { start = true }\n\"G\" = { goal = true }\n") +
      "[[feature]]\nname = \"rubble\"\nwhen = \"leave:rubble\"\n[[feature]]\nname = \"charge\"\nwhen = "
      "\"leave:charger\"\n[[feature]]\nname = \"step\"\nwhen = \"action\"\n[reward]\nweights = { rubble = " +
      weight(-4, 2) + ", charge = " + weight(-2, 6) + ", step = " + weight(-3, -1) + " }\n";
  return parse_domain(text, "room.toml").domain;
}

}  // namespace kith::testing
