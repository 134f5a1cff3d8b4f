#pragma once

#include "kith/domains/domain.hpp"
#include "kith/files/column_names.hpp"
#include "kith/files/reader.hpp"
#include "kith/study/study_spec.hpp"

namespace kith {

/// The words that study files use.
inline const std::vector<std::string> kContrastFactorWords{columns::kStrategy, columns::kComposition};
inline constexpr const char* kStudySchema = "kith.study/1";

/// Reads every key of a study document into a specification; what is wrong goes
/// to the report, and its key keeps its default. `design.vary` is left alone.
/// @param domain  may be null, if it could not be read; then priors are not resolved.
/// @param models  what `learner.X.kind` may name; the first is the default.
[[nodiscard]] StudySpec read_study_spec(const TomlDocument& document, const Domain* domain, const StudyKinds& kinds,
                                        TomlReport& report);

}  // namespace kith
