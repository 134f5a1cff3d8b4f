#include "kith/teaching/strategy.hpp"
#include "planning_parameters.hpp"

namespace kith::detail {
namespace {

// As plan, with what simulated people truly believe and how well they learn; the teacher's beliefs about the others.
class PlanWithTruth : public Strategy {
 public:
  explicit PlanWithTruth(const ParameterValues& parameters) : lookahead_{parameters} {}

  [[nodiscard]] std::unique_ptr<Strategy> clone() const override { return std::make_unique<PlanWithTruth>(*this); }

  [[nodiscard]] UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) override {
    auto members = lookahead_.believed(view);
    for (std::size_t i = 0; i < view.truth.size(); ++i) {
      const auto& truth = view.truth[i];
      if (members[i].empty() || truth.belief == nullptr) continue;
      members[i] = {{1.0, truth.belief, truth.shown_ability, truth.feedback_ability}};
    }
    return {SourceBelief::of_everybody(), lookahead_.best_unit(select.cache(), view, members, random)};
  }

 private:
  Lookahead lookahead_;
};

}  // namespace

StrategyKind oracle_kind() {
  return {"oracle",
          "plan with what simulated people truly believe, as a bound",
          [](const ParameterValues&) { return TeamBeliefNeeds{.members = true, .rules = {}}; },
          [](const ParameterValues& parameters) -> std::unique_ptr<Strategy> {
            return std::make_unique<PlanWithTruth>(parameters);
          },
          Lookahead::parameters(),
          true};
}

}  // namespace kith::detail
