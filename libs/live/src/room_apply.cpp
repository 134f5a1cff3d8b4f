#include <algorithm>
#include <map>

#include "kith/core/error.hpp"
#include "room_stepper.hpp"

namespace kith {
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
    using Rule = void (RoomChange::*)();
    static const std::map<std::string_view, Rule> kRules{
        {"joined", &RoomChange::joined},       {"consented", &RoomChange::consented},
        {"declined", &RoomChange::declined},   {"checked", &RoomChange::checked},
        {"named", &RoomChange::named},         {"screened", &RoomChange::screened},
        {"started", &RoomChange::started},     {"lesson", &RoomChange::taught},
        {"watched", &RoomChange::watched},     {"draft", &RoomChange::draft},
        {"answered", &RoomChange::answered},   {"continued", &RoomChange::continued},
        {"questions", &RoomChange::questions}, {"left", &RoomChange::left},
        {"away", &RoomChange::away},           {"present", &RoomChange::present},
        {"dropped", &RoomChange::dropped},     {"released", &RoomChange::released},
        {"time", &RoomChange::time_is_over},   {"pause", &RoomChange::pause},
        {"resume", &RoomChange::resume},       {"extend", &RoomChange::extend},
        {"message", &RoomChange::message},     {"readmit", &RoomChange::readmit},
        {"simulate", &RoomChange::simulate},   {"strategy", &RoomChange::strategy},
        {"grouped", &RoomChange::grouped},     {"called", &RoomChange::called},
        {"seated", &RoomChange::seated},       {"ended", &RoomChange::ended}};
    const auto rule = kRules.find(event_.type);
    if (rule == kRules.end()) {
      throw Error{ErrorKind::kMismatch, "there is no event '" + event_.type + "' of a room"};
    }
    state_.seq = event_.seq;
    state_.last_us = event_.at_us;
    (this->*rule->second)();
    step_.settle();
    return std::move(state_);
  }

 private:
  // --- who it is about ---
  [[nodiscard]] std::size_t actor() const { return *seat_of_actor(event_.actor) - 1; }
  [[nodiscard]] LiveSeat& who() { return state_.seats[actor()]; }
  [[nodiscard]] std::size_t subject() const { return event_.body.at("seat").get<std::size_t>() - 1; }

  // --- the way to the lobby ---
  void joined() {
    const auto seat = subject();
    const auto& place = event_.body.at("member");
    if (seat == state_.seats.size()) state_.seats.emplace_back();
    auto& person = state_.seats[seat];
    person.status = SeatStatus::kActive;
    person.is_here = true;
    person.presence_us = person.joined_us = person.since_us = event_.at_us;
    person.member.reset();
    if (place.is_null()) return;
    const auto member = place.get<std::size_t>();
    person.member = member;
    person.type = setup_.composition[member];
    state_.members[member].seat = seat;
  }
  void consented() {
    who().readiness = Readiness::kCheck;
    who().query = event_.body.at("query");
    who().since_us = event_.at_us;
  }
  void declined() { step_.dismiss(actor(), "declined", "declined", false); }
  void checked() {
    who().readiness = study_.screening.empty() ? Readiness::kReady : Readiness::kScreening;
    note_ready(who());
  }
  void named() { who().name = event_.body.at("name").get<std::string>(); }
  void screened() {
    who().screened.push_back(event_.body.at("right").get<bool>());
    if (who().screened.size() == study_.screening.size()) who().readiness = Readiness::kReady;
    note_ready(who());
  }
  void note_ready(LiveSeat& seat) {
    seat.since_us = event_.at_us;
    if (seat.readiness != Readiness::kReady) return;
    seat.ready_us = event_.at_us;
    if (!state_.lobby_us) state_.lobby_us = event_.at_us;
  }
  void released() {
    const bool away = event_.body.at("why") == "away";
    const bool in_vain = event_.body.at("why") == "lobby-time";
    const auto& seat = state_.seats[subject()];
    step_.dismiss(subject(), away ? "replaced" : "ended", event_.body.at("why").get<std::string>(),
                  in_vain || (seat.readiness == Readiness::kReady && state_.started_us.has_value()));
  }

  // --- from the waiting list to a group ---
  void grouped() {
    const auto& body = event_.body;
    ++state_.groups[body.at("strategy").get<std::string>() + "/" + body.at("composition").get<std::string>()];
    for (const auto& number : body.at("seats")) {
      if (!number.is_null()) move(number.get<std::size_t>() - 1, "grouped");
    }
  }
  void called() { move(subject(), "called"); }
  // Somebody on the waiting list has a place in a group from now on.
  void move(std::size_t seat, const char* why) {
    step_.dismiss(seat, "moved", why, false);
    state_.seats[seat].name.clear();
    state_.seats[seat].query = Json{};
  }
  void seated() {
    if (subject() == state_.seats.size()) state_.seats.emplace_back();  // and takes a place over next
    auto& person = state_.seats[subject()];
    person.status = SeatStatus::kActive;
    person.readiness = Readiness::kReady;
    person.is_here = true;
    person.presence_us = person.joined_us = person.since_us = event_.at_us;
    person.ready_us = event_.body.at("ready_us").get<std::int64_t>();
    person.name = event_.body.at("name").get<std::string>();
    person.query = event_.body.at("query");
    person.screened = event_.body.at("screened").get<std::vector<bool>>();
    if (!state_.lobby_us) state_.lobby_us = event_.at_us;
  }

  void started() {
    const bool fill = event_.body.at("fill").get<bool>();
    for (std::size_t m = 0; m < state_.members.size(); ++m) {
      if (const auto seat = state_.members[m].seat) {
        const auto& holder = state_.seats[*seat];
        if (!holder.is_person || (holder.status == SeatStatus::kActive && holder.readiness == Readiness::kReady)) {
          continue;
        }
        const bool came = holder.status == SeatStatus::kActive;
        step_.dismiss(*seat, "full", "started", came && study_.group().completion.pay_full);
      }
      if (fill) step_.seat_stand_in(m, setup_.composition[m]);
    }
    for (std::size_t i = 0; i < state_.seats.size(); ++i) {  // reserves who are not ready
      const auto& seat = state_.seats[i];
      if (seat.member || seat.status != SeatStatus::kActive || seat.readiness == Readiness::kReady) continue;
      step_.dismiss(i, "full", "started", study_.group().completion.pay_full);
    }
    step_.begin();
  }

  // --- a period ---
  void taught() { step_.take_lesson(*lesson_); }
  void watched() {
    ++who().watched;
    who().since_us = event_.at_us;
  }
  void draft() { who().draft = actions(); }
  void answered() {
    auto& person = who();
    const auto test = event_.body.at("test").get<std::size_t>();
    const bool for_ever = event_.body.value("for_ever", false);
    auto judged = judged_path(*study_.atlas, state_.session->lesson().tests.at(test).demo, actions(), for_ever);
    person.paths.at(test) =
        GivenPath{actions(), for_ever, judged.is_finished, judged.counts, event_.body.at("ms").get<std::int64_t>()};
    person.draft.clear();
    person.since_us = event_.at_us;
    if (current_test(person) == person.paths.size()) step_.give_answers(actor());
  }
  [[nodiscard]] std::vector<std::size_t> actions() const {
    std::vector<std::size_t> list;
    for (const auto& action : event_.body.at("actions")) list.push_back(action.get<std::size_t>());
    return list;
  }
  void continued() {
    who().has_continued = true;
    who().since_us = event_.at_us;
  }
  void questions() {
    who().has_answered_questions = true;
    who().since_us = event_.at_us;
  }

  void time_is_over() {
    const auto& what = event_.body.at("what");
    if (what == "session") return step_.begin_questions("time-limit");
    for (std::size_t i = 0; i < state_.seats.size(); ++i) {
      auto& seat = state_.seats[i];
      if (!gates(seat)) continue;
      if (what == "watch") seat.watched = std::max(seat.watched, state_.session->lesson().demonstrations.size());
      if (what == "predict" && !seat.has_answered) step_.give_answers(i);
      if (what == "feedback") seat.has_continued = true;
    }
    state_.deadline_us.reset();
  }

  // --- who is there ---
  void away() { set_presence(false); }
  void present() {
    set_presence(true);
    auto& seat = state_.seats[subject()];
    if (seat.status == SeatStatus::kDropped) seat.status = SeatStatus::kActive;
  }
  void set_presence(bool is_here) {
    auto& seat = state_.seats[subject()];
    seat.is_here = is_here;
    seat.presence_us = event_.at_us;
  }

  void dropped() {
    const auto seat = subject();
    if (!is_running(state_)) {
      state_.seats[seat].status = SeatStatus::kDropped;
      return;
    }
    if (event_.body.at("by").is_null()) {
      state_.seats[seat].status = SeatStatus::kDropped;
      state_.seats[seat].in_period = false;
    } else {
      const auto member = *state_.seats[seat].member;
      step_.dismiss(seat, "replaced", "away", true);
      take_over(member);
    }
    after_departure();
  }

  void left() {
    const auto seat = actor();
    const auto& person = state_.seats[seat];
    const auto member = person.member;
    const bool held = member && state_.members[*member].seat == seat;
    const auto waited_us = event_.at_us - person.ready_us;
    const bool waited =
        person.readiness == Readiness::kReady && waited_us >= study_.group().time.leave_after_s * kSecond;
    step_.dismiss(seat, "ended", "left", state_.phase != RoomPhase::kLobby || waited);
    if (!is_running(state_) || !held) return;
    if (!event_.body.at("by").is_null()) take_over(*member);
    after_departure();
  }

  // By a reserve, or by a stand-in.
  void take_over(std::size_t member) {
    if (event_.body.at("type").is_null()) {
      step_.seat_reserve(event_.body.at("by").get<std::size_t>() - 1, member);
    } else {
      step_.seat_stand_in(member, event_.body.at("type").get<std::string>().front());
    }
  }

  void after_departure() {
    const auto& dropout = study_.group().dropout;
    const bool has_reserve = !event_.body.at("by").is_null() && event_.body.at("type").is_null();
    if (dropout.without_reserve() == DropoutPolicy::kEndGroup && !has_reserve) {
      return step_.end("member-left", "Somebody in your group had to stop, so the session is over for everybody.");
    }
    const auto least = dropout.without_reserve() == DropoutPolicy::kSimulate ? 1 : dropout.min_active;
    if (num_active_people(state_) < least) {
      step_.end("too-few", "Too few people are left in your group to go on.");
    }
  }

  // --- facilitators ---
  void pause() { state_.paused_us = event_.at_us; }
  void resume() {
    const auto pause_us = event_.at_us - *state_.paused_us;
    if (state_.deadline_us) *state_.deadline_us += pause_us;
    if (state_.session_deadline_us) *state_.session_deadline_us += pause_us;
    for (auto& seat : state_.seats) {  // the grace period begins anew
      if (!seat.is_here && seat.status == SeatStatus::kActive) seat.presence_us = event_.at_us;
    }
    state_.paused_us.reset();
  }
  void extend() {
    const auto more_us = event_.body.at("seconds").get<std::int64_t>() * kSecond;
    if (state_.deadline_us) *state_.deadline_us += more_us;
    if (state_.session_deadline_us) *state_.session_deadline_us += more_us;
  }
  void message() {
    LiveNotice notice{event_.body.at("text").get<std::string>(), event_.at_us, {}};
    if (!event_.body.at("seat").is_null()) notice.seat = subject();
    state_.notices.push_back(std::move(notice));
  }
  void readmit() {
    const auto seat = subject();
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
  void simulate() {
    const auto seat = subject();
    const auto member = *state_.seats[seat].member;
    const bool was_empty = state_.seats[seat].status == SeatStatus::kEmpty;
    if (state_.seats[seat].status != SeatStatus::kGone) {
      step_.dismiss(seat, was_empty ? "full" : "replaced", "simulated", !was_empty);
    }
    step_.seat_stand_in(member, event_.body.at("type").get<std::string>().front());
  }
  void strategy() {
    state_.next_strategy = strategy_of(study_.spec, event_.body.at("name").get<std::string>());
    if (*state_.next_strategy == state_.session->strategy()) state_.next_strategy.reset();
  }
  void ended() {
    const auto reason = event_.body.at("reason").get<std::string>();
    step_.end(event_.actor == "facilitator" ? "facilitator" : reason, event_.body.at("text").get<std::string>());
  }

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
