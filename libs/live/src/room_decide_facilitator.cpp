#include <algorithm>

#include "room_body.hpp"
#include "room_state.hpp"

namespace kith {

using namespace happening;  // NOLINT(google-build-using-namespace): every event is named here

namespace {

constexpr std::size_t kMostReasonBytes = 500;
constexpr std::size_t kMostMessageBytes = 2000;

class FacilitatorDecider {
 public:
  FacilitatorDecider(const RoomParts& room, const RoomCommand& command, std::int64_t now_us)
      : room_{room}, state_{room.state}, command_{command}, now_us_{now_us} {}

  [[nodiscard]] Decision decide() {
    if (!is_command(RoomSender::kFacilitator, command_.type)) {
      return refused("unknown-type", "There is no command '" + command_.type + "'.");
    }
    if (!command_.body.is_object()) return refused("bad-body", "The body of a command must be an object.");
    const auto reason = text_in(command_.body, "reason", kMostReasonBytes);
    if (!reason) return refused("no-reason", "State a reason; it is kept with the data.");
    reason_ = *reason;
    if (state_.phase == RoomPhase::kEnded) return refused("not-now", "This session has ended.");
    const bool is_for_groups = command_.type != MessageSent::kKind.command && command_.type != Ended::kKind.command;
    if (room_.setup.is_waiting_list && is_for_groups) {
      return not_now("This is the waiting list: it forms groups by itself, and each gets a room of its own.");
    }
    return asked<RoomSender::kFacilitator>(command_.type, [&](auto kind) { return ask(kind); });
  }

 private:
  [[nodiscard]] Decision accepted(RoomHappening what) const {
    return {{{state_.seq + 1, now_us_, command_.actor, std::move(what)}}, {}};
  }
  [[nodiscard]] static Decision not_now(std::string text) { return refused("not-now", std::move(text)); }

  [[nodiscard]] Decision ask(OfKind<Started>) const {
    if (state_.phase != RoomPhase::kLobby) return not_now("This session has already started.");
    std::size_t ready = 0, people = 0;
    for (const auto& member : state_.members) {
      if (!member.seat) {
        ++people;
        continue;
      }
      const auto& seat = state_.seats[*member.seat];
      people += seat.is_person ? 1 : 0;
      ready += seat.is_person && seat.status == SeatStatus::kActive && seat.readiness == Readiness::kReady ? 1 : 0;
    }
    if (people > 0 && ready < room_.study.group().dropout.min_active) {
      return refused("too-few", std::to_string(ready) + " of at least " +
                                    std::to_string(room_.study.group().dropout.min_active) +
                                    " people are ready in the lobby.");
    }
    return accepted(Started{"facilitator", false, reason_});
  }

  [[nodiscard]] Decision ask(OfKind<Paused>) const {
    if (!is_running(state_) && state_.phase != RoomPhase::kQuestions) return not_now("This session is not running.");
    return state_.paused_us ? nothing_to_do() : accepted(Paused{reason_});
  }
  [[nodiscard]] Decision ask(OfKind<Resumed>) const {
    return state_.paused_us ? accepted(Resumed{reason_}) : nothing_to_do();
  }

  [[nodiscard]] Decision ask(OfKind<Extended>) const {
    const auto seconds = integer_in(command_.body, "seconds", 1, 86'400);
    if (!seconds) return refused("bad-body", "'seconds' must be a number from 1 to 86400.");
    if (!state_.deadline_us && !state_.session_deadline_us) return not_now("No time limit applies at the moment.");
    return accepted(Extended{*seconds, reason_});
  }

  [[nodiscard]] Decision ask(OfKind<MessageSent>) const {
    const auto text = text_in(command_.body, "text", kMostMessageBytes);
    if (!text) return refused("bad-body", "'text' is missing or too long.");
    const auto seat = command_.body.find("seat");
    if (seat == command_.body.end() || seat->is_null()) return accepted(MessageSent{*text, std::nullopt, reason_});
    const auto number = seat_number();
    if (!number) return no_seat();
    return accepted(MessageSent{*text, *number + 1, reason_});
  }

  [[nodiscard]] std::optional<std::size_t> seat_number() const {
    const auto number = integer_in(command_.body, "seat", 1, static_cast<std::int64_t>(state_.seats.size()));
    if (!number) return std::nullopt;
    return static_cast<std::size_t>(*number) - 1;
  }
  [[nodiscard]] static Decision no_seat() { return refused("no-seat", "There is no such place in this group."); }

  [[nodiscard]] Decision ask(OfKind<Readmitted>) const {
    const auto number = seat_number();
    if (!number || !state_.seats[*number].is_person) return no_seat();
    const auto& seat = state_.seats[*number];
    if (seat.status == SeatStatus::kActive || seat.status == SeatStatus::kEmpty) return nothing_to_do();
    if (!seat.member || seat.readiness != Readiness::kReady || !is_running(state_)) {
      return not_now("This person has no place in the running session.");
    }
    const auto& holder = state_.members[*seat.member].seat;
    if (holder && *holder != *number && state_.seats[*holder].is_person) {
      return not_now("Another person has taken the place.");
    }
    return accepted(Readmitted{*number + 1, reason_});
  }

  [[nodiscard]] Decision ask(OfKind<Simulated>) const {
    const auto number = seat_number();
    if (!number || !state_.seats[*number].is_person) return no_seat();
    const auto& seat = state_.seats[*number];
    if (!is_running(state_) && state_.phase != RoomPhase::kLobby) return not_now("The lessons are over.");
    const auto& holder = state_.members[*seat.member].seat;
    if (holder && *holder != *number) return not_now("Somebody else has the place already.");
    std::string type{seat.type};
    if (command_.body.contains("type") && !command_.body["type"].is_null()) {
      const auto given = text_in(command_.body, "type", 1);
      if (!given || given->empty() || !is_type(given->front())) {
        return refused("no-type", "The study has no learner type of this letter.");
      }
      type = *given;
    }
    const bool is_counted = seat.status == SeatStatus::kActive;
    if (is_running(state_) && num_active_people(state_) <= (is_counted ? 1 : 0)) {
      return not_now("No person would be left in the group; end the session instead.");
    }
    return accepted(Simulated{*number + 1, type, state_.seats.size() + 1, reason_});
  }

  [[nodiscard]] bool is_type(char letter) const {
    const auto& types = room_.study.spec.learner_types;
    return std::any_of(types.begin(), types.end(), [&](const LearnerType& type) { return type.letter == letter; });
  }

  [[nodiscard]] Decision ask(OfKind<StrategyNamed>) const {
    const auto name = text_in(command_.body, "name", 200);
    if (!name) return refused("bad-body", "'name' is missing.");
    const auto& all = room_.study.spec.strategies;
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == *name; });
    if (found == all.end()) return refused("no-strategy", "This study has no strategy '" + *name + "'.");
    if (found->is_baseline() && state_.members.size() > 1) {
      return refused("no-strategy", "The baseline teaches one person at a time.");
    }
    if (found->kind.name == "plan" && room_.setup.lessons < 2) {
      return refused("no-strategy", "This room was set up by an older version, whose 'plan' chose other lessons.");
    }
    if (!is_running(state_) && state_.phase != RoomPhase::kLobby) return not_now("The lessons are over.");
    return accepted(StrategyNamed{*name, reason_});
  }

  [[nodiscard]] Decision ask(OfKind<Ended>) const {
    return accepted(Ended{reason_, "The session was ended by the people who run it."});
  }

  const RoomParts& room_;
  const Room::State& state_;
  const RoomCommand& command_;
  std::int64_t now_us_;
  std::string reason_;
};

}  // namespace

Decision decide_facilitator(const RoomParts& room, const RoomCommand& command, std::int64_t now_us) {
  return FacilitatorDecider{room, command, now_us}.decide();
}

}  // namespace kith
