#include "kith/study/transcript.hpp"

#include "kith/mdp/planner.hpp"
#include "kith/study/session_forecasts.hpp"

namespace kith {
namespace {

class Recorder : public TeamObserver {
 public:
  Recorder(const Atlas& atlas, std::vector<TranscriptSession>& sessions) : atlas_{atlas}, sessions_{sessions} {}

  void on_session(const Session&, std::span<const std::size_t> members) override {
    sessions_.emplace_back().members.assign(members.begin(), members.end());
  }

  void on_lesson(const Session& session, const Lesson& lesson, const Learners& learners) override {
    auto& period = sessions_.back().periods.emplace_back();
    period.lesson = lesson;
    period.before = state_of(session, lesson, learners);
  }

  void on_feedback(const Session& session, const Lesson& lesson, const std::vector<Learner::Response>& responses,
                   const Feedback& feedback, const Learners& learners) override {
    auto& period = sessions_.back().periods.back();
    period.responses = responses;
    period.feedback = feedback;
    period.revised = session.history().back().revised;
    period.after = state_of(session, lesson, learners);
  }

  void on_end(const Session& session, const Learners&) override {
    sessions_.back().status = session.status();
    sessions_.back().components.assign(session.components().begin(), session.components().end());
  }

 private:
  [[nodiscard]] BeliefFigures figures(std::string whose, const ParticleBelief& belief, const Lesson& lesson) const {
    return {std::move(whose), belief.mass_in(atlas_.policy_bec_half_spaces()), belief.mass_in(lesson.taught),
            belief.effective_sample_size()};
  }

  [[nodiscard]] BeliefFigures figures(std::string whose, const Learner& learner, const Lesson& lesson) const {
    if (const auto* belief = learner.belief()) return figures(std::move(whose), *belief, lesson);
    return {std::move(whose), learner.mass_in(atlas_.policy_bec_half_spaces()), learner.mass_in(lesson.taught)};
  }

  [[nodiscard]] BeliefState state_of(const Session& session, const Lesson& lesson, const Learners& learners) const {
    BeliefState state;
    const auto& members = sessions_.back().members;
    for (std::size_t i = 0; i < learners.size(); ++i) {
      const auto name = "member " + std::to_string(members[i]);
      state.own.push_back(figures(name, *learners[i], lesson));
      state.teacher.push_back(figures(name, session.belief().member(i), lesson));
      state.abilities.push_back(learners[i]->ability());
    }
    if (learners.size() > 1) {
      for (const auto& rule : session.belief().options().rules) {
        state.teacher.push_back(figures(std::string{rule.name}, session.belief().aggregate(rule.name), lesson));
      }
    }
    return state;
  }

  const Atlas& atlas_;
  std::vector<TranscriptSession>& sessions_;
};

}  // namespace

Transcript transcribe(const Atlas& atlas, const StudySpec& spec, const TeamAddress& address) {
  Transcript transcript{spec, address, {}, {}, {}};
  TeachingCache cache{atlas};
  Recorder recorder{atlas, transcript.sessions};
  SessionForecasts forecasts;
  transcript.record = run_team(atlas, cache, spec, address, &recorder, &forecasts);
  if (spec.forecast_sessions > 0) transcript.imagined = forecasts.like(atlas, cache, spec, address);
  std::size_t number = 0;
  for (auto& session : transcript.sessions) {
    for (auto& period : session.periods) {
      if (number < transcript.record.period_records.size())
        period.forecast = transcript.record.period_records[number].forecast;
      ++number;
    }
  }
  return transcript;
}

std::optional<Trajectory> path_of_answer(const Atlas& atlas, StartIndex test, const IntegerVector& counts,
                                         const Direction& weights) {
  if (counts == atlas.feature_counts(test)) return atlas.trajectory(test);
  return Behaviours{atlas}.trajectory(test, weights);
}

}  // namespace kith
