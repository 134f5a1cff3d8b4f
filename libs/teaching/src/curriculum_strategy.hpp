#pragma once

#include <algorithm>
#include <memory>
#include <numeric>
#include <vector>

#include "kith/teaching/strategy.hpp"
#include "unit_of.hpp"

namespace kith {

// Parameters of strategies whose lessons do not depend on beliefs.
[[nodiscard]] std::span<const Parameter> curriculum_parameters();

// A strategy that ranks the demonstrations of a component once and for all and shows them in this order, a few per
// lesson, those first that were not met yet. What they convey is found with the same imagined people as for `plan`.
class CurriculumStrategy : public Strategy {
 public:
  explicit CurriculumStrategy(const ParameterValues& values)
      : people_{static_cast<std::size_t>(values.count("people"))},
        demonstrations_{static_cast<std::size_t>(values.count("demonstrations"))} {}

  [[nodiscard]] UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) override;

 protected:
  // Candidates of the component, the first to be shown first. @param random  another one in every period.
  [[nodiscard]] virtual std::vector<StartIndex> ranking(const TeachingView& view, RandomStream random) const = 0;

  // All candidates of the component that is to be taught, ascending.
  [[nodiscard]] static std::vector<StartIndex> candidates(const TeachingView& view);

 private:
  std::size_t people_;
  std::size_t demonstrations_;
};

}  // namespace kith
