#include <set>

#include "curriculum_strategy.hpp"
#include "visual_order.hpp"

namespace kith::detail {
namespace {

// HIGHLIGHTS [amir2018highlights]: starts of the largest importance I(s) = max_a Q(s, a) - min_a Q(s, a) under the
// robot's weights; for diversity one of every MDP before the second of any.
class Highlights : public CurriculumStrategy {
 public:
  using CurriculumStrategy::CurriculumStrategy;
  [[nodiscard]] std::unique_ptr<Strategy> clone() const override { return std::make_unique<Highlights>(*this); }

 private:
  [[nodiscard]] std::vector<StartIndex> ranking(const TeachingView& view, RandomStream /*random*/) const override {
    struct Ranked {
      double importance;
      std::uint64_t chance;
      StartIndex start;
    };
    const auto random = RandomStream{0}.split("highlights");
    std::vector<Ranked> ranked;
    for (const auto start : candidates(view)) {
      ranked.push_back({importance(view.atlas, start), chance_of(start, random), start});
    }
    std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
      return a.importance != b.importance ? a.importance > b.importance : a.chance < b.chance;
    });
    std::vector<StartIndex> demos, others;
    std::set<std::size_t> mdps;
    for (const auto& candidate : ranked) {
      const bool is_first = mdps.insert(view.atlas.id(candidate.start).mdp.value()).second;
      (is_first ? demos : others).push_back(candidate.start);
    }
    demos.insert(demos.end(), others.begin(), others.end());
    return demos;
  }

  static double importance(const Atlas& atlas, StartIndex start) {
    const auto id = atlas.id(start);
    const auto& weights = atlas.domain().weights();
    double worst = 0.0;  // the best choice loses nothing
    for (std::size_t choice = 0; choice < atlas.domain().mdp(id.mdp).choices(id.start).size(); ++choice) {
      worst = std::max(worst, weights.return_of(atlas.feature_counts(start) - atlas.deviation_counts(start, choice)));
    }
    return worst;
  }
};

}  // namespace

StrategyKind highlights_kind() {
  return {"highlights", "show the states where it matters most what the robot does (HIGHLIGHTS)",
          [](const ParameterValues&) { return TeamBeliefNeeds{.members = true, .rules = {}}; },
          [](const ParameterValues& parameters) -> std::unique_ptr<Strategy> {
            return std::make_unique<Highlights>(parameters);
          },
          curriculum_parameters()};
}

}  // namespace kith::detail
