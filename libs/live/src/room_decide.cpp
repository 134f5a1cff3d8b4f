#include <algorithm>

#include "exploration.hpp"
#include "kith/domains/judgement.hpp"
#include "room_body.hpp"
#include "session_summary.hpp"

namespace kith {

using namespace happening;  // NOLINT(google-build-using-namespace): every event is named here

namespace {

constexpr std::size_t kMostAnswerBytes = 4000;
constexpr std::size_t kMostExplorations = 2000;  // of one person

// What a person asks for.
class SeatDecider : Decider {
  static constexpr std::string_view kIncomplete = "This message is not complete.";

 public:
  SeatDecider(const RoomParts& room, std::size_t seat, const RoomCommand& command, std::int64_t now_us)
      : Decider{room, command, now_us}, seat_{room.state.seats[seat]} {}

  [[nodiscard]] Decision decide() const {
    if (!is_command(RoomSender::kSeat, command_.type)) return refused("unknown-type", "This message is not known.");
    if (!command_.body.is_object()) return bad_body();
    if (seat_.status == SeatStatus::kEmpty) return refused("not-joined", "Nobody has joined with this link yet.");
    if (seat_.status == SeatStatus::kGone) {
      if (command_.type == Left::kKind.command) return nothing_to_do();
      return refused("gone", "Your part in this session is over.");
    }
    return asked<RoomSender::kSeat>(*this, command_, kIncomplete);
  }

  [[nodiscard]] Decision ask(Consented consented) const {
    if (seat_.readiness != Readiness::kConsent) return consented.accept ? nothing_to_do() : not_now();
    if (!consented.accept) return accepted(Declined{});
    if (consented.version != room_.study.group().consent_version) {
      return refused("other-version", "The text has changed. Please reload the page and read it again.");
    }
    consented.query = collected_query(room_.study, consented.query);
    return accepted(std::move(consented));
  }

  [[nodiscard]] Decision ask(Checked) const {
    if (seat_.readiness == Readiness::kConsent) return not_now();
    if (seat_.readiness != Readiness::kCheck) return nothing_to_do();
    return accepted(Checked{});
  }

  [[nodiscard]] Decision ask(Named named) const {
    if (!room_.study.group().ask_name || seat_.readiness == Readiness::kConsent) return not_now();
    return named.name == seat_.name ? nothing_to_do() : accepted(std::move(named));
  }

  [[nodiscard]] Decision ask(Screened answer) const {
    if (seat_.readiness == Readiness::kConsent || seat_.readiness == Readiness::kCheck) return not_now();
    if (answer.test < seat_.screened.size()) return nothing_to_do();
    if (seat_.readiness != Readiness::kScreening || answer.test != seat_.screened.size()) return not_now();
    const auto start = room_.study.screening[answer.test];
    const auto judged = judged_path(*room_.study.atlas, start, answer.actions, answer.for_ever);
    if (!judged.is_legal) return illegal(judged);
    answer.right = is_right(start, judged);
    return accepted(std::move(answer));
  }

  [[nodiscard]] Decision ask(Examined answer) const {
    if (answer.test < seat_.exam.size()) return nothing_to_do();
    if (state_.phase != RoomPhase::kQuestions || !seat_.examined || answer.test != seat_.exam.size()) return not_now();
    const auto judged = judged_path(*room_.study.atlas, *seat_.examined, answer.actions, answer.for_ever);
    if (!judged.is_legal) return illegal(judged);
    answer.start = seat_.examined->value();
    answer.right = is_right(*seat_.examined, judged);
    return accepted(std::move(answer));
  }

  [[nodiscard]] Decision ask(Watched watched) const {
    if (state_.phase != RoomPhase::kWatching || !seat_.in_period) {
      return is_running(state_) && state_.phase != RoomPhase::kWatching ? nothing_to_do() : not_now();
    }
    if (watched.index < seat_.watched || is_late(watched.round)) return nothing_to_do();
    return watched.index > seat_.watched ? not_now() : accepted(watched);
  }

  [[nodiscard]] Decision ask(Drafted draft) const {
    if (state_.phase != RoomPhase::kTesting || !seat_.in_period || seat_.has_answered) return nothing_to_do();
    if (draft.test != current_test(seat_) || draft.actions == seat_.draft) return nothing_to_do();
    if (const auto judged = judged_at(draft.test, draft.actions, false); !judged.is_legal) return illegal(judged);
    return accepted(std::move(draft));
  }

  [[nodiscard]] Decision ask(Answered answer) const {
    if (is_late(answer.round)) return too_late();
    const auto* given =
        answer.test < seat_.paths.size() && seat_.paths[answer.test] ? &*seat_.paths[answer.test] : nullptr;
    if (given != nullptr && given->actions == answer.actions && given->for_ever == answer.for_ever) {
      return nothing_to_do();
    }
    if (state_.phase != RoomPhase::kTesting || !seat_.in_period) {
      return state_.phase == RoomPhase::kWatching ? not_now() : too_late();
    }
    if (given != nullptr) return refused("already-answered", "You have already answered this question.");
    if (seat_.has_answered) return too_late();
    if (answer.test != current_test(seat_)) return not_now();
    const auto judged = judged_at(answer.test, answer.actions, answer.for_ever);
    return judged.is_legal ? accepted(std::move(answer)) : illegal(judged);
  }

  // No choice: keeps the own answer.
  [[nodiscard]] Decision ask(Discussed decided) const {
    if (is_late(decided.round)) return too_late();
    if (state_.phase != RoomPhase::kDiscussing || !seat_.in_period) {
      return state_.phase == RoomPhase::kTesting || state_.phase == RoomPhase::kWatching ? not_now() : too_late();
    }
    if (decided.test < seat_.choices.size() && seat_.choices[decided.test]) {
      if (seat_.choices[decided.test]->entry == decided.choice) return nothing_to_do();
      return refused("already-answered", "You have already decided about this question.");
    }
    if (decided.test >= seat_.choices.size() || decided.test != current_choice(seat_)) return not_now();
    if (decided.choice && *decided.choice >= state_.board[decided.test].size()) return bad_body();
    return accepted(decided);
  }

  [[nodiscard]] Decision ask(Continued continued) const {
    if (state_.phase != RoomPhase::kFeedback || !seat_.in_period) {
      return is_running(state_) || state_.phase == RoomPhase::kQuestions ? nothing_to_do() : not_now();
    }
    return seat_.has_continued || is_late(continued.round) ? nothing_to_do() : accepted(continued);
  }

  [[nodiscard]] std::optional<Decision> closed(OfKind<Explored>) const {
    const auto stage = stage_of_seat(room_, seat_);
    if (!room_.study.group().screens.explore || !can_explore(room_.study.atlas->domain())) return not_now();
    if (stage != "feedback" && stage != "debrief") return too_late();
    return seat_.explorations >= kMostExplorations ? std::optional{not_now()} : std::nullopt;
  }
  [[nodiscard]] Decision ask(Explored wish) const {
    const auto& domain = room_.study.atlas->domain();
    if (wish.world) {
      wish.map.clear();
      return *wish.world < domain.num_mdps() ? accepted(std::move(wish)) : bad_body();
    }
    // As many rows and symbols as the map has.
    const auto map = domain.drawing();
    const bool fits = wish.map.size() == static_cast<std::size_t>(map->height()) &&
                      std::all_of(wish.map.begin(), wish.map.end(), [&](const std::string& row) {
                        return row.size() == static_cast<std::size_t>(map->width());
                      });
    return fits ? accepted(std::move(wish)) : bad_body();
  }

  [[nodiscard]] std::optional<Decision> closed(OfKind<QuestionsAnswered>) const {
    if (state_.phase != RoomPhase::kQuestions || !seat_.member || seat_.examined) return not_now();
    if (seat_.has_answered_questions || room_.study.group().questions.empty()) return nothing_to_do();
    return std::nullopt;
  }
  [[nodiscard]] Decision ask(const QuestionsAnswered& given) const {
    Json answers = Json::object();
    for (const auto& question : room_.study.group().questions) {
      const auto value = given.answers.find(question.id);
      const bool is_missing = value == given.answers.end() || value->is_null() || *value == Json(std::string{});
      if (is_missing) {
        if (question.required) {
          return refused("missing-answer", "Please answer every question that is marked as required.");
        }
        continue;
      }
      auto answer = normalised(question, *value);
      if (!answer) return bad_body();
      answers[question.id] = *std::move(answer);
    }
    return accepted(QuestionsAnswered{std::move(answers)});
  }

  [[nodiscard]] Decision ask(Left left) const {
    if (!seat_.member || state_.phase == RoomPhase::kEnded) return accepted(std::move(left));
    if (stage_of_seat(room_, seat_) == "debrief") return nothing_to_do();
    if (is_running(state_)) {
      const auto others = num_active_people(state_) - (seat_.status == SeatStatus::kActive ? 1 : 0);
      if (room_.study.group().dropout.policy == DropoutPolicy::kSimulate && others > 0) {
        left.by = state_.seats.size() + 1;
        left.type = std::string{seat_.type};
      }
    }
    return accepted(std::move(left));
  }

 private:
  [[nodiscard]] static Decision bad_body() { return refused("bad-body", std::string{kIncomplete}); }
  [[nodiscard]] static Decision not_now() { return refused("not-now", "This is not possible at the moment."); }
  [[nodiscard]] static Decision too_late() { return refused("too-late", "The group has moved on."); }
  // Whether it was meant for another round: pages send again what was not acknowledged, however late that is.
  [[nodiscard]] bool is_late(const std::optional<std::size_t>& round) const {
    return round && *round != current_period(state_);
  }

  [[nodiscard]] bool is_right(StartIndex start, const JudgedPath& judged) const {
    const auto& atlas = *room_.study.atlas;
    return judged.counts && judge_path(atlas.domain(), atlas.feature_counts(start), *judged.counts).is_right;
  }

  [[nodiscard]] Decision illegal(const JudgedPath& judged) const {
    if (judged.is_too_long) {
      return refused("too-long", "A path has at most " +
                                     std::to_string(max_answer_actions(room_.study.atlas->domain())) +
                                     " moves. Please undo some of yours and submit it again.");
    }
    return refused("illegal-path", "The robot cannot move like this. Please reset the path and try again.");
  }

  [[nodiscard]] JudgedPath judged_at(std::size_t test, const std::vector<std::size_t>& actions, bool for_ever) const {
    return judged_path(*room_.study.atlas, state_.session->lesson().tests[test].start, actions, for_ever);
  }

  // A step from 1 for Likert items, the option's text for choices, a text.
  [[nodiscard]] static std::optional<Json> normalised(const GroupQuestion& question, const Json& value) {
    const auto& options = question.options;
    const auto num_options = static_cast<std::int64_t>(options.size());
    switch (question.kind) {
      case GroupQuestion::Kind::kLikert:
        return as_json(read_within<std::int64_t>(value, {.least = 1, .most = options.empty() ? 7 : num_options}));
      case GroupQuestion::Kind::kChoice: {
        if (const auto i = read_within<std::size_t>(value, {.most = num_options - 1})) return Json(options[*i]);
        const bool is_option =
            std::any_of(options.begin(), options.end(), [&](const auto& one) { return value == Json(one); });
        return is_option ? std::optional{value} : std::nullopt;
      }
      case GroupQuestion::Kind::kText:
        return as_json(read_within<std::string>(value, {.longest = kMostAnswerBytes}));
    }
    return std::nullopt;
  }
  template <typename T>
  [[nodiscard]] static std::optional<Json> as_json(const std::optional<T>& value) {
    return value ? std::optional{Json(*value)} : std::nullopt;
  }

  const LiveSeat& seat_;
};

// What the service reports: who came, who is there.
class ServerDecider : Decider {
  static constexpr std::string_view kIncomplete = "the description of the person is incomplete";

 public:
  using Decider::Decider;

  [[nodiscard]] Decision decide() const {
    if (!command_.body.is_object()) return refused("bad-body", "the body is not an object");
    const bool is_halt = command_.type == Paused::kKind.command || command_.type == Resumed::kKind.command;
    if (is_halt) return decide_facilitator(room_, command_, now_us_);  // while it was stopped
    if (!is_command(RoomSender::kServer, command_.type)) {
      return refused("unknown-type", "the server has no command '" + command_.type + "'");
    }
    return asked<RoomSender::kServer>(*this, command_, kIncomplete);
  }

  [[nodiscard]] std::optional<Decision> closed(OfKind<Joined>) const {
    return state_.phase == RoomPhase::kLobby ? std::nullopt : std::optional{started()};
  }
  [[nodiscard]] Decision ask(const Joined& wish) const {
    if (wish.seat > 0) return join_seat(wish.seat - 1);
    for (std::size_t m = 0; m < state_.members.size(); ++m) {
      const auto& member = state_.members[m];
      if (!member.seat) return joined(state_.seats.size(), m);
      if (state_.seats[*member.seat].status == SeatStatus::kEmpty) return joined(*member.seat, m);
    }
    if (room_.setup.is_waiting_list) return joined(state_.seats.size(), std::nullopt);
    return refused("full", "All places in this group are taken.");
  }

  [[nodiscard]] Decision ask(Grouped wish) const {
    const auto planned = next_group_in(room_, now_us_);
    if (!planned) return refused("not-now", "No group can be formed at the moment.");
    const auto& [cell, simulated, seats] = *planned;
    const bool is_planned = wish == Grouped{cell.strategy, cell.composition, simulated, seats, wish.room};
    return is_planned ? accepted(std::move(wish)) : refused(kPlanned);
  }

  [[nodiscard]] std::optional<Decision> closed(OfKind<Seated>) const {
    const bool is_open = !room_.setup.is_waiting_list && state_.phase == RoomPhase::kLobby;
    return is_open ? std::nullopt : std::optional{started()};
  }
  [[nodiscard]] Decision ask(Seated person) const {
    if (person.member >= state_.members.size() || person.ready_us > now_us_ ||
        person.screened.size() != room_.study.screening.size()) {
      return refused("bad-body", std::string{kIncomplete});
    }
    const auto& seat = state_.seats[person.member];
    if (!seat.is_person || seat.status != SeatStatus::kEmpty) return refused("full", "The place is taken.");
    person.seat = person.member + 1;
    person.query = collected_query(room_.study, person.query);
    return accepted(std::move(person));
  }

  [[nodiscard]] Decision ask(const Away& away) const { return presence(away, false); }
  [[nodiscard]] Decision ask(const Present& present) const { return presence(present, true); }

 private:
  [[nodiscard]] static Decision started() { return refused("started", "This group has already started."); }

  [[nodiscard]] Decision join_seat(std::size_t seat) const {
    if (seat >= state_.seats.size() || !state_.seats[seat].is_person) {
      return refused("no-seat", "There is no such place in this group.");
    }
    if (state_.seats[seat].status == SeatStatus::kActive) return nothing_to_do();
    if (state_.seats[seat].status != SeatStatus::kEmpty) return refused("gone", "Your part in this session is over.");
    return joined(seat, state_.seats[seat].member);
  }

  [[nodiscard]] Decision joined(std::size_t seat, std::optional<std::size_t> member) const {
    return accepted(Joined{seat + 1, member});
  }

  template <typename Event>
  [[nodiscard]] Decision presence(const Event& event, bool is_here) const {
    if (event.seat > state_.seats.size()) return refused(kPlace);
    const auto& seat = state_.seats[event.seat - 1];
    if (!seat.is_person || seat.status == SeatStatus::kEmpty) {
      return refused("not-joined", "Nobody has joined with this link yet.");
    }
    return seat.is_here == is_here ? nothing_to_do() : accepted(event);
  }
};

}  // namespace

Decision decide_in(const RoomParts& room, const RoomCommand& command, std::int64_t now_us) {
  const auto now = std::max(now_us, room.state.last_us);
  if (command.actor == "facilitator") return decide_facilitator(room, command, now);
  if (command.actor == "server") return ServerDecider{room, command, now}.decide();
  const auto seat = seat_of_actor(command.actor);
  if (!seat || *seat > room.state.seats.size() || !room.state.seats[*seat - 1].is_person) {
    return refused("no-seat", "There is no such place in this group.");
  }
  return SeatDecider{room, *seat - 1, command, now}.decide();
}

}  // namespace kith
