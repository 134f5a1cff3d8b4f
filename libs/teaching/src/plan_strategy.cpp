#include <vector>

#include "kith/teaching/strategy.hpp"
#include "kith/teaching/teaching_options.hpp"
#include "kith/teaching/team_bank.hpp"
#include "planning_parameters.hpp"

namespace kith::detail {
namespace {

// The unit after which the members are expected to answer most tests right.
class PlanAhead : public Strategy {
 public:
  explicit PlanAhead(const ParameterValues& parameters) : lookahead_{parameters} {}

  [[nodiscard]] std::unique_ptr<Strategy> clone() const override { return std::make_unique<PlanAhead>(*this); }

  [[nodiscard]] UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) override {
    return {SourceBelief::of_everybody(), lookahead_.best_unit(select.cache(), view, members(view), random)};
  }

 private:
  // Where people may be of several kinds, of all of them alike, whatever they answer.
  [[nodiscard]] std::vector<std::vector<MemberHypothesis>> members(const TeachingView& view) const {
    constexpr double kShareOfAnswers = 0.5;
    const bool has_kinds = view.options.hypotheses_about == HypothesesAbout::kKinds && view.bank != nullptr;
    return has_kinds ? Lookahead::mixed(view, kShareOfAnswers, Lookahead::Weighing::kBeforehand)
                     : lookahead_.believed(view);
  }

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
