#include <utility>

#include "curriculum_strategy.hpp"
#include "visual_order.hpp"

namespace kith::detail {
namespace {

class RandomDemonstrations : public CurriculumStrategy {
 public:
  using CurriculumStrategy::CurriculumStrategy;
  [[nodiscard]] std::unique_ptr<Strategy> clone() const override {
    return std::make_unique<RandomDemonstrations>(*this);
  }

 private:
  [[nodiscard]] std::vector<StartIndex> ranking(const TeachingView& view, RandomStream random) const override {
    std::vector<std::pair<std::uint64_t, StartIndex>> shuffled;
    for (const auto start : candidates(view)) shuffled.emplace_back(chance_of(start, random), start);
    std::sort(shuffled.begin(), shuffled.end());
    std::vector<StartIndex> demos;
    for (const auto& [key, start] : shuffled) demos.push_back(start);
    return demos;
  }
};

}  // namespace

StrategyKind random_kind() {
  return {"random", "show demonstrations at random",
          [](const ParameterValues&) { return TeamBeliefNeeds{.members = true, .rules = {}}; },
          [](const ParameterValues& parameters) -> std::unique_ptr<Strategy> {
            return std::make_unique<RandomDemonstrations>(parameters);
          },
          curriculum_parameters()};
}

}  // namespace kith::detail
