#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kith/store/session_export.hpp"
#include "kith/table/codebook.hpp"

// What the tables of an export are: the one place where their columns are defined.
namespace kith {

inline constexpr const char* kSessionsFile = "sessions.csv";
inline constexpr const char* kParticipantsFile = "participants.csv";
inline constexpr const char* kPeriodsFile = "periods.csv";
inline constexpr const char* kTestsFile = "tests.csv";
inline constexpr const char* kDiscussionsFile = "discussions.csv";
inline constexpr const char* kKeysFile = "keypresses.csv";
inline constexpr const char* kQuestionsFile = "questions.csv";
inline constexpr const char* kTrialsFile = "trials.csv";
inline constexpr const char* kBeliefsFile = "beliefs.csv";
inline constexpr const char* kEventsFile = "events.csv";
// What was taught, and to whom: for `kith report`.
inline constexpr const char* kAboutFile = "study.json";

[[nodiscard]] TableDescription sessions_table();
[[nodiscard]] TableDescription participants_table(const SessionExportOptions& options);
[[nodiscard]] TableDescription periods_table();
[[nodiscard]] TableDescription tests_table();
[[nodiscard]] TableDescription discussions_table();
[[nodiscard]] TableDescription keys_table();
[[nodiscard]] TableDescription questions_table(const SessionExportOptions& options);
[[nodiscard]] TableDescription trials_table();
[[nodiscard]] TableDescription beliefs_table();
[[nodiscard]] TableDescription events_table();

}  // namespace kith
