#include <algorithm>
#include <cmath>

#include "domain_data.hpp"
#include "family.hpp"
#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/planner.hpp"

namespace kith::detail {
namespace {

// Plans every MDP of an explicit model under the robot's weights and looks at the result.
class ModelChecker {
 public:
  ModelChecker(const ExplicitFamily& family, const Domain::Data& data, const Dynamics& dynamics,
               TomlPlace weights_place, TomlReport& report)
      : family_{family}, data_{data}, dynamics_{dynamics}, weights_place_{weights_place}, report_{report} {}

  void run() {
    for (const ExplicitMember& member : family_.members) {
      if (member.mdp.discount() == 1.0) check(member);  // every discounted optimum is finite
    }
    if (num_failures_ > 0) report_failure();
    warn_of_ties(num_ties_, weights_place_, report_);
  }

 private:
  void check(const ExplicitMember& member) {
    if (!is_exact(member.mdp)) {
      if (!behave(member.mdp, data_.weights.raw)) note_failure(member, "E0323", "");
      return;
    }
    if (!has_small_values(member.mdp)) {
      note_failure(member, "E0324", "");
      return;
    }
    const ExactPlan plan = plan_exactly(member.mdp, data_.weights.integer);
    if (plan.solution) {
      num_ties_ += count_ties(member.mdp, *plan.solution, data_.weights.integer);
      return;
    }
    note_failure(member, plan.failure == PlanFailure::kPositiveCycle ? "E0321" : "E0322",
                 cycle_text(member, plan.cycle));
  }

  // Whether no path can earn more than planning in integers takes (2^60).
  [[nodiscard]] bool has_small_values(const Mdp& mdp) const {
    double weight = 0.0;
    for (const std::int64_t entry : data_.weights.integer) weight += std::abs(static_cast<double>(entry));
    return weight * mdp.largest_feature() * static_cast<double>(mdp.num_states() + 1) < 0x1p60;
  }

  void note_failure(const ExplicitMember& member, const std::string& id, std::string cycle) {
    if (++num_failures_ > 1) return;
    failure_ = id;
    cycle_ = std::move(cycle);
    failing_ = member.name;
  }

  // "at the door -> in the hall -> at the door".
  [[nodiscard]] static std::string cycle_text(const ExplicitMember& member, const std::vector<StateIndex>& cycle) {
    constexpr std::size_t kShown = 12;
    std::string text;
    for (std::size_t i = 0; i < std::min(cycle.size(), kShown); ++i) text += member.names[cycle[i].value()] + " -> ";
    return text + (cycle.size() > kShown || cycle.empty() ? "..." : member.names[cycle[0].value()]);
  }

  void report_failure() {
    std::string where;
    if (family_.members.size() > 1) {
      where = "; in " + std::to_string(num_failures_) + " of " + std::to_string(family_.members.size()) +
              " MDPs, first in '" + failing_ + "'";
    }
    const std::string hint = "give actions a cost, so that finishing is better than wandering";
    if (failure_ == "E0321") {
      report_.infeasible("E0321", weights_place_,
                         "the robot can collect unlimited reward by going in circles: " + cycle_ + where, hint);
    } else if (failure_ == "E0322") {
      report_.infeasible("E0322", weights_place_, "the robot can go in circles at no cost: " + cycle_ + where, hint);
    } else if (failure_ == "E0324") {
      report_.error("E0324", weights_place_, "the features are too large to count exactly with these weights" + where,
                    "count in larger units, or give the weights with fewer digits");
    } else {
      report_.infeasible("E0323", weights_place_,
                         "there is no best way to finish: the robot can collect reward for ever" + where,
                         hint + ", or set a discount below 1");
    }
  }

  const ExplicitFamily& family_;
  const Domain::Data& data_;
  const Dynamics& dynamics_;
  TomlPlace weights_place_;
  TomlReport& report_;
  std::size_t num_ties_ = 0;
  std::size_t num_failures_ = 0;
  std::string failure_;
  std::string cycle_;
  std::string failing_;
};

}  // namespace

void check_model(const ExplicitFamily& family, const Domain::Data& data, const Dynamics& dynamics,
                 const TomlPlace& weights_place, TomlReport& report) {
  ModelChecker{family, data, dynamics, weights_place, report}.run();
}

}  // namespace kith::detail
