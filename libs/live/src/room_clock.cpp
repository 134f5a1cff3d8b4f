#include <algorithm>

#include "room_state.hpp"

namespace kith {

using namespace happening;  // NOLINT(google-build-using-namespace): every event is named here

namespace {

// Collects what the clock demands, now or later.
class RoomClock {
 public:
  explicit RoomClock(const RoomParts& room)
      : room_{room}, state_{room.state}, group_{room.study.group()}, grace_{group_.dropout.grace_s * kSecond} {}

  std::vector<ClockEvent> events() && {
    if (room_.setup.is_waiting_list) {
      if (state_.phase == RoomPhase::kLobby) waiting_list();
    } else if (state_.phase == RoomPhase::kLobby) {
      lobby();
    } else if (state_.phase != RoomPhase::kEnded && !state_.paused_us) {
      absences();
      limits();
    }
    // Of equal times the first one that was found.
    std::stable_sort(events_.begin(), events_.end(),
                     [](const ClockEvent& a, const ClockEvent& b) { return a.at_us < b.at_us; });
    return std::move(events_);
  }

 private:
  void add(std::int64_t at_us, RoomHappening what) {
    events_.push_back({std::max(at_us, state_.last_us), {0, 0, "server", std::move(what)}});
  }

  void lobby() {
    const bool is_complete = std::all_of(state_.members.begin(), state_.members.end(), [&](const auto& member) {
      if (!member.seat) return false;
      const auto& seat = state_.seats[*member.seat];
      return !seat.is_person ||
             (seat.status == SeatStatus::kActive && seat.readiness == Readiness::kReady && seat.is_here);
    });
    if (is_complete && group_.auto_start) add(state_.last_us, Started{"server", false});
    release();
    if (!state_.lobby_us || group_.time.lobby_s == 0 || !group_.auto_start) return;
    const auto limit = *state_.lobby_us + group_.time.lobby_s * kSecond;
    const auto ready = std::count_if(state_.members.begin(), state_.members.end(), [&](const auto& member) {
      return member.seat && state_.seats[*member.seat].is_person && state_.seats[*member.seat].is_here &&
             state_.seats[*member.seat].readiness == Readiness::kReady;
    });
    if (group_.dropout.policy == DropoutPolicy::kSimulate && ready > 0) {
      add(limit, Started{"server", true});
    } else {
      add(limit, Ended{"lobby-time", "Not enough people came in time."});
    }
  }

  // Seats of people who are away or do not get ready.
  void release() {
    for (std::size_t i = 0; i < state_.seats.size(); ++i) {
      const auto& seat = state_.seats[i];
      if (!seat.is_person || seat.status != SeatStatus::kActive) continue;
      if (!seat.is_here) add(seat.presence_us + grace_, Released{i + 1, "away"});
      if (group_.time.lobby_s > 0 && seat.readiness != Readiness::kReady) {
        add(seat.joined_us + group_.time.lobby_s * kSecond, Released{i + 1, "not-ready"});
      }
    }
  }

  // As in the lobby of a group, but everybody's time begins when they are ready themselves.
  void waiting_list() {
    release();
    const auto wait_us = longest_wait_us(room_);
    if (wait_us == 0) return;
    for (std::size_t i = 0; i < state_.seats.size(); ++i) {
      const auto& seat = state_.seats[i];
      if (seat.status != SeatStatus::kActive || seat.readiness != Readiness::kReady) continue;
      add(seat.ready_us + wait_us, Released{i + 1, "lobby-time"});
    }
  }

  void absences() {
    const bool runs = is_running(state_);
    const auto policy = group_.dropout.policy;
    const auto wait = policy == DropoutPolicy::kContinueNow ? 0 : grace_;
    for (std::size_t i = 0; i < state_.seats.size(); ++i) {
      const auto& seat = state_.seats[i];
      if (!seat.is_person || seat.status != SeatStatus::kActive || seat.is_here) continue;
      if (!seat.member) {
        add(seat.presence_us + grace_, Released{i + 1, "away"});
        continue;
      }
      Dropped dropped{.seat = i + 1, .policy = std::string{name_of(policy)}};
      if (runs && policy == DropoutPolicy::kSimulate && num_active_people(state_) > 1) {
        dropped.by = state_.seats.size() + 1;
        dropped.type = std::string{seat.type};
      }
      if (!runs && stage_of_seat(room_, seat) == "debrief") continue;  // has finished
      add(seat.presence_us + wait, std::move(dropped));
    }
  }

  void limits() {
    if (state_.deadline_us) {
      add(*state_.deadline_us, TimeOver{std::string{rules_of(state_.phase).word}});
    }
    if (state_.session_deadline_us && is_running(state_)) {
      add(*state_.session_deadline_us, TimeOver{"session"});
    }
  }

  const RoomParts& room_;
  const Room::State& state_;
  const GroupOptions& group_;
  std::int64_t grace_;
  std::vector<ClockEvent> events_;
};

}  // namespace

std::vector<ClockEvent> clock_events(const RoomParts& room) { return RoomClock{room}.events(); }

}  // namespace kith
