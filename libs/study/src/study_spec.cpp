#include "kith/study/study_spec.hpp"

#include <algorithm>
#include <stdexcept>

namespace kith {

const LearnerType& learner_type(const StudySpec& spec, char letter) {
  const auto type = std::find_if(spec.learner_types.begin(), spec.learner_types.end(),
                                 [&](const LearnerType& candidate) { return candidate.letter == letter; });
  if (type == spec.learner_types.end()) {
    throw std::invalid_argument{std::string{"learner_type: no learner type '"} + letter + "'"};
  }
  return *type;
}

}  // namespace kith
