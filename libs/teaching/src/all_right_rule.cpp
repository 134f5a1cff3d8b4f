// Enough when everybody answered all tests right, several periods in a row [jayaraman2024].

#include "kith/teaching/stop_rule.hpp"
#include "kith/teaching/teaching_options.hpp"

namespace kith {
namespace {

// Who was away has no verdicts, and keeps nobody from being done.
bool is_all_right(const Feedback& feedback) {
  for (std::size_t i = 0; i < feedback.verdicts.size(); ++i) {
    if (!feedback.all_correct[i] && !feedback.verdicts[i].empty()) return false;
  }
  return true;
}

class AllRightRule : public StopRule {
 public:
  [[nodiscard]] StopVerdict judge_team(const ClosedTests& closed) const override {
    if (!is_all_right(closed.feedback)) return {};
    std::size_t row = 1;
    const auto& history = closed.view.history;
    for (auto past = history.end(); past != history.begin(); ++row) {
      --past;
      if (past->lesson.component != closed.lesson.component || !is_all_right(past->feedback)) break;
    }
    return {row >= closed.view.options.consecutive_correct, 1.0};
  }

  [[nodiscard]] bool is_done(const ClosedTests& closed, std::size_t member) const override {
    return closed.rows[member] >= closed.view.options.consecutive_correct;
  }
};

std::string all_right_until(const TeachingOptions& options, const ParameterValues&) {
  const auto periods = options.consecutive_correct;
  return "until every member answered all tests correctly in " +
         (periods == 1 ? "a period" : std::to_string(periods) + " periods in a row");
}

}  // namespace

namespace detail {

StopRuleKind all_right_kind() {
  return {.name = "all-right",
          .description = "when everybody answered all tests right, consecutive_correct periods in a row",
          .make = [](const ParameterValues&, TeachingCache&) -> std::unique_ptr<const StopRule> {
            return std::make_unique<AllRightRule>();
          },
          .until = all_right_until,
          .released = [](const TeachingOptions&, const ParameterValues&) -> std::string {
            return "had answered all tests correctly";
          }};
}

}  // namespace detail
}  // namespace kith
