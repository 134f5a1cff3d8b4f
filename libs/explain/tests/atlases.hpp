#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "domain_texts.hpp"
#include "kith/bec/atlas.hpp"
#include "kith/domains/domain_file.hpp"

namespace kith::testing {

/// The atlas of a built-in domain, made once.
[[nodiscard]] inline const Atlas& atlas_of(const std::string& name) {
  static std::map<std::string, std::unique_ptr<const Atlas>> known;
  auto& atlas = known[name];
  if (!atlas) atlas = std::make_unique<const Atlas>(load_domain(name));
  return *atlas;
}

/// Domains without tables: with seven features, with chance and discount, and an imported model.
[[nodiscard]] inline std::vector<std::string> domains_without_tables() {
  const std::string source = KITH_SOURCE_DIR;
  return {"navigation", source + "/domains/icy_crossing.toml", source + "/docs/examples/cliff.toml"};
}

/// The built-in domains that can be taught; colored-tiles, the largest, last.
inline const std::vector<std::string> kSmallDomains{"item-delivery", "skateboard", "two-goals", "cookie-crumb"};

/// A domain with one road, five cells long, that has everything on it: whatever the robot likes, it takes it.
inline const std::string kOneRoad = map_domain(
    "one-road", "\"S.r.G\"", "\"r\" = { terrain = \"rubble\", optional = true }\n",
    {{"rubble", "leave:rubble"}, {"arrival", "goal"}, {"step", "action"}}, "rubble = -2, arrival = 1, step = -1",
    "[prior]\nhalfspaces = [ { step = -1 } ]\n[words]\nstep = \"a step\"\n");

}  // namespace kith::testing
