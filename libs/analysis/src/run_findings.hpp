#pragma once

#include <optional>

#include "run_tables.hpp"

namespace kith {

// Each answers one question about a run, or says by its absence that the design
// does not allow it.

// The primary ones of these contrasts, each about one response, corrected among themselves; nothing without any.
[[nodiscard]] std::optional<Finding> primary(const RunTeams& teams, const Outcomes& outcomes,
                                             const std::vector<PlannedContrast>& contrasts,
                                             const AnalysisOptions& options);
// The contrasts as they are tested: those without a response become one for each outcome of the teams.
[[nodiscard]] std::vector<PlannedContrast> by_response(const RunTeams& teams,
                                                       const std::vector<PlannedContrast>& contrasts);
// The fixed effects of a model of teams, with people as a random intercept if several teams consist of them.
[[nodiscard]] Estimable<FixedEffects> effects_of(const ModelData& model, double alpha);
// strategy x composition, group strategies only.
[[nodiscard]] std::optional<Finding> effects(const RunTeams& teams, const std::string& response,
                                             const std::vector<double>& values, const AnalysisOptions& options);
// strategy within every composition, corrected for their number.
[[nodiscard]] std::optional<Finding> effects_within(const RunTeams& teams, const std::string& response,
                                                    const std::vector<double>& values, const AnalysisOptions& options);
// Pairs of group strategies that taught the same simulated people.
[[nodiscard]] std::optional<Finding> paired(const RunTeams& teams, const std::string& response,
                                            const std::vector<double>& values, const AnalysisOptions& options);
// Group strategies against teaching everybody alone.
[[nodiscard]] std::optional<Finding> against_baseline(const RunTeams& teams, const std::string& response,
                                                      const std::vector<double>& values,
                                                      const AnalysisOptions& options);
// Strategies for the team's belief against strategies for one member's, as a planned contrast.
[[nodiscard]] std::optional<Finding> beliefs(const RunTeams& teams, const std::string& response,
                                             const std::vector<double>& values, const AnalysisOptions& options);
// Whether the number of periods varies less under the former, and knowledge less under the latter.
[[nodiscard]] std::optional<Finding> variation(const RunTeams& teams, const std::string& response,
                                               const std::vector<double>& values, const AnalysisOptions& options);
// Adds the analysis of variance that takes all teams as independent, and a warning: teams of a mixed model of a run.
void add_as_published(const ModelData& model, const AnalysisOptions& options, Finding& finding);
// How much the demonstrations convey: the manipulation check.
[[nodiscard]] std::optional<Finding> demonstrations(const RunTeams& teams, const PublishedRun& run,
                                                    const AnalysisOptions& options);

// One value per team and knowledge component: the mean logarithm of the area of what the demonstrations of a period
// convey, over the component's periods but the first, which is alike for all.
struct ConveyedAreas {
  std::vector<std::size_t> team;       // position in RunTeams
  std::vector<std::string> component;  // its number
  std::vector<double> mean_log_area;
};
[[nodiscard]] ConveyedAreas read_areas(const RunTeams& teams, const PublishedRun& run);

}  // namespace kith
