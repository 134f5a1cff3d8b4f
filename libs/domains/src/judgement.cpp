#include "kith/domains/judgement.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "kith/core/error.hpp"

namespace kith {

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
                "domain " + domain.id() + " has no finite optimum in MDP " + std::to_string(mdp.value())};
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

  const auto& weights = domain_->weights();
  const auto loss =
      solution_.feature_counts[start.value()] - result.feature_counts - solution_.feature_counts[result.last.value()];
  const bool nothing_lost = sign_of_dot(weights.integer, loss) == 0;
  result.earned = weights.return_of(result.feature_counts);
  result.regret = nothing_lost ? 0.0 : weights.return_of(loss);
  result.optimal = nothing_lost && result.outcome == ActionsOutcome::kFinished;
  return result;
}

ActionsJudgement judge_actions(const Domain& domain, MdpIndex mdp, std::span<const std::string> actions) {
  return ActionsJudge{domain, mdp}.judge(domain.initial_state(mdp), actions);
}

}  // namespace kith
