#pragma once

#include <filesystem>

#include "kith/fit/person_log.hpp"

namespace kith {

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
