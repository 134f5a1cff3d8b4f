#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "kith/study/group_options.hpp"

namespace kith {

/// The stage of a room.
enum class RoomStage { kLobby, kRunning, kQuestions, kEnded };
[[nodiscard]] constexpr std::string_view name_of(RoomStage stage) noexcept {
  switch (stage) {
    case RoomStage::kLobby:
      return "lobby";
    case RoomStage::kRunning:
      return "running";
    case RoomStage::kQuestions:
      return "questions";
    case RoomStage::kEnded:
      return "ended";
  }
  return {};
}

/// What the group in a room does. The order stays: digests count in it.
enum class RoomPhase { kLobby, kTeaching, kWatching, kTesting, kFeedback, kQuestions, kEnded, kDiscussing };

/// What holds in a phase: one row per phase.
struct PhaseRules {
  RoomStage stage;
  std::string_view word;             ///< Also the page of who has something to do, and the limit in TimeOver.
  std::string_view waits_for;        ///< What who has done their part waits for.
  std::int64_t GroupTime::*limit{};  ///< In seconds; null: none.
  bool has_open_lesson = false;      ///< Session::lesson() is what people work on: its feedback is still to come.
};

[[nodiscard]] constexpr PhaseRules rules_of(RoomPhase phase) noexcept {
  switch (phase) {
    case RoomPhase::kLobby:
      return {RoomStage::kLobby, "lobby", "teacher"};
    case RoomPhase::kTeaching:
      return {RoomStage::kRunning, "teacher", "teacher"};
    case RoomPhase::kWatching:
      return {RoomStage::kRunning, "watch", "others-watching", &GroupTime::watch_s, true};
    case RoomPhase::kTesting:
      return {RoomStage::kRunning, "predict", "answers", &GroupTime::predict_s, true};
    case RoomPhase::kDiscussing:
      return {RoomStage::kRunning, "discuss", "discussion", &GroupTime::discuss_s, true};
    case RoomPhase::kFeedback:
      return {RoomStage::kRunning, "feedback", "feedback", &GroupTime::feedback_s};
    case RoomPhase::kQuestions:
      return {RoomStage::kQuestions, "questions", "teacher"};
    case RoomPhase::kEnded:
      return {RoomStage::kEnded, "ended", "teacher"};
  }
  return {};
}

/// The page of an exam, which everybody takes alone before the questions.
inline constexpr std::string_view kExamPage = "exam";

/// The phase in which people have something to do on this page; nothing for pages that belong to no phase, such as
/// "consent" and "wait".
[[nodiscard]] constexpr std::optional<RoomPhase> phase_of_page(std::string_view page) noexcept {
  for (int i = 0; !rules_of(RoomPhase{i}).word.empty(); ++i) {
    if (rules_of(RoomPhase{i}).word == page) return RoomPhase{i};
  }
  return std::nullopt;
}

}  // namespace kith
