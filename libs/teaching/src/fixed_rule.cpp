// Enough after some periods, whatever the answers.

#include "kith/teaching/stop_rule.hpp"
#include "kith/teaching/teaching_options.hpp"

namespace kith {
namespace {

class FixedRule : public StopRule {
 public:
  [[nodiscard]] StopVerdict judge_team(const ClosedTests& closed) const override {
    const bool is_over = closed.periods_of_component() >= closed.view.options.periods_per_component;
    return {is_over, is_over ? 1.0 : 0.0};
  }
};

}  // namespace

namespace detail {

StopRuleKind fixed_kind() {
  return {.name = "fixed",
          .description = "after periods_per_component periods, whatever the answers",
          .make = [](const ParameterValues&, TeachingCache&) -> std::unique_ptr<const StopRule> {
            return std::make_unique<FixedRule>();
          },
          .until =
              [](const TeachingOptions& options, const ParameterValues&) {
                const auto periods = options.periods_per_component;
                return "for " + std::to_string(periods) + (periods == 1 ? " period" : " periods");
              }};
}

}  // namespace detail
}  // namespace kith
