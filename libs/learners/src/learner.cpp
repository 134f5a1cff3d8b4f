#include "kith/learners/learner.hpp"

#include <algorithm>

#include "kith/core/math.hpp"

namespace kith {

std::vector<Direction> Learner::imagined_weights(std::size_t /*n*/, std::size_t /*period*/) const { return {}; }

double log_likelihood(const Learner& learner, const AnswerEvidence& evidence, double slip) {
  if (evidence.empty()) return 0.0;
  const auto share = learner.likelihood(evidence);
  if (!share) return 0.0;
  return math::log(std::max((1.0 - slip) * *share + slip * evidence.chance(), 1e-300));
}

std::vector<HalfSpace> conveyed_to(Behaviours& behaviours, Regions& regions, std::span<const StartIndex> demonstrations,
                                   std::span<const Direction> expected) {
  std::vector<PolicyCellIndex> cells;
  for (const auto& weights : expected) cells.push_back(behaviours.locate(weights));
  std::vector<HalfSpace> result;
  for (const auto start : demonstrations) {
    const auto own = behaviours.constraints().half_spaces(regions.minimal(behaviours.conveyed(start, cells)));
    result.insert(result.end(), own.begin(), own.end());
  }
  return result;
}

}  // namespace kith
