#include "kith/study/team_run.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include "kith/learners/run_period.hpp"
#include "kith/study/session_forecasts.hpp"
#include "kith/study/team_streams.hpp"
#include "team_estimates.hpp"
#include "team_exam.hpp"

namespace kith {
namespace {

// One simulated person before a session: who they are and where their chance comes from.
struct Person {
  char type = 'N';
  std::vector<double> traits;
  RandomStream stream{0};
  std::size_t member = 0;  // 1-based
};

// Who takes part in a period: seats of the session.
using Present = std::vector<std::size_t>;

class TeamRun {
 public:
  TeamRun(const Atlas& atlas, TeachingCache& cache, const StudySpec& spec, const TeamAddress& address,
          TeamObserver* observer, std::function<bool()> stopped, SessionForecasts* forecasts)
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
    options_.keep_bank |= spec.estimates;
    draw_people();
    if (forecasts == nullptr || spec.forecast_sessions == 0) return;
    like_ = &forecasts->like(atlas, cache, spec, address);
    record_.forecast = forecast_of(forecast_remaining(*like_, {}));
  }

  // Nothing if it was stopped.
  std::optional<TeamRecord> run() {
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
      const auto& type = type_of_person(spec_, letter, stream);
      people_.push_back({type.letter, draw_traits(type, stream), stream, member});
    }
  }

  void run_session(const std::vector<Person>& people, const RandomStream& teacher, std::size_t member) {
    if (was_stopped_) return;
    ++session_;
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
    if (observer_ != nullptr) {
      std::vector<std::size_t> members;
      for (const auto& person : people) members.push_back(person.member);
      observer_->on_session(session, members);
    }
    const auto propose = [&] {
      if (!session.strategy().kind.needs_truth) return session.propose(cache_);
      return session.propose(cache_, truth_about(session, learners));
    };
    TeamExaminer exam{cache_, spec_, record_};
    exam.at_start(learners, rows);
    TeamEstimates estimates{cache_, spec_, record_};
    estimates.at_start(session, learners, rows);
    while (propose()) {
      was_stopped_ = was_stopped_ || (stopped_ && stopped_());
      if (was_stopped_) return;
      teach_period(session, learners, rows, member);
      exam.after_period(session.periods(), learners, rows);
      estimates.after_period(session, learners, rows);
    }
    exam.at_end(session, learners, rows, member);
    estimates.at_end(session, learners, rows);
    if (observer_ != nullptr) observer_->on_end(session, learners);
    if (spec_.beliefs) note_support(learners);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].p_bec = learners[i]->mass_in(atlas_.policy_bec_half_spaces());
      record_.learners.push_back(rows[i]);
    }
    record_.periods += session.periods();
    record_.status = std::max(record_.status, session.status());
    for (const auto status : session.components()) {
      record_.components_learned += status == ComponentStatus::kLearned ? 1u : 0u;
      record_.components_skipped += status == ComponentStatus::kSkipped ? 1u : 0u;
    }
  }

  void note_support(const Learners& learners) {
    auto& fewest = record_.fewest_particles;
    for (const auto& learner : learners) {
      if (learner->belief() == nullptr) continue;
      const double own = learner->belief()->least_support();
      fewest = std::min(fewest.value_or(own), own);
    }
  }

  void teach_period(Session& session, Learners& learners, std::vector<LearnerRecord>& rows, std::size_t member) {
    if (observer_ != nullptr) observer_->on_lesson(session, session.lesson(), learners);
    Present present;
    for (std::size_t i = 0; i < learners.size(); ++i) {
      if (session.takes_part(i)) present.push_back(i);
    }
    std::vector<RandomStream> talk;
    for (const auto& row : rows) talk.push_back(people_[row.member - 1].stream);
    const auto period =
        run_period(session, cache_, learners,
                   {.own_counterfactuals = spec_.learner_counterfactuals_self ? spec_.teaching.counterfactuals : 0,
                    .discussion = spec_.group.discussion.choice,
                    .talk = talk});
    const auto& past = session.history().back();
    const auto& [lesson, answers, feedback] = std::tie(past.lesson, past.answers, past.feedback);
    for (const auto i : present) {
      ++rows[i].periods;
      rows[i].tests += lesson.tests.size();
      for (const auto& verdict : feedback.verdicts[i]) rows[i].correct += verdict.correct ? 1u : 0u;
    }
    add_up(past, present.size());
    if (spec_.record != RecordLevel::kTeam) {
      write_period(session, lesson, feedback, rows, present, member);
      record_.period_records.back().mastery = mastery_after(cache_, spec_, session, learners, present);
      write_demonstrations(lesson, rows, present);
      write_responses(lesson, answers, feedback, rows, present);
      write_discussion(past, rows, present);
      write_progress(lesson, learners, period.abilities, feedback, rows, present);
    }
    if (spec_.record == RecordLevel::kParticles) write_beliefs(session, lesson.period, learners, rows);
    if (observer_ != nullptr) observer_->on_feedback(session, lesson, period.responses, feedback, learners);
  }

  void add_up(const PastPeriod& past, std::size_t members) {
    const auto& lesson = past.lesson;
    record_.demonstrations += lesson.demonstrations.size();
    record_.tests += lesson.tests.size();
    const double minutes = minutes_of(spec_.teaching.pace, past);
    record_.cost.person_periods += members;
    record_.cost.minutes += minutes;
    record_.cost.person_minutes += minutes * static_cast<double>(members);
    area_sum_ += lesson.area_sr;
  }

  void write_period(const Session& session, const Lesson& lesson, const Feedback& feedback,
                    const std::vector<LearnerRecord>& rows, const Present& present, std::size_t member) {
    std::vector<double> p_bec;
    for (const auto& rule : spec_.teaching.rules) {
      p_bec.push_back(session.belief().aggregate(rule.name).mass_in(atlas_.policy_bec_half_spaces()));
    }
    record_.period_records.push_back(
        {.period = lesson.period,
         .member = member,
         .session = session_,
         .members = present.size(),
         .component = lesson.component + 1,
         .source = source_name(lesson.source, rows),
         .demonstrations = lesson.demonstrations.size(),
         .area_sr = lesson.area_sr,
         .running_area_sr = lesson.running_area_sr,
         .tests = lesson.tests.size(),
         .all_correct =
             std::all_of(present.begin(), present.end(), [&](auto i) -> bool { return feedback.all_correct[i]; }),
         .excluded = feedback.excluded.size(),
         .untested = lesson.untested,
         .tests_demonstrated = lesson.tests_demonstrated,
         .gain = lesson.gain,
         .forecast = what_is_left(session),
         .p_bec = std::move(p_bec)});
  }

  // As expected after the last period; sessions that follow count, too.
  [[nodiscard]] std::optional<PeriodForecast> what_is_left(const Session& session) const {
    if (like_ == nullptr) return std::nullopt;
    const auto& last = session.history().back();
    const auto component = last.lesson.component;
    SessionPlace place{.stage = (session_ - 1) * session.components().size() + component, .periods = 0};
    if (last.feedback.component_learned) {
      ++place.stage;
    } else {
      place.periods = static_cast<std::size_t>(
          std::count_if(session.history().begin(), session.history().end(),
                        [&](const PastPeriod& period) { return period.lesson.component == component; }));
    }
    const auto left = forecast_remaining(*like_, place);
    return PeriodForecast{.periods_left = left.mean_periods(),
                          .done_within = {left.done_within(1), left.done_within(2), left.done_within(3)}};
  }

  // Once for the whole team, or for everybody who watched.
  void write_demonstrations(const Lesson& lesson, const std::vector<LearnerRecord>& rows, const Present& present) {
    std::vector<std::size_t> watched;
    const bool everybody = present.size() == people_.size() && record_.address.strategy != kBaseline;
    for (const auto i : present) watched.push_back(rows[i].member);
    if (everybody) watched = {0};
    std::size_t number = 0;
    for (const auto& shown : lesson.demonstrations) {
      const auto id = atlas_.id(shown.start);
      ++number;
      for (const auto member : watched) {
        record_.demonstration_records.push_back({.period = lesson.period,
                                                 .member = member,
                                                 .component = lesson.component + 1,
                                                 .demonstration = number,
                                                 .mdp = id.mdp.value(),
                                                 .start = id.start.value(),
                                                 .constraints = shown.half_spaces});
      }
    }
  }

  void write_responses(const Lesson& lesson, const std::vector<std::vector<Answer>>& answers, const Feedback& feedback,
                       const std::vector<LearnerRecord>& rows, const Present& present) {
    for (const auto i : present) {
      write_answers(answer_record(lesson.period, lesson.component + 1, rows[i]), lesson.tests, answers[i],
                    feedback.verdicts[i]);
    }
  }

  // What all answers of a member in a period have in common.
  [[nodiscard]] static ResponseRecord answer_record(std::size_t period, std::size_t component,
                                                    const LearnerRecord& row) {
    ResponseRecord record;
    record.period = period;
    record.component = component;
    record.member = row.member;
    return record;
  }

  // What one member answered. @param record  with what all answers have in common.
  void write_answers(ResponseRecord record, std::span<const Test> tests, const std::vector<Answer>& answers,
                     const std::vector<Verdict>& verdicts) {
    for (std::size_t t = 0; t < tests.size(); ++t) {
      const auto id = atlas_.id(tests[t].start);
      record.test = t + 1;
      record.mdp = id.mdp.value();
      record.start = id.start.value();
      record.correct = verdicts[t].correct;
      record.regret = verdicts[t].answered ? std::optional{verdicts[t].regret} : std::nullopt;
      record.answer = answers[t];
      record.constraints = verdicts[t].half_spaces;
      record.covered = tests[t].covered;
      record_.responses.push_back(record);
    }
  }

  void write_discussion(const PastPeriod& past, const std::vector<LearnerRecord>& rows, const Present& present) {
    if (past.revised.empty()) return;
    for (const auto i : present) {
      const auto& revised = past.revised[i].empty() ? past.answers[i] : past.revised[i];
      for (std::size_t t = 0; t < past.lesson.tests.size(); ++t) {
        record_.discussions.push_back({.period = past.lesson.period,
                                       .component = past.lesson.component + 1,
                                       .test = t + 1,
                                       .member = rows[i].member,
                                       .first = past.answers[i][t],
                                       .first_correct = past.feedback.verdicts[i][t].correct,
                                       .revised = revised[t],
                                       .revised_correct = past.feedback.final_verdicts(i)[t].correct});
      }
    }
  }

  void write_progress(const Lesson& lesson, const Learners& learners,
                      const std::vector<std::optional<double>>& abilities, const Feedback& feedback,
                      const std::vector<LearnerRecord>& rows, const Present& present) {
    for (const auto i : present) {
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

  // Seats are those of the session, members those of the team.
  [[nodiscard]] static std::string source_name(const SourceBelief& source, const std::vector<LearnerRecord>& rows) {
    if (!source.is_member()) return source.rule;
    return "member " + std::to_string(rows[source.member].member);
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
    summarize_exam(record_, spec_);
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
  std::size_t session_ = 0;                         // of the team, from 1
  const std::vector<PastSession>* like_ = nullptr;  // sessions of the same cell, for forecasts
  double area_sum_ = 0.0;
};

}  // namespace

TeamRecord run_team(const Atlas& atlas, TeachingCache& cache, const StudySpec& spec, const TeamAddress& address,
                    TeamObserver* observer, SessionForecasts* forecasts) {
  cache.trim();
  return TeamRun{atlas, cache, spec, address, observer, {}, forecasts}.run().value();
}

std::optional<TeamRecord> run_team_unless(const std::function<bool()>& stopped, const Atlas& atlas,
                                          TeachingCache& cache, const StudySpec& spec, const TeamAddress& address,
                                          SessionForecasts* forecasts) {
  cache.trim();
  return TeamRun{atlas, cache, spec, address, nullptr, stopped, forecasts}.run();
}

}  // namespace kith
