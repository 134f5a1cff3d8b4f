#include "kith/study/study_spec.hpp"

#include <algorithm>
#include <stdexcept>

#include "kith/core/assert.hpp"

namespace kith {

void take_domain(StudySpec& spec, const Domain& domain) {
  spec.num_features = domain.num_features();
  spec.count_scale = domain.count_scale();
  spec.weights = domain.weights();
  spec.world_names.clear();
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) spec.world_names.push_back(domain.world_name(m));
  const auto is_empty = [](const std::string& name) { return name.empty(); };
  if (std::all_of(spec.world_names.begin(), spec.world_names.end(), is_empty)) spec.world_names.clear();
}

bool has_costs(const StudySpec& spec) noexcept {
  return spec.exam != ExamLevel::kNone || spec.teaching.release.has_value() || spec.forecast_sessions > 0;
}

const StrategyChoice& strategy_of(const StudySpec& spec, std::string_view name) {
  const auto found = std::find_if(spec.strategies.begin(), spec.strategies.end(),
                                  [&](const StrategyChoice& candidate) { return candidate.name == name; });
  if (found == spec.strategies.end()) {
    throw std::invalid_argument{"strategy_of: the study has no strategy '" + std::string{name} + "'"};
  }
  return *found;
}

Cone prior_of(const LearnerType& type, const Cone& of_domain) {
  if (!type.prior) return of_domain;
  Cone prior{of_domain.dimension()};
  const bool has_room = prior.clip(*type.prior);
  KITH_ASSERT(has_room);  // checked when the study was read
  return prior;
}

std::optional<Cone> known_to(const LearnerType& type, const Cone& of_domain) {
  return type.knowing ? known_within(prior_of(type, of_domain), type.knowing->region) : std::nullopt;
}

std::optional<OlderRobot> known_to_all(const StudySpec& spec) {
  const LearnerType* first = nullptr;
  for (const auto& type : spec.learner_types) {
    if (!type.mixture.empty()) continue;
    if (first == nullptr) first = &type;
    if (type.knowing != first->knowing) return std::nullopt;
  }
  return first != nullptr ? first->knowing : std::nullopt;
}

const LearnerType& learner_type(const StudySpec& spec, char letter) {
  const auto type = std::find_if(spec.learner_types.begin(), spec.learner_types.end(),
                                 [&](const LearnerType& candidate) { return candidate.letter == letter; });
  if (type == spec.learner_types.end()) {
    throw std::invalid_argument{std::string{"learner_type: no learner type '"} + letter + "'"};
  }
  return *type;
}

}  // namespace kith
