#include "kith/study/team_run.hpp"

#include <algorithm>
#include <string>

#include "kith/learners/run_period.hpp"
#include "kith/study/team_streams.hpp"

namespace kith {
namespace {

// One simulated person before a session: who they are and where their chance comes from.
struct Person {
  char type = 'N';
  std::vector<double> traits;
  RandomStream stream{0};
  std::size_t member = 0;  // 1-based
};

class TeamRun {
 public:
  TeamRun(const Atlas& atlas, TeachingCache& cache, const StudySpec& spec, const TeamAddress& address,
          TeamObserver* observer, std::function<bool()> stopped)
      : stopped_{std::move(stopped)},
        atlas_{atlas},
        cache_{cache},
        spec_{spec},
        observer_{observer},
        stream_{team_stream(spec, address)} {
    record_.address = address;
    record_.seed_address = readable_address(spec, address);
    options_ = spec.teaching;
    const bool everything = observer != nullptr || spec.record == RecordLevel::kParticles;
    const bool periods = everything || spec.record != RecordLevel::kTeam;
    options_.keep_members |= everything;
    options_.keep_rules |= periods;
    draw_people();
  }

  // Nothing if it was stopped.
  std::optional<TeamRecord> run() {
    record_.completed = true;
    if (record_.address.strategy == kBaseline) {
      for (const auto& person : people_) run_session({person}, lone_teacher_stream(person.stream), person.member);
    } else {
      run_session(people_, teacher_stream(stream_), 0);
    }
    if (was_stopped_) return std::nullopt;
    summarize();
    return std::move(record_);
  }

 private:
  void draw_people() {
    std::size_t member = 0;
    for (const char letter : record_.address.composition) {
      const auto stream = person_stream(stream_, ++member);
      people_.push_back({letter, draw_traits(learner_type(spec_, letter), stream), stream, member});
    }
  }

  void run_session(const std::vector<Person>& people, const RandomStream& teacher, std::size_t member) {
    std::vector<RandomStream> streams;
    Learners learners;
    for (const auto& person : people) {
      streams.push_back(belief_stream(person.stream));
      learners.push_back(make_learner(spec_, learner_type(spec_, person.type), person.traits, person.stream, cache_));
    }
    Session session{cache_, options_, strategy_of(spec_, record_.address.strategy), streams, teacher};
    std::vector<LearnerRecord> rows;
    rows.reserve(people.size());
    for (const auto& person : people) {
      rows.push_back({.member = person.member, .type = person.type, .traits = person.traits});
    }
    if (observer_ != nullptr) observer_->on_session(session, member);
    while (session.propose(cache_)) {
      was_stopped_ = was_stopped_ || (stopped_ && stopped_());
      if (was_stopped_) return;
      teach_period(session, learners, rows, member);
    }
    if (observer_ != nullptr) observer_->on_end(session, learners);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].periods = session.periods();
      rows[i].p_bec = learners[i]->mass_in(atlas_.policy_bec_half_spaces());
      record_.learners.push_back(rows[i]);
    }
    record_.periods += session.periods();
    record_.completed = record_.completed && session.status() == SessionStatus::kComplete;
    for (const auto status : session.components()) {
      record_.components_learned += status == ComponentStatus::kLearned ? 1u : 0u;
      record_.components_skipped += status == ComponentStatus::kSkipped ? 1u : 0u;
    }
  }

  void teach_period(Session& session, Learners& learners, std::vector<LearnerRecord>& rows, std::size_t member) {
    if (observer_ != nullptr) observer_->on_lesson(session, session.lesson(), learners);
    const auto period =
        run_period(session, cache_, learners,
                   {.own_counterfactuals = spec_.learner_counterfactuals_self ? spec_.teaching.counterfactuals : 0});
    const auto& [lesson, answers, feedback] = session.history().back();
    for (std::size_t i = 0; i < learners.size(); ++i) {
      rows[i].tests += lesson.tests.size();
      for (const auto& verdict : feedback.verdicts[i]) rows[i].correct += verdict.correct ? 1u : 0u;
    }
    add_up(lesson);
    if (spec_.record != RecordLevel::kTeam) {
      write_period(session, lesson, feedback, member);
      write_demonstrations(lesson, member);
      write_responses(lesson, answers, feedback, rows);
      write_progress(lesson, learners, period.abilities, feedback, rows);
    }
    if (spec_.record == RecordLevel::kParticles) write_beliefs(session, lesson.period, learners, rows);
    if (observer_ != nullptr) observer_->on_feedback(session, lesson, period.responses, feedback, learners);
  }

  void add_up(const Lesson& lesson) {
    record_.demonstrations += lesson.demonstrations.size();
    record_.tests += lesson.tests.size();
    area_sum_ += lesson.area_sr;
  }

  void write_period(const Session& session, const Lesson& lesson, const Feedback& feedback, std::size_t member) {
    std::vector<double> p_bec;
    for (const auto& rule : spec_.teaching.rules) {
      p_bec.push_back(session.belief().aggregate(rule.name).mass_in(atlas_.policy_bec_half_spaces()));
    }
    record_.period_records.push_back(
        {.period = lesson.period,
         .member = member,
         .component = lesson.component + 1,
         .source = source_name(lesson.source, member),
         .demonstrations = lesson.demonstrations.size(),
         .area_sr = lesson.area_sr,
         .running_area_sr = lesson.running_area_sr,
         .tests = lesson.tests.size(),
         .all_correct =
             std::all_of(feedback.all_correct.begin(), feedback.all_correct.end(), [](bool all) { return all; }),
         .excluded = feedback.excluded.size(),
         .untested = lesson.untested,
         .gain = lesson.gain,
         .p_bec = std::move(p_bec)});
  }

  void write_demonstrations(const Lesson& lesson, std::size_t member) {
    std::size_t number = 0;
    for (const auto& shown : lesson.demonstrations) {
      const auto id = atlas_.id(shown.demo);
      record_.demonstration_records.push_back({.period = lesson.period,
                                               .member = member,
                                               .component = lesson.component + 1,
                                               .demonstration = ++number,
                                               .mdp = id.mdp.value(),
                                               .start = id.start.value(),
                                               .constraints = shown.half_spaces});
    }
  }

  void write_responses(const Lesson& lesson, const std::vector<std::vector<Answer>>& answers, const Feedback& feedback,
                       const std::vector<LearnerRecord>& rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t t = 0; t < lesson.tests.size(); ++t) {
        const auto& verdict = feedback.verdicts[i][t];
        const auto id = atlas_.id(lesson.tests[t].demo);
        record_.responses.push_back({.period = lesson.period,
                                     .component = lesson.component + 1,
                                     .test = t + 1,
                                     .member = rows[i].member,
                                     .mdp = id.mdp.value(),
                                     .start = id.start.value(),
                                     .correct = verdict.correct,
                                     .regret = verdict.answered ? std::optional{verdict.regret} : std::nullopt,
                                     .answer = answers[i][t],
                                     .constraints = verdict.half_spaces,
                                     .covered = lesson.tests[t].covered});
      }
    }
  }

  void write_progress(const Lesson& lesson, const Learners& learners,
                      const std::vector<std::optional<double>>& abilities, const Feedback& feedback,
                      const std::vector<LearnerRecord>& rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      record_.progress.push_back({.period = lesson.period,
                                  .component = lesson.component + 1,
                                  .member = rows[i].member,
                                  .type = rows[i].type,
                                  .ability = abilities[i],
                                  .p_bec = learners[i]->mass_in(atlas_.policy_bec_half_spaces()),
                                  .all_correct = feedback.all_correct[i]});
    }
  }

  void write_beliefs(const Session& session, std::size_t period, const Learners& learners,
                     const std::vector<LearnerRecord>& rows) {
    const auto keep = [&](std::string name, const ParticleBelief& belief) {
      const auto weights = belief.weights();
      BeliefSnapshot snapshot{period, std::move(name), {}, {weights.begin(), weights.end()}};
      for (std::size_t k = 0; k < belief.dimension(); ++k) {
        const auto axis = belief.axis(k);
        snapshot.points.insert(snapshot.points.end(), axis.begin(), axis.end());
      }
      record_.beliefs.push_back(std::move(snapshot));
    };
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (const auto* own = learners[i]->belief()) keep("own " + std::to_string(rows[i].member), *own);
      keep("teacher " + std::to_string(rows[i].member), session.belief().member(i));
    }
    for (const auto& rule : spec_.teaching.rules) keep(std::string{rule.name}, session.belief().aggregate(rule.name));
  }

  // In the baseline the only member's seat is 0, whoever sits there.
  [[nodiscard]] static std::string source_name(const SourceBelief& source, std::size_t alone) {
    if (!source.is_member()) return source.rule;
    return "member " + std::to_string(alone != 0 ? alone : source.member + 1);
  }

  void summarize() {
    // Summed in the order of size, so that seats do not matter to the last bit.
    std::vector<double> masses;
    for (const auto& row : record_.learners) masses.push_back(row.p_bec);
    std::sort(masses.begin(), masses.end());
    double sum = 0.0;
    for (const double mass : masses) sum += mass;
    record_.knowledge = sum / static_cast<double>(masses.size());
    record_.knowledge_min = masses.front();
    record_.area_sr = record_.periods > 0 ? area_sum_ / static_cast<double>(record_.periods) : 0.0;
  }

  std::function<bool()> stopped_;
  bool was_stopped_ = false;
  const Atlas& atlas_;
  TeachingCache& cache_;
  const StudySpec& spec_;
  TeamObserver* observer_;
  RandomStream stream_;
  TeachingOptions options_;
  std::vector<Person> people_;
  TeamRecord record_;
  double area_sum_ = 0.0;
};

}  // namespace

TeamRecord run_team(const Atlas& atlas, TeachingCache& cache, const StudySpec& spec, const TeamAddress& address,
                    TeamObserver* observer) {
  cache.trim();
  return TeamRun{atlas, cache, spec, address, observer, {}}.run().value();
}

std::optional<TeamRecord> run_team_unless(const std::function<bool()>& stopped, const Atlas& atlas,
                                          TeachingCache& cache, const StudySpec& spec, const TeamAddress& address) {
  cache.trim();
  return TeamRun{atlas, cache, spec, address, nullptr, stopped}.run();
}

}  // namespace kith
