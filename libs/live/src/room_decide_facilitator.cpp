#include <algorithm>

#include "room_body.hpp"

namespace kith {

using namespace happening;  // NOLINT(google-build-using-namespace): every event is named here

namespace {

class FacilitatorDecider : Decider {
 public:
  using Decider::Decider;

  [[nodiscard]] Decision decide() const {
    if (!is_command(RoomSender::kFacilitator, command_.type)) {
      return refused("unknown-type", "There is no command '" + command_.type + "'.");
    }
    if (!command_.body.is_object()) return refused("bad-body", "The body of a command must be an object.");
    if (!read_within<std::string>(command_.body.value("reason", Json{}), kReason)) return refused(kReason);
    if (state_.phase == RoomPhase::kEnded) return refused("not-now", "This session has ended.");
    const bool is_for_groups = command_.type != MessageSent::kKind.command && command_.type != Ended::kKind.command;
    if (room_.setup.is_waiting_list && is_for_groups) {
      return not_now("This is the waiting list: it forms groups by itself, and each gets a room of its own.");
    }
    return asked<RoomSender::kFacilitator>(*this, command_, {});
  }

  [[nodiscard]] Decision ask(Started started) const {
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
    started.by = "facilitator";
    return accepted(std::move(started));
  }

  [[nodiscard]] Decision ask(Paused paused) const {
    if (!is_running(state_) && state_.phase != RoomPhase::kQuestions) return not_now("This session is not running.");
    return state_.paused_us ? nothing_to_do() : accepted(std::move(paused));
  }
  [[nodiscard]] Decision ask(Resumed resumed) const {
    return state_.paused_us ? accepted(std::move(resumed)) : nothing_to_do();
  }

  [[nodiscard]] Decision ask(Extended extended) const {
    if (!state_.deadline_us && !state_.session_deadline_us) return not_now("No time limit applies at the moment.");
    return accepted(std::move(extended));
  }

  [[nodiscard]] Decision ask(MessageSent message) const {
    if (message.seat && *message.seat > state_.seats.size()) return refused(kPlace);
    return accepted(std::move(message));
  }

  [[nodiscard]] Decision ask(Readmitted readmitted) const {
    if (!is_person(readmitted.seat)) return refused(kPlace);
    const auto& seat = state_.seats[readmitted.seat - 1];
    if (seat.status == SeatStatus::kActive || seat.status == SeatStatus::kEmpty) return nothing_to_do();
    if (!seat.member || seat.readiness != Readiness::kReady || !is_running(state_)) {
      return not_now("This person has no place in the running session.");
    }
    const auto& holder = state_.members[*seat.member].seat;
    if (holder && *holder != readmitted.seat - 1 && state_.seats[*holder].is_person) {
      return not_now("Another person has taken the place.");
    }
    return accepted(std::move(readmitted));
  }

  [[nodiscard]] Decision ask(Simulated simulated) const {
    if (!is_person(simulated.seat)) return refused(kPlace);
    const auto& seat = state_.seats[simulated.seat - 1];
    if (!is_running(state_) && state_.phase != RoomPhase::kLobby) return not_now("The lessons are over.");
    const auto& holder = state_.members[*seat.member].seat;
    if (holder && *holder != simulated.seat - 1) return not_now("Somebody else has the place already.");
    if (simulated.type.empty()) simulated.type = seat.type;
    if (!is_type(simulated.type.front())) return refused("no-type", std::string{kNoType});
    const bool is_counted = seat.status == SeatStatus::kActive;
    if (is_running(state_) && num_active_people(state_) <= (is_counted ? 1 : 0)) {
      return not_now("No person would be left in the group; end the session instead.");
    }
    simulated.by = state_.seats.size() + 1;
    return accepted(std::move(simulated));
  }

  [[nodiscard]] Decision ask(StrategyNamed named) const {
    const auto& all = room_.study.spec.strategies;
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == named.name; });
    if (found == all.end()) return refused("no-strategy", "This study has no strategy '" + named.name + "'.");
    if (found->is_baseline() && state_.members.size() > 1) {
      return refused("no-strategy", "The baseline teaches one person at a time.");
    }
    if (found->kind.name == "plan" && room_.setup.lessons < 2) {
      return refused("no-strategy", "This room was set up by an older version, whose 'plan' chose other lessons.");
    }
    if (!is_running(state_) && state_.phase != RoomPhase::kLobby) return not_now("The lessons are over.");
    return accepted(std::move(named));
  }

  [[nodiscard]] Decision ask(Ended ended) const {
    ended.text = "The session was ended by the people who run it.";
    return accepted(std::move(ended));
  }

 private:
  [[nodiscard]] static Decision not_now(std::string text) { return refused("not-now", std::move(text)); }
  [[nodiscard]] bool is_person(std::size_t seat) const {
    return seat <= state_.seats.size() && state_.seats[seat - 1].is_person;
  }
  [[nodiscard]] bool is_type(char letter) const {
    const auto& types = room_.study.spec.learner_types;
    return std::any_of(types.begin(), types.end(), [&](const LearnerType& type) { return type.letter == letter; });
  }
};

}  // namespace

Decision decide_facilitator(const RoomParts& room, const RoomCommand& command, std::int64_t now_us) {
  return FacilitatorDecider{room, command, now_us}.decide();
}

}  // namespace kith
