#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace kith::testing {

/// A domain file: floor ".", start "S", goal "G" and what `legend` has.
/// @param rows      as in the file: `"S.rG"`, commas between them. @param legend  further symbols, a line each.
/// @param features  each with its condition. @param weights  "rubble = -3, step = -1".
/// @param more      what follows the weights. @param before  what stands before the map.
[[nodiscard]] inline std::string map_domain(const std::string& id, const std::string& rows, const std::string& legend,
                                            const std::vector<std::pair<std::string, std::string>>& features,
                                            const std::string& weights, const std::string& more = "",
                                            const std::string& before = "") {
  auto text = "schema = \"kith.domain/1\"\nid = \"" + id + "\"\n" + before + "[map]\nrows = [" + rows +
              "]\n[map.legend]\n\".\" = \"floor\"\n" + legend + "\"S\" = { start = true }\n\"G\" = { goal = true }\n";
  for (const auto& [name, when] : features) text += "[[feature]]\nname = \"" + name + "\"\nwhen = \"" + when + "\"\n";
  return text + "[reward]\nweights = { " + weights + " }\n" + more;
}

/// With walls "#" and rubble "r" that may be absent; rubble and steps count.
[[nodiscard]] inline std::string rubble_domain(const std::string& rows, const std::string& more = "") {
  return map_domain("rubble", rows, "\"#\" = \"wall\"\n\"r\" = { terrain = \"rubble\", optional = true }\n",
                    {{"rubble", "leave:rubble"}, {"step", "action"}}, "rubble = -3, step = -1", more);
}

/// In which nothing but steps counts.
[[nodiscard]] inline std::string steps_domain(const std::string& rows) {
  return map_domain("steps", rows, "", {{"step", "action"}}, "step = -1");
}

/// A domain file: side x side cells, from the lower left corner to the upper right one.
/// @param symbol_at  (x, y) -> ".", floor, "r", rubble, or "m", mud.
template <typename SymbolAt>
[[nodiscard]] std::string terrain_grid(std::size_t side, const SymbolAt& symbol_at) {
  std::string rows;
  for (std::size_t y = 0; y < side; ++y) {
    std::string row;
    for (std::size_t x = 0; x < side; ++x) row += symbol_at(x, y);
    if (y == 0) row.back() = 'G';
    if (y + 1 == side) row.front() = 'S';
    rows += (y == 0 ? "\"" : ",\n\"") + row + '"';
  }
  return map_domain("terrain", rows, "\"r\" = { terrain = \"rubble\" }\n\"m\" = { terrain = \"mud\" }\n",
                    {{"rubble", "leave:rubble"}, {"mud", "leave:mud"}, {"step", "action"}},
                    "rubble = -2.7, mud = -1.3, step = -1", "", "[mdp]\nmax_steps = 10000\n");
}

/// Four features, of which people in the way are met in one world only; 3 worlds. Without tables.
inline constexpr const char* kHospital = R"toml(schema = "kith.domain/1"
id = "hospital"
[mdp]
max_steps = 40
[map]
rows = ["...p.H",
        ".#w#p.",
        "D#w#.#",
        ".#.w..",
        "S..#.."]
[map.legend]
"." = "floor"
"#" = "wall"
"w" = { terrain = "wet", optional = true }
"p" = { terrain = "people", optional = true }
"D" = { station = "disinfection", optional = true }
"S" = { start = true }
"H" = { goal = true }
[[family.world]]
present = ["disinfection"]
[[family.world]]
present = ["wet", "disinfection"]
[[family.world]]
present = ["people", "wet(4,4)", "disinfection"]
[[feature]]
name = "wet"
when = "enter:wet"
[[feature]]
name = "disinfect"
when = "enter:disinfection"
[[feature]]
name = "people"
when = "enter:people"
[[feature]]
name = "step"
when = "action"
[reward]
weights = { wet = -2, disinfect = 3, people = -1.5, step = -1 }
[prior]
halfspaces = [ { step = -1 } ]
)toml";

/// A robot that may slip, in the tables states.csv and transitions.csv.
inline constexpr const char* kSlippery = R"toml(schema = "kith.domain/1"
id = "slippery"
[model]
format = "csv"
states = "states.csv"
transitions = "transitions.csv"
[[feature]]
name = "slip"
[[feature]]
name = "step"
[reward]
weights = { slip = -2, step = -1 }
)toml";

/// A domain with a single open facet: whoever likes going right expects the robot to go to and fro for ever.
inline constexpr const char* kToAndFro = R"toml(schema = "kith.domain/1"
id = "open"
[mdp]
max_steps = 60
[map]
rows = ["S..", "...", "..G"]
legend = { "." = "floor", "S" = { start = true }, "G" = { goal = true } }
[[feature]]
name = "right"
when = "action:right"
[[feature]]
name = "step"
when = "action"
[reward]
weights = { right = -0.7, step = -1 }
[prior]
halfspaces = [ { step = -1 } ]
)toml";

}  // namespace kith::testing
