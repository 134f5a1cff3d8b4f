#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "kith/domains/domain_file.hpp"

namespace kith {

/// The domain of a text that must be sound; warnings are allowed.
inline Domain sound_domain(const std::string& text) {
  DomainReading reading = parse_domain(text, "test.toml");
  for (const Diagnostic& d : reading.diagnostics) {
    if (d.severity == Severity::kError) ADD_FAILURE() << to_text(d);
  }
  if (!reading.domain) throw std::runtime_error{"the domain of the test is not sound"};
  return *std::move(reading.domain);
}

/// 5 x 5 cells, nine optional tiles of two colours; walking off a tile costs.
inline const std::string kColoredTiles = R"(
schema = "kith.domain/1"
id = "colored-tiles"
[map]
rows = [".....",
        ".BBBB",
        "....B",
        ".AAA.",
        "S..AG"]
[map.legend]
"." = "floor"
"A" = { terrain = "a", optional = true }
"B" = { terrain = "b", optional = true }
"S" = { start = true }
"G" = { goal = true }
[[feature]]
name = "a"
when = "leave:a"
exclusive = "tile"
[[feature]]
name = "b"
when = "leave:b"
exclusive = "tile"
[[feature]]
name = "step"
when = "action"
[reward]
weights = { a = -6.5, b = -5.25, step = -1 }
[prior]
halfspaces = [ { step = -1 } ]
)";

/// 6 x 4 cells; a tool to ride on, and paths of four cells that bar it.
inline const std::string kSkateboard = R"(
schema = "kith.domain/1"
id = "skateboard"
[map]
rows = ["B..S.G",
        ".....q",
        ".....q",
        "ppppqq"]
[map.legend]
"." = "floor"
"p" = { terrain = "path", optional = "west" }
"q" = { terrain = "path", optional = "east" }
"B" = { item = "board", optional = true }
"S" = { start = true }
"G" = { goal = true }
[[feature]]
name = "board"
when = "carrying:board | action:pickup | action:dropoff"
exclusive = "way"
[[feature]]
name = "path"
when = "leave:path"
exclusive = "way"
[[feature]]
name = "ground"
when = "action"
exclusive = "way"
[[rule]]
when = "carrying:board & enter:path"
forbid = true
[reward]
weights = { board = -0.175, path = -0.5125, ground = -1 }
[prior]
halfspaces = [ { ground = -1 } ]
)";

}  // namespace kith
