#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kith/files/table_of.hpp"
#include "kith/store/session_export.hpp"

// What the tables of an export are: the one place where their columns are defined, by what a row of them holds.
namespace kith {

inline constexpr const char* kSessionsFile = "sessions.csv";
inline constexpr const char* kEventsFile = "events.csv";
// What was taught, and to whom: for `kith report`.
inline constexpr const char* kAboutFile = "study.json";

struct SessionRow {
  std::string session, strategy, composition;
  std::size_t replicate, size, people, withdrawn;
  std::int64_t created_ms;
  std::optional<std::int64_t> started_ms{}, last_ms{};
  std::string stage;
  std::optional<std::string> ended{};
  bool completed;
  std::size_t periods, demonstrations, tests;
  std::optional<double> share_right{};
  std::size_t components_learned;
  std::optional<double> knowledge{};
  std::string digest;
};

struct ParticipantRow {
  std::string session{};
  std::size_t seat = 0;
  std::optional<std::size_t> member{};
  std::optional<std::string> type{}, strategy{}, composition{};
  bool simulated = false;
  std::optional<std::int64_t> joined_ms{};
  std::optional<std::string> consent{}, stage{};
  std::string status{};
  std::size_t times_away = 0;
  double seconds_away = 0.0;
  std::size_t tests = 0, right = 0;
  std::optional<double> share_right{}, knowledge{}, p_bec{}, estimate{};
  std::optional<std::string> name{}, query{}, code{};
};

struct PeriodRow {
  std::string session;
  std::size_t period, component;
  std::string source;
  std::int64_t chosen_ms;
  std::size_t demonstrations, tests;
  std::optional<std::size_t> n_active{};
  std::optional<bool> all_right{};
  double gain, area_sr;
  std::string digest;
};

// An answer of a person, or of a stand-in, whose paths are not kept.
struct TestRow {
  std::string session;
  std::size_t period, component, test, seat, member;
  std::string type, strategy;
  std::size_t mdp;
  std::optional<std::string> mdp_name{};
  std::size_t start;
  std::optional<std::string> path{};
  std::size_t actions;
  std::optional<bool> correct{};
  std::optional<double> regret{}, rt{};
  std::int64_t at_ms;
};

// An answer before and after the group saw all answers.
struct DiscussionRow {
  std::string session;
  std::size_t period, component, test;
  std::optional<std::size_t> seat{};
  std::size_t member;
  bool correct, revised_correct, changed;
};

struct KeyRow {
  std::string session;
  std::size_t period, test, seat, key;
  std::string action;
  std::int64_t ms;
};

struct QuestionRow {
  std::string session;
  std::size_t seat;
  std::string question, kind;
  std::optional<std::string> value{};
};

// What the exam of a person found out about a component.
struct ExamRow {
  std::string session;
  std::size_t seat, member;
  std::string type;
  std::optional<std::string> role{};
  std::string date;
  std::int64_t at_ms;
  std::string robot;
  std::size_t component, boards;
  std::string asked, answers, result, all;
};

struct TrialRow {
  std::string user_id, group, domain, kc_id, interaction_type;
  std::optional<std::string> is_opt_response{};
  std::string mdp_parameters;
};

struct BeliefRow {
  std::string session;
  std::size_t period;
  std::string belief;
  std::optional<std::size_t> member{};
  double p_bec;
};

struct EventRow {
  std::string session;
  std::uint64_t seq;
  std::int64_t at_us;
  std::string actor, type, body;
};

struct ExportTables {
  explicit ExportTables(const SessionExportOptions& options);

  TableOf<SessionRow> sessions{kSessionsFile, "One room: a group that was taught together."};
  TableOf<ParticipantRow> participants{"participants.csv", "One person or stand-in in a room."};
  TableOf<PeriodRow> periods{"periods.csv", "One interaction period of a room: a lesson with its tests."};
  TableOf<TestRow> tests{"tests.csv", "One test of a person or stand-in, answered or not."};
  TableOf<DiscussionRow> discussions{
      "discussions.csv", "One answer before and after the group saw all answers, of people and of stand-ins."};
  TableOf<ExamRow> exams{"exams.csv", "One component in the exam of one person: what an inspector asks for."};
  TableOf<KeyRow> keys{"keypresses.csv", "One keypress, click or tap of an answer."};
  TableOf<QuestionRow> questions;
  TableOf<TrialRow> trials{"trials.csv",
                           "One demonstration, test or feedback of one person, in order, for 'kith fit'."};
  TableOf<BeliefRow> beliefs{"beliefs.csv", "What the teacher believed at the end of a period."};
  TableOf<EventRow> events{kEventsFile, "One event of a room: everything that happened, in order."};
};

}  // namespace kith
