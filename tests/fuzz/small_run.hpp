#pragma once

#include <filesystem>

#include "kith/bec/atlas.hpp"
#include "kith/core/error.hpp"
#include "kith/runs/study_run.hpp"
#include "study_files.hpp"

namespace kith::fuzzing {

/// What the journals of small runs say wrote them.
inline constexpr const char* kProgram = "1.0 (fuzzing)";

/// Four teams of two in a domain that is small but can be taught.
[[nodiscard]] inline StudyReading small_study(std::uint64_t seed) {
  constexpr const char* kText = R"(schema = "kith.study/1"
id = "small"
domain = "two-goals"
seed = 1
replicates = 2
[design]
strategies = ["common", "joint"]
compositions = ["NP"]
[stop]
max_periods = 3
[teacher]
particles = 30
[learner.N]
particles = 30
ability = { mean = 0.75, sd = 0.03 }
confirm_gain = { half_normal = 0.03 }
correct_gain = { value = 0.05 }
[learner.P]
particles = 30
ability = { mean = 0.85, sd = 0.03 }
confirm_gain = { half_normal = 0.03 }
correct_gain = { value = 0.05 }
[record]
level = "period"
)";
  auto reading = parse_study(kText, "small.toml", {{"seed=" + std::to_string(seed)}, folder()});
  if (!reading.study) throw Error{reading.diagnostics};
  return reading;
}

/// Runs it, or one shard of it, into the folder.
inline void run_small_study(const std::filesystem::path& path, const Atlas& atlas, std::uint64_t seed,
                            const Shard& shard = {}) {
  StudyRunOptions options;
  options.program = kProgram;
  options.threads = 1;
  options.shard = shard;
  StudyRun run{path, small_study(seed), options};
  run.teach(atlas);
  RunFacts facts;
  facts.version = "1.0";
  facts.started = facts.stopped = "2026-01-31T12:00:00Z";
  facts.domain = "two-goals";
  if (shard.count > 1) {
    run.publish_shard(facts);
  } else {
    run.publish(facts);
  }
}

}  // namespace kith::fuzzing
