// Enough when it is certain enough that every member predicts the robot well from the component's starts: right from
// most of them, or losing little of its return on average.

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "kith/core/error.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/stop_rule.hpp"
#include "kith/teaching/teaching_options.hpp"
#include "kith/teaching/team_bank.hpp"

namespace kith {
namespace {

class ExamRule : public StopRule {
 public:
  // @param max_regret  nothing: by the share of the starts that are predicted right.
  explicit ExamRule(TeachingCache& cache, std::optional<double> max_regret = {})
      : exam_{cache.shared_exam()}, max_regret_{max_regret} {
    for (std::size_t k = 0; k < cache.atlas().knowledge_components().size(); ++k) {
      starts_.push_back(cache.starts_of(k));
      if (max_regret_) untaught_.push_back(cache.worth_of(k).before().regret);
    }
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
    const auto& options = closed.view.options;
    const auto component = closed.lesson.component;
    // Who imitates demonstrations is wrong, or loses as much as before teaching.
    const auto predicts_well = [&](const ParticleBelief& belief, double own) {
      const auto grade = expected_grade(closed.view.atlas, belief, component);
      return max_regret_ ? own * grade.regret + (1.0 - own) * untaught_[component] <= *max_regret_
                         : own * grade.share_right >= options.share_right;
    };
    std::vector<double> certain;
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (!members[i]) continue;
      certain.push_back(closed.bank->member(i).probability_that(predicts_well));
    }
    std::sort(certain.begin(), certain.end());  // so that seats do not matter
    double all = 1.0;
    for (const double one : certain) all *= one;
    return {closed.periods_of_component() >= options.min_periods && all >= options.probability, all};
  }

  // Of the component's starts: of all of them with tables, else the share of a sample.
  [[nodiscard]] Grade expected_grade(const Atlas& atlas, const ParticleBelief& belief, std::size_t component) const {
    const auto* table = exam_->table();
    if (table == nullptr) return {.share_right = starts_[component]->share_right(belief)};
    const auto weights = belief.weights();
    const auto cells = atlas.tables().cells().locate(belief.x(), belief.y(), belief.z());
    Grade mean;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const auto& grade = table->component(PolicyCellIndex{cells[i]}, component);
      mean.share_right += weights[i] * grade.share_right;
      mean.regret += weights[i] * grade.regret;
    }
    return mean;
  }

  std::shared_ptr<const Exam> exam_;
  std::optional<double> max_regret_;
  std::vector<std::shared_ptr<const StartSample>> starts_;  // per component
  std::vector<double> untaught_;                            // the same, the regret before teaching; if max_regret_
};

// Which share, and how certain that has to be.
std::string predicts(const TeachingOptions& options) {
  return "to predict the robot from at least " + to_string(options.share_right) +
         " of the component's start states with a probability of at least " + to_string(options.probability);
}

constexpr std::string_view kMaxRegret = "max_regret";

const std::array kRegretParameters{Parameter{
    .name = kMaxRegret,
    .default_value = 0.05,
    .description = "how much of the robot's return everybody may lose per start on average, in units of the weights",
    .max = std::numeric_limits<double>::infinity(),
    .min_is_open = true,
    .max_is_open = true}};

std::string loses_little(const TeachingOptions& options, const ParameterValues& parameters) {
  return "to lose at most " + to_string(parameters.real(kMaxRegret)) +
         " per start of the component, compared with the robot, with a probability of at least " +
         to_string(options.probability);
}

}  // namespace

namespace detail {

StopRuleKind exam_kind() {
  return {.name = "exam",
          .description =
              "when all members predict the robot right from at least share_right of the component's starts, with at "
              "least probability",
          .make = [](const ParameterValues&, TeachingCache& cache) -> std::unique_ptr<const StopRule> {
            return std::make_unique<ExamRule>(cache);
          },
          .until = [](const TeachingOptions& options,
                      const ParameterValues&) { return "until all members were estimated " + predicts(options); },
          .released = [](const TeachingOptions& options,
                         const ParameterValues&) { return "were estimated " + predicts(options); },
          .needs = [](const Atlas&) { return StopNeeds{.bank = true}; }};
}

StopRuleKind regret_kind() {
  return {
      .name = "regret",
      .description =
          "when all members lose at most max_regret by what they predict from the component's starts, with at least "
          "probability",
      .make = [](const ParameterValues& parameters, TeachingCache& cache) -> std::unique_ptr<const StopRule> {
        if (cache.shared_exam()->table() == nullptr) {
          throw Error{ErrorKind::kInfeasible,
                      "'mastery = \"regret\"' needs a domain of three features whose behaviours are tabulated: write "
                      "'mastery = \"exam\"', which goes by the share of starts predicted right"};
        }
        return std::make_unique<ExamRule>(cache, parameters.real(kMaxRegret));
      },
      .until =
          [](const TeachingOptions& options, const ParameterValues& parameters) {
            return "until all members were estimated " + loses_little(options, parameters);
          },
      .released =
          [](const TeachingOptions& options, const ParameterValues& parameters) {
            return "were estimated " + loses_little(options, parameters);
          },
      .needs = [](const Atlas&) { return StopNeeds{.bank = true}; },
      .parameters = kRegretParameters};
}

}  // namespace detail
}  // namespace kith
