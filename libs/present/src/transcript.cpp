#include "kith/present/transcript.hpp"

#include <array>

#include "kith/mdp/planner.hpp"

namespace kith {
namespace {

class Recorder : public TeamObserver {
 public:
  Recorder(const Atlas& atlas, std::size_t team_size, std::vector<TranscriptSession>& sessions)
      : atlas_{atlas}, team_size_{team_size}, sessions_{sessions} {}

  void on_session(const Session&, std::size_t member) override {
    auto& session = sessions_.emplace_back();
    for (std::size_t i = 1; i <= (member == 0 ? team_size_ : 1); ++i)
      session.members.push_back(member == 0 ? i : member);
  }

  void on_lesson(const Session& session, const Lesson& lesson, const std::vector<SimulatedLearner>& learners) override {
    auto& period = sessions_.back().periods.emplace_back();
    period.lesson = lesson;
    period.before = state_of(session, lesson, learners);
  }

  void on_feedback(const Session& session, const Lesson& lesson,
                   const std::vector<SimulatedLearner::Response>& responses, const Feedback& feedback,
                   const std::vector<SimulatedLearner>& learners) override {
    auto& period = sessions_.back().periods.back();
    period.responses = responses;
    period.feedback = feedback;
    period.after = state_of(session, lesson, learners);
  }

  void on_end(const Session& session, const std::vector<SimulatedLearner>&) override {
    sessions_.back().status = session.status();
    sessions_.back().components.assign(session.components().begin(), session.components().end());
  }

 private:
  [[nodiscard]] BeliefFigures figures(std::string whose, const ParticleBelief& belief, const Lesson& lesson) const {
    return {std::move(whose), belief.mass_in(atlas_.policy_bec_half_spaces()), belief.mass_in(lesson.taught),
            belief.effective_sample_size()};
  }

  [[nodiscard]] BeliefState state_of(const Session& session, const Lesson& lesson,
                                     const std::vector<SimulatedLearner>& learners) const {
    BeliefState state;
    const auto& members = sessions_.back().members;
    for (std::size_t i = 0; i < learners.size(); ++i) {
      const auto name = "member " + std::to_string(members[i]);
      state.own.push_back(figures(name, learners[i].belief(), lesson));
      state.teacher.push_back(figures(name, session.belief().member(i), lesson));
      state.abilities.push_back(learners[i].ability());
    }
    if (learners.size() > 1) {
      for (const auto& rule : session.belief().options().rules) {
        state.teacher.push_back(figures(std::string{rule.name}, session.belief().aggregate(rule.name), lesson));
      }
    }
    return state;
  }

  const Atlas& atlas_;
  std::size_t team_size_;
  std::vector<TranscriptSession>& sessions_;
};

}  // namespace

Transcript transcribe(const Atlas& atlas, const StudySpec& spec, const TeamAddress& address) {
  Transcript transcript{spec, address, {}, {}};
  TeachingCache cache{atlas};
  Recorder recorder{atlas, address.composition.size(), transcript.sessions};
  transcript.record = run_team(atlas, cache, spec, address, &recorder);
  return transcript;
}

std::optional<Trajectory> path_of_answer(const Atlas& atlas, DemoIndex test, const IntegerVector& counts,
                                         const Direction& weights) {
  if (counts == atlas.feature_counts(test)) return atlas.trajectory(test);
  return Behaviours{atlas}.trajectory(test, weights);
}

}  // namespace kith
