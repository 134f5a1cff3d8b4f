#include "kith/learners/answer_evidence.hpp"

#include <algorithm>
#include <optional>
#include <utility>

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

std::vector<HalfSpace> once_each(std::vector<HalfSpace> half_spaces) {
  std::sort(half_spaces.begin(), half_spaces.end());
  half_spaces.erase(std::unique(half_spaces.begin(), half_spaces.end()), half_spaces.end());
  return half_spaces;
}

}  // namespace

AnswerEvidence::AnswerEvidence(std::span<const HalfSpace> possible, std::span<const AnswerRegion> answers,
                               double chance, EvidenceForm form)
    : is_empty_{answers.empty()}, chance_{chance} {
  if (form == EvidenceForm::kAsGiven) {
    keep_as_given(possible, answers);
    return;
  }
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

void AnswerEvidence::keep_as_given(std::span<const HalfSpace> possible, std::span<const AnswerRegion> answers) {
  possible_ = once_each({possible.begin(), possible.end()});
  consistent_ = possible_;
  for (const auto& region : answers) {
    if (region.inside) {
      consistent_.insert(consistent_.end(), region.cone.begin(), region.cone.end());
    } else {
      outside_.push_back(region.cone);
    }
  }
  consistent_ = once_each(std::move(consistent_));
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
