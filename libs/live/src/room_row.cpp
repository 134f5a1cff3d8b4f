#include <algorithm>
#include <cmath>

#include "kith/live/screening.hpp"
#include "live_texts.hpp"
#include "message_json.hpp"
#include "room_view.hpp"
#include "session_summary.hpp"

namespace kith {
namespace {

bool shows_code_to(const RoomParts& room, const LiveSeat& seat) {
  return seat.gets_code || stage_of_seat(room, seat) == "debrief";
}

class RoomRowPage {
 public:
  RoomRowPage(const RoomParts& room, RoomStage stage, const Viewer& viewer)
      : room_{room}, state_{room.state}, stage_{stage}, is_facilitator_{viewer.role == Viewer::Role::kFacilitator} {}

  [[nodiscard]] view::RoomRow row() const {
    const bool is_list = room_.setup.is_waiting_list;
    view::RoomRow row;
    row.at<"id">() = room_.setup.id;
    if (is_facilitator_) row.at<"code">() = room_.setup.code;
    row.at<"stage">() = stage_ == RoomStage::kRunning && state_.paused_us ? "paused" : name_of(stage_);
    row.at<"strategy">() = is_list ? "waiting list" : strategy_name(state_);
    row.at<"composition">() = room_.setup.composition;
    row.at<"waiting_list">() = is_list;
    for (std::size_t i = 0; i < state_.seats.size(); ++i) {
      if (state_.seats[i].last_page != "moved") row.at<"seats">().push_back(seat_row(i));
    }
    row.at<"period">() = current_period(state_);
    row.at<"component">() = component();
    if (state_.started_us) row.at<"started_ms">() = in_ms(*state_.started_us);
    row.at<"ended">() = state_.end_reason;
    row.at<"forecast">() = forecast();
    if (state_.next_strategy) row.at<"next_strategy">() = state_.next_strategy->name;
    return row;
  }

 private:
  // The one under way, or the next one, from 1.
  [[nodiscard]] std::size_t component() const {
    const auto components = components_of(state_);
    const auto open = std::find(components.begin(), components.end(), ComponentStatus::kOpen);
    const auto index = static_cast<std::size_t>(open - components.begin());
    return std::min(index + 1, components.size());
  }

  [[nodiscard]] view::SeatRow seat_row(std::size_t i) const {
    const auto& seat = state_.seats[i];
    const auto* waits = room_.setup.is_waiting_list ? "Waiting" : "Reserve";
    view::SeatRow row;
    row.at<"seat">() = i + 1;
    row.at<"label">() = seat.member ? member_label(*seat.member) : std::string{waits};
    if (is_facilitator_) row.at<"name">() = seat.name;
    row.at<"kind">() = seat.is_person ? "person" : "simulated";
    row.at<"type">() = seat.type;
    row.at<"presence">() = seat.is_here ? "here" : "away";
    if (seat.status == SeatStatus::kGone) row.at<"presence">() = "left";
    if (seat.status == SeatStatus::kEmpty) row.at<"presence">() = "empty";
    row.at<"status">() = status_of_seat(room_, seat);
    row.at<"dropped">() = seat.status == SeatStatus::kDropped;
    row.at<"since_ms">() = in_ms(seat.presence_us);
    if (seat.member && *seat.member != i) row.at<"member">() = *seat.member + 1;
    row.at<"stage">() = seat.is_person ? stage_of_seat(room_, seat) : std::string{"simulated"};
    if (seat.is_person && seat.since_us > 0) row.at<"stage_since_ms">() = in_ms(stage_since_us(seat));
    if (seat.tests > 0) {
      row.at<"right">() = seat.right;
      row.at<"tests">() = seat.tests;
    }

    if (!room_.study.screening.empty() && seat.screened.size() == room_.study.screening.size()) {
      const auto right = static_cast<std::size_t>(std::count(seat.screened.begin(), seat.screened.end(), true));
      row.at<"estimate">() = screening_estimate(right, seat.screened.size());
      row.at<"estimate_is_high">() = has_high_estimate(room_, seat);
    }
    if (is_facilitator_ && shows_code_to(room_, seat)) {
      row.at<"code">() = completion_code(room_.study, room_.setup.salt, room_.setup.id, i + 1);
    }
    return row;
  }

  // Since when the person has been on their page: what they finished last, or what the whole group began after it.
  [[nodiscard]] std::int64_t stage_since_us(const LiveSeat& seat) const {
    const bool moves_with_group = seat.status != SeatStatus::kGone && state_.phase != RoomPhase::kLobby && seat.member;
    return moves_with_group ? std::max(seat.since_us, state_.phase_us) : seat.since_us;
  }

  // From imagined sessions at the pace of this one so far, where the study has them; else from its own periods.
  [[nodiscard]] std::optional<view::Forecast> forecast() const {
    if (!is_running(state_) || state_.durations_us.empty()) return {};
    const auto& session = *state_.session;
    const auto imagined = room_.study.imagined.find({session.strategy().name, room_.setup.composition});
    if (imagined != room_.study.imagined.end()) return forecast_from(imagined->second);
    const auto components = session.components();
    const auto count = [&](ComponentStatus status) {
      return static_cast<std::size_t>(std::count(components.begin(), components.end(), status));
    };
    std::vector<double> minutes;
    for (const auto us : state_.durations_us) minutes.push_back(in_minutes(us));
    const auto left =
        extrapolate_remaining(count(ComponentStatus::kOpen), count(ComponentStatus::kLearned), session.periods(),
                              session.options().max_periods - session.periods(), minutes);
    return view::Forecast{
        left.mean_periods(), std::ceil(left.minutes_quantile(0.0)), std::ceil(left.minutes_quantile(1.0)), {}};
  }

  [[nodiscard]] view::Forecast forecast_from(const std::vector<PastSession>& sessions) const {
    const auto& session = *state_.session;
    const auto components = session.components();
    SessionPlace place;
    place.stage = static_cast<std::size_t>(std::find(components.begin(), components.end(), ComponentStatus::kOpen) -
                                           components.begin());
    double assumed = 0.0, took = 0.0;  // minutes of the periods so far
    for (const auto& past : session.history()) {
      place.periods += past.lesson.component == place.stage ? 1u : 0u;
      assumed += minutes_of(room_.study.spec.teaching.pace, past);
    }
    for (const auto us : state_.durations_us) took += in_minutes(us);
    const auto left = forecast_remaining(sessions, place).at_pace(assumed > 0.0 ? took / assumed : 1.0);
    constexpr double kLow = 0.1, kHigh = 0.9;
    return {left.mean_periods(),
            std::ceil(left.minutes_quantile(kLow)),
            std::ceil(left.minutes_quantile(kHigh)),
            {left.done_within(1), left.done_within(2), left.done_within(3)}};
  }

  [[nodiscard]] static double in_minutes(std::int64_t us) {
    return static_cast<double>(us) / (60.0 * static_cast<double>(kSecond));
  }

  const RoomParts& room_;
  const Room::State& state_;
  RoomStage stage_;
  bool is_facilitator_;
};

}  // namespace

Json row_json(const RoomParts& room, RoomStage stage, const Viewer& viewer) {
  return written(RoomRowPage{room, stage, viewer}.row());
}

bool Room::shows_code(std::size_t seat) const {
  return shows_code_to({*study_, *setup_, *state_}, state_->seats.at(seat - 1));
}

Json Room::row(const Viewer& viewer) const { return row_json({*study_, *setup_, *state_}, stage(), viewer); }

Json Room::view(const Viewer& viewer, std::int64_t now_us) const {
  const RoomParts parts{*study_, *setup_, *state_};
  if (viewer.role == Viewer::Role::kParticipant) {
    if (viewer.seat < 1 || viewer.seat > state_->seats.size() || !state_->seats[viewer.seat - 1].is_person) {
      throw std::invalid_argument{"Room::view: no person has this seat"};
    }
    return participant_view(parts, viewer.seat - 1, now_us);
  }
  return {{"row", row_json(parts, stage(), viewer)}, {"room", detail_json(parts)}};
}

}  // namespace kith
