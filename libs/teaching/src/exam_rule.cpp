// Enough when every member is expected to predict the robot right from most of the component's starts.

#include <algorithm>

#include "kith/teaching/cache.hpp"
#include "kith/teaching/stop_rule.hpp"
#include "kith/teaching/teaching_options.hpp"

namespace kith {
namespace {

class ExamRule : public StopRule {
 public:
  explicit ExamRule(TeachingCache& cache) {
    for (std::size_t k = 0; k < cache.atlas().knowledge_components().size(); ++k) starts_.push_back(cache.starts_of(k));
  }

  [[nodiscard]] StopVerdict judge_team(const ClosedTests& closed) const override {
    const auto& sample = *starts_[closed.lesson.component];
    double least = 1.0;
    for (std::size_t i = 0; i < closed.counted.size(); ++i) {
      if (closed.counted[i]) least = std::min(least, sample.share_right(closed.expected->member(i)));
    }
    const auto& options = closed.view.options;
    return {closed.periods_of_component() >= options.min_periods && least >= options.share_right, least};
  }

 private:
  std::vector<std::shared_ptr<const StartSample>> starts_;  // per component
};

}  // namespace

namespace detail {

StopRuleKind exam_kind() {
  return {.name = "exam",
          .description =
              "when every member is expected to predict the robot right from at least share_right of the "
              "component's starts",
          .make = [](const ParameterValues&, TeachingCache& cache) -> std::unique_ptr<const StopRule> {
            return std::make_unique<ExamRule>(cache);
          },
          .until =
              [](const TeachingOptions& options, const ParameterValues&) {
                return "until every member was expected to predict the robot from at least " +
                       to_string(options.share_right) + " of the component's start states";
              },
          .needs = [](const Atlas&) { return StopNeeds{.beliefs = true}; }};
}

}  // namespace detail
}  // namespace kith
