#pragma once

#include <optional>

#include "kith/domains/domain.hpp"
#include "kith/files/reader.hpp"
#include "kith/study/study_spec.hpp"

namespace kith {

// `knowing` of a learner type: { robot = "...", halfspaces = [...] }. What named a file has been replaced by it, or
// reported. Nothing if there is no such key, or after reporting what is wrong. @param domain  null: not known.
[[nodiscard]] std::optional<OlderRobot> read_knowing(TomlReader& learner, const Domain* domain, TomlReport& report);

// Reports what nobody can know, as no weights in the prior satisfy it.
void check_knowing(TomlReader& learner, const LearnerType& type, const Domain* domain, TomlReport& report);

// The teacher knows what people know, unless it is told otherwise or they know different things.
void presume_knowing(TomlReader& study, StudySpec& spec, const Domain* domain, TomlReport& report);

}  // namespace kith
