#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace kith {

/// A path as numbers of actions, which may go on like this for ever.
struct AnswerPath {
  std::vector<int> actions;
  bool for_ever = false;
};

/// A rehearsal: groups of simulated people who use a server through its real protocol, as browsers do.
struct RehearsalOptions {
  std::uint16_t port = 0;   ///< On this machine.
  std::string facilitator;  ///< Token of a facilitator: makes the rooms, and ends them when time is up.
  /// Token of an observer: with it, an observer and a facilitator look at one group after another all the time.
  std::string observer{};
  std::size_t groups = 1;
  /// For how long: groups that finish are followed by new ones, and when time is up all are ended. 0: until everybody
  /// has finished.
  std::chrono::milliseconds duration{0};
  std::chrono::milliseconds answer_every{5'000};  ///< How long a person takes for an answer, on average.
  double reconnects = 0.0;                        ///< Share of people who lose their connection, per second.
  double right = 0.8;  ///< Share of right answers, where they are known; others stop a step too early.
  /// A right answer; nothing, as without the function, if it is not known. @param world  its key; @param start  number
  /// of the state.
  std::function<std::optional<AnswerPath>(const std::string& world, int start)> right_path{};
  /// Called about every 100 ms with the time since the start; false ends the rehearsal.
  std::function<bool(std::chrono::milliseconds elapsed)> on_tick{};
};

/// Times in milliseconds.
struct LatencySummary {
  std::size_t count = 0;
  double p50 = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

/// What came of it.
struct RehearsalResult {
  std::size_t groups = 0;  ///< All of them, with those that followed others.
  std::size_t people = 0;  ///< In all of them.
  double seconds = 0.0;
  LatencySummary acknowledgement{};  ///< From sending a message to its acknowledgement, over one connection.
  LatencySummary next_lesson{};      ///< From the last "continue" of a group to each member's first demonstration.
  LatencySummary reconnect{};        ///< From losing a connection to the first view after it, without the wait.
  std::uint64_t messages = 0;        ///< Acknowledged.
  std::uint64_t refused = 0;         ///< Refused with a reason.
  std::uint64_t unanswered = 0;      ///< Neither, when it was over.
  std::uint64_t reconnects = 0;
  std::uint64_t connections_lost = 0;               ///< Not by the rehearsal itself.
  std::map<std::string, std::size_t> stages{};      ///< How many people ended where.
  std::map<std::string, std::uint64_t> refusals{};  ///< How often for which reason.
  std::set<std::string> problems{};                 ///< What the pages of those who look told of.
  std::vector<std::string> answers{};  ///< Ids of all acknowledged answers: each must be in the store once.

  /// How many people came to an end: debrief, ended, declined, full or replaced.
  [[nodiscard]] std::size_t num_finished() const;
};

/// Runs it. @throws kith::Error (kIo) if the server cannot be reached or makes no rooms.
[[nodiscard]] RehearsalResult rehearse(const RehearsalOptions& options);

}  // namespace kith
