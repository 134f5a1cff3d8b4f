#include <array>
#include <optional>
#include <utility>

#include "kith/teaching/strategy.hpp"
#include "planning_parameters.hpp"

namespace kith::detail {
namespace {

constexpr std::array<std::string_view, 4> kRivals{"individual-low", "individual-high", "common", "joint"};

// Of the units that the strategies of the paper would show, the one after which the members are expected to answer most
// tests right.
class PickTheBest : public Strategy {
 public:
  explicit PickTheBest(const ParameterValues& parameters) : lookahead_{parameters} {}

  [[nodiscard]] std::unique_ptr<Strategy> clone() const override { return std::make_unique<PickTheBest>(*this); }

  [[nodiscard]] UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) override {
    auto value = lookahead_.value(select.cache(), view, lookahead_.believed(view), random.split("points"));
    std::optional<UnitProposal> best;
    double most = 0.0;
    for (const auto name : kRivals) {
      const auto rival = strategy_named(name);
      auto proposal = rival.kind.make(rival.parameters)->propose(view, select, random.split(name));
      if (proposal.unit.demonstrations.empty()) continue;
      const double worth = value_of(select.cache(), value, proposal.unit, lookahead_.plan.capacity);
      if (best && worth <= most) continue;
      most = worth;
      best = std::move(proposal);
    }
    if (best) return *std::move(best);
    return {SourceBelief::of_everybody(), {}};
  }

 private:
  Lookahead lookahead_;
};

TeamBeliefNeeds all_beliefs(const ParameterValues&) { return {.members = true, .rules = {"common", "joint"}}; }

}  // namespace

StrategyKind pick_kind() {
  return {"pick", "show the best of the lessons that the other strategies would choose", all_beliefs,
          [](const ParameterValues& parameters) -> std::unique_ptr<Strategy> {
            return std::make_unique<PickTheBest>(parameters);
          },
          Lookahead::parameters()};
}

}  // namespace kith::detail
