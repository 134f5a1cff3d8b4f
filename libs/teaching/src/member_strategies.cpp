#include "kith/teaching/demonstration_selection.hpp"

namespace kith::detail {
namespace {

// For the member who is present and knows least, or most, of the current component.
class ForOneMember : public Strategy {
 public:
  // @param sign  1: who knows least; -1: who knows most.
  explicit ForOneMember(double sign) : sign_{sign} {}

  [[nodiscard]] std::unique_ptr<Strategy> clone() const override { return std::make_unique<ForOneMember>(*this); }

  [[nodiscard]] UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) override {
    const auto seat = chosen_seat(view);
    return {SourceBelief::of_member(seat), select.for_belief(view.belief.member(seat), random)};
  }

 private:
  // Ties by hash, never by seat.
  [[nodiscard]] std::size_t chosen_seat(const TeachingView& view) const {
    // The region of the component as last taught; before its first unit, the policy's.
    const std::span<const HalfSpace> region = view.last_of_component != nullptr
                                                  ? std::span<const HalfSpace>{view.last_of_component->taught}
                                                  : view.atlas.policy_bec_half_spaces();
    std::optional<std::size_t> best;
    double least = 0.0;
    for (std::size_t i = 0; i < view.belief.num_members(); ++i) {
      if (!view.belief.present()[i]) continue;
      const double here = sign_ * view.belief.member(i).mass_in(region);
      if (best && !(here < least || (here == least && view.tie_breaks[i] < view.tie_breaks[*best]))) continue;
      best = i;
      least = here;
    }
    return best.value();  // a session teaches only while somebody is present
  }

  double sign_;
};

TeamBeliefNeeds members_only(const ParameterValues&) { return {.members = true, .rules = {}}; }
std::unique_ptr<Strategy> for_lowest(const ParameterValues&) { return std::make_unique<ForOneMember>(1.0); }
std::unique_ptr<Strategy> for_highest(const ParameterValues&) { return std::make_unique<ForOneMember>(-1.0); }

}  // namespace

StrategyKind baseline_kind() {
  return {kBaseline, "teach every member alone, one after the other", members_only, for_lowest};
}
StrategyKind individual_low_kind() {
  return {"individual-low", "teach for the member who knows least", members_only, for_lowest};
}
StrategyKind individual_high_kind() {
  return {"individual-high", "teach for the member who knows most", members_only, for_highest};
}

}  // namespace kith::detail
