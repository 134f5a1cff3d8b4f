#pragma once

#include <cstddef>
#include <cstdint>

#include "kith/core/parallel.hpp"
#include "kith/fit/person_log.hpp"

namespace kith {

struct AnswerRegionOptions {
  AnswerDetail detail = AnswerDetail::kPath;
  std::size_t draws = 60;  ///< Weights per person, period and round, from each of three beliefs.
  std::size_t rounds = 6;  ///< At most.
  double missed = 0.001;   ///< No further round when at most this share of the weights takes a new path.
  std::uint64_t seed = 1;
  ParallelOptions parallel{};
};

/// Fills in LoggedPeriod::answers, possible and chance of people whose domain has no tables of paths (more than three
/// features, chance, discount, large worlds), and sets ResponseLogs::sample. Does nothing to others.
///
/// Every person is replayed with three abilities; for weights drawn from their beliefs before each set of tests the
/// best paths are planned. An answer then stands for the weights for which its path is better than every other path
/// that was met in that test,
///   { w : w . (mu_answer - mu) >= 0 for all paths mu met },
/// among the weights that no cycle met earns anything for. Both are too large by the weights whose path was not met:
/// rounds with fresh draws go on until these are rare, and the share of the last round is kept.
/// Answers that no weight met takes count by their verdict (W0706).
/// @return false if parallel.on_progress said stop; the logs are then as they were.
/// @throws std::invalid_argument unless draws and rounds are at least 1.
[[nodiscard]] bool find_answer_regions(ResponseLogs& logs, const AnswerRegionOptions& options = {});

}  // namespace kith
