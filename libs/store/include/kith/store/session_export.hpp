#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/files/codebook.hpp"
#include "kith/live/live_study.hpp"
#include "kith/store/event_file.hpp"
#include "kith/teaching/cache.hpp"

namespace kith {

/// What of a session is exported.
struct SessionExportOptions {
  std::optional<std::int64_t> room{};  ///< One room; otherwise all.
  bool with_names = false;             ///< Also names, query parameters and completion codes: what identifies people.
  bool with_text = false;              ///< Also what people wrote in their own words.
  bool with_discussions = false;       ///< Also discussions.csv; export_session() does so where groups talk.
  bool with_exams = false;             ///< Also exams.csv; export_session() does so where people are examined.
  bool with_world_names = false;       ///< Also names of worlds; export_session() does so where they have any.
};

/// What was exported.
struct ExportReport {
  std::map<std::string, std::size_t> rows;    ///< By file.
  std::map<std::string, std::string> hashes;  ///< SHA-256 by file.
};

/// Takes the next piece of the file of that name.
using ExportSink = std::function<void(std::string_view file, std::string_view piece)>;

/// The tables of an export, see docs/live-sessions.md: sessions, participants, periods, tests, keypresses, questions,
/// trials (for `kith fit`), beliefs and events.
[[nodiscard]] std::vector<TableDescription> export_tables(const SessionExportOptions& options);

/// Writes the tables, codebook.json, study.json (what was taught, for `kith report`) and SHA256SUMS, room by room; all
/// of it is of one instant. Every room is replayed: what was right is computed again, not read. The numbers of rows are
/// compared with the store.
/// @param cache  of the study's atlas.
/// @throws kith::Error  kIo E1615 if the numbers of rows differ from the store's; kMismatch E1612 (a damaged row),
/// E1614 (a room does not replay to what it was); kInvalidInput E1618 (there is no such room).
ExportReport export_session(EventFile& file, const std::shared_ptr<const LiveStudy>& study, TeachingCache& cache,
                            const SessionExportOptions& options, const ExportSink& sink);

}  // namespace kith
