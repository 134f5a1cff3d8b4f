#pragma once

#include <random>
#include <string>

namespace kith::testing {

/// A domain file with one square map of so many cells a side, a fifth of them rubble. What it teaches is planned on
/// demand, and takes the longer the larger it is.
[[nodiscard]] inline std::string large_map(int side) {
  std::string rows;
  std::mt19937 random{1};
  for (int y = 0; y < side; ++y) {
    std::string row;
    for (int x = 0; x < side; ++x) row += random() % 5 == 0 ? 'r' : '.';
    if (y == 0) row.front() = 'S';
    if (y + 1 == side) row.back() = 'G';
    rows += "  \"" + row + "\",\n";
  }
  return "schema = \"kith.domain/1\"\nid = \"large\"\n[map]\nrows = [\n" + rows +
         "]\n[map.legend]\n\".\" = \"floor\"\n\"r\" = { terrain = \"rubble\" }\n\"S\" = { start = true }\n"
         "\"G\" = { goal = true }\n[mdp]\nmax_steps = 100000\n"
         "[[feature]]\nname = \"step\"\nwhen = \"action\"\n[[feature]]\nname = \"rubble\"\nwhen = \"enter:rubble\"\n"
         "[[feature]]\nname = \"up\"\nwhen = \"action:up\"\n"
         "[reward]\nweights = { step = -1, rubble = -3, up = -0.5 }\n[prior]\nhalfspaces = [ { step = -1 } ]\n";
}

}  // namespace kith::testing
