#include "kith/teaching/demonstration_selection.hpp"

namespace kith::detail {
namespace {

// For the belief about the team that a rule of aggregation keeps.
class ForTheTeam : public Strategy {
 public:
  explicit ForTheTeam(std::string_view rule) : rule_{rule} {}

  [[nodiscard]] std::unique_ptr<Strategy> clone() const override { return std::make_unique<ForTheTeam>(*this); }

  [[nodiscard]] UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) override {
    return {SourceBelief::of_team(rule_), select.for_belief(view.belief.aggregate(rule_), random)};
  }

 private:
  std::string_view rule_;
};

}  // namespace

StrategyKind common_kind() {
  return {"common", "teach for what all members know",
          [](const ParameterValues&) { return TeamBeliefNeeds{.members = false, .rules = {"common"}}; },
          [](const ParameterValues&) -> std::unique_ptr<Strategy> { return std::make_unique<ForTheTeam>("common"); }};
}

StrategyKind joint_kind() {
  return {"joint", "teach for what at least one member knows",
          [](const ParameterValues&) { return TeamBeliefNeeds{.members = false, .rules = {"joint"}}; },
          [](const ParameterValues&) -> std::unique_ptr<Strategy> { return std::make_unique<ForTheTeam>("joint"); }};
}

}  // namespace kith::detail
