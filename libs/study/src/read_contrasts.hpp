#pragma once

#include <vector>

#include "kith/files/reader.hpp"
#include "kith/study/study_spec.hpp"

namespace kith {

/// Reads the tables of `[[contrast]]`; what is wrong goes to the report, and contrasts whose weights are wrong are left
/// out.
/// @param spec  with the rest of the study, whose strategies and compositions contrasts compare.
[[nodiscard]] std::vector<StudyContrast> read_contrasts(const TomlArray& list, const StudySpec& spec,
                                                        TomlReport& report);

}  // namespace kith
