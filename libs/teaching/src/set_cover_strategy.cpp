#include <bit>
#include <map>
#include <utility>

#include "curriculum_strategy.hpp"
#include "visual_order.hpp"

namespace kith::detail {
namespace {

// SCOT [brown2019machine]: the fewest demonstrations whose one-step constraints are all of the component's, greedily;
// then the fewest of the others that are, and so on.
class SetCover : public CurriculumStrategy {
 public:
  using CurriculumStrategy::CurriculumStrategy;
  [[nodiscard]] std::unique_ptr<Strategy> clone() const override { return std::make_unique<SetCover>(*this); }

 private:
  static constexpr int kCovers = 30;  // more than any session needs

  // Candidates that have the same of the component's constraints.
  struct Alike {
    std::uint64_t covered;          // bit i: the component's i-th constraint
    std::vector<StartIndex> demos;  // by chance
    std::size_t num_taken = 0;
  };

  [[nodiscard]] std::vector<StartIndex> ranking(const TeachingView& view, RandomStream /*random*/) const override {
    const auto& component = view.atlas.knowledge_components()[view.component];
    auto wanted = component.constraints.without(view.atlas.prior()).members();
    if (wanted.size() > 64) wanted.resize(64);
    auto groups = grouped(view, wanted);
    std::vector<StartIndex> ranked;
    for (int cover = 0; cover < kCovers; ++cover) {
      std::uint64_t open = wanted.size() == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << wanted.size()) - 1;
      while (open != 0) {
        Alike* best = nullptr;
        for (auto& group : groups) {
          if (group.num_taken == group.demos.size() || (group.covered & open) == 0) continue;
          if (best == nullptr || std::popcount(group.covered & open) > std::popcount(best->covered & open))
            best = &group;
        }
        if (best == nullptr) break;
        open &= ~best->covered;
        ranked.push_back(best->demos[best->num_taken++]);
      }
    }
    return ranked;
  }

  static std::vector<Alike> grouped(const TeachingView& view, const std::vector<ConstraintIndex>& wanted) {
    std::map<std::uint64_t, std::vector<std::pair<std::uint64_t, StartIndex>>> by_cover;
    const auto chance = RandomStream{0}.split("set cover");
    for (const auto start : candidates(view)) {
      std::uint64_t covered = 0;
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (view.atlas.one_step(start).contains(wanted[i])) covered |= std::uint64_t{1} << i;
      }
      if (covered != 0) by_cover[covered].emplace_back(chance_of(start, chance), start);
    }
    std::vector<Alike> groups;
    for (auto& [covered, demos] : by_cover) {
      std::sort(demos.begin(), demos.end());
      auto& group = groups.emplace_back(Alike{covered, {}});
      for (const auto& [key, start] : demos) group.demos.push_back(start);
    }
    return groups;
  }
};

}  // namespace

StrategyKind set_cover_kind() {
  return {"set-cover", "show the fewest demonstrations that cover the constraints of the component (SCOT)",
          [](const ParameterValues&) { return TeamBeliefNeeds{.members = true, .rules = {}}; },
          [](const ParameterValues& parameters) -> std::unique_ptr<Strategy> {
            return std::make_unique<SetCover>(parameters);
          },
          curriculum_parameters()};
}

}  // namespace kith::detail
