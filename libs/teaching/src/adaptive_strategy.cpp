#include <vector>

#include "kith/teaching/strategy.hpp"
#include "kith/teaching/team_bank.hpp"
#include "planning_parameters.hpp"

namespace kith::detail {
namespace {

constexpr std::string_view kAnswers = "answers";

// As plan, for people of all the kinds that the bank holds possible, in proportion to what their answers say.
//
// Two kinds of belief about a member are mixed. Those of the hypotheses are what people believe if the model is right,
// but only the weights of the hypotheses depend on the answers. The informed belief depends on the answers itself, with
// the expected ability.
class PlanForWhoTheyAre : public Strategy {
 public:
  explicit PlanForWhoTheyAre(const ParameterValues& parameters)
      : lookahead_{parameters}, answers_{parameters.real(kAnswers)} {}

  [[nodiscard]] std::unique_ptr<Strategy> clone() const override { return std::make_unique<PlanForWhoTheyAre>(*this); }

  [[nodiscard]] UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) override {
    const auto members = view.bank == nullptr ? lookahead_.believed(view)
                                              : Lookahead::mixed(view, answers_, Lookahead::Weighing::kPosterior);
    return {SourceBelief::of_everybody(), lookahead_.best_unit(select.cache(), view, members, random)};
  }

 private:
  Lookahead lookahead_;
  double answers_;
};

// Those of all strategies that look ahead, and one more.
std::span<const Parameter> adaptive_parameters() {
  static const auto parameters = [] {
    std::vector<Parameter> all(Lookahead::parameters().begin(), Lookahead::parameters().end());
    all.push_back({.name = kAnswers,
                   .default_value = 0.5,
                   .description = "weight of the teacher's belief about a member, which knows the answers, against "
                                  "those of the hypotheses about the member"});
    return all;
  }();
  return parameters;
}

}  // namespace

StrategyKind adaptive_kind() {
  return {"adaptive", "plan while finding out from their answers how well the members learn",
          [](const ParameterValues&) { return TeamBeliefNeeds{.members = true, .rules = {}, .bank = true}; },
          [](const ParameterValues& parameters) -> std::unique_ptr<Strategy> {
            return std::make_unique<PlanForWhoTheyAre>(parameters);
          },
          adaptive_parameters()};
}

}  // namespace kith::detail
