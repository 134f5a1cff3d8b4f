#include "team_exam.hpp"

#include <algorithm>

#include "kith/core/stream.hpp"
#include "kith/study/team_streams.hpp"

namespace kith {
namespace {

// What people make of their best paths is asked for: so many questions, in as many sittings as weights are drawn from
// the belief.
constexpr std::size_t kQuestions = 160;
constexpr std::size_t kSittings = 16;
constexpr std::size_t kNextSitting = 1'000'000'000;  // answers are drawn by period: this many periods later

// The sum in the order of size, so that seats do not matter to the last bit.
double mean(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

}  // namespace

// The grades of the belief and, where people do not take the paths that are best by it, what that changes: the mean
// difference between their answers and those paths. So whoever changes nothing has the grades of the belief.
ExamGrades TeamExaminer::grades_of(const Learner& learner, std::size_t period) {
  const auto* belief = learner.belief();
  auto grades = belief ? cache_.exam().grade(*belief, cache_.behaviours()) : ExamGrades{};
  if (learner.answers_as_believed()) return grades;
  if (asked_.empty()) asked_ = cache_.exam().questions(kQuestions, {}, RandomStream{0}.split("exam"));
  std::vector<std::optional<Direction>> drawn(kSittings);
  if (belief) {
    drawn.clear();
    for (const auto& draw : belief->systematic_draws(kSittings, RandomStream{0}.split("exam").split("draws")))
      drawn.insert(drawn.end(), draw.count, belief->point(draw.index));
  }
  std::vector<Change> changes;
  for (std::size_t sitting = 0; sitting < kSittings; ++sitting) {
    std::vector<StartIndex> starts;
    for (std::size_t i = sitting; i < asked_.size(); i += kSittings) starts.push_back(asked_[i]);
    add_changes(changes, learner, starts, drawn[sitting], period + sitting * kNextSitting);
  }
  add_means(changes, grades);
  return grades;
}

void TeamExaminer::add_changes(std::vector<Change>& changes, const Learner& learner,
                               const std::vector<StartIndex>& starts, const std::optional<Direction>& weights,
                               std::size_t period) {
  auto& behaviours = cache_.behaviours();
  const auto response =
      weights ? learner.answer_by(behaviours, starts, *weights, period) : learner.answer(behaviours, starts, period);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    auto grade = grade_answer(cache_.atlas(), starts[i], response.answers[i]);
    if (weights) {
      const auto own = behaviours.answer(starts[i], behaviours.locate(*weights));
      const auto without = own == response.answers[i] ? grade : grade_answer(cache_.atlas(), starts[i], own);
      grade = {grade.share_right - without.share_right, grade.regret - without.regret};
    }
    changes.push_back({starts[i], grade});
  }
}

void TeamExaminer::add_means(const std::vector<Change>& changes, ExamGrades& grades) const {
  const auto& components = cache_.atlas().knowledge_components();
  const auto add = [&](Grade& grade, auto counts) {
    const auto n = static_cast<double>(std::count_if(changes.begin(), changes.end(), counts));
    for (const auto& change : changes) {
      if (!counts(change)) continue;
      grade.share_right += change.grade.share_right / n;
      grade.regret += change.grade.regret / n;
    }
    grade = {std::clamp(grade.share_right, 0.0, 1.0), std::max(grade.regret, 0.0)};
  };
  add(grades.all, [](const Change&) { return true; });
  for (std::size_t k = 0; k < grades.components.size(); ++k) {
    add(grades.components[k],
        [&](const Change& change) { return components[k].uses_mdp[cache_.atlas().id(change.start).mdp.value()]; });
  }
}

void TeamExaminer::write(std::size_t period, const Learner& learner, const LearnerRecord& row,
                         const ExamGrades& grades) {
  const auto add = [&](std::size_t component, const Grade& grade, std::optional<double> p_bec) {
    record_.exams.push_back({.period = period,
                             .component = component,
                             .member = row.member,
                             .type = row.type,
                             .share_right = grade.share_right,
                             .regret = grade.regret,
                             .p_bec = p_bec});
  };
  add(0, grades.all, learner.mass_in(cache_.atlas().policy_bec_half_spaces()));
  for (std::size_t k = 0; k < grades.components.size(); ++k) add(k + 1, grades.components[k], std::nullopt);
}

void TeamExaminer::after_period(std::size_t period, const Learners& learners, const std::vector<LearnerRecord>& rows) {
  if (spec_.exam != ExamLevel::kPeriod) return;
  for (std::size_t i = 0; i < rows.size(); ++i)
    write(period, *learners[i], rows[i], grades_of(*learners[i], period + 1));
}

void TeamExaminer::at_end(const Session& session, const Learners& learners, std::vector<LearnerRecord>& rows,
                          std::size_t member) {
  if (spec_.exam == ExamLevel::kNone) return;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto grades = grades_of(*learners[i], session.periods() + 1);
    rows[i].exam_share_right = grades.all.share_right;
    rows[i].exam_regret = grades.all.regret;
    if (spec_.exam == ExamLevel::kEnd) write(session.periods(), *learners[i], rows[i], grades);
  }
  if (spec_.exam_questions > 0) ask(session, learners, rows, member);
}

// The same questions for everybody, about starts that nobody has met.
void TeamExaminer::ask(const Session& session, const Learners& learners, std::vector<LearnerRecord>& rows,
                       std::size_t member) {
  std::vector<StartIndex> seen;
  for (const auto& period : session.history()) {
    for (const auto& shown : period.lesson.demonstrations) seen.push_back(shown.start);
    for (const auto& test : period.lesson.tests) seen.push_back(test.start);
  }
  const auto random = team_stream(spec_, record_.address).split("exam").split(member);
  const auto questions = cache_.exam().questions(spec_.exam_questions, seen, random);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto response = learners[i]->answer(cache_.behaviours(), questions, session.periods() + 1);
    rows[i].exam_questions = questions.size();
    for (std::size_t q = 0; q < questions.size(); ++q) {
      const auto grade = grade_answer(cache_.atlas(), questions[q], response.answers[q]);
      rows[i].exam_correct += grade.share_right > 0.0 ? 1u : 0u;
    }
  }
}

void summarize_exam(TeamRecord& record, const StudySpec& spec) {
  if (spec.exam == ExamLevel::kNone) return;
  std::vector<double> share_right, regret;
  for (const auto& row : record.learners) {
    share_right.push_back(row.exam_share_right);
    regret.push_back(row.exam_regret);
  }
  const double worst = *std::min_element(share_right.begin(), share_right.end());
  record.exam = TeamExam{mean(std::move(share_right)), mean(std::move(regret)), worst};
}

}  // namespace kith
