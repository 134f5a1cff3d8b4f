#include "team_exam.hpp"

#include <algorithm>
#include <span>

#include "kith/random/stream.hpp"
#include "kith/study/team_streams.hpp"

namespace kith {
namespace {

// Of people whose answers do not follow from a belief that could be graded: questions, and in how many sittings. In
// each of these the person answers by other weights.
constexpr std::size_t kQuestionsInstead = 160;
constexpr std::size_t kSittings = 8;
constexpr std::size_t kNextSitting = 1'000'000'000;  // answers are drawn by period: this many periods later

// The sum in the order of size, so that seats do not matter to the last bit.
double mean(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

}  // namespace

ExamGrades TeamExaminer::grades_of(const Learner& learner, std::size_t period) {
  if (learner.answers_as_believed()) return cache_.exam().grade(*learner.belief(), cache_.behaviours());
  if (instead_.empty()) instead_ = cache_.exam().questions(kQuestionsInstead, {}, RandomStream{0}.split("exam"));
  const std::span<const StartIndex> starts{instead_};
  const auto length = (starts.size() + kSittings - 1) / kSittings;
  ExamGrades grades;
  for (std::size_t begin = 0, sitting = 0; begin < starts.size(); begin += length, ++sitting) {
    const auto asked = starts.subspan(begin, std::min(length, starts.size() - begin));
    const auto response = learner.answer(cache_.behaviours(), asked, period + sitting * kNextSitting);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const auto grade = grade_answer(cache_.atlas(), asked[i], response.answers[i]);
      grades.all.share_right += grade.share_right / static_cast<double>(starts.size());
      grades.all.regret += grade.regret / static_cast<double>(starts.size());
    }
  }
  return grades;
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
    for (const auto& shown : period.lesson.demonstrations) seen.push_back(shown.demo);
    for (const auto& test : period.lesson.tests) seen.push_back(test.demo);
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
