#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "kith/domains/domain_file.hpp"

namespace kith {

inline constexpr MdpIndex kFirst{0};

/// Files by name; "domain.toml" is the domain file, the others are those that it names.
using ModelTexts = std::map<std::string, std::string>;

/// A robot on ice: it goes or creeps from the bank over the ice to the shore, and may slip back.
inline const ModelTexts kIceCsv{{"domain.toml", R"(schema = "kith.domain/1"
id = "ice"
[mdp]
discount = 1.0
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
)"},
                                {"states.csv", R"(state,name,terminal,start,x
bank,on the bank,false,true,0
ice,on the ice,false,true,1
shore,ashore,true,false,2
)"},
                                {"transitions.csv", R"(state,action,next,probability,slip,step
bank,go,ice,1,0,1
ice,go,shore,0.75,0,1
ice,go,bank,0.25,1,1
ice,creep,shore,0.5,0,1
ice,creep,ice,0.5,0,1
bank,creep,bank,1,0,1
)"}};

/// The same on a picture of three cells, with a dog that waits ashore or is on the robot's cell.
inline const ModelTexts kIceDrawn{{"domain.toml", kIceCsv.at("domain.toml") + R"([model.drawing]
x = "x"
y = "y"
origin = [0, 0]
[model.drawing.things]
D = { x = "dog", y = "y", carried = "held" }
[map]
rows = [".~G#"]
[map.legend]
"." = "floor"
"~" = { terrain = "ice" }
"G" = { goal = true }
"#" = "wall"
"D" = { item = "dog" }
)"},
                                  {"states.csv", R"(state,name,terminal,start,x,y,dog,held
bank,on the bank,false,true,0,0,2,0
ice,on the ice,false,true,1,0,9,1
shore,ashore,true,false,2,0,2,0
)"},
                                  {"transitions.csv", kIceCsv.at("transitions.csv")}};

inline DomainReading read_model_texts(const ModelTexts& texts) {
  DomainFiles files;
  for (const auto& [name, text] : texts) {
    if (name != "domain.toml") files.known.push_back({name, text});
  }
  return parse_domain(texts.at("domain.toml"), "domain.toml", {}, files);
}

/// The texts with the first `from` of one of them replaced.
inline ModelTexts edited(ModelTexts texts, const std::string& file, const std::string& from, const std::string& to) {
  const auto at = texts.at(file).find(from);
  if (at == std::string::npos) throw std::runtime_error{"nothing to edit: " + from};
  texts.at(file).replace(at, from.size(), to);
  return texts;
}

inline Domain sound_model(const ModelTexts& texts) {
  DomainReading reading = read_model_texts(texts);
  for (const Diagnostic& d : reading.diagnostics) {
    if (d.severity == Severity::kError) ADD_FAILURE() << to_text(d);
  }
  if (!reading.domain) throw std::runtime_error{"the model of the test is not sound"};
  return *std::move(reading.domain);
}

}  // namespace kith
