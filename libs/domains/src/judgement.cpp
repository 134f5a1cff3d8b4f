#include "kith/domains/judgement.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/domains/file_units.hpp"

namespace kith {
namespace {

constexpr double kRelativeError = 1e-6;

// Two returns of expected counts that differ by less are equal, in counts times weights of length 1.
double tolerance(const Domain& domain, const IntegerVector& robot) {
  const auto& unit = domain.weights().unit;
  const auto scale = static_cast<double>(domain.count_scale());
  const double value = std::abs(dot(robot, std::span{unit.data(), robot.size()})) / scale;
  const double rounding = 2.0 * std::sqrt(static_cast<double>(robot.size())) / scale;
  return std::max(kRelativeError * std::max(1.0, value), rounding);
}

}  // namespace

PathJudgement judge_path(const Domain& domain, const IntegerVector& robot, const IntegerVector& path) {
  const auto& weights = domain.weights();
  if (robot.size() != domain.num_features() || path.size() != robot.size()) {
    throw std::invalid_argument{"judge_path: there must be one count per feature"};
  }
  PathJudgement result;
  result.loss = robot - path;
  const auto scale = static_cast<double>(domain.count_scale());
  const int sign = sign_of_dot(weights.integer, result.loss);
  const bool is_equal =
      sign == 0 ||
      (!domain.is_exact() &&
       std::abs(dot(result.loss, std::span{weights.unit.data(), robot.size()})) / scale <= tolerance(domain, robot));
  result.is_right = is_equal || sign < 0;
  result.is_better = !is_equal && sign < 0;
  if (is_equal) return result;
  result.regret = weights.return_of(result.loss) / scale;
  result.raw_regret = dot(result.loss, weights.raw) / scale;
  return result;
}

double in_file_units(const RewardWeights& weights, double value) {
  if (weights.raw.empty()) return value;
  double length = 0.0;
  for (const double x : weights.raw) length += weights.norm == WeightNorm::kL1 ? std::abs(x) : x * x;
  if (weights.norm == WeightNorm::kL2) length = std::sqrt(length);
  std::array<char, 32> digits{};
  const auto written = std::to_chars(digits.begin(), digits.end(), value * length, std::chars_format::general, 15);
  std::from_chars(digits.begin(), written.ptr, value);
  return value;
}

const char* name_of(ActionsOutcome outcome) noexcept {
  switch (outcome) {
    case ActionsOutcome::kFinished:
      return "finished";
    case ActionsOutcome::kStoppedShort:
      return "stopped-short";
    case ActionsOutcome::kIllegal:
      return "illegal";
  }
  return "";
}

ActionsJudge::ActionsJudge(const Domain& domain, MdpIndex mdp) : domain_{&domain}, mdp_{&domain.mdp(mdp)} {
  auto plan = plan_exactly(*mdp_, domain.weights().integer);
  if (!plan.solution) {
    throw Error{ErrorKind::kInfeasible,
                "domain " + domain.id() + " has no finite optimum in world " + std::to_string(mdp.value())};
  }
  solution_ = *std::move(plan.solution);
}

void ActionsJudge::check(StateIndex start) const {
  if (start.value() < mdp_->num_states() + mdp_->num_terminals()) return;
  throw std::invalid_argument{"ActionsJudge: there is no state " + std::to_string(start.value())};
}

double ActionsJudge::best_return(StateIndex start) const {
  check(start);
  return domain_->weights().return_of(solution_.feature_counts[start.value()]);
}

std::optional<Outcome> ActionsJudge::outcome_of(StateIndex s, const std::string& action) const {
  const auto& names = domain_->action_names();
  for (const Choice& choice : mdp_->choices(s)) {
    if (names[choice.action.value()] == action) return mdp_->outcomes(choice).front();
  }
  return std::nullopt;
}

ActionsJudgement ActionsJudge::judge(StateIndex start, std::span<const std::string> actions) const {
  check(start);
  ActionsJudgement result;
  result.last = start;
  result.feature_counts = IntegerVector(domain_->num_features());
  while (!mdp_->is_terminal(result.last) && result.counted < actions.size()) {
    const auto outcome = outcome_of(result.last, actions[result.counted]);
    if (!outcome) {
      result.outcome = ActionsOutcome::kIllegal;
      break;
    }
    result.feature_counts = result.feature_counts + mdp_->integer_features(*outcome);
    result.last = outcome->next;
    ++result.counted;
  }
  if (mdp_->is_terminal(result.last)) result.outcome = ActionsOutcome::kFinished;
  result.ignored = actions.size() - result.counted;

  const auto judged = judge_path(*domain_, solution_.feature_counts[start.value()],
                                 result.feature_counts + solution_.feature_counts[result.last.value()]);
  result.earned = domain_->weights().return_of(result.feature_counts);
  result.regret = judged.regret;
  result.optimal = judged.is_right && result.outcome == ActionsOutcome::kFinished;
  return result;
}

ActionsJudgement judge_actions(const Domain& domain, MdpIndex mdp, std::span<const std::string> actions) {
  return ActionsJudge{domain, mdp}.judge(domain.initial_state(mdp), actions);
}

}  // namespace kith
