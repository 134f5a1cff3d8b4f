// Enough when it is certain enough that every member predicts the robot right from most of the component's starts.

#include <algorithm>
#include <vector>

#include "kith/teaching/cache.hpp"
#include "kith/teaching/stop_rule.hpp"
#include "kith/teaching/teaching_options.hpp"
#include "kith/teaching/team_bank.hpp"

namespace kith {
namespace {

class ExamRule : public StopRule {
 public:
  explicit ExamRule(TeachingCache& cache) {
    exam_ = cache.shared_exam();
    for (std::size_t k = 0; k < cache.atlas().knowledge_components().size(); ++k) starts_.push_back(cache.starts_of(k));
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
    const auto share_right = [&](const ParticleBelief& belief) {
      return expected_share(closed.view.atlas, belief, closed.lesson.component);
    };
    std::vector<double> certain;
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (!members[i]) continue;
      certain.push_back(closed.bank->member(i).probability_of_at_least(options.share_right, share_right));
    }
    std::sort(certain.begin(), certain.end());  // so that seats do not matter
    double all = 1.0;
    for (const double one : certain) all *= one;
    return {closed.periods_of_component() >= options.min_periods && all >= options.probability, all};
  }

  // Of the component's starts: of all of them with tables, else of a sample.
  [[nodiscard]] double expected_share(const Atlas& atlas, const ParticleBelief& belief, std::size_t component) const {
    const auto* table = exam_->table();
    if (table == nullptr) return starts_[component]->share_right(belief);
    const auto& cells = atlas.tables().cells();
    const auto x = belief.x(), y = belief.y(), z = belief.z(), weights = belief.weights();
    double share = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      share += weights[i] * table->component(cells.locate(Eigen::Vector3d{x[i], y[i], z[i]}), component).share_right;
    }
    return share;
  }

  std::shared_ptr<const Exam> exam_;
  std::vector<std::shared_ptr<const StartSample>> starts_;  // per component
};

// Which share, and how certain that has to be.
std::string predicts(const TeachingOptions& options) {
  return "to predict the robot from at least " + to_string(options.share_right) +
         " of the component's start states with a probability of at least " + to_string(options.probability);
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

}  // namespace detail
}  // namespace kith
