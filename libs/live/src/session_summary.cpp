#include "session_summary.hpp"

#include <algorithm>
#include <cmath>

#include "kith/explain/words.hpp"
#include "kith/files/base64.hpp"
#include "kith/live/teaching_task.hpp"
#include "live_texts.hpp"

namespace kith {
namespace {

constexpr std::size_t kNumPoints = 300;

// Points drawn evenly by weight, always the same ones.
std::string points_text(const ParticleBelief& belief) {
  std::string bytes;
  for (const auto& draw : belief.systematic_draws(kNumPoints, RandomStream{0})) {
    for (std::size_t repeat = 0; repeat < draw.count; ++repeat) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto value = static_cast<std::int16_t>(std::lround(belief.axis(k)[draw.index] * 32767.0));
        const auto bits = static_cast<std::uint16_t>(value);
        bytes += static_cast<char>(bits & 255u);
        bytes += static_cast<char>(bits >> 8u);
      }
    }
  }
  return base64(bytes);
}

}  // namespace

const std::string& strategy_name(const Room::State& state) {
  return state.summary ? state.summary->strategy : state.session->strategy().name;
}

std::size_t num_periods(const Room::State& state) {
  return state.summary ? state.summary->periods : state.session->periods();
}

std::size_t current_period(const Room::State& state) {
  return num_periods(state) + (is_running(state) && state.phase != RoomPhase::kFeedback ? 1u : 0u);
}

std::span<const ComponentStatus> components_of(const Room::State& state) {
  return state.summary ? std::span<const ComponentStatus>{state.summary->components} : state.session->components();
}

const Lesson* last_lesson(const Room::State& state) {
  if (state.summary) return state.summary->last_lesson ? &*state.summary->last_lesson : nullptr;
  const auto& history = state.session->history();
  return history.empty() ? nullptr : &history.back().lesson;
}

std::vector<HalfSpace> taught_so_far(const Room::State& state) {
  if (state.summary) return state.summary->taught;
  std::vector<HalfSpace> taught;
  for (const auto& past : state.session->history()) {
    taught.insert(taught.end(), past.lesson.taught.begin(), past.lesson.taught.end());
  }
  return taught;
}

RobotInWords robot_in_words(const RoomParts& room) {
  if (room.state.summary) return room.state.summary->robot;
  const auto& atlas = *room.study.atlas;
  const auto& components = atlas.knowledge_components();
  std::vector<bool> is_taught(components.size(), false);
  for (const auto& past : room.state.session->history()) is_taught[past.lesson.component] = true;
  RobotInWords words;
  std::vector<std::string> said;
  Cone known = atlas.prior_cone();  // to whoever has learned what was taught
  for (const bool taught : {true, false}) {
    std::vector<HalfSpace> constraints;
    for (std::size_t k = 0; k < components.size(); ++k) {
      if (is_taught[k] != taught) continue;
      const auto own = atlas.constraints().half_spaces(components[k].constraints.without(atlas.prior()));
      if (taught) static_cast<void>(known.clip(own));
      for (const auto& one : own) {
        if (taught || !known.implies(one)) constraints.push_back(one);
      }
    }
    for (auto& text : all_in_words(atlas.domain(), constraints)) {
      if (std::find(said.begin(), said.end(), text) != said.end()) continue;
      (taught ? words.taught : words.not_reached).push_back(sentence(text));
      said.push_back(std::move(text));
    }
  }
  return words;
}

std::vector<std::pair<std::string, std::string>> belief_points(const RoomParts& room) {
  if (room.state.summary) return room.state.summary->beliefs;
  std::vector<std::pair<std::string, std::string>> points;
  if (room.study.atlas->domain().num_features() != 3 || room.setup.is_waiting_list) return points;
  const auto& session = *room.state.session;
  for (std::size_t m = 0; m < session.num_members(); ++m) {
    points.emplace_back("member " + std::to_string(m + 1), points_text(session.belief().member(m)));
  }
  for (const auto& rule : session.options().rules) {
    points.emplace_back(rule.name, points_text(session.belief().aggregate(rule.name)));
  }
  return points;
}

Room::State released_state(const RoomParts& room) {
  auto state = room.state;
  SessionSummary summary;
  const auto components = components_of(state);
  summary.strategy = strategy_name(state);
  summary.periods = num_periods(state);
  summary.components.assign(components.begin(), components.end());
  if (const auto* lesson = last_lesson(state)) summary.last_lesson = *lesson;
  summary.taught = taught_so_far(state);
  summary.robot = robot_in_words(room);
  summary.beliefs = belief_points(room);
  summary.digest = digest_of(*state.session);
  if (state.before) summary.digest_before = digest_of(*state.before);
  for (auto& member : state.members) {
    summary.has_learner.push_back(member.learner != nullptr);
    member.learner.reset();
  }
  state.summary = std::make_shared<const SessionSummary>(std::move(summary));
  state.session.reset();
  state.before.reset();
  state.members_before.clear();
  state.runners_up.reset();
  return state;
}

}  // namespace kith
