#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "kith/explain/audit_report.hpp"
#include "kith/live/room_audit.hpp"
#include "kith/store/event_file.hpp"

namespace kith {

struct SessionAuditOptions {
  std::string source;               ///< The folder, as it was named.
  std::string room;                 ///< Id or code of a room; empty: all rooms.
  double forgetting = kForgetting;  ///< AuditOptions::forgetting.
  /// Told how many rooms are judged, of how many; what it throws ends the audit.
  std::function<void(std::size_t done, std::size_t total)> on_progress;
  /// What people knew of the robot before an update, see TeachingOptions::known; nothing: as the study says.
  std::function<std::optional<Cone>(const Atlas&)> known{};
};

/// A live session, and who of its people understands what.
struct SessionAudit {
  std::shared_ptr<const LiveStudy> study;
  AuditReport report;
};

/// Judges everybody who was taught in the rooms of a live session, by their answers.
/// @throws kith::Error: E1115 (kInfeasible) if no room has had a lesson, E1614 (kMismatch) if a room does not replay to
/// what it was; those of find_room() and restore_session_study().
[[nodiscard]] SessionAudit audit_session(EventFile file, const SessionAuditOptions& options);

}  // namespace kith
