#include <algorithm>

#include "exploration.hpp"
#include "kith/explain/board_json.hpp"
#include "kith/explain/curriculum_json.hpp"
#include "kith/explain/examination.hpp"
#include "kith/explain/runs.hpp"
#include "live_texts.hpp"
#include "room_view.hpp"
#include "session_summary.hpp"

namespace kith {
namespace {

// Why a person's session ended early, in their words.
std::string end_text(const LiveSeat& seat, const std::string& group_text) {
  if (seat.last_page == "declined") return "You chose not to take part. Nothing about you was kept.";
  if (seat.last_page == "full") return "All places in the group are taken. Thank you for coming.";
  if (seat.last_page == "replaced") {
    return seat.why == "simulated" ? "The people who run this session had to give your place away."
                                   : "You were away for too long, so the group went on without you.";
  }
  if (seat.why == "left") return "You left the session. Thank you for taking part.";
  if (seat.why == "not-ready") return "It took too long to get ready, so your place was given away.";
  if (seat.why == "lobby-time") return "Not enough people came in time.";
  return group_text;
}

class ParticipantPage {
 public:
  ParticipantPage(const RoomParts& room, std::size_t seat, std::int64_t now_us)
      : room_{room}, state_{room.state}, seat_{room.state.seats[seat]}, number_{seat}, now_us_{now_us} {}

  [[nodiscard]] Json json() const {
    const auto stage = stage_of_seat(room_, seat_);
    const auto& study = room_.study;
    Json view{{"v", 1},
              {"stage", stage},
              {"lang", study.language.code},
              {"dir", study.language.direction},
              {"study", study_texts_json(study)},
              {"me", {{"seat", number_ + 1}, {"label", label()}}},
              {"group", {{"size", size()}, {"active", num_active()}}},
              {"notices", notices()}};
    if (is_running(state_) && seat_.status != SeatStatus::kGone && seat_.member) {
      if (auto waiting = pause(); !waiting.is_null()) view["pause"] = std::move(waiting);
      view["progress"] = progress();
    }
    add_stage(view, stage);
    view["server_ms"] = in_ms(now_us_);
    return view;
  }

 private:
  [[nodiscard]] std::string label() const {
    return seat_.member ? member_label(*seat_.member) : std::string{"Learner"};
  }
  // Of the group; on the waiting list of the largest that somebody may be seated in.
  [[nodiscard]] std::size_t size() const {
    if (!room_.setup.is_waiting_list) return state_.members.size();
    std::size_t largest = 0;
    for (const auto& cell : live_cells(room_.study)) largest = std::max(largest, cell.composition.size());
    return largest;
  }
  // People and stand-ins alike: which is which is none of the page's business.
  [[nodiscard]] std::size_t num_active() const {
    return static_cast<std::size_t>(std::count_if(state_.members.begin(), state_.members.end(),
                                                  [&](const LiveMember& m) { return is_taken(state_, m); }));
  }

  [[nodiscard]] Json notices() const {
    Json list = Json::array();
    for (const auto& notice : state_.notices) {
      if (notice.seat && *notice.seat != number_) continue;
      list.push_back({{"text", notice.text}, {"at_ms", in_ms(notice.at_us)}});
    }
    return list;
  }

  // The group stands still for the facilitator, or for nobody but people who are away.
  [[nodiscard]] Json pause() const {
    if (state_.paused_us) {
      return {{"why", "facilitator"}, {"since_ms", in_ms(*state_.paused_us)}, {"missing", 0}};
    }
    if (room_.study.group().dropout.policy == DropoutPolicy::kContinueNow) return {};
    std::size_t missing = 0;
    std::int64_t since = 0;
    for (const auto& seat : state_.seats) {
      if (!gates(seat) || has_done_phase(state_, seat)) continue;
      if (seat.is_here) return {};  // somebody is at work
      since = missing++ == 0 ? seat.presence_us : std::min(since, seat.presence_us);
    }
    if (missing == 0) return {};
    const auto until = since + room_.study.group().dropout.grace_s * kSecond;
    return {{"why", "someone-away"}, {"since_ms", in_ms(since)}, {"until_ms", in_ms(until)}, {"missing", missing}};
  }

  // Of the parts there are and the rounds so far: nothing about what anybody believes.
  [[nodiscard]] Json progress() const {
    const auto components = state_.session->components();
    const auto over = std::count_if(components.begin(), components.end(),
                                    [](ComponentStatus status) { return status != ComponentStatus::kOpen; });
    const auto rounds = state_.session->periods();
    const bool between = state_.phase == RoomPhase::kFeedback || state_.phase == RoomPhase::kTeaching;
    // While feedback is read the next lesson may be there already: it must not show.
    return {
        {"part", part(over, components.size())},
        {"round", rounds + (between && rounds > 0 && state_.phase == RoomPhase::kFeedback ? 0u : 1u)},
        {"most", state_.session->options().max_periods},
        {"parts", components.size()},
        {"done",
         components.empty() ? 0.0 : static_cast<double>(shown_over(over)) / static_cast<double>(components.size())}};
  }
  // That of the lesson that is being taught. Feedback belongs to it, too, also if the part is finished now.
  [[nodiscard]] std::size_t part(std::ptrdiff_t over, std::size_t parts) const {
    const auto& session = *state_.session;
    if (state_.phase == RoomPhase::kFeedback && !session.history().empty()) {
      return session.history().back().lesson.component + 1;
    }
    if (rules_of(state_.phase).has_open_lesson) return session.lesson().component + 1;
    return std::min(static_cast<std::size_t>(over) + 1, parts);
  }
  [[nodiscard]] std::ptrdiff_t shown_over(std::ptrdiff_t over) const {
    if (state_.phase != RoomPhase::kFeedback || !state_.before) return over;
    const auto components = state_.before->components();
    return std::count_if(components.begin(), components.end(),
                         [](ComponentStatus status) { return status != ComponentStatus::kOpen; });
  }

  void add_stage(Json& view, const std::string& stage) const {
    if (stage == "consent") {
      view["consent"] = {{"version", room_.study.group().consent_version},
                         {"paragraphs", room_.study.group().consent_text},
                         {"stores", stored_json(room_.study.group())}};
    } else if (stage == "check") {
      view["check"] = {{"board", live_board(room_.study, room_.study.sandbox)},
                       {"world", world_key(room_.study, room_.study.atlas->id(room_.study.sandbox).mdp)},
                       {"start", start_number(room_.study.sandbox)},
                       {"parts", room_.study.atlas->knowledge_components().size()},
                       {"most", room_.study.spec.teaching.max_periods},
                       {"ask_name", room_.study.group().ask_name}};
    } else if (stage == "screening") {
      view["predict"] =
          task(room_.study.screening[seat_.screened.size()], seat_.screened.size(), room_.study.screening.size(), {});
    } else if (stage == kExamPage) {
      view["predict"] = task(*seat_.examined, seat_.exam.size(), Examination::kMostBoards, {});
    } else if (stage == "lobby") {
      view["lobby"] = lobby();
    } else if (stage == "wait") {
      view["wait"] = wait();
    } else if (stage == "debrief") {
      view["debrief"] = debrief();
    } else if (is_running(state_) && stage == rules_of(state_.phase).word) {
      add_phase(view);
    } else if (stage == "questions") {
      view["questions"] = {{"items", questions()}};
    } else {
      view["end"] = end_json(room_.study, seat_.why, end_text(seat_, state_.end_text),
                             seat_.gets_code ? code() : std::string{}, seat_.query);
    }
    const bool may_explore = stage == "feedback" || stage == "debrief";
    if (may_explore && room_.study.group().screens.explore && can_explore(room_.study.atlas->domain())) {
      view["explore"] = explore_json(room_, seat_);
    }
    if (state_.deadline_us && stage == rules_of(state_.phase).word) view["limit_ms"] = in_ms(*state_.deadline_us);
  }

  // What there is to do for the group.
  void add_phase(Json& view) const {
    switch (state_.phase) {
      case RoomPhase::kWatching:
        view["watch"] = watch();
        return;
      case RoomPhase::kTesting: {
        const auto& tests = state_.session->lesson().tests;
        const auto test = current_test(seat_);
        view["predict"] = task(tests[test].demo, test, tests.size(), seat_.draft);
        return;
      }
      case RoomPhase::kDiscussing:
        view["discuss"] = discussion();
        return;
      case RoomPhase::kFeedback:
        view["feedback"] = feedback_json(room_, seat_);
        return;
      case RoomPhase::kLobby:  // there is nothing to do, or not for the group
      case RoomPhase::kTeaching:
      case RoomPhase::kQuestions:
      case RoomPhase::kEnded:
        return;
    }
  }

  [[nodiscard]] std::size_t start_number(StartIndex demo) const {
    const auto id = room_.study.atlas->id(demo);
    return world_state(room_.study, id.mdp, id.start).value_or(0);
  }

  [[nodiscard]] Json task(StartIndex demo, std::size_t index, std::size_t of,
                          const std::vector<std::size_t>& draft) const {
    return {{"index", index},
            {"of", of},
            {"board", live_board(room_.study, demo)},
            {"world", world_key(room_.study, room_.study.atlas->id(demo).mdp)},
            {"start", start_number(demo)},
            {"draft", draft}};
  }

  // What the group predicted, without names; which one is the own, and how many predicted each.
  [[nodiscard]] Json discussion() const {
    const auto test = current_choice(seat_);
    const auto demo = state_.session->lesson().tests[test].demo;
    const auto& domain = room_.study.atlas->domain();
    const auto own = own_entry(state_, test, *seat_.member);
    Json predictions = Json::array();
    for (std::size_t e = 0; e < state_.board[test].size(); ++e) {
      const auto& entry = state_.board[test][e];
      const auto path = judged_path(*room_.study.atlas, demo, entry.path.actions, entry.path.for_ever).path;
      auto prediction = path_json(domain, room_.study.atlas->id(demo).mdp, path);
      prediction["own"] = own == e;
      prediction["n"] = entry.members.size();
      predictions.push_back(std::move(prediction));
    }
    return {{"index", test},
            {"of", state_.board.size()},
            {"board", live_board(room_.study, demo)},
            {"predictions", predictions}};
  }

  [[nodiscard]] Json watch() const {
    const auto& demonstrations = state_.session->lesson().demonstrations;
    const auto demo = demonstrations[seat_.watched].demo;
    Json watch{{"index", seat_.watched}, {"of", demonstrations.size()}, {"board", live_board(room_.study, demo)}};
    watch.update(robot_path(room_.study, demo));
    if (room_.study.group().screens.predict_first) {
      watch["world"] = world_key(room_.study, room_.study.atlas->id(demo).mdp);
      watch["state"] = start_number(demo);
    }
    if (auto runs = robot_runs(room_.study, demo); !runs.is_null()) watch["runs"] = std::move(runs);
    return watch;
  }

  // How many others wait is shown, but not for whom they wait: that would tell people how able they are.
  [[nodiscard]] Json waiting_list() const {
    const auto waiting =
        static_cast<std::size_t>(std::count_if(state_.seats.begin(), state_.seats.end(), [](const LiveSeat& seat) {
          return seat.status == SeatStatus::kActive && seat.readiness == Readiness::kReady && seat.is_here;
        }));
    auto json = lobby_of(std::min(waiting, size() - 1), size());
    const auto lobby_s = room_.study.group().time.lobby_s;
    if (lobby_s > 0 && room_.study.group().auto_start) json["until_ms"] = in_ms(seat_.ready_us + lobby_s * kSecond);
    return json;
  }

  [[nodiscard]] Json lobby_of(std::size_t present, std::size_t size) const {
    const auto leave_us = seat_.ready_us + room_.study.group().time.leave_after_s * kSecond;
    return {
        {"present", present}, {"size", size}, {"since_ms", in_ms(seat_.ready_us)}, {"leave_after_ms", in_ms(leave_us)}};
  }

  [[nodiscard]] Json lobby() const {
    if (room_.setup.is_waiting_list) return waiting_list();
    const auto present = std::count_if(state_.members.begin(), state_.members.end(), [&](const LiveMember& member) {
      if (!member.seat) return false;
      const auto& seat = state_.seats[*member.seat];
      return !seat.is_person ||
             (seat.status == SeatStatus::kActive && seat.readiness == Readiness::kReady && seat.is_here);
    });
    auto json = lobby_of(static_cast<std::size_t>(present), state_.members.size());
    const auto lobby_s = room_.study.group().time.lobby_s;
    if (state_.phase == RoomPhase::kLobby && state_.lobby_us && lobby_s > 0 && room_.study.group().auto_start) {
      json["until_ms"] = in_ms(*state_.lobby_us + lobby_s * kSecond);
    }
    return json;
  }

  [[nodiscard]] Json wait() const {
    std::size_t missing = 0;
    for (const auto& seat : state_.seats) {
      if (&seat != &seat_ && gates(seat) && !has_done_phase(state_, seat)) ++missing;
    }
    auto what = rules_of(state_.phase).waits_for;
    const bool has_begun = state_.phase != RoomPhase::kTeaching || num_periods(state_) > 0;
    if (!seat_.has_taken_part && has_begun) what = "joining";
    if (seat_.has_taken_part && !seat_.in_period && state_.phase != RoomPhase::kTeaching) what = "rejoining";
    return {{"for", what}, {"missing", missing}, {"since_ms", in_ms(std::max(seat_.since_us, state_.phase_us))}};
  }

  [[nodiscard]] Json questions() const {
    Json items = Json::array();
    for (const auto& question : room_.study.group().questions) {
      Json item{{"id", question.id}, {"kind", std::string{name_of(question.kind)}}, {"text", question.text}};
      if (!question.options.empty()) item["options"] = question.options;
      if (!question.low.empty()) item["low"] = question.low;
      if (!question.high.empty()) item["high"] = question.high;
      item["required"] = question.required;
      items.push_back(std::move(item));
    }
    return items;
  }

  [[nodiscard]] std::string code() const {
    return completion_code(room_.study, room_.setup.salt, room_.setup.id, number_ + 1);
  }

  [[nodiscard]] Json debrief() const {
    const auto robot = robot_in_words(room_);
    Json json{{"summary", robot.taught}, {"not_reached", robot.not_reached},
              {"code", code()},          {"rounds", num_periods(state_)},
              {"right", seat_.right},    {"tests", seat_.tests}};
    if (auto redirect = redirect_json(room_.study, code(), seat_.query); !redirect.is_null()) {
      json["redirect"] = std::move(redirect);
    }
    return json;
  }

  const RoomParts& room_;
  const Room::State& state_;
  const LiveSeat& seat_;
  std::size_t number_;
  std::int64_t now_us_;
};

// As it stands in a query of a link.
std::string percent_encoded(const std::string& text) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string encoded;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
                       c == '_' || c == '.' || c == '~';
    if (plain) {
      encoded += c;
    } else {
      encoded += '%';
      encoded += kDigits[byte >> 4u];
      encoded += kDigits[byte & 15u];
    }
  }
  return encoded;
}

}  // namespace

Json live_board(const Atlas& atlas, StartIndex demo) {
  const auto& domain = atlas.domain();
  const auto all = board_domain_json(domain);
  Json legend{{"id", all["id"]}};
  for (const char* key : {"legend", "surfaces", "width", "height", "counted", "job"}) {
    if (all.contains(key)) legend[key] = all[key];
  }
  Json board{{"domain", legend}};
  board.update(board_json(domain, atlas.id(demo)));
  return board;
}

Json robot_path(const LiveStudy& study, StartIndex demo) {
  return path_json(study.atlas->domain(), study.atlas->id(demo).mdp, study.atlas->trajectory(demo));
}

Json robot_runs(const LiveStudy& study, StartIndex demo) {
  constexpr std::size_t kRuns = 10;
  const auto world = study.atlas->id(demo).mdp;
  if (study.atlas->domain().mdp(world).is_deterministic()) return nullptr;
  auto random = RandomStream{study.spec.seed}.split("runs").split(demo.value());
  return runs_json(study.atlas->domain(), world, several_runs(*study.atlas, demo, kRuns, random));
}

Json study_texts_json(const LiveStudy& study) {
  Json texts{{"title", study.group().title}, {"story", study.group().story}, {"goal", study.group().goal}};
  if (study.update) texts["update"] = update_json(*study.update);
  return texts;
}

Json redirect_json(const LiveStudy& study, const std::string& code, const Json& query) {
  auto link = study.group().completion.redirect;
  if (link.empty()) return {};
  const auto fill_in = [&](const std::string& name, const std::string& value) {
    const auto mark = "{" + name + "}";
    for (auto at = link.find(mark); at != std::string::npos; at = link.find(mark, at + value.size())) {
      link.replace(at, mark.size(), value);
    }
  };
  fill_in("code", percent_encoded(code));
  for (const auto& name : study.group().collect_query) {
    const bool is_there = query.is_object() && query.contains(name) && query[name].is_string();
    fill_in(name, is_there ? percent_encoded(query[name].get<std::string>()) : std::string{});
  }
  return link;
}

Json end_json(const LiveStudy& study, const std::string& reason, const std::string& text, const std::string& code,
              const Json& query) {
  Json json{{"reason", reason}, {"text", text}};
  if (code.empty()) return json;
  json["code"] = code;
  if (auto redirect = redirect_json(study, code, query); !redirect.is_null()) json["redirect"] = std::move(redirect);
  return json;
}

Json participant_view(const RoomParts& room, std::size_t seat, std::int64_t now_us) {
  return ParticipantPage{room, seat, now_us}.json();
}

Json full_view(const LiveStudy& study, const std::string& code, const Json& query, std::int64_t now_us) {
  LiveSeat nobody;
  nobody.last_page = "full";
  return {{"v", 1},
          {"stage", "full"},
          {"lang", study.language.code},
          {"dir", study.language.direction},
          {"study", study_texts_json(study)},
          {"me", {{"seat", 0}, {"label", "Learner"}}},
          {"group", {{"size", 0}, {"active", 0}}},
          {"notices", Json::array()},
          {"end", end_json(study, "full", end_text(nobody, {}), study.group().completion.pay_full ? code : "", query)},
          {"server_ms", in_ms(now_us)}};
}

}  // namespace kith
