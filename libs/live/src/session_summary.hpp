#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "room_state.hpp"

namespace kith {

/// What the robot is like, one sentence for each constraint, for the last page.
struct RobotInWords {
  std::vector<std::string> taught;       ///< Of the components that the group had lessons about.
  std::vector<std::string> not_reached;  ///< Of the others.
};

/// What pages and digests need of a session when teaching is over. A few kilobytes, where a session has hundreds.
struct SessionSummary {
  std::string strategy;
  std::size_t periods = 0;
  std::vector<ComponentStatus> components;
  std::optional<Lesson> last_lesson;                         ///< Of the last period.
  std::vector<HalfSpace> taught;                             ///< See taught_so_far().
  RobotInWords robot;                                        ///< See robot_in_words().
  std::vector<std::pair<std::string, std::string>> beliefs;  ///< See belief_points().
  std::vector<bool> has_learner;                             ///< By member: whether it was simulated at the end.
  std::string digest;
  std::string digest_before;  ///< Of State::before; empty without one.
};

/// The state with the summary in place of the session, the beliefs and the simulated learners.
/// @pre teaching is over, and the state has its session.
[[nodiscard]] Room::State released_state(const RoomParts& room);

// --- the same before and after ---------------------------------------------------------------------------------------

/// Name of the strategy that taught last.
[[nodiscard]] const std::string& strategy_name(const Room::State& state);
/// Completed periods.
[[nodiscard]] std::size_t num_periods(const Room::State& state);
/// The period that people are in, from 1. While they read feedback the next lesson may be there: it does not count.
[[nodiscard]] std::size_t current_period(const Room::State& state);
[[nodiscard]] std::span<const ComponentStatus> components_of(const Room::State& state);
/// The lesson of the last completed period; null if there is none.
[[nodiscard]] const Lesson* last_lesson(const Room::State& state);
/// What the demonstrations of all completed periods conveyed, in order.
[[nodiscard]] std::vector<HalfSpace> taught_so_far(const Room::State& state);
[[nodiscard]] RobotInWords robot_in_words(const RoomParts& room);
/// Particles of the beliefs about the members and of the aggregated ones, by name: int16 little endian x, y, z in
/// base64. Empty for a waiting list and for rewards of more or fewer than three weights.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> belief_points(const RoomParts& room);

}  // namespace kith
