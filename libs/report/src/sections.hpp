#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "design.hpp"
#include "json_table.hpp"
#include "kith/analysis/finding.hpp"
#include "kith/bec/atlas.hpp"
#include "kith/report/report.hpp"
#include "run_data.hpp"
#include "run_files.hpp"

namespace kith::detail {

// The belief spheres of up to three telling teams, which are taught again from the frozen inputs. Nothing, and a note,
// if what comes of that is not what the tables say.
// @param particles  how many points of a belief are kept, at most.
[[nodiscard]] std::optional<Json> belief_spheres(const RunFiles& run, const ReportDesign& design, const RunData& data,
                                                 const Atlas& atlas, std::size_t particles,
                                                 std::vector<std::string>& notes);

// A team worth looking at, by position in the tables, and why.
struct TellingTeam {
  std::size_t team = 0;
  std::string why;
};
// Of the teams taught together, if there are any: the one with the lowest final knowledge, the slowest and a typical
// one, of different strategies where possible; the typical one first.
[[nodiscard]] std::vector<TellingTeam> telling_teams(const ReportDesign& design, const RunData& data);

// Predicted probabilities that everybody present answers a random test of the component correctly, in tenths, beside
// the true ones after the same periods. Nothing if people have no beliefs to compare with.
[[nodiscard]] std::optional<Json> mastery_calibration_table(const RunData& data);

// Estimates of abilities after each period beside the truth, per series: correlation, coverage of the 80 % intervals,
// and the share of people of whom it is told whether they are proficient. Periods with fewer than 10 people are left
// out.
[[nodiscard]] Json ability_estimates_table(const ReportDesign& design, const RunData& data);

// Mean regret, share right and knowledge of the teams of a series when so many periods were taught, and what that had
// taken: items shown, teacher's and people's minutes. Teams that have ended stay as they are.
[[nodiscard]] Json exam_by_period_table(const ReportDesign& design, const RunData& data);

// What the teams of a cell knew at the end and what that took, and how often the cell is on the efficiency front of its
// composition: no strategy leads to at least as much knowledge with fewer items, or more with as many.
[[nodiscard]] Json efficiency_table(const RunFiles& run, const ReportDesign& design, const RunData& data);

// Forecasts before the first lesson beside what happened, per cell.
[[nodiscard]] Json forecasts_table(const ReportDesign& design, const RunData& data);

// Forecast probabilities of being done after a few more periods, in tenths, beside how often that was so.
[[nodiscard]] Json forecast_calibration_table(const RunData& data);

// What single teams were shown and asked, and how they answered: {"domain", "features", "boards", "sentences", "teams"}
// (docs/json.md). The telling teams first, then by replicate, as many as a page can hold. Nothing if only teams were
// recorded.
[[nodiscard]] std::optional<Json> team_lessons(const RunFiles& run, const ReportDesign& design, const RunData& data,
                                               const Atlas& atlas, std::vector<std::string>& notes);

// Of a study that varies keys, every two factors with at least three levels each, one of them such a key: [{"factors":
// [row, column], "outcomes": [outcome_json()], "table"}]. A row of the table is a
// combination of levels, with means over everything else, and with what each comes to among those that have its level
// of the first factor (column "_standing"): "best", "not clearly worse" (the 95 % interval of the difference, of the
// same people where those can be compared, includes 0), or "".
[[nodiscard]] Json matrices(const RunFiles& run, const RunData& data);

// A paragraph for a paper that says how the run was made and evaluated, and the references that it cites:
// {"paragraph", "references": [{"key", "text", "bibtex"}]}. Every number comes from the resolved study and the
// manifest.
[[nodiscard]] Json methods_of(const RunFiles& run, const ReportDesign& design, const RunData& data,
                              const Analysis& analysis);

// Tables of the document about people over time. A time is left out unless at least 10 of the people, or 20 % of
// them, were still being taught then.

// @param before  by type: mass of a belief in the policy's class before teaching, which is row 0 of every curve.
[[nodiscard]] Json knowledge_by_period_table(const RunFiles& run, const ReportDesign& design, const RunData& data,
                                             const std::vector<double>& before);
[[nodiscard]] Json correct_by_period_table(const RunFiles& run, const ReportDesign& design, const RunData& data);

// The document about live sessions, from an export of their tables. It has the parts of a report that can be known of
// people: their answers, how long they were taught, and what the teacher estimated; nothing about what they believed.
// @throws kith::Error as read_session_tables().
[[nodiscard]] Json session_report(const std::filesystem::path& folder, const ReportOptions& options);

}  // namespace kith::detail
