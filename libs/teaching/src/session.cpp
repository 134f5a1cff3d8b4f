#include "kith/teaching/session.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

#include "kith/bec/comparison.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/judgement.hpp"
#include "session_checks.hpp"
#include "shown_by_answers.hpp"

namespace kith {
namespace {

constexpr std::size_t kMaxMembers = 30;
// An ability of 1 would exclude every particle when a person contradicts what was taught.
constexpr double kSurest = 1.0 - 1e-9;

TeamBelief::Options belief_options(const TeachingOptions& options, const StrategyChoice& choice,
                                   std::size_t dimension) {
  const auto needs = choice.kind.needs(choice.parameters);
  const auto is_needed = [&](const AggregationRule& rule) {
    return options.keep_rules || std::find(needs.rules.begin(), needs.rules.end(), rule.name) != needs.rules.end();
  };
  std::vector<AggregationRule> rules;
  std::copy_if(options.rules.begin(), options.rules.end(), std::back_inserter(rules), is_needed);
  for (const auto& name : needs.rules) {
    const bool is_there = std::any_of(rules.begin(), rules.end(), [&](const auto& rule) { return rule.name == name; });
    require(is_there, "the strategy '" + choice.name + "' needs the belief '" + name + "'");
  }
  return {.filter = options.filter,
          .likelihood = HalfSpaceLikelihood{std::min(options.assumed_ability, kSurest), options.likelihood, dimension},
          .response_noise = options.response_noise,
          .reduce_before_update = options.reduce_before_update,
          .members = options.keep_members || needs.members,
          .rules = std::move(rules)};
}

// Updates the belief with these members present; if that throws, nothing has changed.
template <typename Update>
void update_with(TeamBelief& belief, const std::vector<bool>& present, Update update) {
  if (belief.present() == present) return update(belief);
  TeamBelief trial = belief;
  trial.set_present(present);
  update(trial);
  belief = std::move(trial);
}

// The same for the belief by which a teacher teaches and the one by which it judges, if there is one. The one by which
// it teaches comes last, so that it is the one whose results remain.
template <typename Update>
void update_both(TeamBelief& belief, std::optional<TeamBelief>& judged, const std::vector<bool>& present,
                 Update update) {
  auto trial = judged;
  if (trial) update_with(*trial, present, update);
  update_with(belief, present, update);
  judged = std::move(trial);
}

std::string_view name_of(SessionPhase phase) {
  switch (phase) {
    case SessionPhase::kProposal:
      return "no lesson has been chosen yet";
    case SessionPhase::kLesson:
      return "the lesson has not been shown yet";
    case SessionPhase::kTests:
      return "the tests are open";
    case SessionPhase::kFeedback:
      return "the feedback has not been given yet";
    case SessionPhase::kFinished:
      return "the session is finished";
  }
  return {};
}

}  // namespace

std::string_view name_of(SessionStatus status) noexcept {
  constexpr std::array<std::string_view, 4> kNames{"running", "complete", "skipped", "max_periods"};
  return kNames.at(static_cast<std::size_t>(status));
}

bool Feedback::all_right_in_the_end(std::size_t member) const {
  if (member >= revised.size() || revised[member].empty()) return all_correct.at(member);
  return std::all_of(revised[member].begin(), revised[member].end(), [](const Verdict& one) { return one.correct; });
}

Session::Session(TeachingCache& cache, TeachingOptions options, StrategyChoice strategy,
                 std::vector<RandomStream> persons, RandomStream teacher)
    : atlas_{cache.shared_atlas()},
      options_{std::move(options)},
      choice_{std::move(strategy)},
      strategy_{choice_.kind.make(choice_.parameters)},
      persons_{std::move(persons)},
      teacher_{teacher},
      belief_{cache.start_of(options_), belief_options(options_, choice_, atlas_->domain().num_features()), persons_,
              teacher.split("team belief")},
      right_in_a_row_(persons_.size(), 0),
      components_(atlas_->knowledge_components().size(), ComponentStatus::kOpen),
      attendance_(persons_.size(), Attendance::kPresent),
      is_new_(persons_.size(), false),
      visited_{atlas_->num_states()},
      pending_(persons_.size()) {
  require(persons_.size() <= kMaxMembers, "a team has at most 30 members");
  require(!choice_.is_baseline() || persons_.size() == 1, "the baseline teaches one person per session");
  require(options_.counterfactuals >= 1, "counterfactuals must be at least 1");
  for (const auto& key : stop_keys()) {
    require(is_possible(key.parameter, key.get(options_)),
            std::string{key.parameter.name} + " must be in " + range_of(key.parameter));
  }
  taught_before_ = cache.constraints().half_spaces(cache.regions().minimal(atlas_->prior()));
  taught_with_unit_ = taught_before_;
  make_rules(cache);
  if (teaches_whole() && !components_.empty()) {
    component_ = components_.size() - 1;
    std::fill(components_.begin(), components_.end() - 1, ComponentStatus::kSkipped);
  }
  for (const auto& person : persons_) tie_breaks_.push_back(person.address());
}

bool Session::teaches_whole() const noexcept {
  return options_.scaffold == Scaffold::kNone ||
         (options_.scaffold == Scaffold::kOfStrategy && choice_.kind.teaches_whole);
}

void Session::require_phase(SessionPhase phase, std::string_view what) const {
  if (phase_ == phase) return;
  throw Error{ErrorKind::kUsage, std::string{what} + " is not possible now: " + std::string{name_of(phase_)}};
}

void Session::require_seat(std::size_t member) const {
  if (member < num_members()) return;
  refuse("there is no member " + std::to_string(member + 1) + ": the team has " + std::to_string(num_members()));
}

const Lesson& Session::lesson() const {
  if (phase_ == SessionPhase::kProposal || phase_ == SessionPhase::kFinished) {
    throw Error{ErrorKind::kUsage, "there is no lesson now: " + std::string{name_of(phase_)}};
  }
  return lesson_;
}

// --- the period ----------------------------------------------------------------------------------------------------

void Session::show() {
  require_phase(SessionPhase::kLesson, "showing a lesson");
  std::vector<bool> present;
  for (const Attendance seat : attendance_) present.push_back(seat == Attendance::kPresent);
  if (nobody(present)) throw Error{ErrorKind::kUsage, "the lesson cannot be shown: everybody is away"};
  std::vector<HalfSpace> conveyed;
  for (const auto& shown : lesson_.demonstrations) {
    conveyed.insert(conveyed.end(), shown.half_spaces.begin(), shown.half_spaces.end());
  }
  auto shown = events_.prepare(LessonShown{});
  update_both(belief_, judged_, present,
              [&](TeamBelief& belief) { belief.observe_demonstrations(conveyed, lesson_.period); });
  if (bank_) {
    const double minutes = history_.empty() ? 0.0 : minutes_of(options_.pace, history_.back());
    bank_->watch(*atlas_, lesson_, present, minutes);
  }
  events_.push_back(std::move(shown));
  phase_ = SessionPhase::kTests;
}

Verdict Session::judge(const Test& test, const Answer& answer) const {
  if (!answer) return verdict_on(*atlas_, test, answer);
  const auto& robot = atlas_->feature_counts(test.start);
  if (answer->size() != robot.size()) {
    refuse("an answer has " + std::to_string(answer->size()) + " feature counts instead of " +
           std::to_string(robot.size()));
  }
  if (judge_path(atlas_->domain(), robot, *answer).is_better) {
    refuse("an answer earns more than the robot's optimal behaviour, which no path can");
  }
  return verdict_on(*atlas_, test, answer);
}

// What the answers show. @throws Error if they cannot be answers to the current tests.
Session::Given Session::judged(std::size_t member, std::vector<Answer> answers) const {
  require_seat(member);
  const auto who = "member " + std::to_string(member + 1);
  if (!takes_part(member)) refuse(who + " is away");
  if (has_answered(member)) refuse(who + " has already answered");
  if (has_discussed()) refuse(who + " is too late: the answers have been discussed");
  return judged_answers(member, std::move(answers));
}

Session::Given Session::judged_answers(std::size_t member, std::vector<Answer> answers) const {
  const auto who = "member " + std::to_string(member + 1);
  if (answers.size() != lesson_.tests.size()) {
    refuse(who + " gave " + std::to_string(answers.size()) + " answers to " + std::to_string(lesson_.tests.size()) +
           " tests");
  }
  Given given{std::move(answers), {}};
  for (std::size_t t = 0; t < lesson_.tests.size(); ++t) {
    given.verdicts.push_back(judge(lesson_.tests[t], given.answers[t]));
  }
  return given;
}

void Session::answer(std::size_t member, std::vector<Answer> answers) {
  require_phase(SessionPhase::kTests, "answering");
  auto given = judged(member, std::move(answers));
  events_.push_back(events_.prepare(TestsAnswered{member, given.answers}));
  pending_[member] = std::move(given);
}

void Session::discuss(std::vector<std::vector<Answer>> revised) {
  require_phase(SessionPhase::kTests, "discussing answers");
  if (has_discussed()) throw Error{ErrorKind::kUsage, "the answers have been discussed already"};
  if (std::count_if(pending_.begin(), pending_.end(), [](const auto& one) { return one.has_value(); }) < 2) {
    throw Error{ErrorKind::kUsage, "there is nothing to discuss: fewer than two members have answered"};
  }
  if (revised.size() != num_members()) {
    refuse("there are revised answers of " + std::to_string(revised.size()) + " members instead of " +
           std::to_string(num_members()));
  }
  std::vector<Given> judged(num_members());
  for (std::size_t i = 0; i < num_members(); ++i) {
    if (revised[i].empty()) continue;
    if (!has_answered(i)) refuse("member " + std::to_string(i + 1) + " revises answers without having given any");
    judged[i] = judged_answers(i, revised[i]);
  }
  events_.push_back(events_.prepare(AnswersDiscussed{std::move(revised)}));
  revised_ = std::move(judged);
}

const Feedback& Session::close_tests() {
  require_phase(SessionPhase::kTests, "closing the tests");
  Feedback feedback;
  Verdict unanswered;
  unanswered.answered = false;
  std::vector<bool> counts;  // who takes part or had answered before leaving
  std::vector<std::vector<HalfSpace>> shown(num_members()), revised(num_members());
  for (std::size_t i = 0; i < num_members(); ++i) {
    counts.push_back(takes_part(i) || has_answered(i));
    auto& verdicts = feedback.verdicts.emplace_back();
    if (counts[i] && !has_answered(i)) verdicts.assign(lesson_.tests.size(), unanswered);
    if (has_answered(i)) verdicts = pending_[i]->verdicts;
    for (const auto& verdict : verdicts) add_new(shown[i], verdict.half_spaces);
    const bool all =
        counts[i] && std::all_of(verdicts.begin(), verdicts.end(), [](const auto& v) { return v.correct; });
    feedback.all_correct.push_back(all);
  }
  if (nobody(counts)) throw Error{ErrorKind::kUsage, "the tests cannot be closed: everybody is away"};
  for (std::size_t i = 0; i < revised_.size(); ++i) {
    feedback.revised.push_back(revised_[i].verdicts);
    revised[i] = shown_by_revision(feedback.verdicts[i], revised_[i].verdicts);
  }
  for (const auto& test : lesson_.tests) add_new(feedback.half_spaces, test.covered);
  auto closed = events_.prepare(TestsClosed{});
  update_both(belief_, judged_, counts, [&](TeamBelief& belief) {
    feedback.excluded = belief.observe_responses(shown, lesson_.period);
    if (has_discussed()) belief.observe_discussion(revised, lesson_.period);
  });
  inform_bank(feedback, counts);
  auto rows = right_in_a_row_;
  for (std::size_t i = 0; i < num_members(); ++i) rows[i] = feedback.all_correct[i] ? rows[i] + 1 : 0;
  decide(feedback, counts, rows);
  events_.push_back(std::move(closed));
  right_in_a_row_ = std::move(rows);
  feedback_ = std::move(feedback);
  phase_ = SessionPhase::kFeedback;
  return feedback_;
}

const Feedback& Session::give_feedback() {
  require_phase(SessionPhase::kFeedback, "giving feedback");
  std::vector<bool> present;
  for (const Attendance seat : attendance_) present.push_back(seat == Attendance::kPresent);
  if (nobody(present)) throw Error{ErrorKind::kUsage, "feedback cannot be given: everybody is away"};
  std::vector<std::vector<Answer>> answers;
  for (std::size_t i = 0; i < num_members(); ++i) {
    auto& list = answers.emplace_back();
    if (has_answered(i)) {
      list = pending_[i]->answers;
    } else if (!feedback_.verdicts[i].empty()) {
      list.resize(lesson_.tests.size());
    }
  }
  auto given = events_.prepare(FeedbackGiven{});
  history_.make_room();
  const auto past = std::make_shared<PastPeriod>();
  update_both(belief_, judged_, present,
              [&](TeamBelief& belief) { belief.observe_feedback(feedback_.half_spaces, lesson_.period); });
  events_.push_back(std::move(given));
  *past = {std::move(lesson_), std::move(answers), std::move(feedback_)};
  for (auto& one : revised_) past->revised.push_back(std::move(one.answers));
  revised_.clear();
  history_.push_back(past);
  lesson_ = {};
  feedback_ = {};
  for (auto& answered : pending_) answered.reset();
  conclude_period(history_.back().feedback);
  return history_.back().feedback;
}

void Session::conclude_period(const Feedback& feedback) {
  if (feedback.component_learned) {
    components_[component_] = ComponentStatus::kLearned;
    if (!options_.review) taught_before_ = taught_with_unit_;
    std::fill(right_in_a_row_.begin(), right_in_a_row_.end(), 0);
    ++component_;
    std::replace(attendance_.begin(), attendance_.end(), Attendance::kReleased, Attendance::kReturning);
  }
  for (const auto member : feedback.released) {
    if (attendance_[member] == Attendance::kPresent) attendance_[member] = Attendance::kReleased;
  }
  const bool more = std::find(components_.begin(), components_.end(), ComponentStatus::kOpen) != components_.end();
  phase_ = SessionPhase::kProposal;
  if (more && periods() >= options_.max_periods) {
    status_ = SessionStatus::kMaxPeriods;
    phase_ = SessionPhase::kFinished;
  }
}

const Feedback& Session::submit(std::span<const std::vector<Answer>> answers) {
  require_phase(SessionPhase::kLesson, "submitting answers");
  if (answers.size() != num_members()) {
    refuse("there are answers of " + std::to_string(answers.size()) + " members instead of " +
           std::to_string(num_members()));
  }
  for (std::size_t i = 0; i < num_members(); ++i) {
    if (takes_part(i)) static_cast<void>(judged(i, answers[i]));  // before anything happens
  }
  show();
  for (std::size_t i = 0; i < num_members(); ++i) {
    if (takes_part(i)) answer(i, answers[i]);
  }
  close_tests();
  return give_feedback();
}

}  // namespace kith
