#pragma once

#include <gtest/gtest.h>

#include <string>

#include "kith/core/error.hpp"
#include "kith/fit/import_logs.hpp"
#include "kith/runs/run_folder.hpp"
#include "kith/study/study.hpp"
#include "scratch_folder.hpp"

// Running everything 20 times as slowly, sanitizers get smaller cases.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

namespace kith::testing {

/// People who were simulated, as a run folder has them.
struct SimulatedPeople {
  ResponseLogs logs;
};

/// A study of item delivery; `rest` are tables besides [design].
inline std::string study_text(const std::string& composition, std::size_t teams, const std::string& rest) {
  return "schema = \"kith.study/1\"\nid = \"people\"\ndomain = \"item-delivery\"\nseed = 12\nreplicates = " +
         std::to_string(teams) + "\n[design]\nstrategies = [\"common\"]\ncompositions = [\"" + composition +
         "\"]\npairing = \"none\"\n" + rest;
}

/// Runs a study into a folder.
inline RunResult run_into(const std::filesystem::path& folder, const std::string& text, const StudyKinds& kinds = {}) {
  const auto reading = parse_study(text, "study.toml", {.kinds = kinds});
  if (!reading.study) throw Error{reading.diagnostics};
  const Atlas atlas{*reading.domain};
  auto result = run_teams(atlas, *reading.study, team_addresses(*reading.study));
  RunFolder{folder, freeze(reading), true}.publish(*reading.study, result.teams, {});
  return result;
}

inline SimulatedPeople simulate(const std::string& text, AnswerDetail detail = AnswerDetail::kPath) {
  const ScratchFolder folder;
  run_into(folder.path() / "run", text);
  return {import_run_folder(folder.path() / "run", detail)};
}

}  // namespace kith::testing
