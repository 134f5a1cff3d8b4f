// Enough when everybody probably answers a random test of the component right, and their answers tell them from people
// whom lessons do not reach.

#include <algorithm>

#include "kith/teaching/cache.hpp"
#include "kith/teaching/stop_rule.hpp"
#include "kith/teaching/teaching_options.hpp"
#include "kith/teaching/team_bank.hpp"
#include "whole_components.hpp"

namespace kith {
namespace {

// Where whole components are taught, people are judged by beliefs that take the answers in: lessons stop showing what
// answers prove to be known, and beliefs of the bank never learn of that.
StopNeeds posterior_needs(const Atlas& atlas) { return {.bank = true, .beliefs = teaches_whole_components(atlas)}; }

class PosteriorRule : public StopRule {
 public:
  explicit PosteriorRule(TeachingCache& cache) {
    if (!posterior_needs(cache.atlas()).beliefs) {
      exam_ = cache.shared_exam();
      return;
    }
    for (std::size_t k = 0; k < cache.atlas().knowledge_components().size(); ++k) tests_.push_back(cache.tests_of(k));
  }

  [[nodiscard]] StopVerdict judge_team(const ClosedTests& closed) const override {
    return judge(closed, closed.counted);
  }
  [[nodiscard]] bool is_done(const ClosedTests& closed, std::size_t member) const override {
    std::vector<bool> alone(closed.counted.size(), false);
    alone[member] = true;
    return judge(closed, alone).is_enough;
  }

 private:
  [[nodiscard]] StopVerdict judge(const ClosedTests& closed, const std::vector<bool>& members) const {
    // Such people would otherwise count as done after a few lucky answers, because most people learn.
    constexpr double kShare = 0.2;  // of 1 - probability
    const auto& options = closed.view.options;
    const double right =
        exam_ ? closed.bank->probability_of_mastery(closed.view.atlas, *exam_, closed.lesson.component, members)
              : all_right(*tests_[closed.lesson.component], *closed.expected, members);
    return {closed.periods_of_component() >= options.min_periods && right >= options.probability &&
                closed.bank->shows_learning(members, kShare * (1.0 - options.probability)),
            right};
  }

  // The probability that all of them predict the robot right at a random start.
  static double all_right(const StartSample& sample, const TeamBelief& belief, const std::vector<bool>& members) {
    std::vector<std::vector<double>> right(sample.size());  // per start the members' probabilities
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (!members[i]) continue;
      const auto probabilities = sample.probabilities_right(belief.member(i));
      for (std::size_t s = 0; s < right.size(); ++s) right[s].push_back(probabilities[s]);
    }

    double sum = 0.0;
    for (std::size_t s = 0; s < right.size(); ++s) {
      std::sort(right[s].begin(), right[s].end());  // so that seats do not matter
      double together = sample.weight(s);
      for (const double one : right[s]) together *= one;
      sum += together;
    }
    return sum;
  }

  std::shared_ptr<const Exam> exam_;                       // with tables
  std::vector<std::shared_ptr<const StartSample>> tests_;  // per component, without
};

}  // namespace

namespace detail {

StopRuleKind posterior_kind() {
  return {.name = "posterior",
          .description =
              "when the probability that all members answer a random test of the component right is at "
              "least probability, and their answers tell them from people who do not learn",
          .make = [](const ParameterValues&, TeachingCache& cache) -> std::unique_ptr<const StopRule> {
            return std::make_unique<PosteriorRule>(cache);
          },
          .until =
              [](const TeachingOptions& options, const ParameterValues&) {
                return "until the estimated probability that all members answer a random test correctly was " +
                       to_string(options.probability);
              },
          .released =
              [](const TeachingOptions& options, const ParameterValues&) {
                return "were estimated to answer a random test correctly with a probability of at least " +
                       to_string(options.probability);
              },
          .needs = posterior_needs};
}

}  // namespace detail
}  // namespace kith
