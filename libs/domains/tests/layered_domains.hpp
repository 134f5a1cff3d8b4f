#pragma once

#include <map>
#include <string>

#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"

namespace kith::testing::layered {

inline const std::string kTail = R"([[feature]]
name = "step"
when = "action"
[reward]
weights = { f = -2, step = -1 }
)";

// `map`: all of [map] below its head; `when`: of the feature f.
inline std::string domain_text(const std::string& map, const std::string& when, const std::string& more = "") {
  return "schema = \"kith.domain/1\"\nid = \"layers\"\n[map]\n" + map + "[[feature]]\nname = \"f\"\nwhen = \"" + when +
         "\"\n" + more + kTail;
}

inline const std::string kLegend = R"([map.legend]
"." = "floor"
"#" = "wall"
"r" = { terrain = "rubble", optional = true }
"m" = { terrain = "smoke" }
"S" = { start = true }
"G" = { goal = true }
)";

inline const std::string kYaml =
    "image: floor.pgm\nresolution: 0.05\norigin: [-1.0, -1.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\n"
    "free_thresh: 0.196\n";
inline const std::string kFloor = "P2\n# 4 x 2\n4 2\n255\n254 254 254 254\n0 205 0 254\n";

inline std::map<std::string, std::string> files_with(const std::map<std::string, std::string>& more = {}) {
  std::map<std::string, std::string> files{
      {"floor.yaml", kYaml},
      {"floor.pgm", kFloor},
      {"zones.pgm", "P2 4 2 255 255 64 128 255 255 255 255 255"},
      {"heat.pgm", std::string{"P5 4 2 255\n\xFF\x80\x00\xFF\xFF\xFF\xFF\xFF", 19}}};
  for (const auto& [name, text] : more) files[name] = text;
  return files;
}

inline DomainReading read(const std::string& text, const std::map<std::string, std::string>& files = files_with()) {
  DomainFiles known;
  for (const auto& [name, content] : files) known.known.push_back({name, content});
  return parse_domain(text, "layers.toml", {}, known);
}

inline std::string all_of(const DomainReading& reading) {
  std::string text;
  for (const Diagnostic& d : reading.diagnostics) text += to_text(d);
  return text;
}

}  // namespace kith::testing::layered
