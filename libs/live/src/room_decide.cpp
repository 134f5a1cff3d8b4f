#include <algorithm>

#include "exploration.hpp"
#include "kith/domains/judgement.hpp"
#include "room_body.hpp"
#include "room_state.hpp"

namespace kith {

using namespace happening;  // NOLINT(google-build-using-namespace): every event is named here

namespace {

constexpr std::int64_t kMostMillis = 86'400'000;
constexpr std::size_t kMostNameBytes = 80;
constexpr std::size_t kMostAnswerBytes = 4000;
constexpr std::size_t kMostExplorations = 2000;  // of one person
constexpr std::size_t kMostStartBytes = 2000;

// What a person asks for.
class SeatDecider {
 public:
  SeatDecider(const RoomParts& room, std::size_t seat, const RoomCommand& command, std::int64_t now_us)
      : room_{room}, state_{room.state}, seat_{room.state.seats[seat]}, command_{command}, now_us_{now_us} {}

  [[nodiscard]] Decision decide() const {
    if (!is_command(RoomSender::kSeat, command_.type)) return refused("unknown-type", "This message is not known.");
    if (!command_.body.is_object()) return bad_body();
    if (seat_.status == SeatStatus::kEmpty) return refused("not-joined", "Nobody has joined with this link yet.");
    if (seat_.status == SeatStatus::kGone) {
      if (command_.type == Left::kKind.command) return nothing_to_do();
      return refused("gone", "Your part in this session is over.");
    }
    return asked<RoomSender::kSeat>(command_.type, [&](auto kind) { return ask(kind); });
  }

 private:
  [[nodiscard]] static Decision bad_body() { return refused("bad-body", "This message is not complete."); }
  [[nodiscard]] static Decision not_now() { return refused("not-now", "This is not possible at the moment."); }
  [[nodiscard]] static Decision too_late() { return refused("too-late", "The group has moved on."); }
  [[nodiscard]] Decision accepted(RoomHappening what) const {
    return {{{state_.seq + 1, now_us_, command_.actor, std::move(what)}}, {}};
  }

  [[nodiscard]] Decision ask(OfKind<Consented>) const {
    const auto accept = command_.body.find("accept");
    const auto version = text_in(command_.body, "version", 100);
    if (accept == command_.body.end() || !accept->is_boolean() || !version) return bad_body();
    if (seat_.readiness != Readiness::kConsent) return *accept ? nothing_to_do() : not_now();
    if (!accept->get<bool>()) return accepted(Declined{});
    if (*version != room_.study.group().consent_version) {
      return refused("other-version", "The text has changed. Please reload the page and read it again.");
    }
    auto query = collected_query(room_.study, command_.body.value("query", Json{}));
    return accepted(Consented{*version, std::move(query)});
  }

  [[nodiscard]] Decision ask(OfKind<Declined>) const { return ask(OfKind<Consented>{}); }

  [[nodiscard]] Decision ask(OfKind<Checked>) const {
    if (seat_.readiness == Readiness::kConsent) return not_now();
    if (seat_.readiness != Readiness::kCheck) return nothing_to_do();
    return accepted(Checked{});
  }

  [[nodiscard]] Decision ask(OfKind<Named>) const {
    const auto name = text_in(command_.body, "name", kMostNameBytes);
    if (!name || name->find('\n') != std::string::npos) return bad_body();
    if (!room_.study.group().ask_name || seat_.readiness == Readiness::kConsent) return not_now();
    return *name == seat_.name ? nothing_to_do() : accepted(Named{*name});
  }

  [[nodiscard]] Decision ask(OfKind<Screened>) const {
    const auto test = integer_in(command_.body, "test", 0, 1000);
    const auto actions = actions_in(command_.body);
    const auto for_ever = flag_in(command_.body, "for_ever");
    const auto ms = integer_in(command_.body, "ms", 0, kMostMillis);
    if (!test || !actions || !for_ever || !ms) return bad_body();
    if (seat_.readiness == Readiness::kConsent || seat_.readiness == Readiness::kCheck) return not_now();
    const auto number = static_cast<std::size_t>(*test);
    if (number < seat_.screened.size()) return nothing_to_do();
    if (seat_.readiness != Readiness::kScreening || number != seat_.screened.size()) return not_now();
    const auto& atlas = *room_.study.atlas;
    const auto demo = room_.study.screening[number];
    const auto judged = judged_path(atlas, demo, *actions, *for_ever);
    if (!judged.is_legal) return illegal(judged);
    return accepted(Screened{number, *actions, is_right(demo, judged), *ms, *for_ever});
  }

  [[nodiscard]] Decision ask(OfKind<Examined>) const {
    const auto test = integer_in(command_.body, "test", 0, 1000);
    const auto actions = actions_in(command_.body);
    const auto for_ever = flag_in(command_.body, "for_ever");
    const auto ms = integer_in(command_.body, "ms", 0, kMostMillis);
    if (!test || !actions || !for_ever || !ms) return bad_body();
    const auto number = static_cast<std::size_t>(*test);
    if (number < seat_.exam.size()) return nothing_to_do();
    if (state_.phase != RoomPhase::kQuestions || !seat_.examined || number != seat_.exam.size()) return not_now();
    const auto judged = judged_path(*room_.study.atlas, *seat_.examined, *actions, *for_ever);
    if (!judged.is_legal) return illegal(judged);
    return accepted(
        Examined{number, seat_.examined->value(), *actions, is_right(*seat_.examined, judged), *ms, *for_ever});
  }

  [[nodiscard]] bool is_right(StartIndex demo, const JudgedPath& judged) const {
    const auto& atlas = *room_.study.atlas;
    return judged.counts && judge_path(atlas.domain(), atlas.feature_counts(demo), *judged.counts).is_right;
  }

  [[nodiscard]] Decision illegal(const JudgedPath& judged) const {
    if (judged.is_too_long) {
      return refused("too-long", "A path has at most " +
                                     std::to_string(max_answer_actions(room_.study.atlas->domain())) +
                                     " moves. Please undo some of yours and submit it again.");
    }
    return refused("illegal-path", "The robot cannot move like this. Please reset the path and try again.");
  }

  [[nodiscard]] Decision ask(OfKind<Watched>) const {
    const auto demo = integer_in(command_.body, "demo", 0, 1000);
    if (!demo) return bad_body();
    if (state_.phase != RoomPhase::kWatching || !seat_.in_period) {
      return is_running(state_) && state_.phase != RoomPhase::kWatching ? nothing_to_do() : not_now();
    }
    const auto number = static_cast<std::size_t>(*demo);
    if (number < seat_.watched) return nothing_to_do();
    if (number > seat_.watched) return not_now();
    return accepted(Watched{number});
  }

  [[nodiscard]] JudgedPath judged_at(std::size_t test, const std::vector<std::size_t>& actions, bool for_ever) const {
    return judged_path(*room_.study.atlas, state_.session->lesson().tests[test].demo, actions, for_ever);
  }

  [[nodiscard]] Decision ask(OfKind<Drafted>) const {
    const auto test = integer_in(command_.body, "test", 0, 1000);
    const auto actions = actions_in(command_.body);
    if (!test || !actions) return bad_body();
    if (state_.phase != RoomPhase::kTesting || !seat_.in_period || seat_.has_answered) return nothing_to_do();
    const auto number = static_cast<std::size_t>(*test);
    if (number != current_test(seat_)) return nothing_to_do();
    if (*actions == seat_.draft) return nothing_to_do();
    if (const auto judged = judged_at(number, *actions, false); !judged.is_legal) return illegal(judged);
    return accepted(Drafted{number, *actions});
  }

  [[nodiscard]] Decision ask(OfKind<Answered>) const {
    const auto test = integer_in(command_.body, "test", 0, 1000);
    const auto actions = actions_in(command_.body);
    const auto for_ever = flag_in(command_.body, "for_ever");
    const auto keys = keys_in(command_.body);
    const auto ms = integer_in(command_.body, "ms", 0, kMostMillis);
    if (!test || !actions || !for_ever || !keys || !ms) return bad_body();
    const auto number = static_cast<std::size_t>(*test);
    const bool was_given = number < seat_.paths.size() && seat_.paths[number];
    if (was_given && seat_.paths[number]->actions == *actions && seat_.paths[number]->for_ever == *for_ever)
      return nothing_to_do();
    if (state_.phase != RoomPhase::kTesting || !seat_.in_period) {
      return state_.phase == RoomPhase::kWatching ? not_now() : too_late();
    }
    if (was_given) return refused("already-answered", "You have already answered this question.");
    if (seat_.has_answered) return too_late();
    if (number != current_test(seat_)) return not_now();
    if (const auto judged = judged_at(number, *actions, *for_ever); !judged.is_legal) return illegal(judged);
    return accepted(Answered{number, *actions, *keys, *ms, *for_ever});
  }

  // No choice: keeps the own answer.
  [[nodiscard]] Decision ask(OfKind<Discussed>) const {
    const auto test = integer_in(command_.body, "test", 0, 1000);
    const auto ms = integer_in(command_.body, "ms", 0, kMostMillis);
    const auto given = command_.body.find("choice");
    const bool keeps = given == command_.body.end() || given->is_null();
    const auto choice = keeps ? std::nullopt : integer_in(command_.body, "choice", 0, 1000);
    if (!test || !ms || (!keeps && !choice)) return bad_body();
    if (state_.phase != RoomPhase::kDiscussing || !seat_.in_period) {
      return state_.phase == RoomPhase::kTesting || state_.phase == RoomPhase::kWatching ? not_now() : too_late();
    }
    const auto number = static_cast<std::size_t>(*test);
    BoardChoice wanted;
    if (choice) wanted.entry = static_cast<std::size_t>(*choice);
    if (number < seat_.choices.size() && seat_.choices[number]) {
      if (*seat_.choices[number] == wanted) return nothing_to_do();
      return refused("already-answered", "You have already decided about this question.");
    }
    if (number >= seat_.choices.size() || number != current_choice(seat_)) return not_now();
    if (wanted.entry && *wanted.entry >= state_.board[number].size()) return bad_body();
    return accepted(Discussed{number, wanted.entry, *ms});
  }

  [[nodiscard]] Decision ask(OfKind<Continued>) const {
    if (state_.phase != RoomPhase::kFeedback || !seat_.in_period) {
      return is_running(state_) || state_.phase == RoomPhase::kQuestions ? nothing_to_do() : not_now();
    }
    return seat_.has_continued ? nothing_to_do() : accepted(Continued{});
  }

  [[nodiscard]] Decision ask(OfKind<Explored>) const {
    const auto& domain = room_.study.atlas->domain();
    const auto stage = stage_of_seat(room_, seat_);
    if (!room_.study.group().screens.explore || !can_explore(domain)) return not_now();
    if (stage != "feedback" && stage != "debrief") return too_late();
    if (seat_.explorations >= kMostExplorations) return not_now();
    auto start = command_.body.value("start", Json{});
    if (!start.is_object() || start.dump().size() > kMostStartBytes) return bad_body();
    if (command_.body.contains("world")) {
      const auto world = integer_in(command_.body, "world", 0, static_cast<std::int64_t>(domain.num_mdps()) - 1);
      return world ? accepted(Explored{std::move(start), static_cast<std::size_t>(*world), {}}) : bad_body();
    }
    auto map = rows_of(*domain.drawing(), command_.body.value("map", Json{}));
    return map ? accepted(Explored{std::move(start), std::nullopt, *std::move(map)}) : bad_body();
  }

  // As many rows and symbols as the map has.
  [[nodiscard]] static std::optional<std::vector<std::string>> rows_of(const GridMap& map, const Json& json) {
    if (!json.is_array() || json.size() != static_cast<std::size_t>(map.height())) return std::nullopt;
    std::vector<std::string> rows;
    for (const auto& row : json) {
      if (!row.is_string()) return std::nullopt;
      rows.push_back(row.get<std::string>());
      if (rows.back().size() != static_cast<std::size_t>(map.width()) ||
          !is_clean_text(rows.back(), rows.back().size())) {
        return std::nullopt;
      }
    }
    return rows;
  }

  [[nodiscard]] Decision ask(OfKind<QuestionsAnswered>) const {
    if (state_.phase != RoomPhase::kQuestions || !seat_.member || seat_.examined) return not_now();
    if (seat_.has_answered_questions || room_.study.group().questions.empty()) return nothing_to_do();
    const auto given = command_.body.find("answers");
    if (given == command_.body.end() || !given->is_object()) return bad_body();
    Json answers = Json::object();
    for (const auto& question : room_.study.group().questions) {
      const auto value = given->find(question.id);
      const bool is_missing = value == given->end() || value->is_null() || *value == Json(std::string{});
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

  // A step from 1 for Likert items, the option's text for choices, a text.
  [[nodiscard]] static std::optional<Json> normalised(const GroupQuestion& question, const Json& value) {
    switch (question.kind) {
      case GroupQuestion::Kind::kLikert: {
        const auto steps = question.options.empty() ? 7 : static_cast<std::int64_t>(question.options.size());
        const auto step = integer_in({{"step", value}}, "step", 1, steps);
        return step ? std::optional{Json(*step)} : std::nullopt;
      }
      case GroupQuestion::Kind::kChoice: {
        if (const auto i = integer_in({{"i", value}}, "i", 0, static_cast<std::int64_t>(question.options.size()) - 1))
          return Json(question.options[static_cast<std::size_t>(*i)]);
        const bool is_option =
            value.is_string() && std::find(question.options.begin(), question.options.end(),
                                           value.get_ref<const std::string&>()) != question.options.end();
        return is_option ? std::optional{value} : std::nullopt;
      }
      case GroupQuestion::Kind::kText:
        if (!value.is_string() || !is_clean_text(value.get_ref<const std::string&>(), kMostAnswerBytes))
          return std::nullopt;
        return value;
    }
    return std::nullopt;
  }

  [[nodiscard]] Decision ask(OfKind<Left>) const {
    if (!seat_.member || state_.phase == RoomPhase::kEnded) return accepted(Left{});
    if (stage_of_seat(room_, seat_) == "debrief") return nothing_to_do();
    Left left;
    if (is_running(state_)) {
      const auto others = num_active_people(state_) - (seat_.status == SeatStatus::kActive ? 1 : 0);
      if (room_.study.group().dropout.policy == DropoutPolicy::kSimulate && others > 0) {
        left.by = state_.seats.size() + 1;
        left.type = std::string{seat_.type};
      }
    }
    return accepted(std::move(left));
  }

  const RoomParts& room_;
  const Room::State& state_;
  const LiveSeat& seat_;
  const RoomCommand& command_;
  std::int64_t now_us_;
};

// What the service reports: who came, who is there.
class ServerDecider {
 public:
  ServerDecider(const RoomParts& room, const RoomCommand& command, std::int64_t now_us)
      : room_{room}, state_{room.state}, command_{command}, now_us_{now_us} {}

  [[nodiscard]] Decision decide() const {
    if (!command_.body.is_object()) return refused("bad-body", "the body is not an object");
    if (!is_command(RoomSender::kServer, command_.type)) {
      return refused("unknown-type", "the server has no command '" + command_.type + "'");
    }
    return asked<RoomSender::kServer>(command_.type, [&](auto kind) { return ask(kind); });
  }

 private:
  [[nodiscard]] Decision accepted(RoomHappening what) const {
    return {{{state_.seq + 1, now_us_, command_.actor, std::move(what)}}, {}};
  }

  [[nodiscard]] Decision ask(OfKind<Joined>) const {
    if (state_.phase != RoomPhase::kLobby) return refused("started", "This group has already started.");
    const auto asked = integer_in(command_.body, "seat", 1, 1000);
    if (command_.body.contains("seat") && !command_.body["seat"].is_null() && !asked)
      return refused("bad-body", "'seat' is not a number of a seat");
    if (asked) return join_seat(static_cast<std::size_t>(*asked) - 1);
    for (std::size_t m = 0; m < state_.members.size(); ++m) {
      const auto& member = state_.members[m];
      if (!member.seat) return joined(state_.seats.size(), m);
      if (state_.seats[*member.seat].status == SeatStatus::kEmpty) return joined(*member.seat, m);
    }
    if (room_.setup.is_waiting_list) return joined(state_.seats.size(), std::nullopt);
    return refused("full", "All places in this group are taken.");
  }

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

  [[nodiscard]] Decision ask(OfKind<Grouped>) const {
    const auto room = text_in(command_.body, "room", 100);
    const auto planned = next_group_in(room_, now_us_);
    if (!room || !planned) return refused("not-now", "No group can be formed at the moment.");
    auto body = to_json(*planned);
    body["room"] = *room;
    if (body != command_.body) return refused("not-now", "Somebody has come or gone since this group was planned.");
    return accepted(
        Grouped{planned->cell.strategy, planned->cell.composition, planned->simulated, planned->seats, *room});
  }

  [[nodiscard]] Decision ask(OfKind<Seated>) const {
    if (room_.setup.is_waiting_list || state_.phase != RoomPhase::kLobby) {
      return refused("started", "This group has already started.");
    }
    const auto member = integer_in(command_.body, "member", 0, static_cast<std::int64_t>(state_.members.size()) - 1);
    const auto version = text_in(command_.body, "version", 100);
    const auto name = text_in(command_.body, "name", kMostNameBytes);
    const auto ready = integer_in(command_.body, "ready_us", 0, now_us_);
    const auto from = command_.body.find("from");
    const auto screened = screening_in(command_.body);
    if (!member || !version || !name || !ready || from == command_.body.end() || !from->is_object() || !screened) {
      return refused("bad-body", "the description of the person is incomplete");
    }
    const auto number = static_cast<std::size_t>(*member);
    if (!state_.seats[number].is_person || state_.seats[number].status != SeatStatus::kEmpty) {
      return refused("full", "The place is taken.");
    }
    return accepted(Seated{number + 1, number, *from, *version,
                           collected_query(room_.study, command_.body.value("query", Json{})), *name, *screened,
                           *ready});
  }

  // Whether each answer to the tests of the screening was right.
  [[nodiscard]] std::optional<std::vector<bool>> screening_in(const Json& body) const {
    const auto found = body.find("screened");
    if (found == body.end() || !found->is_array() || found->size() != room_.study.screening.size()) return {};
    std::vector<bool> screened;
    for (const auto& right : *found) {
      if (!right.is_boolean()) return {};
      screened.push_back(right.get<bool>());
    }
    return screened;
  }

  [[nodiscard]] Decision ask(OfKind<Away>) const { return presence<Away>(false); }
  [[nodiscard]] Decision ask(OfKind<Present>) const { return presence<Present>(true); }
  template <typename Event>
  [[nodiscard]] Decision presence(bool is_here) const {
    const auto number = integer_in(command_.body, "seat", 1, static_cast<std::int64_t>(state_.seats.size()));
    if (!number) return refused("no-seat", "There is no such place in this group.");
    const auto& seat = state_.seats[static_cast<std::size_t>(*number) - 1];
    if (!seat.is_person || seat.status == SeatStatus::kEmpty) {
      return refused("not-joined", "Nobody has joined with this link yet.");
    }
    if (seat.is_here == is_here) return nothing_to_do();
    return accepted(Event{static_cast<std::size_t>(*number)});
  }

  const RoomParts& room_;
  const Room::State& state_;
  const RoomCommand& command_;
  std::int64_t now_us_;
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
