#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "kith/analysis/table_model.hpp"
#include "kith/study/study_spec.hpp"

namespace kith {

/// What a report holds, and who is told how far it is.
struct ReportOptions {
  std::size_t points_per_cell = 150;  ///< Teams of a cell that are listed one by one; fewer where there are many cells.
  std::size_t sphere_particles = 250;  ///< Particles of a belief that are drawn; fewer for long sessions.
  StudyKinds kinds{};                  ///< What the run's study can name.
  /// Tests a model on a table of live sessions, as analyze_balanced_table(), which is asked without it; nothing if it
  /// cannot.
  std::function<std::optional<Analysis>(const Dataset&, const ModelQuestion&)> test_model{};
  /// Called with what is done next ("reading periods.csv"), and again now and then while it is done.
  std::function<void(std::string_view step)> on_step{};
};

/// The report of a finished run, or of the tables that were exported from live sessions: one JSON document (schema
/// kith.report/1, docs/json.md) on one line, in ASCII. It holds the tables behind the figures with their intervals,
/// the findings of the analysis, a methods paragraph with its references, every parameter, how to reproduce the run,
/// and the beliefs of three teams, which are taught again from the frozen inputs. It depends on the files of the folder
/// only, and on test_model: equal folders give equal bytes.
///
/// A report of live sessions has what can be known of people: answers, periods, and the teacher's estimates of their
/// knowledge.
///
/// What the recording level does not give is left out. A team at the limit of periods counts as censored.
/// @throws kith::Error kIo or kInvalidInput with diagnostics (E0601 to E0606, E0620 to E0622 and those of the files
/// read) if the folder is neither a finished run nor an export, or a file in it is missing or damaged.
[[nodiscard]] std::string build_report(const std::filesystem::path& run_folder, const ReportOptions& options = {});

/// The page that shows the document: `page` with the document in place of kDocumentPlaceholder, written so that no
/// text in it can end the script element, and the document's title in place of kTitlePlaceholder.
/// @throws std::invalid_argument unless the page has each placeholder once and the document is a JSON object with a
/// title.
[[nodiscard]] std::string render_report(std::string_view document, std::string_view page);

inline constexpr std::string_view kDocumentPlaceholder = "/*KITH_REPORT_JSON*/";
inline constexpr std::string_view kTitlePlaceholder = "/*KITH_REPORT_TITLE*/";

}  // namespace kith
