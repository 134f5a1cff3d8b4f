#pragma once

#include <filesystem>
#include <vector>

#include "kith/fit/person_log.hpp"
#include "kith/study/study_spec.hpp"

namespace kith {

/// Reads logs of any known layout and puts them together: run folders (import_run_folder()) and CSV files with one row
/// per trial (import_trials()). With more than one log, people are named after it: "2:7/1".
/// @throws kith::Error as the importers do; E0703 for anything else.
[[nodiscard]] ResponseLogs import_logs(const std::vector<std::filesystem::path>& paths, AnswerDetail detail);

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

/// The people of a table with one row per trial, as the closed-loop studies after [lee2021] kept it, in the order in
/// which things happened. Columns: user_id, domain, interaction_type, is_opt_response, mdp_parameters (JSON with
/// `constraints`, a list of normals); optional: loop_condition, iteration, kc_id, group. Others are passed over.
///
/// interaction_type is one of demo, diagnostic test, diagnostic feedback, remedial demo, remedial test, remedial
/// feedback, final test. A demonstration conveys its constraints. A test begins to count as a period of its own with
/// what was shown since the one before; its answer counts by its verdict: right means that the weight satisfies the
/// test's constraints. Feedback teaches its own constraints or, without any, the test's. A person in two domains is two
/// people. The component is kc_id or, without it, mdp_parameters.variable_filter.
///
/// Known faults, each noted and none dropped in silence: a label that contradicts the rows (W0701: the rows count), a
/// different number of final tests than most have (W0702), right answers without their feedback row among people who
/// have feedback otherwise (W0703: counted as heard), people who were told the weights (W0705: left out).
/// @throws kith::Error (kInvalidInput) with all diagnostics: E0501 to E0512, E0707, E0709; or (kIo).
[[nodiscard]] ResponseLogs import_trials(const std::filesystem::path& path);

}  // namespace kith
