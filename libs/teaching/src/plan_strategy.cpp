#include "kith/teaching/strategy.hpp"
#include "planning_parameters.hpp"

namespace kith::detail {
namespace {

// The unit after which the members are expected to answer most tests right.
class PlanAhead : public Strategy {
 public:
  explicit PlanAhead(const ParameterValues& parameters) : lookahead_{parameters} {}

  [[nodiscard]] std::unique_ptr<Strategy> clone() const override { return std::make_unique<PlanAhead>(*this); }

  [[nodiscard]] UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) override {
    return {SourceBelief::of_everybody(),
            lookahead_.best_unit(select.cache(), view, lookahead_.believed(view), random)};
  }

 private:
  Lookahead lookahead_;
};

}  // namespace

StrategyKind plan_kind() {
  return {"plan", "choose demonstrations by what all members are expected to know afterwards",
          [](const ParameterValues&) { return TeamBeliefNeeds{.members = true, .rules = {}}; },
          [](const ParameterValues& parameters) -> std::unique_ptr<Strategy> {
            return std::make_unique<PlanAhead>(parameters);
          },
          Lookahead::parameters()};
}

}  // namespace kith::detail
