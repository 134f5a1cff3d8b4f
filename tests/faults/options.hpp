#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "models.hpp"

namespace kith::faults {

/// What the command line asks for.
struct Options {
  Tools tools{};
  std::map<std::string, std::size_t> cases{};  ///< How many of each family.
  std::string scenarios{};                     ///< Only these, separated by commas; all if empty.
  std::string only_case{};                     ///< Replay this one and keep its folder.
  std::uint64_t seed = 1;
  std::size_t jobs = 1;
  double seconds = 0.0;  ///< Begin no case after so many; 0: no limit.
  bool help = false;
};

/// @throws kith::Error if it cannot be understood
[[nodiscard]] Options parse_options(int argc, char** argv);

[[nodiscard]] std::string usage();

}  // namespace kith::faults
