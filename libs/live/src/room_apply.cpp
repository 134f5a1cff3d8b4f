#include <algorithm>
#include <variant>

#include "exploration.hpp"
#include "room_stepper.hpp"
#include "session_summary.hpp"

namespace kith {

using namespace happening;  // NOLINT(google-build-using-namespace): every event is named here

namespace {

// What each type of event changes. Events have been checked: decide(), due() or taught() led to them.
class RoomChange {
 public:
  RoomChange(const RoomParts& room, const RoomEvent& event, TeachingCache& cache, const TaughtLesson* lesson)
      : study_{room.study},
        setup_{room.setup},
        event_{event},
        lesson_{lesson},
        state_{room.state},
        step_{study_, setup_, state_, cache, event.at_us} {}

  Room::State result() && {
    state_.seq = event_.seq;
    state_.last_us = event_.at_us;
    std::visit([&](const auto& what) { happen(what); }, event_.what);
    step_.settle();
    return std::move(state_);
  }

 private:
  // --- who it is about ---
  [[nodiscard]] std::size_t actor() const { return *seat_of_actor(event_.actor) - 1; }
  [[nodiscard]] LiveSeat& who() { return state_.seats[actor()]; }

  // --- the way to the lobby ---
  void happen(const Joined& e) {
    const auto seat = e.seat - 1;
    if (seat == state_.seats.size()) state_.seats.emplace_back();
    auto& person = state_.seats[seat];
    person.status = SeatStatus::kActive;
    person.is_here = true;
    person.presence_us = person.joined_us = person.since_us = event_.at_us;
    person.member.reset();
    if (!e.member) return;
    person.member = e.member;
    person.type = setup_.composition[*e.member];
    state_.members[*e.member].seat = seat;
  }
  void happen(const Consented& e) {
    who().readiness = Readiness::kCheck;
    who().query = e.query;
    who().since_us = event_.at_us;
  }
  void happen(const Declined&) { step_.dismiss(actor(), "declined", "declined", false); }
  void happen(const Checked&) {
    who().readiness = study_.screening.empty() ? Readiness::kReady : Readiness::kScreening;
    note_ready(who());
  }
  void happen(const Named& e) { who().name = e.name; }
  void happen(const Screened& e) {
    who().screened.push_back(e.right);
    if (who().screened.size() == study_.screening.size()) who().readiness = Readiness::kReady;
    note_ready(who());
  }
  void note_ready(LiveSeat& seat) {
    seat.since_us = event_.at_us;
    if (seat.readiness != Readiness::kReady) return;
    seat.ready_us = event_.at_us;
    if (!state_.lobby_us) state_.lobby_us = event_.at_us;
  }
  void happen(const Released& e) {
    const bool away = e.why == "away";
    const bool in_vain = e.why == "lobby-time";
    const auto& seat = state_.seats[e.seat - 1];
    step_.dismiss(e.seat - 1, away ? "replaced" : "ended", e.why,
                  in_vain || (seat.readiness == Readiness::kReady && state_.started_us.has_value()));
  }

  // --- from the waiting list to a group ---
  void happen(const Grouped& e) {
    ++state_.groups[e.strategy + "/" + e.composition];
    for (const auto& number : e.seats) {
      if (number) move(*number - 1, "grouped");
    }
  }
  // Somebody on the waiting list has a place in a group from now on.
  void move(std::size_t seat, const char* why) {
    step_.dismiss(seat, "moved", why, false);
    state_.seats[seat].name.clear();
    state_.seats[seat].query = Json{};
  }
  void happen(const Seated& e) {
    auto& person = state_.seats[e.seat - 1];
    person.status = SeatStatus::kActive;
    person.readiness = Readiness::kReady;
    person.is_here = true;
    person.presence_us = person.joined_us = person.since_us = event_.at_us;
    person.ready_us = e.ready_us;
    person.name = e.name;
    person.query = e.query;
    person.screened = e.screened;
    if (!state_.lobby_us) state_.lobby_us = event_.at_us;
  }

  void happen(const Started& e) {
    for (std::size_t m = 0; m < state_.members.size(); ++m) {
      if (const auto seat = state_.members[m].seat) {
        const auto& holder = state_.seats[*seat];
        if (!holder.is_person || (holder.status == SeatStatus::kActive && holder.readiness == Readiness::kReady)) {
          continue;
        }
        const bool came = holder.status == SeatStatus::kActive;
        step_.dismiss(*seat, "full", "started", came && study_.group().completion.pay_full);
      }
      if (e.fill) step_.seat_stand_in(m, setup_.composition[m]);
    }
    step_.begin();
  }

  // --- a period ---
  void happen(const LessonChosen&) { step_.take_lesson(*lesson_); }
  void happen(const Watched&) {
    ++who().watched;
    who().since_us = event_.at_us;
  }
  void happen(const Drafted& e) { who().draft = e.actions; }
  void happen(const Answered& e) {
    auto& person = who();
    const auto judged = judged_or_left(state_.session->lesson().tests.at(e.test).start, e);
    person.paths.at(e.test) = GivenPath{e.actions, e.for_ever, judged.is_finished, judged.counts, e.ms};
    person.draft.clear();
    person.since_us = event_.at_us;
    if (current_test(person) == person.paths.size()) step_.give_answers(actor());
  }
  template <typename Event>
  [[nodiscard]] JudgedPath judged_or_left(StartIndex start, const Event& e) const {
    if (e.erased.is_null()) return judged_path(*study_.atlas, start, e.actions, e.for_ever);
    JudgedPath judged;
    judged.is_finished = e.erased.at("finished").template get<bool>();
    if (const auto& counts = e.erased.at("counts"); !counts.is_null()) {
      auto& vector = judged.counts.emplace(counts.size());
      for (std::size_t k = 0; k < counts.size(); ++k) vector[k] = counts[k].template get<std::int64_t>();
    }
    return judged;
  }
  void happen(const Discussed& e) {
    who().choices.at(e.test) = BoardChoice{e.choice};
    who().since_us = event_.at_us;
  }
  void happen(const Continued&) {
    who().has_continued = true;
    who().since_us = event_.at_us;
  }
  void happen(const Explored& e) {
    auto& person = who();
    if (e.start.is_null()) return;
    auto found = explored(study_, e);
    for (auto& half_space : found.conveyed) {
      if (std::ranges::find(person.explored, half_space) == person.explored.end()) {
        person.explored.push_back(std::move(half_space));
      }
    }
    person.exploration = std::make_shared<const view::Explored>(std::move(found.shown));
    ++person.explorations;
  }
  void happen(const Examined& e) {
    auto& person = who();
    const auto counts = judged_or_left(StartIndex{e.start}, e).counts;
    person.exam.push_back(exam_board(*study_.atlas, StartIndex{e.start}, counts, num_periods(state_) + e.test + 1));
    person.since_us = event_.at_us;
    step_.examine(actor());
  }
  void happen(const QuestionsAnswered&) {
    who().has_answered_questions = true;
    who().since_us = event_.at_us;
  }

  void happen(const TimeOver& e) {
    if (e.what == "session") return step_.begin_questions("time-limit");
    for (std::size_t i = 0; i < state_.seats.size(); ++i) {
      if (gates(state_.seats[i]) && !has_done_phase(state_, state_.seats[i])) step_.finish_phase(i);
    }
    state_.deadline_us.reset();
  }

  // --- who is there ---
  void happen(const Away& e) { set_presence(e.seat - 1, false); }
  void happen(const Present& e) {
    set_presence(e.seat - 1, true);
    auto& seat = state_.seats[e.seat - 1];
    if (seat.status == SeatStatus::kDropped) seat.status = SeatStatus::kActive;
  }
  void set_presence(std::size_t number, bool is_here) {
    auto& seat = state_.seats[number];
    seat.is_here = is_here;
    seat.presence_us = event_.at_us;
  }

  void happen(const Dropped& e) {
    const auto seat = e.seat - 1;
    if (!is_running(state_)) {
      state_.seats[seat].status = SeatStatus::kDropped;
      return;
    }
    if (!e.type) {
      state_.seats[seat].status = SeatStatus::kDropped;
      state_.seats[seat].in_period = false;
    } else {
      const auto member = *state_.seats[seat].member;
      step_.dismiss(seat, "replaced", "away", true);
      step_.seat_stand_in(member, e.type->front());
    }
    after_departure();
  }

  void happen(const Left& e) {
    const auto seat = actor();
    const auto& person = state_.seats[seat];
    const auto member = person.member;
    const bool held = member && state_.members[*member].seat == seat;
    const auto waited_us = event_.at_us - person.ready_us;
    const bool waited =
        person.readiness == Readiness::kReady && waited_us >= study_.group().time.leave_after_s * kSecond;
    step_.dismiss(seat, "ended", "left", state_.phase != RoomPhase::kLobby || waited);
    if (!is_running(state_) || !held) return;
    if (e.type) step_.seat_stand_in(*member, e.type->front());
    after_departure();
  }

  void after_departure() {
    const auto& dropout = study_.group().dropout;
    if (dropout.policy == DropoutPolicy::kEndGroup) {
      return step_.end("member-left", "Somebody in your group had to stop, so the session is over for everybody.");
    }
    const auto least = dropout.policy == DropoutPolicy::kSimulate ? 1 : dropout.min_active;
    if (num_active_people(state_) < least) {
      step_.end("too-few", "Too few people are left in your group to go on.");
    }
  }

  // --- facilitators ---
  void happen(const Paused&) { state_.paused_us = event_.at_us; }
  void happen(const Resumed&) {
    const auto pause_us = event_.at_us - *state_.paused_us;
    if (state_.deadline_us) *state_.deadline_us += pause_us;
    if (state_.session_deadline_us) *state_.session_deadline_us += pause_us;
    for (auto& seat : state_.seats) {  // the grace period begins anew
      if (!seat.is_here && seat.status == SeatStatus::kActive) seat.presence_us = event_.at_us;
    }
    state_.paused_us.reset();
  }
  void happen(const Extended& e) {
    const auto more_us = e.seconds * kSecond;
    if (state_.deadline_us) *state_.deadline_us += more_us;
    if (state_.session_deadline_us) *state_.session_deadline_us += more_us;
  }
  void happen(const MessageSent& e) {
    LiveNotice notice{e.text, event_.at_us, {}};
    if (e.seat) notice.seat = *e.seat - 1;
    state_.notices.push_back(std::move(notice));
  }
  void happen(const Readmitted& e) {
    const auto seat = e.seat - 1;
    const auto member = *state_.seats[seat].member;
    auto& place = state_.members[member];
    if (place.seat && *place.seat != seat) step_.dismiss(*place.seat, "", "readmitted", false);
    place.seat = seat;
    place.learner.reset();
    place.is_new = true;
    auto& person = state_.seats[seat];
    person.status = SeatStatus::kActive;
    person.last_page.clear();
    person.why.clear();
    person.gets_code = false;
    person.in_period = false;
    if (!person.is_here) person.presence_us = event_.at_us;
  }
  void happen(const Simulated& e) {
    const auto seat = e.seat - 1;
    const auto member = *state_.seats[seat].member;
    const bool was_empty = state_.seats[seat].status == SeatStatus::kEmpty;
    if (state_.seats[seat].status != SeatStatus::kGone) {
      step_.dismiss(seat, was_empty ? "full" : "replaced", "simulated", !was_empty);
    }
    step_.seat_stand_in(member, e.type.front());
  }
  void happen(const StrategyNamed& e) {
    state_.next_strategy = strategy_of(study_.spec, e.name);
    if (*state_.next_strategy == state_.session->strategy()) state_.next_strategy.reset();
  }
  void happen(const Ended& e) { step_.end(event_.actor == "facilitator" ? "facilitator" : e.reason, e.text); }

  const LiveStudy& study_;
  const RoomSetup& setup_;
  const RoomEvent& event_;
  const TaughtLesson* lesson_;
  Room::State state_;
  RoomStepper step_;
};

}  // namespace

Room::State state_after(const RoomParts& room, const RoomEvent& event, TeachingCache& cache,
                        const TaughtLesson* lesson) {
  return RoomChange{room, event, cache, lesson}.result();
}

}  // namespace kith
