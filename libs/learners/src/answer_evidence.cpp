#include "kith/learners/answer_evidence.hpp"

#include <optional>

#include "kith/geometry/cone.hpp"

namespace kith {
namespace {

std::optional<Cone> cone_of(std::span<const HalfSpace> possible, std::span<const AnswerRegion> answers) {
  if (!possible.empty()) return Cone::intersection(possible);
  for (const auto& region : answers) {
    if (!region.cone.empty()) return Cone{region.cone.front().dimension()};
  }
  return Cone::intersection(possible);
}

}  // namespace

AnswerEvidence::AnswerEvidence(std::span<const HalfSpace> possible, std::span<const AnswerRegion> answers,
                               double chance)
    : is_empty_{answers.empty()}, chance_{chance} {
  auto cone = cone_of(possible, answers);
  if (!cone) {
    is_contradictory_ = true;
    return;
  }
  possible_ = cone->minimal_set();
  for (const auto& region : answers) {
    if (!region.inside) {
      outside_.push_back(region.cone);
      continue;
    }
    for (const auto& half_space : region.cone) {
      if (!cone->clip(half_space)) is_contradictory_ = true;
    }
  }
  consistent_ = cone->minimal_set();
}

AnswerEvidence::AnswerEvidence(const Atlas& atlas, std::span<const GivenAnswer> answers)
    : is_empty_{true}, chance_{1.0} {
  std::vector<HalfSpace> possible;
  std::vector<AnswerRegion> regions;
  double chance = 1.0;
  bool is_best_for_nobody = false;
  for (const auto& [test, counts] : answers) {
    const auto facets = atlas.tables().finite_region(test).facets();
    possible.insert(possible.end(), facets.begin(), facets.end());
    const auto coverage = atlas.tables().coverage_set(test);
    auto& region = regions.emplace_back();
    bool is_known = false;
    for (const auto& other : coverage) {
      if (other == counts) {
        is_known = true;
      } else {
        region.cone.emplace_back(counts - other);
      }
    }
    if (!is_known) region.cone.clear();
    is_best_for_nobody = is_best_for_nobody || !is_known;
    chance /= static_cast<double>(coverage.size() + (is_known ? 0 : 1));
  }
  *this = AnswerEvidence{possible, regions, chance};
  is_contradictory_ = is_contradictory_ || is_best_for_nobody;
  paths_.assign(answers.begin(), answers.end());
  atlas_ = &atlas;
}

}  // namespace kith
