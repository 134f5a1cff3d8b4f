#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "console.hpp"
#include "kith/live/live_study.hpp"
#include "kith/service/live_service.hpp"
#include "kith/service/rehearsal.hpp"
#include "serve_options.hpp"

namespace kith::cli {

/// What is observed of this process while a rehearsal runs in it.
struct RehearsalRecord {
  std::vector<double> memory_mb;          ///< Resident, once a second.
  std::optional<double> restarted_after;  ///< Seconds after which the server was restarted; none: it was not.
  double restart_seconds = 0.0;           ///< From stopping it until it accepted connections again.
};

/// What `kith serve --rehearse` does against a server of this process.
/// @param restart  stops the server and starts it again at the same port, after options.restart_after.
/// @param record  is filled in while the rehearsal runs; outlives it.
[[nodiscard]] RehearsalOptions rehearsal_options(const ServeOptions& options, std::shared_ptr<const LiveStudy> study,
                                                 std::uint16_t port, LiveService::StartLinks links,
                                                 std::function<void()> restart, RehearsalRecord& record);

/// What became of the answers that were acknowledged.
struct StoredAnswers {
  std::size_t lost = 0;   ///< Not in the store.
  std::size_t twice = 0;  ///< In the store more than once.
};
/// Looks them up in the store of a folder that is not being served. @throws kith::Error as EventFile::read().
[[nodiscard]] StoredAnswers look_up(const std::vector<std::string>& answers, const std::filesystem::path& folder);

/// Prints the result as a table or as JSON. @return the exit code: 7 if an answer was lost or stored twice, 6 if
/// somebody did not come to an end or the server was not restarted as asked for, else 0.
[[nodiscard]] int report_rehearsal(const ServeOptions& options, const RehearsalResult& result,
                                   const RehearsalRecord& record, const StoredAnswers& stored, Console& console);

}  // namespace kith::cli
