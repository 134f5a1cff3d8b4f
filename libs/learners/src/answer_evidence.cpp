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

}  // namespace kith
