#include "kith/live/room.hpp"

#include <algorithm>

#include "kith/core/assert.hpp"
#include "kith/core/error.hpp"
#include "kith/files/bytes.hpp"
#include "kith/files/sha256.hpp"
#include "kith/study/team_streams.hpp"
#include "room_stepper.hpp"
#include "room_view.hpp"
#include "session_summary.hpp"

namespace kith {
namespace {

[[noreturn]] void refuse_setup(const std::string& message) { throw Error{ErrorKind::kInvalidInput, message}; }
[[noreturn]] void mismatch(const RoomEvent& event, const std::string& why) {
  throw Error{ErrorKind::kMismatch, "event " + std::to_string(event.seq) + " ('" + std::string{event.kind().word} +
                                        "') does not fit its room: " + why};
}

std::vector<bool> simulated_members(const LiveStudy& study, const RoomSetup& setup) {
  const auto members = setup.composition.size();
  if (setup.simulated.empty()) return simulated_members(study, members);
  if (setup.simulated.size() != members) refuse_setup("a room says for other seats than it has who takes them");
  return setup.simulated;
}

// What the session of a waiting list, which never begins, is made of.
RoomSetup waiting_list_session(const LiveStudy& study) {
  const auto cell = live_cells(study).front();
  return {.strategy = cell.strategy, .composition = cell.composition};
}

std::shared_ptr<const Session> make_session(const LiveStudy& study, const RoomSetup& setup, TeachingCache& cache) {
  auto options = study.spec.teaching;
  options.keep_members = true;  // facilitators see all beliefs, and may change the strategy
  options.keep_rules = true;
  options.avoids_repeats = setup.lessons >= 1;
  options.shares_bank = setup.lessons >= 3;
  const auto team = team_stream(study.spec, address_of(setup));
  std::vector<RandomStream> beliefs;
  for (std::size_t m = 0; m < setup.composition.size(); ++m) {
    beliefs.push_back(belief_stream(person_stream(team, m + 1)));
  }
  const auto strategy = strategy_of(study.spec, setup.strategy);
  const auto teacher = strategy.is_baseline() ? lone_teacher_stream(person_stream(team, 1)) : teacher_stream(team);
  return std::make_shared<const Session>(cache, options, strategy, beliefs, teacher);
}

void check_setup(const LiveStudy& study, const RoomSetup& setup) {
  const auto& strategies = study.spec.strategies;
  const auto strategy =
      std::find_if(strategies.begin(), strategies.end(), [&](const auto& one) { return one.name == setup.strategy; });
  const bool is_planner = strategy == strategies.end() ? setup.strategy == "adaptive" || setup.strategy == "pick"
                                                       : strategy->kind.name == "plan";
  if (is_planner && setup.lessons < 2) {
    refuse_setup("room " + setup.id + " was taught by '" + setup.strategy +
                 "' of an older version, which chose other lessons: open the folder with the version that began it");
  }
  if (study.spec.teaching.mastery.kind.name == "exam" && setup.lessons < 3) {
    refuse_setup(
        "room " + setup.id +
        " was set up by an older version, whose stop rule 'exam' was another: open the folder with that version");
  }
  if (setup.lessons > RoomSetup::kLessonRules) {
    refuse_setup("room " + setup.id + " was set up by a newer version of kith: open the folder with that version");
  }
  if (strategy == strategies.end()) refuse_setup("this study has no strategy '" + setup.strategy + "'");
  if (setup.composition.empty() || setup.composition.size() > 30) refuse_setup("a room has 1 to 30 seats");
  for (const char letter : setup.composition) {
    const auto& types = study.spec.learner_types;
    const bool is_known =
        std::any_of(types.begin(), types.end(), [&](const LearnerType& type) { return type.letter == letter; });
    if (!is_known) refuse_setup(std::string{"this study has no learner type '"} + letter + "'");
  }
  if (strategy->is_baseline() && setup.composition.size() > 1) {
    refuse_setup("the strategy 'baseline' teaches one person at a time: make a room with one seat per person");
  }
}

// The command that an event goes back to; nothing for events that no command leads to.
std::optional<RoomCommand> command_of(const RoomEvent& event) {
  if (event.kind().command.empty()) return std::nullopt;
  RoomCommand command{event.actor, std::string{event.kind().command}, body_of(event), {}};
  if (event.get<happening::Consented>() != nullptr) command.body["accept"] = true;
  if (event.get<happening::Declined>() != nullptr) command.body = {{"accept", false}, {"version", ""}};
  return command;
}

// Whether this can be what is left of an answer, see happening::Answered.
bool is_remainder(const Json& erased, std::size_t num_features) {
  if (!erased.is_object() || !erased.contains("counts") || !erased.value("finished", Json{}).is_boolean()) return false;
  const auto& counts = erased["counts"];
  return counts.is_null() || (counts.is_array() && counts.size() == num_features &&
                              std::ranges::all_of(counts, [](const Json& count) { return count.is_number_integer(); }));
}

// Whether what is left of a deed of somebody who was withdrawn fits where it was.
bool is_erased_deed(const RoomParts& room, const LiveSeat& person, const RoomEvent& event) {
  if (const auto* answer = event.get<happening::Answered>()) {
    return is_remainder(answer->erased, room.study.spec.num_features) && room.state.phase == RoomPhase::kTesting &&
           person.in_period && !person.has_answered && answer->test == current_test(person);
  }
  if (const auto* screened = event.get<happening::Screened>()) {
    return screened->actions.empty() && person.readiness == Readiness::kScreening &&
           screened->test == person.screened.size();
  }
  if (const auto* examined = event.get<happening::Examined>()) {
    const bool is_left = examined->erased.is_null() || is_remainder(examined->erased, room.study.spec.num_features);
    return examined->actions.empty() && is_left && examined->start < room.study.atlas->num_states() &&
           room.state.phase == RoomPhase::kQuestions && examined->test == person.exam.size();
  }
  if (const auto* draft = event.get<happening::Drafted>()) {
    return draft->actions.empty() && room.state.phase == RoomPhase::kTesting && person.in_period;
  }
  const auto* asked = event.get<happening::Explored>();
  return asked != nullptr && asked->start.is_null();
}

// Texts and deeds may have been erased since; only whether they are possible is checked.
bool fits_without_text(const RoomParts& room, const RoomEvent& event) {
  const auto is_seat = [&](std::size_t seat) { return seat >= 1 && seat <= room.state.seats.size(); };
  if (const auto* message = event.get<happening::MessageSent>()) {
    return event.actor == "facilitator" && (!message->seat || is_seat(*message->seat));
  }
  const auto seat = seat_of_actor(event.actor);
  if (!seat || !is_seat(*seat)) return false;
  const auto& person = room.state.seats[*seat - 1];
  if (!person.is_person || person.status == SeatStatus::kEmpty || person.status == SeatStatus::kGone) return false;
  if (is_erased_deed(room, person, event)) return true;
  if (!event.kind().is_free_text) return false;
  if (event.get<happening::Named>() != nullptr) return true;
  return room.state.phase == RoomPhase::kQuestions && !person.has_answered_questions;
}

}  // namespace

Room::Room(std::shared_ptr<const LiveStudy> study, RoomSetup setup, TeachingCache& cache) : study_{std::move(study)} {
  if (setup.is_waiting_list) {
    if (!study_->seats_by_ability()) refuse_setup("this study seats nobody by the estimate of a screening");
    auto state = std::make_shared<State>();
    state->session = make_session(*study_, waiting_list_session(*study_), cache);
    setup_ = std::make_shared<const RoomSetup>(std::move(setup));
    state_ = std::move(state);
    return;
  }
  check_setup(*study_, setup);
  setup.simulated = simulated_members(*study_, setup);
  setup_ = std::make_shared<const RoomSetup>(std::move(setup));
  auto state = std::make_shared<State>();
  state->session = make_session(*study_, *setup_, cache);
  state->members.resize(setup_->composition.size());
  for (std::size_t m = 0; m < state->members.size(); ++m) {
    LiveSeat seat;
    seat.type = setup_->composition[m];
    seat.member = m;
    seat.is_person = !setup_->simulated[m];
    state->members[m].seat = m;
    if (!seat.is_person) {
      seat.status = SeatStatus::kActive;
      seat.is_here = true;
      state->members[m].learner = make_stand_in(*study_, *setup_, m, seat.type, true, cache);
    }
    state->seats.push_back(std::move(seat));
  }
  state_ = std::move(state);
}

const RoomSetup& Room::setup() const noexcept { return *setup_; }
const LiveStudy& Room::study() const noexcept { return *study_; }
std::uint64_t Room::seq() const noexcept { return state_->seq; }
bool Room::holds_session() const noexcept { return state_->session != nullptr; }
const Session& Room::session() const noexcept {
  KITH_ASSERT(holds_session());
  return *state_->session;
}

void Room::release() {
  const bool is_over = state_->phase == RoomPhase::kQuestions || state_->phase == RoomPhase::kEnded;
  const bool is_examining =
      state_->phase == RoomPhase::kQuestions &&
      std::any_of(state_->seats.begin(), state_->seats.end(), [](const LiveSeat& seat) {
        return seat.examined && (seat.status == SeatStatus::kActive || seat.status == SeatStatus::kDropped);
      });
  if (is_over && !is_examining && holds_session()) {
    state_ = std::make_shared<const State>(released_state({*study_, *setup_, *state_}));
  }
}

std::size_t Room::num_seats() const noexcept { return state_->seats.size(); }

RoomStage Room::stage() const noexcept {
  if (state_->phase != RoomPhase::kQuestions) return rules_of(state_->phase).stage;
  const bool has_questions = !study_->group().questions.empty();
  const bool all = std::all_of(state_->seats.begin(), state_->seats.end(), [&](const LiveSeat& seat) {
    return !seat.is_person || seat.status != SeatStatus::kActive ||
           (!seat.examined && (!has_questions || seat.has_answered_questions));
  });
  return all ? RoomStage::kEnded : RoomStage::kQuestions;
}

const std::vector<ObservedPeriod>& Room::exam_of(std::size_t seat) const { return state_->seats.at(seat - 1).exam; }

bool Room::is_person(std::size_t seat) const { return state_->seats.at(seat - 1).is_person; }

std::optional<std::size_t> Room::seat_of(std::size_t member) const {
  const auto& seat = state_->members.at(member).seat;
  return seat ? std::optional{*seat + 1} : std::nullopt;
}

bool Room::has_free_seat() const {
  return decide({"server", std::string{happening::Joined::kKind.command}, Json::object(), {}}, state_->last_us)
             .refusal == std::nullopt;
}

std::string Room::stage_of(std::size_t seat) const {
  return stage_of_seat({*study_, *setup_, *state_}, state_->seats.at(seat - 1));
}

std::string Room::status_of(std::size_t seat) const {
  return status_of_seat({*study_, *setup_, *state_}, state_->seats.at(seat - 1));
}

bool Room::is_done(std::size_t seat) const {
  const auto stage = stage_of(seat);
  for (const char* last : {"debrief", "declined", "ended", "replaced", "full", "moved"}) {
    if (stage == last) return true;
  }
  return false;
}

Decision Room::decide(const RoomCommand& command, std::int64_t now_us) const {
  return decide_in({*study_, *setup_, *state_}, command, now_us);
}

std::vector<RoomEvent> Room::due(std::int64_t now_us) const {
  auto events = clock_events({*study_, *setup_, *state_});
  if (events.empty() || events.front().at_us > now_us) return {};
  auto event = std::move(events.front().event);
  event.seq = state_->seq + 1;
  event.at_us = std::max(now_us, state_->last_us);
  return {std::move(event)};
}

std::optional<std::int64_t> Room::next_due() const {
  const auto events = clock_events({*study_, *setup_, *state_});
  if (events.empty()) return std::nullopt;
  return events.front().at_us;
}

// --- teaching ------------------------------------------------------------------------------------------------------

std::optional<TeachingTask> next_task(const std::shared_ptr<const LiveStudy>& study, const RoomSetup& setup,
                                      const Room::State& state, std::vector<SessionEvent> ahead) {
  TeachingTask::Content content{study, state.session, std::move(ahead), {}, {}, state.next_strategy};
  content.room = readable_address(study->spec, address_of(setup)) + "/" + setup.strategy;
  for (const auto& member : state.members) {
    content.learners.push_back(member.learner ? member.learner->clone() : nullptr);
    content.room += '/';
    if (member.learner && member.seat) {
      content.room += std::to_string(*member.seat) + state.seats[*member.seat].type;
    }
  }
  return TeachingTask{std::move(content)};
}

std::optional<TeachingTask> Room::teaching() const {
  const auto& state = *state_;
  if (state.phase != RoomPhase::kTeaching && state.phase != RoomPhase::kFeedback) return std::nullopt;
  if (state.session->phase() != SessionPhase::kProposal) return std::nullopt;
  const bool somebody =
      std::any_of(state.members.begin(), state.members.end(), [](const LiveMember& member) { return !member.is_away; });
  if (!somebody) return std::nullopt;
  return next_task(study_, *setup_, state, {});
}

std::vector<TeachingTask> Room::likely_teaching() const {
  const auto& state = *state_;
  std::vector<TeachingTask> tasks;
  if (setup_->is_waiting_list) return tasks;
  if (state.phase == RoomPhase::kLobby) {
    tasks.push_back(*next_task(study_, *setup_, state, {}));
  } else if (state.phase == RoomPhase::kDiscussing) {
    // Those who have not decided yet will keep their answers.
    std::vector<SessionEvent> ahead{AnswersDiscussed{revised_answers(state)}, TestsClosed{}, FeedbackGiven{}};
    tasks.push_back(*next_task(study_, *setup_, state, std::move(ahead)));
  } else if (state.phase == RoomPhase::kTesting && !study_->group().discussion.choice.is_held()) {
    // Those who have not answered yet will be right.
    std::vector<SessionEvent> ahead;
    const auto& tests = state.session->lesson().tests;
    for (std::size_t m = 0; m < state.members.size(); ++m) {
      if (!state.session->takes_part(m) || state.session->has_answered(m) || !state.members[m].seat) continue;
      const auto& seat = state.seats[*state.members[m].seat];
      TestsAnswered answered{m, {}};
      for (std::size_t t = 0; t < tests.size(); ++t) {
        const bool is_given = t < seat.paths.size() && seat.paths[t];
        answered.answers.push_back(is_given ? seat.paths[t]->counts
                                            : Answer{study_->atlas->feature_counts(tests[t].start)});
      }
      ahead.emplace_back(std::move(answered));
    }
    ahead.emplace_back(TestsClosed{});
    ahead.emplace_back(FeedbackGiven{});
    tasks.push_back(*next_task(study_, *setup_, state, std::move(ahead)));
  }
  return tasks;
}

RoomEvent Room::taught(const TaughtLesson& lesson, std::int64_t now_us) const {
  const auto task = teaching();
  if (!task || task->key() != lesson.key) {
    throw std::invalid_argument{"Room::taught: the room does not wait for this lesson"};
  }
  const bool finished = lesson.after->finished();
  return {state_->seq + 1, std::max(now_us, state_->last_us), "server",
          happening::LessonChosen{lesson.key, lesson.digest, lesson.after->periods() + (finished ? 0 : 1), finished}};
}

// --- events --------------------------------------------------------------------------------------------------------

void Room::apply(const RoomEvent& event, TeachingCache& cache, const TaughtLesson* lesson) {
  const RoomParts parts{*study_, *setup_, *state_};
  if (event.seq != state_->seq + 1) mismatch(event, "number " + std::to_string(state_->seq + 1) + " is expected");
  if (event.at_us < state_->last_us) mismatch(event, "it is older than the one before");
  std::optional<TaughtLesson> again;
  if (event.get<happening::LessonChosen>() != nullptr) {
    const auto task = teaching();
    if (!task || event.actor != "server") mismatch(event, "the room does not wait for a lesson");
    if (lesson == nullptr || lesson->key != task->key()) lesson = &again.emplace(task->run(cache));
    if (taught(*lesson, event.at_us) != event) mismatch(event, "the teacher chooses another lesson");
  } else {
    bool fits = false;
    if (event.actor == "server") {
      const auto clock = clock_events(parts);
      fits = std::any_of(clock.begin(), clock.end(), [&](const ClockEvent& one) {
        return one.at_us <= event.at_us && one.event.what == event.what;
      });
    }
    if (auto command = command_of(event); !fits && command) {
      // A new seat is not asked for by its number.
      const auto* joined = event.get<happening::Joined>();
      if (joined != nullptr && joined->seat > num_seats()) command->body.erase("seat");
      const auto decision = decide_in(parts, *command, event.at_us);
      fits = decision.events.size() == 1 && decision.events.front() == event;
    }
    if (!fits && !fits_without_text(parts, event)) {
      mismatch(event, "it is not possible in this state");
    }
  }
  state_ = std::make_shared<const State>(state_after(parts, event, cache, lesson));
}

Room replay(std::shared_ptr<const LiveStudy> study, RoomSetup setup, std::span<const RoomEvent> events,
            TeachingCache& cache) {
  Room room{std::move(study), std::move(setup), cache};
  for (const auto& event : events) room.apply(event, cache);
  return room;
}

}  // namespace kith
