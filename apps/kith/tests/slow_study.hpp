#pragma once

#include <fstream>
#include <string>

#include "large_map.hpp"
#include "run_kith.hpp"

namespace kith::testing {

/// Writes a study of which the choice of the first lesson takes minutes. @return its file.
inline std::string slow_study(const Scratch& scratch, const std::string& composition) {
  std::ofstream{scratch / "map.toml"} << large_map(60);
  std::ofstream{scratch / "study.toml"} << "schema = \"kith.study/1\"\nid = \"slow\"\ndomain = \"map.toml\"\nseed = 1\n"
                                           "replicates = 2\n[design]\nstrategies = [\"common\"]\ncompositions = [\""
                                        << composition
                                        << "\"]\n[learner.N]\nability = { mean = 0.7, sd = 0.03 }\n"
                                           "confirm_gain = { value = 0.03 }\ncorrect_gain = { value = 0.05 }\n"
                                           "[teacher]\nparticles = 100000\ncounterfactuals = 100000\n";
  return scratch / "study.toml";
}

}  // namespace kith::testing
