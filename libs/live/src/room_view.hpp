#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "room_state.hpp"
#include "views.hpp"

namespace kith {

/// Milliseconds of microseconds, as views have them.
[[nodiscard]] inline std::int64_t in_ms(std::int64_t us) noexcept { return us / 1000; }

/// What a board says of the domain: LiveStudy::legend.
[[nodiscard]] Json board_legend(const Domain& domain);
/// A board as participants get it: the legend of the domain and the map.
[[nodiscard]] Json live_board(const Json& legend, const Atlas& atlas, StartIndex start);
[[nodiscard]] inline Json live_board(const LiveStudy& study, StartIndex start) {
  return live_board(*study.legend, *study.atlas, start);
}
/// The robot's path from there: path_json().
[[nodiscard]] Json robot_path(const LiveStudy& study, StartIndex start);
/// Runs of the robot from there, with outcomes as they fell, the same for everybody: runs_json(). Null where nothing is
/// left to chance.
[[nodiscard]] Json robot_runs(const LiveStudy& study, StartIndex start);

/// ParticipantView.
[[nodiscard]] Json participant_view(const RoomParts& room, std::size_t seat, std::int64_t now_us);
/// `feedback` of a participant.
[[nodiscard]] view::Feedback feedback_view(const RoomParts& room, const LiveSeat& seat);
/// `explore` of a participant: what can be explored and what was explored last. @pre can_explore() the domain.
[[nodiscard]] view::Explore explore_view(const RoomParts& room, const LiveSeat& seat);
/// Why the robot's path is better than another one, in words: "Your path makes the robot take 2 more steps than
/// needed."
[[nodiscard]] std::string cost_in_words(const Domain& domain, MdpIndex world, const IntegerVector& robot_counts,
                                        const IntegerVector& own_counts);

/// RoomRow.
[[nodiscard]] Json row_json(const RoomParts& room, RoomStage stage, const Viewer& viewer);
/// RoomDetail.
[[nodiscard]] Json detail_json(const RoomParts& room);

}  // namespace kith
