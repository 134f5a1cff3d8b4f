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
#include "message_json.hpp"
#include "room_view.hpp"
#include "session_summary.hpp"

namespace kith {
namespace {

std::vector<std::vector<double>> outline_of(const Cone& cone) {
  std::vector<std::vector<double>> corners;
  for (const auto& corner : outline(cone)) corners.push_back({corner.x(), corner.y(), corner.z()});
  return corners;
}

std::vector<std::string> plain_sentences(const Domain& domain, std::span<const HalfSpace> half_spaces) {
  std::vector<std::string> list;
  for (const auto& text : all_in_words(domain, half_spaces)) list.push_back(sentence(text));
  return list;
}

class RoomDetailPage {
 public:
  explicit RoomDetailPage(const RoomParts& room)
      : room_{room}, state_{room.state}, atlas_{*room.study.atlas}, domain_{atlas_.domain()} {}

  [[nodiscard]] view::RoomDetail detail() const {
    view::RoomDetail detail;
    detail.at<"id">() = room_.setup.id;
    detail.at<"session">() = session();
    if (const auto* lesson = current_lesson()) detail.at<"lesson">() = lesson_view(*lesson);
    detail.at<"answers">() = answers();
    detail.at<"curves">() = curves();
    for (auto& [name, points] : belief_points(room_))
      detail.at<"beliefs">().push_back({std::move(name), std::move(points)});
    detail.at<"truth">() = truth();
    detail.at<"timers">() = timers();
    return detail;
  }

 private:
  [[nodiscard]] view::SessionNow session() const {
    view::SessionNow now{{}, {}, std::string{rules_of(state_.phase).word}};
    const auto all = components_of(state_);
    for (std::size_t i = 0; i < all.size(); ++i) {
      constexpr std::array kWords{"open", "learned", "skipped"};
      now.at<"components">().push_back({component_in_words(atlas_, i), kWords[static_cast<std::size_t>(all[i])]});
    }
    if (const auto* lesson = current_lesson()) now.at<"component">() = lesson->component + 1;
    return now;
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

  [[nodiscard]] view::LessonNow lesson_view(const Lesson& lesson) const {
    view::LessonNow now{lesson.source.rule, why(lesson), {}, {}, {}};
    if (lesson.source.is_member()) now.at<"source">() = "member " + std::to_string(lesson.source.member + 1);
    const auto shown = [&](StartIndex start, std::optional<double> gain, std::span<const HalfSpace> half_spaces) {
      return view::ShownBoard{live_board(room_.study, start), robot_path(room_.study, start), gain,
                              plain_sentences(domain_, half_spaces)};
    };
    for (const auto& one : lesson.demonstrations)
      now.at<"demonstrations">().push_back(shown(one.start, one.gain, one.half_spaces));
    for (const auto& test : lesson.tests) now.at<"tests">().push_back(shown(test.start, std::nullopt, test.covered));
    if (state_.runners_up && rules_of(state_.phase).has_open_lesson) {
      for (const auto& other : *state_.runners_up) {
        now.at<"runners_up">().push_back(
            {live_board(room_.study, other.start), other.gain, plain_sentences(domain_, other.half_spaces)});
      }
    }
    return now;
  }

  [[nodiscard]] std::vector<view::GivenAnswer> answers() const {
    std::vector<view::GivenAnswer> list;
    for (const auto& answer : state_.answers) {
      const bool was_discussed = answer.right_in_the_end.has_value();
      list.push_back({answer.seat + 1, answer.period, answer.test, answer.right,
                      in_file_units(domain_.weights(), answer.regret), answer.ms, answer.stopped_short,
                      was_discussed ? std::optional{answer.changed} : std::nullopt, answer.right_in_the_end});
    }
    return list;
  }

  [[nodiscard]] std::vector<view::CurvePoint> curves() const {
    std::vector<view::CurvePoint> list;
    for (const auto& point : state_.curves) {
      Json p_bec = Json::object(), right = Json::object();
      for (const auto& [name, mass] : point.p_bec) p_bec[name] = mass;
      for (const auto& [seat, share] : point.right) right[std::to_string(seat + 1)] = share;
      list.push_back({point.period, std::move(p_bec), std::move(right)});
    }
    return list;
  }

  [[nodiscard]] view::Truth truth() const {
    const auto& unit = domain_.weights().unit;
    view::Truth truth{{unit.begin(), unit.end()}, domain_.feature_names(), {}, {}};
    if (domain_.num_features() != 3) return truth;
    Cone bec = atlas_.prior_cone();
    if (bec.clip(atlas_.policy_bec_half_spaces())) truth.at<"bec">() = outline_of(bec);
    truth.at<"prior">() = outline_of(atlas_.prior_cone());
    return truth;
  }

  [[nodiscard]] std::vector<view::Timer> timers() const {
    std::vector<view::Timer> list;
    const auto add = [&](const char* name, std::int64_t since_us, const std::optional<std::int64_t>& until_us) {
      list.push_back({name, in_ms(since_us), until_us ? std::optional{in_ms(*until_us)} : std::nullopt});
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

Json detail_json(const RoomParts& room) { return written(RoomDetailPage{room}.detail()); }

}  // namespace kith
