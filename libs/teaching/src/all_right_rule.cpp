// Enough when everybody answered all tests right, several periods in a row [jayaraman2024].

#include <algorithm>

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

// Short lessons ask little: as many tests as the component has facets are needed, six of more.
std::size_t tests_needed(const ClosedTests& closed) {
  constexpr std::size_t kEnoughTests = 6;
  if (!closed.view.has_short_lessons) return 0;
  const auto& atlas = closed.view.atlas;
  const auto& component = atlas.knowledge_components()[closed.lesson.component];
  auto facets = component.constraints.without(atlas.prior()).members();
  if (const auto& known = closed.view.options.known)
    std::erase_if(facets, [&](ConstraintIndex c) { return known->implies(atlas.constraints()[c]); });
  return std::min(facets.size(), kEnoughTests);
}

// Whether so many periods in a row, of which this one is the last, are enough.
bool is_enough(const ClosedTests& closed, std::size_t row) {
  if (row < closed.view.options.consecutive_correct) return false;
  std::size_t tests = closed.lesson.tests.size();
  const auto& history = closed.view.history;
  for (auto past = history.end(); row > 1 && past != history.begin(); --row) tests += (--past)->lesson.tests.size();
  return tests >= tests_needed(closed);
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
    return {is_enough(closed, row), 1.0};
  }

  [[nodiscard]] bool is_done(const ClosedTests& closed, std::size_t member) const override {
    return is_enough(closed, closed.rows[member]);
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
          .description =
              "when everybody answered all tests right, consecutive_correct periods in a row (of plan, whose lessons "
              "are short, "
              "until they have as many tests as the component has facets, at most six)",
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
