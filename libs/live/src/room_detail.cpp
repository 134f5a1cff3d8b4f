#include <algorithm>
#include <array>
#include <cmath>

#include "kith/domains/file_units.hpp"
#include "kith/explain/board_json.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/explain/misconception.hpp"
#include "kith/explain/words.hpp"
#include "kith/geometry/outline.hpp"
#include "live_texts.hpp"
#include "room_view.hpp"
#include "session_summary.hpp"

namespace kith {
namespace {

Json outline_json(const Cone& cone) {
  Json corners = Json::array();
  for (const auto& corner : outline(cone)) corners.push_back({corner.x(), corner.y(), corner.z()});
  return corners;
}

Json plain_sentences(const Domain& domain, std::span<const HalfSpace> half_spaces) {
  Json list = Json::array();
  for (const auto& text : all_in_words(domain, half_spaces)) list.push_back(sentence(text));
  return list;
}

class RoomDetailPage {
 public:
  explicit RoomDetailPage(const RoomParts& room)
      : room_{room}, state_{room.state}, atlas_{*room.study.atlas}, domain_{atlas_.domain()} {}

  [[nodiscard]] Json json() const {
    Json detail{{"id", room_.setup.id}, {"session", session()}};
    if (const auto* lesson = current_lesson()) detail["lesson"] = lesson_json(*lesson);
    detail["answers"] = answers();
    detail["curves"] = curves();
    detail["beliefs"] = beliefs();
    detail["truth"] = truth();
    detail["timers"] = timers();
    return detail;
  }

 private:
  [[nodiscard]] Json session() const {
    Json components = Json::array();
    const auto all = components_of(state_);
    for (std::size_t i = 0; i < all.size(); ++i) {
      constexpr std::array kWords{"open", "learned", "skipped"};
      components.push_back(
          {{"name", component_in_words(atlas_, i)}, {"status", kWords[static_cast<std::size_t>(all[i])]}});
    }
    const auto* lesson = current_lesson();
    return {{"period", num_periods(state_)},
            {"component", lesson != nullptr ? Json(lesson->component + 1) : Json{}},
            {"components", components},
            {"phase", rules_of(state_.phase).word}};
  }

  // The one that people see; while they read the feedback that of the period behind them.
  [[nodiscard]] const Lesson* current_lesson() const {
    return rules_of(state_.phase).has_open_lesson ? &state_.session->lesson() : last_lesson(state_);
  }

  [[nodiscard]] std::string why(const Lesson& lesson) const {
    if (lesson.repeats) return "No demonstration would add anything, so the previous lesson is shown again.";
    std::string text;
    if (lesson.source.is_everybody()) {
      text = "Chosen for everybody: for what the teacher believes about each member.";
    } else if (lesson.source.is_member()) {
      text = "Chosen for what the teacher believes about " + member_label(lesson.source.member) + ".";
    } else if (lesson.source.rule == "common") {
      text = "Chosen for the common belief: what all members know.";
    } else if (lesson.source.rule == "joint") {
      text = "Chosen for the joint belief: what at least one member knows.";
    } else {
      text = "Chosen for the belief '" + lesson.source.rule + "'.";
    }
    if (!lesson.demonstrations.empty() && lesson.demonstrations.front().gain > 1.0) {
      const double share = 1.0 - 1.0 / lesson.demonstrations.front().gain;
      text += " The first demonstration rules out " + std::to_string(std::lround(100.0 * share)) +
              " % of the rewards that are consistent with the earlier lessons.";
    }
    return text;
  }

  [[nodiscard]] Json lesson_json(const Lesson& lesson) const {
    const auto shown = [&](StartIndex demo) {
      Json entry{{"board", live_board(room_.study, demo)}};
      entry.update(robot_path(room_.study, demo));
      return entry;
    };
    Json demonstrations = Json::array(), tests = Json::array(), others = Json::array();
    for (const auto& one : lesson.demonstrations) {
      auto entry = shown(one.demo);
      entry["gain"] = one.gain;
      entry["sentences"] = plain_sentences(domain_, one.half_spaces);
      demonstrations.push_back(std::move(entry));
    }
    for (const auto& test : lesson.tests) {
      auto entry = shown(test.demo);
      entry["sentences"] = plain_sentences(domain_, test.covered);
      tests.push_back(std::move(entry));
    }
    if (state_.runners_up && rules_of(state_.phase).has_open_lesson) {
      for (const auto& other : *state_.runners_up) {
        others.push_back({{"board", live_board(room_.study, other.demo)},
                          {"gain", other.gain},
                          {"sentences", plain_sentences(domain_, other.half_spaces)}});
      }
    }
    const auto source =
        lesson.source.is_member() ? "member " + std::to_string(lesson.source.member + 1) : lesson.source.rule;
    return {{"source", source},
            {"why", why(lesson)},
            {"demonstrations", demonstrations},
            {"tests", tests},
            {"runners_up", others}};
  }

  [[nodiscard]] Json answers() const {
    Json list = Json::array();
    for (const auto& answer : state_.answers) {
      list.push_back({{"seat", answer.seat + 1},
                      {"period", answer.period},
                      {"test", answer.test},
                      {"right", answer.right},
                      {"regret", in_file_units(domain_.weights(), answer.regret)},
                      {"ms", answer.ms},
                      {"stopped_short", answer.stopped_short}});
      if (!answer.right_in_the_end) continue;
      list.back()["changed"] = answer.changed;
      list.back()["right_in_the_end"] = *answer.right_in_the_end;
    }
    return list;
  }

  [[nodiscard]] Json curves() const {
    Json list = Json::array();
    for (const auto& point : state_.curves) {
      Json p_bec = Json::object(), right = Json::object();
      for (const auto& [name, mass] : point.p_bec) p_bec[name] = mass;
      for (const auto& [seat, share] : point.right) right[std::to_string(seat + 1)] = share;
      list.push_back({{"period", point.period}, {"p_bec", p_bec}, {"right", right}});
    }
    return list;
  }

  [[nodiscard]] Json beliefs() const {
    Json list = Json::array();
    for (auto& [name, points] : belief_points(room_)) {
      list.push_back({{"name", std::move(name)}, {"points", std::move(points)}});
    }
    return list;
  }

  [[nodiscard]] Json truth() const {
    Json truth{{"weights", Json::array()},
               {"features", domain_.feature_names()},
               {"bec", Json::array()},
               {"prior", Json::array()}};
    for (const double weight : domain_.weights().unit) truth["weights"].push_back(weight);
    if (domain_.num_features() != 3) return truth;
    Cone bec = atlas_.prior_cone();
    if (bec.clip(atlas_.policy_bec_half_spaces())) truth["bec"] = outline_json(bec);
    truth["prior"] = outline_json(atlas_.prior_cone());
    return truth;
  }

  [[nodiscard]] Json timers() const {
    Json list = Json::array();
    const auto add = [&](const char* name, std::int64_t since_us, const std::optional<std::int64_t>& until_us) {
      Json timer{{"name", name}, {"since_ms", in_ms(since_us)}};
      if (until_us) timer["until_ms"] = in_ms(*until_us);
      list.push_back(std::move(timer));
    };
    if (state_.phase == RoomPhase::kLobby) {
      const auto limit = room_.study.group().time.lobby_s;
      if (state_.lobby_us) {
        add("lobby", *state_.lobby_us,
            limit > 0 && room_.study.group().auto_start ? std::optional{*state_.lobby_us + limit * kSecond}
                                                        : std::nullopt);
      }
      return list;
    }
    if (is_running(state_)) add("phase", state_.phase_us, state_.deadline_us);
    if (state_.started_us && is_running(state_)) add("session", *state_.started_us, state_.session_deadline_us);
    if (state_.paused_us) add("pause", *state_.paused_us, std::nullopt);
    return list;
  }

  const RoomParts& room_;
  const Room::State& state_;
  const Atlas& atlas_;
  const Domain& domain_;
};

}  // namespace

Json detail_json(const RoomParts& room) { return RoomDetailPage{room}.json(); }

}  // namespace kith
