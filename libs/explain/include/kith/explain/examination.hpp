#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "kith/explain/audit.hpp"
#include "kith/teaching/exam_chooser.hpp"

namespace kith {

/// What an exam comes to.
enum class ExamResult {
  kUnderstands,  ///< As Understanding::kUnderstands.
  kDoesNot,      ///< Almost certainly does not satisfy all constraints often enough.
  kCannotTell,   ///< Neither.
};

/// "understands", "does-not-understand" or "cannot-tell".
[[nodiscard]] const char* name_of(ExamResult result) noexcept;

/// Of a component. @param options  with which it was judged.
[[nodiscard]] ExamResult exam_result(const ComponentAudit& audit, const AuditOptions& options = {});
/// Of all: whoever does not understand some component does not understand the robot.
[[nodiscard]] ExamResult exam_result(const PersonAudit& audit, const AuditOptions& options = {});

/// An exam of one person after all lessons. ExamChooser picks one board after the other, about components that are not
/// settled yet, until all are or kMostBoards were asked. Whoever is said to understand is so by the rules of Auditor.
class Examination {
 public:
  static constexpr std::size_t kMostBoards = 12;

  /// @param cache  stays valid as long as this object.
  /// @param periods  all that was observed of the person in teaching, in order; boards of an exam count as asked.
  /// @param is_usable  which starts people can be asked about; empty: all.
  Examination(TeachingCache& cache, const AuditOptions& options, std::vector<ObservedPeriod> periods,
              const RandomStream& random, const std::function<bool(StartIndex)>& is_usable = {});

  /// The next board; nothing when the exam is over.
  [[nodiscard]] std::optional<StartIndex> next();
  /// The answer to a board.
  void take(StartIndex start, const Answer& answer);

  /// What was observed of the person: the lessons, and one period for every board (exam_board()).
  [[nodiscard]] const std::vector<ObservedPeriod>& periods() const noexcept { return periods_; }
  [[nodiscard]] std::size_t num_boards() const noexcept { return num_boards_; }
  /// What can be said now, without misconceptions and what to do about them: Auditor::audit() has those.
  [[nodiscard]] PersonAudit audit() const { return auditor_.judge(bank_, periods_); }

 private:
  void observe(const ObservedPeriod& period);

  TeachingCache* cache_;
  AuditOptions options_;
  Auditor auditor_;
  MisconceptionBank bank_;
  ExamChooser chooser_;
  std::vector<ObservedPeriod> periods_;
  std::size_t num_boards_ = 0;
};

}  // namespace kith
