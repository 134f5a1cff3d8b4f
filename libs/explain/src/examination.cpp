#include "kith/explain/examination.hpp"

#include <algorithm>
#include <utility>

namespace kith {

const char* name_of(ExamResult result) noexcept {
  switch (result) {
    case ExamResult::kUnderstands:
      return "understands";
    case ExamResult::kDoesNot:
      return "does-not-understand";
    case ExamResult::kCannotTell:
      break;
  }
  return "cannot-tell";
}

ExamResult exam_result(const ComponentAudit& audit, const AuditOptions& options) {
  if (audit.understanding == Understanding::kUnderstands) return ExamResult::kUnderstands;
  const bool is_judged = audit.periods > 0 || audit.examined > 0;
  return is_judged && audit.level.probability <= 1.0 - options.sure ? ExamResult::kDoesNot : ExamResult::kCannotTell;
}

ExamResult exam_result(const PersonAudit& audit, const AuditOptions& options) {
  bool all = true;
  for (const auto& component : audit.components) {
    const auto result = exam_result(component, options);
    if (result == ExamResult::kDoesNot) return result;
    all = all && result == ExamResult::kUnderstands;
  }
  return all ? ExamResult::kUnderstands : ExamResult::kCannotTell;
}

Examination::Examination(TeachingCache& cache, const AuditOptions& options, std::vector<ObservedPeriod> periods,
                         const RandomStream& random, const std::function<bool(StartIndex)>& is_usable)
    : cache_{&cache},
      options_{options},
      auditor_{cache, options},
      bank_{cache.atlas(), options.bank, MisconceptionBank::beliefs(cache, options.bank, random.split("bank"))},
      chooser_{cache, is_usable} {
  for (auto& period : periods) observe(period);
  periods_ = std::move(periods);
}

void Examination::observe(const ObservedPeriod& period) {
  bank_.observe(cache_->atlas(), period);
  for (const auto& shown : period.demonstrations) chooser_.leave_out(shown.start);
  for (const auto& test : period.tests) chooser_.leave_out(test.start);
  num_boards_ += period.is_exam() ? 1u : 0u;
}

std::optional<StartIndex> Examination::next() {
  if (num_boards_ >= kMostBoards) return std::nullopt;
  const auto person = audit();
  std::vector<std::vector<HalfSpace>> open;
  for (const auto& component : person.components) {
    if (exam_result(component, options_) != ExamResult::kCannotTell) continue;
    open.push_back(auditor_.constraints_of(component.component));
  }
  return open.empty() ? std::nullopt : chooser_.choose(bank_, open, options_.level);
}

void Examination::take(StartIndex start, const Answer& answer) {
  auto board = exam_board(cache_->atlas(), start, answer, periods_.empty() ? 1 : periods_.back().period + 1);
  observe(board);
  periods_.push_back(std::move(board));
}

}  // namespace kith
