#pragma once

#include <filesystem>

#include "kith/fit/person_log.hpp"
#include "kith/study/study_spec.hpp"

namespace kith {

/// The people of a run folder (docs/tables.md): what they saw (demonstrations.csv), answered
/// (responses.csv) and are labelled (learners.csv). What is known of them apart from the parameters (filter, prior,
/// cap, scale) is taken from the frozen study. The true parameters in learners.csv are
/// kept to compare with.
///
/// Paths that are best for nobody count by their verdict only (W0706).
/// @throws kith::Error (kInvalidInput, with file and row) if a table cannot be understood (E0501 to E0512, E0707,
/// E0708), the run has no answers because of its record level (E0705), it is not finished (E0704), or learners imagine
/// counterfactuals of their own, so that the tables do not say what they learned (E0706), or there are learners of
/// another model than "bayesian" (E0712).
/// @param kinds  what the frozen study may name.
[[nodiscard]] ResponseLogs import_run_folder(const std::filesystem::path& folder, AnswerDetail detail,
                                             const StudyKinds& kinds = {});

}  // namespace kith
