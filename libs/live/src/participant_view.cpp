#include <algorithm>

#include "exploration.hpp"
#include "kith/explain/board_json.hpp"
#include "kith/explain/examination.hpp"
#include "kith/explain/runs.hpp"
#include "live_texts.hpp"
#include "message_json.hpp"
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

// The redirect of the study with the code and the query parameters filled in; empty without one.
std::string redirect(const LiveStudy& study, const std::string& code, const Json& query) {
  auto link = study.group().completion.redirect;
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

view::End end_of(const LiveStudy& study, const std::string& reason, const std::string& text, const std::string& code,
                 const Json& query) {
  return {reason, text, code, code.empty() ? std::string{} : redirect(study, code, query)};
}

// What is the same for everybody.
view::Participant empty_page(const LiveStudy& study, std::string stage, std::int64_t now_us) {
  const auto& group = study.group();
  view::Participant page;
  page.at<"stage">() = std::move(stage);
  page.at<"lang">() = study.language.code;
  page.at<"study">() = {group.title, group.story, group.goal, {}};
  if (const auto& update = study.update) {
    page.at<"study">().at<"update">() = {update->now, update->still, update->news};
  }
  page.at<"server_ms">() = in_ms(now_us);
  return page;
}

class ParticipantPage {
 public:
  ParticipantPage(const RoomParts& room, std::size_t seat, std::int64_t now_us)
      : room_{room}, state_{room.state}, seat_{room.state.seats[seat]}, number_{seat}, now_us_{now_us} {}

  [[nodiscard]] view::Participant page() const {
    const auto stage = stage_of_seat(room_, seat_);
    auto page = empty_page(room_.study, stage, now_us_);
    page.at<"me">() = {label()};
    page.at<"group">() = {size()};
    page.at<"notices">() = notices();
    if (is_running(state_) && seat_.status != SeatStatus::kGone && seat_.member) {
      page.at<"pause">() = pause();
      page.at<"progress">() = progress();
    }
    add_stage(page);
    return page;
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

  [[nodiscard]] std::vector<view::Notice> notices() const {
    std::vector<view::Notice> list;
    for (const auto& notice : state_.notices) {
      if (!notice.seat || *notice.seat == number_) list.push_back({notice.text, in_ms(notice.at_us)});
    }
    return list;
  }

  // The group stands still for the facilitator, or for nobody but people who are away.
  [[nodiscard]] std::optional<view::Pause> pause() const {
    if (state_.paused_us) return view::Pause{"facilitator", in_ms(*state_.paused_us), {}, 0};
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
    return view::Pause{"someone-away", in_ms(since), in_ms(until), missing};
  }

  // Of the parts there are and the rounds so far: nothing about what anybody believes.
  [[nodiscard]] view::Progress progress() const {
    const auto components = state_.session->components();
    const auto over = std::count_if(components.begin(), components.end(),
                                    [](ComponentStatus status) { return status != ComponentStatus::kOpen; });
    return {part(over, components.size()), current_period(state_), state_.session->options().max_periods,
            components.size()};
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

  void add_stage(view::Participant& page) const {
    const auto& stage = page.at<"stage">();
    const auto& study = room_.study;
    if (stage == "consent") {
      page.at<"consent">() = {study.group().consent_version, study.group().consent_text, stored_json(study.group())};
    } else if (stage == "check") {
      page.at<"check">() = check();
    } else if (stage == "screening") {
      page.at<"predict">() =
          task(study.screening[seat_.screened.size()], seat_.screened.size(), study.screening.size(), {});
    } else if (stage == kExamPage) {
      page.at<"predict">() = task(*seat_.examined, seat_.exam.size(), Examination::kMostBoards, {});
    } else if (stage == "lobby") {
      page.at<"lobby">() = lobby();
    } else if (stage == "wait") {
      page.at<"wait">() = wait();
    } else if (stage == "debrief") {
      page.at<"debrief">() = debrief();
    } else if (stage == rules_of(RoomPhase::kWatching).word) {
      page.at<"watch">() = watch();
    } else if (stage == rules_of(RoomPhase::kTesting).word) {
      const auto& tests = state_.session->lesson().tests;
      const auto test = current_test(seat_);
      page.at<"predict">() = task(tests[test].start, test, tests.size(), seat_.draft);
    } else if (stage == rules_of(RoomPhase::kDiscussing).word) {
      page.at<"discuss">() = discussion();
    } else if (stage == rules_of(RoomPhase::kFeedback).word) {
      page.at<"feedback">() = feedback_view(room_, seat_);
    } else if (stage == "questions") {
      page.at<"questions">() = {questions()};
    } else {
      page.at<"end">() =
          end_of(study, seat_.why, end_text(seat_, state_.end_text), seat_.gets_code ? code() : "", seat_.query);
    }
    const bool may_explore = stage == "feedback" || stage == "debrief";
    if (may_explore && study.group().screens.explore && can_explore(study.atlas->domain())) {
      page.at<"explore">() = explore_view(room_, seat_);
    }
    if (state_.deadline_us && stage == rules_of(state_.phase).word) page.at<"limit_ms">() = in_ms(*state_.deadline_us);
  }

  [[nodiscard]] std::size_t start_number(StartIndex start) const {
    const auto id = room_.study.atlas->id(start);
    return world_state(room_.study, id.mdp, id.start).value_or(0);
  }

  [[nodiscard]] std::string world_of(StartIndex start) const {
    return world_key(room_.study, room_.study.atlas->id(start).mdp);
  }

  [[nodiscard]] view::Check check() const {
    const auto& study = room_.study;
    return {live_board(study, study.sandbox),           world_of(study.sandbox),         start_number(study.sandbox),
            study.atlas->knowledge_components().size(), study.spec.teaching.max_periods, study.group().ask_name};
  }

  [[nodiscard]] view::Task task(StartIndex start, std::size_t index, std::size_t of,
                                const std::vector<std::size_t>& draft) const {
    return {index, of, live_board(room_.study, start), world_of(start), start_number(start), draft};
  }

  // What the group predicted, without names; which one is the own, and how many predicted each.
  [[nodiscard]] view::Discussion discussion() const {
    const auto test = current_choice(seat_);
    const auto start = state_.session->lesson().tests[test].start;
    const auto& domain = room_.study.atlas->domain();
    const auto own = own_entry(state_, test, *seat_.member);
    std::vector<view::Prediction> predictions;
    for (std::size_t e = 0; e < state_.board[test].size(); ++e) {
      const auto& entry = state_.board[test][e];
      const auto path = judged_path(*room_.study.atlas, start, entry.path.actions, entry.path.for_ever).path;
      predictions.push_back(
          {path_json(domain, room_.study.atlas->id(start).mdp, path), own == e, entry.members.size()});
    }
    return {test, state_.board.size(), live_board(room_.study, start), std::move(predictions)};
  }

  [[nodiscard]] view::Watch watch() const {
    const auto& demonstrations = state_.session->lesson().demonstrations;
    const auto start = demonstrations[seat_.watched].start;
    view::Watch watch{seat_.watched,
                      demonstrations.size(),
                      live_board(room_.study, start),
                      robot_path(room_.study, start),
                      {},
                      {},
                      robot_runs(room_.study, start)};
    if (!room_.study.group().screens.predict_first) return watch;
    watch.at<"world">() = world_of(start);
    watch.at<"state">() = start_number(start);
    return watch;
  }

  // On the waiting list how many others wait is shown, but not for whom they wait: that would tell people how able they
  // are.
  [[nodiscard]] view::Lobby lobby() const {
    const auto& time = room_.study.group().time;
    const auto waits = [](const LiveSeat& seat) {
      return seat.status == SeatStatus::kActive && seat.readiness == Readiness::kReady && seat.is_here;
    };
    const bool is_list = room_.setup.is_waiting_list;
    const auto present =
        is_list ? std::count_if(state_.seats.begin(), state_.seats.end(), waits)
                : std::count_if(state_.members.begin(), state_.members.end(), [&](const LiveMember& member) {
                    return member.seat && (!state_.seats[*member.seat].is_person || waits(state_.seats[*member.seat]));
                  });
    const auto shown = static_cast<std::size_t>(present);
    view::Lobby lobby{is_list ? std::min(shown, size() - 1) : shown,
                      size(),
                      in_ms(seat_.ready_us),
                      in_ms(seat_.ready_us + time.leave_after_s * kSecond),
                      {}};
    const auto since_us = is_list ? std::optional{seat_.ready_us} : state_.lobby_us;
    const bool is_open = is_list || state_.phase == RoomPhase::kLobby;
    if (is_open && since_us && time.lobby_s > 0 && room_.study.group().auto_start) {
      lobby.at<"until_ms">() = in_ms(*since_us + time.lobby_s * kSecond);
    }
    return lobby;
  }

  [[nodiscard]] view::Wait wait() const {
    std::size_t missing = 0;
    for (const auto& seat : state_.seats) {
      if (&seat != &seat_ && gates(seat) && !has_done_phase(state_, seat)) ++missing;
    }
    auto what = rules_of(state_.phase).waits_for;
    const bool has_begun = state_.phase != RoomPhase::kTeaching || num_periods(state_) > 0;
    if (!seat_.has_taken_part && has_begun) what = "joining";
    if (seat_.has_taken_part && !seat_.in_period && state_.phase != RoomPhase::kTeaching) what = "rejoining";
    return {std::string{what}, missing, in_ms(std::max(seat_.since_us, state_.phase_us))};
  }

  [[nodiscard]] std::vector<view::Question> questions() const {
    std::vector<view::Question> items;
    for (const auto& one : room_.study.group().questions) {
      items.push_back({one.id, std::string{name_of(one.kind)}, one.text, one.options, one.low, one.high, one.required});
    }
    return items;
  }

  [[nodiscard]] std::string code() const {
    return completion_code(room_.study, room_.setup.salt, room_.setup.id, number_ + 1);
  }

  [[nodiscard]] view::Debrief debrief() const {
    auto robot = robot_in_words(room_);
    return {std::move(robot.taught),
            std::move(robot.not_reached),
            code(),
            num_periods(state_),
            seat_.right,
            seat_.tests,
            redirect(room_.study, code(), seat_.query)};
  }

  const RoomParts& room_;
  const Room::State& state_;
  const LiveSeat& seat_;
  std::size_t number_;
  std::int64_t now_us_;
};

}  // namespace

Json board_legend(const Domain& domain) {
  const auto all = board_domain_json(domain);
  Json legend{{"id", all["id"]}};
  for (const char* key : {"legend", "surfaces", "width", "height", "counted", "job"}) {
    if (all.contains(key)) legend[key] = all[key];
  }
  return legend;
}

Json live_board(const Json& legend, const Atlas& atlas, StartIndex start) {
  Json board{{"domain", legend}};
  board.update(board_json(atlas.domain(), atlas.id(start)));
  return board;
}

Json robot_path(const LiveStudy& study, StartIndex start) {
  return path_json(study.atlas->domain(), study.atlas->id(start).mdp, study.atlas->trajectory(start));
}

Json robot_runs(const LiveStudy& study, StartIndex start) {
  constexpr std::size_t kRuns = 10;
  const auto world = study.atlas->id(start).mdp;
  if (study.atlas->domain().mdp(world).is_deterministic()) return nullptr;
  auto random = RandomStream{study.spec.seed}.split("runs").split(start.value());
  return runs_json(study.atlas->domain(), world, several_runs(*study.atlas, start, kRuns, random));
}

Json participant_view(const RoomParts& room, std::size_t seat, std::int64_t now_us) {
  return written(ParticipantPage{room, seat, now_us}.page());
}

Json full_view(const LiveStudy& study, const std::string& code, const Json& query, std::int64_t now_us) {
  LiveSeat nobody;
  nobody.last_page = "full";
  auto page = empty_page(study, "full", now_us);
  page.at<"me">() = {"Learner"};
  page.at<"end">() = end_of(study, "full", end_text(nobody, {}), study.group().completion.pay_full ? code : "", query);
  return written(page);
}

}  // namespace kith
