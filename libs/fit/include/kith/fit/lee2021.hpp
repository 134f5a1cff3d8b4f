#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "kith/domains/domain.hpp"

namespace kith {

/// A test world of the study of Lee, Admoni & Simmons (2021) [lee2021], as its
/// public table of worlds has it, turned into a domain with one MDP.
///
/// Rewards (divided by their L1 norm for display): augmented_taxi delivery 26,
/// entering a toll -3, step -1; two_goal 7.25, 10.5, step -1; skateboard goal 9,
/// board -0.3 (a boarded move, picking it up or putting it down, instead of a
/// step), step -1. `exit` ends the episode anywhere and costs a step.
struct RecordedWorld {
  std::string id;          ///< "two_goal_000"
  std::string family;      ///< "augmented_taxi", "two_goal" or "skateboard"
  std::string difficulty;  ///< "low", "medium" or "high"
  std::vector<std::string> optimal_actions;
  double optimal_return = 0.0;  ///< As stored: divided by the L1 norm of the weights.
  std::string domain_text;      ///< A domain file (docs/formats.md).
  Domain domain;                ///< What it says.
};

/// Reads the table of worlds: JSON, one world a line, of at most 20 000 states each.
/// @throws kith::Error (kInvalidInput) with all diagnostics (E0701, E0702, and those of domain files), or (kIo).
[[nodiscard]] std::vector<RecordedWorld> read_lee2021_worlds(const std::filesystem::path& path);

/// One answer of the same study, with the verdict that was recorded.
struct RecordedResponse {
  std::size_t participant = 0;
  std::size_t experiment = 1;
  std::string family;
  std::string world;           ///< RecordedWorld::id
  std::size_t difficulty = 0;  ///< 0, 1, 2: low, medium, high
  bool optimal = false;
  std::vector<std::string> moves;
  std::size_t line = 0;  ///< In the file, from 1.
};

/// Reads the table of responses (CSV); columns that are not needed may be missing or unknown.
/// @throws kith::Error (kInvalidInput) with all diagnostics (E0501 to E0511), or (kIo).
[[nodiscard]] std::vector<RecordedResponse> read_lee2021_responses(const std::filesystem::path& path);

}  // namespace kith
