#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "kith/explain/examination.hpp"
#include "kith/explain/json.hpp"
#include "kith/study/study_spec.hpp"

namespace kith {

/// What an exam says of some people after so many boards, or at its end if that came before.
struct ExamFindings {
  std::size_t wrongly = 0;  ///< People said to understand a component that they get wrong more often than right.
  std::size_t nearly = 0;   ///< The same of one that they get right more often than wrong, yet not often enough.
  std::size_t rightly = 0;  ///< Components that people understand, and are said to.
};

/// People of one kind who were taught and then examined.
struct RehearsedKind {
  std::string kind;
  std::size_t people = 0;
  std::size_t mistaken = 0;              ///< People who get some component wrong more often than right.
  std::size_t understood = 0;            ///< Components that people understand.
  std::size_t boards = 0;                ///< Asked of all of them.
  std::vector<ExamFindings> findings{};  ///< Per entry of kExamLengths.
};

/// Numbers of boards after which findings are reported.
inline constexpr std::array<std::size_t, 5> kExamLengths{0, 2, 4, 8, Examination::kMostBoards};

struct ExamRehearsalOptions {
  std::size_t people = 100;  ///< Of every kind.
  std::size_t threads = 0;   ///< 0: as many as there are cores; changes no result.
  std::function<bool(std::size_t done, std::size_t total)> on_progress{};
};

/// Simulated people, each taught alone by `plan`, for at most twelve lessons, and examined: first those who learn as
/// the types of a study do, then the kinds of people_not_as_assumed(). Whoever answers as believed understands a
/// component if they satisfy its constraints often enough (CredibleLevelOptions::enough), and gets it
/// wrong more often than right if they do so less than half of the time, as does everybody who answers otherwise.
/// @return nothing if on_progress said stop.
[[nodiscard]] std::vector<RehearsedKind> rehearse_exam(const Atlas& atlas, const StudySpec& study,
                                                       const ExamRehearsalOptions& options);

/// The document kith.exam-rehearsal/1.
[[nodiscard]] Json rehearsal_json(const Atlas& atlas, const std::vector<RehearsedKind>& kinds,
                                  const std::string& program);

}  // namespace kith
