#include "room_stepper.hpp"

#include <algorithm>
#include <tuple>

#include "kith/explain/examination.hpp"
#include "kith/study/audit_people.hpp"
#include "kith/study/team_streams.hpp"

namespace kith {

std::shared_ptr<const Learner> make_stand_in(const LiveStudy& study, const RoomSetup& setup, std::size_t member,
                                             char type, bool is_first, TeachingCache& cache) {
  auto person = person_stream(team_stream(study.spec, address_of(setup)), member + 1);
  if (!is_first) person = person.split("stand-in");
  const auto& learner_of_type = type_of_person(study.spec, type, person);
  return make_learner(study.spec, learner_of_type, draw_traits(learner_of_type, person), person, cache);
}

// --- people and places ---------------------------------------------------------------------------------------------

void RoomStepper::dismiss(std::size_t seat, const std::string& page, const std::string& why, bool gets_code) {
  auto& who = state_.seats[seat];
  who.had_dropped = who.status == SeatStatus::kDropped;
  who.status = SeatStatus::kGone;
  who.last_page = page;
  who.why = why;
  who.gets_code = gets_code;
  who.in_period = false;
  who.since_us = at_us_;
  if (who.member && state_.members[*who.member].seat == seat) state_.members[*who.member].seat.reset();
}

void RoomStepper::seat_stand_in(std::size_t member, char type) {
  LiveSeat seat;
  seat.is_person = false;
  seat.type = type;
  seat.member = member;
  seat.status = SeatStatus::kActive;
  seat.is_here = true;
  seat.presence_us = seat.joined_us = seat.since_us = at_us_;
  const auto learner = std::shared_ptr<Learner>{make_stand_in(study_, setup_, member, type, false, cache_)->clone()};
  learner->begin_component();  // also in the middle of one
  state_.members[member].seat = state_.seats.size();
  state_.members[member].learner = learner;
  state_.members[member].response = {};
  state_.members[member].is_new = state_.members[member].is_newcomer = true;
  state_.seats.push_back(std::move(seat));
}

void RoomStepper::begin() {
  state_.started_us = at_us_;
  if (study_.group().time.max_minutes > 0) {
    state_.session_deadline_us = at_us_ + study_.group().time.max_minutes * 60 * kSecond;
  }
  begin_phase(RoomPhase::kTeaching);
}

void RoomStepper::end(const std::string& reason, const std::string& text) {
  for (std::size_t i = 0; i < state_.seats.size(); ++i) {
    auto& seat = state_.seats[i];
    if (!seat.is_person || seat.status == SeatStatus::kEmpty || seat.status == SeatStatus::kGone) continue;
    if (state_.phase == RoomPhase::kQuestions && !seat.examined &&
        (seat.has_answered_questions || study_.group().questions.empty()))
      continue;  // they have finished
    dismiss(i, "ended", reason, seat.readiness == Readiness::kReady);
  }
  state_.end_reason = reason;
  state_.end_text = text;
  state_.ended_us = at_us_;
  state_.paused_us.reset();
  begin_phase(RoomPhase::kEnded);
}

void RoomStepper::begin_questions(const std::string& reason) {
  state_.end_reason = reason;
  state_.ended_us = at_us_;
  for (std::size_t i = 0; i < state_.seats.size(); ++i) {
    auto& seat = state_.seats[i];
    seat.in_period = false;
    if (seat.is_person && seat.status == SeatStatus::kActive && !seat.member) {
      dismiss(i, "full", "not-needed", study_.group().completion.pay_full);
    }
    if (study_.group().exam && seat.is_person) examine(i);
  }
  begin_phase(RoomPhase::kQuestions);
}

// By what this person saw and answered, not those who had the place before.
void RoomStepper::examine(std::size_t seat) {
  auto& who = state_.seats[seat];
  who.examined.reset();
  const bool takes_part = who.status == SeatStatus::kActive || who.status == SeatStatus::kDropped;
  if (!takes_part || !who.member || !state_.session) return;
  auto periods = observed_periods(state_.session->history(), *who.member);
  std::erase_if(periods, [&](const ObservedPeriod& period) {
    return std::none_of(state_.answers.begin(), state_.answers.end(), [&](const LiveAnswer& answer) {
      return answer.seat == seat && answer.period == period.period;
    });
  });
  if (periods.empty()) return;
  periods.insert(periods.end(), who.exam.begin(), who.exam.end());
  const auto random = RandomStream{1}.split("exam").split(setup_.id).split(seat);
  const auto is_answerable = [&](StartIndex start) { return answerable_path(*study_.atlas, start).has_value(); };
  who.examined =
      Examination{cache_, audit_options(study_.spec.teaching, 0.0), std::move(periods), random, is_answerable}.next();
}

// --- steps of the group --------------------------------------------------------------------------------------------

void RoomStepper::settle() {
  if (!is_running(state_)) return;
  sync_members();
  advance();
}

void RoomStepper::revert() {
  state_.session = std::move(state_.before);
  state_.before.reset();
  for (std::size_t m = 0; m < state_.members.size(); ++m) {
    auto& member = state_.members[m];
    const auto& before = state_.members_before[m];
    member.is_away = before.is_away;
    // A stand-in who is still the same one forgets the lesson.
    if (member.seat == before.seat) {
      member.learner = before.learner;
    } else if (member.seat) {  // the session as it was has somebody else there
      member.is_new = true;
      member.is_newcomer = !state_.seats[*member.seat].has_taken_part;
    }
    member.response = {};
    member.revised.clear();
  }
  state_.members_before.clear();
  state_.board.clear();
  for (auto& seat : state_.seats) seat.choices.clear();
  state_.runners_up.reset();
  for (auto& seat : state_.seats) seat.in_period = seat.in_period && state_.phase == RoomPhase::kFeedback;
}

// Who has a place takes part in the session, and nobody else does.
void RoomStepper::sync_members() {
  const auto differs = [&](const LiveMember& member) {
    return is_taken(state_, member) == member.is_away || (member.is_new && member.seat);
  };
  if (state_.session->finished() || std::none_of(state_.members.begin(), state_.members.end(), differs)) return;
  const bool is_ahead = state_.phase == RoomPhase::kFeedback || state_.phase == RoomPhase::kTeaching;
  if (is_ahead && state_.before) revert();  // the lesson was chosen for others
  auto session = *state_.session;
  for (std::size_t m = 0; m < state_.members.size(); ++m) {
    auto& member = state_.members[m];
    if (!differs(member)) continue;
    // Who takes a place over takes part from the next lesson on.
    if (!member.is_away) session.leave(m);
    const bool is_there = is_taken(state_, member);
    if (is_there && member.is_newcomer) session.replace(m);
    if (is_there && !member.is_newcomer) session.come_back(m);
    member.is_away = !is_there;
    member.is_new = false;
    member.is_newcomer = member.is_newcomer && !is_there;
  }
  state_.session = std::make_shared<const Session>(std::move(session));
  if (is_ahead) return;
  for (std::size_t m = 0; m < state_.members.size(); ++m) {
    if (state_.session->takes_part(m)) return;
  }
  // Nobody who watched this lesson is left: those who are here begin with a new one.
  revert();
  begin_phase(RoomPhase::kTeaching);
  sync_members();
}

bool has_done_phase(const Room::State& state, const LiveSeat& seat) noexcept {
  switch (state.phase) {
    case RoomPhase::kWatching:
      return seat.watched >= state.session->lesson().demonstrations.size();
    case RoomPhase::kTesting:
      return seat.has_answered;
    case RoomPhase::kDiscussing:
      return std::all_of(seat.choices.begin(), seat.choices.end(), [](const auto& one) { return one.has_value(); });
    case RoomPhase::kFeedback:
      return seat.has_continued;
    case RoomPhase::kLobby:
    case RoomPhase::kTeaching:
    case RoomPhase::kQuestions:
    case RoomPhase::kEnded:
      break;
  }
  return true;
}

bool RoomStepper::all_done() const {
  return std::all_of(state_.seats.begin(), state_.seats.end(),
                     [&](const LiveSeat& seat) { return !gates(seat) || has_done_phase(state_, seat); });
}

void RoomStepper::advance() {
  while (!state_.paused_us) {
    switch (state_.phase) {
      case RoomPhase::kTeaching:
        if (state_.session->finished()) {
          const auto status = state_.session->status();
          return begin_questions(status == SessionStatus::kComplete  ? "complete"
                                 : status == SessionStatus::kSkipped ? "skipped"
                                                                     : "max-periods");
        }
        if (state_.session->phase() != SessionPhase::kLesson) return;
        begin_watching();
        break;
      case RoomPhase::kWatching:
        if (!all_done()) return;
        begin_tests();
        break;
      case RoomPhase::kTesting:
        if (!all_done()) return;
        if (study_.group().discussion.choice.is_held() && can_discuss(*state_.session)) {
          begin_discussion();
        } else {
          finish_tests();
        }
        break;
      case RoomPhase::kDiscussing:
        if (!all_done()) return;
        finish_discussion();
        break;
      case RoomPhase::kFeedback:
        if (!all_done()) return;
        state_.durations_us.push_back(at_us_ - state_.period_us);
        begin_phase(RoomPhase::kTeaching);
        break;
      case RoomPhase::kLobby:
      case RoomPhase::kQuestions:
      case RoomPhase::kEnded:
        return;
    }
  }
}

void RoomStepper::begin_phase(RoomPhase phase) {
  state_.phase = phase;
  state_.phase_us = at_us_;
  state_.deadline_us.reset();
  const auto limit = rules_of(phase).limit;
  const auto limit_s = limit != nullptr ? study_.group().time.*limit : 0;
  if (limit_s > 0) state_.deadline_us = at_us_ + limit_s * kSecond;
}

void RoomStepper::take_lesson(const TaughtLesson& lesson) {
  state_.before = state_.session;
  state_.members_before = state_.members;
  state_.session = lesson.after;
  for (std::size_t m = 0; m < state_.members.size(); ++m) {
    auto& member = state_.members[m];
    if (!member.learner) continue;
    member.learner = std::shared_ptr<const Learner>{lesson.learners[m]->clone()};
    member.response = lesson.responses[m];
  }
  state_.runners_up = std::make_shared<const std::vector<RunnerUp>>(lesson.runners_up);
}

void RoomStepper::begin_watching() {
  const auto& session = *state_.session;
  if (state_.next_strategy && session.strategy() == *state_.next_strategy) state_.next_strategy.reset();
  for (auto& seat : state_.seats) {
    seat.in_period = seat.status == SeatStatus::kActive && seat.member &&
                     state_.members[*seat.member].seat == static_cast<std::size_t>(&seat - state_.seats.data()) &&
                     session.takes_part(*seat.member);
    seat.has_taken_part = seat.has_taken_part || seat.in_period;
    seat.watched = 0;
    seat.paths.clear();
    seat.paths.resize(session.lesson().tests.size());
    seat.draft.clear();
    seat.has_answered = seat.paths.empty();
    seat.has_continued = false;
    seat.exploration.reset();
    seat.choices.clear();
  }
  state_.board.clear();
  state_.period_us = at_us_;
  begin_phase(RoomPhase::kWatching);
}

void RoomStepper::begin_tests() {
  auto session = *state_.session;
  session.show();
  for (std::size_t m = 0; m < state_.members.size(); ++m) {
    const auto& member = state_.members[m];
    if (member.learner && session.takes_part(m)) session.answer(m, member.response.answers);
  }
  state_.session = std::make_shared<const Session>(std::move(session));
  begin_phase(RoomPhase::kTesting);
}

void RoomStepper::finish_phase(std::size_t seat) {
  auto& who = state_.seats[seat];
  switch (state_.phase) {
    case RoomPhase::kWatching:
      who.watched = state_.session->lesson().demonstrations.size();
      return;
    case RoomPhase::kTesting:
      return give_answers(seat);  // those that were given: a path that was not submitted is none
    case RoomPhase::kDiscussing:
      for (auto& choice : who.choices) {
        if (!choice) choice.emplace();  // keeps the answer
      }
      return;
    case RoomPhase::kFeedback:
      who.has_continued = true;
      return;
    case RoomPhase::kLobby:
    case RoomPhase::kTeaching:
    case RoomPhase::kQuestions:
    case RoomPhase::kEnded:
      return;
  }
}

void RoomStepper::give_answers(std::size_t seat) {
  auto& who = state_.seats[seat];
  std::vector<Answer> answers;
  for (const auto& path : who.paths) answers.push_back(path ? path->counts : std::nullopt);
  auto session = *state_.session;
  session.answer(*who.member, std::move(answers));
  state_.session = std::make_shared<const Session>(std::move(session));
  who.has_answered = true;
  who.draft.clear();
}

// Stand-ins talk at once; people see what everybody answered and decide.
void RoomStepper::begin_discussion() {
  const auto& session = *state_.session;
  const auto team = team_stream(study_.spec, address_of(setup_));
  std::vector<RandomStream> persons;
  Learners stand_ins;
  std::vector<Learner*> talking;
  for (std::size_t m = 0; m < state_.members.size(); ++m) {
    persons.push_back(person_stream(team, m + 1));
    const auto& member = state_.members[m];
    const bool talks = member.learner && session.has_answered(m) && session.takes_part(m);
    stand_ins.push_back(talks ? member.learner->clone() : nullptr);
    talking.push_back(stand_ins.back().get());
  }
  auto revised = discuss(study_.group().discussion.choice, session, cache_, talking, persons);
  make_board();
  for (std::size_t m = 0; m < state_.members.size(); ++m) {
    if (!stand_ins[m]) continue;
    state_.members[m].learner = std::move(stand_ins[m]);
    state_.members[m].revised = std::move(revised[m]);
  }
  for (auto& seat : state_.seats) {
    if (!gates(seat)) continue;
    seat.choices.assign(state_.board.size(), std::nullopt);
    for (std::size_t t = 0; t < state_.board.size(); ++t) {
      const auto own = own_entry(state_, t, *seat.member);
      if (state_.board[t].size() <= (own ? 1u : 0u)) seat.choices[t].emplace();  // there is nothing else
    }
  }
  begin_phase(RoomPhase::kDiscussing);
}

// What was answered, without names: every path once. The order is that of the paths, so that it tells nobody's seat.
void RoomStepper::make_board() {
  const auto& tests = state_.session->lesson().tests;
  state_.board.assign(tests.size(), {});
  for (std::size_t t = 0; t < tests.size(); ++t) {
    auto& entries = state_.board[t];
    for (std::size_t m = 0; m < state_.members.size(); ++m) {
      const auto path = path_of(m, t);
      if (!path) continue;
      const auto known = std::find_if(entries.begin(), entries.end(), [&](const BoardAnswer& one) {
        return one.path.actions == path->actions && one.path.for_ever == path->for_ever;
      });
      if (known != entries.end()) {
        known->members.push_back(m);
      } else {
        entries.push_back({*path, {m}});
      }
    }
    std::sort(entries.begin(), entries.end(), [](const BoardAnswer& a, const BoardAnswer& b) {
      return std::tie(a.path.actions, a.path.for_ever) < std::tie(b.path.actions, b.path.for_ever);
    });
  }
}

// The answer of a member to a test as a path that can be drawn. A stand-in's is the best one for the weights it had in
// mind; nothing where its answer is none of these, such as a slip.
std::optional<GivenPath> RoomStepper::path_of(std::size_t member, std::size_t test) const {
  const auto& place = state_.members[member];
  if (!state_.session->has_answered(member) || !place.seat) return std::nullopt;
  const auto& seat = state_.seats[*place.seat];
  if (seat.is_person) return test < seat.paths.size() ? seat.paths[test] : std::nullopt;
  const auto& answer = state_.session->answers(member)[test];
  if (!answer || !place.response.weights) return std::nullopt;
  const auto start = state_.session->lesson().tests[test].start;
  const auto drawn = cache_.behaviours().trajectory(start, *place.response.weights);
  if (!drawn || drawn->repeats_from) return std::nullopt;
  GivenPath path{.actions = {}, .is_finished = true, .counts = answer};
  for (const auto action : drawn->actions) path.actions.push_back(action.value());
  const auto judged = judged_path(*study_.atlas, start, path.actions, false);
  const bool is_it = judged.is_legal && (!study_.atlas->domain().mdp(study_.atlas->id(start).mdp).is_deterministic() ||
                                         judged.counts == answer);
  return is_it ? std::optional{path} : std::nullopt;
}

void RoomStepper::finish_discussion() {
  auto session = *state_.session;
  session.discuss(revised_answers(state_));
  state_.session = std::make_shared<const Session>(std::move(session));
  finish_tests();
  for (auto& seat : state_.seats) {  // what is judged now is what they answered in the end
    for (std::size_t t = 0; seat.in_period && t < seat.choices.size(); ++t) {
      if (seat.choices[t] && seat.choices[t]->entry) seat.paths[t] = state_.board[t][*seat.choices[t]->entry].path;
    }
  }
  for (auto& member : state_.members) member.revised.clear();
}

void RoomStepper::finish_tests() {
  auto session = *state_.session;
  session.close_tests();
  session.give_feedback();
  const auto& past = session.history().back();
  for (std::size_t m = 0; m < state_.members.size(); ++m) {
    auto& member = state_.members[m];
    if (!member.learner || !session.takes_part(m)) continue;
    const auto learner = std::shared_ptr<Learner>{member.learner->clone()};
    learner->hear_feedback(past.feedback.all_right_in_the_end(m), past.feedback.half_spaces, past.lesson.period);
    member.learner = learner;
    member.response = {};
  }
  state_.session = std::make_shared<const Session>(std::move(session));
  state_.before.reset();
  state_.members_before.clear();
  record_answers();
  record_curves();
  begin_phase(RoomPhase::kFeedback);
}

void RoomStepper::record_answers() {
  const auto& past = state_.session->history().back();
  for (std::size_t i = 0; i < state_.seats.size(); ++i) {
    auto& seat = state_.seats[i];
    if (!seat.member || state_.members[*seat.member].seat != i || !seat.in_period) continue;
    const auto& verdicts = past.feedback.verdicts[*seat.member];
    for (std::size_t t = 0; t < verdicts.size(); ++t) {
      const auto path = seat.is_person && t < seat.paths.size() ? seat.paths[t] : std::nullopt;
      seat.tests += 1;
      seat.right += verdicts[t].correct ? 1u : 0u;
      state_.answers.push_back({.seat = i,
                                .period = past.lesson.period,
                                .test = t,
                                .right = verdicts[t].correct,
                                .regret = verdicts[t].regret,
                                .ms = path ? path->ms : 0,
                                .stopped_short = path && !path->is_finished});
      if (past.revised.empty()) continue;
      const auto& revised = past.revised[*seat.member];
      state_.answers.back().right_in_the_end = past.feedback.final_verdicts(*seat.member)[t].correct;
      state_.answers.back().changed = !revised.empty() && revised[t] != past.answers[*seat.member][t];
    }
  }
}

void RoomStepper::record_curves() {
  const auto& session = *state_.session;
  const auto& region = study_.atlas->policy_bec_half_spaces();
  LiveCurvePoint point;
  point.period = session.periods();
  for (std::size_t m = 0; m < session.num_members(); ++m) {
    point.p_bec.emplace_back("member " + std::to_string(m + 1), session.belief().member(m).mass_in(region));
  }
  for (const auto& rule : session.options().rules) {
    point.p_bec.emplace_back(std::string{rule.name}, session.belief().aggregate(rule.name).mass_in(region));
  }
  for (std::size_t i = 0; i < state_.seats.size(); ++i) {
    const auto& seat = state_.seats[i];
    if (seat.tests > 0) {
      point.right.emplace_back(i, static_cast<double>(seat.right) / static_cast<double>(seat.tests));
    }
  }
  state_.curves.push_back(std::move(point));
}

}  // namespace kith
